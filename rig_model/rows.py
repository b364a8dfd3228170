"""What is unknown in each row of a record: found where the row's measured numbers are met best.

Least squares of one number for each row, with the balance's derivative by it (rig_model/partial.py)
as Gauss and Newton do. Measured profiles are wavy, so a row can have several places that meet it:
the range is looked at in even steps first, and the best places are refined each.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from railpatch.errors import CaseError

from rig_model.balance import Balance
from rig_model.predict import Prediction
from rig_model.programme import Position
from rig_model.scene import RigScene

Array = NDArray[np.float64]

# the field of a position by the quantity that a record has not
FIELDS = {"lateral_position": "y", "yaw": "yaw"}
# places that are refined, and steps of one refinement
REFINED = 4
MOST_STEPS = 6
MOST_HALVINGS = 5
# golden sections of the way between neighbours
SECTIONS = 8
GOLDEN = 0.3819660112501051
# standard deviations of 95 %, and their square
NORMAL_95 = 1.959963984540054
CHI_95 = NORMAL_95**2
# of the range: a step that ends the refinement; of the squares: a gain that is none
CLOSE, GAIN = 1e-5, 1e-4


@dataclass(frozen=True)
class Place:
    """One value in one row. squares: of what is left over its error, summed. slope: [names], of
    what is measured by the value; None before it is asked for."""

    value: float
    balance: Balance
    known: Prediction
    left: Array
    squares: float
    slope: Array | None = None


@dataclass(frozen=True)
class RowFit:
    """Of a row: the best place, and others whose squares are least around them."""

    best: Place
    others: tuple[Place, ...] = ()


@dataclass(frozen=True)
class RowProblem:
    """balance: of a position, from what is known. moved: what is known, at another value.
    observed, slope: [names], of a balance."""

    balance: Callable[[Position, Prediction | None], tuple[Balance, Prediction]]
    moved: Callable[[Prediction, Position, Position], Prediction]
    observed: Callable[[Balance], Array]
    slope: Callable[[Balance], Array]


class Rows:
    """One input of each row, within a range.

    quantity: of FIELDS. starts: values that are looked at first. errors: [names], SI units, of what
    is measured. fits: [m], of the last replay.
    """

    def __init__(self, quantity: str, low: float, high: float, starts: int) -> None:
        """Raises CaseError."""
        if quantity not in FIELDS:
            raise CaseError(f"match.rows: value is {quantity!r}, allowed {', '.join(FIELDS)}")
        self.quantity, self.field = quantity, FIELDS[quantity]
        self.low, self.high, self.starts = low, high, starts
        self.errors = np.ones(0)
        self.fits: list[RowFit | None] = []
        self._seeds: Array = np.zeros(0)
        # [p] by row: of the value by the parameters
        self._by: dict[int, Array] = {}

    def check(self, scene: RigScene) -> None:
        """Refuses what rows cannot be solved apart for. Raises CaseError."""
        frame = scene.rig.frame
        if frame is not None and frame.friction:
            raise CaseError(
                "match.rows: value is given with rig.frame.friction, allowed without: a row's "
                "sliders depend on the rows before it"
            )
        if scene.rig.conditioning is not None:
            raise CaseError(
                "match.rows: value is given with rig.conditioning, allowed without: a row's "
                "friction depends on the rows before it"
            )
        if frame is not None and frame.gauge_stiffness is not None:
            raise CaseError(
                "match.rows: value is given with rig.frame.gauge_stiffness, allowed without"
            )
        if scene.measured is not None and self.quantity in scene.measured.driven:
            raise CaseError(
                f"match.rows: value is {self.quantity!r}, allowed what the record does not drive"
            )

    def forget(self, count: int) -> None:
        """Of so many rows: each is looked at over its whole range again."""
        last = self.fits or [None] * count
        self._seeds = np.array([np.nan if fit is None else fit.best.value for fit in last])
        self.fits = [None] * count

    def ends(self, quantity: str) -> tuple[float, ...]:
        """Of the range, where the rows are of that quantity."""
        return (self.low, self.high) if quantity == self.quantity else ()

    def fit(self, index: int, position: Position, measured: Array, problem: RowProblem) -> RowFit:
        """The best value of a row, from the last one, or from its whole range at first."""
        last = self.fits[index]
        if last is not None:
            start = self._place(last.best.value, position, last.best, measured, problem)
            found = RowFit(self._refined(start, position, measured, problem), last.others)
        else:
            found = self._searched(index, position, measured, problem)
        self.fits[index] = found
        return found

    def projected(self, index: int, slopes: Array) -> Array:
        """[names, parameters], derivatives along the best value of a row."""
        along, weights = self.along(index)
        if along is None:
            return slopes
        by = -(weights * along) @ slopes / (weights @ along**2)
        self._by[index] = by
        return slopes + np.outer(along, by)

    def along(self, index: int) -> tuple[Array | None, Array]:
        """[names], the derivative by a row's value, None where that is at an end; and weights."""
        fit = self.fits[index]
        assert fit is not None
        place = fit.best
        weights = np.where(np.isfinite(place.left), self.errors**-2.0, 0.0)
        held = not self.low < place.value < self.high
        if held or place.slope is None or not weights @ place.slope**2 > 0:
            return None, weights
        return place.slope, weights

    def told(self, index: int, covariance: Array) -> tuple[float, float, float, bool]:
        """Value of a row, ends of 95 %, and whether another place would do as well (its squares
        within 3.84 of the least); the ends then go from the first place to the last."""
        fit = self.fits[index]
        assert fit is not None
        along, weights = self.along(index)
        width = np.inf
        if along is not None:
            by = self._by.get(index, np.zeros(len(covariance)))
            width = NORMAL_95 * np.sqrt(1 / (weights @ along**2) + by @ covariance @ by)
        low, high = fit.best.value - width, fit.best.value + width
        near = [p for p in fit.others if p.squares < fit.best.squares + CHI_95]
        several = [p.value for p in near if not low <= p.value <= high]
        ends = [low, high, *several]
        return fit.best.value, max(min(ends), self.low), min(max(ends), self.high), bool(several)

    def _searched(
        self, index: int, position: Position, measured: Array, problem: RowProblem
    ) -> RowFit:
        places: list[Place] = []
        for value in np.linspace(self.low, self.high, self.starts):
            before = places[-1] if places else None
            places.append(self._place(float(value), position, before, measured, problem))
        squares = np.array([np.inf, *(place.squares for place in places), np.inf])
        least = (squares[1:-1] <= squares[:-2]) & (squares[1:-1] <= squares[2:])
        order = sorted(np.flatnonzero(least), key=lambda k: places[k].squares)
        begun = [
            self._narrowed(places, int(k), position, measured, problem) for k in order[:REFINED]
        ]
        if np.isfinite(self._seeds[index]):
            # never worse than what was found before
            begun.append(self._place(self._seeds[index], position, places[-1], measured, problem))
        refined = [self._refined(place, position, measured, problem) for place in begun]
        refined.sort(key=lambda place: place.squares)
        return RowFit(refined[0], tuple(refined[1:]))

    def _narrowed(
        self, places: list[Place], k: int, position: Position, measured: Array, problem: RowProblem
    ) -> Place:
        """The best place around one of less squares than its neighbours, by golden sections: where
        a flange begins to touch, slopes at a place tell little of the next one."""
        best = places[k]
        low, high = places[max(k - 1, 0)].value, places[min(k + 1, len(places) - 1)].value
        for _ in range(SECTIONS):
            left = best.value - low > high - best.value
            value = best.value + GOLDEN * ((low if left else high) - best.value)
            place = self._place(value, position, best, measured, problem)
            if place.squares < best.squares:
                low, high = (low, best.value) if left else (best.value, high)
                best = place
            elif left:
                low = value
            else:
                high = value
        return best

    def _at(self, position: Position, value: float) -> Position:
        return replace(position, **{self.field: value})

    def _place(
        self, value: float, position: Position, near: Place | None, measured: Array,
        problem: RowProblem,
    ) -> Place:  # fmt: skip
        known = None
        if near is not None and near.balance.converged:
            known = problem.moved(
                near.known, self._at(position, near.value), self._at(position, value)
            )
        balance, found = problem.balance(self._at(position, value), known)
        if not balance.converged:
            return Place(value, balance, found, np.full(len(measured), np.nan), np.inf)
        left = problem.observed(balance) - measured
        return Place(value, balance, found, left, float(np.nansum((left / self.errors) ** 2)))

    def _refined(
        self, place: Place, position: Position, measured: Array, problem: RowProblem
    ) -> Place:
        """By Gauss and Newton; each step is halved until the squares are less."""
        if not np.isfinite(place.squares):
            return place
        spacing = (self.high - self.low) / max(self.starts - 1, 1)
        place = replace(place, slope=problem.slope(place.balance))
        for _ in range(MOST_STEPS):
            assert place.slope is not None
            weights = np.where(np.isfinite(place.left), self.errors**-2.0, 0.0)
            curvature = float(weights @ place.slope**2)
            gradient = float(weights @ (np.nan_to_num(place.left) * place.slope))
            if not curvature > 0 or gradient**2 / curvature < GAIN * (1 + 1e-3 * place.squares):
                break
            step = float(np.clip(-gradient / curvature, -spacing, spacing))
            step = float(np.clip(place.value + step, self.low, self.high)) - place.value
            for _ in range(MOST_HALVINGS + 1):
                if abs(step) < CLOSE * (self.high - self.low):
                    return place
                trial = self._place(place.value + step, position, place, measured, problem)
                if trial.squares < place.squares:
                    break
                step *= 0.5
            else:
                return place
            place = replace(trial, slope=problem.slope(trial.balance))
        return place
