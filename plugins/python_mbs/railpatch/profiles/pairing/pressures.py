"""Greatest pressure between a pair of profiles over the wheelset's lateral position, and how far
the noise of their points leaves it open."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from railpatch.contact import Contact
from railpatch.profiles.pairing.contact_points import Dimensions, pair_case, positions
from railpatch.profiles.raw import Reading, Role

Array = NDArray[np.float64]
LOAD = 80e3  # N, of a wheel
REACH, STEP = 0.01, 5e-4  # m


@dataclass(frozen=True)
class Pressures:
    """Of the right wheel on its rail, [n]. load: N. files: names of those with noise. notes: of
    what was assumed, by file. doubts: why a wheel can hardly lie where it is put."""

    load: float
    files: tuple[str, ...]
    notes: dict[str, list[str]]
    doubts: list[str]
    y: Array  # m, lateral position of the wheelset
    pressure: Array  # Pa, greatest one; NaN: no contact
    error: Array  # -, what 95 % of its relative errors stay below; NaN: no noise, no contact

    def at(self, y: Array) -> tuple[Array, Array]:
        """Pressure and error at other positions, m, [m]; NaN at those that are none of these."""
        found = np.full((2, y.size), np.nan)
        for place, *values in zip(self.y, self.pressure, self.error, strict=True):
            found[:, np.abs(y - place) < 1e-9] = np.array(values)[:, None]
        return found[0], found[1]

    def line(self) -> str:
        """What noise leaves open, in one line; empty without noise."""
        known = np.isfinite(self.error)
        if not known.any():
            return ""
        worst = int(np.nanargmax(self.error))
        middle = float(np.median(self.error[known]))
        return (
            f"max_pressure under {1e-3 * self.load:g} kN is known to within {100 * middle:.2g} % "
            f"(median), at worst {100 * self.error[worst]:.2g} % at y = {1e3 * self.y[worst]:.3g} "
            f"mm (of 95 % of cases) for the noise of {' and '.join(self.files)}"
        )


def pressures(
    wheel: str | Path,
    rail: str | Path,
    dimensions: Dimensions | None = None,
    *,
    load: float = LOAD,
    smoothing: float | None = None,
    readings: Mapping[Role, Reading | None] | None = None,
) -> Pressures:
    """Every 0.5 mm from -10 mm to 10 mm, by the half-space on 24 x 24 elements, without friction.

    wheel, rail, dimensions, smoothing, readings: as for contact_points. load: N, on the wheel.
    Raises ProfileError, CaseError.
    """
    case = pair_case(wheel, rail, dimensions or Dimensions(), smoothing, readings or {})
    del case["grid"]
    case["method"] = {"tangential": "none"}
    case["wheelset"]["vertical_force"] = load
    contact = Contact(case)
    at = positions(REACH, STEP)
    found = np.full((2, at.size), np.nan)
    for index, place in enumerate(at):
        result = contact.step(y=float(place))
        patches = result["patches"] if result.solved else []
        if patches:
            found[0, index] = max(patch["max_pressure"] for patch in patches)
            found[1, index] = contact.pressure_error().get("right", np.nan)
    said = contact.profile_notes(), contact.placement_doubts()
    return Pressures(load, tuple(contact.noisy_profiles()), *said, at, *found)
