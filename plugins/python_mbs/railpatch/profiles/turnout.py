"""Rails of a turnout by formula: a blade at its stock rail, a crossing's nose and its wing rail.

Own shapes of simple arcs and straight lines with round numbers of the usual size (assumed), for
trials, tests and pages: no drawing of a turnout in use. In the axes of a right rail whose gauge
line is y = 0 and whose running plane is z = 0; y to the field side, z down, x along the track, m.

    python -m railpatch.profiles.turnout crossing -o DIR

writes a file of points for each slice, and a case that uses them.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from railpatch.profiles.elementary import asin, cos, sin

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

Array = NDArray[np.float64]
POINT_SPACING = 2.5e-4  # m, at most
BOTTOM = 0.03  # m, below the running plane: where profiles end, and of gaps
CORNER = 0.013  # m, radius of a rail's corners (as 60E1)
NOSE_CORNER = 0.01  # m
WIDTH = 0.07  # m, of a head
CROWN = 0.3  # m, radius of a head
LEAN = 0.15  # rad, of faces from upright
FLANGEWAY = 0.044  # m
DIVERGENCE = 1 / 15  # of both routes' gauge lines at a crossing
NOSE_TIP, BLADE_TIP = 0.006, 0.003  # m, how wide
BLADE_DIVERGENCE = 1 / 60  # of a stock rail's face and the gauge line


@dataclass(frozen=True)
class Slice:
    """A rail's points at a place along the track, and its features."""

    position: float  # m
    points: Array  # m, [n, 2], y and z
    features: tuple[float, ...]  # m, arc lengths


def head(face: float, top: float, width: float = WIDTH, corner: float = CORNER) -> Array:
    """m, [n, 2], outline of a head: leaning face, corner, crown, corner, face, down to BOTTOM.

    The corners' circles touch the crown's from inside and the lines y = face, face + width.
    """
    half = crown_angle(width, corner)
    middle = face + 0.5 * width
    left = circle((face + corner, top + CROWN - (CROWN - corner) * cos_(half)), corner)
    over = circle((middle, top + CROWN), CROWN)
    upper = 1.5 * np.pi
    corner_points = left(np.pi + LEAN, upper - half)
    crown_points = over(upper - half, upper + half)
    start = corner_points[0]
    foot = np.array([start[0] - sin_(LEAN) / cos_(LEAN) * (BOTTOM - start[1]), BOTTOM])
    half_line = np.concatenate([line(foot, start), corner_points[1:]])
    other = np.column_stack([2 * middle - half_line[:, 0], half_line[:, 1]])[::-1]
    return np.concatenate([half_line, crown_points[1:-1], other])


def crown_angle(width: float, corner: float) -> float:
    """rad, half of a crown's arc."""
    return float(asin(np.array((0.5 * width - corner) / (CROWN - corner))))


def crown_from(face: float, width: float = WIDTH, corner: float = CORNER) -> float:
    """m, y at which a head's crown begins."""
    return face + corner * (1 - sin_(crown_angle(width, corner)))


def circle(centre: tuple[float, float], radius: float) -> Callable[[float, float], Array]:
    """Points of its arcs from one direction to another, rad, from y towards z."""

    def arc(begin: float, end: float) -> Array:
        count = max(2, int(np.ceil(radius * (end - begin) / POINT_SPACING)))
        angle = begin + (end - begin) * np.arange(count + 1) / count
        return np.column_stack([centre[0] + radius * cos(angle), centre[1] + radius * sin(angle)])

    return arc


def line(begin: Array, end: Array) -> Array:
    """Points of a straight line."""
    count = max(1, int(np.ceil(np.hypot(*(end - begin)) / POINT_SPACING)))
    return begin + (end - begin) * np.arange(count + 1)[:, None] / count


def sin_(angle: float) -> float:
    """Of one number."""
    return float(sin(np.array(angle)))


def cos_(angle: float) -> float:
    """Of one number."""
    return float(cos(np.array(angle)))


def arc_length_at(points: Array, y: float) -> float:
    """m, along the chords of a line that runs to greater y."""
    way = np.append(0.0, np.cumsum(np.hypot(*np.diff(points, axis=0).T)))
    return float(np.interp(y, points[:, 0], way))


def between(points: Array, low: float, high: float) -> Array:
    """The part of a line that runs to greater y between two places."""
    y, z = points.T
    low, high = max(low, float(y[0])), min(high, float(y[-1]))
    inside = (y > low + 1e-6) & (y < high - 1e-6)
    at = np.concatenate([[low], y[inside], [high]])
    return np.column_stack([at, np.interp(at, y, z)])


def crossing(step: float = 0.075) -> list[Slice]:
    """A wheel goes from the wing rail to the nose: slices from 0.3 m before the nose's tip on.

    The nose's faces are both routes' gauge lines; its tip is 6 mm wide and 6 mm low, and its top
    is in the running plane from 0.35 m on. The wing lies beside it at the flangeway's width, 3 mm
    above the running plane, to which it falls from 0.5 m to 1 m.
    """
    ends = [-0.3, -1e-3, *(step * np.arange(round(1.2 / step) + 1)).tolist()]
    return [crossing_slice(x) for x in ends]


def crossing_slice(x: float) -> Slice:
    """x: m, from the nose's tip on."""
    width = NOSE_TIP + DIVERGENCE * x
    wing = head(width + FLANGEWAY, -0.003 * min(1.0, max(0.0, (1.0 - x) / 0.5)))
    corner = crown_from(width + FLANGEWAY)
    if x < 0:
        # nose and gap are missing
        return Slice(x, wing, (0.0, 0.0, 0.0, 0.0, arc_length_at(wing, corner)))
    radius = min(NOSE_CORNER, 0.4 * width)
    nose = head(0.0, 0.006 * max(0.0, 1 - x / 0.35), width, radius)
    points = np.concatenate([nose, line(nose[-1], wing[0])[1:-1], wing])
    begin = crown_from(0.0, width, radius)
    places = (begin, width - begin, nose[-1, 0], wing[0, 0], corner)
    return Slice(x, points, tuple(arc_length_at(points, float(y)) for y in places))


def blade(step: float = 0.15) -> list[Slice]:
    """A wheel goes from the stock rail to the blade: slices from 0.3 m before the blade's tip on.

    The stock rail's face leaves the gauge line by 1 : 60. The blade is a head at the gauge line of
    which the stock rail hides what lies lower: where it is 3 mm wide its top is 14 mm low, at 25 mm
    3 mm, and from 50 mm on it is in the running plane. The stock rail's face below the place where
    the blade hides it goes over into the blade's, so what lies above stays where it is.
    """
    ends = [-0.3, -0.15, -0.075, -1e-3, *(step * np.arange(round(3.0 / step) + 1)).tolist()]
    return [blade_slice(x) for x in ends]


def blade_slice(x: float) -> Slice:
    """x: m, from the blade's tip on."""
    width = BLADE_TIP + BLADE_DIVERGENCE * x
    stock = head(max(width, 0.0), 0.0)
    corner = crown_from(max(width, 0.0))
    if x < 0:
        at_tip = head(BLADE_TIP, 0.0)
        joint = hidden_from(blade_at(BLADE_TIP), at_tip)
        hidden = arc_length_at(stock, joint - BLADE_TIP + max(width, 0.0))
        return Slice(x, stock, (hidden, hidden, arc_length_at(stock, corner)))
    own = blade_at(width)
    joint = hidden_from(own, stock)
    points = np.concatenate([between(own, -1.0, joint), between(stock, joint, 1.0)[1:]])
    places = (min(crown_from(0.0), joint), joint, max(corner, joint))
    return Slice(x, points, tuple(arc_length_at(points, y) for y in places))


def blade_at(width: float) -> Array:
    """Its head before the stock rail hides a part, where it is so wide, m."""
    return head(0.0, float(np.interp(width, [BLADE_TIP, 0.025, 0.05], [0.014, 0.003, 0.0])))


def hidden_from(blade_points: Array, stock: Array) -> float:
    """m, y from which the stock rail lies higher than the blade."""
    y = np.arange(stock[0, 0], stock[-1, 0], 1e-5)
    above = np.interp(y, *stock.T) - np.interp(y, *blade_points.T)
    higher = np.flatnonzero((above < 0) & (y > stock[0, 0] + 1e-4))
    k = int(higher[0])
    share = above[k - 1] / (above[k - 1] - above[k])
    return float(y[k - 1] + share * (y[k] - y[k - 1]))


KINDS = {"crossing": crossing, "blade": blade}


def write_slices(kind: str, slices: Sequence[Slice], folder: Path) -> str:
    """Writes a file of each slice, mm; gives the sections of a case in TOML. Raises OSError."""
    folder.mkdir(parents=True, exist_ok=True)
    lines = []
    for index, part in enumerate(slices):
        name = f"{kind}_{index:02d}.txt"
        rows = [f"{1e3 * y:.6f} {1e3 * z:.6f}" for y, z in part.points.tolist()]
        text = f"# y z, mm, at x = {part.position:g} m\n" + "\n".join(rows) + "\n"
        (folder / name).write_text(text, encoding="utf-8")
        features = ", ".join(f"{feature:.9g}" for feature in part.features)
        lines.append(
            f'  {{ position = {part.position:.9g}, profile = "{name}", features = [{features}] }},'
        )
    return "\n".join(lines)


def case_text(sections: str) -> str:
    """A case of a right wheel on these sections, rolling, 80 kN."""
    return CASE.replace("SECTIONS", sections)


CASE = """\
kind = "wheel_rail"
[wheel]
side = "right"
[wheelset]
x = 0.0
y = 0.0
vertical_force = 8e4
speed = 20.0
pitch_rate = -43.478260869565216
nominal_radius = 0.46
flange_back_distance = 1.36
flange_back_position = -0.07
[track]
gauge = 1.435
section_blend = "cubic"
[track.right]
origin = [0.7175, 0.0]
sections = [
SECTIONS
]
[profiles]
wheel = "S1002"
smoothing = 0.0
[profiles.rail_file]
unit = "mm"
swap = false
mirror = "none"
[friction]
coefficient = 0.3
[method]
normal = "half_space"
tangential = "full"
[grid]
elements = [16, 16]
[material]
shear_modulus = 8.2e10
poisson_ratio = 0.28
"""


def case_of(kind: str, folder: Path) -> dict[str, Any]:
    """The same as a dictionary, with whole paths; writes the slices to a folder. Raises OSError."""
    case: dict[str, Any] = tomllib.loads(case_text(write_slices(kind, KINDS[kind](), folder)))
    for section in case["track"]["right"]["sections"]:
        section["profile"] = str(folder / section["profile"])
    return case


def main() -> None:
    """Writes the slices and the case."""
    parser = argparse.ArgumentParser(description="Slices of a turnout's rails by formula.")
    parser.add_argument("kind", choices=sorted(KINDS))
    parser.add_argument("-o", "--output", type=Path, required=True)
    given = parser.parse_args()
    sections = write_slices(given.kind, KINDS[given.kind](), given.output)
    (given.output / f"{given.kind}.toml").write_text(case_text(sections), encoding="utf-8")
    print(given.output / f"{given.kind}.toml")


if __name__ == "__main__":
    main()
