"""Splines and functions of fixed order beside scipy's and numpy's."""

from __future__ import annotations

import numpy as np
import pytest
from railpatch.profiles import elementary
from railpatch.profiles.spline import cubic_spline, slopes, smoothed_values, solve_tridiagonal
from scipy.interpolate import CubicSpline, make_smoothing_spline

RANDOM = np.random.default_rng(11)


@pytest.mark.parametrize("count", [2, 3, 4, 5, 60])
@pytest.mark.parametrize(
    ("ends", "theirs"),
    [
        ("natural", "natural"),
        ((0.0, 0.0), "clamped"),
        ((0.7, -1.3), ((1, [0.7] * 3), (1, [-1.3] * 3))),
        ("periodic", "periodic"),
    ],
)
def test_splines_are_those_of_scipy(count: int, ends: object, theirs: object) -> None:
    # fewer than three intervals have no period of their own: wheels have 8 points and more
    count = max(count, 4) if ends == "periodic" else count
    x = np.cumsum(RANDOM.uniform(0.2, 1.8, count))
    y = RANDOM.standard_normal((count, 3))
    y[-1] = y[0]
    ours, reference = cubic_spline(x, y, ends), CubicSpline(x, y, bc_type=theirs)
    at = np.linspace(x[0], x[-1], 501)
    for order in (0, 1, 2):
        np.testing.assert_allclose(ours(at, order), reference(at, order), rtol=0, atol=2e-12)
    np.testing.assert_allclose(slopes(x, y, ends), reference(x, 1), rtol=0, atol=1e-12)
    np.testing.assert_array_equal(slopes(x, y[:, 0], ends), slopes(x, y, ends)[:, 0])


@pytest.mark.parametrize("stiffness", [1e-9, 1e-4, 1.0, 1e3])
def test_smoothing_is_that_of_scipy(stiffness: float) -> None:
    x = np.cumsum(RANDOM.uniform(0.2, 1.8, 80))
    y, weight = RANDOM.standard_normal(80), RANDOM.uniform(0.1, 2.0, 80)
    reference = make_smoothing_spline(x, y, w=weight, lam=stiffness)(x)
    ours = smoothed_values(x, y, weight, stiffness)
    np.testing.assert_allclose(ours, reference, rtol=0, atol=1e-9)


def test_smoothing_leaves_a_line_alone() -> None:
    x = np.cumsum(RANDOM.uniform(0.2, 1.8, 30))
    line = 3.0 - 0.5 * x
    np.testing.assert_allclose(smoothed_values(x, line, np.ones(30), 10.0), line, atol=1e-12)


def test_elimination_solves() -> None:
    lower, upper = RANDOM.uniform(-1, 1, (2, 9))
    middle, right = RANDOM.uniform(3, 4, 10), RANDOM.standard_normal(10)
    matrix = np.diag(middle) + np.diag(lower, -1) + np.diag(upper, 1)
    found = solve_tridiagonal(*(v.tolist() for v in (lower, middle, upper, right)))
    np.testing.assert_allclose(matrix @ found, right, atol=1e-13)


def test_functions_are_those_of_numpy() -> None:
    x = RANDOM.uniform(-1, 1, (7, 5))
    for name, theirs in (
        ("sin", np.sin), ("cos", np.cos), ("tan", np.tan),
        ("asin", np.arcsin), ("acos", np.arccos), ("atan", np.arctan),
    ):  # fmt: skip
        ours = getattr(elementary, name)
        np.testing.assert_allclose(ours(x), theirs(x), rtol=1e-15, atol=1e-16)
        np.testing.assert_allclose(ours(x.T), theirs(x.T), rtol=1e-15, atol=1e-16)
        assert float(ours(0.3)) == pytest.approx(float(theirs(0.3)), rel=1e-15)
    np.testing.assert_allclose(elementary.hypot(x, 2.0), np.hypot(x, 2.0), rtol=1e-15)
    assert float(elementary.hypot(3.0, 4.0)) == 5.0


@pytest.mark.parametrize(("rule", "points"), [(elementary.GAUSS_5, 5), (elementary.GAUSS_8, 8)])
def test_quadratures_are_gauss_and_legendres(rule: tuple, points: int) -> None:
    nodes, weights = np.polynomial.legendre.leggauss(points)
    np.testing.assert_allclose(rule[0], nodes, rtol=0, atol=3e-16)
    # numpy's weights are a quotient of small differences
    np.testing.assert_allclose(rule[1], weights, rtol=0, atol=1e-14)
    # exact to the degree 2 n - 1
    for degree in range(2 * points):
        exact = (1 - (-1) ** (degree + 1)) / (degree + 1)
        total = elementary.weighted_sum(np.array(rule[0]) ** degree, rule[1])
        assert float(total) == pytest.approx(exact, abs=1e-15)
