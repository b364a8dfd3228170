"""Elastic half-space by direct summation, in numpy; shares nothing with the solver it checks.

Piecewise-constant tractions on a uniform grid; coefficients by integrating the point-load solutions
(Boussinesq; Cerruti) over an element in closed form: with F an antiderivative in x and y, the four
corners' alternating sum. Arrays are [ny, nx] and [2, ny, nx].
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def corners(primitive, x: Array, y: Array, dx: float, dy: float) -> Array:
    """Integral over the element around (x, y) of the function with that primitive."""
    value = np.zeros(np.broadcast(x, y).shape)
    for sx in (1, -1):
        for sy in (1, -1):
            value += sx * sy * primitive(x + sx * dx / 2, y + sy * dy / 2)
    return value


def x2_over_r3(x: Array, y: Array) -> Array:
    """Primitive of x^2 / r^3 in x and y, by the inverse hyperbolic sine."""
    return y * np.arcsinh(x / np.abs(y))


def y2_over_r3(x: Array, y: Array) -> Array:
    return x * np.arcsinh(y / np.abs(x))


def xy_over_r3(x: Array, y: Array) -> Array:
    return -np.hypot(x, y)


def x_over_r2(x: Array, y: Array) -> Array:
    """Primitive of x / r^2 in x and y."""
    return y * np.log(np.hypot(x, y)) + x * np.arctan(y / x)


def y_over_r2(x: Array, y: Array) -> Array:
    return x * np.log(np.hypot(x, y)) + y * np.arctan(x / y)


@dataclass
class HalfSpace:
    """Displacement differences of two bodies, with their combined constants (Kalker 1990, eq.
    1.44), from tractions on the elements of a mask."""

    x: Array
    y: Array
    mask: NDArray[np.bool_]  # [ny, nx], the loaded elements; all results are given on it too
    shear_modulus: float
    poisson_ratio: float
    layer: float = 0.0  # m/Pa
    mismatch: float = 0.0  # K of unlike bodies

    def __post_init__(self) -> None:
        self.dx, self.dy = self.x[1] - self.x[0], self.y[1] - self.y[0]
        rows, columns = np.nonzero(self.mask)
        self.rows, self.columns = rows, columns

    def table(self, ahead: int) -> tuple[Array, Array, Array, Array]:
        """zz, xx, yy, xy by offset (rows, columns), seen from `ahead` elements further along x."""
        ny, nx = self.mask.shape
        x = (np.arange(-nx + 1, nx) + ahead) * self.dx
        y = np.arange(-ny + 1, ny)[:, None] * self.dy
        xx = corners(x2_over_r3, x, y, self.dx, self.dy)
        yy = corners(y2_over_r3, x, y, self.dx, self.dy)
        xy = corners(xy_over_r3, x, y, self.dx, self.dy)
        nu = self.poisson_ratio
        c = 1 / (np.pi * self.shear_modulus)
        out = (c * (1 - nu) * (xx + yy), c * (xx + (1 - nu) * yy), c * (yy + (1 - nu) * xx))
        for k in (1, 2):
            if abs(ahead) < nx:
                out[k][ny - 1, nx - 1 - ahead] += self.layer
        return (*out, c * nu * xy)

    def matrix(self, table: Array) -> Array:
        """The dense matrix on the mask's elements."""
        ny, nx = self.mask.shape
        dj = self.rows[:, None] - self.rows[None, :] + ny - 1
        di = self.columns[:, None] - self.columns[None, :] + nx - 1
        return table[dj, di]

    def normal(self, pressure: Array) -> Array:
        """u_n in the whole grid from the pressure."""
        everywhere = HalfSpace(
            self.x,
            self.y,
            np.ones_like(self.mask),
            self.shear_modulus,
            self.poisson_ratio,
        )
        ny, nx = self.mask.shape
        zz = self.table(0)[0]
        dj = everywhere.rows[:, None] - self.rows[None, :] + ny - 1
        di = everywhere.columns[:, None] - self.columns[None, :] + nx - 1
        return (zz[dj, di] @ pressure[self.mask]).reshape(ny, nx)

    def displacement(self, traction: Array, ahead: int = 0) -> Array:
        """[2, N] on the mask, seen from `ahead` elements further along x."""
        _, xx, yy, xy = self.table(ahead)
        px, py = traction[0][self.mask], traction[1][self.mask]
        coupling = self.matrix(xy)
        return np.array(
            [self.matrix(xx) @ px + coupling @ py, coupling @ px + self.matrix(yy) @ py]
        )

    def coupling(self, ahead: int) -> tuple[Array, Array]:
        """u_x and u_y from p_n by offset, as in `table`; with the other sign u_n from p_x, p_y."""
        ny, nx = self.mask.shape
        x = (np.arange(-nx + 1, nx) + ahead) * self.dx
        y = np.arange(-ny + 1, ny)[:, None] * self.dy
        c = -self.mismatch / (np.pi * self.shear_modulus)
        along = corners(x_over_r2, x, y, self.dx, self.dy)
        across = corners(y_over_r2, x, y, self.dx, self.dy)
        return c * along, c * across

    def from_pressure(self, pressure: Array, ahead: int = 0) -> Array:
        """[2, N] on the mask, tangential displacement seen from `ahead` elements further on."""
        p = pressure[self.mask]
        return np.array([self.matrix(table) @ p for table in self.coupling(ahead)])

    def from_traction(self, traction: Array) -> Array:
        """u_n in the whole grid from the tractions."""
        ny, nx = self.mask.shape
        rows, columns = (k.ravel() for k in np.indices((ny, nx)))
        dj = rows[:, None] - self.rows[None, :] + ny - 1
        di = columns[:, None] - self.columns[None, :] + nx - 1
        sum_ = np.zeros(ny * nx)
        for table, t in zip(self.coupling(0), traction, strict=True):
            sum_ -= table[dj, di] @ t[self.mask]
        return sum_.reshape(ny, nx)

    def stiffness(self) -> float:
        """Pa, dx over the jump of displacement at one loaded element: turns slip to traction."""
        now, upstream = self.table(0), self.table(1)
        ny, nx = self.mask.shape
        at = (ny - 1, nx - 1)
        return 2 * self.dx / (now[1][at] - upstream[1][at] + now[2][at] - upstream[2][at])
