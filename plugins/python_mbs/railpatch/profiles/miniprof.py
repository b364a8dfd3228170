"""MiniProf measurements (.ban rails, .whl wheels): 'Key=Value' header, then columns in mm."""

from __future__ import annotations

import re
from pathlib import Path

from railpatch.errors import ProfileError
from railpatch.profiles.columns import from_points, parse_numbers
from railpatch.profiles.raw import RawProfile, Reading, Role

HEADER = re.compile(r"\s*([A-Za-z][\w.]*)\s*=(.*)")


def read_miniprof(path: Path, text: str, role: Role | None, reading: Reading) -> RawProfile:
    """Reads the columns X and Y named by ColumnDef (Y is the height); XYPoints must agree.

    Xoffset and Yoffset of the header describe the instrument and are not added.
    """
    header, rows = split_header(path, text)
    if role is None:
        raise ProfileError(path, "say whether this is a 'wheel' or a 'rail' profile: role, --role")
    columns = [name.strip().upper() for name in header.get("columndef", "X,Y").split(",")]
    if "X" not in columns or "Y" not in columns:
        raise ProfileError(path, f"ColumnDef={','.join(columns)} names no columns X and Y")
    ix, iy = columns.index("X"), columns.index("Y")
    points, lines = [], []
    for number, row in rows:
        values = parse_numbers(path, number, row, least=max(ix, iy) + 1)
        points.append([values[ix], values[iy], 1.0])
        lines.append(number)
    if not points:
        raise ProfileError(path, "holds no points")
    check_count(path, header, len(points))
    return from_points(path, points, lines, role, measured=True, reading=reading, unit=1e-3)


def split_header(path: Path, text: str) -> tuple[dict[str, str], list[tuple[int, str]]]:
    """Header by lower-case key, and the numbered lines after it."""
    header: dict[str, str] = {}
    rows: list[tuple[int, str]] = []
    for number, row in enumerate(text.splitlines(), 1):
        match = HEADER.match(row)
        if match and not rows:
            header[match.group(1).lower()] = match.group(2).strip()
        elif match:
            raise ProfileError(path, f"header line {row.strip()[:60]!r} among the points", number)
        elif row.strip():
            rows.append((number, row))
    return header, rows


def check_count(path: Path, header: dict[str, str], found: int) -> None:
    """A file that was cut off has fewer points than its header says."""
    said = header.get("xypoints")
    if said is None:
        return
    if not said.isdigit() or int(said) != found:
        raise ProfileError(path, f"holds {found} points, its header says XYPoints={said}")
