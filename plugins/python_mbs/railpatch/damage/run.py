"""Wear along a run: distributions over the profiles of every wheel and its rail."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from railpatch.case.asked import Damage
from railpatch.case.types import SIDES
from railpatch.damage.distribution import Distribution

Array = NDArray[np.float64]
Wheel = tuple[int, str]
ROWS = ("wheel", "rail", "height", "wear")


class RunWear:
    """Of a run with some wheelsets, numbered from 1. Each sample stands for the way since the one
    before.

    by_wheel: number and side -> Distribution. masses: kg, of each body, the same from the samples'
    patches themselves. lengths: m, round each wheelset's wheels; rail_length: m, over which rail or
    roller wears: round the roller, None: the way of the run.
    """

    def __init__(
        self, law: Damage, radii: Sequence[float], rail_length: float | None = None
    ) -> None:
        """radii: m, of the wheelsets' wheels."""
        self._law = law
        self.lengths = [math.tau * radius for radius in radii]
        self.rail_length = rail_length
        wheels = [(number, side) for number in range(1, len(radii) + 1) for side in SIDES]
        self.by_wheel = {wheel: Distribution() for wheel in wheels}
        self.masses: dict[Wheel, float] = dict.fromkeys(wheels, 0.0)
        self.ways: dict[Wheel, float] = dict.fromkeys(wheels, 0.0)

    def add(self, number: int, rows: Mapping[str, Sequence[Any]], way: float) -> None:
        """Rows of a wheelset's patches by side, as Contact.wear_rows() and
        ForceElement.wear_rows() give them, over a way (m)."""
        for side in SIDES:
            wheel = number, side
            self.ways[wheel] += way
            for share, patch in rows.get(side, ()):
                self.by_wheel[wheel].add(patch, way, share)
                rate = float((patch["wear"] * patch["height"]).sum())
                self.masses[wheel] += share * rate * way

    def depths(self, wheel: Wheel) -> tuple[Array, Array]:
        """m, [bins] each, worn off wheel and rail (or roller)."""
        found, density = self.by_wheel[wheel], self._law.worn_density
        length = self.rail_length or self.ways[wheel] or math.inf
        own = found.depth("wheel", density, self.lengths[wheel[0] - 1])
        return own, found.depth("rail", density, length)

    def message(self, wheel: Wheel) -> dict[str, Any]:
        """Of the log: bins of wheel and rail from the first that is worn to the last."""
        found = self.by_wheel[wheel]
        own, rail = self.depths(wheel)
        worn = np.flatnonzero((found.wheel > 0) | (found.rail > 0))
        used = slice(max(worn[0] - 1, 0), worn[-1] + 2) if worn.size else slice(0, 0)
        return {
            "way": self.ways[wheel],
            "mass": self.masses[wheel],
            "wheel_mass": found.mass("wheel"),
            "rail_mass": found.mass("rail"),
            "y": found.y[used].tolist(),
            "wheel": found.wheel[used].tolist(),
            "rail": found.rail[used].tolist(),
            "wheel_depth": own[used].tolist(),
            "rail_depth": rail[used].tolist(),
        }

    def summary(self) -> dict[str, Any]:
        """Plain numbers by "wheelset_N_left": mass (kg, of each body), way (m), wheel_depth,
        rail_depth (m, greatest) and wheel_place, rail_place (m, their y on the profiles)."""
        told = {}
        for wheel, found in self.by_wheel.items():
            own, rail = self.depths(wheel)
            told[f"wheelset_{wheel[0]}_{wheel[1]}"] = {
                "mass": self.masses[wheel],
                "way": self.ways[wheel],
                "wheel_depth": float(own.max()),
                "wheel_place": float(found.y[own.argmax()]),
                "rail_depth": float(rail.max()),
                "rail_place": float(found.y[rail.argmax()]),
            }
        return told

    def text(self) -> str:
        """For the terminal."""
        parts = [
            f"{number} {side} {1e3 * self.masses[number, side]:.4g} g, "
            f"{1e6 * float(self.depths((number, side))[0].max()):.3g} um"
            for number, side in self.by_wheel
        ]
        return "of each wheel and its rail, greatest depth round the wheel: " + "; ".join(parts)


def rows_of(result: Mapping[str, Any]) -> dict[str, list[tuple[float, dict[str, Array]]]]:
    """Of a wheelset's result with fields, as Contact.wear_rows()."""
    found: dict[str, list[tuple[float, dict[str, Array]]]] = {}
    for side in SIDES:
        wheel = result[side]
        worn = [p for p in wheel["patches"] + wheel["alternatives"] if p.get("damage")]
        found[side] = [
            (
                patch.get("share", 1.0),
                {name: np.asarray(patch["damage"]["fields"][f"row_{name}"]) for name in ROWS},
            )
            for patch in worn
        ]
    return found
