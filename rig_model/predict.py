"""Where the next position's balance is likely to be, from the balances found before."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from rig_model.programme import Position

Vector = NDArray[np.float64]

# a position counts as seen before when it is nearer to an earlier one than this part of a step
SEEN = 0.25
HIGHEST_ORDER = 2
# balances that are kept: finely sampled runs are predicted by extrapolation anyway
MEMORY = 500


@dataclass(frozen=True)
class Prediction:
    """unknowns: [n]. jacobian: the solver's, found at this place before; None for a new place.
    factors: by side, of friction that conditions, where they are known."""

    unknowns: Vector
    jacobian: Vector | None = None
    factors: dict[str, float] | None = None


class Predictor:
    """Takes the unknowns of a position passed before, or extrapolates them along the run.

    What is extrapolated is their difference from a baseline, which knows the machine's geometry
    without friction. The order of extrapolation is the one that would have predicted the last
    balance best, measured with ``scale``, [n].
    """

    def __init__(
        self, baseline: Callable[[Position], Vector], scale: Vector, extra: tuple[str, ...] = ()
    ) -> None:
        """extra: names of the unknowns after the baseline's; "y" counts from the position's."""
        self._baseline, self._names = baseline, extra
        self._extra = np.array([float(name == "y") for name in extra])
        self._scale = scale
        self._places: list[Vector] = []
        self._progress: list[float] = []
        self._differences: list[Vector] = []
        self._jacobians: list[Vector | None] = []

    def anew(self) -> Predictor:
        """Without the balances found before."""
        return Predictor(self._baseline, self._scale, self._names)

    def remember(self, position: Position, unknowns: Vector, jacobian: Vector | None) -> None:
        """Adds a balance that was found, and the Jacobian there."""
        self._places.append(place_of(position))
        self._progress.append(position.progress)
        beyond = unknowns[self._count :] - self._extra * position.y
        self._differences.append(unknowns - self._at(position, beyond))
        self._jacobians.append(jacobian)
        for kept in (self._places, self._progress, self._differences, self._jacobians):
            del kept[:-MEMORY]

    def moved(self, known: Prediction, before: Position, after: Position) -> Prediction:
        """What is known at one position, for another one near it, by the baseline."""
        beyond = known.unknowns[self._count :] - self._extra * before.y
        change = self._at(after, beyond) - self._at(before, beyond)
        return replace(known, unknowns=known.unknowns + change)

    def begin(self, position: Position) -> Prediction:
        """By the baseline alone."""
        return Prediction(self._at(position, np.zeros_like(self._extra)))

    def predict(self, position: Position) -> Prediction:
        """What is to be expected at the position."""
        if not self._differences:
            return self.begin(position)
        seen = self._seen(place_of(position))
        if seen is not None:
            ahead, jacobian = self._differences[seen], self._jacobians[seen]
        else:
            count = len(self._differences)
            ahead = self._extrapolated(self._best_order(), count, position.progress)
            jacobian = None
        return Prediction(self._at(position, ahead[self._count :]) + ahead, jacobian)

    @property
    def _count(self) -> int:
        """Of the baseline's unknowns."""
        return len(self._scale) - len(self._extra)

    def _at(self, position: Position, beyond: Vector) -> Vector:
        """The baseline where the wheelset is: a frame, if it yields, lets it be beside its
        actuators. beyond: the further unknowns, of which the baseline has the actuators' place."""
        beside = replace(position, y=position.y + float((self._extra * beyond).sum()))
        return np.append(self._baseline(beside), self._extra * position.y)

    def _seen(self, place: Vector) -> int | None:
        """Index of the balance found at this place before."""
        distance = np.linalg.norm(np.array(self._places) - place, axis=1)
        nearest = int(np.argmin(distance))
        return nearest if distance[nearest] <= SEEN * distance[-1] else None

    def _best_order(self) -> int:
        last = len(self._differences) - 1
        errors = [
            np.abs(
                (self._extrapolated(order, last, self._progress[last]) - self._differences[last])
                / self._scale
            ).max()
            for order in range(min(HIGHEST_ORDER, last - 1) + 1)
        ]
        return int(np.argmin(errors)) if errors else 0

    def _extrapolated(self, order: int, count: int, progress: float) -> Vector:
        """Lagrange polynomial through the last ``order`` + 1 of the first ``count`` balances."""
        chosen = range(count - 1 - order, count)
        at = self._progress
        total = np.zeros_like(self._scale)
        for i in chosen:
            weights = [(progress - at[k]) / (at[i] - at[k]) for k in chosen if k != i]
            total += np.prod(weights) * self._differences[i]
        return total


def place_of(position: Position) -> Vector:
    """Lateral position in mm, yaw angle in mrad, load in kN and speed of the rollers in 0.1 rad/s
    where they vary: numbers that compare in such a machine."""
    load, rate = position.vertical_force or 0.0, position.roller_pitch_rate or 0.0
    return np.array([1e3 * position.y, 1e3 * position.yaw, 1e-3 * load, 10 * rate])
