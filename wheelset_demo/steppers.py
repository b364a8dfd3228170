"""Time steppers: explicit Runge-Kutta of order 4, linearly implicit Rosenbrock of order 2.

The creep forces damp the wheelset like f/(V m), with f some 1e7 N: the slower it runs, the stiffer
it is. Steps of rk4 (Kutta 1901) are bounded by 2.785 V/(f (1/m + r^2/I)), with the radius r and the
inertia I about the axle, and by 2.8 over the frequency at which the wheelset bounces on its
contacts, some 1500 rad/s. ros2 has no bound on these; its steps are chosen for accuracy.

ros2 (Verwer, Spee, Blom, Hundsdorfer, SIAM J. Sci. Comput. 20 (1999) 1456-1480) solves

    (I - gamma h A) k1 = f(y),   (I - gamma h A) k2 = f(y + h k1) - 2 k1,
    y <- y + 3/2 h k1 + 1/2 h k2,   gamma = 1 - 1/sqrt(2).

It is of order 2 for any matrix A and L-stable where A is the Jacobian of f, so that A may be an old
one. Exact derivatives cost two or three evaluations of the contact, those by differences a dozen.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Literal

import numpy as np

from wheelset_demo.system import COUNT, IMPULSES, WORKS, Rates, State, System, Vector

# parts of a state as one vector: motion, work, impulse, time
MOTION = 2 * COUNT
WORK = MOTION + len(WORKS)
TIME = WORK + len(IMPULSES)

GAMMA = 1 - 1 / math.sqrt(2)
# m, of differences: small against the approach of wheel and rail, some 1e-4 m
LENGTH = 1e-7
# -, of differences: small against the creepage at which friction is used up, some 1e-3
CREEPAGE = 1e-5
ARM = 0.75  # m, half the distance of the contacts: from lengths to angles, forces to moments


Derivatives = Callable[[System, State, Rates, float], Vector]


class Rk4:
    """Explicit Runge-Kutta method of order 4 with a fixed step (s)."""

    def __init__(self, system: System, step: float) -> None:
        self._system, self._step = system, step

    def step(self, state: State, rates: Rates) -> State:
        """The state one step on; rates: those at the state. Raises ContactFailure."""
        h, half = self._step, 0.5 * self._step
        stages = [rates]
        for share in (half, half, h):
            motion = state.motion + share * stages[-1].motion
            stages.append(self._system.rates(state.time + share, motion))
        weights = [h / 6, h / 3, h / 3, h / 6]
        change = sum(w * rates_of(k) for w, k in zip(weights, stages, strict=True))
        return moved_by(state, h, change)


class Ros2:
    """Linearly implicit Rosenbrock method of order 2 with a fixed step (s).

    every: steps between new derivatives of the accelerations. derivatives: what finds them.
    """

    def __init__(
        self,
        system: System,
        step: float,
        every: int = 25,
        derivatives: Derivatives | None = None,
    ) -> None:
        self._system, self._step, self._every = system, step, every
        self._derivatives = derivatives or by_differences
        self._age = 0
        self._inverse: Vector | None = None

    def step(self, state: State, rates: Rates) -> State:
        """The state one step on; rates: those at the state. Raises ContactFailure."""
        if self._inverse is None or self._age >= self._every:
            self._renew(state, rates)
        self._age += 1
        h = self._step
        first = self._inverse @ rates_of(rates)
        moved = self._system.rates(state.time + h, state.motion + h * first[:MOTION])
        second = self._inverse @ (rates_of(moved) - 2 * first)
        return moved_by(state, h, h * (1.5 * first + 0.5 * second))

    def _renew(self, state: State, rates: Rates) -> None:
        jacobian = self._derivatives(self._system, state, rates, self._step)
        self._inverse = np.linalg.inv(np.eye(TIME + 1) - GAMMA * self._step * jacobian)
        self._age = 0


def rates_of(rates: Rates) -> Vector:
    """[23], of motion, work, impulse and time."""
    return np.concatenate([rates.motion, rates.work, rates.impulse, [1.0]])


def moved_by(state: State, step: float, change: Vector) -> State:
    """The state a step (s) later."""
    motion, work = state.motion + change[:MOTION], state.work + change[MOTION:WORK]
    return State(state.time + step, motion, work, state.impulse + change[WORK:TIME])


def exactly(system: System, state: State, rates: Rates, time_step: float) -> Vector:
    """[23, 23], of the rates of motion, work, impulse and time with respect to these.

    Works and impulses are part of it: they are then integrated with the same stiff accuracy as the
    motion, or the balances would not close. So is time, because the suspension's reference moves.
    """
    jacobian = np.zeros((TIME + 1, TIME + 1))
    found = system.derivatives(state.motion)
    jacobian[:TIME, :MOTION], jacobian[:TIME, TIME] = found.by_motion, found.by_time
    return jacobian


def by_differences(system: System, state: State, rates: Rates, time_step: float) -> Vector:
    """The same by differences. Nothing depends on the pitch angle."""
    jacobian = np.zeros((TIME + 1, TIME + 1))
    known = rates_of(rates)
    for column, length in enumerate(differences(float(state.v[0]))):
        if length > 0:
            motion = state.motion.copy()
            motion[column] += length
            moved = system.rates(state.time, motion)
            jacobian[:, column] = (rates_of(moved) - known) / length
    moved = system.rates(state.time + time_step, state.motion)
    jacobian[:, TIME] = (rates_of(moved) - known) / time_step
    return jacobian


def differences(speed: float) -> list[float]:
    """[12], m, rad, m/s, rad/s; 0 where nothing depends on the coordinate."""
    rate = CREEPAGE * max(abs(speed), 1e-3)
    lengths = [LENGTH, LENGTH, LENGTH, LENGTH / ARM, CREEPAGE, 0.0]
    return [*lengths, rate, rate, rate, rate / ARM, rate / ARM, rate / ARM]


def make_stepper(
    name: str, system: System, step: float, every: int, derivatives: Literal["exact", "differences"]
) -> Rk4 | Ros2:
    """By the names in the scene."""
    if name == "rk4":
        return Rk4(system, step)
    return Ros2(system, step, every, exactly if derivatives == "exact" else by_differences)
