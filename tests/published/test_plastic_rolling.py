"""Two-dimensional rolling with a plastic layer.

The program CONTACT's values for Carter's case (reference README: R = 500 mm, steel, a = 1 mm,
mu = 0.5, tau_c0 = 35 MPa, no elastic layer, creepage -4e-4, elements of 0.02 mm), and the
behaviours of the report DOT/FRA/ORD-24/18 (Vollebregt 2024), sections 4.4.4 and 4.4.5, for the
case of Meierhofer et al. 2014 in its table 3.
"""

from __future__ import annotations

import numpy as np
import pytest
import railpatch
from patch_cases import Line, check, modulus, solve

# k_tau in N/mm^3, |F_x|/(mu F_n)
CARTER = [(4.018e6, 0.644), (1.23e5, 0.630), (0.0, 0.586), (-2.05e4, 0.543)]
ELEMENT = 2e-5


def carter(hardening: float, **motion) -> dict:
    return {
        "kind": "patch",
        "geometry": {"line_contact_radius": 0.5, "width": 1e-3},
        "load": {"normal_force": 178.90},
        "grid": {"elements": [100, 1]},
        "motion": {"creepage": [-4e-4, 0.0], "rolling_speed": 1.0, **motion},
        "friction": {"coefficient": 0.5},
        "layer": {"thickness": 0.0, "yield_stress": 35e6, "hardening": hardening * 1e9},
        "method": {"tolerance": 1e-7},
    }


def test_force_of_carter_with_plasticity() -> None:
    lines = []
    for hardening, target in CARTER:
        found = solve(carter(hardening))["creep_force"][0] / (0.5 * 178.90)
        lines.append(Line(f"k_tau {hardening:.3g} N/mm^3", found, target, 0.01 * target))
    check(lines)


@pytest.mark.parametrize("rule", ["path", "magnitude"])
@pytest.mark.parametrize("hardening", [pair[0] for pair in CARTER])
def test_transient_settles_on_the_steady_solution(hardening: float, rule: str) -> None:
    """And in one direction alone both rules of accumulation are the same."""
    steady = solve(carter(hardening), fields=True)
    case = carter(hardening, regime="transient_rolling", distance=400 * ELEMENT, steps=400)
    case["layer"]["plastic_rule"] = rule
    settled = solve(case, fields=True)
    force = settled["creep_force"][0] / steady["creep_force"][0]
    check([Line(f"{hardening:.3g} {rule}", force, 1.0, 0.002)])
    # behind the contact only the transient grid still knows of it
    contact = steady["pressure"] > 0
    wanted = steady["plastic_displacement"][:, contact]
    found = settled["plastic_displacement"][:, contact]
    np.testing.assert_allclose(found, wanted, atol=0.002 * np.abs(wanted).max())


# table 3; a from tau_c0 = 0.4 max(mu p_n) at 200 MPa (section 4.4.5): max p_n = 1000 MPa
MEIERHOFER = {"shear_modulus": 77519.4e6, "poisson_ratio": 0.29}
FORCE, FRICTION = 1323.6e3, 0.5  # N/m
A = 2 * FORCE / (np.pi * 1000e6)
RADIUS = np.pi * A**2 * modulus(MEIERHOFER) / (4 * FORCE)
SLOPE = 3121e9 * 3000e9 / (3121e9 - 3000e9)  # Pa/m, of k_tau = S k_u/(S - k_u)


def meierhofer(hardening: float, creepage: float, yield_stress: float = 200e6) -> dict:
    return {
        "kind": "patch",
        "material": dict(MEIERHOFER),
        "geometry": {"line_contact_radius": RADIUS, "width": 1e-3},
        "load": {"normal_force": FORCE * 1e-3},
        "grid": {"elements": [80, 1]},
        "motion": {"creepage": [creepage, 0.0], "rolling_speed": 1.0},
        "friction": {"coefficient": FRICTION},
        "layer": {"thickness": 0.0, "yield_stress": yield_stress, "hardening": hardening},
    }


def hardening_of(relative: float) -> float:
    """Pa/m, k_tau of k_rel = k_u/S."""
    return SLOPE * relative / (1 - relative)


def curve(relative: float, creepages, yield_stress: float = 200e6) -> np.ndarray:
    """Coefficient of traction over creepage, as a sequence of solves from the last one."""
    contact = railpatch.Contact(meierhofer(hardening_of(relative), 0.0, yield_stress))
    found = []
    for creepage in creepages:
        result = contact.step(creepage=[-creepage, 0.0])
        assert result.status == "converged"
        found.append(result["creep_force"][0] / (FORCE * 1e-3))
    return np.array(found)


@pytest.mark.parametrize("creepage", [0.003, 0.01])
def test_traction_is_limited_by_the_hardened_yield_stress(creepage: float) -> None:
    """Figure 40: traction follows mu p_n at the edges and tau_c0 + k_tau u* between them."""
    result = solve(meierhofer(3121e9, -creepage), fields=True)
    traction, pressure = result["traction"][0, 0], result["pressure"][0]
    grown = 200e6 + 3121e9 * result["plastic_path"][0]
    np.testing.assert_allclose(result["yield_stress"][0], grown, rtol=1e-12)
    assert np.all(traction <= np.minimum(FRICTION * pressure, grown) * (1 + 1e-9))
    plastic = result["element_division"][0] == 3
    assert plastic.sum() > 20
    met = np.minimum(FRICTION * pressure, grown)[plastic]
    np.testing.assert_allclose(traction[plastic], met, rtol=1e-9)
    # rolling towards +x, tau_c rises from the leading edge on
    assert np.all(np.diff(grown[1:-1]) <= 1e-3)
    elastic = solve({**meierhofer(3121e9, -creepage), "layer": {"thickness": 0.0}}, fields=True)
    assert elastic["creep_force"][0] > result["creep_force"][0]


CREEPAGES = np.concatenate([np.linspace(1e-3, 1e-2, 10), [0.02, 0.05, 0.2, 1.0]])


@pytest.mark.parametrize("yield_stress", [200e6, 350e6])
def test_level_yield_stress_lowers_the_plateau(yield_stress: float) -> None:
    """k_rel = 0: at large creepage min(mu p_n, tau_c0) over the ellipse, in closed form."""
    found = curve(0.0, CREEPAGES, yield_stress)
    peak = FRICTION * 1000e6
    edge = A * np.sqrt(1 - (yield_stress / peak) ** 2)
    beyond = peak * (A * np.arccos(edge / A) - edge * np.sqrt(1 - (edge / A) ** 2))
    plateau = (2 * yield_stress * edge + beyond) / FORCE
    assert plateau < FRICTION
    assert np.all(np.diff(found) > -1e-6)
    check([Line("plateau", found[-1], plateau, 0.005 * plateau)])


@pytest.mark.parametrize("yield_stress", [200e6, 350e6])
def test_softening_falls_behind_a_maximum(yield_stress: float) -> None:
    level = curve(0.0, CREEPAGES, yield_stress)
    soft = curve(-0.05, CREEPAGES, yield_stress)
    assert np.all(soft <= level + 1e-9)
    assert soft.max() > soft[-1] + 0.02
    assert 0 < soft.argmax() < len(soft) - 1


@pytest.mark.parametrize(("yield_stress", "unaffected"), [(200e6, 0.3), (350e6, 0.1)])
def test_hardening_reaches_coulomb(yield_stress: float, unaffected: float) -> None:
    """Asymptotically mu, the slower the smaller k_rel."""
    curves = [curve(relative, CREEPAGES, yield_stress) for relative in (0.01, 0.04, unaffected)]
    level = curve(0.0, CREEPAGES, yield_stress)
    for found in curves:
        assert np.all(np.diff(found) > -1e-4)
        assert found[-1] == pytest.approx(FRICTION, rel=0.01)
    for slower, faster in zip([level, *curves], curves, strict=False):
        assert np.all(slower <= faster + 1e-6)
    # where the report calls the curve hardly affected, 5 % of creepage are full sliding
    assert curves[-1][CREEPAGES == 0.05][0] == pytest.approx(FRICTION, rel=0.01)
