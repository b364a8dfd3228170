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
    """unknowns: [n]. jacobian: the solver's, found at this place before; None for a new place."""

    unknowns: Vector
    jacobian: Vector | None = None


class Predictor:
    """Takes the unknowns of a position passed before, or extrapolates them along the run.

    What is extrapolated is their difference from a baseline, which knows the machine's geometry
    without friction. The order of extrapolation is the one that would have predicted the last
    balance best, measured with ``scale``, [n].
    """

    def __init__(self, baseline: Callable[[Position], Vector], scale: Vector) -> None:
        self._baseline = baseline
        self._scale = scale
        self._places: list[Vector] = []
        self._progress: list[float] = []
        self._differences: list[Vector] = []
        self._jacobians: list[Vector | None] = []

    def remember(self, position: Position, unknowns: Vector, jacobian: Vector | None) -> None:
        """Adds a balance that was found, and the Jacobian there."""
        self._places.append(place_of(position))
        self._progress.append(position.progress)
        self._differences.append(unknowns - self._at(position, unknowns[3:] - position.y))
        self._jacobians.append(jacobian)
        for kept in (self._places, self._progress, self._differences, self._jacobians):
            del kept[:-MEMORY]

    def predict(self, position: Position) -> Prediction:
        """What is to be expected at the position."""
        if not self._differences:
            return Prediction(self._at(position, np.zeros(max(len(self._scale) - 3, 0))))
        seen = self._seen(place_of(position))
        if seen is not None:
            ahead = self._differences[seen]
            return Prediction(self._at(position, ahead[3:]) + ahead, self._jacobians[seen])
        count = len(self._differences)
        ahead = self._extrapolated(self._best_order(), count, position.progress)
        return Prediction(self._at(position, ahead[3:]) + ahead)

    def _at(self, position: Position, deflection: Vector) -> Vector:
        """The baseline where the wheelset is: a frame, if it yields ([1], m; else [0]), lets it be
        beside its actuators. The baseline of the lateral position itself is theirs."""
        if not len(deflection):
            return self._baseline(position)
        beside = replace(position, y=position.y + float(deflection[0]))
        return np.append(self._baseline(beside), position.y)

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
