"""Shear of one element with a plastic layer against its piecewise-linear law.

Report DOT/FRA/ORD-24/18 (Vollebregt 2024), section 4.4.3: one steel element of 1 mm^2 under 900 N,
and four materials measured by Hou, Kalousek and Magel 1997 (table 2). Elastic bodies and layer
together have the slope tau_c0/u_c0 (eq. 50); beyond yield the slope is k_u.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest
import railpatch
from patch_cases import Line, check

# m, Pa, Pa/m
MATERIALS = {
    "magnetite": (0.070e-3, 560e6, 0.0),
    "clay": (0.040e-3, 200e6, 400e9),
    "sand": (0.050e-3, 400e6, -200e9),
    "molybdenum disulfide": (0.020e-3, 20e6, 20e9),
}
SHEAR_MODULI = {"magnetite": 176.63e6, "clay": 106.25e6, "sand": 176.63e6}  # Pa, report
THICKNESS, AREA = 20e-6, 1e-6
STEP = 0.05e-3
PATHS = {
    "loading": [STEP] * 17,
    "unloading": [STEP] * 4 + [-0.2 * STEP] * 3 + [STEP] * 4,
    "reversal": [STEP] * 5 + [-STEP] * 10 + [STEP] * 12,
}


def case(layer: dict | None) -> dict:
    gap = [[1.0, 1.0, 1.0], [1.0, 0.0, 1.0], [1.0, 1.0, 1.0]]
    return {
        "kind": "patch",
        "material": {"shear_modulus": 82e9, "poisson_ratio": 0.28},
        "geometry": {"undeformed_distance": gap},
        "load": {"normal_force": 900.0},
        "grid": {"element_size": [1e-3, 1e-3]},
        "motion": {"regime": "shift", "creepage": [0.0, 0.0]},
        "friction": {"coefficient": 10.0},
        "method": {"tolerance": 1e-10},
        **({"layer": layer} if layer else {}),
    }


def bodies() -> float:
    """m/Pa, flexibility of the bodies at one element: u_x from p_x at its own centre.

    Kalker 1990, appendix C, on a square of side d: (2 - nu)/(pi G) 2 d asinh(1)."""
    return (2 - 0.28) / (np.pi * 82e9) * 2 * 1e-3 * np.arcsinh(1.0)


@dataclass
class Spring:
    """A spring of slope S in series with a plastic slider of strength tau_c(u*)."""

    slope: float
    strength: float
    hardening: float
    rule: str
    elastic: float = 0.0
    path: float = 0.0
    plastic: float = 0.0

    def limit(self, plastic: float, path: float) -> float:
        u = path if self.rule == "path" else abs(plastic)
        return max(self.strength + self.hardening * u, 0.1 * self.strength)

    def move(self, step: float) -> float:
        """Stress after a step, by bisection for the plastic part."""
        tried = self.elastic + step
        sign = np.sign(tried)

        def excess(part: float) -> float:
            limit = self.limit(self.plastic + sign * part, self.path + part)
            return self.slope * (abs(tried) - part) - limit

        low, high = 0.0, abs(tried)
        if excess(0.0) <= 0:
            high = 0.0
        for _ in range(200):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if excess(middle) > 0 else (low, middle)
        self.elastic = tried - sign * high
        self.plastic += sign * high
        self.path += high
        return self.slope * self.elastic


def layer_of(name: str, rule: str) -> tuple[dict, Spring]:
    at_yield, strength, beyond = MATERIALS[name]
    slope = strength / at_yield
    hardening = slope * beyond / (slope - beyond)
    layer = {
        "shear_modulus": THICKNESS / (at_yield / strength - bodies()),
        "thickness": THICKNESS,
        "yield_stress": strength,
        "hardening": hardening,
        "plastic_rule": rule,
    }
    return layer, Spring(slope, strength, hardening, rule)


def test_elastic_element_is_that_of_the_report() -> None:
    result = railpatch.Contact(case(None)).step(creepage=[-1e-6, 0.0])
    lines = [Line("force at 0.001 mm (N)", result["creep_force"][0], 84.97, 0.005)]
    lines.append(Line("the same, closed form", 1e-6 / bodies() * AREA, 84.97, 0.005))
    for name, modulus in SHEAR_MODULI.items():
        found = layer_of(name, "path")[0]["shear_modulus"]
        lines.append(Line(f"G3 of {name} (Pa)", found, modulus, 5e3))
    check(lines)


@pytest.mark.parametrize("axis", [0, 1])
@pytest.mark.parametrize("rule", ["path", "magnitude"])
@pytest.mark.parametrize("path", PATHS)
@pytest.mark.parametrize("name", MATERIALS)
def test_element_follows_its_law(name: str, path: str, rule: str, axis: int) -> None:
    layer, spring = layer_of(name, rule)
    contact = railpatch.Contact(case(layer))
    lines, last = [], 0.0
    for step in PATHS[path]:
        result = contact.step(creepage=[-step * (axis == 0), -step * (axis == 1)], fields=True)
        assert result.status == "converged"
        wanted = spring.move(step)
        stress = result["creep_force"][axis] / AREA
        lines.append(Line(f"{name} {path}", stress, wanted, 1e-6 * spring.strength))
        found = result["plastic_displacement"][axis, 1, 1]
        lines.append(Line("  plastic displacement (m)", found, spring.plastic, 1e-6 * STEP))
        star = spring.path if rule == "path" else abs(spring.plastic)
        lines.append(Line("  u*", result["plastic_path"][1, 1], star, 1e-6 * STEP))
        assert result["plastic_power"] >= 0
        # no slip; where stress turns round in a step its mean, and so its work, is next to none
        turned = stress * last < 0
        assert result["friction_power"] == 0 or turned
        assert abs(result["friction_power"]) <= abs(result["creep_power"])
        last = stress
    check(lines)


def test_table_of_hardening() -> None:
    """Any table: rising, level, falling; the last stress holds beyond."""
    table = [[0.0, 2e8], [5e-5, 3e8], [1e-4, 3e8], [2e-4, 1e8]]
    layer = {"shear_modulus": 1.0625e8, "thickness": THICKNESS, "hardening_table": table}
    slope = 1 / (bodies() + THICKNESS / 1.0625e8)
    contact = railpatch.Contact(case(layer))
    total = 0.0
    for _ in range(14):
        total += STEP / 2
        result = contact.step(creepage=[-STEP / 2, 0.0], fields=True)
        assert result.status == "converged"
        stress, u = result["creep_force"][0] / AREA, result["plastic_path"][1, 1]
        limit = np.interp(u, *np.array(table).T)
        assert stress == pytest.approx(slope * (total - u), rel=1e-9)
        assert stress <= limit * (1 + 1e-9)
        assert u == 0 or stress == pytest.approx(limit, rel=1e-9)
    assert u > 2e-4


def test_slip_where_friction_is_below_yield() -> None:
    """Both bounds met: plastic up to g, slip beyond (state S*), work of each apart."""
    layer, spring = layer_of("clay", "path")
    slippery = case(layer)
    slippery["friction"] = {"coefficient": 300e6 * AREA / 900.0}
    contact = railpatch.Contact(slippery)
    for _ in range(12):
        result = contact.step(creepage=[-STEP, 0.0], fields=True)
    check(
        [
            Line("stress is g", result["creep_force"][0] / AREA, 300e6, 1.0),
            Line("tau_c is g", result["yield_stress"][1, 1], 300e6, 1.0),
            Line("u* (m)", result["plastic_path"][1, 1], 100e6 / spring.hardening, 1e-12),
            Line(
                "friction work of a step (J)", result["friction_power"], 300e6 * AREA * STEP, 1e-9
            ),
            Line("plastic work (J)", result["plastic_power"], 0.0, 1e-12),
        ]
    )
    assert result["elements"]["slip"] == 1
