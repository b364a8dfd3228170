"""Kalker's creepage coefficients at vanishing creepage, as the table that the core compiles in.

``python -m railpatch.evidence.kalker_table -o core/fast/kalker_table.inc`` makes the
file again in minutes; ``--check`` adds a second set of grids and prints how far the two differ.

With all of the contact in stick, steady rolling is linear: w + B p = 0 with B p the slip that the
tractions cause (Kalker 1990, Three-dimensional elastic bodies in rolling contact, chapter 3), and

    F_x = -G c^2 C11 xi,  F_y = -G c^2 (C22 eta + c C23 phi),  M_z = G c^3 (C23 eta - c C33 phi)

with c^2 = a b. The solver here is the core's theory on other elements: rows of equal width over
the half ellipse y > 0 (the other half by symmetry), each as long as its strip is on average and
cut into equally many elements, the first slip point a quarter of an element inside the leading
edge, as in vortex-lattice methods, and spin taken half an element ahead, where the difference of
displacements is centred, which makes the two off-diagonal coefficients agree to rounding. Such
rows converge smoothly, with errors of first and second order, so that three grids extrapolate.
"""

from __future__ import annotations

import argparse
import textwrap
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

Array = NDArray[np.float64]

NAMES = ("C11", "C22", "C23", "C33")
RATIO = 20.0  # greatest a/b and b/a
NODES = 25  # equally spaced in ln(a/b)
# Chebyshev-Lobatto points of 0 ... 0.5
POISSON_RATIOS = 0.25 * (1 - np.cos(np.pi * np.arange(5) / 4))
ELEMENTS = 9  # along a row of the coarsest of three grids, at a/b of 5 and less


@dataclass(frozen=True)
class Rows:
    """Elements of the half ellipse y > 0 with a b = 1; sizes in units of sqrt(a b)."""

    x: Array  # centres
    y: Array
    length: Array
    low: Array  # lateral edges
    high: Array

    @property
    def area(self) -> Array:
        """Area of each element."""
        return self.length * (self.high - self.low)


def fitted_rows(ratio: float, along: int, rows: int) -> Rows:
    """Rows over the half ellipse with a/b = ratio, `along` elements in each."""
    a = np.sqrt(ratio)
    b = 1 / a
    edges = b * np.arange(rows + 1) / rows
    # half the length of a strip, from its exact area
    s = np.clip(edges / b, 0, 1)
    area = 0.5 * a * b * (s * np.sqrt(1 - s * s) + np.arcsin(s))
    half = np.diff(area) / np.diff(edges)
    length = np.repeat(2 * half / along, along)
    steps = np.tile(np.arange(along) + 0.75, rows)
    return Rows(
        x=np.repeat(half, along) - steps * length,
        y=np.repeat(0.5 * (edges[1:] + edges[:-1]), along),
        length=length,
        low=np.repeat(edges[:-1], along),
        high=np.repeat(edges[1:], along),
    )


def log_ratio(p2: Array, r2: Array, p1: Array, r1: Array) -> Array:
    """ln((p2 + r2)/(p1 + r1)) without cancellation where p is negative."""
    negative = p1 + p2 < 0
    return np.log(np.where(negative, r1 - p1, p2 + r2) / np.where(negative, r2 - p2, p1 + r1))


def integrals(x: Array, y1: Array, y2: Array, half: Array) -> tuple[Array, Array, Array]:
    """[[y ln(x+r)]], [[x ln(y+r)]] and [[-r]] over an element (Kalker 1990, app. C)."""
    x1, x2 = x - half, x + half
    r11, r12, r21, r22 = (np.hypot(u, v) for u in (x1, x2) for v in (y1, y2))
    first = y2 * log_ratio(x2, r22, x1, r12) - y1 * log_ratio(x2, r21, x1, r11)
    second = x2 * log_ratio(y2, r22, y1, r21) - x1 * log_ratio(y2, r12, y1, r11)
    return first, second, -(r22 - r12 - r21 + r11)


def slip_integrals(rows: Rows, mirrored: bool) -> list[Array]:
    """The same as differences over an element's length: the slip that an element (or its mirror
    image at y = 0) causes at every centre."""
    low, high = (-rows.high, -rows.low) if mirrored else (rows.low, rows.high)
    y1, y2 = rows.y[:, None] - high, rows.y[:, None] - low
    here, ahead = (
        integrals(at[:, None] - rows.x, y1, y2, 0.5 * rows.length)
        for at in (rows.x, rows.x + rows.length)
    )
    return [(u - v) / rows.length[:, None] for u, v in zip(here, ahead, strict=True)]


def solve(rows: Rows, poisson_ratios: Array) -> Array:
    """C11, C22, C23, C32, C33 of one grid, [poisson ratio][coefficient]."""
    own, image = slip_integrals(rows, False), slip_integrals(rows, True)
    n = rows.x.size
    area = np.concatenate([rows.area, rows.area])
    spin_x = rows.x + 0.5 * rows.length
    found = []
    for nu in poisson_ratios:

        def matrix(sign_x: int, nu: float = nu) -> Array:
            # p_x even and p_y odd in y (sign_x = 1), or the other way round
            j1, j2, j4 = (u + sign_x * v for u, v in zip(own, image, strict=True))
            k1, k2, k4 = (u - sign_x * v for u, v in zip(own, image, strict=True))
            return np.block([[j1 + (1 - nu) * j2, nu * k4], [nu * j4, k2 + (1 - nu) * k1]]) / np.pi

        one, none = np.ones(n), np.zeros(n)
        forward = np.linalg.solve(matrix(1), -np.concatenate([one, none]))
        sideways = np.stack(
            [np.concatenate([none, one]), np.concatenate([-rows.y, spin_x])], axis=1
        )
        lateral, spin = np.linalg.solve(matrix(-1), -sideways).T
        lever = np.concatenate([-rows.y, rows.x]) * area
        force = np.concatenate([none, rows.area])
        found.append(
            [
                -2 * area[:n] @ forward[:n],
                -2 * force @ lateral,
                -2 * force @ spin,
                2 * lever @ lateral,
                -2 * lever @ spin,
            ]
        )
    return np.array(found)


def coefficients(ratio: float, poisson_ratios: Array, elements: int = ELEMENTS) -> Array:
    """C11, C22, C23, C33 from three grids, each twice as fine; [poisson ratio][coefficient]."""
    # rows not much narrower than their elements are long
    share = max(0.3, min(1.0, 5.0 / ratio))
    along = round(elements / np.sqrt(share))
    across = max(3, round(along * share))
    grids = [solve(fitted_rows(ratio, along * k, across * k), poisson_ratios) for k in (1, 2, 4)]
    # errors of first and of second order
    first = [2 * fine - coarse for coarse, fine in pairwise(grids)]
    limit = (4 * first[1] - first[0]) / 3
    return np.stack([limit[:, 0], limit[:, 1], limit[:, 2:4].mean(axis=1), limit[:, 4]], axis=1)


def table(logs: Array, elements: int = ELEMENTS) -> Array:
    """[node][poisson ratio][coefficient]."""
    return np.array([coefficients(float(np.exp(t)), POISSON_RATIOS, elements) for t in logs])


def spell(values: Array, slopes: Array) -> str:
    """The C++ source of the table."""
    lines = [
        "// Generated by python -m railpatch.evidence.kalker_table; do not edit.",
        f"// Creepage coefficients at a/b = {RATIO:g}^(k/{(NODES - 1) // 2}), "
        f"k = {-(NODES - 1) // 2} ... {(NODES - 1) // 2}, and Poisson's ratios",
        f"// {', '.join(f'{nu:.6g}' for nu in POISSON_RATIOS)}: values and derivatives to ln(a/b)",
        f"// of {', '.join(NAMES)}, [node][coefficient][value, derivative][poisson_ratio].",
        f"constexpr int kalker_nodes = {NODES};",
        f"constexpr double kalker_greatest_ratio = {RATIO};",
        f"constexpr double kalker_values[{NODES}][{len(NAMES)}][2][{len(POISSON_RATIOS)}] = {{",
    ]
    for node in range(NODES):
        rows = []
        for k in range(len(NAMES)):
            pair = (values[node, :, k], slopes[node, :, k])
            rows.append(
                "{" + ", ".join("{" + ", ".join(f"{v:.7g}" for v in u) + "}" for u in pair) + "}"
            )
        text = "{" + ", ".join(rows) + "},"
        lines += textwrap.wrap(text, 98, initial_indent="    ", subsequent_indent="     ")
    return "\n".join([*lines, "};", ""])


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(
        prog="python -m railpatch.evidence.kalker_table", description=__doc__
    )
    parser.add_argument("-o", "--output", type=Path, required=True, help="C++ file to write")
    parser.add_argument("--check", action="store_true", help="compare with a second set of grids")
    parser.add_argument("--elements", type=int, default=ELEMENTS, help="along a row, coarsest grid")
    given = parser.parse_args()
    logs = np.log(RATIO) * np.linspace(-1, 1, NODES)
    values = table(logs, given.elements)
    slopes = CubicSpline(logs, values, axis=0)(logs, 1)
    given.output.write_text(spell(values, slopes), encoding="ascii")
    if not given.check:
        return
    other = table(logs, given.elements - 2)
    print("a/b, greatest relative difference of", ", ".join(NAMES))
    for t, difference in zip(logs, np.abs(other / values - 1).max(axis=1), strict=True):
        print(f"{np.exp(t):8.4f}", *(f"{d:.1e}" for d in difference))


if __name__ == "__main__":
    main()
