"""Errors of creep forces of a measured-like wheel on its rail by fast theories: docs/profiles.md.

    python docs/table_on_wheels.py [STATES]

Random positions, loads and rolling motions of a right wheel, on new and on worn profiles; each
against the full theory on 20 x 20 fitted nodes with the pressure of 40 x 40 elements. Errors of the
creep force of each patch over friction coefficient times normal force, in per cent.
"""

from __future__ import annotations

import sys
from typing import Any

import numpy as np
from railpatch import Contact

RADIUS, FRICTION = 0.46, 0.3
PAIRS = (("S1002", "UIC60@1:40"), ("worn@0", "worn@1"), ("worn@14", "worn@15"))
THEORIES = ("table", "fastsim", "fastrip", "polach")
COARSE = {"elements": [16, 16]}
SPEED, LOADS = 20.0, (1e4, 1.5e5)  # m/s, N
SEED = 20261123
LEVELS = (0.5, 0.9, 0.95, 0.99)


def contact_of(
    pair: tuple[str, str], method: dict[str, Any], grid: dict[str, Any], **height: float
) -> Contact:
    """A wheel at a height z (m), or under a vertical_force (N)."""
    wheel, rail = pair
    return Contact(
        {
            "kind": "wheel_rail",
            "wheel": {"side": "right"},
            "wheelset": {
                "nominal_radius": RADIUS,
                "flange_back_distance": 1.36,
                "flange_back_position": -0.07,
                **height,
            },
            "track": {"kind": "rail", "gauge": 1.435, "gauge_height": 0.014},
            "profiles": {"wheel": wheel, "rail": rail},
            "friction": {"coefficient": FRICTION},
            "method": method,
            "grid": grid,
        }
    )


def random_motion(random: np.random.Generator, yaw: float, radius: float) -> dict[str, float]:
    """Creepages beside free rolling, from a hundredth of what makes all slide to some times it."""
    longitudinal, lateral = random.choice([-1, 1], 2) * 10.0 ** random.uniform(-4.5, -2.2, 2)
    return {
        "speed": SPEED,
        "pitch_rate": -SPEED / radius * (1 + longitudinal),
        "vy": SPEED * (lateral + yaw),
    }


def random_place(random: np.random.Generator) -> dict[str, float]:
    """From the tread to the flange, rolled and yawed as in a curve."""
    return {
        "y": random.uniform(-6e-3, 7.5e-3),
        "yaw": random.uniform(-0.03, 0.03),
        "roll": random.uniform(-3e-3, 3e-3),
    }


def errors(pair: tuple[str, str], states: int) -> dict[str, np.ndarray]:
    """By theory, of each patch; infinite where a theory is out of its range."""
    random = np.random.default_rng(SEED)
    accurate = {"tangential": "full", "tolerance": 1e-5, "max_iterations": 500}
    exact = contact_of(pair, accurate, {"elements": [40, 40], "fitted": [20, 20]}, z=0.0)
    rest = contact_of(pair, {"tangential": "polach"}, COARSE, vertical_force=8e4)
    fast = {name: contact_of(pair, {"tangential": name}, COARSE, z=0.0) for name in THEORIES}
    found: dict[str, list[float]] = {name: [] for name in THEORIES}
    while len(found[THEORIES[0]]) < states:
        place = random_place(random)
        load = float(np.exp(random.uniform(*np.log(LOADS))))
        still = rest.step(**place, vertical_force=load)
        if not still.solved:
            continue
        place["z"] = still["z"]
        motion = random_motion(random, place["yaw"], still["rolling_radius"])
        truth = exact.step(**place, **motion)
        if not truth.solved:
            continue
        for name, contact in fast.items():
            result = contact.step(**place, **motion)
            for patch, accurate_patch in zip(result["patches"], truth["patches"], strict=False):
                solved = patch["status"] == "converged"
                missing = utilised(patch) - utilised(accurate_patch)
                found[name].append(float(np.hypot(*missing)) if solved else np.inf)
    return {name: np.array(values) for name, values in found.items()}


def utilised(patch: Any) -> np.ndarray:
    """Creep force over friction coefficient times normal force."""
    return np.array(patch["creep_force"]) / (FRICTION * patch["normal_force"])


def main() -> None:
    states = int(sys.argv[1]) if len(sys.argv) > 1 else 2000
    print(
        "| profiles | theory | median | 90 % | 95 % | 99 % | out of range |\n|---|---|" + 5 * "---|"
    )
    for pair in PAIRS:
        for name, error in errors(pair, states).items():
            levels = np.quantile(error[np.isfinite(error)], LEVELS)
            cells = " | ".join(f"{100 * level:.2f}" for level in levels)
            out = 100 * np.mean(np.isinf(error))
            print(f"| {pair[0]}, {pair[1]} | {name} | {cells} | {out:.1f} % |", flush=True)


if __name__ == "__main__":
    main()
