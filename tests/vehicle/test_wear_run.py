"""[damage] along runs of a vehicle, a wheelset and a rig: mass balances, samples, log, page."""

from __future__ import annotations

import csv
import json
import math
from dataclasses import replace

import numpy as np
import pinocchio as pin
import pytest
import vehicle_scenes as scenes
from click.testing import CliRunner
from railpatch import CaseError, Contact
from railpatch.case.asked import Damage
from railpatch.case.types import SIDES
from railpatch.command.cli import cli
from railpatch.log import read_run
from railpatch.pinocchio import Body, ForceElement, wheelset_model
from railpatch.pinocchio.model import WHEELSET
from railpatch.report import write_report

from rig_model.run import replay
from rig_model.scene import load_rig_scene as load_rig
from wheelset_demo.hunting import slowest_mode
from wheelset_demo.scene import load_wheelset_scene, scene_file
from wheelset_demo.simulation import Simulation as WheelsetSimulation
from wheelset_demo.vehicle import Simulation, load_vehicle_scene
from wheelset_demo.vehicle.trace import run_vehicle, summarise

FAST = {"normal": "hertz", "tangential": "fastsim"}


def worn_scene(every=10, duration=0.3, **law):
    given = scenes.scene(duration=duration, irregular=True, method=FAST, damage_every=every)
    case = given.case.model_copy(update={"damage": Damage(**law)})
    return replace(given, case=case)


@pytest.fixture(scope="module")
def ran(tmp_path_factory):
    path = tmp_path_factory.mktemp("wear") / "run.mcap"
    simulation = Simulation(worn_scene())
    trace = run_vehicle(simulation, None, path)
    assert trace.failure is None
    return simulation, summarise(trace, simulation), path


def test_mass_over_the_profiles_is_that_of_the_samples(ran):
    """Of each wheel and its rail, in the run and in the log, whose bins are summed here."""
    simulation, summary, path = ran
    wear, run = simulation.wear, read_run(path)
    assert wear is not None
    assert summary.wear is not None
    for (number, side), found in wear.by_wheel.items():
        mass = wear.masses[number, side]
        assert mass > 0
        for body in ("wheel", "rail"):
            assert found.mass(body) == pytest.approx(mass, rel=1e-9)
        (message,) = run[f"/wheelset/{number}/{side}/wear"].messages
        width = message["y"][1] - message["y"][0]
        for body in ("wheel", "rail"):
            assert sum(message[body]) * width == pytest.approx(mass, rel=1e-9)
        assert message["mass"] == pytest.approx(mass)
        # the way is the wheelset's own
        assert message["way"] == pytest.approx(simulation.scene.speed * 0.3, rel=1e-3)
        depth = np.array(message["wheel"]) / (7850.0 * 2 * math.pi * 0.46)
        np.testing.assert_allclose(message["wheel_depth"], depth, rtol=1e-12)
        depth = np.array(message["rail"]) / (7850.0 * message["way"])
        np.testing.assert_allclose(message["rail_depth"], depth, rtol=1e-12)
        told = summary.wear[f"wheelset_{number}_{side}"]
        assert told["mass"] == pytest.approx(mass)
        assert told["wheel_depth"] == pytest.approx(max(message["wheel_depth"]))
        # on the tread, and inside what the contact reached
        assert -0.03 < told["wheel_place"] < 0.03
    json.dumps(summary.to_dict(), allow_nan=False)
    assert "wear_text" not in summary.to_dict()
    assert "1 left" in summary.text()


def test_samples():
    """Every tenth step for its way is within 2 % of every step, and the run is the same."""
    few, many = (Simulation(worn_scene(every, 0.2)) for every in (10, 1))
    for simulation in (few, many):
        for _ in simulation.steps():
            pass
    np.testing.assert_array_equal(few.state.values, many.state.values)
    assert few.wear is not None
    assert many.wear is not None
    total = [sum(one.wear.masses.values()) for one in (few, many)]
    assert total[0] == pytest.approx(total[1], rel=0.02)
    ways = [one.wear.ways[1, "left"] for one in (few, many)]
    assert ways[0] == pytest.approx(ways[1], rel=1e-12)
    # and without [damage] the run has the same bits
    plain = scenes.finished(scenes.scene(duration=0.2, irregular=True, method=FAST))
    np.testing.assert_array_equal(plain.state.values, few.state.values)
    assert plain.wear is None


def test_page_and_files(ran, tmp_path):
    _, summary, path = ran
    write_report(path, tmp_path / "run.html")
    page = (tmp_path / "run.html").read_text(encoding="utf-8")
    assert "Wear over the profiles" in page
    assert 'id="wear"' in page
    for ending in ("csv", "json"):
        out = tmp_path / f"x.{ending}"
        done = CliRunner().invoke(cli, ["export", str(path), "--wear", "-o", str(out)])
        assert done.exit_code == 0, done.output
    wheels = json.loads((tmp_path / "x.json").read_text())
    assert len(wheels) == 8
    with (tmp_path / "x.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    own = [row for row in rows if (row["wheelset"], row["side"]) == ("3", "right")]
    (same,) = [one for one in wheels if (one["wheelset"], one["side"]) == (3, "right")]
    assert [float(row["wheel [kg/m]"]) for row in own] == pytest.approx(same["wheel"])
    assert [float(row["y [m]"]) for row in own] == pytest.approx(same["y"])
    assert summary.wear["wheelset_3_right"]["mass"] == pytest.approx(same["mass"])
    for wrong in (["-o", "x.xlsx"], ["-o", "x.csv", "--list"], []):
        assert CliRunner().invoke(cli, ["export", str(path), "--wear", *wrong]).exit_code == 2


def test_a_force_element_has_the_damage_of_its_case():
    """Of one state, as a Contact has it: numbers and rows."""
    case = load_vehicle_scene().with_method(**FAST).case.model_dump()
    case["damage"] = {"wear": "usfd"}
    model = wheelset_model(Body(1500.0, (800.0, 100.0, 800.0)), 0.46)
    element = ForceElement(model, WHEELSET, case)
    data, q, v = model.createData(), pin.neutral(model), np.zeros(model.nv)
    q[1], q[2], v[0], v[5] = 2e-3, 3e-4, 20.0, -20.0 / 0.46 * 1.001
    pin.forwardKinematics(model, data, q, v)
    element.step(data, pin.StdVec_Force([pin.Force.Zero()] * model.njoints))
    contact = Contact(case)
    place = element.state()
    expected = contact.step(**{key: place[key] for key in place if key != "pitch"})
    found = element.result()
    assert found["damage"]["wear_rate"] > 0
    for side in SIDES:
        for name in ("wear_rate", "wheel_depth_rate", "fatigue_index"):
            assert found[side]["damage"][name] == pytest.approx(expected[side]["damage"][name])
        pairs = zip(element.wear_rows()[side], contact.wear_rows()[side], strict=True)
        for (share, rows), (own_share, own) in pairs:
            assert share == pytest.approx(own_share)
            for name, values in rows.items():
                np.testing.assert_allclose(values, own[name], rtol=1e-9, atol=1e-15)
    plain = case | {"damage": None}
    other = ForceElement(model, WHEELSET, plain)
    other.step(data, pin.StdVec_Force([pin.Force.Zero()] * model.njoints))
    with pytest.raises(CaseError, match="damage: left out"):
        other.wear_rows()


def test_a_wheelset_run(tmp_path):
    """The same of one wheelset on straight track."""
    scene = load_wheelset_scene(None, {"distance": 4.0})
    case = scene.case.model_copy(update={"damage": Damage(basis="patch")})
    scene = replace(scene, case=case)
    simulation = WheelsetSimulation(scene)
    trace = simulation.run()
    assert trace.wear is not None
    for side in SIDES:
        assert trace.wear.ways[1, side] == pytest.approx(4.0, rel=2e-3)
        mass = trace.wear.masses[1, side]
        assert mass > 0
        assert trace.wear.by_wheel[1, side].mass("wheel") == pytest.approx(mass, rel=1e-9)
    text = scene_file("s1002.toml").read_text(encoding="utf-8")
    path, log = tmp_path / "scene.toml", tmp_path / "run.mcap"
    path.write_text(text + '\n[damage]\nbasis = "patch"\n', encoding="utf-8")
    run = ["wheelset", str(path), "--distance", "2", "-o", str(log)]
    done = CliRunner().invoke(cli, [*run, "--json"])
    assert done.exit_code == 0, done.output
    told = json.loads(done.stdout)["wear"]["wheelset_1_left"]
    (message,) = read_run(log)["/left/wear"].messages
    assert told["mass"] == pytest.approx(message["mass"])
    assert "wear " in CliRunner().invoke(cli, run).stdout
    write_report(log, tmp_path / "run.html")
    assert "Wear over the profiles" in (tmp_path / "run.html").read_text(encoding="utf-8")
    with pytest.raises(CaseError, match="no way over which profiles wear"):
        slowest_mode(load_wheelset_scene(path), 20.0)
    path.write_text(text.replace("[run]", "[run]\ndamage_every = 2"), encoding="utf-8")
    with pytest.raises(CaseError, match=r"run\.damage_every"):
        load_wheelset_scene(path)


def test_a_rig_run(tmp_path):
    """Positions count for the time since the one before, by the rollers' surface."""
    scene = load_rig(None, {"positions": 5})
    law = Damage()
    scene = replace(scene, case=scene.case.model_copy(update={"damage": law}))
    summary = replay(scene, tmp_path / "rig.mcap")
    assert summary.good
    wear = summary.wear
    assert wear is not None
    run = read_run(tmp_path / "rig.mcap")
    times = run["/left/contact"].time
    radius = scene.case.track.roller_radius
    ways = np.diff(times, prepend=0.0) * radius * scene.case.track.roller_pitch_rate
    for side in SIDES:
        rates = np.array([m["damage"]["wear_rate"] for m in run[f"/{side}/contact"].messages])
        (message,) = run[f"/{side}/wear"].messages
        assert message["mass"] == pytest.approx(float(rates @ ways), rel=1e-9)
        assert message["wheel_mass"] == pytest.approx(message["mass"], rel=1e-9)
        depth = np.array(message["rail"]) / (7850.0 * 2 * math.pi * radius)
        np.testing.assert_allclose(message["rail_depth"], depth, rtol=1e-12)
    assert "wear " in summary.text()
    write_report(tmp_path / "rig.mcap", tmp_path / "rig.html")
    assert "rollers round them" in (tmp_path / "rig.html").read_text(encoding="utf-8")
