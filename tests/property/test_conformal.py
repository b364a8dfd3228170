"""Conformal contact of S1002 on UIC60 in the flange root, by dense sums in three dimensions.

Nothing here is shared with the solver but the undeformed distance and the rows' positions and
angles (tests/cpp/test_conformal.cpp checks those against circles): every element's traction is a
vector in space, its displacement the mean of two half-spaces, one along the source's and one along
the observer's surface (Boussinesq and Cerruti integrated over rectangles, Love 1929; Kalker 1990,
appendix C). The contact conditions are asked of local components.
"""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest
import railpatch
from numpy.typing import NDArray

Array = NDArray[np.float64]

TOLERANCE = 1e-6
# the solver measures its residuals over all elements together; allow for another way of measuring
IMPOSED = 10 * TOLERANCE
SHEAR_MODULUS, POISSON_RATIO = 82e9, 0.28
RADIUS, SPEED, PITCH_RATE = 0.46, 20.0, -20.0 / 0.459
FRICTION = 0.3
PLACES = (5.0e-3, 6.5e-3)  # m: two parts in a patch of 13 degrees, one of 24 degrees


def wheel_case(
    y: float, tangential: str, surface: str = "curved", **options: Any
) -> dict[str, Any]:
    case: dict[str, Any] = {
        "kind": "wheel_rail",
        "wheelset": {
            "y": y,
            "yaw": 2e-3,
            "vertical_force": 6e4,
            "speed": SPEED,
            "pitch_rate": PITCH_RATE,
            "nominal_radius": RADIUS,
            "flange_back_distance": 1.36,
            "flange_back_position": -0.07,
        },
        "track": {"cant": 0.025},
        "profiles": {"wheel": "S1002", "rail": "UIC60"},
        "grid": {"elements": [14, 20]},
        "method": {"tangential": tangential, "reference_surface": surface, "tolerance": TOLERANCE},
    }
    if tangential != "none":
        case["friction"] = {"coefficient": FRICTION}
    case["method"].update(options)
    return case


class Solved:
    """A solved patch and its elements in space."""

    def __init__(self, y: float, tangential: str, **options: Any) -> None:
        contact = railpatch.Contact(wheel_case(y, tangential, **options))
        self.y = y
        self.result = contact.step(fields=True)
        assert self.result.status == "converged"
        (self.patch,) = self.result["patches"]
        self.h = contact._core.field(1, 0, "undeformed_distance")
        self.p = self.patch["pressure"].ravel()
        self.angle = self.patch["row_angle"]
        self.nx, self.ny = len(self.patch["x"]), len(self.patch["y"])
        self.dx, self.dy = np.diff(self.patch["x"][:2])[0], np.diff(self.patch["y"][:2])[0]

    @property
    def traction(self) -> Array:
        """[element, x s n] on the wheel, in the row's axes; pressure pushes along -n."""
        px, ps = self.patch["traction"].reshape(2, -1)
        return np.stack([px, ps, -self.p], axis=-1)

    def axes(self) -> Array:
        """[row, which of x s n, track axis]"""
        c, s, zero = np.cos(self.angle), np.sin(self.angle), 0 * self.angle
        x = np.stack([zero + 1, zero, zero], axis=-1)
        return np.stack([x, np.stack([zero, c, s], -1), np.stack([zero, -s, c], -1)], axis=1)

    def influence(self, ahead: int = 0) -> Array:
        """[observer row, observer x, source row, source x, 3, 3], in the rows' own axes; the
        observer lies that many elements further along x."""
        i, j = np.arange(self.nx), np.arange(self.ny)
        dx = (i[None, :, None, None] - i[None, None, None, :] + ahead) * self.dx
        dy = (j[:, None, None, None] - j[None, None, :, None]) * self.dy
        flat = half_space(dx + 0 * dy, dy + 0 * dx, self.dx, self.dy)
        axes = self.axes()
        # components of the source's axes in the observer's
        turn = np.einsum("iax,jbx->ijab", axes, axes)[:, None, :, None]
        return 0.5 * (turn @ flat + flat @ turn)

    def displacement(self, ahead: int = 0) -> Array:
        traction = self.traction.reshape(self.ny, self.nx, 3)
        return np.einsum("jiklab,klb->jia", self.influence(ahead), traction)

    def rigid_slip(self) -> Array:
        """[row, x of elements, x s]: velocity of the wheel's material over the rolling speed, as
        deep below the reference surface as the wheel's undeformed surface is at the reference."""
        patch, axes = self.patch, self.axes()
        position, arc = patch["row_position"], patch["y"]
        near = np.argsort(np.abs(arc))[:4]
        middle = np.array([np.polyval(np.polyfit(arc[near], r[near], 3), 0) for r in position])
        angle = patch["contact_angle"]
        normal = np.array([-np.sin(angle), np.cos(angle)])
        depth = patch["approach"] - normal @ (middle - np.array(patch["position"][1:]))
        yaw = 2e-3
        axle = np.array([-np.sin(yaw), np.cos(yaw), 0.0])
        centre = np.array([0, self.y, self.result["z"] - RADIUS])
        slip = np.empty((self.ny, self.nx, 2))
        for row in range(self.ny):
            for column in range(self.nx):
                # a quarter of an element upstream, as the rest of the step's slip is
                x = patch["position"][0] + patch["x"][column] + 0.25 * self.dx
                at = np.array([x, *position[:, row]]) + depth * axes[row, 2]
                turned = np.cross(PITCH_RATE * axle, at - centre)
                slip[row, column] = axes[row, :2] @ (np.array([SPEED, 0, 0]) + turned)
        return slip / patch["rolling_speed"]


@cache
def solved(y: float, tangential: str, **options: Any) -> Solved:
    return Solved(y, tangential, **options)


def half_space(x: Array, y: Array, dx: float, dy: float) -> Array:
    """[..., 3, 3] displacement (x, y, z) from unit traction on a rectangle, wheel minus rail."""
    total = np.zeros((*x.shape, 3, 3))
    for k in (0.5, -0.5):
        for m in (0.5, -0.5):
            u, v = x + k * dx, y + m * dy
            r = np.hypot(u, v)
            by_u, by_v = v * np.log(u + r), u * np.log(v + r)
            sign = 1 if k == m else -1
            nu = POISSON_RATIO
            total[..., 0, 0] += sign * (by_u + (1 - nu) * by_v)
            total[..., 1, 1] += sign * (by_v + (1 - nu) * by_u)
            total[..., 2, 2] += sign * (1 - nu) * (by_u + by_v)
            total[..., 0, 1] -= sign * nu * r
            total[..., 1, 0] -= sign * nu * r
    return total / (np.pi * SHEAR_MODULUS)


@pytest.mark.parametrize("y", PLACES)
@pytest.mark.parametrize("tangential", ["none", "full"])
def test_bodies_touch_where_there_is_pressure(y: float, tangential: str) -> None:
    s = solved(y, tangential)
    if tangential == "none":
        traction = np.stack([0 * s.p, 0 * s.p, -s.p], -1).reshape(s.ny, s.nx, 3)
        u = np.einsum("jiklab,klb->jia", s.influence(), traction)
    else:
        u = s.displacement()
    # of the same two numbers as the solver: greatest displacement by pressure
    scale = np.abs(u[..., 2]).max()
    gap = s.h - u[..., 2].ravel()
    assert np.all(s.p >= 0)
    assert np.abs(gap[s.p > 0]).max() < IMPOSED * scale
    assert gap[s.p == 0].min() > -IMPOSED * scale
    span = np.ptp(s.angle[(s.p.reshape(s.ny, s.nx) > 0).any(axis=1)])
    assert np.degrees(span) > 10


@pytest.mark.parametrize("y", PLACES)
def test_slip_is_that_of_rigid_motion_and_displacement(y: float) -> None:
    s = solved(y, "full")
    direction = 1
    change = (s.displacement() - s.displacement(direction))[..., :2] / s.dx
    rigid = s.rigid_slip()
    touching = s.patch["pressure"] > 0
    found = np.moveaxis(s.patch["micro_slip"], 0, -1)[touching]
    expected = (rigid + change)[touching]
    # the curve's height at the reference is interpolated between rows: 0.2 um over the radius
    assert np.abs(found - expected).max() < 0.2e-6 / RADIUS


@pytest.mark.parametrize("y", PLACES)
def test_traction_keeps_its_bound_and_opposes_slip(y: float) -> None:
    s = solved(y, "full")
    slip = s.patch["micro_slip"].reshape(2, -1)
    traction, bound = s.traction[:, :2].T, FRICTION * s.p
    size, speed = np.hypot(*traction), np.hypot(*slip)
    division = s.patch["element_division"].ravel()
    stick, sliding = division == 1, division == 2
    assert sliding.sum() > 10
    assert np.all(size <= bound * (1 + IMPOSED))
    typical = np.hypot(*s.rigid_slip().reshape(-1, 2).T).max()
    if stick.any():
        assert speed[stick].max() < 1e-4 * typical
    power = (traction * slip).sum(axis=0)[sliding]
    assert np.all(power <= 0)
    assert np.abs(power + (size * speed)[sliding]).max() < 1e-3 * (bound.max() * typical)


@pytest.mark.parametrize("y", PLACES)
@pytest.mark.parametrize("tangential", ["none", "full"])
def test_forces_are_sums_of_vectors(y: float, tangential: str) -> None:
    """By the rule that has pressure along the rows' normals; along the rail's: test_power.py."""
    s = solved(y, tangential, patch_rule="contact")
    local = s.traction if tangential == "full" else np.stack([0 * s.p, 0 * s.p, -s.p], axis=-1)
    vectors = np.einsum("jia,jax->jix", local.reshape(s.ny, s.nx, 3), s.axes()) * s.dx * s.dy
    force = vectors.sum(axis=(0, 1))
    assert s.result["force"] == pytest.approx(force, abs=1e-9 * 6e4)
    # about the wheelset's centre; on the surface, which the core moves by half the approach
    centre = np.array([0, s.y, s.result["z"] - RADIUS])
    moment = np.zeros(3)
    for row in range(s.ny):
        for column in range(s.nx):
            x = s.patch["position"][0] + s.patch["x"][column]
            at = np.array([x, *s.patch["row_position"][:, row]])
            moment += np.cross(at - centre, vectors[row, column])
    lever = 0.6 * s.patch["approach"]
    assert s.result["moment"] == pytest.approx(moment, abs=lever * np.linalg.norm(force))


@pytest.mark.parametrize("y", PLACES)
def test_any_traction_does_positive_work(y: float) -> None:
    s = solved(y, "full")
    size = 3 * s.nx * s.ny
    matrix = np.moveaxis(s.influence(), 4, 2).reshape(size, size)
    assert np.abs(matrix - matrix.T).max() < 1e-12 * np.abs(matrix).max()
    values = np.linalg.eigvalsh(matrix)
    assert values[0] > 0


def test_elastic_energy_is_half_the_work() -> None:
    s = solved(6.5e-3, "full")
    work = 0.5 * (s.traction * s.displacement().reshape(-1, 3)).sum() * s.dx * s.dy
    assert s.patch["elastic_energy"] == pytest.approx(work, rel=1e-5)


@pytest.mark.parametrize("name", ["row_position", "row_angle"])
def test_planes_have_no_rows_of_their_own(name: str) -> None:
    result = railpatch.solve(wheel_case(0.0, "full", "plane"), fields=True)
    assert name not in result["patches"][0]
