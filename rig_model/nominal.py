"""Nominal profiles for the rig, by formula: smooth ones, beside those that NRC measured.

    python -m rig_model.nominal FOLDER      # writes the two files that the nominal scene names

Millimetres, right-hand orientation (flange or gauge side at -y), z down.
"""

from __future__ import annotations

import math
import sys
from pathlib import Path

WHEEL_FILE = "nominal_wheel.csv"
ROLLER_FILE = "nominal_roller.csv"
CONE = 1 / 20
FACET = 1 / 30
TAPE_LINE = 70.0  # mm from the flange back, where the wheel has its nominal radius
# arcs from the facet's ends (+-4 mm) outwards: radius (mm), inclination at their outer end (rad)
FACET_HALF_WIDTH = 4.0
GAUGE_ARCS = ((300.0, -0.08), (80.0, -0.2), (13.0, -1.52))
FIELD_ARCS = ((300.0, 0.05), (13.0, 1.3))
SIDE_LENGTH = 20.0  # mm, straight gauge side below the last arc
SPACING = 0.5  # mm

Point = tuple[float, float]


def wheel_points() -> list[Point]:
    """A cone of 1:20 without a flange, (y, z) from 10 to 135 mm from the flange back."""
    return [(y, -CONE * (y - TAPE_LINE)) for y in range(10, 136, 5)]


def roller_points() -> list[Point]:
    """A flat facet of 1:30 between arcs that join it smoothly, (y, z); z = 0 in its middle."""
    angle = -math.atan(FACET)
    end = (FACET_HALF_WIDTH * math.cos(angle), FACET_HALF_WIDTH * math.sin(angle))
    start = (-end[0], -end[1])
    gauge = arcs(start, angle, GAUGE_ARCS, -1)
    last = GAUGE_ARCS[-1][1]
    gauge += straight(gauge[-1], last, SIDE_LENGTH, -1)
    field = arcs(end, angle, FIELD_ARCS, 1)
    facet = straight(start, angle, 2 * FACET_HALF_WIDTH, 1)
    return [*reversed(gauge), start, *facet, *field]


def arcs(start: Point, angle: float, pieces: tuple[Point, ...], way: int) -> list[Point]:
    """Points along arcs, after ``start``, walking towards +y (way = 1) or -y (-1).

    Along an arc that is bent downwards the inclination changes by way * length / radius.
    """
    points = [start]
    for radius, last in pieces:
        steps = max(2, math.ceil(radius * abs(last - angle) / SPACING))
        y, z = points[-1]
        for k in range(1, steps + 1):
            a = angle + (last - angle) * k / steps
            rise = radius * (math.cos(angle) - math.cos(a))
            points.append((y + way * radius * abs(math.sin(a) - math.sin(angle)), z + rise))
        angle = last
    return points[1:]


def straight(start: Point, angle: float, length: float, way: int) -> list[Point]:
    """Points along a straight line, after ``start``."""
    steps = math.ceil(length / SPACING)
    step = way * length / steps
    y, z = start
    return [
        (y + k * step * math.cos(angle), z + k * step * math.sin(angle))
        for k in range(1, steps + 1)
    ]


def text_of(title: str, points: list[Point]) -> str:
    """The file: two columns in mm."""
    rows = [f"# {title}", "# y, z in mm, right-hand orientation, z down"]
    return "\n".join(rows + [f"{y:.6f},{z:.6f}" for y, z in points]) + "\n"


def files() -> dict[str, str]:
    """Name -> content of both files."""
    return {
        WHEEL_FILE: text_of("nominal wheel: cone 1:20, y from the flange back", wheel_points()),
        ROLLER_FILE: text_of("nominal roller: facet 1:30 of 8 mm between arcs", roller_points()),
    }


if __name__ == "__main__":
    for name, content in files().items():
        (Path(sys.argv[1]) / name).write_text(content)
