"""Cases that the tests of this folder change."""

from __future__ import annotations

import copy
from typing import Any

PATCH: dict[str, Any] = {
    "kind": "patch",
    "material": {"shear_modulus": 82e9, "poisson_ratio": 0.28},
    "geometry": {"semi_axes": [0.006, 0.006]},
    "load": {"normal_force": 1.0e5},
    "grid": {"elements": [16, 16]},
    "motion": {
        "regime": "steady_rolling",
        "creepage": [1e-3, 0.0],
        "spin_creepage": 0.0,
        "rolling_speed": 10.0,
    },
    "friction": {"coefficient": 0.3},
}
WHEELSET: dict[str, Any] = {
    "kind": "wheelset",
    "grid": {"element_size": [5e-4, 5e-4]},
    "friction": {"coefficient": 0.3},
    "wheelset": {
        "y": 0.0,
        "z": 1e-4,
        "speed": 2.0,
        "pitch_rate": -2.0 / 0.46,
        "nominal_radius": 0.46,
        "flange_back_distance": 1.36,
        "flange_back_position": -0.070,
    },
    "track": {"kind": "rail", "gauge": 1.435, "gauge_height": 0.014},
    "profiles": {"wheel": "S1002", "rail": "UIC60@1:40"},
}


def with_values(case: dict[str, Any], **values: Any) -> dict[str, Any]:
    """The case with values by key, 'load__normal_force' for [load] normal_force; None removes."""
    changed = copy.deepcopy(case)
    for key, value in values.items():
        *tables, name = key.split("__")
        table = changed
        for part in tables:
            table = table.setdefault(part, {})
        if value is None:
            table.pop(name, None)
        else:
            table[name] = copy.deepcopy(value)
    return changed
