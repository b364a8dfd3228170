"""SIMPACK rail and wheel profiles (.prr, .prw).

The keys of the spline block are applied in SIMPACK's own order: shift, rotation, bounds, mirror,
inversion, unit. Lengths are in the file's unit until the last step. '!' starts a comment.
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from railpatch.errors import ProfileError
from railpatch.profiles.columns import from_points, parse_numbers
from railpatch.profiles.elementary import cos, hypot, sin
from railpatch.profiles.raw import RawProfile, Reading, Role

ROLE_OF_TYPE: dict[int, Role] = {0: "rail", 1: "wheel"}
KEY = re.compile(r"([\w.]+)\s*=\s*(.*)")


def read_simpack(path: Path, text: str, role: Role | None, reading: Reading) -> RawProfile:
    """Reads header keys and points of a SIMPACK profile."""
    keys, points, lines = split_blocks(path, text)
    if not points:
        raise ProfileError(path, "holds no points")
    role = role_of(path, keys, role)
    if number(path, keys, "header.version", 1.0) != 1.0:
        raise ProfileError(path, f"version is {keys['header.version'][1]}, allowed 1")
    array, kept = process(path, keys, np.array(points))
    if not kept.any():
        raise ProfileError(path, "the y and z bounds leave no points")
    unit = 1.0 / number(path, keys, "spline.units.len.f", 1.0, positive=True)
    raw = from_points(
        path,
        array[kept].tolist(),
        [line for line, keep in zip(lines, kept, strict=True) if keep],
        role,
        measured=False,
        reading=reading,
        unit=unit,
    )
    if number(path, keys, "spline.inversion", 0.0):
        for name in ("y", "z", "weight", "line"):
            setattr(raw, name, getattr(raw, name)[::-1].copy())
    return raw


def split_blocks(
    path: Path, text: str
) -> tuple[dict[str, tuple[int, str]], list[list[float]], list[int]]:
    """Keys as 'block.key' -> (line, value), points as [y, z, weight], and their lines."""
    keys: dict[str, tuple[int, str]] = {}
    points: list[list[float]] = []
    lines: list[int] = []
    block = ""
    for line, row in enumerate(text.splitlines(), 1):
        words = row.split("!", 1)[0].strip()
        if not words:
            continue
        if words.endswith(".begin"):
            block = words.removesuffix(".begin")
        elif words.endswith(".end"):
            block = "spline" if block == "point" else ""
        elif block == "point":
            values = parse_numbers(path, line, words)
            points.append([values[0], values[1], values[2] if len(values) > 2 else 1.0])
            lines.append(line)
        elif match := KEY.match(words):
            keys[f"{block}.{match.group(1)}"] = (line, match.group(2).strip().strip("'"))
        else:
            raise ProfileError(path, f"expected 'key = value', found {words[:60]!r}", line)
    if block:
        raise ProfileError(path, f"is cut off: '{block}.end' is missing")
    return keys, points, lines


def number(
    path: Path,
    keys: dict[str, tuple[int, str]],
    key: str,
    default: float,
    *,
    positive: bool = False,
) -> float:
    """The value of a key as a number."""
    if key not in keys:
        return default
    line, text = keys[key]
    value = parse_numbers(path, line, text, least=1)[0]
    if positive and value <= 0:
        raise ProfileError(path, f"{key.split('.', 1)[1]} is {value}, allowed > 0", line)
    return value


def role_of(path: Path, keys: dict[str, tuple[int, str]], role: Role | None) -> Role:
    """The role by header.type, checked against the one asked for."""
    kind = number(path, keys, "header.type", -1.0)
    said = ROLE_OF_TYPE.get(int(kind))
    if "header.type" in keys and said is None:
        raise ProfileError(path, f"type is {kind}, allowed 0 (rail) or 1 (wheel)")
    if said is not None and role is not None and said != role:
        raise ProfileError(path, f"is a {said} profile by its header, a {role} is needed")
    found = role or said
    if found is None:
        raise ProfileError(path, "says neither 'type = 0' (rail) nor 'type = 1' (wheel)")
    return found


def process(
    path: Path, keys: dict[str, tuple[int, str]], points: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Shift, rotation, bounds and mirror; returns the points and which of them are kept."""
    y = points[:, 0] + number(path, keys, "spline.shift.y", 0.0)
    z = points[:, 1] + number(path, keys, "spline.shift.z", 0.0)
    unit = number(path, keys, "spline.units.ang.f", 1.0, positive=True)
    angle = number(path, keys, "spline.rotate", 0.0) / unit
    y, z = y * cos(angle) - z * sin(angle), y * sin(angle) + z * cos(angle)
    kept = np.ones(y.size, dtype=bool)
    for axis, values in (("y", y), ("z", z)):
        low = number(path, keys, f"spline.bound.{axis}.min", 1.0)
        high = number(path, keys, f"spline.bound.{axis}.max", 0.0)
        # SIMPACK switches bounds off by a lower bound above the upper one
        if low < high:
            kept &= (values >= low) & (values <= high)
    kept &= far_enough(y, z, number(path, keys, "spline.point.dist.min", 0.0))
    if number(path, keys, "spline.mirror.y", 0.0):
        y = -y
    if number(path, keys, "spline.mirror.z", 0.0):
        z = -z
    return np.column_stack([y, z, points[:, 2]]), kept


def far_enough(y: np.ndarray, z: np.ndarray, distance: float) -> np.ndarray:
    """Which points lie at least `distance` from the last kept one."""
    kept = np.ones(y.size, dtype=bool)
    last = 0
    for i in range(1, y.size):
        if hypot(y[i] - y[last], z[i] - z[last]) < distance:
            kept[i] = False
        else:
            last = i
    return kept
