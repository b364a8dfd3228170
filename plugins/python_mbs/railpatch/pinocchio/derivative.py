"""Derivatives of forces on wheelsets, and with them of a model's accelerations.

    pin.computeABADerivatives(model, data, q, v, tau, fext)

holds each force of ``fext`` as it is in its joint's frame. Forces that change with position and
velocity change the acceleration further,

    d a = Minv sum_j J_j^T d f_j,

J_j the Jacobian and f_j the force of joint j, both in its frame (Carpentier and Mansard, RSS 2018,
have the rest). acceleration_derivatives() adds that to Pinocchio's.

From the tangent space to a wheelset's state, the twelve numbers of ``STATE``. For a small motion of
the joint (rho along, omega about its axes), A its axes in track axes, c the wheelset's centre in
the joint frame, and velocities v (linear), w (angular) in the joint frame:

    d centre = A (rho + omega x c)          d (A u) = A (omega x u + du) for any u of the joint
    d (roll, yaw, pitch) = E A omega        (roll_rate, yaw_rate, pitch_rate) = E A w

with E of the attitude angles as at the head of force_element.hpp: small turns and angular
velocities become rates of the angles in the same way.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Protocol

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

Matrix = NDArray[np.float64]
# rows of a state
PLACE, ANGLES, VELOCITY, RATES = (slice(3 * k, 3 * k + 3) for k in range(4))
ROLL, YAW = 3, 4


@dataclass(frozen=True)
class WrenchDerivatives:
    """Of a wrench on a joint, in its frame. by_q, by_v: [6, nv], by the tangent space. by_time:
    [6], at held q and v."""

    joint: int
    by_q: Matrix
    by_v: Matrix
    by_time: Matrix


class Wheelsets(Protocol):
    """What knows the states of wheelsets, see StateDerivatives: ForceElement. wheelset: in the
    joint frame. states: [wheelsets, 12]."""

    joints: list[int]
    wheelset: pin.SE3

    @property
    def states(self) -> Matrix:
        """Of the last step."""

    def track_rotation(self, index: int) -> Matrix:
        """[3, 3], from track axes to the world's."""


class Differentiable(Protocol):
    """What acts on joints and has derivatives: ForceElement, Suspension."""

    def wrench_derivatives(self, chain: StateChain) -> list[WrenchDerivatives]:
        """Of its wrenches at the last step."""


@dataclass(frozen=True)
class StateDerivatives:
    """Of a wheelset's state, and of wrenches on it, by the tangent space.

    joint: its index. by_q, by_v: [12, nv], rows STATE. turn: [3, nv], of the joint frame about its
    own axes, by q. axes: [3, 3], from track axes to the joint's. centre: m, [3], of the wheelset in
    the joint frame.
    """

    joint: int
    by_q: Matrix
    by_v: Matrix
    turn: Matrix
    axes: Matrix
    centre: Matrix

    def wrench(
        self, wrench: Matrix, by_state: Matrix, by_time: Matrix | None = None
    ) -> WrenchDerivatives:
        """Of a wrench on the wheelset.

        wrench: [6], force and moment at the wheelset's centre, track axes. by_state: [6, 12],
        by_time: [6], its derivatives in these axes.
        """
        # axes that turn with the joint see a constant vector turn back
        held = np.vstack(
            [pin.skew(self.axes @ part) @ self.turn for part in (wrench[:3], wrench[3:])]
        )
        by_q = self._moved(self._turned(by_state @ self.by_q) + held)
        by_v = self._moved(self._turned(by_state @ self.by_v))
        change = np.zeros(6) if by_time is None else self._moved(self._turned(by_time))
        return WrenchDerivatives(self.joint, by_q, by_v, change)

    def turned(self, wrench: Matrix) -> Matrix:
        """[6], a wrench at the wheelset's centre in track axes as it is at the joint."""
        return self._moved(self._turned(wrench))

    def _turned(self, change: Matrix) -> Matrix:
        """From track axes to those of the joint."""
        return np.concatenate([self.axes @ change[:3], self.axes @ change[3:]])

    def _moved(self, change: Matrix) -> Matrix:
        """From the wheelset's centre to the joint's origin."""
        moment = change[3:] + pin.skew(self.centre) @ change[:3]
        return np.concatenate([change[:3], moment])


class StateChain:
    """From the tangent space of a model to the states of an element's wheelsets.

    data: with computeForwardKinematicsDerivatives(model, data, q, v, a) at the q and v of the
    element's last step.
    """

    def __init__(self, model: pin.Model, data: pin.Data) -> None:
        self._model, self._data = model, data
        # holds the elements: another one at the place of one that is gone is not taken for it
        self._found: dict[tuple[Wheelsets, int], StateDerivatives] = {}

    def of(self, element: Wheelsets, index: int) -> StateDerivatives:
        """Of one wheelset of an element."""
        key = (element, index)
        if key not in self._found:
            self._found[key] = self._make(element, index)
        return self._found[key]

    def jacobian(self, joint: int) -> Matrix:
        """[6, nv], of a joint in its own frame."""
        return pin.getJointJacobian(self._model, self._data, joint, pin.ReferenceFrame.LOCAL)

    def _make(self, element: Wheelsets, index: int) -> StateDerivatives:
        joint = element.joints[index]
        local = pin.ReferenceFrame.LOCAL
        velocity_by_q, jacobian = pin.getJointVelocityDerivatives(
            self._model, self._data, joint, local
        )
        out = element.track_rotation(index).T @ self._data.oMi[joint].rotation
        centre = element.wheelset.translation
        velocity = self._data.v[joint].vector
        state = element.states[index]
        lever, turned = pin.skew(centre), jacobian[3:]
        to_angles, by_roll, by_yaw = angle_rates(state[ROLL], state[YAW])
        linear = velocity[:3] + np.cross(velocity[3:], centre)
        spin = out @ velocity[3:]

        by_q = np.zeros((len(state), self._model.nv))
        by_v = np.zeros_like(by_q)
        by_q[PLACE] = out @ (jacobian[:3] - lever @ turned)
        by_q[ANGLES] = to_angles @ out @ turned
        linear_by_q = velocity_by_q[:3] - lever @ velocity_by_q[3:]
        by_q[VELOCITY] = out @ (linear_by_q - pin.skew(linear) @ turned)
        by_v[VELOCITY] = by_q[PLACE]
        spin_by_q = out @ (velocity_by_q[3:] - pin.skew(velocity[3:]) @ turned)
        by_angles = np.outer(by_roll @ spin, by_q[ROLL]) + np.outer(by_yaw @ spin, by_q[YAW])
        by_q[RATES] = to_angles @ spin_by_q + by_angles
        by_v[RATES] = by_q[ANGLES]
        return StateDerivatives(joint, by_q, by_v, turned, out.T, centre)


def angle_rates(roll: float, yaw: float) -> tuple[Matrix, Matrix, Matrix]:
    """E [3, 3] from track axes to rates of roll, yaw, pitch; its derivatives by roll and yaw."""
    c, s, level, across = math.cos(roll), math.sin(roll), math.cos(yaw), math.sin(yaw)
    pitch, pitch_by_roll = np.array([0.0, c, s]) / level, np.array([0.0, -s, c]) / level
    pitch_by_yaw = pitch * across / level
    rates = np.array([across * pitch, [0.0, -s, c], pitch])
    rates[0, 0] = 1.0
    by_roll = np.array([across * pitch_by_roll, [0.0, -c, -s], pitch_by_roll])
    by_yaw = np.array([level * pitch + across * pitch_by_yaw, np.zeros(3), pitch_by_yaw])
    return rates, by_roll, by_yaw


def angular_velocity(state: Matrix) -> tuple[Matrix, Matrix]:
    """rad/s, [3], in track axes, and its derivatives [3, 12] by the state."""
    to_rates, by_roll, by_yaw = angle_rates(state[ROLL], state[YAW])
    back = np.linalg.inv(to_rates)
    spin = back @ state[RATES]
    by_state = np.zeros((3, len(state)))
    by_state[:, RATES] = back
    by_state[:, ROLL] = -back @ by_roll @ spin
    by_state[:, YAW] = -back @ by_yaw @ spin
    return spin, by_state


@dataclass(frozen=True)
class AccelerationDerivatives:
    """acceleration: [nv]. by_q, by_v: [nv, nv], by the tangent space. by_time: [nv], at held q and
    v. chain: from the tangent space to the states of wheelsets."""

    acceleration: Matrix
    by_q: Matrix
    by_v: Matrix
    by_time: Matrix
    chain: StateChain


def acceleration_derivatives(
    model: pin.Model,
    data: pin.Data,
    q: Matrix,
    v: Matrix,
    tau: Matrix,
    fext: pin.StdVec_Force,
    forces: Iterable[Differentiable],
) -> AccelerationDerivatives:
    """Accelerations of forward dynamics and their derivatives, with those of the forces.

    forces: the force elements, of cases with method.derivatives = true, and suspensions whose last
    step() was at q and v and gave ``fext``. What else is in it is held as it is in its joint's
    frame. tau: held, too. In data afterwards: as after computeABADerivatives(), its ddq_dq and
    ddq_dv without the changes of the forces. Raises CaseError.
    """
    pin.computeABADerivatives(model, data, q, v, tau, fext)
    acceleration = data.ddq.copy()
    by_q, by_v = data.ddq_dq.copy(), data.ddq_dv.copy()
    upper = np.triu(data.Minv)
    inverse = upper + np.triu(upper, 1).T
    pin.computeForwardKinematicsDerivatives(model, data, q, v, acceleration)
    chain, by_time = StateChain(model, data), np.zeros(model.nv)
    for part in (part for force in forces for part in force.wrench_derivatives(chain)):
        to_acceleration = inverse @ chain.jacobian(part.joint).T
        by_q += to_acceleration @ part.by_q
        by_v += to_acceleration @ part.by_v
        by_time += to_acceleration @ part.by_time
    return AccelerationDerivatives(acceleration, by_q, by_v, by_time, chain)
