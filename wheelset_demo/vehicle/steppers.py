"""Time steps: linearly implicit, of order 2 with any matrix, so that it may be an old one.

The wheels bounce on their contacts at some 1500 rad/s and creep forces damp like f/(V m): stiff at
steps of 1 ms. With A and G, the derivatives of f(y, u) by y and by the rails' deviations u at some
earlier state, and u known ahead:

bdf2, one evaluation of f a step: backward differences of A (y - y*) + G (u - u*), the rest of f
extrapolated (Ascher, Ruuth, Wetton, SIAM J. Numer. Anal. 32 (1995) 797-823). With d the change of y
in a step, d' that of the step before,

    (I - 2/3 h A) (d - d') = 2/3 (h (2 f_n - f_n-1 + G (u_n+1 - 2 u_n + u_n-1)) - d').

Where A is exact it is BDF2, L-stable. A stiffness off by a part e (true = (1 + e) A) is stable for
-1 <= e <= 1/3, as the roots of x^2 + e (2 x - 1), the stiff limit, show.

ros2, two evaluations: as wheelset_demo.steppers, with the term of the rates of u.
"""

from __future__ import annotations

import math
from typing import Protocol

import numpy as np

from wheelset_demo.vehicle.system import Rates, Vector, VehicleState, VehicleSystem

GAMMA = 1 - 1 / math.sqrt(2)


class Stepper(Protocol):
    """Makes a state of the one before."""

    def step(self, state: VehicleState, rates: Rates) -> tuple[VehicleState, Rates]:
        """The state a step later with its rates. Raises ContactFailure."""


class Implicit:
    """What both share: the matrix and when it is made anew."""

    def __init__(self, system: VehicleSystem, step: float, every: int, weight: float) -> None:
        self._system, self._step, self._every, self._weight = system, step, every, weight
        self._age = 0
        self._inverse = np.zeros((0, 0))
        self._inputs = np.zeros((0, 0))

    def _keep_fresh(self, values: Vector) -> None:
        """New derivatives where they are old; values: whose rates were the last ones."""
        if self._age % self._every == 0:
            matrix, self._inputs = self._system.derivatives(values)
            self._inverse = inverse_of(matrix, self._weight * self._step, self._system.count)
        self._age += 1

    def _arrived(
        self, state: VehicleState, rates: Rates, change: Vector
    ) -> tuple[VehicleState, Rates]:
        """The next state and its rates; works by the trapezoidal rule."""
        time, values = state.time + self._step, state.values + change
        found = self._system.rates(time, values)
        work = state.work + 0.5 * self._step * (rates.powers + found.powers)
        return VehicleState(time, values, work, state.count), found


def inverse_of(matrix: Vector, step: float, count: int) -> Vector:
    """[size, size], of 1 - step matrix, whose rows of coordinates say that rates are velocities.

    By eliminating them, and the forces of dampers, whose own part is a diagonal: what is left to
    invert is [count, count].
    """
    v, series = slice(count, 2 * count), slice(2 * count, None)
    size = len(matrix)
    changed = step * matrix
    loss = 1.0 / (1.0 - np.diagonal(changed)[series])
    to_v = changed[v, series] * loss
    left = np.eye(count) - changed[v, v] - step * changed[v, :count] - to_v @ changed[series, v]
    found = np.zeros((size, size))
    found[v] = np.linalg.inv(left) @ np.hstack([changed[v, :count], np.eye(count), to_v])
    found[:count] = step * found[v]
    found[:count, :count] += np.eye(count)
    found[series] = loss[:, None] * (changed[series, v] @ found[v])
    found[series, series] += np.diag(loss)
    return found


class Bdf2(Implicit):
    """One evaluation a step; the first step is one of ros2."""

    def __init__(self, system: VehicleSystem, step: float, every: int) -> None:
        super().__init__(system, step, every, 2 / 3)
        self._first = Ros2(system, step, 1)
        self._before: tuple[Vector, Rates] | None = None

    def step(self, state: VehicleState, rates: Rates) -> tuple[VehicleState, Rates]:
        """The state a step later with its rates. Raises ContactFailure."""
        if self._before is None:
            found = self._first.step(state, rates)
            self._before = (found[0].values - state.values, rates)
            return found
        h = self._step
        self._keep_fresh(state.values)
        last, older = self._before
        ahead = self._system.inputs_ahead(state.values, h)
        bend = self._inputs @ (ahead - 2 * rates.inputs + older.inputs)
        known = h * (2 * rates.values - older.values + bend) - last
        change = last + (2 / 3) * (self._inverse @ known)
        self._before = (change, rates)
        return self._arrived(state, rates, change)


class Ros2(Implicit):
    """Two evaluations a step."""

    def __init__(self, system: VehicleSystem, step: float, every: int) -> None:
        super().__init__(system, step, every, GAMMA)

    def step(self, state: VehicleState, rates: Rates) -> tuple[VehicleState, Rates]:
        """The state a step later with its rates. Raises ContactFailure."""
        h, system = self._step, self._system
        self._keep_fresh(state.values)
        ahead = system.inputs_ahead(state.values, h)
        moving = GAMMA * (self._inputs @ (ahead - rates.inputs))
        first = self._inverse @ (rates.values + moving)
        moved = system.rates(state.time + h, state.values + h * first)
        second = self._inverse @ (moved.values - 2 * first - moving)
        return self._arrived(state, rates, h * (1.5 * first + 0.5 * second))


def make_stepper(system: VehicleSystem) -> Stepper:
    """As the scene says."""
    run = system.scene.run
    kinds = {"bdf2": Bdf2, "ros2": Ros2}
    return kinds[run.stepper](system, run.step, run.derivatives_every)
