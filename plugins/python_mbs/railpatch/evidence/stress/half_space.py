"""Elastic half-space in numpy; shares nothing with the solver that it checks.

Piecewise-constant tractions on a uniform grid; coefficients by integrating the point-load
solutions (Boussinesq; Cerruti) over an element in closed form: with F an antiderivative in x and y,
the four corners' alternating sum. Line contact: plane strain, ln(width/r) in place of the point
load (Johnson 1985, section 2.3). Arrays are [ny, nx] and [2, ny, nx]; sums by convolution.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import NDArray

Array = NDArray[np.float64]


def convolved(kernel: Array, values: Array) -> Array:
    """Where the kernel [2 ny - 1, 2 nx - 1] covers all values [ny, nx]."""
    # scipy.signal has the same, and takes longer to import than many a trial takes
    full = [a + b - 1 for a, b in zip(kernel.shape, values.shape, strict=True)]
    size = [scipy.fft.next_fast_len(n, real=True) for n in full]
    product = scipy.fft.rfft2(kernel, size) * scipy.fft.rfft2(values, size)
    ny, nx = values.shape
    return scipy.fft.irfft2(product, size)[ny - 1 : full[0] - ny + 1, nx - 1 : full[1] - nx + 1]


def corners(
    primitive: Callable[[Array, Array], Array], x: Array, y: Array, dx: Array, dy: Array
) -> Array:
    """Integral over the element around (x, y) of the function with that primitive."""
    value = np.zeros(np.broadcast(x, y).shape)
    for sx in (1, -1):
        for sy in (1, -1):
            value += sx * sy * primitive(x + sx * dx / 2, y + sy * dy / 2)
    return value


def x2_over_r3(x: Array, y: Array) -> Array:
    """Primitive of x^2 / r^3 in x and y, by the inverse hyperbolic sine."""
    size = np.abs(y)
    return y * np.arcsinh(
        np.divide(x, size, out=np.zeros(np.broadcast(x, y).shape), where=size > 0)
    )


def y2_over_r3(x: Array, y: Array) -> Array:
    """Primitive of y^2 / r^3 in x and y."""
    return x2_over_r3(y, x)


def xy_over_r3(x: Array, y: Array) -> Array:
    """Primitive of x y / r^3 in x and y."""
    return -np.hypot(x, y)


def x_over_r2(x: Array, y: Array) -> Array:
    """Primitive of x / r^2 in x and y."""
    return y * np.log(np.hypot(x, y)) + x * np.arctan(y / x)


def y_over_r2(x: Array, y: Array) -> Array:
    """Primitive of y / r^2 in x and y."""
    return x_over_r2(y, x)


def x_log(x: Array) -> Array:
    """Primitive of ln |x|."""
    return x * np.log(np.where(x == 0, 1.0, np.abs(x))) - x


@dataclass(frozen=True)
class HalfSpace:
    """Displacement differences of two bodies.

    shape: elements [ny, nx]. dx, dy: m. shear_modulus, poisson_ratio, mismatch: of both together
    (G, nu and K of Kalker 1990, eq. 1.44; K is 0 with (1 - 2 nu)/G in common). layer: m/Pa,
    flexibility of a third-body layer. width: m, of a line contact.
    """

    shape: tuple[int, int]
    dx: float
    dy: float
    shear_modulus: float
    poisson_ratio: float
    layer: float = 0.0
    width: float | None = None
    mismatch: float = 0.0

    def kernels(self, ahead: float = 0.0) -> tuple[Array, Array, Array, Array]:
        """m/Pa: zz, xx, yy, xy by offset (rows, columns), seen from points `ahead` m along x."""
        ny, nx = self.shape
        x = np.arange(-nx + 1, nx) * self.dx + ahead
        nu, c = self.poisson_ratio, 1 / (np.pi * self.shear_modulus)
        if self.width is not None:
            low, high = x - self.dx / 2, x + self.dx / 2
            line = (self.dx * np.log(self.width) - x_log(high) + x_log(low))[None, :]
            return 2 * c * (1 - nu) * line, 2 * c * (1 - nu) * line, 2 * c * line, 0 * line
        y = np.arange(-ny + 1, ny)[:, None] * self.dy
        xx = corners(x2_over_r3, x, y, self.dx, self.dy)
        yy = corners(y2_over_r3, x, y, self.dx, self.dy)
        xy = corners(xy_over_r3, x, y, self.dx, self.dy)
        return (
            c * (1 - nu) * (xx + yy),
            c * (xx + (1 - nu) * yy),
            c * (yy + (1 - nu) * xx),
            c * nu * xy,
        )

    def normal(self, pressure: Array) -> Array:
        """u_n in the whole grid from the pressure."""
        return convolved(self.kernels()[0], pressure)

    def tangential(self, traction: Array, ahead: float = 0.0) -> Array:
        """[2, ny, nx], displacement at points `ahead` m along x of the elements' centres."""
        _, xx, yy, xy = self.kernels(ahead)
        px, py = traction
        u = np.array(
            [
                convolved(xx, px) + convolved(xy, py),
                convolved(xy, px) + convolved(yy, py),
            ]
        )
        return u + self.layer * shifted(traction, ahead / self.dx)

    def coupling(self, ahead: float = 0.0) -> tuple[Array, Array]:
        """m/Pa: u_x and u_y from p_n by offset, as in `kernels`; u_n from p_x and p_y with the
        other sign. Point contact only."""
        ny, nx = self.shape
        x = np.arange(-nx + 1, nx) * self.dx + ahead
        y = np.arange(-ny + 1, ny)[:, None] * self.dy
        c = -self.mismatch / (np.pi * self.shear_modulus)
        along = corners(x_over_r2, x, y, self.dx, self.dy)
        return c * along, c * corners(y_over_r2, x, y, self.dx, self.dy)

    def from_pressure(self, pressure: Array, ahead: float = 0.0) -> Array:
        """[2, ny, nx], tangential displacement that the pressure of unlike bodies causes."""
        return np.array([convolved(k, pressure) for k in self.coupling(ahead)])

    def from_traction(self, traction: Array) -> Array:
        """u_n in the whole grid that the tractions of unlike bodies cause."""
        x, y = (convolved(k, p) for k, p in zip(self.coupling(), traction, strict=True))
        return -(x + y)

    def flexibility(self, ahead: float | None = None) -> float:
        """m/Pa, displacement of one loaded element, mean of both directions; ahead: less that
        which is seen from there."""
        ny, nx = self.shape
        now = self.kernels()
        found = 0.5 * (now[1][ny - 1, nx - 1] + now[2][ny - 1, nx - 1]) + self.layer
        if ahead is None:
            return float(found)
        then = self.kernels(ahead)
        own = self.layer * max(0.0, 1 - abs(ahead) / self.dx)
        return float(found - 0.5 * (then[1][ny - 1, nx - 1] + then[2][ny - 1, nx - 1]) - own)


def shifted(field: Array, elements: float, outside: float = 0.0) -> Array:
    """Values at points so many elements along x of the centres, straight between centres."""
    nx = field.shape[-1]
    whole = int(np.floor(np.clip(elements, -nx - 1, nx + 1)))
    part = elements - whole if abs(elements) <= nx else 0.0
    low, high = moved(field, whole, outside), moved(field, whole + 1, outside)
    return low if part == 0 else (1 - part) * low + part * high


def moved(field: Array, elements: int, outside: float) -> Array:
    """Values of the element so many further along x."""
    nx = field.shape[-1]
    out = np.full_like(field, outside)
    if abs(elements) >= nx:
        return out
    if elements >= 0:
        out[..., : nx - elements] = field[..., elements:]
    else:
        out[..., -elements:] = field[..., :elements]
    return out
