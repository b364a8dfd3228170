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

Quantities of one dimension have one error where none is given, unless what is left says otherwise
(Schwarz 1978, Ann. Stat. 6, 461-464): a search that weighs few points of each by errors of their
own favours the quantity that it happened to meet. As the errors are estimated, intervals are those
of Student's distribution.

What rows find for themselves (a run's lateral position) is the model's affair: it takes as many
numbers from those that tell of the parameters and the noise. All quantities of one dimension then
have one error: a row could meet one of them, and make its error vanish.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
import scipy
from numpy.typing import NDArray

from railpatch.errors import CaseError
from railpatch.match.model import DIFFERENCE, Model
from railpatch.match.noise import Near, Noise
from railpatch.match.point_units import unit_of_observed
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
# of a range: derivatives serve as far as this in a search, corrected by what is computed there
SERVE = 0.05


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
        self.model, self.tell = model, tell
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
        self._near: Near | None = None
        # what a search begins with
        first = self.scale.copy()
        for group in self.alike():
            first[group] = first[group].max()
        self.first = Noise(np.where(np.isfinite(self.given), self.given, FIRST * first))
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

    def near_slopes(self, shares: Array) -> Array:
        """[observed, m, p], by the shares, as a search needs them: the last ones where they are
        near, corrected by every point computed since (Broyden 1965)."""
        known = self._near
        if known is None or np.abs(shares - known.start).max() > SERVE:
            self._near = Near(shares.copy(), shares.copy(), self.computed(shares), None)
            self._near.slopes = self.slopes(shares)
        else:
            known.go_to(shares, self.computed(shares))
        assert self._near is not None
        assert self._near.slopes is not None
        return self._near.slopes

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
            scipy.linalg.solve_triangular(factor, values[k][rows], lower=True)
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
            own = self.whitened(self.near_slopes(shares), weights)
            return np.concatenate([own, self.prior_slopes(shares)])[:, free]

        begin = np.clip(start[free], 1e-6, 1 - 1e-6)
        found = scipy.optimize.least_squares(
            left, begin, slope, bounds=(0.0, 1.0), loss=loss, x_scale=0.1, max_nfev=most, xtol=1e-5,
            ftol=1e-5,
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
            self.tell(f"start {number} of {table.starts}: misfit {self._misfit(shares):.4g}")
            if cost < least:
                best, least = shares, cost
        assert best is not None
        for _ in range(ROUNDS):
            self.anew()
            noise = self.noise_of(self.computed(best), table.correlated)
            best = self.solve(best, noise, table.loss, every, 15)
        self.tell(f"weighted: misfit {self._misfit(best):.4g}")
        self.anew()
        return self.fit_at(best, self.noise_of(self.computed(best), table.correlated))

    def anew(self) -> None:
        """What rows found for themselves is sought over its whole range again."""
        if self.model.free:
            self.model.forget()
            self._last = self._near = None

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
        tried = (
            scipy.stats.qmc.Sobol(len(given), seed=seed).random(many)
            if count > 1
            else np.zeros((0, 0))
        )
        loss = self.model.plan.table.loss

        def cost(shares: Array) -> float:
            self.anew()
            return self._cost(shares, noise, loss)

        rest = sorted(tried, key=cost)
        return [given, *rest[: count - 1]]

    def _cost(self, shares: Array, noise: Noise, loss: str) -> float:
        difference = self.computed(shares) - np.nan_to_num(self.measured)
        z = np.concatenate([self.whitened(difference, self.weights(noise)), self.prior(shares)])
        return float(scipy.optimize.least_squares(lambda _: z, [0.0], loss=loss, max_nfev=1).cost)

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
        for group in self.alike():
            whole = squares[group].sum() / degrees[group].sum()
            # errors of their own gain half of this by likelihood, for one number more each
            several = np.maximum(squares[group] / degrees[group], 1e-18 * self.scale[group] ** 2)
            gain = float(count[group] @ np.log(max(whole, 1e-300) / several))
            price = (len(group) - 1) * np.log(max(count[group].sum(), 2))
            if self.model.free or gain < price:
                squares[group], degrees[group] = squares[group].sum(), degrees[group].sum()
        own = np.sqrt(squares / degrees)
        error = np.where(np.isfinite(self.given), self.given, np.maximum(own, 1e-9 * self.scale))
        estimated = degrees[~np.isfinite(self.given)]
        known = float(estimated.min()) if len(estimated) else np.inf
        if not discrepancy:
            return Noise(error, degrees=known)

        def loss(logarithms: Array) -> float:
            factor, size, length = np.exp(logarithms)
            used = np.where(np.isfinite(self.given), error, error * factor)
            return -self.likelihood(computed, Noise(used, float(size), float(length)))

        best, least = Noise(error, degrees=known), -self.likelihood(computed, Noise(error))
        for length in (0.1, 0.5):
            found = scipy.optimize.minimize(
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
                best = Noise(used, float(size), float(length), known)
                least = float(found.fun + 2)
        return best

    def alike(self) -> list[NDArray[np.intp]]:
        """Quantities of one dimension without a given error."""
        columns = list(self.model.plan.table.observed.items())
        named: dict[str, list[int]] = {}
        for k in np.flatnonzero(~np.isfinite(self.given)):
            key, column = columns[k]
            own = BY_NAME[key].dimension if not column.name else ""
            own = own or f"{unit_of_observed(key, column, column.over)} {column.over}"
            named.setdefault(own, []).append(int(k))
        return [np.array(group) for group in named.values()]

    def likelihood(self, computed: Array, noise: Noise) -> float:
        """Logarithm, of the points that count, normally distributed."""
        whole, total = noise.covariance(self.apart), 0.0
        for k, there in enumerate(self.there):
            rows = np.flatnonzero(there & self.kept)
            left = self.measured[k, rows] - computed[k, rows]
            factor = scipy.linalg.cho_factor(self.covariance_of(k, rows, noise, whole), lower=True)
            logarithm = np.log(np.diag(factor[0])).sum()
            total -= 0.5 * float(left @ scipy.linalg.cho_solve(factor, left)) + logarithm
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


def refuse_unsolved(model: Model, computed: Array) -> None:
    """Raises CaseError where the scene has no result at most points."""
    bad = ~np.isfinite(computed).all(axis=0)
    if bad.mean() > 0.5:
        raise CaseError(
            f"match.scene: value is a scene without a good result at {int(bad.sum())} of "
            f"{len(bad)} points, allowed one that is solved at most of them"
        )
