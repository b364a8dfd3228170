"""The heat of the film: what the liquid's own shear takes of the power of friction.

Asperities and liquid share the friction mu = mu_a f + mu_f (1 - f) of docs/fluids.md, so they share
its power: the part is written out again here, and the books must close.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
import railpatch
from case_samples import WHEELSET, with_values

STRESS, LIMIT, VISCOSITY, ALPHA = 8e6, 0.07, 0.1, 20e-9
OIL: dict[str, Any] = {
    "model": "film",
    "roughness": 8e-6,
    "boundary_friction": 0.15,
    "viscosity": VISCOSITY,
    "pressure_coefficient": ALPHA,
    "eyring_stress": STRESS,
    "limiting_friction": LIMIT,
}
CASE: dict[str, Any] = {
    "kind": "patch",
    "geometry": {"semi_axes": [6e-3, 5e-3]},
    "load": {"normal_force": 8e4},
    "motion": {"creepage": [6e-3, 2e-3], "spin_creepage": 0.0, "rolling_speed": 5.0},
    "friction": {"coefficient": 0.4},
    "grid": {"elements": [16, 16]},
    "method": {"normal": "hertz", "tangential": "full", "tolerance": 1e-8},
    "fluid": OIL,
}
HEAT = {"conductivity": 50.0, "heat_capacity": 450.0, "density": 7850.0}
LOADED = with_values(WHEELSET, wheelset__z=None, wheelset__vertical_force=2e4)
RELATIVE = 1e-12


def solved(case: dict[str, Any], **changes: Any) -> railpatch.Result:
    result = railpatch.Contact(case).step(**changes)
    assert result.status == "converged", result.reason
    return result


def shear_friction(result: railpatch.Result) -> float:
    """mu_f (1 - f) of Eyring's liquid at the mean pressure, by the result's own film."""
    pressure = 8e4 / (math.pi * 6e-3 * 5e-3)
    slip = 5.0 * math.hypot(6e-3, 2e-3)
    rate = VISCOSITY * math.exp(ALPHA * pressure) * slip / result["central_film_thickness"]
    friction = min(STRESS * math.asinh(rate / STRESS) / pressure, LIMIT)
    return friction * (1 - result["mean_asperity_share"])


@pytest.mark.parametrize("theory", ["full", "polach", "fastsim"])
def test_asperities_and_film_share_the_work(theory: str) -> None:
    result = solved({**CASE, "method": {**CASE["method"], "tangential": theory}})
    asperities = 0.15 * result["mean_asperity_share"]
    part = shear_friction(result) / (asperities + shear_friction(result))
    assert 0.1 < part < 0.9
    film, friction = result["fluid_power"], result["friction_power"]
    assert film == pytest.approx(part * friction, rel=1e-9)
    assert film + friction * (1 - part) == pytest.approx(friction, rel=RELATIVE)
    if theory != "fastsim":  # whose elements leave a part of the work open
        assert friction == pytest.approx(result["creep_power"], rel=1e-6)


@pytest.mark.parametrize("model", ["film", "strip"])
def test_both_bodies_get_the_heat_of_asperities_and_film(model: str) -> None:
    """With [temperature] all work of friction, the film's too, is in the bodies' heat."""
    fluid = OIL if model == "film" else {"model": "strip", "roughness": 5e-7, "liquid": "water"}
    fluid = {**fluid, "boundary_friction": 0.15}
    result = solved({**CASE, "fluid": fluid, "temperature": HEAT})
    heat = result["wheel_heat"] + result["rail_heat"]
    assert heat == pytest.approx(result["friction_power"], rel=RELATIVE)
    film = result["fluid_power"]
    assert (film > 0.1 * heat) if model == "film" else (film == 0.0)


def test_of_an_elastohydrodynamic_contact() -> None:
    """Element by element; without asperities all of it, without Eyring's stress nothing."""
    oil = {"model": "ehl", "boundary_friction": 0.15, "liquid": "oil", "viscosity": 0.1}
    oil |= {"temperature": 40.0, "eyring_stress": 5e6}
    case = {**CASE, "grid": {"elements": [32, 16]}, "method": {"tolerance": 1e-8}}
    case["motion"] = {**CASE["motion"], "rolling_speed": 20.0}
    smooth = solved({**case, "fluid": {**oil, "roughness": 1e-7}})
    assert smooth["fluid_power"] == pytest.approx(smooth["friction_power"], rel=1e-6)
    contact = railpatch.Contact({**case, "fluid": {**oil, "roughness": 2e-6}, "temperature": HEAT})
    rough = contact.step(fields=True)
    film, friction = rough["fluid_power"], rough["friction_power"]
    assert 0.01 * friction < film < 0.99 * friction
    heat = rough["wheel_heat"] + rough["rail_heat"]
    assert heat == pytest.approx(friction, rel=RELATIVE)
    # sliding elements have tractions at the bound mu_a p_a + tau_f
    fields = {name: np.array(rough[name]) for name in ("pressure", "fluid_pressure", "traction")}
    asperity = 0.15 * (fields["pressure"] - fields["fluid_pressure"])
    traction = np.hypot(*fields["traction"])
    work = traction * np.hypot(*np.array(rough["micro_slip"]))
    slides = work > 0
    part = np.zeros_like(work)
    part[slides] = 1 - asperity[slides] / traction[slides]
    # here of each place, there of material that moves by an element
    assert film / friction == pytest.approx((part * work).sum() / work.sum(), abs=0.02)
    dry_oil = {**oil, "roughness": 2e-6, "eyring_stress": 0.0}
    assert solved({**case, "fluid": dry_oil})["fluid_power"] == 0.0


def test_where_it_is_not_known_or_nothing() -> None:
    method = {**CASE["method"], "tangential": "polach"}
    regimes = {"model": "regimes", "water_rate": 1e-7}
    by_regimes = {**CASE, "friction": None, "fluid": regimes, "method": method}
    assert math.isnan(solved(by_regimes)["fluid_power"])
    dry = {name: table for name, table in CASE.items() if name != "fluid"}
    assert math.isnan(solved(dry)["fluid_power"])
    stands = {**CASE["motion"], "rolling_speed": 0.0, "creepage": [0.0, 0.0]}
    assert solved({**CASE, "motion": stands})["fluid_power"] == 0.0
    apart = {**CASE, "load": {"approach": -1e-5}}
    assert railpatch.Contact(apart).step()["fluid_power"] == 0.0


def test_wheels_have_their_patches_sum() -> None:
    result = solved({**LOADED, "fluid": OIL})
    sums = 0.0
    for side in ("left", "right"):
        patches = [*result[side]["patches"], *result[side].get("alternatives", [])]
        own = math.fsum(patch["share"] * patch["fluid_power"] for patch in patches)
        assert result[side]["fluid_power"] == pytest.approx(own, rel=RELATIVE)
        sums += own
    assert sums > 0
    assert result["fluid_power"] == pytest.approx(sums, rel=RELATIVE)
