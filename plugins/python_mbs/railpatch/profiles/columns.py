"""Two plain columns y z, and the parsing of number lines that the other readers share."""

from __future__ import annotations

import re
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np

from railpatch.delimited import COMMENT, DECIMAL_COMMA, decimal_points, number
from railpatch.errors import ProfileError
from railpatch.profiles.noise import rounding_of
from railpatch.profiles.orientation import check_columns
from railpatch.profiles.raw import METRES, RawProfile, Reading, Role

# a profile is some 0.1 m wide: a larger spread than this of the first column means mm
METRE_WIDTH = 1.0
# the line of titles begins with a letter, also between quotes, and has no digits
TITLES = re.compile(r"[\"']?[^\W\d_][^\d]*")
HEADS = ": before them one line of titles without digits; others begin with #, !, % or //"
# a unit of length in it: "y [mm]; z [mm]"
TITLED_UNIT = re.compile(r"[\[(]\s*(" + "|".join(METRES) + r")\s*[\])]")


def parse_numbers(
    path: Path, line: int, text: str, least: int = 2, before: str = ""
) -> list[float]:
    """The numbers of one line, separated by blanks, commas, semicolons or tabs. before: what may
    stand in place of numbers there, for the message."""
    words = [word for word in re.split(r"[\s,;]+", text.strip()) if word]
    try:
        values = [number(word) for word in words]
    except ValueError:
        found = f"expected numbers, found {text.strip()[:60]!r}{before}"
        raise ProfileError(path, found, line) from None
    if len(values) < least:
        raise ProfileError(path, f"expected {least} numbers, found {text.strip()[:60]!r}", line)
    for value in values:
        if not np.isfinite(value):
            what = f"value {value} is not finite: leave out the line of such a point"
            raise ProfileError(path, what, line)
    return values


def with_points(path: Path, text: str) -> tuple[str, str]:
    """The text with decimal points, and a note where it had decimal commas.

    A comma between digits is a decimal one where something else separates the numbers; comments
    may say what they like. Raises ProfileError where commas may be either.
    """
    numbers = (row for row in text.splitlines() if not row.lstrip().startswith(COMMENT))
    rows = [row for row in numbers if DECIMAL_COMMA.search(row)]
    if not rows:
        return text, ""
    apart = [len(re.split(r"[;\t]|(?<=\d) +(?=[-+\d])", row.strip().rstrip(";"))) for row in rows]
    if min(apart) >= 2:
        return decimal_points(text), "decimal commas"
    if any(row.count(",") > 2 and "." not in row for row in rows):
        raise ProfileError(
            path,
            f"has commas that may be decimal ones or stand between numbers: {rows[0][:60]!r}; "
            "allowed decimal points, or ';' between numbers",
        )
    return text, ""


def read_columns(path: Path, text: str, role: Role | None, reading: Reading) -> RawProfile:
    """Columns y, z and an optional weight; one line of titles. The unit of length is that of the
    titles, else mm or m by the width."""
    text, commas = with_points(path, text)
    if role is None:
        raise ProfileError(path, "say whether this is a 'wheel' or a 'rail' profile: role, --role")
    points: list[list[float]] = []
    lines: list[int] = []
    titles, width = "", 0
    for at, row in enumerate(text.splitlines(), 1):
        if not row.strip() or row.lstrip().startswith(COMMENT):
            continue
        if not points and not titles and TITLES.fullmatch(row.strip()):
            titles = row.strip()
            continue
        values = parse_numbers(path, at, row, before="" if points else HEADS)
        width = len(values)
        points.append([values[0], values[1], values[2] if len(values) > 2 else 1.0])
        lines.append(at)
    if not points:
        raise ProfileError(path, "holds no points")
    if len(points) > 2 and all(b[0] - a[0] == 1 for a, b in pairwise(points)) and width > 2:
        raise ProfileError(
            path, "counts its points in the first column: allowed y, z and a weight of each point"
        )
    notes = [commas] if commas else []
    if width > 2:
        notes += weight_notes(path, [point[2] for point in points])
    units = set(TITLED_UNIT.findall(titles))
    unit = units.pop() if len(units) == 1 and reading.unit is None else None
    if unit is not None:
        notes.append(f"unit of length {unit}, as its titles say")
    metres = METRES[unit] if unit is not None else None
    raw = from_points(
        path, points, lines, role, measured=False, reading=reading, unit=metres, named=unit
    )
    raw.notes[:0] = notes
    return raw


def weight_notes(path: Path, weights: list[float]) -> list[str]:
    """What is told of a third column. Raises ProfileError where it rises or falls all the way, as
    a time or a distance does."""
    if all(b > a for a, b in pairwise(weights)) or all(b < a for a, b in pairwise(weights)):
        raise ProfileError(
            path,
            f"has a third column that goes from {weights[0]:g} to {weights[-1]:g} without a turn, "
            "which is no weight of the points: leave it out",
        )
    low, high = min(weights), max(weights)
    return [f"third column taken as the points' weights, {low:g} to {high:g}"] if low < high else []


def from_points(
    path: Path,
    points: list[list[float]],
    lines: list[int],
    role: Role,
    *,
    measured: bool,
    reading: Reading,
    unit: float | None = None,
    named: str | None = None,
) -> RawProfile:
    """Builds a RawProfile of [y, z, weight] rows; unit: m per unit of length, None: detected.
    named: its name in METRES, where a scene can say it."""
    array = np.array(points, dtype=float)
    notes: list[str] = []
    taken = replace(reading, swap=len(points) >= 5 and check_columns(path, array, reading.swap))
    if taken.swap:
        array[:, :2] = array[:, 1::-1]
        notes.append("columns taken as z, y")
    if reading.unit is not None:
        unit = METRES[reading.unit]
        notes.append(f"unit of length {reading.unit} as asked")
    if named is not None:
        taken = replace(taken, unit=named)
    if unit is None:
        in_mm = np.ptp(array[:, 0]) > METRE_WIDTH
        unit = 1e-3 if in_mm else 1.0
        taken = replace(taken, unit="mm" if in_mm else "m")
        notes.append(f"unit of length taken as {'mm' if in_mm else 'm'}")
    rounding = rounding_of(array[:, 1]) * unit
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
        taken=taken,
        rounding=rounding,
    )
