"""The search for the parameters, and how well the points know them.

Nonlinear least squares in the shares of the ranges (trust region, scipy.optimize.least_squares)
from several starts, with a loss that points far off do not rule. Then what is left is taken as
noise of each point and, with ``discrepancy``, as an error of the model that belongs together from
point to point: a Gaussian process over the inputs (Kennedy and O'Hagan 2001, J. R. Stat. Soc. B 63,
425-464, their delta; one for each quantity with the same numbers), whose size, length and noise are
those of the greatest likelihood. The parameters are sought again with the points weighted so,
twice. Derivatives are the model's, or differences over a thousandth of each range, away from its
nearer end.

Factor and offset of a measuring chain enter linearly. With f = 1 + u, both of known standard
deviation, they are taken out of the search: measured - computed = u computed + offset + noise is
normal with u's and the offset's part in its covariance (u times what was measured, in place of what
is computed), which is the variable projection of Golub and Pereyra (1973, SIAM J. Numer. Anal. 10,
413-432) with their priors; what they are follows from what is left.

What rows find for themselves (a run's lateral position) is the model's affair: it takes as many
numbers from those that tell of the parameters and the noise. All quantities of one dimension then
have one error where none is given: a row could meet one of them, and make its error vanish.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import cho_factor, cho_solve, solve_triangular
from scipy.optimize import least_squares, minimize
from scipy.stats import chi2, qmc

from railpatch.errors import CaseError
from railpatch.match.model import DIFFERENCE, Model
from railpatch.record.quantities import BY_NAME

Array = NDArray[np.float64]
Told = Callable[[str], None]

# first guesses for all starts, and where rows look at their whole range for each
TRIED, FEW = 16, 4
LEVEL = 0.95
NEAR_END = 1e-3  # of a range
# of what was observed: what a state without a result is off by, and the noise begun with
FAR, FIRST = 10.0, 0.05
ROUNDS = 2


@dataclass(frozen=True)
class Noise:
    """Of what is left. error: [observed], SI units, of each point. size: -, over that, how much
    belongs together. length: over which, in standard deviations of the inputs."""

    error: Array
    size: float = 0.0
    length: float = 1.0

    def covariance(self, apart: Array) -> Array:
        """[m, m], over the squared error. apart: [m, m], squared distances of the inputs."""
        own = np.eye(len(apart))
        if self.size == 0:
            return own
        return own + self.size**2 * np.exp(-0.5 * apart / self.length**2)


@dataclass
class Fit:
    """Parameters that were found.

    shares: [p], of the ranges. noise: of what is left. covariance: [p, p], of the shares. left:
    [observed, m], measured minus computed, SI units, NaN where nothing was measured. slopes:
    [observed, m, p], of what is computed by the shares. likelihood: logarithm, of the points.
    spread: [observed, m], standard deviation of a point that was not there.
    """

    shares: Array
    noise: Noise
    covariance: Array
    left: Array
    computed: Array
    slopes: Array
    likelihood: float
    spread: Array
    intervals: list[tuple[float, float]] = field(default_factory=list)

    @property
    def rms(self) -> Array:
        """[observed], SI units, of what is left."""
        return np.sqrt(np.nanmean(self.left**2, axis=1))


class Search:
    """The search for what one explanation seeks."""

    def __init__(self, model: Model, tell: Told = lambda _: None) -> None:
        self.model, self._tell = model, tell
        self.sought = list(model.explanation.seek.values())
        self.measured = model.measured
        self.there = np.isfinite(self.measured)
        table = model.plan.table
        given = [column.error for column in table.observed.values()]
        self.given = np.array([np.nan if error is None else error for error in given])
        # [observed, m, 2], what factor and offset change by one standard deviation of theirs
        self.linear = np.stack(
            [
                np.nan_to_num(self.measured[k])[:, None] * [column.factor_error or 0.0, 0.0]
                + [0.0, column.offset_error or 0.0]
                for k, column in enumerate(table.observed.values())
            ]
        )
        scale = np.nanmax(np.abs(self.measured), axis=1)
        self.scale = np.where(scale > 0, scale, 1.0)
        inputs = np.array(list(model.inputs.values()))
        spread = inputs.std(axis=1, keepdims=True)
        inputs = inputs / np.where(spread > 0, spread, 1.0)
        self.apart = ((inputs[:, :, None] - inputs[:, None, :]) ** 2).sum(axis=0)
        self.kept = np.ones(self.measured.shape[1], dtype=bool)
        self._last: tuple[Array, Array] | None = None
        # what a search begins with
        self.first = Noise(np.where(np.isfinite(self.given), self.given, FIRST * self.scale))
        model.weigh(self.first.error)

    # --- what is computed ------------------------------------------------------------------------

    def computed(self, shares: Array) -> Array:
        """[observed, m]; what has no result is far off. The last one is kept."""
        if self.model.free or self._last is None or not np.array_equal(self._last[0], shares):
            found = self.model.at(np.clip(shares, 0.0, 1.0))
            far = self.measured + FAR * self.scale[:, None]
            found = np.where(np.isfinite(found), found, np.where(self.there, far, 0.0))
            self._last = (shares.copy(), found)
        return self._last[1]

    def slopes(self, shares: Array) -> Array:
        """[observed, m, p], by the shares."""
        exact = self.model.slopes(np.clip(shares, 0.0, 1.0))
        if exact is not None:
            return exact
        here, found = self.computed(shares), []
        for k in range(len(shares)):
            step = -DIFFERENCE if shares[k] > 0.5 else DIFFERENCE
            moved = shares.copy()
            moved[k] += step
            found.append((self.computed(moved) - here) / step)
        return np.stack(found, axis=-1)

    # --- weighted --------------------------------------------------------------------------------

    def weights(self, noise: Noise) -> list[tuple[NDArray[np.intp], Array]]:
        """Of each quantity the points that count and the Cholesky factor of their covariance."""
        self.model.weigh(noise.error)
        whole = noise.covariance(self.apart)
        found = []
        for k in range(len(self.there)):
            rows = np.flatnonzero(self.there[k] & self.kept)
            found.append((rows, np.linalg.cholesky(self.covariance_of(k, rows, noise, whole))))
        return found

    def covariance_of(self, k: int, rows: NDArray[np.intp], noise: Noise, whole: Array) -> Array:
        """[rows, rows], SI units, of one quantity's points; whole: noise.covariance of all."""
        linear = self.linear[k][rows]
        return noise.error[k] ** 2 * whole[np.ix_(rows, rows)] + linear @ linear.T

    def whitened(self, values: Array, weights: list[tuple[NDArray[np.intp], Array]]) -> Array:
        """[points, ...] of [observed, m, ...]: with unit covariance."""
        parts = [
            solve_triangular(factor, values[k][rows], lower=True)
            for k, (rows, factor) in enumerate(weights)
        ]
        return np.concatenate(parts)

    def prior(self, shares: Array) -> Array:
        """[priors], in their standard deviations."""
        return np.array(
            [
                (one.at(float(share)) - one.prior) / one.prior_error
                for one, share in zip(self.sought, shares, strict=True)
                if one.prior is not None
            ]
        )

    def prior_slopes(self, shares: Array) -> Array:
        """[priors, p]."""
        rows = []
        for k, one in enumerate(self.sought):
            if one.prior is None:
                continue
            row = np.zeros(len(shares))
            step = one.at(float(shares[k]) + 1e-6) - one.at(float(shares[k]) - 1e-6)
            row[k] = step / 2e-6 / one.prior_error
            rows.append(row)
        return np.array(rows).reshape(-1, len(shares))

    def solve(
        self, start: Array, noise: Noise, loss: str, free: NDArray[np.bool_], most: int
    ) -> Array:
        """Shares with the least sum, of those that are free. Raises CaseError."""
        weights = self.weights(noise)

        def whole(some: Array) -> Array:
            shares = start.copy()
            shares[free] = some
            return shares

        def left(some: Array) -> Array:
            shares = whole(some)
            difference = self.computed(shares) - np.nan_to_num(self.measured)
            return np.concatenate([self.whitened(difference, weights), self.prior(shares)])

        def slope(some: Array) -> Array:
            shares = whole(some)
            own = self.whitened(self.slopes(shares), weights)
            return np.concatenate([own, self.prior_slopes(shares)])[:, free]

        begin = np.clip(start[free], 1e-6, 1 - 1e-6)
        found = least_squares(
            left, begin, slope, bounds=(0.0, 1.0), loss=loss, x_scale=0.1, max_nfev=most, xtol=1e-5,
            ftol=1e-6,
        )  # fmt: skip
        return whole(found.x)

    # --- the whole search ------------------------------------------------------------------------

    def run(self) -> Fit:
        """The best of all starts. Raises CaseError."""
        table = self.model.plan.table
        noise = self.first
        every = np.ones(len(self.sought), dtype=bool)
        best, least = None, np.inf
        self.model.weigh(noise.error)
        for number, start in enumerate(self._starts(noise, table.starts, table.seed), start=1):
            self.anew()
            shares = self.solve(start, noise, table.loss, every, 30)
            cost = self._cost(shares, noise, table.loss)
            self._tell(f"start {number} of {table.starts}: misfit {self._misfit(shares):.4g}")
            if cost < least:
                best, least = shares, cost
        assert best is not None
        for _ in range(ROUNDS):
            self.anew()
            noise = self.noise_of(self.computed(best), table.correlated)
            best = self.solve(best, noise, table.loss, every, 15)
        self._tell(f"weighted: misfit {self._misfit(best):.4g}")
        self.anew()
        return self.fit_at(best, self.noise_of(self.computed(best), table.correlated))

    def anew(self) -> None:
        """What rows found for themselves is sought over its whole range again."""
        if self.model.free:
            self.model.forget()
            self._last = None

    def at_optimum(self, fit: Fit) -> None:
        """Brings the model back to an optimum, with its derivatives."""
        self.model.weigh(fit.noise.error)
        self.anew()
        self.slopes(fit.shares)

    def fit_at(self, shares: Array, noise: Noise) -> Fit:
        """What is known at an optimum."""
        self.model.weigh(noise.error)
        slopes = self.slopes(shares)
        computed = self.computed(shares)
        whole = np.concatenate(
            [self.whitened(slopes, self.weights(noise)), self.prior_slopes(shares)]
        )
        # what nothing tells is as wide as its range
        normal = whole.T @ whole + np.eye(len(shares)) * 1e-8 * np.trace(whole.T @ whole)
        covariance = np.linalg.inv(normal)
        of_parameters = np.einsum("kmp,pq,kmq->km", slopes, covariance, slopes)
        own = noise.error[:, None] ** 2 * (1 + noise.size**2) + (self.linear**2).sum(axis=-1)
        spread = np.sqrt(of_parameters + own)
        left = np.where(self.there, self.measured - computed, np.nan)
        likelihood = self.likelihood(computed, noise)
        return Fit(shares, noise, covariance, left, computed, slopes, likelihood, spread)

    def _starts(self, noise: Noise, count: int, seed: int) -> list[Array]:
        """The best of evenly spread first guesses, that of the file first."""
        given = np.array([0.5 if s.start is None else s.share(s.start) for s in self.sought])
        many = FEW if self.model.free else TRIED
        tried = qmc.Sobol(len(given), seed=seed).random(many) if count > 1 else np.zeros((0, 0))
        loss = self.model.plan.table.loss

        def cost(shares: Array) -> float:
            self.anew()
            return self._cost(shares, noise, loss)

        rest = sorted(tried, key=cost)
        return [given, *rest[: count - 1]]

    def _cost(self, shares: Array, noise: Noise, loss: str) -> float:
        difference = self.computed(shares) - np.nan_to_num(self.measured)
        z = np.concatenate([self.whitened(difference, self.weights(noise)), self.prior(shares)])
        return float(least_squares(lambda _: z, [0.0], loss=loss, max_nfev=1).cost)

    def _misfit(self, shares: Array) -> float:
        """rms over the greatest measured value, of all quantities."""
        left = (self.computed(shares) - self.measured) / self.scale[:, None]
        return float(np.sqrt(np.nanmean(np.where(self.there, left, np.nan) ** 2)))

    # --- noise -----------------------------------------------------------------------------------

    def noise_of(self, computed: Array, discrepancy: bool) -> Noise:
        """Of the greatest likelihood. Points far off count as they do in the loss."""
        left = np.where(self.there & self.kept, self.measured - computed, np.nan)
        # parameters that were sought have taken their part
        count = np.isfinite(left).sum(axis=1)
        taken = len(self.sought) + self.model.free
        degrees = np.maximum(count * (1 - taken / max(count.sum(), 1)), 1)
        squares = np.nansum(left**2, axis=1)
        if self.model.free:
            for group in self.alike():
                squares[group], degrees[group] = squares[group].sum(), degrees[group].sum()
        own = np.sqrt(squares / degrees)
        error = np.where(np.isfinite(self.given), self.given, np.maximum(own, 1e-9 * self.scale))
        if not discrepancy:
            return Noise(error)

        def loss(logarithms: Array) -> float:
            factor, size, length = np.exp(logarithms)
            used = np.where(np.isfinite(self.given), error, error * factor)
            return -self.likelihood(computed, Noise(used, float(size), float(length)))

        best, least = Noise(error), -self.likelihood(computed, Noise(error))
        for length in (0.1, 0.5):
            found = minimize(
                loss,
                np.log([0.7, 1.0, length]),
                method="L-BFGS-B",
                bounds=[(-5, 2), (-4, 4), (np.log(0.02), np.log(3.0))],
                options={"maxiter": 40},
            )
            factor, size, length = np.exp(found.x)
            # three numbers more than without are worth it (Akaike 1974)
            if found.fun + 2 < least:
                used = np.where(np.isfinite(self.given), error, error * factor)
                best, least = Noise(used, float(size), float(length)), float(found.fun + 2)
        return best

    def alike(self) -> list[NDArray[np.intp]]:
        """Quantities of one dimension without a given error, which have one with rows."""
        keys = list(self.model.plan.table.observed)
        named: dict[str, list[int]] = {}
        for k in np.flatnonzero(~np.isfinite(self.given)):
            named.setdefault(BY_NAME[keys[k]].dimension, []).append(int(k))
        return [np.array(group) for group in named.values()]

    def likelihood(self, computed: Array, noise: Noise) -> float:
        """Logarithm, of the points that count, normally distributed."""
        whole, total = noise.covariance(self.apart), 0.0
        for k, there in enumerate(self.there):
            rows = np.flatnonzero(there & self.kept)
            left = self.measured[k, rows] - computed[k, rows]
            factor = cho_factor(self.covariance_of(k, rows, noise, whole), lower=True)
            logarithm = np.log(np.diag(factor[0])).sum()
            total -= 0.5 * float(left @ cho_solve(factor, left)) + logarithm
            total -= 0.5 * len(rows) * np.log(2 * np.pi)
        return float(total)

    def chains(self, fit: Fit) -> dict[str, dict[str, tuple[float, float]]]:
        """Factor and offset of each measuring chain that has them: value and standard deviation, by
        their means under what is left."""
        whole, found = fit.noise.covariance(self.apart), {}
        for k, (key, column) in enumerate(self.model.plan.table.observed.items()):
            given = {"factor": column.factor_error, "offset": column.offset_error}
            rows = np.flatnonzero(self.there[k])
            solved = np.linalg.solve(
                self.covariance_of(k, rows, fit.noise, whole),
                np.column_stack([fit.left[k, rows], self.linear[k][rows]]),
            )
            parts = self.linear[k][rows].T @ solved
            for place, (name, error) in enumerate(given.items()):
                if error is None:
                    continue
                spread = error * float(np.sqrt(max(1 - parts[place, 1 + place], 0.0)))
                value = float(name == "factor") + error * float(parts[place, 0])
                found.setdefault(key, {})[name] = (value, spread)
        return found

    # --- intervals -------------------------------------------------------------------------------

    def intervals(self, fit: Fit, kind: str) -> list[tuple[float, float]]:
        """Shares, 95 % of each parameter, within its range."""
        far = float(np.sqrt(chi2.ppf(LEVEL, 1)))
        found = []
        for k, share in enumerate(fit.shares):
            width = far * float(np.sqrt(fit.covariance[k, k]))
            ends = [share - width, share + width]
            if kind == "profile":
                ends = [self._profile_end(fit, k, end, far) for end in ends]
                self._tell(f"interval of {self.model.keys[k]}")
            found.append((float(max(ends[0], 0.0)), float(min(ends[1], 1.0))))
        return found

    def _profile_end(self, fit: Fit, k: int, end: float, far: float) -> float:
        """Where the profile likelihood has fallen by what 95 % are, by secants from the guess.

        All other parameters are sought anew at each value (Venzon and Moolgavkar 1988).
        """
        free = np.arange(len(fit.shares)) != k
        weights = self.weights(fit.noise)

        def squares(shares: Array) -> float:
            difference = self.computed(shares) - np.nan_to_num(self.measured)
            z = np.concatenate([self.whitened(difference, weights), self.prior(shares)])
            return float(z @ z)

        least = squares(fit.shares)
        inner, outer = (fit.shares[k], 0.0), None  # share, root of the rise
        guess = end
        for _ in range(4):
            at = float(np.clip(guess, 0.0, 1.0))
            shares = fit.shares + fit.covariance[:, k] / fit.covariance[k, k] * (at - fit.shares[k])
            shares = np.clip(shares, 0.0, 1.0)
            shares[k] = at
            if free.any():
                shares = self.solve(shares, fit.noise, "linear", free, 3)
            rise = float(np.sqrt(max(squares(shares) - least, 0.0)))
            if rise < far and at in (0.0, 1.0):
                return at
            if abs(rise - far) < 0.05 * far:
                return at
            if rise < far:
                inner = (at, rise)
            else:
                outer = (at, rise)
            if outer is None:
                guess = at + (at - fit.shares[k]) * (far / max(rise, 0.3 * far) - 1)
            else:
                part = (far - inner[1]) / (outer[1] - inner[1])
                guess = inner[0] + part * (outer[0] - inner[0])
        return float(np.clip(guess, 0.0, 1.0))


def refuse_unsolved(model: Model, computed: Array) -> None:
    """Raises CaseError where the scene has no result at most points."""
    bad = ~np.isfinite(computed).all(axis=0)
    if bad.mean() > 0.5:
        raise CaseError(
            f"match.scene: value is a scene without a good result at {int(bad.sum())} of "
            f"{len(bad)} points, allowed one that is solved at most of them"
        )
