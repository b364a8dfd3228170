"""Points of a profile as read from a file, brought to metres and right-hand orientation."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from railpatch.errors import ProfileError

Role = Literal["wheel", "rail"]
Array = NDArray[np.float64]

# m, a wheel or rail profile narrower or wider than this is a mistake in the units
WIDTH_RANGE = (0.01, 0.5)
# z is taken as pointing down unless the deviations from the median are this much larger upwards
UP_RATIO = 1.5
# m, a wheel's flange is recognised when it stands out of the tread by more than this
FLANGE_HEIGHT = 0.01


@dataclass
class RawProfile:
    """Points of a profile, metres, from the flange or gauge side (-y) to the field side, z down."""

    source: str
    role: Role
    y: Array  # m, [n]
    z: Array  # m, [n], down
    weight: Array  # -, [n], weight of each point in the smoothing
    line: NDArray[np.int64]  # [n], line number of each point in the file
    measured: bool  # a measurement with noise (True) or designed points (False)
    notes: list[str] = field(default_factory=list)  # what the reader changed


def check_points(raw: RawProfile) -> None:
    """Refuses too few points, values that are not finite, and an impossible width."""
    if raw.y.size < 5:
        raise ProfileError(raw.source, f"holds {raw.y.size} points, needs 5 or more")
    bad = np.flatnonzero(~(np.isfinite(raw.y) & np.isfinite(raw.z)))
    if bad.size:
        first = bad[0]
        raise ProfileError(
            raw.source,
            f"point ({raw.y[first]}, {raw.z[first]}) is not finite",
            int(raw.line[first]),
        )
    width = float(np.ptp(raw.y))
    if not WIDTH_RANGE[0] <= width <= WIDTH_RANGE[1]:
        raise ProfileError(
            raw.source,
            f"is {width:.6g} m wide, allowed {WIDTH_RANGE[0]} ... {WIDTH_RANGE[1]} m: "
            "wrong unit of length?",
        )


def orient(raw: RawProfile) -> None:
    """Turns the points to z down, flange at -y, first point on the flange or gauge side."""
    median = np.median(raw.z)
    down, up = raw.z.max() - median, median - raw.z.min()
    # flange of a wheel and sides of a rail both lie below the running surface
    if up > UP_RATIO * down:
        raw.z = -raw.z
        raw.notes.append("z pointed up: mirrored")
        down = up
    if raw.role == "wheel" and down > FLANGE_HEIGHT:
        flange = raw.y[np.argmax(raw.z)]
        if flange > 0.5 * (raw.y.max() + raw.y.min()):
            raw.y = -raw.y
            raw.notes.append("flange lay at +y: mirrored")
    if raw.y[0] > raw.y[-1]:
        for name in ("y", "z", "weight", "line"):
            setattr(raw, name, getattr(raw, name)[::-1].copy())
