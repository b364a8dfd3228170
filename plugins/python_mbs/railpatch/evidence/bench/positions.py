"""Contacts of wheels on rails at random positions, to fit and test models on: other loads, rails,
lateral positions and angles than those of set B."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from railpatch.case.load import load_scene
from railpatch.evidence.bench.problems import Batch, merged
from railpatch.evidence.bench.surfaces import MANCHESTER, patches_of

RADII = (0.3, 0.55)  # m, of wheels
LOADS = (4e3, 8e4)  # N, vertical
CANTS = (20, 30, 40, 60)  # of rails, 1:n
ROLLERS = 0.3  # share of wheels on rollers
TRIALS = 20


def random_position(random: np.random.Generator) -> tuple[dict[str, Any], dict[str, Any]]:
    """A case of a wheel and its state."""
    radius, load = random.uniform(*RADII), np.exp(random.uniform(*np.log(LOADS)))
    track: dict[str, Any] = {}
    if random.random() < ROLLERS:
        track = {"kind": "roller", "roller_radius": random.uniform(0.3, 1.0)}
    y = random.uniform(-6e-3, 11e-3)
    case = {
        "wheelset": {"vertical_force": float(load), "nominal_radius": float(radius)},
        "profiles": {"rail": f"UIC60@1:{random.choice(CANTS)}"},
        "track": track,
        # elements that grow with the contact, as finely as the grid allows
        "grid": {"element_size": [4e-4 * (load / 1e4) ** (1 / 3), 1e-4 * (load / 1e4) ** (1 / 3)]},
    }
    rate = -MANCHESTER["wheelset"]["speed"] / radius
    state = {
        "y": float(y),
        "roll": float(-0.05 * y * random.uniform(0, 3)),
        "yaw": float(random.choice((-1, 1)) * 10 ** random.uniform(-4, -1.7)),
        "pitch_rate": float(rate * (1 + 1e-3 * random.standard_normal())),
    }
    if track:
        track["roller_pitch_rate"] = MANCHESTER["wheelset"]["speed"] / track["roller_radius"]
        case["wheelset"]["speed"] = 0.0
    return merged(MANCHESTER, case), state


def random_patch(random: np.random.Generator, index: int) -> Batch:
    """One patch, with the motion that the position gives it."""
    for _ in range(TRIALS):
        case, state = random_position(random)
        try:
            found = list(patches_of(load_scene(case), iter([(f"position {index}", state)])))
        except ValueError:
            continue
        if found:
            batch = found[int(random.integers(len(found)))]
            return replace(
                batch,
                normal_force=batch.normal_force[:1],
                creepage=batch.creepage[:1],
                spin=batch.spin[:1],
            )
    raise ValueError(f"no contact in {TRIALS} trials")
