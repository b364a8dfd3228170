"""Micro-slip of rows of nodes by direct summation, in numpy; shares nothing with the solver.

Each row's traction is interpolated in the angle of its nodes by sines and cut into rectangles much
finer than the nodes; their displacements are Kalker's closed forms (half_space.py of the package's
stress program), whose slope is taken by central differences where a rectangle lies around the
point.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from railpatch.stress.half_space import Array, corners, x2_over_r3, xy_over_r3, y2_over_r3

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
        order = np.arange(1, self.count + 1)
        # from the angle 0 at the greatest x; the traction is an odd function of the angle
        nodes = self.traction[:, :, ::-1]
        coefficients = nodes @ np.sin(np.outer(order, order) * self.step) * 2 / (self.count + 1)
        ends = self.middle[:, None] + self.half_length[:, None] * np.cos(edges)
        x, length = 0.5 * (ends[:, 1:] + ends[:, :-1]), ends[:, :-1] - ends[:, 1:]
        return x, length, coefficients @ np.sin(np.outer(order, angles))

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
