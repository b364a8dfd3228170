"""Two plain columns y z, and the parsing of number lines that the other readers share."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from railpatch.errors import ProfileError
from railpatch.profiles.raw import RawProfile, Role

COMMENT = ("!", "#", "%", "//")
# a profile is some 0.1 m wide: a larger spread than this of the first column means mm
METRE_WIDTH = 1.0


def parse_numbers(path: Path, line: int, text: str, least: int = 2) -> list[float]:
    """The numbers of one line, separated by blanks, commas, semicolons or tabs."""
    words = [word for word in re.split(r"[\s,;]+", text.strip()) if word]
    try:
        # Fortran writes 1.0D+00
        values = [float(re.sub("[dD]", "e", word)) for word in words]
    except ValueError:
        raise ProfileError(path, f"expected numbers, found {text.strip()[:60]!r}", line) from None
    if len(values) < least:
        raise ProfileError(path, f"expected {least} numbers, found {text.strip()[:60]!r}", line)
    for value in values:
        if not np.isfinite(value):
            raise ProfileError(path, f"value {value} is not finite", line)
    return values


def read_columns(path: Path, text: str, role: Role | None) -> RawProfile:
    """Columns y, z and an optional weight; mm or m, told by the width; one line of titles."""
    if role is None:
        raise ProfileError(path, "say whether this is a 'wheel' or a 'rail' profile")
    points: list[list[float]] = []
    lines: list[int] = []
    titled = False
    for number, row in enumerate(text.splitlines(), 1):
        if not row.strip() or row.lstrip().startswith(COMMENT):
            continue
        if not points and not titled and re.fullmatch(r"[A-Za-z][^\d]*", row.strip()):
            titled = True
            continue
        values = parse_numbers(path, number, row)
        points.append([values[0], values[1], values[2] if len(values) > 2 else 1.0])
        lines.append(number)
    if not points:
        raise ProfileError(path, "holds no points")
    return from_points(path, points, lines, role, measured=False)


def from_points(
    path: Path,
    points: list[list[float]],
    lines: list[int],
    role: Role,
    *,
    measured: bool,
    unit: float | None = None,
) -> RawProfile:
    """Builds a RawProfile of [y, z, weight] rows; unit: m per unit of length, None: detected."""
    array = np.array(points, dtype=float)
    notes: list[str] = []
    if unit is None:
        in_mm = np.ptp(array[:, 0]) > METRE_WIDTH
        unit = 1e-3 if in_mm else 1.0
        notes.append(f"unit of length taken as {'mm' if in_mm else 'm'}")
    weight = array[:, 2]
    if (weight < 0).any():
        first = int(np.flatnonzero(weight < 0)[0])
        raise ProfileError(path, f"weight {weight[first]} is negative", lines[first])
    keep = weight > 0
    if not keep.all():
        notes.append(f"{np.count_nonzero(~keep)} points of weight 0 left out")
    return RawProfile(
        source=str(path),
        role=role,
        y=array[keep, 0] * unit,
        z=array[keep, 1] * unit,
        weight=weight[keep],
        line=np.array(lines)[keep],
        measured=measured,
        notes=notes,
    )
