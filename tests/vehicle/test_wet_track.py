"""Wet stretches under a braked vehicle, and rails that its wheels clean for those that follow."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from railpatch.case.fluid import Fluid
from railpatch.case.friction import Friction
from railpatch.errors import CaseError

from wheelset_demo.scene import scene_file
from wheelset_demo.vehicle import Simulation, load_vehicle_scene
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


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("[[wet]]\nposition = 20.0\nlength = 5.0\nwater_rate = 1e-8\n", "fluid.water_rate"),
        ("[[wet]]\nposition = 20.0\nwater_rate = 1e-8\n", r"wet\[0\].length: value is missing"),
        ("[[wet]]\nposition = 20.0\nlength = -5.0\nwater_rate = 1e-8\n", r"wet\[0\].length"),
        (
            '[fluid]\nmodel = "film"\nroughness = 5e-7\nliquid = "water"\nwater_rate = 0.0\n'
            + "[[wet]]\nposition = 20.0\nlength = 5.0\nwater_rate = 1e-8\n" * 2,
            r"wet\[1\].position: value is 20.0, allowed >= 25 m",
        ),
    ],
)
def test_refused_by_name(text: str, message: str, tmp_path: Path) -> None:
    path = tmp_path / "scene.toml"
    content = scene_file("vehicle_straight.toml").read_text(encoding="utf-8")
    path.write_text(content + "\n" + text, encoding="utf-8")
    with pytest.raises(CaseError, match=message):
        load_vehicle_scene(path)


def test_water_that_no_wheel_comes_to_is_told() -> None:
    scene = braked(DAMP, 0.1, (WET.model_copy(update={"position": 900.0}),))
    assert any("wet[0].position is 900 m" in text for text in doubts_of(scene))


def test_the_log_and_the_summary_take_it(tmp_path: Path) -> None:
    scene = braked({**DAMP, "recovery": {"coefficient": 5e-4}}, 0.05)
    trace = run_vehicle(Simulation(scene))
    assert trace.failure is None
    assert trace.works[-1][1] > 0
