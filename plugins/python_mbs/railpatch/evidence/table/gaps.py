"""Rows of numbers with gaps, filled by the principal components of rows without (Everson and
Sirovich 1995, J. Opt. Soc. Am. A 12, 1657-1664)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Vector = NDArray[np.float64]
LEFT = 3e-4  # of a number beyond what the components have, standard deviation


class Gaps:
    """Fills rows [place, 3] that are known at some places.

    whole: rows [n, place, 3] to learn from; known: numbers of the places that others will have. The
    amounts of the components are the likeliest ones, with the spread that they have in ``whole``
    and what is left of a number normal with ``LEFT``: so that few places bear all components.
    """

    def __init__(self, whole: Vector, known: NDArray[np.intp]) -> None:
        count, places, parts = whole.shape
        self._known, self._shape = known, (places, parts)
        rows = whole.reshape(count, -1)
        self._mean = rows.mean(axis=0)
        _, size, shared = np.linalg.svd(rows - self._mean, full_matrices=False)
        spread = size[: count - 1] / np.sqrt(count - 1)
        # one unit of a component is what it has in one row
        self._shared = shared[: count - 1] * spread[:, None]
        seen = self._at(self._shared)
        normal = seen @ seen.T + LEFT**2 * np.eye(len(spread))
        self._amounts = np.linalg.solve(normal, seen)

    def _at(self, rows: Vector) -> Vector:
        """Of rows [..., place times 3] the known places."""
        places, parts = self._shape
        found = rows.reshape(*rows.shape[:-1], places, parts)[..., self._known, :]
        return found.reshape(*rows.shape[:-1], -1)

    def filled(self, known: Vector) -> Vector:
        """[place, 3] of the known places' [k, 3], which stay."""
        amounts = self._amounts @ (known.reshape(-1) - self._at(self._mean))
        found = (self._mean + amounts @ self._shared).reshape(self._shape)
        found[self._known] = known
        return found
