"""Dimensionless creep forces from the full theory.

For an ellipse with c = sqrt(a b) and the bound B = mu Fn: w = (G c^2/B) (xi, eta, c phi) gives
(Fx, Fy, Mz/c)/B, which depends on w, a/b and Poisson's ratio alone.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from railpatch import _core
from railpatch.evidence.table.recipe import Recipe, spin_rules

# any size and load will do: the forces are scaled by them
SIZE = 0.006  # m, c
SHEAR_MODULUS = 82e9  # Pa
NORMAL_FORCE = 1e5  # N
FRICTION = 0.3
UNIT = FRICTION * NORMAL_FORCE / (SHEAR_MODULUS * SIZE**2)  # creepage of w = 1


class NotSolved(RuntimeError):
    """A case of the table that the full theory did not solve."""


def contact_on(ratio: float, poisson: float, **theory: Any) -> _core.Contact:
    """The core's handle of an elliptic contact with Hertz's pressure.

    theory: fields of the core's config for the tangential problem.
    """
    return _core.Contact(
        {
            "kind": "patch",
            "geometry": "semi_axes",
            "semi_axes": [SIZE * ratio**0.5, SIZE / ratio**0.5],
            "shear_modulus": [SHEAR_MODULUS] * 2,
            "poisson_ratio": [poisson] * 2,
            "normal": "hertz",
            "friction_coefficient": FRICTION,
            **theory,
        },
        False,
    )


def input_of(w: np.ndarray, direction: int) -> dict[str, Any]:
    """Fields of a step at w."""
    return {
        "normal_force": NORMAL_FORCE,
        "creepage": [float(UNIT * w[0]), float(UNIT * w[1])],
        "spin_creepage": float(UNIT * w[2] / SIZE),
        "direction": direction,
    }


def forces_of(result: dict[str, Any]) -> np.ndarray:
    """(Fx, Fy, Mz/c)/B of a step's result."""
    patch = result["right"]["patches"][0]
    force = [*patch["creep_force"], patch["spin_moment"] / SIZE]
    return np.array(force) / (FRICTION * NORMAL_FORCE)


class Ellipse:
    """Creep forces of one a/b and Poisson's ratio on one grid of fitted rows."""

    def __init__(
        self, ratio: float, poisson: float, grid: tuple[int, int], tolerance: float = 1e-5
    ) -> None:
        self.about = f"a/b = {ratio:.4g}, Poisson's ratio {poisson:.4g}, grid {grid}"
        self._contact = contact_on(
            ratio,
            poisson,
            tangential="full",
            fitted=list(grid),
            tolerance=tolerance,
            max_iterations=1000,
        )

    def reset(self) -> None:
        """Forgets the last solution."""
        self._contact.reset()

    def __call__(self, w: np.ndarray, direction: int = 1) -> np.ndarray:
        """(Fx, Fy, Mz/c)/B at w; starts from the last solution."""
        values = input_of(w, direction)
        result = self._contact.step(values)
        if result["status"] != "converged":
            self._contact.reset()
            result = self._contact.step(values)
        if result["status"] != "converged":
            raise NotSolved(f"{self.about}, w = {np.asarray(w).tolist()}: {result['status']}")
        return forces_of(result)


class Accurate:
    """Creep forces of one a/b and Poisson's ratio from two grids, extrapolated to none (Richardson
    1911), or from one fine grid where spin rules."""

    def __init__(self, recipe: Recipe, ratio: float, poisson: float, factor: float = 1.0) -> None:
        grids = [recipe.grid(ratio, factor * q) for q in (1.0, recipe.refinement)]
        self._coarse, self._fine = (Ellipse(ratio, poisson, grid) for grid in grids)
        self._spin = Ellipse(ratio, poisson, recipe.spin_grid(ratio, factor))
        self._weight = 1.0 / (recipe.refinement**recipe.order - 1.0)

    def reset(self) -> None:
        """Forgets the last solutions."""
        for ellipse in (self._coarse, self._fine, self._spin):
            ellipse.reset()

    def __call__(self, w: np.ndarray, v: np.ndarray) -> np.ndarray:
        """(Fx, Fy, Mz/c)/B at w; v: the same, scaled as in core/fast/creep_table.hpp."""
        if spin_rules(v):
            return self._spin(w)
        coarse, fine = self._coarse(w), self._fine(w)
        return fine + self._weight * (fine - coarse)

    def coarse(self, w: np.ndarray) -> np.ndarray:
        """(Fx, Fy, Mz/c)/B at w from the coarser grid alone."""
        return self._coarse(w)


def slopes(recipe: Recipe, ratio: float, poisson: float) -> np.ndarray:
    """d(Fx, Fy, Mz/c)/dw at w = 0, from small creepages and two finer grids, extrapolated."""
    step, found = 1e-3, []
    for factor in (recipe.refinement, recipe.refinement**2):
        ellipse = Ellipse(ratio, poisson, recipe.grid(ratio, factor), tolerance=1e-9)
        matrix = np.zeros((3, 3))
        for k, w in enumerate(step * np.eye(3)):
            # slip begins with the square of the creepage
            matrix[:, k] = (2.0 * ellipse(w) - 0.5 * ellipse(2.0 * w)) / step
        found.append(matrix)
    coarse, fine = found
    matrix = fine + (fine - coarse) / (recipe.refinement**recipe.order - 1.0)
    # what the symmetries leave
    return matrix * np.array([[1, 0, 0], [0, 1, 1], [0, 1, 1]])


def scales_of(recipe: Recipe, slope: np.ndarray) -> np.ndarray:
    """s1, s2, s3 of core/fast/creep_table.hpp, from slopes [..., 3, 3]."""
    c11, c22, c23 = -slope[..., 0, 0], -slope[..., 1, 1], -slope[..., 1, 2]
    s3 = recipe.spin_scale * np.sqrt(c23 * np.sqrt(c11 * c22))
    return np.stack([c11, c22, s3], axis=-1)


def sliding(ratio: float, w: np.ndarray, count: int = 200) -> np.ndarray:
    """(Fx, Fy, Mz/c)/B of sliding without elasticity in the direction of w, by Gauss quadrature of
    the elliptic pressure along rolling and strips of their exact load across."""
    angle = np.arange(1, count + 1) * np.pi / (count + 1)
    edge = np.linspace(-1.0, 1.0, count + 1)
    low, high = edge[:-1], edge[1:]
    mean = 1.0 - (low * low + low * high + high * high) / 3.0  # of the squared chord
    x = ratio**0.5 * np.sqrt(mean)[:, None] * np.cos(angle)
    y = (0.5 * (low + high) / ratio**0.5)[:, None]
    load = 1.5 * (mean / count)[:, None] * (2.0 / (count + 1) * np.sin(angle) ** 2)
    slip = w[0] - w[2] * y + 0.0 * x, w[1] + w[2] * x
    unit = load / np.maximum(np.hypot(*slip), 1e-300)
    px, py = -unit * slip[0], -unit * slip[1]
    return np.array([px.sum(), py.sum(), (x * py - y * px).sum()])
