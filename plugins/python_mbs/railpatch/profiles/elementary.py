"""Functions whose results are the same on every computer: the core's, and sums in a fixed order.

numpy and the system choose theirs by the processor, and so does the linear algebra behind ``@``,
scipy's splines and numpy's quadratures: what the core is given is made with these instead. Of numpy
remain single operations, +, -, *, / and square roots, which are rounded in one way.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from railpatch._core import apply, apply_hypot

Array = NDArray[np.float64]

# Gauss and Legendre's points in -1 ... 1, and weights
GAUSS_5 = (
    (-0.9061798459386640, -0.5384693101056831, 0.0, 0.5384693101056831, 0.9061798459386640),
    (
        0.23692688505618908,
        0.47862867049936647,
        0.5688888888888889,
        0.47862867049936647,
        0.23692688505618908,
    ),
)
_OUTER = (0.9602898564975363, 0.7966664774136267, 0.5255324099163290, 0.1834346424956498)
_SHARES = (0.10122853629037626, 0.22238103445337448, 0.31370664587788727, 0.36268378337836198)
GAUSS_8 = (
    (*(-node for node in _OUTER), *reversed(_OUTER)),
    (*_SHARES, *reversed(_SHARES)),
)


def _of(name: str, x: ArrayLike) -> Any:
    values = np.array(x, dtype=float)
    flat = values.reshape(-1)
    apply(name, flat)
    return flat.reshape(values.shape)[()]


def sin(x: ArrayLike) -> Any:
    """Of numbers of any shape, like those below."""
    return _of("sin", x)


def cos(x: ArrayLike) -> Any:
    """-"""
    return _of("cos", x)


def tan(x: ArrayLike) -> Any:
    """-"""
    return _of("tan", x)


def asin(x: ArrayLike) -> Any:
    """rad"""
    return _of("asin", x)


def acos(x: ArrayLike) -> Any:
    """rad"""
    return _of("acos", x)


def atan(x: ArrayLike) -> Any:
    """rad"""
    return _of("atan", x)


def hypot(x: ArrayLike, y: ArrayLike) -> Any:
    """Length of the pairs."""
    first, second = np.broadcast_arrays(np.asarray(x, dtype=float), np.asarray(y, dtype=float))
    flat = first.flatten()
    apply_hypot(flat, second.flatten())
    return flat.reshape(first.shape)[()]


def weighted_sum(values: Array, weights: Sequence[float]) -> Array:
    """Over the last axis, one after the other."""
    total = np.zeros(values.shape[:-1])
    for k, weight in enumerate(weights):
        total = total + weight * values[..., k]
    return total
