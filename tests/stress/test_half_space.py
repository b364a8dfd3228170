"""The check's own half-space: against direct sums of point loads and against closed forms."""

from __future__ import annotations

import numpy as np
import pytest
from railpatch.evidence.stress.half_space import HalfSpace, shifted

G, NU = 82e9, 0.28
RANDOM = np.random.default_rng(11)


def point_loads(p: np.ndarray, dx: float, dy: float, at: tuple[float, float]) -> np.ndarray:
    """u_x, u_y, u_n of Boussinesq's and Cerruti's point loads on a fine raster (Johnson 1985, 3.3,
    3.6, for two bodies of the same material)."""
    fine = 40
    ny, nx = p.shape[1:]
    x = (np.arange(nx * fine) + 0.5) / fine * dx - dx / 2
    y = (np.arange(ny * fine) + 0.5) / fine * dy - dy / 2
    p = np.repeat(np.repeat(p, fine, axis=1), fine, axis=2) * dx * dy / fine**2
    rx, ry = at[0] - x, at[1] - y[:, None]
    r = np.hypot(rx, ry)
    c = 1 / (np.pi * G)
    xx, yy = c * ((1 - NU) / r + NU * rx**2 / r**3), c * ((1 - NU) / r + NU * ry**2 / r**3)
    xy, nn = c * NU * rx * ry / r**3, c * (1 - NU) / r
    return np.array(
        [(xx * p[0] + xy * p[1]).sum(), (xy * p[0] + yy * p[1]).sum(), (nn * p[2]).sum()]
    )


@pytest.mark.parametrize("ahead", [0.0, 1.0, -2.5, 0.5])
def test_against_point_loads(ahead: float) -> None:
    shape, dx, dy = (4, 5), 1e-3, 7e-4
    p = np.random.default_rng(11).standard_normal((3, *shape))
    space = HalfSpace(shape, dx, dy, G, NU)
    u = space.tangential(p[:2], ahead * dx)
    for row, column in ((0, 0), (2, 3)):
        # a raster of even number has no point where the observer stands
        wanted = point_loads(p, dx, dy, ((column + ahead) * dx, row * dy))
        # the raster cuts the singular load short by a part of its own size
        assert u[:, row, column] == pytest.approx(wanted[:2], abs=0.02 * np.abs(wanted).max())
        if ahead == 0:
            normal = space.normal(p[2])[row, column]
            assert normal == pytest.approx(wanted[2], abs=0.02 * abs(wanted[2]) + 1e-16)


def test_line_contact_is_a_long_strip() -> None:
    """Differences of displacement in the middle of a strip that is long against its width."""
    n, dx = 6, 1e-3
    p = RANDOM.standard_normal((2, 1, n))
    length = 1e4 * dx
    line = HalfSpace((1, n), dx, 1.0, G, NU, width=1.0)
    strip = HalfSpace((1, n), dx, length, G, NU)
    flat = HalfSpace.tangential(line, p), HalfSpace.tangential(strip, p)
    for one, other in zip(*flat, strict=True):
        assert np.ptp(one - other) <= 1e-6 * np.ptp(one)


def test_layer_adds_to_the_diagonal() -> None:
    shape = (3, 6)
    p = RANDOM.standard_normal((2, *shape))
    bare, layered = (HalfSpace(shape, 1e-3, 1e-3, G, NU, layer) for layer in (0.0, 3e-15))
    for elements in (0.0, 1.0, 0.25, -7.0):
        difference = layered.tangential(p, 1e-3 * elements) - bare.tangential(p, 1e-3 * elements)
        assert np.allclose(difference, 3e-15 * shifted(p, elements), rtol=1e-9, atol=1e-24)
    assert layered.flexibility() - bare.flexibility() == pytest.approx(3e-15, rel=1e-9)


def test_shift_of_a_field() -> None:
    field = np.arange(4.0)[None, :]
    assert shifted(field, 1.0).tolist() == [[1, 2, 3, 0]]
    assert shifted(field, -2.0, 9.0).tolist() == [[9, 9, 0, 1]]
    assert shifted(field, 0.25).tolist() == [[0.25, 1.25, 2.25, 2.25]]
    assert shifted(field, 100.0).tolist() == [[0, 0, 0, 0]]
