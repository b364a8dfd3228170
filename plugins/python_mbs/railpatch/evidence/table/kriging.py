"""Amounts of the functions of a table of shapes as Gaussian processes of a shape's features.

Kriging with a constant mean (Sacks, Welch, Mitchell and Wynn 1989, Stat. Sci. 4), one covariance
for all functions. Its lengths and what nodes do not know are those that make the nodes likeliest,
each told by the others (leave one out: Dubrule 1983, Math. Geol. 15).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize
from scipy.spatial.distance import cdist

Vector = NDArray[np.float64]
LENGTH, NOISE = (0.4, 600.0), (1e-6, 0.3)  # limits: of standard deviations, of the variance
START, START_NOISE = 8.0, 1e-3
MOST = 300  # nodes that tell the lengths
STEPS = 40


@dataclass(frozen=True)
class Lengths:
    """Of each feature, beyond which nodes know nothing of each other; noise: of a node."""

    length: Vector
    noise: float


def covariance(one: Vector, other: Vector) -> Vector:
    """Wendland's function of the distances, core/fast/shape_table.hpp."""
    d = np.minimum(cdist(one, other), 1.0)
    return (1.0 - d) ** 4 * (4.0 * d + 1.0)


def solved(features: Vector, lengths: Lengths) -> tuple[Vector, Vector]:
    """Inverse of the nodes' covariance, and of what is left beside a constant mean."""
    at = features / lengths.length
    inverse = np.linalg.inv(covariance(at, at) + lengths.noise * np.eye(len(at)))
    of_one = inverse.sum(axis=1)
    return inverse, inverse - np.outer(of_one, of_one) / of_one.sum()


def find_lengths(features: Vector, amounts: Vector, last: Lengths | None) -> Lengths:
    """For features [n, m] and amounts [n, k] of functions in falling order; last: to begin with."""
    size = np.sqrt((amounts**2).mean(axis=0))
    share = size / size.max()
    spread = features.std(axis=0)

    def unlikely(logs: Vector) -> float:
        try:
            _, rest = solved(features, Lengths(np.exp(logs[:-1]), float(np.exp(logs[-1]))))
        except np.linalg.LinAlgError:
            return 1e6
        known = np.maximum(np.diag(rest), 1e-12)
        # of each node what the others leave of it, over how much they leave
        left = (rest @ amounts) ** 2 / known[:, None]
        return float(share @ (np.log(left.mean(axis=0)) - np.log(known).mean()) / 2)

    start = Lengths(START * spread, START_NOISE) if last is None else last
    limits = [tuple(np.log(np.array(LENGTH) * s)) for s in spread] + [tuple(np.log(NOISE))]
    found = minimize(
        unlikely, np.log([*start.length, start.noise]), method="L-BFGS-B", bounds=limits,
        options={"maxiter": STEPS},
    )  # fmt: skip
    return Lengths(np.exp(found.x[:-1]), float(np.exp(found.x[-1])))


def weights_of(features: Vector, amounts: Vector, lengths: Lengths) -> tuple[Vector, Vector]:
    """Mean [k] and weights [n, k] of the covariances with the nodes."""
    inverse, rest = solved(features, lengths)
    of_one = inverse.sum(axis=1)
    return of_one @ amounts / of_one.sum(), rest @ amounts
