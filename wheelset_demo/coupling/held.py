"""The wheelset with its contact elsewhere: forces are exchanged at communication points only.

    with FmuContact("wheelset.fmu") as contact:
        for state in held_run(scene, contact, step=2.5e-4, steps=400): ...

At each point the contact gets the wheelset's position and velocity and gives force and moment,
which the multibody model then holds over the step (zero-order hold). One who solves them in the
process (ElementContact) and one who does it in an FMU give the same run.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Protocol

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray
from railpatch.pinocchio import ForceElement
from railpatch.pinocchio.element import STATE
from railpatch.pinocchio.model import WHEELSET

from wheelset_demo.coupling.instance import WRENCH, FmuFailure, UnpackedFmu
from wheelset_demo.scene import WheelsetScene, refuse_bulk
from wheelset_demo.start import released
from wheelset_demo.system import (
    BAD,
    COUNT,
    State,
    System,
    Vector,
    model_of,
    no_forces,
    suspension_of,
)

STATUS_GOOD = (0, 1, 4, 5)  # converged, no contact, accuracy not met, work spent


class HeldContact(Protocol):
    """Contact forces at communication points, one call a point, times rising by the step (s)."""

    def wrench(self, time: float, step: float, motion: Vector) -> Vector:
        """[6], N, N m, on the wheelset at its centre, track axes; motion: [12]."""


class ElementContact:
    """In this process."""

    def __init__(self, scene: WheelsetScene) -> None:
        """Raises CaseError, ProfileError."""
        refuse_bulk(scene.case, "a contact held between communication points")
        self._model = model_of(scene)
        self._data = self._model.createData()
        self._element = ForceElement(self._model, WHEELSET, scene.at_height())

    def wrench(self, time: float, step: float, motion: Vector) -> Vector:
        """See HeldContact. Raises RuntimeError for a contact that was not solved."""
        pin.forwardKinematics(self._model, self._data, motion[:COUNT], motion[COUNT:])
        fext = no_forces(self._model)
        status = self._element.step(self._data, fext)
        if status in BAD:
            raise RuntimeError(f"contact at {time:.6g} s: {status}")
        return self._element.contact_wrench[0].copy()


class FmuContact:
    """In an FMU of kind "wheelset" with z given, through fmpy."""

    def __init__(self, path: str | Path) -> None:
        """Raises fmpy's errors."""
        from fmpy.fmi2 import FMU2Slave

        self._fmu = UnpackedFmu(path)
        self._outputs = [self._fmu.references[name] for name in WRENCH]
        self._status = [self._fmu.references["status"]]
        self._slave = self._fmu.instance(FMU2Slave, self._fmu.description.coSimulation)
        self._begun = False

    def __enter__(self) -> FmuContact:
        return self

    def __exit__(self, *_: object) -> None:
        # after an error nothing but this is allowed
        self._fmu.close()

    def wrench(self, time: float, step: float, motion: Vector) -> Vector:
        """See HeldContact. The first one is that of the initialisation, the others of a step each.

        Raises RuntimeError for a contact that was not solved.
        """
        try:
            self._advance(time, step, motion[self._fmu.used].tolist())
        except FmuFailure as failure:
            raise RuntimeError(f"contact at {time:.6g} s: {failure}") from None
        if self._slave.getInteger(self._status)[0] not in STATUS_GOOD:
            raise RuntimeError(f"contact at {time:.6g} s: not solved by the FMU")
        return np.array(self._slave.getReal(self._outputs))

    def _advance(self, time: float, step: float, values: list[float]) -> None:
        slave, call, inputs = self._slave, self._fmu.call, self._fmu.inputs
        if self._begun:
            call(slave.setReal, inputs, values)
            call(slave.doStep, time - step, step)
            return
        call(slave.setupExperiment, None, time)
        call(slave.enterInitializationMode)
        call(slave.setReal, inputs, values)
        call(slave.exitInitializationMode)
        self._begun = True


class Carrier:
    """What a suspension wants of a force element: the wheelset's state, and a wrench put in its
    joint's frame. The coordinates of the composite carrier are the state."""

    frame_speed = 0.0

    def __init__(self, model: pin.Model, data: pin.Data) -> None:
        self.joints = [model.getJointId(WHEELSET)]
        self.states = np.zeros((1, len(STATE)))
        self._data = data

    def place(self, index: int, force: Sequence[float], moment: Sequence[float]) -> NDArray:
        """[6], force and moment (track axes, at the centre) in the joint frame."""
        turn = self._data.oMi[self.joints[index]].rotation.T
        return np.concatenate([turn @ force, turn @ moment])


def held_run(
    scene: WheelsetScene, contact: HeldContact, step: float, steps: int
) -> Iterator[State]:
    """States at the communication points, ``step`` (s) apart, from the release on.

    Velocities first, then positions with the new ones: the bounce on the contacts does not grow
    below 2 over its frequency.
    """
    model = model_of(scene)
    data = model.createData()
    carrier = Carrier(model, data)
    suspension = suspension_of(scene, carrier)
    joint, torque = carrier.joints[0], np.zeros(model.nv)
    state = released(scene, System(scene))
    for index in range(steps + 1):
        time = index * step
        yield State(time, state.motion, state.work)
        if index == steps:
            return
        q, v = state.q, state.v
        pin.forwardKinematics(model, data, q, v)
        carrier.states[0] = state.motion
        fext = no_forces(model)
        wrench = contact.wrench(time, step, state.motion)
        fext[joint] = pin.Force(carrier.place(0, wrench[:3], wrench[3:]))
        suspension.step(time, fext)
        faster = v + step * pin.aba(model, data, q, v, torque, fext)
        state = State(time + step, np.concatenate([q + step * faster, faster]), state.work)
