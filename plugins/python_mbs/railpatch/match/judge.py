"""What a match is worth: points left out and predicted, and what the points cannot tell."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from railpatch.match.fit import LEVEL, NEAR_END, Fit, Search

Array = NDArray[np.float64]

# standard deviations of 95 %, and correlation from which on two parameters are one
NORMAL_95 = 1.959963984540054
ONE = 0.98
# part of its range from which on a parameter is not known at all
WIDE = 0.95


@dataclass(frozen=True)
class LeftOut:
    """Of points that were left out in turn and predicted.

    rms: [observed], SI units. within: part of them inside the band of 95 %. density: mean logarithm
    of the likelihood of one.
    """

    rms: Array
    within: float
    density: float


def left_out(search: Search, fit: Fit) -> LeftOut | None:
    """Each part of the points predicted by a fit to all others; None where nothing is left out."""
    table = search.model.plan.table
    if table.folds == 0:
        return None
    count = search.measured.shape[1]
    folds = min(table.folds, count)
    order = np.random.default_rng(table.seed).permutation(count)
    every = np.ones(len(fit.shares), dtype=bool)
    errors = np.full(search.measured.shape, np.nan)
    spread = np.full(search.measured.shape, np.nan)
    for part in np.array_split(order, folds):
        search.kept = np.ones(count, dtype=bool)
        search.kept[part] = False
        try:
            shares = search.solve(fit.shares, fit.noise, table.loss, every, 6)
            found = search.fit_at(shares, fit.noise)
        finally:
            search.kept = np.ones(count, dtype=bool)
        errors[:, part] = found.left[:, part]
        spread[:, part] = found.spread[:, part]
    z = errors / spread
    density = -0.5 * z**2 - np.log(spread * np.sqrt(2 * np.pi))
    there = np.isfinite(z)
    return LeftOut(
        np.sqrt(np.nanmean(errors**2, axis=1)),
        float(np.mean(np.abs(z[there]) < NORMAL_95)),
        float(np.mean(density[there])),
    )


def correlations(fit: Fit) -> Array:
    """[p, p], of the parameters."""
    errors = np.sqrt(np.diag(fit.covariance))
    return fit.covariance / np.outer(errors, errors)


def not_told(search: Search, fit: Fit) -> list[str]:
    """What the points cannot tell, a sentence each."""
    found, keys, sought = [], search.model.keys, search.sought
    alone = set()
    for k, (low, high) in enumerate(fit.intervals):
        if high - low > WIDE:
            found.append(f"{keys[k]}: not known from these points, any value in its range will do")
            alone.add(k)
        elif low <= NEAR_END:
            found.append(f"{keys[k]}: no lower limit above {sought[k].low:g}, the end of its range")
        elif high >= 1 - NEAR_END:
            found.append(
                f"{keys[k]}: no upper limit below {sought[k].high:g}, the end of its range"
            )
    table = correlations(fit)
    for i in range(len(keys)):
        for j in range(i):
            if abs(table[i, j]) < ONE or {i, j} & alone:
                continue
            together = "quotient" if table[i, j] > 0 else "product"
            if min(sought[i].low, sought[j].low) <= 0:
                together = "difference" if table[i, j] > 0 else "sum"
            found.append(
                f"{keys[j]} and {keys[i]}: nearly only their {together} (correlation "
                f"{table[i, j]:.3f})"
            )
    return found


__all__ = ["LEVEL", "LeftOut", "correlations", "left_out", "not_told"]
