"""Friction laws, layers and temperatures, as tables of a case."""

from __future__ import annotations

from typing import Any

FALLING = {"law": "slip_velocity", "kinetic": 0.12, "amplitude": 0.23, "halving_speed": 0.05}
LAWS: dict[str, dict[str, Any]] = {
    "coulomb": {"friction": {"coefficient": 0.3}},
    "exponential": {"friction": FALLING},
    "rational": {"friction": {**FALLING, "shape": "rational"}},
    "linear": {"friction": {**FALLING, "shape": "linear"}},
    "two terms": {"friction": {**FALLING, "amplitude": [0.3, -0.1], "halving_speed": [0.04, 0.2]}},
    "polach": {
        "friction": {
            **{"law": "slip_velocity", "shape": "polach"},
            **{"coefficient": 0.45, "polach_a": 0.4, "polach_b": 12.0},
        }
    },
    "memory": {"friction": {**FALLING, "memory_distance": 8e-4, "memory_speed": 2e-3}},
    "temperature": {
        "friction": {
            **{"law": "temperature", "reference": 0.4, "change": -0.2},
            **{"reference_temperature": 22.0, "temperature_range": 60.0},
        },
        "temperature": {"wheel": 20.0, "rail": 20.0},
    },
    "heat of Coulomb friction": {
        "friction": {"coefficient": 0.3},
        "temperature": {
            **{"wheel": 40.0, "rail": 20.0, "exchange": True, "conductivity": [45.0, 55.0]},
            **{"heat_capacity": 480.0, "density": 7800.0, "depth": 2e-5},
        },
    },
    "factor": {"friction": {**FALLING, "factor": [[-1.0, 0.6], [1.0, 0.6]]}},
    "elastic layer": {
        "friction": {"coefficient": 0.3},
        "layer": {"shear_modulus": 8.2e9, "thickness": 5e-5},
    },
    "falling on a layer": {
        "friction": FALLING,
        "layer": {"shear_modulus": 8.2e9, "thickness": 5e-5},
    },
    "hardening layer": {
        "friction": {"coefficient": 0.4},
        "layer": {
            **{"shear_modulus": 8.2e9, "thickness": 5e-5, "yield_stress": 6e7},
            **{"hardening": 2e12, "plastic_rule": "magnitude"},
        },
    },
    "heat of a layer that yields": {
        "friction": {"coefficient": 0.4},
        "layer": {
            **{"shear_modulus": 8.2e9, "thickness": 5e-5, "yield_stress": 6e7},
            **{"plastic_rule": "path", "plastic_heat_fraction": 0.7},
        },
        "temperature": {"wheel": 20.0, "rail": 20.0},
    },
    "softening table": {
        "friction": FALLING,
        "layer": {"thickness": 0.0, "hardening_table": [[0.0, 9e7], [1e-5, 8e7], [5e-5, 6e7]]},
    },
    "unlike bodies": {
        "friction": FALLING,
        "material": {"shear_modulus": [82e9, 26e9], "poisson_ratio": [0.28, 0.33]},
    },
}
