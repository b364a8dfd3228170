"""Shapes of contact that problems are made of: each gives [geometry] and [grid] of a case."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
import scipy
from numpy.typing import NDArray
from scipy.special import ellipe, ellipk

SHEAR_MODULUS = 82e9  # Pa
POISSON_RATIO = 0.28
CONTACT_MODULUS = SHEAR_MODULUS / (1 - POISSON_RATIO)  # Pa, of two equal bodies
MARGIN = 2  # elements around a contact whose size is only known to an element

Floats = NDArray[np.float64]


class Shape(Protocol):
    """A shape of the undeformed bodies."""

    exact_pressure: bool  # Hertz's closed form gives the greatest pressure

    def tables(self, elements: int) -> dict[str, Any]:
        """[geometry] and [grid] with so many elements across the contact."""
        ...

    def semi_axes(self, force: Floats) -> Floats:
        """m, [n, 2] along rolling and lateral; those of the bounding box where no ellipse."""
        ...


@dataclass(frozen=True)
class Ellipse:
    """A contact ellipse of given semi-axes a, b (m), whatever the load."""

    a: float
    b: float
    exact_pressure = True

    def tables(self, elements: int) -> dict[str, Any]:
        """The semi-axes themselves."""
        return {
            "geometry": {"semi_axes": [self.a, self.b]},
            "grid": {"elements": [elements, elements]},
        }

    def semi_axes(self, force: Floats) -> Floats:
        """The same for every force."""
        return np.tile([self.a, self.b], (len(force), 1))


@dataclass(frozen=True)
class Quadratic:
    """Quadratic surfaces whose contact has the semi-axes a, b (m) at a load (N)."""

    a: float
    b: float
    force: float
    exact_pressure = True

    def tables(self, elements: int) -> dict[str, Any]:
        """The curvatures; the ellipse follows from each step's load."""
        return {
            "geometry": {"curvatures": list(hertz_curvatures(self.a, self.b, self.force))},
            "grid": {"elements": [elements, elements]},
        }

    def semi_axes(self, force: Floats) -> Floats:
        """Both grow with the cube root of the load (Hertz 1882)."""
        return np.outer(np.cbrt(force / self.force), [self.a, self.b])


@dataclass(frozen=True, eq=False)
class Surface:
    """Undeformed distance c0(y) + c1(y) x + c2(y) x^2 about the centre of the contact's box.

    y: m, [m], evenly spaced. rows: [m, 3], c0 in m, c1, c2 in 1/m. half_size: m, of the box that
    bounds the contact along rolling and lateral. Between rows the coefficients are cubic splines.
    """

    y: Floats
    rows: Floats
    half_size: tuple[float, float]
    exact_pressure = False

    def distance(self, x: Floats, y: Floats) -> Floats:
        """m, [len(y), len(x)]."""
        c0, c1, c2 = scipy.interpolate.CubicSpline(self.y, self.rows)(y).T[:, :, None]
        return c0 + c1 * x + c2 * x**2

    def tables(self, elements: int, room: float = 0.0) -> dict[str, Any]:
        """The distance on a grid with a margin around the contact's box.

        room: least margin over the size of the box, for theories whose contact is larger.
        """
        size = [2 * half / elements for half in self.half_size]
        count = elements + 2 * max(MARGIN, int(np.ceil(room * elements)))
        places = np.arange(count) - (count - 1) / 2
        gap = self.distance(size[0] * places, size[1] * places)
        return {
            "geometry": {"undeformed_distance": gap.tolist()},
            "grid": {"element_size": size},
        }

    def semi_axes(self, force: Floats) -> Floats:
        """Those of the ellipse in the box."""
        return np.tile(self.half_size, (len(force), 1))


def hertz_pressure(semi_axes: Floats, force: Floats) -> Floats:
    """Pa, greatest pressure of an elliptic contact: 3 F / (2 pi a b) (Hertz 1882)."""
    return 1.5 * force / (np.pi * semi_axes.prod(axis=1))


def hertz_curvatures(a: float, b: float, force: float) -> tuple[float, float]:
    """1/m, of the undeformed distance c0 x^2 + c1 y^2 whose contact ellipse is a, b at this load.

    Johnson, *Contact Mechanics*, 1985, eq. 4.26, with x along the longer axis.
    """
    longer, shorter = max(a, b), min(a, b)
    pressure = 1.5 * force / (np.pi * a * b)
    ratio = (shorter / longer) ** 2
    if ratio == 1:
        both = np.pi * pressure / (4 * a * CONTACT_MODULUS)
        return both, both
    m = 1 - ratio
    first, second = ellipk(m), ellipe(m)
    scale = pressure * shorter / (CONTACT_MODULUS * m * longer**2)
    along, across = scale * (first - second), scale * (second / ratio - first)
    return (float(along), float(across)) if a > b else (float(across), float(along))
