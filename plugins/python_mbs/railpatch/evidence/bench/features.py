"""What each piece of physics costs in time and memory, beside a plain case in the same run."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from railpatch import _core
from railpatch.case.load import load_scene
from railpatch.case.moving import changed_case
from railpatch.case.to_core import config_of, input_of
from railpatch.evidence.bench.problems import merged

SIZE = 24
PASSES, QUICK_PASSES = 15, 5
WARM_CHANGE = 1.01  # of the creepages between two warm steps
CREEPAGE = [8e-4, 3e-4]

PLAIN: dict[str, Any] = {
    "kind": "patch",
    "geometry": {"semi_axes": [0.006, 0.006]},
    "load": {"normal_force": 1.0e5},
    "grid": {"elements": [SIZE, SIZE]},
    "motion": {"creepage": CREEPAGE, "spin_creepage": 0.1, "rolling_speed": 20.0},
    "friction": {"coefficient": 0.3},
}
STEP = 0.012 / SIZE  # m, an element of PLAIN
WARM = {"wheel": 20.0, "rail": 20.0}
YIELDING = {"thickness": 2e-5, "shear_modulus": 1e9, "yield_stress": 2e8, "hardening": 1e13}
SLIP_LAW = {"law": "slip_velocity", "kinetic": 0.2, "amplitude": 0.1, "halving_speed": 0.05}
HEAT_LAW = {
    "law": "temperature",
    "reference": 0.3,
    "change": -0.2,
    "reference_temperature": 30.0,
    "temperature_range": 200.0,
}
SHIFTED = {
    "regime": "shift",
    "creepage": [8e-6, 3e-6],
    "spin_creepage": None,
    "rolling_speed": None,
}
ROLLING = {"regime": "transient_rolling", "distance": STEP}
# what each adds to the plain case; keys that are None are removed, tables that replace are whole
FEATURES: tuple[tuple[str, dict[str, Any]], ...] = (
    ("plain: steady rolling, Coulomb", {}),
    ("elastic layer", {"layer": {"thickness": 2e-5, "shear_modulus": 1e9}}),
    ("friction over the lateral position", {"friction": {"factor": [[-2e-3, 1.0], [2e-3, 0.6]]}}),
    ("slip-velocity law", {"friction": {"coefficient": None, **SLIP_LAW}}),
    (
        "slip-velocity law with memory",
        {"friction": {"coefficient": None, "memory_distance": 1e-3, **SLIP_LAW}},
    ),
    ("layer that yields", {"layer": YIELDING}),
    ("force prescribed", {"motion": {"creepage": None, "tangential_force": [-1.5e4, -5e3]}}),
    ("unlike bodies", {"material": {"shear_modulus": [82e9, 20e9]}}),
    ("temperature", {"temperature": WARM}),
    (
        "friction over temperature",
        {"temperature": WARM, "friction": {"coefficient": None, **HEAT_LAW}},
    ),
    ("shift, a step", {"motion": SHIFTED}),
    ("transient rolling, a step", {"motion": ROLLING}),
    ("the same, layer that yields", {"motion": ROLLING, "layer": YIELDING}),
    ("the same, temperature", {"motion": ROLLING, "layer": YIELDING, "temperature": WARM}),
    ("frictionless", {"friction": None, "method": {"tangential": "none"}}),
)


@dataclass(frozen=True)
class FeatureCost:
    """Cost of a step of one scene. cold, warm: s, medians; ratios: medians of the times over those
    of the plain scene in the same pass. bytes: held by the handle. good: all steps converged."""

    name: str
    cold: float
    warm: float
    cold_ratio: float
    warm_ratio: float
    bytes: int
    good: bool


def feature_costs(
    quick: bool = False, progress: Callable[[Any], None] = lambda _: None
) -> list[FeatureCost]:
    """Steps every scene once in each pass, cold and then warm with creepages 1 % away."""
    contacts, inputs = [], []
    for _, changes in FEATURES:
        scene = load_scene(merged(PLAIN, changes))
        contacts.append(_core.Contact(config_of(scene), False))
        inputs.append([input_of(changed_case(scene.case, move)) for move in moves(changes)])
    times = np.empty((QUICK_PASSES if quick else PASSES, len(FEATURES), 2))
    good = [True] * len(FEATURES)
    for one_pass in times:
        for k, contact in enumerate(contacts):
            seconds, results = contact.time_steps(inputs[k], [True, False, False], 1)
            one_pass[k] = seconds[0, 0], seconds[0, 1:].mean()
            good[k] = good[k] and all(result["status"] == "converged" for result in results)
    ratios = np.median(times / times[:, :1], axis=0)
    middle = np.median(times, axis=0)
    found = [
        FeatureCost(
            name=name,
            cold=float(middle[k, 0]),
            warm=float(middle[k, 1]),
            cold_ratio=float(ratios[k, 0]),
            warm_ratio=float(ratios[k, 1]),
            bytes=sum(stage["bytes"] for stage in contacts[k].describe()),
            good=good[k],
        )
        for k, (name, _) in enumerate(FEATURES)
    ]
    progress(found)
    return found


def moves(changes: dict[str, Any]) -> list[dict[str, Any]]:
    """Moving inputs of a cold step and two warm ones."""
    motion = {**PLAIN["motion"], **changes.get("motion", {})}
    key = "creepage" if motion["creepage"] is not None else "tangential_force"
    near = [WARM_CHANGE * value for value in motion[key]]
    return [{}, {key: near}, {key: motion[key]}]
