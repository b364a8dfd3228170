"""Built-in profiles by name, from formulas: exact values and slopes at dense knots."""

from __future__ import annotations

import dataclasses
import functools
import math
import re

import numpy as np
import scipy

from railpatch.errors import ProfileError
from railpatch.profiles.curve import Profile
from railpatch.profiles.elementary import GAUSS_8, atan, hypot, weighted_sum
from railpatch.profiles.formulas import (
    Piece,
    arc_piece,
    head_pieces,
    s1002_pieces,
    straight_piece,
    uic60_pieces,
)
from railpatch.profiles.raw import Role
from railpatch.profiles.worn import NUMBERS, RAIL, WHEEL, worn

# mm, longest distance of the knots: an arc of 12 mm is then met within 1e-8 mm
SPACING = 0.25
# mm, half width of "cone", "cylinder" and the widest "arc"
HALF_WIDTH = 70.0
# -, an "arc" ends where it is inclined by asin of this
ARC_END = 0.9
NAMES = (
    '"S1002", "UIC60", "60E1", "54E1", "UIC60@1:40", "cone@1:20", "arc@0.3" (radius in m), '
    '"cylinder", "worn@7" (number of a worn shape)'
)
RAILS = ("UIC60", "60E1", "54E1")
PATTERN = re.compile(r"(S1002|UIC60|60E1|54E1|cone|arc|cylinder|worn)(?:@(.*))?")


@functools.lru_cache(maxsize=64)
def builtin_profile(name: str, role: Role) -> Profile | None:
    """The built-in profile of that name, or None where the name is not built in.

    "S1002": wheel, y = 0 at the tread circle, flange back at -0.070 m. "UIC60": rail, uncanted;
    "60E1", "54E1": rails of EN 13674-1, uncanted. "UIC60@1:40", "60E1@1:20", ...: inclined towards
    the track's centre by atan(1/40), ...; highest point at (0, 0).
    "cone@1:20": line z = -y/20, wheel or roller. "cylinder": z = 0. "arc@R": crown of radius R in m
    for a rail, the same convex shape for a wheel. The last three are 0.14 m wide at most.
    "worn@7": the 7th worn shape of S1002 or UIC60@1:40, see worn.py.
    The same object each time, whose arrays cannot be written to.
    Raises ProfileError where the name is known, but not for this role or not with this number.
    """
    match = PATTERN.fullmatch(name)
    if match is None:
        return None
    kind, argument = match.groups()
    if kind == "S1002":
        require(name, role == "wheel" and argument is None, "is a wheel, written 'S1002'")
        return from_pieces(name, s1002_pieces())
    if kind in RAILS:
        require(name, role == "rail", "is a rail, not a wheel")
        rail = from_pieces(name, uic60_pieces() if kind == "UIC60" else head_pieces(kind))
        return rail if argument is None else inclined(rail, 1 / ratio(name, argument))
    if kind == "cylinder":
        require(name, argument is None, "is written 'cylinder'")
        return from_pieces(name, [line(0.0)])
    require(name, argument is not None, f"needs a number, as in {NAMES}")
    if kind == "worn":
        return worn_profile(name, argument, role)
    if kind == "cone":
        return from_pieces(name, [line(-1 / ratio(name, argument))])
    return from_pieces(name, [crown(name, argument, role)])


def require(name: str, good: bool, problem: str) -> None:
    """Raises ProfileError with the problem unless good."""
    if not good:
        raise ProfileError(name, problem)


def ratio(name: str, argument: str) -> float:
    """n of '1:n', from 1 to a million."""
    match = re.fullmatch(r"1:(\d+(?:\.\d+)?)", argument)
    value = float(match.group(1)) if match else math.nan
    require(name, 1 <= value <= 1e6, f"inclination is {argument!r}, allowed '1:n', n = 1 ... 1e6")
    return value


def worn_profile(name: str, argument: str, role: Role) -> Profile:
    """S1002 or UIC60@1:40 with the wear of that number."""
    good = argument.isascii() and argument.isdecimal() and len(argument) <= 6
    require(name, good, f"number is {argument!r}, allowed 0 ... {NUMBERS - 1}")
    new = builtin_profile("S1002" if role == "wheel" else "UIC60@1:40", role)
    assert new is not None
    shape = worn(new, WHEEL if role == "wheel" else RAIL, int(argument))
    return read_only(dataclasses.replace(shape, name=name))


def line(slope: float) -> Piece:
    """z = slope y over the full width."""
    return straight_piece((-HALF_WIDTH, -slope * HALF_WIDTH), (HALF_WIDTH, slope * HALF_WIDTH))


def crown(name: str, argument: str, role: Role) -> Piece:
    """Arc with its crown at (0, 0): falling to both sides on a rail, rising on a wheel."""
    try:
        radius = 1e3 * float(argument)
    except ValueError:
        radius = math.nan
    require(name, 10 <= radius <= 1e6, f"radius is {argument!r}, allowed 0.01 ... 1000 m")
    sign = -1.0 if role == "rail" else 1.0
    half = min(HALF_WIDTH, ARC_END * radius)
    return arc_piece(-half, half, (0.0, -sign * radius, radius, sign))


def inclined(rail: Profile, slope: float) -> Profile:
    """Turned towards the track's centre by atan(slope), highest point moved to (0, 0)."""
    turned = rail.moved(0.0, 0.0, -float(atan(slope)))
    top = int(np.argmin(turned.z))
    low, high = turned.arc_length[[max(top - 1, 0), min(top + 1, turned.z.size - 1)]]

    def fall(s: float) -> float:
        step = 1e-6
        ends = turned.evaluate([s - step, s + step])[1]
        return float(ends[1] - ends[0])

    y, z = turned.evaluate(scipy.optimize.brentq(fall, low, high, xtol=1e-14))
    return read_only(turned.moved(-float(y), -float(z)))


def from_pieces(name: str, pieces: list[Piece]) -> Profile:
    """Hermite knots in m over the pieces (mm); at a joint the mean of both sides is taken."""
    node, weight = np.array(GAUSS_8[0]), GAUSS_8[1]
    length, y, z, dy, dz = ([] for _ in range(5))
    arc = 0.0
    for first, last, point, rate in pieces:
        rough = float(hypot(*rate(np.linspace(first, last, 65))).mean() * (last - first))
        t = np.linspace(first, last, max(4, math.ceil(rough / SPACING)) + 1)
        half = 0.5 * np.diff(t)[:, None]
        at = t[:-1, None] + half * (1 + node)
        step = weighted_sum(hypot(*rate(at)), weight) * half[:, 0]
        s = arc + np.concatenate([[0.0], np.cumsum(step)])
        speed = hypot(*rate(t))
        knots = [s, *point(t), *(component / speed for component in rate(t))]
        for column, values in zip((length, y, z, dy, dz), knots, strict=True):
            if column:
                column[-1] = 0.5 * (column[-1] + values[0])
                values = values[1:]
            column.extend(values)
        arc = s[-1]
    m = [1e-3 * np.array(column) for column in (length, y, z)]
    return read_only(Profile(name, m[0], m[1], m[2], np.array(dy), np.array(dz)))


def read_only(profile: Profile) -> Profile:
    """The same one, whose arrays cannot be written to."""
    for array in (profile.arc_length, profile.y, profile.z, profile.dy, profile.dz):
        array.flags.writeable = False
    return profile
