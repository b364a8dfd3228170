"""The same wheelset with its contact inside the FMU, stepped by fmpy, and in the process."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import wheelset_scenes as scenes
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import FMU2Slave
from railpatch import _core
from railpatch.fmu import pack_fmu

from wheelset_demo.coupling.held import ElementContact, FmuContact, held_run
from wheelset_demo.coupling.instance import FmuFailure, UnpackedFmu
from wheelset_demo.scene import WheelsetScene
from wheelset_demo.simulation import Simulation
from wheelset_demo.start import released
from wheelset_demo.system import System

STEP, STEPS = 2.5e-4, 400  # s: the bounce on the contacts bounds the explicit step
# of coordinates (x and pitch run on), of lateral, vertical and turning rates, of the spin: rounding
# of z by 1e-17 m in one of two runs in the process sets their bounces as far apart as is found here
SIZE = np.array([1.0, 1e-3, 1e-3, 1e-3, 1e-3, 1.0, 20.0, 0.1, 0.1, 0.1, 0.1, 40.0])


def packed(scene: WheelsetScene, folder: Path) -> Path:
    """With the FFT library of this process: the same sums in the same order."""
    path = folder / "wheelset.fmu"
    return pack_fmu(scene.at_height(), path, name="wheelset", backend=_core.fft_backend())


@pytest.mark.parametrize("name", ["s1002.toml", "hunting.toml"])
def test_equal_to_the_run_in_the_process(name: str, tmp_path: Path, measured):
    # forces differ by rounding, which a choice that hangs on it makes as great as the tolerance
    scene = scenes.scene(tmp_path, name, tolerance=1e-9)
    inside = np.array(
        [state.motion for state in held_run(scene, ElementContact(scene), STEP, STEPS)]
    )
    with FmuContact(packed(scene, tmp_path)) as contact:
        outside = np.array([state.motion for state in held_run(scene, contact, STEP, STEPS)])
    assert len(inside) == len(outside) == STEPS + 1
    difference = (np.abs(inside - outside) / SIZE).max()
    measured(f"{name}, contact in the FMU, {STEPS} steps: {difference:.1e} off the process")
    assert difference < 1e-9
    # it has moved
    assert np.ptp(inside[:, 1]) > 1e-5


def test_held_forces_follow_the_implicit_run(tmp_path: Path):
    # zero-order hold is of first order: nothing but the step lies between the two
    scene = scenes.scene(tmp_path, "hunting.toml", y=1e-3, speed=20.0, distance=2.0, log_every=1000)
    simulation = Simulation(scene)
    simulation.run()
    errors = []
    for step in (2e-4, 1e-4):
        *_, last = held_run(scene, ElementContact(scene), step, round(0.1 / step))
        errors.append(abs(last.motion[1] - simulation.state.motion[1]) / 1e-3)
    assert errors[0] < 1e-3
    assert errors[1] == pytest.approx(errors[0] / 2, rel=0.2)


def test_a_contact_that_fails_says_so(tmp_path: Path):
    scene = scenes.scene(tmp_path, "s1002.toml")
    motion = released(scene, System(scene)).motion
    with FmuContact(packed(scene, tmp_path)) as contact:
        contact.wrench(0.0, STEP, motion)
        motion[1] = 0.5
        with pytest.raises(RuntimeError, match=r"^contact at 0\.00025 s: fmi2DoStep: .* out of"):
            contact.wrench(STEP, STEP, motion)


def test_an_instance_that_cannot_be_made_leaves_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    file = packed(scenes.scene(tmp_path, "hunting.toml"), tmp_path)
    unpacked = tmp_path / "unpacked"
    unpacked.mkdir()
    monkeypatch.setattr("tempfile.tempdir", str(unpacked))

    def fail(*_: object, **__: object) -> None:
        assert list(unpacked.iterdir())
        raise RuntimeError("none")

    monkeypatch.setattr(FMU2Slave, "instantiate", fail)
    with pytest.raises(RuntimeError, match="none"):
        FmuContact(file)
    assert not list(unpacked.iterdir())


def test_messages_are_those_of_the_call_that_failed(tmp_path: Path):
    scene = scenes.scene(tmp_path, "s1002.toml")
    motion = released(scene, System(scene)).motion
    fmu = UnpackedFmu(packed(scene, tmp_path))
    slave = fmu.instance(FMU2Slave, fmu.description.coSimulation)
    fmu.call(slave.setupExperiment, None, 0.0)
    fmu.call(slave.enterInitializationMode)
    motion[1] = 0.5
    fmu.call(slave.setReal, fmu.inputs, motion[fmu.used].tolist())
    with pytest.raises(FmuFailure, match="cannot be solved"):
        fmu.call(slave.exitInitializationMode)

    def silent() -> None:
        raise FMICallException("silent", 3)

    with pytest.raises(FmuFailure, match="silent") as failure:
        fmu.call(silent)
    assert failure.value.status == 3
    fmu.close()
