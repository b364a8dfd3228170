"""Vehicles of other wheelsets and bodies: one bogie, six axles, loads that differ, own profiles."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
import vehicle_parts as parts
from click.testing import CliRunner
from profile_files import columns
from railpatch import ProfileError
from railpatch.command.cli import cli
from railpatch.errors import CaseError
from railpatch.log import read_run
from railpatch.profiles.builtin import builtin_profile
from railpatch.report.vehicle.data import vehicle_run

from wheelset_demo.scene import GRAVITY
from wheelset_demo.vehicle import Simulation, load_vehicle_scene
from wheelset_demo.vehicle.trace import run_vehicle

FRAME, AXLE = parts.BODY["mass"], parts.WHEELSET["mass"]


def finished(simulation: Simulation) -> Simulation:
    for _ in simulation.steps():
        pass
    return simulation


def test_one_bogie(tmp_path):
    """Two wheelsets and a frame: 6 + 2 (5 + 1) degrees of freedom, its weight on four wheels."""
    simulation = Simulation(parts.load(tmp_path, parts.bogie(), duration=0.3))
    assert simulation.system.model.nv == 18
    assert simulation.system.wheelsets == 2
    weight = GRAVITY * (FRAME + 2 * AXLE)
    np.testing.assert_allclose(simulation.system.suspension.statics.loads, weight / 2, rtol=1e-12)
    finished(simulation)
    loads = -simulation.element.wheels[:, :, 2]
    np.testing.assert_allclose(loads, weight / 4, rtol=5e-3)
    assert np.abs(simulation.element.states[:, [1, 4]]).max() < 1e-6


def test_loads_follow_from_moments(tmp_path):
    """A frame whose centre is ahead of the middle: by the lever rule, and for three axles by the
    springs' stiffness: three unknowns, z of the frame, its pitch, as a beam on equal springs."""
    scene = parts.load(tmp_path, parts.bogie((1.5, -1.0), x=0.4))
    loads = Simulation(scene).system.suspension.statics.loads - AXLE * GRAVITY
    lever = FRAME * GRAVITY * np.array([1.4, 1.1]) / 2.5
    np.testing.assert_allclose(loads, lever, rtol=1e-9)
    places = np.array([2.0, 0.5, -2.0])
    scene = parts.load(tmp_path, parts.bogie(tuple(places.tolist()), x=0.1))
    loads = Simulation(scene).system.suspension.statics.loads - AXLE * GRAVITY
    level = np.stack([np.ones(3), places])
    plane = np.linalg.solve(level @ level.T, FRAME * GRAVITY * np.array([1.0, 0.1]))
    # springs along the track lie at the axles' height, 0.14 m below the frame's centre: they resist
    # its pitch by a hundredth of what the vertical ones do
    np.testing.assert_allclose(loads, level.T @ plane, rtol=5e-3)
    assert loads.sum() == pytest.approx(FRAME * GRAVITY, rel=1e-12)


def test_a_body_beside_the_middle(tmp_path):
    """0.1 m to the right: its weight's moment is on the wheelsets at once, and right wheels carry
    more by moment over the distance of the contacts, 2 e each."""
    vehicle = parts.bogie()
    vehicle["body"][0]["position"] = [0.0, 0.1, 0.6]
    simulation = Simulation(parts.load(tmp_path, vehicle, duration=0.6, log_every=10))
    moments = simulation.system.suspension.statics.moments
    assert moments.sum() == pytest.approx(FRAME * GRAVITY * 0.1, rel=1e-9)
    rows = [-simulation.element.wheels[:, :, 2] for state in simulation.steps() if state.time > 0.3]
    left, right = np.mean(rows, axis=0).sum(axis=0)
    result = simulation.element.result(0)
    half = 0.5 * (
        result["right"]["patches"][0]["position"][1] - result["left"]["patches"][0]["position"][1]
    )
    # lateral forces at the rails' tops turn the whole by their height: they sum to nearly nothing
    assert (right - left) * half == pytest.approx(FRAME * GRAVITY * 0.1, rel=0.03)


def six_axles():
    """A locomotive's layout: a body on two bogies of three wheelsets, with axle boxes."""
    frames = {"bogie_1": 5.0, "bogie_2": -5.0}
    box = {"mass": 100.0, "inertia": [2.0, 5.0, 5.0], "lateral": 1.0}
    axles = {n: [x + 1.8, x, x - 1.8] for n, x in frames.items()}
    primary = [
        parts.place(frame, f"axle_box_{3 * b + k + 1}_{side}", x, y, parts.RADIUS)
        for b, frame in enumerate(frames)
        for k, x in enumerate(axles[frame])
        for side, y in (("left", -1.0), ("right", 1.0))
    ]
    secondary = [parts.place(f, "body", x, y, 0.9) for f, x in frames.items() for y in (-1.0, 1.0)]
    places = [x for frame in frames for x in axles[frame]]
    return {
        "body": [
            {"name": "body", "mass": 6e4, "inertia": [8e4, 1e6, 1e6], "position": [0, 0, 1.9]},
            *(
                {"name": n, "mass": 5e3, "inertia": [3e3, 9e3, 1e4], "position": [x, 0.0, 0.7]}
                for n, x in frames.items()
            ),
        ],
        "wheelset": [{"positions": places, **parts.WHEELSET, "axle_box": box}],
        "element": [
            parts.springs(places=primary, turning_stiffness=[0.0, 8e4, 0.0]),
            parts.springs(
                name="secondary", places=secondary, stiffness=[2e5, 2e5, 6e5], damping=[3e4] * 3
            ),
            {
                "name": "rods",
                "stiffness": [5e6, 0.0, 0.0],
                "damping": [2e4, 0.0, 0.0],
                "places": [parts.place(f, "body", x, 0.0, 0.6) for f, x in frames.items()],
            },
        ],
    }


def test_six_axles_from_scene_to_log(tmp_path):
    """Twelve wheels on every surface: JSON, log, report; momentum and energy close."""
    vehicle = six_axles()
    file = tmp_path / "co.toml"
    irregular = '[irregularity]\nlevel = "low"\nbegins = 5.0\n'
    file.write_text(parts.text_of(vehicle, duration=0.4, log_every=2) + irregular)
    log, page = tmp_path / "co.mcap", tmp_path / "co.html"
    done = CliRunner().invoke(cli, ["vehicle", str(file), "--json", "-o", str(log)])
    assert done.exit_code == 0, done.output
    found = json.loads(done.output)["runs"]["scene"]
    assert len(found["friction"]) == 12
    assert found["open_balance"] < 0.02 * found["lost"]
    run = read_run(log)
    data = vehicle_run(run)
    assert sorted(data.wheelsets) == [1, 2, 3, 4, 5, 6]
    assert data.body_names() == [
        "body",
        "bogie_1",
        "bogie_2",
        *(f"wheelset_{k}" for k in range(1, 7)),
    ]
    weight = GRAVITY * (6e4 + 2 * 5e3 + 6 * (AXLE + 200.0))
    assert sum(loads[0] for loads in data.loads.values()) == pytest.approx(weight, rel=5e-3)
    made = CliRunner().invoke(cli, ["report", str(log), "-o", str(page)])
    assert made.exit_code == 0, made.output
    assert "wheelset 6" in page.read_text(encoding="utf-8").lower()


def test_a_quarter_of_a_vehicle_is_the_vehicle(tmp_path):
    """A wheelset whose table is written twice over is the same vehicle: order and grouping of
    tables change no number."""
    one = parts.bogie()
    other = parts.bogie()
    first, second = other["wheelset"][0]["positions"]
    other["wheelset"] = [{**parts.WHEELSET, "positions": [x]} for x in (second, first)]
    other["body"], other["element"] = list(reversed(other["body"])), other["element"]
    ends = [finished(Simulation(parts.load(tmp_path, each))).state.values for each in (one, other)]
    assert ends[0].tobytes() == ends[1].tobytes()


def test_own_profiles_and_radii(tmp_path):
    """The second wheelset runs on cones of another radius: it spins by its own, and in a vehicle of
    two such wheelsets it does the same."""
    mixed, cones = parts.bogie(), parts.bogie()
    own = {"nominal_radius": 0.42, "profiles": {"wheel": "cone@1:20"}}
    mixed["wheelset"] = [
        {**parts.WHEELSET, "positions": [1.25]},
        {**parts.WHEELSET, **own, "positions": [-1.25]},
    ]
    scene = parts.load(tmp_path, mixed)
    assert scene.profiles["wheelset_1.wheel"] == "cone@1:20"
    simulation = Simulation(scene)
    rolling = np.abs(simulation.state.v[simulation.system.vehicle.spins]) / scene.speed
    assert rolling[0] == pytest.approx(1 / 0.46, rel=2e-3)
    assert rolling[1] == pytest.approx(1 / 0.42, rel=2e-3)
    cones["wheelset"] = [{**parts.WHEELSET, **own, "positions": [1.25, -1.25]}]
    alike = Simulation(parts.load(tmp_path, cones))
    np.testing.assert_allclose(
        simulation.element.wheels[1], alike.element.wheels[1], rtol=1e-6, atol=1e-3
    )
    # and both are in the log
    trace = run_vehicle(finished(simulation), output=tmp_path / "own.mcap")
    assert trace.failure is None


def test_own_profiles_from_files(tmp_path):
    """Paths start beside the scene; the log carries the files; what is wrong is named."""
    vehicle = parts.bogie()
    vehicle["wheelset"] = [
        {**parts.WHEELSET, "positions": [1.25], "profiles": {"wheel_left": "own.txt"}},
        {**parts.WHEELSET, "positions": [-1.25]},
    ]
    wheel = builtin_profile("S1002", "wheel")
    text = columns(1e3 * wheel.y[::8], 1e3 * wheel.z[::8])
    (tmp_path / "own.txt").write_text(text)
    simulation = Simulation(parts.load(tmp_path, vehicle, duration=0.005))
    first, second = simulation.element.wheels[:, :, 2]
    # the right wheel keeps the scene's
    np.testing.assert_allclose(first, second, rtol=2e-2)
    run_vehicle(simulation, output=tmp_path / "own.mcap")
    attached = read_run(tmp_path / "own.mcap").attachments
    assert attached["own.txt"].data == text.encode()
    (tmp_path / "own.txt").unlink()
    with pytest.raises(ProfileError, match=r"own\.txt"):
        Simulation(parts.load(tmp_path, vehicle))
    vehicle["wheelset"][0]["profiles"] = {"wheel": "cone@1:20", "wheel_left": "S1002"}
    with pytest.raises(
        CaseError, match=r"vehicle.wheelset\[0\].profiles.wheel.*only without 'wheel_left'"
    ):
        parts.load(tmp_path, vehicle)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (
            lambda v: v["element"][0].update(stiffness=[1e7, 0.0, 1e6]),
            r"nothing holds (wheelset|carrier)_[12]\.y",
        ),
        (
            lambda v: v["element"][0].update(stiffness=[1e7, 5e6, 0.0]),
            r"nothing holds frame\.(z|roll|pitch)",
        ),
        (
            lambda v: v["element"][0]["places"].__delitem__(slice(2, 4)),
            "vehicle.wheelset_2: value is free",
        ),
        (lambda v: v["wheelset"][0].update(positions=[1.25, 1.25]), "each place for one wheelset"),
        (
            lambda v: v["body"][0].update(mass=0.0),
            r"vehicle.body\[0\].mass: value is 0.0, allowed > 0",
        ),
        (
            lambda v: v["element"][0]["places"][0].update(between=["frame", "car"]),
            "value is 'car', allowed frame, wheelset_1, wheelset_2",
        ),
        (
            lambda v: v["element"][0].update(stiffness=[0.0] * 3, damping=[0.0] * 3),
            "a coefficient > 0",
        ),
        (
            lambda v: v["element"][0].update(friction_force=[1e3, 0.0, 0.0]),
            "friction_stiffness: value is",
        ),
        (lambda v: v["body"][0].update(position=[9.0, 0.0, 0.6]), "wheelset_2 carries -"),
    ],
)
def test_refused(tmp_path, change, message):
    vehicle = parts.bogie()
    change(vehicle)
    with pytest.raises(CaseError, match=message):
        Simulation(parts.load(tmp_path, vehicle))


def test_sliders_carry_no_weight(tmp_path):
    vehicle = parts.bogie()
    vehicle["element"][0] |= {
        "stiffness": [1e7, 5e6, 0.0],
        "friction_stiffness": [0.0, 0.0, 1e6],
        "friction_force": [0.0, 0.0, 1e5],
    }
    with pytest.raises(CaseError, match=r"no spring carries frame\.z.*sliders carry nothing"):
        Simulation(parts.load(tmp_path, vehicle))


def test_the_page_s_vehicle_runs(tmp_path):
    """That of docs/vehicle.md, with the contact and track of the packaged scene."""
    page = (Path(__file__).parents[2] / "docs" / "vehicle.md").read_text(encoding="utf-8")
    shown = page[page.index("[[vehicle.body]] ") :]
    shown = shown[: shown.index("```")]
    file = tmp_path / "page.toml"
    around = parts.text_of({})
    file.write_text(around.replace("[vehicle]\n", shown), encoding="utf-8")
    simulation = finished(Simulation(load_vehicle_scene(file).with_run(duration=0.02)))
    assert simulation.system.wheelsets == 2
    assert (np.abs(simulation.element.wheels[:, :, 2]) > 1e4).all()
