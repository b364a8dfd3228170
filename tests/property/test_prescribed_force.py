"""Random patches with a prescribed creep force: F -> creepage -> F, from any start."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
import railpatch
from patch_cases import patch_case

TOLERANCE = 1e-9


def random_case(seed: int) -> tuple[dict[str, Any], float]:
    """A case, and friction's most (N)."""
    random = np.random.default_rng(seed)
    a = 10 ** random.uniform(-2.8, -1.8)
    load, friction = 10 ** random.uniform(3.5, 5.3), random.uniform(0.1, 0.6)
    layer = {"shear_modulus": 8e9, "thickness": 10 ** random.uniform(-6, -4)}
    case = patch_case(
        {"semi_axes": [a, a * 10 ** random.uniform(-0.7, 0.7)]},
        force=load,
        elements=1,
        creepage=[0.0, 0.0],
        spin=float(random.choice([0.0, random.uniform(-1, 1)])),
        direction=int(random.choice([1, -1])),
        friction=friction,
        layer=layer if random.random() < 0.3 else None,
        normal=str(random.choice(["hertz", "half_space"])),
        tolerance=TOLERANCE,
    )
    count = [int(n) for n in random.integers(8, 17, 2)]
    case["grid"] = {"fitted": count} if seed % 2 else {"elements": count}
    most = friction * load
    share, angle = random.choice([0.0, 0.1, 0.5, 0.9, 0.99]), random.uniform(0, 2 * math.pi)
    force: list[Any] = [share * most * math.cos(angle), share * most * math.sin(angle)]
    given = int(random.integers(0, 4))  # 0, 1: this component's creepage; else both forces
    if given < 2:
        force[given] = "creepage"
        case["motion"]["creepage"][given] = random.uniform(-1e-3, 1e-3)
    case["motion"]["tangential_force"] = force
    return case, most


@pytest.mark.parametrize("seed", range(60))
def test_round_trip_from_any_start(seed: int) -> None:
    case, most = random_case(seed)
    contact = railpatch.Contact(case)
    cold = contact.step()
    wanted = case["motion"]["tangential_force"]
    assert cold.status == "converged", (seed, cold["residual"], case)
    for k in range(2):
        if wanted[k] != "creepage":
            assert abs(cold["creep_force"][k] - wanted[k]) <= 1.01 * TOLERANCE * most, (seed, k)
        else:
            assert cold["creepage"][k] == case["motion"]["creepage"][k], (seed, k)

    # warm, from a state far away
    away = [f if f == "creepage" else -0.3 * f + 0.2 * most for f in wanted]
    assert contact.step(tangential_force=away).status == "converged", seed
    warm = contact.step(tangential_force=wanted)
    assert warm.status == "converged", (seed, warm["residual"])
    # the smallest creepage that counts: a thousandth of what the steel's stiffness resists with
    size = np.linalg.norm(cold["creepage"]) + 1e-3 * most / (
        82e9 * math.prod(case["geometry"]["semi_axes"])
    )
    difference = np.linalg.norm(np.subtract(warm["creepage"], cold["creepage"]))
    assert difference <= 1e-5 * size, (seed, difference / size)

    given = {**case, "motion": {**case["motion"], "creepage": cold["creepage"]}}
    del given["motion"]["tangential_force"]
    again = railpatch.solve(given)
    assert again.status == "converged", seed
    error = np.linalg.norm(np.subtract(again["creep_force"], cold["creep_force"])) / most
    assert error <= 1e-6, (seed, error)
    for key in ("spin_moment", "friction_power"):
        scale = abs(cold[key]) + 1e-3 * most * (1e-3 if key == "spin_moment" else size * 10)
        assert abs(again[key] - cold[key]) <= 1e-5 * scale, (seed, key)
