"""Points of a profile as read from a file, and what the file does not say of them itself."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from railpatch.errors import ProfileError

Role = Literal["wheel", "rail"]
Unit = Literal["m", "mm", "in"]
Mirror = Literal["none", "y", "z", "yz"]
Array = NDArray[np.float64]

METRES: dict[Unit, float] = {"m": 1.0, "mm": 1e-3, "in": 0.0254}
# m, a wheel or rail profile narrower or wider than this is a mistake in the units
WIDTH_RANGE = (0.01, 0.5)


@dataclass(frozen=True)
class Reading:
    """What a file does not say of itself. None: found by rules, and asked for where they are not
    certain.

    unit: of length in the file. swap: the columns are z, y in place of y, z. mirror: the axes that
    point the other way in the file than from the flange or gauge side to the field side, and down.
    origin: [y, z], m, of the profile's origin in the file's axes, after swap and mirror.
    """

    unit: Unit | None = None
    swap: bool | None = None
    mirror: Mirror | None = None
    origin: tuple[float, float] | None = None


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
    notes: list[str] = field(default_factory=list)  # what was assumed and changed
    taken: Reading = field(default_factory=Reading)  # what was said or found; None: the file says
    rounding: float = 0.0  # m, step that most heights are multiples of; 0: finer than matters


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
            f"is {width:.6g} m wide, allowed {WIDTH_RANGE[0]} ... {WIDTH_RANGE[1]} m: wrong unit "
            f"of length? unit may be {', '.join(METRES)}",
        )
