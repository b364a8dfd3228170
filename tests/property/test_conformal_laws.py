"""Conformal contact with friction laws, layers and heat, in steady rolling.

Laws are checked element by element by code that shares nothing with the solver
(railpatch/evidence/stress/laws.py), displacement with a layer by the dense sums of
tests/conformal_samples.py. Two equal convex arcs have a straight curve midway between them: there
the curved reference surface is the plane.
"""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest
import railpatch
from case_samples import with_values
from conformal_samples import FRICTION, PLACES, SPEED, Solved, wheel_case
from law_samples import LAWS
from railpatch.case.friction import Friction
from railpatch.evidence.stress import laws

TOLERANCE = 1e-9
IMPOSED = 20 * TOLERANCE
STICK, SLIP, PLASTIC = 1, 2, 3
HEATS = ("wheel_heat", "rail_heat", "max_temperature")
FLEXIBILITY = 5e-5 / 8.2e9  # m/Pa, of a layer
ALONE = [name for name in LAWS if name != "unlike bodies"]
HEATED = [name for name in ALONE if "temperature" in LAWS[name]]
FALLING = ("exponential", "rational", "linear", "two terms", "polach", "falling on a layer")


def curved_case(law: str, y: float) -> dict[str, Any]:
    case = {**wheel_case(y, "full", tolerance=TOLERANCE), **LAWS[law]}
    case["grid"] = {"elements": [14, 20]}
    return case


@cache
def solved(law: str, y: float) -> dict[str, Any]:
    result = railpatch.solve(curved_case(law, y), fields=True)
    assert result.status == "converged"
    (patch,) = result["patches"]
    return patch


def flat_case(law: str, surface: str) -> dict[str, Any]:
    """Two convex arcs of 0.3 m above each other, in all three creepages."""
    case = {**wheel_case(0.0, "full", surface), **LAWS[law]}
    case["profiles"] = {"wheel": "arc@0.3", "rail": "arc@0.3"}
    case["track"] = {"gauge": 1.36}
    case["wheelset"] |= {"yaw": 0.0, "vy": 0.02, "yaw_rate": 0.3}
    # both surfaces have pressure along normals of the patch
    case["method"] |= {"tolerance": 1e-10, "patch_rule": "contact"}
    return case


@pytest.mark.parametrize("law", ALONE)
def test_a_straight_curve_is_the_plane(law: str) -> None:
    plane, curved = (railpatch.solve(flat_case(law, s)) for s in ("plane", "curved"))
    assert plane.status == curved.status == "converged"
    size = np.linalg.norm(plane["force"])
    assert np.abs(np.subtract(curved["force"], plane["force"])).max() < 1e-6 * size
    (flat,), (bent,) = plane["patches"], curved["patches"]
    for name in ("approach", "friction_power", "elastic_energy", *HEATS, "plastic_power"):
        # those of what the case does not have are none
        assert bent[name] == pytest.approx(flat[name], rel=1e-6, nan_ok=True), name
    assert bent["elements"] == flat["elements"]


@pytest.mark.parametrize("y", PLACES)
@pytest.mark.parametrize("law", FALLING)
def test_the_law_holds_in_every_element(law: str, y: float) -> None:
    patch = solved(law, y)
    p = patch["pressure"]
    traction, slip = np.hypot(*patch["traction"]), np.hypot(*patch["micro_slip"])
    friction = Friction.model_validate(LAWS[law]["friction"])
    bound = laws.by_speed(friction, slip * patch["rolling_speed"]) * p
    sliding = patch["element_division"] == SLIP
    assert sliding.sum() > 20
    assert np.abs(traction - bound)[sliding].max() <= IMPOSED * bound.max()
    assert np.all(traction <= friction.greatest * p * (1 + IMPOSED))
    # opposite to the micro-slip
    along = (patch["traction"] * patch["micro_slip"]).sum(axis=0)[sliding]
    assert np.all(along <= 0)
    straight = along / (traction * slip)[sliding]
    assert np.abs(straight + 1).max() < 1e-6


@pytest.mark.parametrize("y", PLACES)
def test_yield_bounds_every_element(y: float) -> None:
    """Of a layer that does not harden: the lesser of friction and yield stress."""
    patch = solved("heat of a layer that yields", y)
    traction = np.hypot(*patch["traction"])
    stress = LAWS["heat of a layer that yields"]["layer"]["yield_stress"]
    bound = np.minimum(0.4 * patch["pressure"], stress)
    assert np.all(traction <= bound + IMPOSED * stress)
    moved = patch["element_division"] >= SLIP
    assert np.abs(traction - bound)[moved].max() <= IMPOSED * stress
    assert (patch["element_division"] == PLASTIC).sum() > 20


@pytest.mark.parametrize("y", PLACES)
def test_friction_follows_temperature(y: float) -> None:
    patch = solved("temperature", y)
    friction = Friction.model_validate(LAWS["temperature"]["friction"])
    both = patch["temperature"]
    coefficient = laws.by_temperature(friction, np.max(both, axis=0))
    sliding = patch["element_division"] == SLIP
    bound = coefficient * patch["pressure"]
    size = np.hypot(*patch["traction"])
    assert np.abs(size - bound)[sliding].max() <= 1e-6 * bound.max()
    assert np.ptp(coefficient[sliding]) > 0.05


@pytest.mark.parametrize("y", PLACES)
@pytest.mark.parametrize("law", HEATED)
def test_heat_is_what_friction_takes(law: str, y: float) -> None:
    patch = solved(law, y)
    layer = LAWS[law].get("layer", {})
    taken = patch["friction_power"]
    if "yield_stress" in layer:
        taken += layer["plastic_heat_fraction"] * patch["plastic_power"]
    assert patch["wheel_heat"] + patch["rail_heat"] == pytest.approx(taken, rel=1e-9)
    assert taken > 0


class Layered(Solved):
    """With the third body's part of the displacement, that of each element's own traction."""

    def displacement(self, ahead: int = 0) -> np.ndarray:
        u = super().displacement(ahead)
        traction = self.traction.reshape(self.ny, self.nx, 3)
        own = np.zeros_like(traction)
        own[:, : self.nx - ahead] = FLEXIBILITY * traction[:, ahead:]
        own[..., 2] = 0
        return u + own


@pytest.mark.parametrize("y", PLACES)
def test_a_layer_gives_way_to_its_own_traction(y: float, monkeypatch: pytest.MonkeyPatch) -> None:
    case = curved_case("elastic layer", y)
    case["method"]["spin_offset"] = "quarter"
    monkeypatch.setattr("conformal_samples.wheel_case", lambda *_, **__: case)
    s = Layered(y, "full")
    change = (s.displacement() - s.displacement(1))[..., :2] / s.dx
    touching = s.patch["pressure"] > 0
    found = np.moveaxis(s.patch["micro_slip"], 0, -1)[touching]
    expected = (s.rigid_slip() + change)[touching]
    # as without a layer: the curve's height at the reference is interpolated between rows
    assert np.abs(found - expected).max() < 0.2e-6 / 0.46
    layers = np.abs((s.displacement() - super(Layered, s).displacement())[..., :2]).max()
    assert layers > 10 * 0.2e-6 / 0.46 * s.dx


@pytest.mark.parametrize("y", PLACES)
def test_a_thin_layer_is_none(y: float) -> None:
    """The flexibility's limit; forces go there straight."""
    # the place of the spin term is another by default where there is a layer
    without = railpatch.solve(with_values(curved_case("coulomb", y), method__spin_offset="none"))
    forces = []
    for thickness in (2e-8, 1e-8):
        case = with_values(curved_case("coulomb", y), method__spin_offset="none")
        case["layer"] = {"shear_modulus": 8.2e9, "thickness": thickness}
        forces.append(np.subtract(railpatch.solve(case)["force"], without["force"]))
    size = FRICTION * 6e4
    assert np.abs(forces[1]).max() < 1e-3 * size
    assert forces[0] == pytest.approx(2 * forces[1], abs=1e-5 * size)


def test_what_is_solved_rolls() -> None:
    assert all(abs(solved("coulomb", y)["rolling_speed"] / SPEED - 1) < 0.05 for y in PLACES)
