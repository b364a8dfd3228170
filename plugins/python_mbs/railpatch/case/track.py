"""Irregularities of the rails along the track, from a record.

A record holds the rails' deviations at positions along the track. Under a wheelset at x the rails
lie where the record says: these deviations add to their offset. The rail itself stands still, and
its lateral slope is a real angle of attack, so nothing adds to its lateral velocity. Contacts are
prismatic along the track: one on a vertical slope would take the wheel's climbing for slip along an
inclined surface, so the rail's vertical velocity is the rate at which its height changes under the
wheelset, speed times slope.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import scipy
from numpy.typing import ArrayLike, NDArray

from railpatch.case.arrays import plain_numbers
from railpatch.case.gap import read_rows
from railpatch.case.load import Scene
from railpatch.case.patch import PatchCase
from railpatch.errors import CaseError
from railpatch.profiles.spline import cubic_spline

KEY = "track.irregularity"
COLUMNS = ("x", "left lateral", "left vertical", "right lateral", "right vertical")


class Irregularity:
    """Lateral (to the right) and vertical (down) deviations of both rails over x, m.

    A C2 cubic spline through the record, without slope at its ends and constant beyond them.
    x: [n], increasing; deviations: [n, 4], left lateral, left vertical, right lateral, right
    vertical. Raises CaseError.
    """

    def __init__(self, x: ArrayLike, deviations: ArrayLike) -> None:
        positions, values = plain_numbers(KEY, x), plain_numbers(KEY, deviations)
        if positions.ndim != 1 or positions.size < 2 or values.shape != (positions.size, 4):
            shapes = f"{positions.shape} and {values.shape}"
            raise CaseError(f"{KEY}: shapes are {shapes}, allowed n >= 2 and n rows of 4")
        if not (np.isfinite(positions).all() and np.isfinite(values).all()):
            raise CaseError(f"{KEY}: values are not all finite, allowed finite numbers")
        if (np.diff(positions) <= 0).any():
            first = positions[1:][np.diff(positions) <= 0][0]
            raise CaseError(f"{KEY}: x is {first:g} after a greater one, allowed increasing values")
        self._spline = cubic_spline(positions, values, (0.0, 0.0))
        # deviations and slopes side by side: one evaluation gives both
        slope = self._spline.derivative().c
        slope = np.concatenate([np.zeros_like(slope[:1]), slope])
        self._both = scipy.interpolate.PPoly(
            np.concatenate([self._spline.c, slope], axis=-1), self._spline.x
        )

    def at(self, x: ArrayLike) -> NDArray[np.float64]:
        """m, [..., 2, 2]: of the left and right rail, lateral and vertical, for each x."""
        return self._spline(self._inside(x)).reshape(*np.shape(x), 2, 2)

    def slope(self, x: ArrayLike) -> NDArray[np.float64]:
        """-, [..., 2, 2]: the same by x; 0 beyond the record."""
        return self.both(x)[1]

    def both(self, x: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """at() and slope()."""
        inside, shape = self._inside(x), (*np.shape(x), 2, 2)
        found = self._both(inside)
        slopes = found[..., 4:] * np.equal(inside, x)[..., None]
        return found[..., :4].reshape(shape), slopes.reshape(shape)

    @property
    def pieces(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """x [n] (m) and coefficients [4, n - 1, 8], as scipy's, of at() and slope() within it."""
        return self._both.x, np.ascontiguousarray(self._both.c)

    def _inside(self, x: ArrayLike) -> NDArray[np.float64]:
        return np.clip(np.asarray(x, dtype=float), self._spline.x[0], self._spline.x[-1])


def read_irregularity(path: str | Path) -> Irregularity:
    """A record of five columns, m: x, left lateral, left vertical, right lateral, right vertical.

    Columns are separated by commas, semicolons or spaces; '#' starts a comment. Raises CaseError.
    """
    rows = read_rows(Path(path), KEY)
    for line, row in rows:
        if len(row) != len(COLUMNS):
            named = ", ".join(COLUMNS)
            raise CaseError(f"{KEY}: {path}:{line}: {len(row)} values, allowed 5: {named}")
    if len(rows) < 2:
        raise CaseError(f"{KEY}: {path}: {len(rows)} rows, allowed 2 or more")
    values = np.array([row for _, row in rows])
    return Irregularity(values[:, 0], values[:, 1:])


def irregularity_of(scene: Scene) -> Irregularity | None:
    """The record of a scene that has one. Raises CaseError."""
    if isinstance(scene.case, PatchCase) or scene.case.track.irregularity is None:
        return None
    return read_irregularity(scene.folder / scene.case.track.irregularity)


def add_irregularity(values: dict[str, Any], irregularity: Irregularity) -> None:
    """Into the rails' offsets and vertical velocities of rp_input."""
    moved, slopes = irregularity.both(values["x"])
    rates = values["speed"] * slopes[:, 1]
    values["rail_offset"] = [
        [x, y + lateral, z + vertical]
        for (x, y, z), (lateral, vertical) in zip(values["rail_offset"], moved, strict=True)
    ]
    values["rail_velocity"] = [
        [x, y, z + rate] for (x, y, z), rate in zip(values["rail_velocity"], rates, strict=True)
    ]
