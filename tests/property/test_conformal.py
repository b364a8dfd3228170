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
from conformal_samples import FRICTION, PLACES, RADIUS, TOLERANCE, Solved, wheel_case
from railpatch.case.to_core import POSE_AND_VELOCITY

# the solver measures its residuals over all elements together; allow for another way of measuring
IMPOSED = 10 * TOLERANCE


@cache
def solved(y: float, tangential: str, **options: Any) -> Solved:
    return Solved(y, tangential, **options)


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


@pytest.mark.parametrize("rule", ["blended", "contact"])
@pytest.mark.parametrize("coefficient", [0.05, 0.3])
@pytest.mark.parametrize("y", PLACES)
def test_friction_is_used_by_tractions_alone(y: float, coefficient: float, rule: str) -> None:
    """The creep force has the lateral part of pressures that are inclined against each other, which
    no friction carries and which wears nothing."""
    case = wheel_case(y, "full", patch_rule=rule)
    case["friction"]["coefficient"] = coefficient
    for patch in railpatch.solve(case, fields=True)["patches"]:
        area = np.diff(patch["x"][:2])[0] * np.diff(patch["y"][:2])[0]
        px, ps = patch["traction"] * area
        force, load = np.array([px.sum(), ps.sum()]), patch["pressure"].sum() * area
        moment = (patch["x"] * ps - patch["y"][:, None] * px).sum()
        size = np.hypot(*force)
        assert patch["utilised_friction"] == pytest.approx(size / (coefficient * load), rel=1e-9)
        assert patch["utilised_friction"] <= 1 + IMPOSED
        assert patch["traction_coefficient"] == pytest.approx(
            size / patch["normal_force"], rel=1e-9
        )
        gamma = [*patch["creepage"], patch["spin_creepage"]]
        wear = np.abs(np.array([*force, moment]) * gamma).sum()
        assert patch["wear_number"] == pytest.approx(wear, rel=1e-9)


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


def test_derivatives_are_by_differences() -> None:
    """So that what asks for them, runs in time among it, goes on curved surfaces too."""
    y, step = PLACES[0], 2e-6
    case = wheel_case(y, "full", tolerance=1e-9, derivatives=True)
    case["wheelset"]["z"] = railpatch.solve(case)["z"]
    del case["wheelset"]["vertical_force"]
    contact = railpatch.Contact(case)
    contact.step()
    found = contact.jacobian()
    assert found["kind"] == "differences"
    ahead, behind = (
        railpatch.Contact(case).step(y=y + sign * step)["force"] for sign in (1.0, -1.0)
    )
    slope = np.subtract(ahead, behind) / (2 * step)
    column = np.array(found["right"])[:3, POSE_AND_VELOCITY.index("y")]
    assert column == pytest.approx(slope, abs=0.02 * np.abs(slope).max())
