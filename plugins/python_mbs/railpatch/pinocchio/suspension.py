"""Springs and dampers between a wheelset and a reference that moves along the track."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Protocol

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from railpatch.pinocchio.derivative import ROLL, YAW, StateChain, WrenchDerivatives
from railpatch.pinocchio.element import STATE

DIRECTIONS = ("x", "y", "z", "roll", "yaw")
# columns of the element's states
POSITION = slice(0, 5)
RATES = [6, 7, 8, 9, 10]


class Carried(Protocol):
    """What a suspension wants of the force element of its wheelset; see ForceElement."""

    joints: list[int]
    frame_speed: float

    @property
    def states(self) -> NDArray[np.float64]:
        """[wheelsets, 12]."""

    def place(self, index: int, force: Sequence[float], moment: Sequence[float]) -> NDArray:
        """[6]."""


class Suspension:
    """A primary suspension: linear springs and dampers to a frame at constant speed.

    element: the force element of the wheelset; its step() comes first. stiffness: N/m for "x", "y",
    "z", N m/rad for "roll", "yaw"; damping: N s/m, N m s/rad; what is left out is 0. index: of the
    wheelset in the element. reference: m, rad, where the springs are free of force, by the same
    names; its x moves on with ``speed`` (m/s, on the track). preload: N, constant force on the
    wheelset, down.

    The force acts at the wheelset's centre through bearings without friction: there is no moment
    about the axle. Moments are those of the generalised coordinates roll and yaw: with angular
    velocity w, M.w = m_roll roll_rate + m_yaw yaw_rate; to first order they are about x and z.
    Stiffness and reference belong to small angles; the energy is exact at any.
    Raises ValueError for unknown names and values that are not finite.
    """

    def __init__(
        self,
        element: Carried,
        stiffness: Mapping[str, float],
        damping: Mapping[str, float],
        *,
        index: int = 0,
        reference: Mapping[str, float] | None = None,
        speed: float = 0.0,
        preload: float = 0.0,
    ) -> None:
        self._element, self._index = element, index
        self._joint = element.joints[index]
        self._stiffness = values_of("stiffness", stiffness, least=0.0)
        self._damping = values_of("damping", damping, least=0.0)
        self._reference = values_of("reference", reference or {})
        self.speed, self.preload = float(speed), float(preload)
        self._deflection = np.zeros(5)
        self._rates = np.zeros(5)
        self._force = np.zeros(5)

    def step(self, time: float, fext: pin.StdVec_Force) -> None:
        """Adds the suspension's force to ``fext``; time: s, since the reference was at x = 0."""
        state = self._element.states[self._index]
        self._deflection = state[POSITION] - self._reference
        self._deflection[0] -= (self.speed - self._element.frame_speed) * time
        self._rates = state[RATES]
        self._rates[0] -= self.speed
        self._force = -self._stiffness * self._deflection - self._damping * self._rates
        self._force[2] += self.preload
        wrench = self._element.place(self._index, *wrench_of(self._force, state[3], state[4]))
        vector = fext[self._joint].vector
        vector += wrench

    def wrench_by_state(self) -> NDArray[np.float64]:
        """[6, 12], of the wrench at the centre in track axes at the last step, columns STATE."""
        by_force = np.zeros((5, len(STATE)))
        by_force[:, POSITION] = -np.diag(self._stiffness)
        by_force[:, RATES] = -np.diag(self._damping)
        m_roll, m_yaw = self._force[3:].tolist()
        roll, yaw = self._element.states[self._index][[ROLL, YAW]].tolist()
        c, s, level = math.cos(roll), math.sin(roll), math.cos(yaw)
        across = m_roll * math.tan(yaw)
        found = np.zeros((6, len(STATE)))
        found[:3], found[3] = by_force[:3], by_force[3]
        found[4] = c * math.tan(yaw) * by_force[3] - s * by_force[4]
        found[5] = s * math.tan(yaw) * by_force[3] + c * by_force[4]
        found[4:, ROLL] += [-across * s - m_yaw * c, across * c - m_yaw * s]
        found[4:, YAW] += [m_roll * c / level**2, m_roll * s / level**2]
        return found

    @property
    def wrench_by_time(self) -> NDArray[np.float64]:
        """[6], N/s, N m/s: of the same by time at a held state, as the reference moves on."""
        moving = self._stiffness[0] * (self.speed - self._element.frame_speed)
        return np.array([moving, 0.0, 0.0, 0.0, 0.0, 0.0])

    @property
    def wrench(self) -> NDArray[np.float64]:
        """[6], N, N m: at the centre in track axes, of the last step."""
        state = self._element.states[self._index]
        force, moment = wrench_of(self._force, state[ROLL], state[YAW])
        return np.array([*force, *moment])

    def wrench_derivatives(self, chain: StateChain) -> list[WrenchDerivatives]:
        """Of the wrench at the last step; see acceleration_derivatives()."""
        states = chain.of(self._element, self._index)
        return [states.wrench(self.wrench, self.wrench_by_state(), self.wrench_by_time)]

    def power_derivatives(self) -> NDArray[np.float64]:
        """[2, 12], W over units of STATE: of damping_power and drive_power at the last step."""
        found = np.zeros((2, len(STATE)))
        found[0, RATES] = 2 * self._damping * self._rates
        found[1] = self.speed * self.wrench_by_state()[0]
        return found

    @property
    def force(self) -> NDArray[np.float64]:
        """[5], N, N m: on the wheelset at the last step, by DIRECTIONS."""
        return self._force

    @property
    def potential(self) -> float:
        """J, of springs and preload at the last step."""
        springs = 0.5 * float(self._stiffness @ self._deflection**2)
        return springs - self.preload * float(self._deflection[2])

    @property
    def damping_power(self) -> float:
        """W, taken by the dampers, >= 0."""
        return float(self._damping @ self._rates**2)

    @property
    def drive_power(self) -> float:
        """W, that the moving reference puts in: its speed times the force it pulls with."""
        return self.speed * float(self._force[0])


def wrench_of(
    force: NDArray[np.float64], roll: float, yaw: float
) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Force [3] (N) and moment [3] (N m) in track axes of generalised forces [5].

    M.e_x = m_roll, M.h = m_yaw with the yaw axis h = (0, -sin roll, cos roll), and M.a = 0 with the
    axle's direction a; with g = (0, cos roll, sin roll) that is M = m_roll (e_x + tan yaw g) +
    m_yaw h.
    """
    x, y, z, m_roll, m_yaw = force.tolist()
    c, s = math.cos(roll), math.sin(roll)
    across = m_roll * math.tan(yaw)
    return (x, y, z), (m_roll, across * c - m_yaw * s, across * s + m_yaw * c)


def values_of(
    name: str, given: Mapping[str, float], least: float = -math.inf
) -> NDArray[np.float64]:
    """[5], by DIRECTIONS. Raises ValueError."""
    for key, value in given.items():
        if key not in DIRECTIONS:
            raise ValueError(f"{name}.{key}: the key is unknown, allowed {', '.join(DIRECTIONS)}")
        if not math.isfinite(value) or value < least:
            raise ValueError(f"{name}.{key}: value is {value}, allowed a finite number >= {least}")
    return np.array([float(given.get(key, 0.0)) for key in DIRECTIONS])
