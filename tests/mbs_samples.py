"""A wheelset in Pinocchio that the tests of mbs/ share."""

from __future__ import annotations

import copy
from typing import Any

import numpy as np
import pinocchio as pin
from railpatch.pinocchio import Body, wheelset_model

RADIUS = 0.46
WHEELSET = Body(1300.0, (700.0, 110.0, 700.0))
CASE: dict[str, Any] = {
    "kind": "wheelset",
    "grid": {"elements": [8, 8]},
    "friction": {"coefficient": 0.3},
    "method": {"tolerance": 1e-6},
    "wheelset": {
        "z": 0.0,
        "nominal_radius": RADIUS,
        "flange_back_distance": 1.36,
        "flange_back_position": -0.070,
    },
    "track": {"kind": "rail"},
    "profiles": {"wheel": "S1002", "rail": "UIC60@1:40"},
}
# keys of the element's state that are keys of [wheelset]
MOVING = ("y", "z", "roll", "yaw", "speed", "vy", "vz", "roll_rate", "yaw_rate", "pitch_rate")
# an easy state in contact, in the order of the composite's coordinates
ROLLING = np.array([2.0, 1e-3, 2.4e-4, 1e-4, 2e-3, 0.4])
RATES = np.array([20.0, 0.02, 1e-4, 2e-3, 0.02, -20.0 / RADIUS])


def rolling(*change: float) -> np.ndarray:
    """The easy state's coordinates with some change."""
    return ROLLING + np.array(change)


def case(**tables: dict[str, Any]) -> dict[str, Any]:
    """The case with values of some tables changed; None removes."""
    changed = copy.deepcopy(CASE)
    for table, values in tables.items():
        content = changed.setdefault(table, {})
        content.update(values)
        changed[table] = {key: value for key, value in content.items() if value is not None}
    return changed


def model() -> pin.Model:
    """A wheelset on a composite carrier."""
    return wheelset_model(WHEELSET, RADIUS)


def no_forces(model: pin.Model) -> pin.StdVec_Force:
    """An fext of zeros."""
    return pin.StdVec_Force([pin.Force.Zero() for _ in range(model.njoints)])


def random_motions(seed: int, count: int) -> list[tuple[np.ndarray, np.ndarray]]:
    """q and v of the composite near contact; of every fourth one or both wheels are in the air."""
    rng = np.random.default_rng(seed)
    found = []
    for index in range(count):
        q = ROLLING + rng.uniform(-1, 1, 6) * [5, 3e-3, 5e-5, 1e-4, 4e-3, 3]
        v = RATES + rng.uniform(-1, 1, 6) * [0.05, 0.05, 1e-3, 1e-2, 0.05, 0.1]
        if index % 4 == 3:
            q[2] -= 5e-4
            q[3] += 1e-3 * (index % 8 == 3)
        found.append((q, v))
    return found


def turn(axis: str, angle: float) -> np.ndarray:
    """[3, 3], about one axis."""
    vector = np.eye(3)["xyz".index(axis)]
    return pin.AngleAxis(angle, vector).matrix()
