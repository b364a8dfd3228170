"""Friction that falls with the speed of slip: one element, where all is known in closed form.

One loaded element in steady rolling: s = xi + B p with the number B, |p| = mu(|s| V) p_n in slip.
A law that falls faster than 1/B has up to three solutions for a creepage, stick, slip, and one
between that is unstable: history decides (physics of stick-slip; Rabinowicz 1958).
"""

from __future__ import annotations

import numpy as np
import pytest
import railpatch
from patch_cases import Line, check
from scipy.optimize import brentq

FORCE, AREA, SPEED = 900.0, 1e-6, 10.0
PRESSURE = FORCE / AREA
KINETIC, AMPLITUDE, HALVING = 0.1, 0.4, 0.01


def case(**friction) -> dict:
    gap = [[1.0, 1.0, 1.0], [1.0, 0.0, 1.0], [1.0, 1.0, 1.0]]
    law = {"kinetic": KINETIC, "amplitude": AMPLITUDE, "halving_speed": HALVING}
    return {
        "kind": "patch",
        "geometry": {"undeformed_distance": gap},
        "load": {"normal_force": FORCE},
        "grid": {"element_size": [1e-3, 1e-3]},
        "motion": {"creepage": [0.0, 0.0], "rolling_speed": SPEED},
        "friction": {"law": "slip_velocity", **law, **friction},
        "method": {"tolerance": 1e-10},
    }


@pytest.fixture(scope="module")
def flexibility() -> float:
    """1/Pa, B: from a creepage so small that the element sticks."""
    creepage = 1e-6
    result = railpatch.Contact(case()).step(creepage=[-creepage, 0.0])
    return creepage / (result["creep_force"][0] / AREA)


def mu(speed: float) -> float:
    return KINETIC + AMPLITUDE * 2 ** (-speed / HALVING)


def solutions(creepage: float, b: float) -> list[float]:
    """Coefficients of traction: stick, and the roots of |p| = mu p_n on a fine mesh."""
    stick = creepage / (b * PRESSURE)
    found = [stick] if stick <= mu(0.0) else []

    def excess(slip: float) -> float:
        return (creepage - slip) / b - mu(slip * SPEED) * PRESSURE

    mesh = np.linspace(0.0, creepage, 4001)
    values = [excess(slip) for slip in mesh]
    for low, high, first, last in zip(mesh, mesh[1:], values, values[1:], strict=False):
        if first * last < 0:
            found.append(mu(brentq(excess, low, high, xtol=1e-16) * SPEED))
    return found


def test_two_solutions_followed_by_history(flexibility: float) -> None:
    saturation = flexibility * mu(0.0) * PRESSURE
    creepages = np.linspace(0.05, 1.5, 60) * saturation
    contact = railpatch.Contact(case())
    branches: dict[str, list[float]] = {}
    lines, several = [], 0
    for name, order in (("up", creepages), ("down", creepages[::-1])):
        found = []
        for creepage in order:
            result = contact.step(creepage=[-creepage, 0.0])
            assert result.status == "converged"
            possible = solutions(creepage, flexibility)
            # the greatest is stick or the only one, the smallest the lowest in slip
            wanted = max(possible) if name == "up" else min(possible)
            traction = result["creep_force"][0] / FORCE
            lines.append(Line(f"{name} {creepage / saturation:.3f}", traction, wanted, 1e-6))
            assert (result["ambiguous_elements"] == 1) == (len(possible) > 1)
            several += len(possible) > 1
            found.append(traction)
        branches[name] = found
    check(lines)
    assert several > 6
    gap = np.abs(np.array(branches["up"]) - np.array(branches["down"])[::-1])
    assert gap.max() > 0.2


def test_gentle_law_has_one_solution(flexibility: float) -> None:
    contact = railpatch.Contact(case(halving_speed=1.0))
    for share in (0.2, 0.9, 1.05, 1.5):
        creepage = share * flexibility * mu(0.0) * PRESSURE
        result = contact.step(creepage=[-creepage, 0.0])
        assert result.status == "converged"
        assert result["ambiguous_elements"] == 0


def full_sliding(law: dict, slip: float, **method) -> float:
    """Coefficient of traction of a patch that slides as a whole with nearly the same slip."""
    sliding = {
        "kind": "patch",
        "geometry": {"semi_axes": [1e-3, 1e-3]},
        "load": {"normal_force": 1000.0},
        "grid": {"elements": [12, 12]},
        "motion": {"creepage": [-slip, 0.0], "rolling_speed": SPEED},
        "friction": {"law": "slip_velocity", **law},
        "method": {"normal": "hertz", "tolerance": 1e-8},
    }
    result = railpatch.solve(sliding)
    assert result.status == "converged"
    assert result["elements"]["stick"] == 0
    return result["creep_force"][0] / 1000.0


def test_laws_at_full_sliding() -> None:
    """Slip of 0.3 at 10 m/s: 3 m/s; elastic slip of some 1e-3 adds per thousands."""
    rate, speed = 0.3, 3.0
    shape = {"kinetic": 0.1, "amplitude": 0.3, "halving_speed": 2.0}
    cases = [
        ({**shape}, 0.1 + 0.3 * 2**-1.5),
        ({**shape, "shape": "rational"}, 0.1 + 0.3 / 2.5),
        ({**shape, "shape": "linear"}, 0.1 + 0.3 * 0.25),
        (
            {"shape": "polach", "coefficient": 0.55, "polach_a": 0.4, "polach_b": 0.6},
            0.55 * (0.6 * np.exp(-0.6 * speed) + 0.4),
        ),
        (
            {"kinetic": 0.2, "amplitude": [0.1, 0.05], "halving_speed": [1.0, 3.0]},
            0.2 + 0.1 / 8 + 0.025,
        ),
    ]
    check(
        [
            Line(law.get("shape", "exponential"), full_sliding(law, rate), value, 0.003 * value)
            for law, value in cases
        ]
    )
