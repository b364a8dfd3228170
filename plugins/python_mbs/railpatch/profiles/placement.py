"""What a wheel's profile says of its flange, where the scene puts it.

The tread's datum lies 70 mm from the flange's back, and the flange's thickness is measured 10 mm
below it, from the back (EN 13715, EN 15302, EN 15313: Sd; its height below the datum: Sh). S1002
has 32.5 and 28 mm.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite

import numpy as np
from numpy.typing import NDArray

from railpatch.profiles.orientation import FLANGE_HEIGHT, TAPING_LINE

Array = NDArray[np.float64]

# m, below the tread's datum, of the flange's thickness
BELOW = 0.010
# m, thickness of flanges: EN 15313 allows 22 to 33 mm in service (25 under 840 mm diameter, 27.5
# under 760 mm), wheels measured for report DOT/FRA/ORD-24/18, with AAR's flange, have 36.7 mm
THICKNESS = (0.020, 0.038)
# m, by which the back in the points may lie from where it is said to be
BACK_OFF = 1.5e-3
# m, by which the tread may lie off the nominal radius: more than hollow treads in service have
TREAD_OFF = 4e-3


@dataclass(frozen=True)
class Flange:
    """m: tread, how far its datum lies below the nominal radius; thickness, counted from where the
    back is said to be; height; back, y of the points there, NaN where they end before."""

    tread: float
    thickness: float
    height: float
    back: float

    def note(self, flange_back: float, distance: float) -> str:
        """What was taken for what. flange_back: m, where the back is said to be; distance: m, said
        between both wheels'."""
        seen = ""
        if isfinite(self.back):
            apart = distance + 2 * (self.back - flange_back)
            seen = f" (in the points at {1e3 * self.back:.1f} mm, both {1e3 * apart:.1f} mm apart)"
        return (
            f"origin as in the file: flange back at y = {1e3 * flange_back:.1f} mm{seen}, flange "
            f"{1e3 * self.thickness:.1f} mm thick and {1e3 * self.height:.1f} mm high, tread datum "
            f"{1e3 * self.tread + 0.0:.2f} mm below the nominal radius"
        )

    def doubts(self, flange_back: float) -> list[str]:
        """Why the profile can hardly lie where it is put."""
        found = []
        low, high = THICKNESS
        if not low <= self.thickness <= high:
            found.append(
                f"flange is {1e3 * self.thickness:.3g} mm thick 10 mm below the tread datum, "
                f"counted from wheelset.flange_back_position, outside {1e3 * low:g} to "
                f"{1e3 * high:g} mm (S1002 has 32.5 mm)"
            )
        if isfinite(self.back) and abs(self.back - flange_back) > BACK_OFF:
            found.append(
                f"flange back lies at y = {1e3 * self.back:.4g} mm of the points, "
                f"{1e3 * abs(self.back - flange_back):.3g} mm from wheelset.flange_back_position: "
                "say that, or origin of the file"
            )
        if abs(self.tread) > TREAD_OFF:
            found.append(
                f"tread datum, 70 mm from the flange back, lies {1e3 * self.tread:.3g} mm below "
                "wheelset.nominal_radius: say the radius there, or origin of the file"
            )
        return found


def flange_of(y: Array, z: Array, flange_back: float) -> Flange | None:
    """Of a wheel's profile, m, in the wheel's axes; None without a flange or tread there.

    flange_back: m, where its back is said to be.
    """
    tip = int(np.argmax(z))
    at = flange_back + TAPING_LINE
    if not y[tip] < at <= y[-1] or float(z.max() - np.median(z)) < FLANGE_HEIGHT:
        return None
    tread = float(np.interp(at, y[tip:], z[tip:]))
    level = tread + BELOW
    outer = crossing(y[tip:], z[tip:], level)
    if not isfinite(outer):
        return None
    inner = crossing(y[tip::-1], z[tip::-1], level)
    return Flange(tread, outer - flange_back, float(z[tip]) - tread, inner)


def gauge_note(y: Array, z: Array, gauge_height: float) -> str:
    """Where a rail's profile is held, whatever its origin. gauge_height: m, below its top."""
    top = int(np.argmin(z))
    beside = z[: top + 1] - z[top] <= gauge_height
    return (
        f"placed by its top, at y = {1e3 * float(y[top]):.1f} mm, and its gauge side, at y = "
        f"{1e3 * float(y[: top + 1][beside].min()):.1f} mm, whatever its origin"
    )


def crossing(y: Array, z: Array, level: float) -> float:
    """y at which z, from a maximum, first falls below a level; NaN where it does not."""
    below = np.flatnonzero(z < level)
    if not below.size or below[0] == 0:
        return float("nan")
    k = int(below[0])
    share = (z[k - 1] - level) / (z[k - 1] - z[k])
    return float(y[k - 1] + share * (y[k] - y[k - 1]))
