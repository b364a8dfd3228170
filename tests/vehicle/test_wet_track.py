"""Wet stretches under a braked vehicle, and rails that its wheels clean for those that follow."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from railpatch.case.fluid import Fluid
from railpatch.case.friction import Friction
from railpatch.errors import CaseError

from rig_model.scene import default_scene, load_rig_scene
from wheelset_demo.scene import load_wheelset_scene, scene_file
from wheelset_demo.vehicle import Simulation, VehicleScene, load_vehicle_scene
from wheelset_demo.vehicle.plausible import doubts_of
from wheelset_demo.vehicle.trace import run_vehicle
from wheelset_demo.vehicle.wet_track import CELL, WetTable, WetTrack

TORQUE = 46875.0  # N m
WET = WetTable(position=0.0, length=100.0, water_rate=25e-9)
STRETCH = WetTable(position=17.0, length=9.0, water_rate=1e-7)
DAMP = {"model": "regimes", "water_rate": 0.0}


def braked(fluid: dict, duration: float, wet: tuple[WetTable, ...] = (WET,)):
    """The locomotive of the package, 13 m long, brakes at 15 m/s with control of its slip."""
    scene = load_vehicle_scene(scene_file("locomotive.toml"))
    scene = scene.with_run(step=2e-3, log_every=1, duration=duration)
    scene = scene.with_method(tangential="polach")
    case = scene.case.model_copy(
        update={"friction": Friction(coefficient=0.5), "fluid": Fluid(**fluid)}
    )
    drives = [one.model_copy(update={"torque": [[0.0, -TORQUE]]}) for one in scene.vehicle.drive]
    vehicle = scene.vehicle.model_copy(update={"drive": drives})
    return replace(scene, case=case, vehicle=vehicle, wet=wet)


def run(scene) -> tuple[Simulation, dict[str, np.ndarray]]:
    simulation = Simulation(scene)
    kept = {"position": [], "work": [], "adhesion": [], "water": []}
    for state in simulation.steps():
        wheels = simulation.element.wheels
        kept["position"].append(simulation.system.positions.copy())
        kept["work"].append(state.work[4:].reshape(-1, 2).copy())
        kept["adhesion"].append(wheels[:, :, 0].sum(axis=1) / wheels[:, :, 2].sum(axis=1))
        kept["water"].append(simulation.element.water.copy())
    return simulation, {key: np.array(value) for key, value in kept.items()}


def at_the_end(kept: dict[str, np.ndarray]) -> np.ndarray:
    """Adhesion of each wheelset over the last 0.2 s, where all run on rails that others ran on."""
    return kept["adhesion"][-100:].mean(axis=0)


def test_following_wheels_meet_a_cleaner_rail() -> None:
    """Work is kept whole; in each cell it is what the wheels spent over it, found again from where
    they were; each wheelset brakes better than the one ahead, all worse than in the dry."""
    simulation, kept = run(braked({**DAMP, "recovery": {"coefficient": 2e-4}}, 1.4))
    wet, x, work = simulation.system.wet, kept["position"], kept["work"]
    assert wet is not None
    assert wet.spent == pytest.approx(work[-1].sum(), rel=1e-9)
    for side in (0, 1):
        expected = np.zeros(wet.work.shape[1])
        for k in range(4):
            # the cell that it is in is not left yet
            cells = np.arange(int(x[0, k] / CELL), int(x[-1, k] / CELL))
            at = [
                np.interp(np.maximum(c * CELL, x[0, k]), x[:, k], work[:, k, side])
                for c in (cells, cells + 1)
            ]
            expected[cells] += (at[1] - at[0]) / CELL
        assert wet.work[side] == pytest.approx(expected, rel=1e-7, abs=1e-6)
    # what the last wheelset meets at the end is what those ahead left there, not its own
    at = int(x[-1, 3] / CELL)
    assert kept["water"][-1, 3, 1] == wet.work[0, at] > 0
    assert (kept["water"][:, :, 0] == WET.water_rate).all()
    found = at_the_end(kept)
    assert (np.diff(found) > 0).all(), found
    assert 0.05 < found[0] < found[3] < 0.4


def test_without_recovery_all_wheels_are_alike() -> None:
    """Sustained 0.05 under each wheelset, that of the regime's knot."""
    simulation, kept = run(braked(DAMP, 0.5))
    assert simulation.system.wet is not None
    assert simulation.system.wet.spent == 0
    found = at_the_end(kept)
    # the knot's coefficient, less what of the contact still adheres
    assert (found > 0.045).all()
    assert (found < 0.05).all()
    assert found == pytest.approx(found.mean(), rel=0.01)


def test_a_film_on_the_stretch_alone() -> None:
    """Supply where the wheelset is: within the stretch the coefficient is the film's."""
    film = {"model": "film", "roughness": 5e-7, "boundary_friction": 0.15, "liquid": "water"}
    simulation, kept = run(braked({**film, "water_rate": 0.0}, 0.4, (STRETCH,)))
    for k in range(4):
        inside = 17.0 <= kept["position"][-1, k] < 26.0
        (patch,) = simulation.element.result(k)["left"]["patches"]
        assert (patch["effective_friction"] < 0.25) == inside
        assert (patch["effective_friction"] == 0.5) == (not inside)


def test_nothing_is_kept_in_the_dry() -> None:
    assert WetTrack.of((), None, 100.0, 4) is None
    assert WetTrack.of((), Fluid(**DAMP), 100.0, 4) is None
    scene = load_vehicle_scene(scene_file("locomotive.toml"))
    assert Simulation(scene).system.wet is None


FLUID = """
[fluid]
model = "film"
roughness = 5e-7
liquid = "water"
"""
RATE = FLUID + "water_rate = 0.0\n"


def stretch(**changes: str | None) -> str:
    keys = {"position": "20.0", "length": "5.0", "water_rate": "1e-8", **changes}
    lines = [f"{name} = {value}" for name, value in keys.items() if value is not None]
    return "\n".join(["[[wet]]", *lines, ""])


def loaded(text: str, tmp_path: Path) -> VehicleScene:
    path = tmp_path / "scene.toml"
    content = scene_file("vehicle_straight.toml").read_text(encoding="utf-8")
    path.write_text(content + "\n" + text, encoding="utf-8")
    return load_vehicle_scene(path)


ONLY = "allowed only with fluid.water_rate, that of the rest of the track"
KEYS = "but the key is unknown, allowed position, length, water_rate"
# what is appended to a scene, and all that is said
REFUSED: dict[str, tuple[str, list[str]]] = {
    "no liquid": (stretch(), [f"wet: given without [fluid], {ONLY}"]),
    "flooded": (FLUID + stretch(), [f"wet: given without fluid.water_rate, {ONLY}"]),
    "a layer": (
        FLUID + "oil_film = 1e-6\n" + stretch(),
        [f"wet: given with fluid.oil_film, {ONLY}"],
    ),
    "strip": (
        FLUID.replace("film", "strip") + stretch(),
        ["wet: given with fluid.model = 'strip', allowed only with 'film' or 'regimes'"],
    ),
    "unknown key": (
        RATE + stretch(rail_work="3.0"),
        [f"wet[0].rail_work: value is 3.0, {KEYS}; 'rail_work' is a key of [fluid]"],
    ),
    "its end": (
        RATE + stretch(length=None, end="25.0"),
        [
            "wet[0].length: value is missing, allowed m",
            f"wet[0].end: value is 25.0, {KEYS}",
        ],
    ),
    "ends before it starts": (
        RATE + stretch(length="-5.0"),
        ["wet[0].length: value is -5.0, allowed > 0.0 m"],
    ),
    "no length": (RATE + stretch(length="0.0"), ["wet[0].length: value is 0.0, allowed > 0.0 m"]),
    "endless": (
        RATE + stretch(length="1e6"),
        ["wet[0].length: value is 1000000.0, allowed <= 100000.0 m"],
    ),
    "before the track": (
        RATE + stretch(position="-1.0"),
        ["wet[0].position: value is -1.0, allowed >= 0.0 m"],
    ),
    "negative rate": (
        RATE + stretch(water_rate="-1e-8"),
        ["wet[0].water_rate: value is -1e-08, allowed >= 0.0 m^3/s"],
    ),
    "a river": (
        RATE + stretch(water_rate="1e3"),
        ["wet[0].water_rate: value is 1000.0, allowed <= 1.0 m^3/s"],
    ),
    "no number": (
        RATE + stretch(water_rate="nan"),
        ["wet[0].water_rate: value is nan, allowed a finite number"],
    ),
    "a word": (
        RATE + stretch(water_rate="'much'"),
        ["wet[0].water_rate: value is 'much', allowed a number"],
    ),
    "one table": (
        RATE + stretch().replace("[[wet]]", "[wet]"),
        [
            "wet: value is a table, allowed a list of [[wet]] tables, with the keys position, "
            "length, water_rate"
        ],
    ),
    "twice": (
        RATE + 2 * stretch(),
        ["wet[1].position: value is 20.0, allowed >= 25 m, where another ends"],
    ),
    "two within a third": (
        RATE + stretch(length="50.0") + stretch(position="22.0") + stretch(position="40.0"),
        [
            "wet[1].position: value is 22.0, allowed >= 70 m, where another ends",
            "wet[2].position: value is 40.0, allowed >= 70 m, where another ends",
        ],
    ),
}


@pytest.mark.parametrize("name", REFUSED)
def test_refused_by_name(name: str, tmp_path: Path) -> None:
    text, said = REFUSED[name]
    with pytest.raises(CaseError) as error:
        loaded(text, tmp_path)
    assert error.value.problems == said


def test_stretches_that_touch(tmp_path: Path) -> None:
    """In any order; where one ends the next begins."""
    text = RATE + stretch(position="25.0", water_rate="2e-8") + stretch()
    scene = loaded(text, tmp_path)
    track = WetTrack.of(scene.wet, scene.case.fluid, scene.length, 1)
    assert track is not None
    water, places = np.zeros((1, 3)), (19.99, 20.0, 24.99, 25.0, 29.99, 30.0)
    found = []
    for place in places:
        track.put(np.array([place]), water)
        found.append(water[0, 0])
    assert found == pytest.approx([np.nan, 1e-8, 1e-8, 2e-8, 2e-8, np.nan], nan_ok=True)


@pytest.mark.parametrize(
    ("load", "source"),
    [
        (load_wheelset_scene, scene_file("hunting.toml")),
        (load_rig_scene, default_scene()),
    ],
)
def test_other_runs_have_no_stretches(
    load: Callable[[Path], Any], source: Path, tmp_path: Path
) -> None:
    """Of the vehicle alone: elsewhere the key is unknown."""
    path = tmp_path / "scene.toml"
    path.write_text(source.read_text(encoding="utf-8") + "\n" + stretch(), encoding="utf-8")
    with pytest.raises(CaseError, match=r"wet: value is .* unknown"):
        load(path)


def test_water_that_no_wheel_comes_to_is_told() -> None:
    scene = braked(DAMP, 0.1, (WET.model_copy(update={"position": 900.0}),))
    assert any("wet[0].position is 900 m" in text for text in doubts_of(scene))


def test_the_log_and_the_summary_take_it(tmp_path: Path) -> None:
    scene = braked({**DAMP, "recovery": {"coefficient": 5e-4}}, 0.05)
    trace = run_vehicle(Simulation(scene))
    assert trace.failure is None
    assert trace.works[-1][1] > 0
