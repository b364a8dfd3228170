"""A wheel profile on a rail profile over the wheelset's lateral position: where they touch.

The places come from the contact search of the core, with each wheel pressed on its rail by a force
so small that the bodies are as good as rigid. As in EN 15302 the wheelset neither yaws nor rolls:
each wheel lies on its own rail.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from railpatch.contact import Contact
from railpatch.profiles.pairing.conicity import equivalent_conicity
from railpatch.profiles.raw import Reading, Role

Array = NDArray[np.float64]
# N, flattens a wheel on a rail by some 5e-8 m
LIGHT_LOAD = 1.0


@dataclass(frozen=True)
class Dimensions:
    """What belongs to a pair of profiles besides their shapes; that of EN 15302 by default."""

    gauge: float = 1.435  # m
    gauge_height: float = 0.014  # m, below the rail's top
    nominal_radius: float = 0.46  # m, at the wheel profile's z = 0
    flange_back_distance: float = 1.36  # m
    flange_back_position: float = -0.07  # m, of the flange back on the wheel profile's y axis

    @property
    def marker(self) -> float:
        """m, of the right wheel profile's y = 0 from the wheelset's centre."""
        return 0.5 * self.flange_back_distance - self.flange_back_position


@dataclass(frozen=True)
class ContactPoints:
    """The right wheel on its rail, [n] each; the left wheel is its mirror image at -y."""

    dimensions: Dimensions
    y: Array  # m, lateral position of the wheelset, to the right, symmetric about 0
    position: Array  # m, of the contact from the track's centre line; NaN: no contact
    contact_angle: Array  # rad
    rolling_radius: Array  # m, mean by load where the wheel touches in two places
    touches: NDArray[np.int64]  # -, places where the wheel touches

    @property
    def on_wheel(self) -> Array:
        """m, y of the contact on the wheel's profile."""
        return self.position - self.y - self.dimensions.marker

    @property
    def rolling_radius_difference(self) -> Array:
        """m, right minus left wheel."""
        return self.rolling_radius - self.rolling_radius[::-1]

    def conicity(self, amplitude: float) -> float:
        """tan(gamma), see equivalent_conicity; NaN beyond the positions with contact."""
        difference = self.rolling_radius_difference
        inside = np.isfinite(difference)
        # contact ends on both sides alike: what is left is one stretch around the middle
        middle = self.y.size // 2
        if not inside[middle]:
            return float("nan")
        beyond = np.flatnonzero(~inside[middle:])
        reach = int(beyond[0]) - 1 if beyond.size else middle
        part = slice(middle - reach, middle + reach + 1)
        if reach < 1:
            return float("nan")
        return equivalent_conicity(self.y[part], difference[part], amplitude)


def positions(reach: float, step: float) -> Array:
    """m, from -reach to reach in equal steps of about the given length, exactly symmetric."""
    count = max(1, round(reach / step))
    half = reach * np.arange(1, count + 1) / count
    return np.concatenate([-half[::-1], [0.0], half])


def contact_points(
    wheel: str | Path,
    rail: str | Path,
    y: ArrayLike | None = None,
    dimensions: Dimensions | None = None,
    *,
    smoothing: float | None = None,
    readings: Mapping[Role, Reading | None] | None = None,
) -> ContactPoints:
    """Contact points, angles and rolling radii of a wheel on a rail, both sides alike.

    wheel, rail: built-in names or files, as for load_profile; smoothing: m, likewise. readings: of
    the files, by role. y: m, lateral
    positions, increasing and symmetric about 0; by default -10 mm to 10 mm by 0.05 mm.
    Raises ProfileError, CaseError, ValueError.
    """
    at = positions(0.01, 5e-5) if y is None else np.asarray(y, dtype=float)
    if at.size < 3 or (np.diff(at) <= 0).any() or not np.array_equal(at, -at[::-1]):
        raise ValueError("y must increase, be symmetric about 0 and hold 3 positions or more")
    sizes = dimensions or Dimensions()
    contact = Contact(pair_case(wheel, rail, sizes, smoothing, readings or {}))
    values = np.full((3, at.size), np.nan)
    touches = np.zeros(at.size, dtype=np.int64)
    for index, place in enumerate(at):
        found = contact.step(y=float(place))
        if found.status != "converged":
            continue
        patches = found["patches"]
        touches[index] = len(patches)
        most = max(patches, key=lambda patch: patch["normal_force"])
        values[:, index] = most["position"][1], most["contact_angle"], found["rolling_radius"]
    return ContactPoints(sizes, at, *values, touches)


def pair_case(
    wheel: str | Path,
    rail: str | Path,
    sizes: Dimensions,
    smoothing: float | None,
    readings: Mapping[Role, Reading | None],
) -> dict:
    """The case of the right wheel at rest under a light load."""
    profiles: dict[str, Any] = {"wheel": str(wheel), "rail": str(rail)}
    if smoothing is not None:
        profiles["smoothing"] = smoothing
    for role, reading in readings.items():
        given = {
            key: value for key, value in asdict(reading or Reading()).items() if value is not None
        }
        if given:
            profiles[f"{role}_file"] = given
    return {
        "kind": "wheel_rail",
        # odd: an element lies where the approach is greatest
        "grid": {"elements": [5, 9]},
        "method": {"normal": "hertz", "tangential": "none", "tolerance": 1e-8},
        "wheelset": {
            "vertical_force": LIGHT_LOAD,
            "nominal_radius": sizes.nominal_radius,
            "flange_back_distance": sizes.flange_back_distance,
            "flange_back_position": sizes.flange_back_position,
        },
        "track": {"gauge": sizes.gauge, "gauge_height": sizes.gauge_height},
        "profiles": profiles,
    }
