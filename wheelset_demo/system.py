"""The equations of motion: wheelset, suspension and contact."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray
from railpatch import CaseError
from railpatch.case.types import SIDES
from railpatch.pinocchio import (
    Body,
    Energies,
    ForceElement,
    Suspension,
    acceleration_derivatives,
    energies,
    wheelset_model,
)
from railpatch.pinocchio import powers as powers_of
from railpatch.pinocchio.model import WHEELSET
from railpatch.pinocchio.suspension import Carried

from wheelset_demo.scene import GRAVITY, WheelsetScene

Vector = NDArray[np.float64]

# coordinates x, y, z, roll, yaw, pitch, and the same number of velocities
COUNT = 6
# integrated along with the motion (J), see railpatch.pinocchio.Powers
WORKS = ("contact", "friction", "damping", "drive")
# and the impulses of all forces on the wheelset and its carrier: N s, and about the centre N m s
IMPULSES = ("x", "y", "z", "about x", "about y", "about z")
BAD = ("not_converged", "out_of_range")


class ContactFailure(RuntimeError):
    """A contact was not solved; the run cannot go on. time: s, of the state."""

    def __init__(self, time: float, position: float, reason: str) -> None:
        self.time = time
        super().__init__(f"contact failed at {time:.6g} s, {position:.6g} m: {reason}")


@dataclass(frozen=True)
class State:
    """time: s. motion: [12], coordinates and velocities. work: [4], J, by WORKS. impulse: [6], N s,
    N m s, by IMPULSES."""

    time: float
    motion: Vector
    work: Vector
    impulse: Vector = field(default_factory=lambda: np.zeros(len(IMPULSES)))

    @property
    def q(self) -> Vector:
        """[6], x, y, z, roll, yaw, pitch."""
        return self.motion[:COUNT]

    @property
    def v(self) -> Vector:
        """[6], speed, vy, vz, roll_rate, yaw_rate, pitch_rate."""
        return self.motion[COUNT:]


@dataclass(frozen=True)
class Rates:
    """Time derivatives of a state. motion: [12]. work: [4], W. status: of the contact. impulse:
    [6], N, N m."""

    motion: Vector
    work: Vector
    status: str
    impulse: Vector = field(default_factory=lambda: np.zeros(len(IMPULSES)))


@dataclass(frozen=True)
class Linear:
    """Derivatives of rates of motion, work and impulse, [22], by motion, [22, 12], and time."""

    by_motion: Vector
    by_time: Vector


class System:
    """Wheelset, suspension and contact of a scene. Keeps the contact's last solution."""

    def __init__(self, scene: WheelsetScene, *, exact: bool | None = None) -> None:
        """exact: whether derivatives() will be asked for; left out: as the scene's stepper does.

        Raises CaseError, ProfileError.
        """
        self.model = model_of(scene)
        self.data = self.model.createData()
        self.element = ForceElement(
            self.model, WHEELSET, scene.at_height(scene.run.exact if exact is None else exact)
        )
        self.suspension = suspension_of(scene, self.element)
        self._fext = no_forces(self.model)
        self._joint = self.model.getJointId(WHEELSET)
        self._torque = np.zeros(self.model.nv)
        self._weight = np.array([0.0, 0.0, scene.body.total_mass * GRAVITY, 0.0, 0.0, 0.0])
        self.evaluations = 0

    def rates(self, time: float, motion: Vector) -> Rates:
        """At a time (s) and a motion, [12]. Raises ContactFailure."""
        q, v = motion[:COUNT], motion[COUNT:]
        pin.forwardKinematics(self.model, self.data, q, v)
        self._fext[self._joint].setZero()
        self.evaluations += 1
        try:
            status = self.element.step(self.data, self._fext)
        except CaseError as error:
            # far off the rails, or not a number: a step too long
            raise ContactFailure(time, float(q[0]), str(error)) from None
        if status in BAD:
            raise ContactFailure(time, float(q[0]), self.statuses())
        self.suspension.step(time, self._fext)
        acceleration = pin.aba(self.model, self.data, q, v, self._torque, self._fext)
        power = powers_of(self.element, [self.suspension])
        work = np.array([getattr(power, name) for name in WORKS])
        impulse = self.element.contact_wrench[0] + self.suspension.wrench + self._weight
        return Rates(np.concatenate([v, acceleration]), work, status, impulse)

    def derivatives(self, motion: Vector) -> Linear:
        """Exact ones at a motion whose rates were the last ones asked for. Raises CaseError."""
        q, v = motion[:COUNT], motion[COUNT:]
        spring = self.suspension
        found = acceleration_derivatives(
            self.model, self.data, q, v, self._torque, self._fext, [self.element, spring]
        )
        states = found.chain.of(self.element, 0)
        by_state = np.hstack([states.by_q, states.by_v])
        wrench = self.element.derivatives() + spring.wrench_by_state()
        contact = self.element.contact_power_derivatives()
        friction = self.element.creep_power_derivatives()
        powers = [contact, friction, *spring.power_derivatives()]
        by_motion = np.vstack(
            [
                np.hstack([np.zeros((COUNT, COUNT)), np.eye(COUNT)]),
                np.hstack([found.by_q, found.by_v]),
                powers @ by_state,
                wrench @ by_state,
            ]
        )
        moving = spring.wrench_by_time
        drive = [0.0, 0.0, 0.0, spring.speed * moving[0]]
        return Linear(by_motion, np.concatenate([np.zeros(COUNT), found.by_time, drive, moving]))

    def momentum(self, state: State) -> Vector:
        """[6], N s, N m s, by IMPULSES: of all bodies, about their centre of mass."""
        found = pin.computeCentroidalMomentum(self.model, self.data, state.q, state.v)
        return found.vector.copy()

    def statuses(self) -> str:
        """How the last contact ended, by side."""
        result = self.element.result()
        texts = {side: f"{side} wheel {result[side]['status']}" for side in SIDES}
        reasons = {side: result[side]["reason"] for side in SIDES}
        return ", ".join(
            f"{texts[side]}: {reasons[side]}" if reasons[side] else texts[side] for side in SIDES
        )

    def energies(self, state: State) -> Energies:
        """Of a state whose rates were the last ones asked for."""
        return energies(self.model, self.data, state.q, state.v, self.element, [self.suspension])


def model_of(scene: WheelsetScene) -> pin.Model:
    """The wheelset on a composite carrier."""
    body = scene.body
    wheelset = Body(body.mass, (body.roll_inertia, body.pitch_inertia, body.roll_inertia))
    radius = scene.case.wheelset.nominal_radius
    return wheelset_model(wheelset, radius, carrier_body=carrier_of(scene), gravity=GRAVITY)


def suspension_of(scene: WheelsetScene, element: Carried) -> Suspension:
    """The primary suspension of an element's wheelset."""
    table = scene.suspension
    stiffness, damping = table.stiffness.model_dump(), table.damping.model_dump()
    return Suspension(element, stiffness, damping, speed=scene.speed, preload=scene.preload)


def no_forces(model: pin.Model) -> pin.StdVec_Force:
    """An fext of zeros."""
    return pin.StdVec_Force([pin.Force.Zero() for _ in range(model.njoints)])


def carrier_of(scene: WheelsetScene) -> Body | None:
    """What is carried without spinning."""
    mass, inertia = scene.body.carrier_mass, scene.body.carrier_inertia
    if mass is None or inertia is None:
        return None
    # nothing turns about the axle but the wheelset: any value will do
    return Body(mass, (inertia, inertia, inertia))
