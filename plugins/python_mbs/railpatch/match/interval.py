"""Intervals of parameters: by the curvature at the optimum, or by profile likelihood."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import lsq_linear
from scipy.stats import t as student

from railpatch.match.fit import LEVEL, Fit, Search

Array = NDArray[np.float64]

# of the likelihood's root, from where an end of an interval follows by a secant; of its fall to an
# end, a gain of the other parameters that is none, and what derivatives may miss where a share is
# away from the optimum before they are found anew
CLOSE, SMALL, NEARLY, AWAY = 0.15, 0.05, 0.2, 0.15
# steps of the others by corrected derivatives, by new ones, and how often each of these is halved
POLISHED, MOST, HALVINGS = 2, 8, 4
TRIALS = 10
# correlation from which on two parameters are one
ONE = 0.98
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
    """Where the profile likelihood has fallen by what 95 % are, by the Illinois method from a guess
    (Dowell and Jarratt 1971, BIT 11, 168-174).

    All other parameters are sought anew at each value (Venzon and Moolgavkar 1988), by steps of
    Gauss and Newton with the derivatives at the optimum, which every point that is computed
    corrects by the least change that explains it (Broyden 1965).
    """
    path, best = Path(search, fit, k), float(fit.shares[k])
    # inner and outer one: share, and the root of the rise less what it is at the end
    at, left, counted = [best, np.nan], [-far, np.nan], [-far, np.nan]
    guess, last = end, -1
    for _ in range(TRIALS):
        here = float(np.clip(guess, 0.0, 1.0))
        rise = float(np.sqrt(max(path.least_at(here, far**2) - path.least, 0.0)))
        if rise < far and here in (0.0, 1.0):
            return here
        side = int(rise >= far)
        at[side], left[side], counted[side] = here, rise - far, rise - far
        if side == last:
            # what stays where it was counts half
            counted[1 - side] *= 0.5
        last, close = side, abs(rise - far) < CLOSE * far
        if np.isnan(at[1]):
            guess = here + (here - best) * (far / max(rise, 0.3 * far) - 1)
        else:
            low, high = left if close else counted
            guess = at[0] - low * (at[1] - at[0]) / (high - low)
        if close:
            break
    return float(np.clip(guess, 0.0, 1.0))


class Path:
    """Points with the least squares for values of one parameter. least: of all."""

    def __init__(self, search: Search, fit: Fit, k: int) -> None:
        self._search, self._k = search, k
        self._weights = search.weights(fit.noise)
        self._free = np.arange(len(fit.shares)) != k
        self._best, self._shares, self._left = fit.shares, fit.shares, self._left_at(fit.shares)
        slopes = search.whitened(fit.slopes, self._weights)
        self._slopes = np.concatenate([slopes, search.prior_slopes(fit.shares)])
        # along parameters that are known together only, derivatives a little off mislead
        errors = np.sqrt(np.diag(fit.covariance))
        table = np.abs(fit.covariance / np.outer(errors, errors)) - np.eye(len(errors))
        self._joined = bool(table.max() > ONE)
        self.least = float(self._left @ self._left)

    def least_at(self, value: float, fall: float) -> float:
        """The least squares there. fall: of them, at the ends of the interval."""
        before = (self._shares, self._left)
        shares = self._shares.copy()
        shares[self._k] = value
        start = self._left + self._slopes[:, self._k] * (value - self._shares[self._k])
        shares, expected = self._stepped(shares, start)
        self._go_to(shares)
        for _ in range(POLISHED if self._free.any() else 0):
            squares = float(self._left @ self._left)
            # a whole fall of the likelihood off, or nearly so far from the optimum
            away = np.abs(self._shares - self._best)[self._free].max() > AWAY
            if self._joined or squares - expected > (NEARLY if away else 1.0) * fall:
                return self._searched(value, before, fall)
            shares, expected = self._stepped(self._shares, self._left)
            if squares - expected < SMALL * fall:
                return squares
            here = (self._shares, self._left)
            self._go_to(shares)
            if self._left @ self._left > squares:
                self._shares, self._left = here
                return self._searched(value, before, fall) if away else squares
        return float(self._left @ self._left)

    def _searched(self, value: float, before: tuple[Array, Array], fall: float) -> float:
        """The same with new derivatives at each point, where those at hand mislead. before: the
        last point on the path."""
        here = min((before, (self._shares, self._left)), key=lambda at: self._far(at, value))
        self._shares = here[0].copy()
        self._shares[self._k] = value
        self._left = self._left_at(self._shares)
        for _ in range(MOST):
            self._renew()
            squares = float(self._left @ self._left)
            there, expected = self._stepped(self._shares, self._left)
            if squares - expected < SMALL * fall:
                break
            step = there - self._shares
            for _ in range(HALVINGS):
                left = self._left_at(self._shares + step)
                if left @ left < squares:
                    self._shares, self._left = self._shares + step, left
                    break
                step *= 0.5
            else:
                break
        return float(self._left @ self._left)

    def _renew(self) -> None:
        """Derivatives where the path is."""
        search = self._search
        slopes = search.whitened(search.slopes(self._shares), self._weights)
        self._slopes = np.concatenate([slopes, search.prior_slopes(self._shares)])

    def _far(self, at: tuple[Array, Array], value: float) -> float:
        """How little a point is a start: its squares, or those of the last one moved here."""
        left = at[1] + self._slopes[:, self._k] * (value - at[0][self._k])
        return float(left @ left)

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
