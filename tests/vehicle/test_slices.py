"""Vehicles, wheelsets and rigs over profiles by slices, whose files lie beside the scene."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import vehicle_scenes as scenes
from railpatch import Contact
from railpatch.errors import CaseError
from railpatch.profiles.turnout import blade, write_slices

from rig_model.scene import load_rig_scene
from wheelset_demo.scene import GRAVITY, load_wheelset_scene, scene_file
from wheelset_demo.vehicle import Simulation, VehicleScene, load_vehicle_scene
from wheelset_demo.vehicle.trace import run_vehicle

TIP = 22.0  # m, of the blade: the first wheelset stands 21.56 m along the track
ORIGIN = 0.7175  # m, of the gauge line
FILES = '[profiles.{body}_file]\nunit = "mm"\nswap = false\nmirror = "none"\n'
LEFT = f"""
[track.left]
origin = [{-ORIGIN}, 0.0]
sections = [{{ position = 0.0, profile = "blade_00.txt" }}]
"""


def with_blade(folder: Path, scene: str, left: str = LEFT) -> Path:
    """A scene of the package whose right rail is a blade at its stock rail, from TIP on."""
    slices = [replace(part, position=part.position + TIP) for part in blade()]
    sections = write_slices("blade", slices, folder)
    lines = scene_file(scene).read_text(encoding="utf-8").splitlines()
    rail = next(line for line in lines if line.startswith("rail = "))
    text = "\n".join(lines).replace(rail, "smoothing = 0.0\n" + FILES.format(body="rail"))
    if not left:
        text = text.replace("smoothing = 0.0\n", 'smoothing = 0.0\nrail_left = "UIC60@1:40"\n')
    right = f"[track.right]\norigin = [{ORIGIN}, 0.0]\nsections = [\n{sections}\n]\n"
    text = text.replace("[track]", '[track]\nsection_blend = "cubic"', 1)
    text = text.replace("[profiles]", f"{right}{left}[profiles]", 1)
    path = folder / scene
    path.write_text(text, encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Of slices and scenes; files are read once."""
    return tmp_path_factory.mktemp("slices")


def vehicle_scene(folder: Path, left: str = LEFT, **run: Any) -> VehicleScene:
    """The coach on straight and even track, in a quick theory."""
    scene = load_vehicle_scene(with_blade(folder, "vehicle_straight.toml", left))
    wheelset = scene.case.wheelset.model_copy(update={"speed": 20.0})
    case = scene.case.model_copy(update={"wheelset": wheelset})
    return replace(scene, case=case, irregularity=None).with_method(**scenes.QUICK).with_run(**run)


def test_slices_lie_beside_the_scene(folder: Path, monkeypatch) -> None:
    """Wherever the command is called."""
    monkeypatch.chdir("/")
    for load, name in ((load_vehicle_scene, "vehicle_straight"), (load_wheelset_scene, "s1002")):
        scene = load(with_blade(folder, f"{name}.toml"))
        found = scene.case.track.right.sections[3].profile
        assert found == scene.profiles["track.right.sections[3]"] == str(folder / "blade_03.txt")


def test_slices_of_a_rig_lie_beside_its_scene(tmp_path: Path, monkeypatch) -> None:
    """A wheel's, round it."""
    monkeypatch.chdir("/")
    (tmp_path / "round.txt").write_text("0 0\n1 0\n")
    given = load_rig_scene().text.decode()
    sections = '[wheelset.right]\nsections = [{ angle = 0.0, profile = "round.txt" }]'
    path = tmp_path / "rig.toml"
    path.write_text(given.replace("[wheelset.right]", sections))
    scene = load_rig_scene(path)
    (section,) = scene.case.wheelset.right.sections
    assert section.profile == str(scene.files["round.txt"]) == str(tmp_path / "round.txt")


def test_a_start_on_one_wheel_is_refused(folder: Path) -> None:
    """The stock rail is 1.4 mm higher under the wheel than the rail of the other side."""
    with pytest.raises(CaseError, match=r"left wheel of a level wheelset hangs above its rail"):
        Simulation(vehicle_scene(folder, left=""))


def test_wheels_stand_where_they_start(folder: Path) -> None:
    """Each wheelset at its own place: rails that lie 0.3 mm lower from 21 m on, under the first."""
    scene = vehicle_scene(folder)
    file = folder / "blade_00.txt"
    np.savetxt(folder / "lower.txt", np.loadtxt(file) + np.array([0.0, 0.3]), fmt="%.9f")
    profiles = [(0.0, file), (20.0, file), (21.0, folder / "lower.txt")]
    (first,) = scene.case.track.left.sections
    sections = [
        first.model_copy(update={"position": x, "profile": str(profile)}) for x, profile in profiles
    ]
    track = scene.case.track.model_copy(
        update={
            side: getattr(scene.case.track, side).model_copy(update={"sections": sections})
            for side in ("left", "right")
        }
    )
    simulation = Simulation(replace(scene, case=scene.case.model_copy(update={"track": track})))
    loads = -simulation.element.wheels[:, :, 2]
    np.testing.assert_allclose(loads, loads[3, 0], rtol=1e-6)
    # but for the lateral force of spin on contacts that lean, which is not yet in balance
    assert loads.sum() == pytest.approx(scene.vehicle.mass * GRAVITY, rel=0.05)


def test_forces_over_a_blade_are_those_of_one_wheel(folder: Path) -> None:
    """Through the transfer from the stock rail to the blade; and the run's energy closes."""
    scene = vehicle_scene(folder, step=5e-4, log_every=10, duration=0.15)
    simulation = Simulation(scene)
    content = scene.at_height().case.model_dump()
    content |= {"kind": "wheel_rail", "wheel": {"side": "right"}}
    alone = Contact(content)
    places, loads = [], []
    for _ in simulation.steps():
        found = simulation.element.result(0)["right"]
        expected = alone.step(**simulation.element.state(0))
        assert found["status"] == expected["status"] == "converged"
        for key in ("force", "moment"):
            assert found[key] == pytest.approx(expected[key], rel=1e-9, abs=1e-6)
        places.append(simulation.system.positions[0] - TIP)
        loads.append(-found["force"][2])
    assert places[0] < 0 < 2.0 < places[-1]
    assert np.ptp(loads) > 1e3


def test_energy_closes_over_a_blade(folder: Path, measured) -> None:
    """As on irregular rails, down to the time steps' error."""
    missing = []
    for step in (1e-3, 5e-4):
        trace = run_vehicle(Simulation(vehicle_scene(folder, duration=0.15, step=step)))
        assert trace.failure is None
        missing.append(trace.open_balance() / trace.lost())
    measured(f"open of what was lost: {missing[0]:.2e}, at half the step {missing[1]:.2e}")
    assert missing[0] < 0.1
    assert missing[1] < 0.5 * missing[0]
