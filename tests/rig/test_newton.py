"""Newton's method on systems whose roots are known in closed form."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from rig_model.newton import Newton
from rig_model.search import Evaluation, Settings


def make(**changes) -> Newton:
    """A solver for two unknowns."""
    values = {
        "residual_scale": np.ones(2),
        "difference": np.full(2, np.nan),
        "step_limit": np.full(2, 10.0),
        "tolerance": 1e-10,
    }
    return Newton(Settings(**values | changes))


class Circle:
    """x^2 + y^2 = 5, x y = 2, with the root (2, 1); no value left of ``edge``."""

    def __init__(self, edge=-np.inf, *, solved=lambda x: True):
        self.edge, self.solved, self.points = edge, solved, []

    def __call__(self, x):
        self.points.append(x.copy())
        value = np.array([x @ x - 5, x[0] * x[1] - 2])
        slope = np.array([2 * x, x[::-1]])
        if x[0] < self.edge:
            return Evaluation(None)
        return Evaluation(value, self.solved(x), len(self.points), lambda: slope)


def test_converges_quadratically():
    circle = Circle()
    root = make().solve(circle, np.array([2.1, 0.9]))
    assert root.converged
    errors = [np.abs(point - [2, 1]).max() for point in circle.points]
    for before, after in pairwise(errors):
        # |e'| <= |J^-1| |f''|/2 |e|^2, here below 2 |e|^2
        assert after <= 2 * before**2 + 1e-15
    assert root.evaluations == len(circle.points) <= 5
    np.testing.assert_array_equal(circle.points[root.payload - 1], root.x)


def test_linear_system_takes_one_step():
    matrix = np.array([[4.0, 1.0], [1.0, 3.0]])
    root = make().solve(
        lambda x: Evaluation(matrix @ x - [1, 2], True, None, lambda: matrix), np.zeros(2)
    )
    assert root.converged
    assert root.evaluations == 2


def test_steps_are_limited():
    circle = Circle()
    make(step_limit=np.full(2, 0.05)).solve(circle, np.array([2.5, 0.5]))
    steps = np.abs(np.diff(circle.points, axis=0))
    assert steps.max() <= 0.05 * (1 + 1e-12)


def test_halves_steps_that_leave_the_range():
    """atan: from 3 Newton's method jumps to -9.5, where there is no value here."""
    points = []

    def bounded(x):
        points.append(x.copy())
        if np.abs(x).max() > 4:
            return Evaluation(None)
        return Evaluation(np.arctan(x), True, None, lambda: np.diag(1 / (1 + x**2)))

    root = make(step_limit=np.full(2, 100.0)).solve(bounded, np.array([3.0, 3.0]))
    assert np.abs(points).max() > 4
    assert root.converged
    np.testing.assert_allclose(root.x, 0, atol=1e-9)


def test_unsolved_points_are_no_roots():
    root = make().solve(Circle(solved=lambda _: False), np.array([2.1, 0.9]))
    assert not root.converged


def test_no_value_at_the_start():
    root = make().solve(Circle(edge=5.0), np.array([2.1, 0.9]))
    assert not root.converged
    assert root.residual is None
    assert root.evaluations == 1


def test_most_evaluations():
    circle = Circle()
    root = make(max_evaluations=2).solve(circle, np.array([5.0, -3.0]))
    assert not root.converged
    assert root.evaluations == len(circle.points) == 2
