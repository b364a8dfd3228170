"""Random wet cases with heat: creepages take the work of friction and of layers that yield, the
bodies get as heat all of the first and nine tenths of the second, and the liquid's own shear is a
part of friction.
"""

from __future__ import annotations

import random
from typing import Any

import numpy as np
import pytest
import railpatch

OF_PLASTIC = 0.9  # of a layer's work, temperature.plastic_heat_fraction by default


def drawn(seed: int) -> dict[str, Any]:
    """Every model with a grid, liquid, supply, layers, transient rolling, factors of friction."""
    rng = random.Random(seed)
    model = rng.choice(["film", "strip", "ehl"])
    fluid: dict[str, Any] = {"model": model, "roughness": 10 ** rng.uniform(-7, -5.3)}
    fluid["boundary_friction"] = rng.uniform(0.05, 0.3)
    liquid = rng.choice(["water", "oil", None])
    if liquid is not None:
        fluid["liquid"] = liquid
    if liquid != "water":
        fluid["viscosity"] = 10 ** rng.uniform(-2.5, -0.5)
        if model != "strip" and rng.random() < 0.7:
            fluid["eyring_stress"] = 10 ** rng.uniform(6, 7.2)
            if model == "ehl" and liquid == "oil" and rng.random() < 0.5:
                fluid["liquid_conductivity"] = 0.14
    if liquid is not None and rng.random() < 0.5:
        fluid["temperature"] = rng.uniform(5, 60)
    if model != "strip" and rng.random() < 0.4:
        fluid["oil_film"] = 10 ** rng.uniform(-8, -5)
    case: dict[str, Any] = {
        "kind": "patch",
        "geometry": {"semi_axes": [rng.uniform(3e-3, 8e-3), rng.uniform(3e-3, 8e-3)]},
        "load": {"normal_force": rng.uniform(2e4, 1.2e5)},
        "motion": {
            "creepage": [rng.uniform(-0.01, 0.01), rng.uniform(-0.005, 0.005)],
            "spin_creepage": rng.uniform(-1, 1),
            "rolling_speed": 10 ** rng.uniform(-1, 1.8),
            "direction": rng.choice([1, -1]),
        },
        "friction": {"coefficient": 0.4, "scale": [1.0, rng.uniform(0.4, 1.2)]},
        "grid": {"elements": [12, 10]},
        "method": {"normal": "half_space" if model == "ehl" else "hertz"},
        "fluid": fluid,
        "temperature": {"wheel": 20.0, "rail": 20.0},
    }
    if model != "ehl" and rng.random() < 0.5:
        case["motion"] |= {"regime": "transient_rolling", "distance": rng.uniform(2e-4, 2e-3)}
    if rng.random() < 0.4:
        case["layer"] = {"thickness": 1e-5, "shear_modulus": 10 ** rng.uniform(8.5, 10)}
        if rng.random() < 0.5:
            case["layer"]["yield_stress"] = 10 ** rng.uniform(7, 8)
    return case


@pytest.mark.parametrize("seed", range(36))
def test_heat_is_work(seed: int) -> None:
    case = drawn(seed)
    contact = railpatch.Contact(case)
    rolls_on = "regime" in case["motion"]
    for step in range(3 if rolls_on else 1):
        result = contact.step(creepage=[(1 - 0.4 * step) * c for c in case["motion"]["creepage"]])
        assert result.status == "converged", result.reason
        friction, plastic = result["friction_power"], result["plastic_power"]
        plastic = 0.0 if plastic is None or np.isnan(plastic) else plastic
        work = friction + plastic
        heat = result["wheel_heat"] + result["rail_heat"]
        # where all sticks what slides is within the solver's tolerance, 1e-5
        least = 1e-6 * abs(result["creep_power"])
        assert heat == pytest.approx(friction + OF_PLASTIC * plastic, rel=1e-9, abs=least)
        assert min(result["wheel_heat"], result["rail_heat"]) >= 0
        if not rolls_on:
            assert work == pytest.approx(result["creep_power"], rel=1e-6)
        assert -1e-12 * friction <= result["fluid_power"] <= friction * (1 + 1e-9)
