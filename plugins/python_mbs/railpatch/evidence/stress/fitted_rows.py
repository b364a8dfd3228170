"""Fitted rows: their conditions, and micro-slip by direct summation; shares nothing with the
solver.

Each row's traction is that which the rows stand for, cubics in the angle through its nodes, cut
into rectangles much finer than the nodes; their displacements are Kalker's closed forms
(half_space.py), whose slope is taken by central differences where a rectangle lies around the
point. Conditions: Kalker 1990, chapter 1; stick has no slip at the point half a step ahead of the
node, slip has the bound against a slip between those of the two points around the node. Any other
way between the nodes, sines say, is another traction: where it turns within a step, as at the pole
of spin, its slip differs by more than the conditions allow, on any number of rectangles.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from railpatch.evidence.stress.half_space import Array, corners, x2_over_r3, xy_over_r3, y2_over_r3
from railpatch.evidence.stress.liquids import greatest_of
from railpatch.evidence.stress.step import Finding, Step

STICK, SLIP = 1, 2
# Pa: films leave friction coefficients down to 1e-300, whose tractions are none
NO_STRESS = 1e-100
# micro-slip of the rows against rectangles, over the largest slip that the motion or the bound asks
# for: the rows' own quadrature where stick ends
OF_SLIP = 0.02
# rows on which that is looked at: fewer nodes have a greater error, more take long
LEAST_NODES, MOST_NODES = 8, 256
LEAST_RATIO = 0.2  # of the contact's sides
FINE = 15  # rectangles for each node: an odd number, so that one lies around each point


@dataclass
class Rows:
    """Rows of n nodes x_k = middle + half_length cos(k pi/(n+1)), read off a result's fields."""

    x: Array  # [rows, n], rising
    y: Array
    traction: Array  # [2, rows, n]

    def __post_init__(self) -> None:
        self.count = self.x.shape[1]
        self.step = np.pi / (self.count + 1)
        self.middle = 0.5 * (self.x[:, 0] + self.x[:, -1])
        self.half_length = 0.5 * (self.x[:, -1] - self.x[:, 0]) / np.cos(self.step)
        self.height = float(np.diff(self.y).mean())

    @property
    def areas(self) -> Array:
        """m^2 that each node stands for."""
        angles = self.step * np.arange(1, self.count + 1)
        return self.height * self.half_length[:, None] * self.step * np.sin(angles)

    def points(self, direction: int) -> Array:
        """[rows, n + 1], from the leading edge: where the slip of the rows is looked at."""
        angles = self.step * (np.arange(self.count + 1) + 0.5)
        return self.middle[:, None] + direction * self.half_length[:, None] * np.cos(angles)

    def from_leading_edge(self, field: Array, direction: int) -> Array:
        return field[..., ::-1] if direction > 0 else field

    def fine_traction(self) -> tuple[Array, Array, Array]:
        """Middles and lengths [rows, m] of the rectangles, and the traction [2, rows, m] there."""
        pieces = FINE * (self.count + 1)
        edges = np.pi * np.arange(pieces + 1) / pieces
        angles = 0.5 * (edges[1:] + edges[:-1])
        ends = self.middle[:, None] + self.half_length[:, None] * np.cos(edges)
        x, length = 0.5 * (ends[:, 1:] + ends[:, :-1]), ends[:, :-1] - ends[:, 1:]
        return x, length, self.between_nodes(angles)

    def between_nodes(self, angles: Array) -> Array:
        """[2, rows, m], at angles (from 0 at the greatest x) the cubic through the four nodes
        around; the traction is an odd function of the angle at both edges."""
        nodes = self.traction[:, :, ::-1]
        edge = np.zeros((*nodes.shape[:2], 1))
        parts = [-nodes[:, :, :1], edge, nodes, edge, -nodes[:, :, -1:]]
        known = np.concatenate(parts, axis=2)
        place = angles / self.step
        first = np.minimum(place.astype(int), self.count)
        found = np.zeros((*nodes.shape[:2], angles.size))
        for one in range(4):
            others = [other for other in range(4) if other != one]
            weight = np.prod([(place - first + 1 - k) / (one - k) for k in others], axis=0)
            found += weight * known[:, :, first + one]
        return found

    def slope(
        self, direction: int, shear_modulus: float, poisson_ratio: float, layer: float
    ) -> Array:
        """du/dx [2, rows, n + 1] at the points."""
        x, length, traction = self.fine_traction()
        points = self.points(direction)
        # half of the rectangle around a point
        angle = self.step / FINE
        away = np.sin(self.step * (np.arange(self.count + 1) + 0.5)) * np.sin(angle / 2)
        half = self.half_length[:, None] * away
        nu, c = poisson_ratio, 1 / (np.pi * shear_modulus)
        u = np.zeros((2, 2, *points.shape))
        for side in (0, 1):
            seen = points + (2 * side - 1) * half
            for j, y in enumerate(self.y):
                dx = seen[:, :, None] - x[j]
                dy = (self.y - y)[:, None, None]
                xx, yy, xy = (
                    corners(f, dx, dy, length[j], self.height)
                    for f in (x2_over_r3, y2_over_r3, xy_over_r3)
                )
                px, py = traction[:, j]
                u[side, 0] += c * ((xx + (1 - nu) * yy) @ px + nu * (xy @ py))
                u[side, 1] += c * ((yy + (1 - nu) * xx) @ py + nu * (xy @ px))
        return (u[1] - u[0]) / (2 * half) + layer * self.traction_slope(direction)

    def traction_slope(self, direction: int) -> Array:
        """dp/dx [2, rows, n + 1] between neighbouring nodes, zero traction at both edges."""
        edges = np.zeros((*self.traction.shape[:2], 1))
        p = np.concatenate([edges, self.traction, edges], axis=2)
        low = self.middle - self.half_length
        x = np.concatenate([low[:, None], self.x, (low + 2 * self.half_length)[:, None]], axis=1)
        return self.from_leading_edge(np.diff(p, axis=2) / np.diff(x, axis=1), direction)


def rigid_slip(motion: dict[str, Any], x: Array, y: Array) -> Array:
    """[2, ...], wheel minus rail over the rolling speed."""
    (xi, eta), phi = motion["creepage"], motion["spin_creepage"]
    return np.array([xi - phi * y + 0 * x, eta + phi * x + 0 * y])


def fitted_findings(step: Step) -> Iterator[Finding]:
    """Pressure, bound, sums, and stick and slip by the given micro-slip."""
    rows = Rows(step["x"], step["y"], step["traction"])
    areas, (px, py) = rows.areas, rows.traction
    pressure, friction = step["pressure"], greatest_of(step)
    yield Finding("negative pressure", -float(pressure.min() / pressure.max()), 0.0)
    normal = abs(float((pressure * areas).sum()) / step.patch["normal_force"] - 1)
    yield Finding("sum of pressure", normal, 1e-6)
    most = friction * step.patch["normal_force"]
    force = np.array([float((p * areas).sum()) for p in (px, py)])
    moment = float(((rows.x * py - rows.y[:, None] * px) * areas).sum())
    reach = float(np.abs(rows.x).max() + np.abs(rows.y).max())
    limit = max(1e-9 * most, 1e-300)
    yield Finding("sum of tractions", float(np.hypot(*(force - step.patch["creep_force"]))), limit)
    yield Finding("moment of tractions", abs(moment - step.patch["spin_moment"]), limit * reach)
    bound = friction * pressure
    size, most_bound = np.hypot(px, py), max(float(bound.max()), NO_STRESS)
    over = float((size - bound * (1 + 1e-9)).max()) / most_bound
    yield Finding("traction over its bound", over, 1e-12)
    division, given = step["element_division"], step["micro_slip"]
    counts = [int((division == state).sum()) for state in (STICK, SLIP)]
    differ = np.abs(np.array(counts) - step.patch["elements"][1:3]).max()
    yield Finding("count of elements", float(differ), 0.0)
    sliding = division == SLIP
    still = float(np.abs(given[:, ~sliding]).max(initial=0.0))
    yield Finding("micro-slip outside slip", still, 0.0)
    # the solver's residual is a traction: shares of the greatest bound
    short = float(((bound - size)[sliding]).max(initial=0.0)) / most_bound
    yield Finding("slip below friction", short, 100 * step.tolerance)
    slip = np.hypot(*given)
    along = (px * given[0] + py * given[1]) / np.maximum(slip, 1e-300)
    worst = float(along[sliding].max(initial=0.0)) / most_bound
    yield Finding("micro-slip along the traction", worst, 1e-9)


def rectangle_findings(step: Step) -> Iterator[Finding]:
    """Stick and slip by the slip of rectangles, where the rows are fine enough to be judged."""
    rows = Rows(step["x"], step["y"], step["traction"])
    sides = 2 * float(rows.half_length.max()), float(np.ptp(rows.y)) + rows.height
    across = min(rows.traction.shape[1:])
    if across < LEAST_NODES or rows.traction[0].size > MOST_NODES:
        return
    if min(sides) < LEAST_RATIO * max(sides):
        return
    direction = step.direction
    modulus, ratio = step.elastic
    xi, eta, phi = step.motion
    motion = {"creepage": [xi, eta], "spin_creepage": phi}
    slope = rows.slope(direction, modulus, ratio, step.layer)
    points = rigid_slip(motion, rows.points(direction), rows.y[:, None]) - direction * slope
    bound = greatest_of(step) * float(step["pressure"].max())
    # slope of the bound's own displacement at the edge of a long strip (Johnson 1985, section 8.3),
    # and of the layer's below it
    elastic = 2 * (1 - ratio) * bound / modulus + step.layer * bound / min(sides)
    rigid = rigid_slip(motion, rows.x, rows.y[:, None])
    limit = (OF_SLIP + step.tolerance) * max(float(np.hypot(*rigid).max()), elastic)
    division = rows.from_leading_edge(step["element_division"], direction)
    given = rows.from_leading_edge(step["micro_slip"], direction)
    ahead, behind = points[:, :, :-1], points[:, :, 1:]
    stick = float(np.hypot(*ahead)[division == STICK].max(initial=0.0))
    yield Finding("slip in stick", stick, limit)
    # distance of the given slip from the way between the two points' slips
    way = behind - ahead
    share = ((given - ahead) * way).sum(axis=0) / np.maximum((way**2).sum(axis=0), 1e-300)
    off = np.hypot(*(given - ahead - np.clip(share, 0, 1) * way))
    yield Finding("micro-slip", float(off[division == SLIP].max(initial=0.0)), limit)
