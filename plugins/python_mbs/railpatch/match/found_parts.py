"""Parts of what a match finds: rows' own values, what is felt, the posterior's samples."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class RowsFound:
    """What each row has for itself. progress: -, values, low, high: SI units, [m]: the best one and
    ends of 95 %. several: [m], whether other places between the ends meet the row as well."""

    name: str
    progress: Array
    values: Array
    low: Array
    high: Array
    several: NDArray[np.bool_]

    def table(self) -> list[list[float]]:
        """Rows of progress from 0 to 1 and value, as [rig] takes them."""
        found = [
            list(row) for row in zip(self.progress.tolist(), self.values.tolist(), strict=True)
        ]
        if found[0][0] > 0:
            found.insert(0, [0.0, found[0][1]])
        if found[-1][0] < 1:
            found.append([1.0, found[-1][1]])
        return found

    def to_dict(self) -> dict[str, Any]:
        """What match.json holds of it."""
        return {
            "progress": self.progress.tolist(),
            "value": self.values.tolist(),
            "low": self.low.tolist(),
            "high": self.high.tolist(),
            "several_places": self.several.tolist(),
        }


@dataclass(frozen=True)
class Screened:
    """How a parameter is felt over its whole range, of Morris's trajectories.

    effect: -, rms change of a measured number, in its error, over the range. spread: -, standard
    deviation of that over the trajectories. felt: whether the points together know it from nothing.
    """

    effect: float
    spread: float
    felt: bool


@dataclass(frozen=True)
class Sampled:
    """Of the posterior. median, low, high: of a parameter, low and high with 95 % between."""

    median: float
    low: float
    high: float
