"""The film of an elastohydrodynamic contact warms by its own shear (docs/ehl.md): its mean
temperature above the surfaces is tau v h/(12 k), of a parabola across it, and Eyring's stress is
that of its viscosity there. Written out again here, with another search for the root.
"""

from __future__ import annotations

import math
from functools import cache
from typing import Any

import numpy as np
import pytest
import railpatch
from railpatch.case import CaseError
from scipy.optimize import brentq

STRESS, ALPHA, ETA, LIMIT, SPEED, CREEPAGE = 5e6, 20e-9, 0.1, 0.5, 20.0, 0.1
OIL: dict[str, Any] = {"model": "ehl", "roughness": 1e-7, "liquid": "oil", "viscosity": ETA}
OIL |= {"boundary_friction": 0.15, "reference_temperature": 40.0, "eyring_stress": STRESS}
OIL |= {"limiting_friction": LIMIT}
CASE: dict[str, Any] = {
    "kind": "patch",
    "geometry": {"semi_axes": [6e-3, 5e-3]},
    "load": {"normal_force": 8e4},
    "motion": {"creepage": [CREEPAGE, 0.0], "spin_creepage": 0.0, "rolling_speed": SPEED},
    "friction": {"coefficient": 0.4},
    "grid": {"elements": [16, 12]},
    "method": {"normal": "half_space", "tangential": "full", "tolerance": 1e-8},
}
GIVEN = {"temperature": 40.0}


@cache
def solved(conductivity: float | None) -> railpatch.Result:
    fluid = {**OIL, **GIVEN}
    if conductivity is not None:
        fluid["liquid_conductivity"] = conductivity
    result = railpatch.Contact({**CASE, "fluid": fluid}).step(fields=True)
    assert result.status == "converged", result.reason
    return result


def viscosity(celsius: float, pressure: float) -> float:
    """Roelands' by temperature and pressure, with alpha as its slope at p = 0 and 40 degrees."""
    ratio = (celsius + 273.15 - 138) / (40 + 273.15 - 138)
    eta = ETA * math.exp((math.log(ETA) + 9.67) * (ratio**-1.1 - 1))
    scale = math.log(eta) + 9.67
    z = ALPHA * 1.96e8 / (math.log(ETA) + 9.67)
    return eta * math.exp(scale * ((1 + pressure / 1.96e8) ** z - 1))


def stress(rise: float, pressure: float, film: float, slip: float) -> float:
    rate = viscosity(40 + rise, pressure) * slip / film
    return min(STRESS * math.asinh(rate / STRESS), LIMIT * pressure)


def test_each_element_again() -> None:
    k = 0.14
    result = solved(k)
    fields = {name: np.array(result[name]) for name in ("fluid_pressure", "film_thickness")}
    asperities = 0.15 * (np.array(result["pressure"]) - fields["fluid_pressure"])
    slip = SPEED * CREEPAGE
    total = 0.0
    for p, h, a in zip(
        fields["fluid_pressure"].ravel(),
        fields["film_thickness"].ravel(),
        asperities.ravel(),
        strict=True,
    ):
        if not p > 0:
            continue

        def excess(rise: float, p: float = p, h: float = h) -> float:
            return rise - stress(rise, p, h, slip) * slip * h / (12 * k)

        high = stress(0.0, p, h, slip) * slip * h / (12 * k)
        # at its limit the stress does not fall
        limited = not excess(high) > 0
        rise = high if limited else brentq(excess, 0.0, high, xtol=1e-12, rtol=1e-14)
        total += stress(rise, p, h, slip) + a
    x, y = (np.unique(np.round(result[name], 12)) for name in ("x", "y"))
    area = (x[1] - x[0]) * (y[1] - y[0])
    assert result["effective_friction"] == pytest.approx(total * area / 8e4, rel=1e-9)


def test_it_falls_with_what_the_film_keeps() -> None:
    """Of a liquid that conducts all away what it is without; the books close."""
    none = solved(None)
    friction = none["effective_friction"]
    # a power series in 1/k, by its first three numbers at k without end
    one, two, three = (solved(1000.0 / n)["effective_friction"] for n in (1, 2, 3))
    assert 3 * one - 3 * two + three == pytest.approx(friction, rel=1e-6)
    found = [solved(k)["effective_friction"] for k in (0.05, 0.14, 10.0)]
    assert found[0] < found[1] < found[2] < friction
    assert found[1] < 0.8 * friction
    warm = solved(0.14)
    assert warm["central_film_thickness"] == none["central_film_thickness"]
    assert warm["fluid_power"] == pytest.approx(warm["friction_power"], rel=1e-6)


def test_with_the_temperature_of_the_surfaces() -> None:
    """All work of friction is in the bodies' heat."""
    heat = {"conductivity": 50.0, "heat_capacity": 450.0, "density": 7850.0}
    fluid = {**OIL, "liquid_conductivity": 0.14, "viscosity": ETA}
    result = railpatch.Contact({**CASE, "fluid": fluid, "temperature": heat}).step()
    assert result.status == "converged", result.reason
    both = result["wheel_heat"] + result["rail_heat"]
    assert both == pytest.approx(result["friction_power"], rel=1e-9)


@pytest.mark.parametrize(
    "changes",
    [
        {"liquid": "water", "viscosity": None, "eyring_stress": None, "limiting_friction": None},
        {"liquid": None, "temperature": None, "reference_temperature": None},
        {"model": "film"},
        {"model": "strip"},
    ],
)
def test_refused_where_nothing_reads_it(changes: dict[str, Any]) -> None:
    fluid = {**OIL, **GIVEN, "liquid_conductivity": 0.14, **changes}
    fluid = {key: value for key, value in fluid.items() if value is not None}
    with pytest.raises(CaseError, match=r"fluid\.liquid_conductivity|liquid_conductivity"):
        railpatch.Contact({**CASE, "fluid": fluid})
