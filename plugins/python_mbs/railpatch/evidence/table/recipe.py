"""What a table is made of: axes, grids of the solves, and the sample that tells its error."""

from __future__ import annotations

import hashlib
import json
from dataclasses import asdict, dataclass

import numpy as np

# directions n = (cos psi cos theta, cos psi sin theta, sin psi): signs of (Fx, Fy, Mz) where
# xi -> -xi (theta -> pi - theta), and where (eta, phi) -> -(eta, phi)
REVERSAL = np.array([-1.0, 1.0, 1.0])
MIRROR = np.array([1.0, -1.0, -1.0])


@dataclass(frozen=True)
class Recipe:
    """Intervals of each axis, a/b from lowest to highest, and the grids of the solves."""

    ratios: int = 10
    psi: int = 12
    theta: int = 16
    t: int = 24
    lowest_ratio: float = 0.1
    highest_ratio: float = 10.0
    poisson_ratio: tuple[float, float, float] = (0.0, 0.28, 0.5)
    radius: float = 2.5
    spin_scale: float = 1.7
    size: float = 11.0  # nodes and rows of the coarser grid, a/b = 1
    refinement: float = 1.5  # of the finer grid
    spin_nodes: float = 28.0  # where spin rules, a/b = 1
    spin_rows: float = 18.0
    order: float = 1.8  # of the discretisation's error
    sample: int = 2000  # random cases for the error

    def text(self) -> str:
        """The recipe as JSON."""
        return json.dumps(asdict(self), sort_keys=True)

    def key(self) -> str:
        """A short name for parts of this recipe."""
        return hashlib.sha256(self.text().encode()).hexdigest()[:12]

    @property
    def axis_ratios(self) -> np.ndarray:
        """a/b of the nodes."""
        low, high = np.log(self.lowest_ratio), np.log(self.highest_ratio)
        return np.exp(np.linspace(low, high, self.ratios + 1))

    @property
    def psi_nodes(self) -> np.ndarray:
        """rad, share of spin in the direction."""
        return np.linspace(0.0, 0.5 * np.pi, self.psi + 1)

    @property
    def theta_nodes(self) -> np.ndarray:
        """rad, direction of the creepage."""
        return np.linspace(-0.5 * np.pi, 0.5 * np.pi, self.theta + 1)

    @property
    def t_nodes(self) -> np.ndarray:
        """-, |v|/(R + |v|); at 1 all slides without elasticity."""
        return np.linspace(0.0, 1.0, self.t + 1)

    def direction(self, j: int, k: int) -> np.ndarray:
        """n of a node, with exact zeros on the planes of symmetry."""
        psi, theta = self.psi_nodes[j], self.theta_nodes[k]
        level = 0.0 if j == self.psi else np.cos(psi)
        along = 0.0 if k in (0, self.theta) else np.cos(theta)
        across = 0.0 if 2 * k == self.theta else np.sin(theta)
        return np.array([level * along, level * across, np.sin(psi)])

    def grid(self, ratio: float, factor: float = 1.0) -> tuple[int, int]:
        """Nodes and rows of the coarser grid for an a/b, times a factor."""
        nodes = self.size * ratio ** (0.24 if ratio > 1 else 0.12)
        rows = self.size * ratio ** (-0.24 if ratio > 1 else -0.20)
        return whole(factor * nodes), whole(factor * rows)

    def spin_grid(self, ratio: float, factor: float = 1.0) -> tuple[int, int]:
        """Nodes and rows where spin rules: slip turns about a point inside the contact, which the
        grid must resolve along its longer axis above all; less so where wheels hardly come."""
        if ratio > 5.0:
            factor *= 0.75
        nodes = self.spin_nodes * ratio ** (0.32 if ratio > 1 else 0.43)
        rows = self.spin_rows * ratio ** (-0.20 if ratio > 1 else -0.50)
        return whole(factor * nodes), whole(factor * rows)


def whole(number: float) -> int:
    """Nodes or rows within the solver's limits."""
    return min(64, max(6, round(number)))


def spin_rules(v: np.ndarray) -> bool:
    """Whether slip turns about a point in or near the contact; there the error of a grid jumps to
    and fro, and extrapolation would enlarge it."""
    return bool(abs(v[2]) > 2.0 and abs(v[2]) > 0.5 * np.hypot(v[0], v[1]))
