"""Broyden's method on systems whose roots are known in closed form."""

from __future__ import annotations

import numpy as np
import pytest

from rig_model.broyden import Broyden
from rig_model.search import Evaluation, Settings

MATRIX = np.array([[4.0, 1.0, 0.0], [1.0, 3.0, -1.0], [0.5, -1.0, 5.0]])


def make(**changes) -> Broyden:
    """A solver for three unknowns."""
    values = {
        "residual_scale": np.ones(3),
        "difference": np.full(3, 1e-4),
        "step_limit": np.full(3, 1.0),
        "tolerance": 1e-9,
    }
    return Broyden(Settings(**values | changes))


class Counted:
    """A function that counts its calls and keeps the points."""

    def __init__(self, function, *, solved=lambda x: True):
        self.function, self.solved, self.points = function, solved, []

    def __call__(self, x):
        self.points.append(x.copy())
        return Evaluation(self.function(x), self.solved(x), payload=len(self.points))


def curved(x, shift=0.0):
    """Root (2, 1, ln 3) for shift = 0."""
    return np.array(
        [x[0] ** 2 + x[1] ** 2 - 5 - shift, x[0] * x[1] - 2, np.exp(x[2]) - x[0] - x[1] - shift]
    )


def test_linear_system_takes_differences_and_one_step():
    f = Counted(lambda x: MATRIX @ x - np.array([0.3, -0.2, 0.1]))
    root = make().solve(f, np.zeros(3))
    assert root.converged
    np.testing.assert_allclose(MATRIX @ root.x, [0.3, -0.2, 0.1], atol=1e-9)
    # the start, three differences, the step; rounding in the differences may ask for one more
    assert root.evaluations == len(f.points) <= 6
    assert root.restarts == 0


def test_curved_system_finds_its_root():
    f = Counted(curved)
    root = make().solve(f, np.array([2.3, 0.8, 0.9]))
    assert root.converged
    np.testing.assert_allclose(root.x, [2, 1, np.log(3)], atol=1e-7)
    assert np.abs(root.residual).max() <= 1e-9
    assert root.evaluations == len(f.points) <= 16
    # the payload belongs to the root, not to a later point
    np.testing.assert_array_equal(f.points[root.payload - 1], root.x)


def test_next_solve_is_warm():
    solver = make()
    first = solver.solve(Counted(curved), np.array([2.3, 0.8, 0.9]))
    near = Counted(lambda x: curved(x, 1e-3))
    second = solver.solve(near, first.x)
    assert second.converged
    assert len(near.points) == second.evaluations <= 5
    cold = make().solve(Counted(lambda x: curved(x, 1e-3)), first.x)
    assert cold.evaluations > second.evaluations
    np.testing.assert_allclose(cold.x, second.x, atol=1e-8)


def test_step_is_the_secant_equation():
    """After a step the Jacobian explains the change that was seen, and nothing else changed."""
    solver = make(tolerance=1e-2)
    points = Counted(curved)
    solver.solve(points, np.array([2.05, 0.98, 1.08]))
    assert len(points.points) == 5  # start, differences, one step
    start, last = points.points[0], points.points[-1]
    before = np.column_stack([(curved(start + 1e-4 * e) - curved(start)) / 1e-4 for e in np.eye(3)])
    scale = 1 / np.linalg.norm(before, axis=0)
    step = (last - start) / scale
    np.testing.assert_allclose(solver.jacobian @ step, curved(last) - curved(start), rtol=1e-9)
    change = solver.jacobian - before * scale
    assert np.linalg.matrix_rank(change, tol=1e-9 * np.linalg.norm(change)) == 1


def test_restarts_where_the_jacobian_misleads():
    solver = make()
    solver.solve(Counted(lambda x: MATRIX @ x - 1), np.zeros(3))
    # another problem: the Jacobian that was kept leads uphill
    f = Counted(lambda x: -50 * MATRIX.T @ np.sinh(x) + 1)
    root = solver.solve(f, np.full(3, 0.4))
    assert root.converged
    assert np.abs(f.function(root.x)).max() <= 1e-9


def test_stalled_search_starts_anew():
    solver = make(residual_scale=np.ones(3), max_restarts=2)
    solver.solve(Counted(lambda x: MATRIX @ x - 1), np.zeros(3))
    solver.jacobian = np.diag([1e6, 1e6, 1e6])  # steps far too short
    root = solver.solve(Counted(lambda x: MATRIX @ x - 2), np.zeros(3))
    assert root.restarts >= 1
    assert root.converged


def test_singular_jacobian_is_no_error():
    solver = make()
    solver.solve(Counted(lambda x: MATRIX @ x - 1), np.zeros(3))
    solver.jacobian = np.zeros((3, 3))
    assert solver.solve(Counted(lambda x: MATRIX @ x - 2), np.zeros(3)).converged


@pytest.mark.parametrize("limit", [4, 5, 11, 40])
def test_without_root_it_fails_within_its_limit(limit):
    f = Counted(lambda x: np.array([x[0] ** 2 + 1, x[1], x[2]]))
    solver = make(max_evaluations=limit)
    root = solver.solve(f, np.full(3, 0.5))
    assert not root.converged
    assert root.evaluations == len(f.points) <= limit
    # what is given back is the best point that was seen
    best = min(np.abs(f.function(x)).max() for x in f.points)
    assert np.abs(root.residual).max() == best
    assert solver.jacobian is None


def test_value_that_is_not_solved_is_no_root():
    f = Counted(lambda x: MATRIX @ x - 1, solved=lambda x: False)
    root = make().solve(f, np.linalg.solve(MATRIX, np.ones(3)))
    assert not root.converged


def test_value_solved_at_the_second_try_is_a_root():
    f = Counted(lambda x: MATRIX @ x - 1)
    f.solved = lambda x: len(f.points) > 6
    root = make().solve(f, np.full(3, 0.1))
    assert root.converged
    assert root.payload > 6


def test_steps_stay_where_there_are_values():
    """Newton's first step from x = 0.05 would lead to where the logarithm has no value."""

    def f(x):
        return None if (x <= 0).any() else np.log(x) - np.array([0.0, 1.0, 2.0])

    counted = Counted(f)
    root = make(step_limit=np.full(3, 50.0)).solve(counted, np.array([4.0, 0.05, 30.0]))
    assert any((x <= 0).any() for x in counted.points)
    assert root.converged
    np.testing.assert_allclose(root.x, np.exp([0, 1, 2]), rtol=1e-7)


@pytest.mark.parametrize("value", [None, np.full(3, np.nan), np.full(3, np.inf)])
def test_start_without_value(value):
    root = make().solve(Counted(lambda x: value), np.zeros(3))
    assert not root.converged
    assert root.residual is None
    assert root.evaluations == 1


def test_start_that_is_not_finite_is_not_evaluated():
    f = Counted(lambda x: x)
    assert not make().solve(f, np.array([0.0, np.nan, 0.0])).converged
    assert f.points == []


def test_step_limit():
    f = Counted(lambda x: 1e-3 * (x - 10))
    limit = np.array([0.1, 0.2, 0.5])
    make(step_limit=limit, tolerance=1e-12, max_evaluations=12).solve(f, np.zeros(3))
    steps = np.abs(np.diff(f.points[4:], axis=0))
    assert (steps <= limit * (1 + 1e-9)).all()
    assert steps.max() > 0.05


def test_units_of_the_unknowns_do_not_matter():
    """Metres or micrometres: the same points are visited."""
    unit = np.array([1e6, 1e-3, 10.0])
    plain, other = Counted(curved), Counted(lambda x: curved(x / unit))
    start = np.array([2.3, 0.8, 0.9])
    make().solve(plain, start)
    make(difference=1e-4 * unit, step_limit=unit).solve(other, start * unit)
    assert len(plain.points) == len(other.points)
    np.testing.assert_allclose(np.array(other.points) / unit, plain.points, rtol=1e-7)
