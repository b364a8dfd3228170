"""Cubic splines through points and near them, by eliminations in a fixed order.

Linear algebra libraries choose their kernels by the processor; here each number is made by the same
operations everywhere.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import scipy
from numpy.typing import NDArray

Array = NDArray[np.float64]
# slopes at both ends, or "natural": no curvature there, or "periodic"
Ends = tuple[float, float] | str


def cubic_spline(x: Array, values: Array, ends: Ends) -> scipy.interpolate.CubicHermiteSpline:
    """The C2 cubic spline through values [n] or [n, m] at increasing x."""
    return scipy.interpolate.CubicHermiteSpline(x, values, slopes(x, values, ends))


def slopes(x: Array, values: Array, ends: Ends) -> Array:
    """Of that spline at its knots, shaped as the values."""
    if values.ndim > 1 and ends == "natural":
        return _natural_slopes(x, values)
    columns = values.reshape(len(values), -1).T
    found = [_slopes(x, column, ends) for column in columns]
    return np.array(found).T.reshape(values.shape)


def _slopes(x: Array, y: Array, ends: Ends) -> list[float]:
    h = np.diff(x)
    rise = np.diff(y) / h
    if ends == "periodic":
        return _periodic(h, rise)
    # continuous second derivatives: h1 s0 + 2 (h0 + h1) s1 + h0 s2 = 3 (h1 m0 + h0 m1)
    lower, upper = [*h[1:].tolist()], [*h[:-1].tolist()]
    middle = (2 * (h[:-1] + h[1:])).tolist()
    right = (3 * (h[1:] * rise[:-1] + h[:-1] * rise[1:])).tolist()
    if isinstance(ends, str):
        first, last = (2.0, 1.0, 3 * float(rise[0])), (1.0, 2.0, 3 * float(rise[-1]))
    else:
        first, last = (1.0, 0.0, ends[0]), (0.0, 1.0, ends[1])
    return solve_tridiagonal(
        [*lower, last[0]],
        [first[0], *middle, last[1]],
        [first[1], *upper],
        [first[2], *right, last[2]],
    )


def _natural_slopes(x: Array, y: Array) -> Array:
    """Of many columns, a row at once."""
    h = np.diff(x)
    wide = h[:, None]
    rise = np.diff(y, axis=0) / wide
    right = 3 * (wide[1:] * rise[:-1] + wide[:-1] * rise[1:])
    return np.array(
        solve_tridiagonal(
            [*h[1:].tolist(), 1.0],
            [2.0, *(2 * (h[:-1] + h[1:])).tolist(), 2.0],
            [1.0, *h[:-1].tolist()],
            [3 * rise[0], *right, 3 * rise[-1]],
        )
    )


def _periodic(h: Array, rise: Array) -> list[float]:
    """The last value is the first: the cyclic matrix is a tridiagonal one and a product of two
    vectors (Sherman and Morrison 1950)."""
    before, rise_before = np.roll(h, 1), np.roll(rise, 1)
    lower, upper = h.tolist(), before.tolist()
    middle = (2 * (before + h)).tolist()
    right = (3 * (h * rise_before + before * rise)).tolist()
    shift = -middle[0]
    middle[-1] -= lower[0] * upper[-1] / shift
    middle[0] -= shift
    corner = [0.0] * len(right)
    corner[0], corner[-1] = shift, upper[-1]
    one = solve_tridiagonal(lower[1:], middle, upper[:-1], right)
    two = solve_tridiagonal(lower[1:], middle, upper[:-1], corner)
    ratio = lower[0] / shift
    share = (one[0] + ratio * one[-1]) / (1.0 + two[0] + ratio * two[-1])
    found = [a - share * b for a, b in zip(one, two, strict=True)]
    return [*found, found[0]]


def solve_tridiagonal(
    lower: Sequence[float], middle: Sequence[float], upper: Sequence[float], right: Sequence[Any]
) -> list[Any]:
    """Elimination without exchange of rows, for matrices whose diagonal prevails; right: numbers or
    rows of them."""
    pivot, value = [middle[0]], [right[0]]
    for a, b, c, d in zip(lower, middle[1:], upper, right[1:], strict=True):
        factor = a / pivot[-1]
        pivot.append(b - factor * c)
        value.append(d - factor * value[-1])
    found = [value[-1] / pivot[-1]]
    for p, v, c in zip(pivot[-2::-1], value[-2::-1], reversed(upper), strict=True):
        found.append((v - c * found[-1]) / p)
    return found[::-1]


def smoothed_values(x: Array, y: Array, weight: Array, stiffness: float) -> Array:
    """At the knots, f with the least sum weight (y - f)^2 + stiffness integral f''^2; y [n] or
    [n, m].

    Second derivatives g of the natural spline solve (R + stiffness Q' W^-1 Q) g = Q' y, and
    f = y - stiffness W^-1 Q g (Reinsch 1967), with five diagonals, positive definite.
    """
    h = np.diff(x)
    inverse = stiffness / weight
    # column j of Q: a_j, b_j, c_j in rows j, j + 1, j + 2
    a, c = 1 / h[:-1], 1 / h[1:]
    b = -a - c
    middle = (h[:-1] + h[1:]) / 3 + inverse[:-2] * a * a + inverse[1:-1] * b * b
    middle = middle + inverse[2:] * c * c
    beside = h[1:-1] / 6 + inverse[1:-2] * b[:-1] * a[1:] + inverse[2:-1] * c[:-1] * b[1:]
    after = inverse[2:-2] * c[:-2] * a[2:]
    if y.ndim > 1:
        a, b, c, inverse = a[:, None], b[:, None], c[:, None], inverse[:, None]
    right = a * y[:-2] + b * y[1:-1] + c * y[2:]
    rows = right.tolist() if y.ndim == 1 else list(right)
    g = np.array(_solve_five(middle.tolist(), beside.tolist(), after.tolist(), rows))
    bent = np.zeros_like(y)
    bent[:-2] += a * g
    bent[1:-1] += b * g
    bent[2:] += c * g
    return y - inverse * bent


def _solve_five(
    middle: list[float], beside: list[float], after: list[float], right: list[Any]
) -> list[Any]:
    """A symmetric positive definite matrix of five diagonals as L D L'; right: numbers or rows."""
    count = len(middle)
    pivot, one, two = [0.0] * count, [0.0] * count, [0.0] * count
    value = list(right)
    for i in range(count):
        pivot[i] = middle[i]
        if i > 0:
            pivot[i] -= one[i - 1] * one[i - 1] * pivot[i - 1]
            value[i] = value[i] - one[i - 1] * value[i - 1]
        if i > 1:
            pivot[i] -= two[i - 2] * two[i - 2] * pivot[i - 2]
            value[i] = value[i] - two[i - 2] * value[i - 2]
        if i + 1 < count:
            crossed = one[i - 1] * two[i - 1] * pivot[i - 1] if i > 0 else 0.0
            one[i] = (beside[i] - crossed) / pivot[i]
        if i + 2 < count:
            two[i] = after[i] / pivot[i]
    found: list[Any] = [v / p for v, p in zip(value, pivot, strict=True)]
    for i in range(count - 2, -1, -1):
        found[i] = found[i] - one[i] * found[i + 1]
        if i + 2 < count:
            found[i] = found[i] - two[i] * found[i + 2]
    return found
