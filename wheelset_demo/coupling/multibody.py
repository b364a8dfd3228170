"""The multibody side: wheelset and suspension under a contact wrench that is given over a step."""

from __future__ import annotations

import math

import numpy as np
import pinocchio as pin
from railpatch.pinocchio import acceleration_derivatives
from railpatch.pinocchio.derivative import StateChain, WrenchDerivatives, angular_velocity

from wheelset_demo.coupling.held import Carrier
from wheelset_demo.scene import WheelsetScene
from wheelset_demo.system import COUNT, Vector, model_of, no_forces, suspension_of

MOTION = 2 * COUNT
# s: suspension and inertia alone are slow, some 40 rad/s
LONGEST = 1e-3
KILO = 1e3  # N, N m


class HeldCarrier(Carrier):
    """One whose wrench is the same in track axes, wherever the wheelset goes."""

    wheelset = pin.SE3.Identity()
    wrench = np.zeros(6)

    def track_rotation(self, _index: int) -> Vector:
        """[3, 3], of the track axes in the world."""
        return np.eye(3)

    def wrench_derivatives(self, chain: StateChain) -> list[WrenchDerivatives]:
        """See railpatch.pinocchio.acceleration_derivatives."""
        return [chain.of(self, 0).wrench(self.wrench, np.zeros((6, MOTION)))]


class Multibody:
    """Motion: [12], coordinates and velocities. Wrench: [6], N, N m, on the wheelset at its centre
    in track axes."""

    def __init__(self, scene: WheelsetScene) -> None:
        self._model = model_of(scene)
        self._data = self._model.createData()
        self._carrier = HeldCarrier(self._model, self._data)
        self._suspension = suspension_of(scene, self._carrier)
        self._joint = self._carrier.joints[0]
        self._fext = no_forces(self._model)
        self._torque = np.zeros(self._model.nv)

    def rates(self, time: float, motion: Vector, wrench: Vector) -> Vector:
        """[13], of the motion, and the power (W) of the contact wrench."""
        q, v = motion[:COUNT], motion[COUNT:]
        pin.forwardKinematics(self._model, self._data, q, v)
        self._carrier.states[0], self._carrier.wrench = motion, wrench
        local = pin.Force(self._carrier.place(0, wrench[:3], wrench[3:]))
        self._fext[self._joint] = local
        power = local.vector @ self._data.v[self._joint].vector
        self._suspension.step(time, self._fext)
        acceleration = pin.aba(self._model, self._data, q, v, self._torque, self._fext)
        return np.concatenate([v, acceleration, [power]])

    def derivatives(
        self, time: float, motion: Vector, wrench: Vector
    ) -> tuple[Vector, Vector, Vector]:
        """Of the motion's rates: [12, 12] by the motion at a held wrench, [12, 6] by the wrench,
        [12] by time."""
        known = self.rates(time, motion, wrench)
        found = acceleration_derivatives(
            self._model,
            self._data,
            motion[:COUNT],
            motion[COUNT:],
            self._torque,
            self._fext,
            [self._carrier, self._suspension],
        )
        by_motion = np.zeros((MOTION, MOTION))
        by_motion[:COUNT, COUNT:] = np.eye(COUNT)
        by_motion[COUNT:] = np.hstack([found.by_q, found.by_v])
        # accelerations are linear in the wrench, so differences are exact
        columns = [self.rates(time, motion, wrench + unit) - known for unit in KILO * np.eye(6)]
        by_wrench = np.array(columns).T[:MOTION] / KILO
        return by_motion, by_wrench, np.append(np.zeros(COUNT), found.by_time)

    def advance(
        self, time: float, motion: Vector, step: float, wrench: Vector, slope: Vector | None = None
    ) -> tuple[Vector, float]:
        """Motion a step (s) later and the contact's work (J), by Kutta's method of order 4.

        The wrench is held, or changes by its slope (N/s, N m/s).
        """
        count = math.ceil(step / LONGEST * (1 - 1e-9))
        h = step / count
        slope = np.zeros(6) if slope is None else slope
        state = np.append(motion, 0.0)

        def rates(past: float, at: Vector) -> Vector:
            return self.rates(time + past, at[:MOTION], wrench + past * slope)

        for k in range(count):
            a = rates(k * h, state)
            b = rates((k + 0.5) * h, state + 0.5 * h * a)
            c = rates((k + 0.5) * h, state + 0.5 * h * b)
            d = rates((k + 1) * h, state + h * c)
            state = state + h / 6 * (a + 2 * b + 2 * c + d)
        return state[:MOTION], float(state[MOTION])

    def kick(
        self, time: float, motion: Vector, step: float, wrench: Vector
    ) -> tuple[Vector, float]:
        """The same in one go: velocities first, then positions with the new ones (Euler)."""
        rates = self.rates(time, motion, wrench)
        v = motion[COUNT:] + step * rates[COUNT:MOTION]
        moved = np.concatenate([motion[:COUNT] + step * v, v])
        # the power of the mean velocity is what the kinetic energy gets
        mean = np.concatenate([motion[:COUNT], 0.5 * (motion[COUNT:] + v)])
        return moved, step * power_of(mean, wrench)


def power_of(motion: Vector, wrench: Vector) -> float:
    """W, of a wrench at the wheelset's centre."""
    spin, _ = angular_velocity(motion)
    return float(wrench[:3] @ motion[COUNT : COUNT + 3] + wrench[3:] @ spin)


def power_by_motion(motion: Vector, wrench: Vector, by_motion: Vector) -> Vector:
    """[12], of the same, for a wrench with derivatives [6, 12]."""
    spin, spin_by_motion = angular_velocity(motion)
    found = np.concatenate([motion[COUNT : COUNT + 3], spin]) @ by_motion
    found[COUNT : COUNT + 3] += wrench[:3]
    return found + wrench[3:] @ spin_by_motion
