"""Which way a profile's points lie: found by rules that are noted, asked for where they are not
certain.

A wheel's flange and the sides of a rail's head lie below the running surface, which tells up from
down; a wheel's flange tells its inner side. Nothing tells the gauge side of a rail whose head is
symmetric: then -y is taken, unless the head leans the other way.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from railpatch.errors import ProfileError
from railpatch.profiles.elementary import cos, sin
from railpatch.profiles.raw import Mirror, RawProfile, Reading, Role

Array = NDArray[np.float64]

# how far a column goes over how far it goes to and fro: y follows the profile, z need not
FOLLOWS, TURNS = 0.8, 0.6
# a column that spans less than this of the other is no width
NARROW = 0.5
# the deviations from the median to one side over those to the other that tell up from down
CERTAIN = 1.5
# m, a wheel's flange stands out of the tread, a rail's sides lie below its top, by more than this
FLANGE_HEIGHT = 0.01
SIDE_HEIGHT = 0.002
# of the width, how far from an end a flange's tip may lie
FLANGE_ZONE = 0.4
# m, by how much a flange's inner side comes back from its tip
FLANGE_BACK = 1e-3
# m: how far a flange's tip may lie from the flange back, where the radius is measured from there,
# and how far the tread may lie from the nominal radius
TIP_RANGE = (0.003, 0.035)
TAPING_LINE = 0.07
TREAD_HEIGHT = 0.01
# a head leans by an inclination between these; m, how symmetric it is then about its axis
LEANS = (1 / 80, 1 / 12)
SYMMETRIC = 5e-5


def check_columns(path: object, points: Array, swap: bool | None) -> bool:
    """Whether the columns are z, y. Raises ProfileError where it seems so and was not said."""
    if swap is not None:
        return swap
    y, z = points[:, 0], points[:, 1]
    turning = follows(y) < TURNS and follows(z) > FOLLOWS
    narrow = np.ptp(y) < NARROW * np.ptp(z) and follows(z) > FOLLOWS
    if turning or narrow:
        raise ProfileError(
            path,
            "seems to hold z, y in place of y, z: its second column follows the profile, its first "
            "does not; say swap = true or swap = false",
        )
    return False


def follows(values: Array) -> float:
    """1 where values only rise or only fall; 0 where they end where they began."""
    way = float(np.abs(np.diff(values)).sum())
    return abs(float(values[-1] - values[0])) / way if way > 0 else 0.0


def orient(raw: RawProfile, reading: Reading) -> None:
    """Turns the points to z down, flange or gauge side at -y, that side first.

    Raises ProfileError where no rule is certain, or the points are not of the role.
    """
    mirror = reading.mirror
    if mirror is None:
        mirror = found_mirror(raw)
        said = ""
    else:
        said = " as asked"
    raw.taken = replace(raw.taken, mirror=mirror)
    for axis in ("y", "z"):
        if axis in mirror and mirror != "none":
            setattr(raw, axis, -getattr(raw, axis))
            raw.notes.append(f"{axis} mirrored{said}: {REASONS[raw.role, axis]}")
    if raw.y[0] > raw.y[-1]:
        for name in ("y", "z", "weight", "line"):
            setattr(raw, name, getattr(raw, name)[::-1].copy())
        raw.notes.append("points turned round, to begin at -y")
    if reading.origin is not None:
        raw.y = raw.y - reading.origin[0]
        raw.z = raw.z - reading.origin[1]
    check_role(raw)
    if reading.mirror is None and raw.role == "rail":
        check_lean(raw)


REASONS: dict[tuple[Role, str], str] = {
    ("wheel", "y"): "the flange lay at +y",
    ("wheel", "z"): "the flange pointed to -z",
    ("rail", "y"): "the gauge side lay at +y",
    ("rail", "z"): "the head pointed to +z",
}


def found_mirror(raw: RawProfile) -> Mirror:
    """The axes that point the other way. Raises ProfileError where nothing tells."""
    median = np.median(raw.z)
    down, up = float(raw.z.max() - median), float(median - raw.z.min())
    depth = FLANGE_HEIGHT if raw.role == "wheel" else SIDE_HEIGHT
    if max(down, up) < depth or max(down, up) < CERTAIN * min(down, up):
        if raw.role == "rail" and (sign := bend(raw.y, raw.z)):
            turned = sign < 0
        else:
            what = "flange" if raw.role == "wheel" else "side of a rail's head"
            raise ProfileError(
                raw.source,
                f"shows no {what} by which up is told from down: say mirror = 'none' where z "
                "points down and the flange or gauge side lies at -y, else 'y', 'z' or 'yz'",
            )
    else:
        turned = up > down
    if raw.role == "rail":
        raw.notes.append("the gauge side is taken to lie at -y")
        return "z" if turned else "none"
    tip = float(raw.y[np.argmin(raw.z) if turned else np.argmax(raw.z)])
    share = (tip - raw.y.min()) / np.ptp(raw.y)
    if FLANGE_ZONE < share < 1 - FLANGE_ZONE:
        raise ProfileError(
            raw.source,
            f"has its deepest point in the middle, at y = {1e3 * tip:.4g} mm, where no flange is: "
            "is it a wheel's? then say mirror = 'none', 'y', 'z' or 'yz'",
        )
    inner = "y" if share > 0.5 else ""
    return {"": "none", "y": "y", "z": "z", "yz": "yz"}[inner + ("z" if turned else "")]  # type: ignore[return-value]


def bend(y: Array, z: Array) -> int:
    """1 where the points bend downwards on both sides as a head does, -1 upwards, 0: not clear."""
    middle, half = 0.5 * (y.max() + y.min()), 0.5 * np.ptp(y)
    u = (y - middle) / half
    terms = np.column_stack([np.ones_like(u), u, u * u])
    found = np.linalg.lstsq(terms, z, rcond=None)[0]
    left = float(np.sqrt(np.mean((z - terms @ found) ** 2)))
    if abs(found[2]) < 5 * left or abs(found[2]) < 1e-4:
        return 0
    return 1 if found[2] > 0 else -1


def check_role(raw: RawProfile) -> None:
    """Refuses a rail with a flange, and a wheel that falls off on both sides as a head does."""
    tip = int(np.argmax(raw.z))
    before, after = raw.z[: tip + 1], raw.z[tip:]
    back = float(raw.z[tip] - before[0])
    deep = float(raw.z[tip] - after.min())
    flange = deep > FLANGE_HEIGHT and back > FLANGE_BACK and raw.y[tip] > raw.y[0]
    if raw.role == "rail" and flange:
        raise ProfileError(
            raw.source, "has a flange: it seems to be a wheel's profile, a rail is needed"
        )
    top = int(np.argmin(raw.z))
    falls = min(raw.z[:top].max(initial=-1.0), raw.z[top:].max(initial=-1.0)) - raw.z[top]
    if raw.role == "wheel" and not flange and falls > FLANGE_HEIGHT:
        raise ProfileError(
            raw.source,
            "falls off on both sides as a rail's head: it seems to be a rail's profile, a wheel is "
            "needed",
        )


def check_placed(name: object, y: Array, z: Array, flange_back: float) -> None:
    """Refuses a wheel whose flange does not stand beside the flange back, or whose tread is far
    from its nominal radius: every radius and position counts from the profile's origin.

    y, z: m, of the profile in the wheel's axes. flange_back: m, its position on the y axis.
    """
    if float(z.max() - np.median(z)) < FLANGE_HEIGHT:
        return
    tip = float(y[np.argmax(z)]) - flange_back
    at = flange_back + TAPING_LINE
    height = float(np.interp(at, y, z)) if y[0] <= at <= y[-1] else 0.0
    if not TIP_RANGE[0] <= tip <= TIP_RANGE[1] or abs(height) > TREAD_HEIGHT:
        raise ProfileError(
            name,
            f"has its flange's tip {1e3 * tip:.4g} mm from the flange back "
            f"(wheelset.flange_back_position), and lies {1e3 * height:.4g} mm below the nominal "
            f"radius {1e3 * TAPING_LINE:g} mm from it, allowed {1e3 * TIP_RANGE[0]:g} to "
            f"{1e3 * TIP_RANGE[1]:g} mm and {-1e3 * TREAD_HEIGHT:g} to {1e3 * TREAD_HEIGHT:g} mm: "
            "say wheelset.flange_back_position, which is -0.07 for S1002, or of a file "
            "origin = [y, z] in m, the place in it where the nominal radius is measured",
        )


def check_gauge_side(name: object, y: Array, z: Array, gauge_height: float) -> None:
    """Refuses a rail that is cut off above where its gauge is measured: it would be placed by the
    point where it ends, towards the wheel by what is missing.

    y, z: m, of the profile. gauge_height: m, below the top.
    """
    top = int(np.argmin(z))
    depth = float(z[: top + 1].max() - z[top])
    if depth < gauge_height:
        raise ProfileError(
            name,
            f"ends {1e3 * depth:.4g} mm below its top on the gauge side (-y), allowed "
            f"track.gauge_height, {1e3 * gauge_height:.4g} mm, or more: the rail is placed by its "
            "point there. Measure further down, or say a smaller gauge_height with the gauge there",
        )


def check_lean(raw: RawProfile) -> None:
    """Refuses a symmetric head that leans away from the track: y seems to be mirrored."""
    angle = lean(raw.y, raw.z)
    if angle is not None and angle < -LEANS[0]:
        raise ProfileError(
            raw.source,
            f"is a head that leans by 1:{-1 / angle:.0f} away from the track where its gauge side "
            "lies at -y: say mirror = 'y' where it lies at +y, else mirror = 'none'",
        )


def lean(y: Array, z: Array) -> float | None:
    """rad, by which a head leans towards -y; None where it is symmetric about no leaning axis."""
    angles = np.linspace(-LEANS[1], LEANS[1], 81)
    errors = np.array([asymmetry(y, z, angle) for angle in angles])
    if not np.isfinite(errors).all():
        return None
    best = int(np.argmin(errors))
    upright = errors[angles.size // 2]
    if errors[best] > SYMMETRIC or upright < 3 * errors[best] or abs(angles[best]) < LEANS[0]:
        return None
    return float(angles[best])


def asymmetry(y: Array, z: Array, angle: float) -> float:
    """m, how far the middle between both sides wanders from 2 to 10 mm below the top, once the
    points are turned upright by the angle; inf where a side is not so high."""
    c, s = cos(angle), sin(angle)
    u, w = c * y - s * z, s * y + c * z
    top = int(np.argmin(w))
    depth = w[top] + np.linspace(2e-3, 1e-2, 9)
    sides = []
    for part_u, part_w in ((u[top::-1], w[top::-1]), (u[top:], w[top:])):
        rising = np.maximum.accumulate(part_w)
        if rising[-1] < depth[-1]:
            return float("inf")
        sides.append(np.interp(depth, rising, part_u))
    middle = 0.5 * (sides[0] + sides[1])
    return float(np.std(middle))
