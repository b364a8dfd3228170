"""A profile as the smooth curve that the core takes."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

from railpatch.errors import ProfileError
from railpatch.profiles.elementary import cos, sin

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Scatter:
    """What noise leaves to chance in the shape of a profile that was fitted to points.

    noise: m, standard deviation of a point across the profile. spacing: m, of the points.
    smoothing: m, [n], wave length about each knot of which half the amplitude is kept; 0:
    interpolation. flattened: m, [n], by which the same smoothing once more moves it across, z down.
    """

    noise: float
    spacing: float
    smoothing: Array
    flattened: Array


@dataclass(frozen=True)
class Profile:
    """A profile as a cubic Hermite curve in arc length (rp_profile of the C interface).

    Right-hand orientation: from the flange or gauge side (-y) to the field side (+y), z down.
    """

    name: str
    arc_length: Array  # m, [n], strictly increasing
    y: Array  # m, [n]
    z: Array  # m, [n], down
    dy: Array  # -, [n], derivative with respect to arc length
    dz: Array  # -, [n]
    notes: tuple[str, ...] = field(default=())  # what reading and clean-up changed
    scatter: Scatter | None = None  # of noisy points

    def __post_init__(self) -> None:
        for key in ("arc_length", "y", "z", "dy", "dz"):
            values = np.ascontiguousarray(getattr(self, key), dtype=float)
            if values.shape != (self.arc_length.size,) or not np.isfinite(values).all():
                raise ProfileError(self.name, f"{key} must hold finite values, one per knot")
            object.__setattr__(self, key, values)
        if self.arc_length.size < 4 or (np.diff(self.arc_length) <= 0).any():
            raise ProfileError(self.name, "arc_length must increase, with 4 knots or more")

    def evaluate(self, arc_length: ArrayLike) -> tuple[Array, Array]:
        """Position (y, z) in m at arc lengths in m; outside the ends the end's tangent is used."""
        s = np.asarray(arc_length, dtype=float)
        inside = np.clip(s, self.arc_length[0], self.arc_length[-1])
        k = np.clip(np.searchsorted(self.arc_length, inside) - 1, 0, self.arc_length.size - 2)
        h = self.arc_length[k + 1] - self.arc_length[k]
        t = (inside - self.arc_length[k]) / h
        h00, h10 = (1 + 2 * t) * (1 - t) ** 2, t * (1 - t) ** 2
        h01, h11 = t**2 * (3 - 2 * t), t**2 * (t - 1)
        end = np.where(s > inside, self.arc_length.size - 1, 0)
        out = []
        for value, slope in ((self.y, self.dy), (self.z, self.dz)):
            cubic = h00 * value[k] + h01 * value[k + 1] + h * (h10 * slope[k] + h11 * slope[k + 1])
            out.append(cubic + (s - inside) * slope[end])
        return out[0], out[1]

    def moved(self, dy: float, dz: float, angle: float = 0.0) -> Profile:
        """Turned by angle (rad, about x: y towards z), then moved by (dy, dz) in m."""
        c, s = cos(angle), sin(angle)
        return Profile(
            self.name,
            self.arc_length,
            c * self.y - s * self.z + dy,
            s * self.y + c * self.z + dz,
            c * self.dy - s * self.dz,
            s * self.dy + c * self.dz,
            self.notes,
            self.scatter,
        )
