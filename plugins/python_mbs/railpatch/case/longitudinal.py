"""Shapes along the rolling direction, from the keys of a case to the core's arrays.

All numbers in SI units. Wheel flats and rail joints are closed forms, given in the functions.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from railpatch.case.gap import read_rows
from railpatch.case.rolling import HIGHEST, Flat, Joint, RailShape, WheelShape
from railpatch.case.types import SIDES
from railpatch.errors import CaseError
from railpatch.profiles.elementary import acos, cos, tan
from railpatch.profiles.spline import cubic_spline

Values = NDArray[np.float64]
FLAT_SPACING = 5e-4  # m, along the circumference
RAIL_SPACING = 1e-3  # m, at most
POINTS = (8, 1_000_000)  # of a wheel
MOST_HEIGHTS = 10_000_000


def flat_runout(radius: float, flat: Flat, angles: Values) -> Values:
    """m, radius minus that of the circle at pitch angles, rad.

    A chord: R cos(a_f)/cos(a) - R for |a| < a_f, R (1 - cos a_f) = depth. Its ends, where it meets
    the circle at the angle a_f, are parabolas over the length of rounding, at most a third of it.
    """
    half = acos(1.0 - flat.depth / radius)
    a = (angles - flat.angle + np.pi) % (2 * np.pi) - np.pi
    inside = np.abs(a) < 2 * half
    chord = np.full_like(a, flat.depth)
    chord[inside] = radius * (cos(half) / cos(a[inside]) - 1.0)
    # least of chord and circle, rounded where they differ by less than b
    b = tan(half) * min(0.5 * flat.rounding, radius * half / 3)
    return smooth_least(chord, b)


def smooth_least(values: Values, b: float) -> Values:
    """Least of the values and 0, a parabola where they are within b of 0."""
    rounded = -((b - values) ** 2) / (4 * b)
    return np.where(values <= -b, values, np.where(values >= b, 0.0, rounded))


def joint_height(joint: Joint, x: Values) -> Values:
    """m, height of the running surface at positions along the track.

    -depth (1 - 2|x - x0|/length)^2 within the length, its kink at the joint rounded to a parabola;
    a step as a smooth rise over the length of rounding; a gap as a trench as wide as the gap and
    deep enough that a wheel does not touch its bottom, with flanks as long as the rounding / 4.
    """
    away = np.abs(x - joint.position)
    # |x| rounded: a parabola through the corner
    r = 0.5 * joint.rounding
    smooth = np.where(away < r, 0.5 * (away**2 / r + r), away)
    height = -joint.depth * np.clip(1.0 - 2.0 * smooth / joint.length, 0.0, None) ** 2
    height += joint.step * rise((x - joint.position) / joint.rounding)
    if joint.gap > 0:
        flank = 0.25 * joint.rounding
        trench = 1.0 - rise((away - 0.5 * joint.gap) / flank - 0.5)
        height -= 5e-4 * trench
    return height


def rise(t: Values) -> Values:
    """From 0 at t = -1/2 to 1 at t = 1/2, with two continuous derivatives."""
    u = np.clip(t + 0.5, 0.0, 1.0)
    return u * u * u * (10.0 - u * (15.0 - 6.0 * u))


def shape_config(case: Any, folder: Path) -> dict[str, Any]:
    """Fields of rp_config of a case with wheels; none where it has no such shapes."""
    radius = case.wheelset.nominal_radius
    wheels = [getattr(case.wheelset, side) for side in SIDES]
    rails = [getattr(case.track, side) for side in SIDES]
    config: dict[str, Any] = {}
    runouts: list[Any] = [
        wheel_runout(wheel, radius, folder, f"wheelset.{side}.runout")
        if side in case.sides
        else None
        for wheel, side in zip(wheels, SIDES, strict=True)
    ]
    if any(values is not None for values in runouts):
        check_heights(runouts, "wheelset", "runout")
        config["runout"] = runouts
    used = [
        rail if side in case.sides else RailShape() for rail, side in zip(rails, SIDES, strict=True)
    ]
    return {**config, **rail_heights(used, folder)}


def check_heights(sides: list[Any], table: str, key: str) -> None:
    """Refuses shapes that are higher or deeper than the core takes; of the key's rows, with what is
    added to them. sides: m, left and right; None: level or round. Raises CaseError."""
    for side, values in zip(SIDES, sides, strict=True):
        largest = 0.0 if values is None else float(values[np.abs(values).argmax()])
        if abs(largest) > HIGHEST:
            allowed = f"heights of {-HIGHEST:g} to {HIGHEST:g} m"
            raise CaseError(f"{table}.{side}.{key}: value is up to {largest:g}, allowed {allowed}")


def wheel_runout(wheel: WheelShape, radius: float, folder: Path, key: str) -> Values | None:
    """m, at equally spaced pitch angles; None: round."""
    if wheel.runout is None and wheel.flat is None:
        return None
    given = None
    if wheel.runout is not None:
        rows = columns_of(wheel.runout, folder, key, 1)
        given = rows[:, 0]
        if not POINTS[0] <= len(given) <= POINTS[1]:
            shown = f"{len(given)} values"
            raise CaseError(f"{key}: value is {shown}, allowed {POINTS[0]} ... {POINTS[1]}")
        if wheel.flat is None:
            return given
    count = int(np.ceil(2 * np.pi * radius / FLAT_SPACING))
    angles = 2 * np.pi * np.arange(count) / count
    runout = flat_runout(radius, wheel.flat, angles)
    if given is not None:
        around = 2 * np.pi * np.arange(len(given) + 1) / len(given)
        runout = runout + cubic_spline(around, np.append(given, given[0]), "periodic")(angles)
    return runout


def rail_heights(rails: list[RailShape], folder: Path) -> dict[str, Any]:
    """rail_height of both sides at the same positions; empty where all is level."""
    curves: list[list[Any]] = []
    low, high, spacing = np.inf, -np.inf, RAIL_SPACING
    for rail, side in zip(rails, SIDES, strict=True):
        own: list[Any] = []
        if rail.running_surface is not None:
            rows = columns_of(rail.running_surface, folder, f"track.{side}.running_surface", 2)
            own.append(surface_of(rows, f"track.{side}.running_surface"))
            low, high = min(low, rows[0, 0]), max(high, rows[-1, 0])
            spacing = min(spacing, float(np.diff(rows[:, 0]).min()))
        if rail.joint is not None:
            joint = rail.joint
            own.append(lambda x, joint=joint: joint_height(joint, x))
            reach = 0.5 * joint.length + joint.gap + joint.rounding
            low, high = min(low, joint.position - reach), max(high, joint.position + reach)
            spacing = min(spacing, joint.rounding / 16)
        curves.append(own)
    if not any(curves):
        return {}
    count = max(4, int(np.ceil((high - low) / spacing)) + 1)
    if count > MOST_HEIGHTS:
        raise CaseError(
            f"track: running_surface and joint ask for {count} heights {spacing:g} m apart, "
            f"allowed {MOST_HEIGHTS}"
        )
    x = low + spacing * np.arange(count)
    heights = [sum((curve(x) for curve in own), np.zeros(count)) if own else None for own in curves]
    check_heights(heights, "track", "running_surface")
    return {"rail_height": heights, "rail_height_start": low, "rail_height_spacing": spacing}


def surface_of(rows: Values, key: str) -> Any:
    """The smooth curve through heights, constant beyond."""
    x, height = rows[:, 0], rows[:, 1]
    if len(x) < 4 or not np.all(np.diff(x) > 0):
        raise CaseError(f"{key}: value is {len(x)} rows, allowed 4 or more of growing positions")
    spline = cubic_spline(x, height, (0.0, 0.0))
    return lambda at: spline(np.clip(at, x[0], x[-1]))


def columns_of(value: str | list[Any], folder: Path, key: str, columns: int) -> Values:
    """[rows, columns] of a text file or of nested lists."""
    if isinstance(value, list):
        return np.array(value, dtype=float).reshape(-1, columns)
    rows = read_rows(folder / value, key)
    for line, row in rows:
        if len(row) != columns:
            raise CaseError(
                f"{key}: {folder / value}:{line} holds {len(row)} values, allowed {columns}"
            )
    return np.array([row for _, row in rows], dtype=float).reshape(-1, columns)
