"""Tractive rolling of unlike cylinders without a tangential force.

Pressure stretches the surfaces of wheel and rail differently, so free rolling has a creepage.
Bentall and Johnson 1967, Int. J. Mech. Sci. 9, with slip; Bufler 1959, Ing.-Arch. 27, without. The
case: aluminium on steel, two rollers of equal size.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import railpatch
from patch_cases import Line, check, patch_case, solve
from scipy.optimize import brentq

SHEAR_MODULUS, POISSON_RATIO = (23e9, 82e9), (0.31, 0.28)
RADIUS, WIDTH, A = 0.025, 0.01, 1e-4  # m; 1/radius = 1/0.05 + 1/0.05


def combined(shear_modulus=SHEAR_MODULUS, poisson_ratio=POISSON_RATIO) -> tuple[float, float]:
    """G/(1 - nu) in Pa and K/(1 - nu) (Kalker 1990, eq. 1.44)."""
    (gw, gr), (nw, nr) = shear_modulus, poisson_ratio
    flexibility = 0.5 * ((1 - nw) / gw + (1 - nr) / gr)
    return 1 / flexibility, 0.25 * ((1 - 2 * nw) / gw - (1 - 2 * nr) / gr) / flexibility


MODULUS, BETA = combined()
FORCE = np.pi * MODULUS * A**2 / (4 * RADIUS) * WIDTH


def case(elements: int, friction: float, tolerance: float = 1e-7, **motion: Any) -> dict[str, Any]:
    shape = {"line_contact_radius": RADIUS, "width": WIDTH}
    material = {"shear_modulus": list(SHEAR_MODULUS), "poisson_ratio": list(POISSON_RATIO)}
    made = patch_case(
        shape,
        force=FORCE,
        elements=[elements, 1],
        creepage=[0.0, 0.0],
        friction=friction,
        material=material,
        tolerance=tolerance,
    )
    made["motion"] |= {"tangential_force": [0.0, "creepage"]} | motion
    return made


def free_rolling(elements: int, friction: float, **motion: Any) -> railpatch.Result:
    return solve(case(elements, friction, **motion))


def frictionless_creepage() -> float:
    """Tractions too small to matter: slip is xi + 2 K/G p, with Hertz's pressure, and changes its
    sign where the pressure inside carries half of the load."""

    def inner_share(c: float) -> float:
        return 2 / np.pi * (np.arcsin(c) + c * np.sqrt(1 - c**2)) - 0.5

    return -BETA * A / RADIUS * np.sqrt(1 - brentq(inner_share, 0, 1) ** 2)


def adhesive_creepage() -> float:
    """No slip at all: p + i q of exponents 1/2 +- i e at the ends, e = ln((1+b)/(1-b))/(2 pi) with
    b = K/(1-nu), is bounded for xi = -2 e a/R alone; the load makes a^2 (1 + 4 e^2) Hertz's."""
    e = np.log((1 + BETA) / (1 - BETA)) / (2 * np.pi)
    return -2 * e * A / np.sqrt(1 + 4 * e**2) / RADIUS


def test_little_friction() -> None:
    closed = frictionless_creepage()
    assert closed == pytest.approx(-5.263e-4, abs=5e-8)
    lines = []
    for elements in (100, 200):
        found = free_rolling(elements, 1e-4)["creepage"][0]
        lines.append(Line(f"{elements} elements", found, closed, 0.003 * abs(closed)))
    check(lines)


def test_published_figures() -> None:
    """Figures of the program CONTACT; that at 10 is of a grid which does not resolve the ends: see
    the next test."""
    lines = []
    for friction, published in ((0.05, -4.294e-4), (10.0, -3.591e-4)):
        result = free_rolling(200, friction)
        found = result["creepage"][0]
        lines.append(Line(f"friction {friction}", found, published, 0.01 * abs(published)))
        assert abs(result["creep_force"][0]) <= 1e-6 * FORCE * friction
        # with friction of 10 all sticks, and nothing is lost
        assert result["friction_power"] >= 0
        assert (result["friction_power"] > 1e-6) == (friction == 0.05)
    check(lines)


def test_no_slip() -> None:
    """The contact is shorter than Hertz's by 0.4 %, which elements must be fine enough to tell."""
    closed = adhesive_creepage()
    lines = [
        Line(f"{n} elements", free_rolling(n, 10.0)["creepage"][0], closed, 0.01 * abs(closed))
        for n in (500, 1000)
    ]
    check(lines)


def test_direction_and_bodies() -> None:
    forward = free_rolling(100, 0.05)["creepage"][0]
    assert free_rolling(100, 0.05, direction=-1)["creepage"][0] == pytest.approx(-forward, rel=1e-5)
    exchanged = case(100, 0.05)
    for key in ("shear_modulus", "poisson_ratio"):
        exchanged["material"][key] = exchanged["material"][key][::-1]
    assert solve(exchanged)["creepage"][0] == pytest.approx(-forward, rel=1e-5)


def test_like_cylinders_roll_without_creepage() -> None:
    like = case(100, 0.3)
    like["material"] = {"shear_modulus": 82e9, "poisson_ratio": 0.28}
    assert solve(like)["creepage"][0] == pytest.approx(0, abs=1e-15)
