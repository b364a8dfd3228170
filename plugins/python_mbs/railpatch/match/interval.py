"""Intervals of parameters: by the curvature at the optimum, or by profile likelihood."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import lsq_linear
from scipy.stats import t as student

from railpatch.match.fit import LEVEL, Fit, Search

Array = NDArray[np.float64]

# of the likelihood's root, from where an end of an interval follows by a secant; of the likelihood,
# a gain of the other parameters that is none; most of their steps
CLOSE, SMALL, POLISHED = 0.2, 0.05, 2
TINY = 1e-12


def intervals_of(search: Search, fit: Fit, kind: str) -> list[tuple[float, float]]:
    """Shares, 95 % of each parameter, within its range."""
    far = float(student.ppf(0.5 + 0.5 * LEVEL, fit.noise.degrees))
    found = []
    for k, share in enumerate(fit.shares):
        width = far * float(np.sqrt(fit.covariance[k, k]))
        ends = [share - width, share + width]
        if kind == "profile":
            ends = [profile_end(search, fit, k, end, far) for end in ends]
            search.tell(f"interval of {search.model.keys[k]}")
        found.append((float(max(ends[0], 0.0)), float(min(ends[1], 1.0))))
    return found


def profile_end(search: Search, fit: Fit, k: int, end: float, far: float) -> float:
    """Where the profile likelihood has fallen by what 95 % are, by secants from the guess.

    All other parameters are sought anew at each value (Venzon and Moolgavkar 1988), by steps of
    Gauss and Newton with the derivatives at the optimum, which every point that is computed
    corrects by the least change that explains it (Broyden 1965).
    """
    path = Path(search, fit, k)
    inner, outer = (fit.shares[k], 0.0), None  # share, root of the rise
    guess = end
    for _ in range(6):
        at = float(np.clip(guess, 0.0, 1.0))
        rise = float(np.sqrt(max(path.least_at(at, SMALL * far**2) - path.least, 0.0)))
        if rise < far and at in (0.0, 1.0):
            return at
        close = abs(rise - far) < CLOSE * far
        if rise < far:
            inner = (at, rise)
        else:
            outer = (at, rise)
        if outer is None:
            guess = at + (at - fit.shares[k]) * (far / max(rise, 0.3 * far) - 1)
        else:
            part = (far - inner[1]) / (outer[1] - inner[1])
            guess = inner[0] + part * (outer[0] - inner[0])
        if close:
            break
    return float(np.clip(guess, 0.0, 1.0))


class Path:
    """Points with the least squares for values of one parameter. least: of all."""

    def __init__(self, search: Search, fit: Fit, k: int) -> None:
        self._search, self._k = search, k
        self._weights = search.weights(fit.noise)
        self._free = np.arange(len(fit.shares)) != k
        self._shares, self._left = fit.shares, self._left_at(fit.shares)
        slopes = search.whitened(fit.slopes, self._weights)
        self._slopes = np.concatenate([slopes, search.prior_slopes(fit.shares)])
        self.least = float(self._left @ self._left)

    def least_at(self, value: float, small: float) -> float:
        """The least squares there. small: a gain that is none."""
        shares = self._shares.copy()
        shares[self._k] = value
        start = self._left + self._slopes[:, self._k] * (value - self._shares[self._k])
        shares, _ = self._stepped(shares, start)
        self._go_to(shares)
        for _ in range(POLISHED if self._free.any() else 0):
            squares = float(self._left @ self._left)
            shares, expected = self._stepped(self._shares, self._left)
            if squares - expected < small:
                break
            before = (self._shares, self._left)
            self._go_to(shares)
            if self._left @ self._left > squares:
                self._shares, self._left = before
                break
        return float(self._left @ self._left)

    def _left_at(self, shares: Array) -> Array:
        search = self._search
        difference = search.computed(shares) - np.nan_to_num(search.measured)
        return np.concatenate([search.whitened(difference, self._weights), search.prior(shares)])

    def _stepped(self, shares: Array, left: Array) -> tuple[Array, float]:
        """Where the other parameters leave least by the derivatives, and the squares there."""
        if not self._free.any():
            return shares, float(left @ left)
        own = shares[self._free]
        found = lsq_linear(self._slopes[:, self._free], -left, (0.0 - own - TINY, 1.0 - own + TINY))
        moved = shares.copy()
        moved[self._free] = np.clip(own + found.x, 0.0, 1.0)
        return moved, 2 * float(found.cost)

    def _go_to(self, shares: Array) -> None:
        left, step = self._left_at(shares), shares - self._shares
        if (size := float(step @ step)) > 0:
            missed = left - self._left - self._slopes @ step
            self._slopes = self._slopes + np.outer(missed, step) / size
        self._shares, self._left = shares, left
