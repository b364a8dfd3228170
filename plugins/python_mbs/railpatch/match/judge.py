"""What a match is worth: points left out and predicted, and what the points cannot tell."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from railpatch.match.fit import LEVEL, NEAR_END, Fit, Search
from railpatch.match.found_parts import RowsFound, Screened
from railpatch.match.interval import ONE

Array = NDArray[np.float64]

# standard deviations of 95 %
NORMAL_95 = 1.959963984540054
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
    """Each part of the points predicted by a fit to all others; None where nothing is left out.

    The others' fit is one step of Gauss and Newton from the fit to all.
    """
    table = search.model.plan.table
    if table.folds == 0 or search.model.free:
        # a row that is left out has nothing that tells where it was
        return None
    count = search.measured.shape[1]
    order = np.random.default_rng(table.seed).permutation(count)
    errors = np.full(search.measured.shape, np.nan)
    spread = np.full(search.measured.shape, np.nan)
    # where all points leave the search to rest, by its loss; what is at an end stays there
    from_all, _ = step_from(search, fit)
    for part in np.array_split(order, min(table.folds, count)):
        search.kept = np.ones(count, dtype=bool)
        search.kept[part] = False
        step, covariance = step_from(search, fit)
        search.kept = np.ones(count, dtype=bool)
        moved = np.clip(fit.shares + step - from_all, 0.0, 1.0) - fit.shares
        errors[:, part] = fit.left[:, part] - fit.slopes[:, part] @ moved
        of_parameters = np.einsum(
            "kmp,pq,kmq->km", fit.slopes[:, part], covariance, fit.slopes[:, part]
        )
        own = fit.noise.error[:, None] ** 2 * (1 + fit.noise.size**2)
        own = own + (search.linear[:, part] ** 2).sum(axis=-1)
        spread[:, part] = np.sqrt(of_parameters + own)
    z = errors / spread
    density = -0.5 * z**2 - np.log(spread * np.sqrt(2 * np.pi))
    there = np.isfinite(z)
    return LeftOut(
        np.sqrt(np.nanmean(errors**2, axis=1)),
        float(np.mean(np.abs(z[there]) < NORMAL_95)),
        float(np.mean(density[there])),
    )


def step_from(search: Search, fit: Fit) -> tuple[Array, Array]:
    """One step of Gauss and Newton by the points that are kept, [p], and the covariance [p, p]."""
    weights = search.weights(fit.noise)
    left = search.whitened(np.nan_to_num(fit.left), weights)
    slopes = search.whitened(fit.slopes, weights)
    counted = np.sqrt(counting(left, search.model.plan.table.loss))
    left, slopes = counted * left, counted[:, None] * slopes
    left = np.concatenate([left, -search.prior(fit.shares)])
    slopes = np.concatenate([slopes, search.prior_slopes(fit.shares)])
    free = (fit.shares > NEAR_END) & (fit.shares < 1 - NEAR_END)
    normal = slopes[:, free].T @ slopes[:, free]
    step, covariance = np.zeros(len(fit.shares)), np.zeros((len(fit.shares),) * 2)
    if free.any():
        own = np.linalg.inv(normal + 1e-8 * np.trace(normal) * np.eye(len(normal)))
        covariance[np.ix_(free, free)] = own
        step[free] = own @ slopes[:, free].T @ left
    return step, covariance


def counting(z: Array, loss: str) -> Array:
    """How much points count: the slope of scipy's losses by the square."""
    square = z**2
    return {
        "linear": np.ones_like(z),
        "soft_l1": 1 / np.sqrt(1 + square),
        "huber": np.where(square <= 1, 1.0, 1 / np.sqrt(np.maximum(square, 1.0))),
        "cauchy": 1 / (1 + square),
    }[loss]


def correlations(fit: Fit) -> Array:
    """[p, p], of the parameters."""
    errors = np.sqrt(np.diag(fit.covariance))
    return fit.covariance / np.outer(errors, errors)


def not_told(
    search: Search,
    fit: Fit,
    felt: Mapping[str, Screened] | None = None,
    rows: RowsFound | None = None,
) -> list[str]:
    """What the points cannot tell, a sentence each. felt: of the screening."""
    keys, sought = search.model.keys, search.sought
    found = [
        f"{key}: the points do not feel it: from end to end of its range a measured number moves "
        f"by {one.effect:.2g} of its error"
        for key, one in (felt or {}).items()
        if not one.felt
    ]
    if rows is not None and rows.several.any():
        named = ", ".join(str(i + 1) for i in np.flatnonzero(rows.several))
        found.append(f"{rows.name} of rows {named}: more than one place meets the row as well")
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
            if sought[i].logarithmic and sought[j].logarithmic:
                together = "quotient" if table[i, j] > 0 else "product"
                text = f"nearly only their {together}"
            else:
                text = f"nearly only together: one {'rises' if table[i, j] > 0 else 'falls'} as the"
                text += " other rises"
            found.append(f"{keys[j]} and {keys[i]}: {text} (correlation {table[i, j]:.3f})")
    return found


__all__ = ["LEVEL", "LeftOut", "correlations", "left_out", "not_told"]
