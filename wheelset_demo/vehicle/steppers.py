"""Time steps: linearly implicit, of order 2 with any matrix, so that it may be an old one.

The wheels bounce on their contacts at 1150 to 1330 rad/s and creep forces damp like f/(V m): stiff
at steps of 1 ms. With A and G, the derivatives of f(y, u) by y and by u, what the rails do, at some
earlier state, and u known ahead:

bdf2, one evaluation of f a step: backward differences of A (y - y*) + G (u - u*), the rest of f
extrapolated (Ascher, Ruuth, Wetton, SIAM J. Numer. Anal. 32 (1995) 797-823). With d the change of y
in a step, d' that of the step before,

    (I - 2/3 h A) (d - d') = 2/3 (h (2 f_n - f_n-1 + G (u_n+1 - 2 u_n + u_n-1)) - d').

Where A is exact it is BDF2, L-stable. A stiffness off by a part e (true = (1 + e) A) is stable for
-1 <= e <= 1/3, as the roots of x^2 + e (2 x - 1), the stiff limit, show. What the new rates differ
by from the ones that the step assumed says when that is about to be left: a wheelset's lateral or
vertical acceleration off by more than SURPRISE asks for new derivatives at once.

u takes part with what the track's own bends move the rails by, or contacts would seem to be pushed
out of a curve: a stiffness times the way that the vehicle turns off in a step.

ros2, two evaluations: as wheelset_demo.steppers, with the term of the rates of u. Its matrix sees
velocities, not their changes, and so wants one of the same heading: it makes the first step, on
straight track with derivatives of that moment.
"""

from __future__ import annotations

import numpy as np

from wheelset_demo.steppers import GAMMA
from wheelset_demo.vehicle.system import Rates, Vector, VehicleState, VehicleSystem

# m/s^2, of a wheelset: some tenth of its load over its mass
SURPRISE = 6.0


class Implicit:
    """What both share: the matrix and when it is made anew."""

    def __init__(self, system: VehicleSystem, step: float, every: int, weight: float) -> None:
        self._system, self._step, self._every, self._weight = system, step, every, weight
        self._age = 0
        # wheelsets whose contacts' derivatives are known to be wrong
        self._wrong: list[int] = list(range(system.wheelsets))
        self._matrix = self._inverse = self._inputs = np.zeros((0, 0))

    def _keep_fresh(self, values: Vector) -> None:
        """New derivatives where they are old; values: whose rates were the last ones."""
        if self._age >= self._every:
            self._age, self._wrong = 0, list(range(self._system.wheelsets))
        if self._wrong:
            self._matrix, self._inputs = self._system.derivatives(values, self._wrong)
            weight = self._weight * self._step
            self._inverse = inverse_of(self._matrix, weight, self._system.count)
            self._wrong = []
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
        self._watched = system.count + system.vehicle.carriers[:, 1:3].ravel()
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
        ahead, off = self._system.look_ahead(state.values, h)
        bend = self._inputs @ (ahead - 2 * rates.inputs + older.inputs + off)
        known = 2 * rates.values - older.values + bend
        change = last + (2 / 3) * (self._inverse @ (h * known - last))
        self._before = (change, rates)
        found = self._arrived(state, rates, change)
        rows = self._watched
        assumed = known[rows] + self._matrix[rows] @ (change - last)
        away = np.abs(found[1].values[rows] - assumed).reshape(-1, 2).max(axis=1)
        self._wrong = np.flatnonzero(away > SURPRISE).tolist()
        return found


class Ros2(Implicit):
    """Two evaluations a step."""

    def __init__(self, system: VehicleSystem, step: float, every: int) -> None:
        super().__init__(system, step, every, GAMMA)

    def step(self, state: VehicleState, rates: Rates) -> tuple[VehicleState, Rates]:
        """The state a step later with its rates. Raises ContactFailure."""
        h, system = self._step, self._system
        self._keep_fresh(state.values)
        ahead, _ = system.look_ahead(state.values, h)
        moving = GAMMA * (self._inputs @ (ahead - rates.inputs))
        first = self._inverse @ (rates.values + moving)
        moved = system.rates(state.time + h, state.values + h * first)
        second = self._inverse @ (moved.values - 2 * first - moving)
        return self._arrived(state, rates, h * (1.5 * first + 0.5 * second))
