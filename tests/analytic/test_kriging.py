"""What a shape's features tell of the functions of a table: kriging against its own equations."""

from __future__ import annotations

import numpy as np
import pytest
from railpatch.evidence.table.kriging import (
    Lengths,
    covariance,
    find_lengths,
    solved,
    weights_of,
)
from railpatch.evidence.table.pair import fall_of, shape


def nodes(count: int, seed: int = 1) -> tuple[np.ndarray, np.ndarray]:
    """Two features that count and one that does not, and two amounts."""
    x = np.random.default_rng(seed).uniform(-1.0, 1.0, (count, 3))
    return x, np.column_stack([np.sin(3 * x[:, 0]) + x[:, 1], 0.2 * x[:, 0] * x[:, 1] + 0.1])


def system(x: np.ndarray, lengths: Lengths) -> np.ndarray:
    """Of ordinary kriging with its Lagrange multiplier (Cressie 1993, eq. 3.2.16)."""
    n = len(x)
    found = np.zeros((n + 1, n + 1))
    at = x / lengths.length
    distance = np.linalg.norm(at[:, None] - at[None], axis=2).clip(max=1.0)
    found[:n, :n] = (1 - distance) ** 4 * (4 * distance + 1) + lengths.noise * np.eye(n)
    found[:n, n] = found[n, :n] = 1.0
    return found


def test_weights_solve_the_kriging_system() -> None:
    x, amounts = nodes(25)
    lengths = Lengths(np.array([2.0, 3.0, 9.0]), 1e-4)
    mean, weight = weights_of(x, amounts, lengths)
    wanted = np.linalg.solve(system(x, lengths), np.vstack([amounts, np.zeros((1, 2))]))
    assert weight == pytest.approx(wanted[:-1], rel=1e-8, abs=1e-10)
    assert mean == pytest.approx(wanted[-1], rel=1e-8)
    # nodes that know all of themselves are met
    exact = Lengths(lengths.length, 1e-12)
    mean, weight = weights_of(x, amounts, exact)
    at = x / exact.length
    assert covariance(at, at) @ weight + mean == pytest.approx(amounts, abs=1e-8)
    # far from all of them the mean is left
    assert covariance(at[:1] + 5.0, at).max() == 0


def test_what_is_left_out_is_told_by_the_others() -> None:
    x, amounts = nodes(20)
    lengths = Lengths(np.array([2.0, 3.0, 9.0]), 1e-3)
    _, rest = solved(x, lengths)
    left = rest @ amounts / np.diag(rest)[:, None]
    for i in (0, 7, 19):
        others = np.arange(20) != i
        mean, weight = weights_of(x[others], amounts[others], lengths)
        told = covariance(x[i : i + 1] / lengths.length, x[others] / lengths.length) @ weight
        assert amounts[i] - told[0] - mean == pytest.approx(left[i], rel=1e-7, abs=1e-10)


def test_lengths_tell_which_features_count() -> None:
    x, amounts = nodes(60)
    found = find_lengths(x, amounts, None)
    assert found.length[2] > 5 * found.length[0]
    mean, weight = weights_of(x, amounts, found)
    new, wanted = nodes(200, 2)
    told = covariance(new / found.length, x / found.length) @ weight + mean
    assert np.std(told - wanted, axis=0) == pytest.approx(0.0, abs=0.03)


def test_rows_tell_of_two_parts() -> None:
    y = np.linspace(-1.0, 1.0, 41)
    x = np.linspace(-1.0, 1.0, 40)
    hertz = np.sqrt(np.maximum(1 - x**2 - (y / 0.95)[:, None] ** 2, 0.0))
    assert fall_of(hertz) == 1.0
    # of a semi-ellipsoid the integral of the rows' squared load is 3/5 over b
    assert shape(x, y, hertz)[2][7] == pytest.approx(np.log(0.6), abs=0.01)
    rows = np.array([0, 1.0, 4.0, 0.5, 2.0, 1.0, 0.0])
    assert fall_of(np.outer(rows, np.ones(3))) == pytest.approx(0.25)
