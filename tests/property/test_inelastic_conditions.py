"""Contact conditions with plastic layers and slip-velocity laws, checked again in numpy.

|p| <= min(g, tau_c); slip opposite to traction and only where |p| = g; plastic displacement along
traction and only where tau_c was met; rigid slip, elastic displacement by code of its own
(railpatch/evidence/stress/half_space.py), slip and plastic displacement add up;
friction coefficient and yield stress from recurrences along the rows (report DOT/FRA/ORD-24/18,
eqs. 39 to 49). Powers are not negative.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import railpatch
from railpatch.evidence.stress.half_space import Array, HalfSpace

SHEAR_MODULUS, POISSON = 82e9, 0.28
TOLERANCE = 1e-6
IMPOSED = 20 * TOLERANCE
STICK, SLIP, PLASTIC = 1, 2, 3


def random_case(seed: int) -> dict[str, Any]:
    rng = np.random.default_rng([20261121, seed])
    a = 10 ** rng.uniform(-3, -2)
    b = a / 10 ** rng.uniform(-0.4, 0.4)
    force = 10 ** rng.uniform(3.5, 5.0) * (a * b / 4e-5)
    friction = rng.uniform(0.1, 0.5)
    peak = 1.5 * force / (np.pi * a * b)
    size = 10 ** rng.uniform(-1, 1) * friction * force / (4 * SHEAR_MODULUS * a * b)
    angle = rng.uniform(0, 2 * np.pi)
    speed = float(10 ** rng.uniform(-1, 2))
    case: dict[str, Any] = {
        "kind": "patch",
        "material": {"shear_modulus": SHEAR_MODULUS, "poisson_ratio": POISSON},
        "geometry": {"semi_axes": [a, b]},
        "load": {"normal_force": force},
        "grid": {"elements": [int(rng.integers(8, 22)), int(rng.integers(8, 22))]},
        "motion": {
            "creepage": [size * np.cos(angle), size * np.sin(angle)],
            "spin_creepage": float(rng.choice([0.0, 1.0]) * rng.normal() * size / np.sqrt(a * b)),
            "direction": int(rng.choice([-1, 1])),
            "rolling_speed": speed,
        },
        "friction": {"coefficient": friction},
        "method": {"tolerance": TOLERANCE, "normal": "hertz"},
    }
    kind = seed % 3
    if kind != 0:
        # falls by half over a tenth of the creepage to ten times it
        case["friction"] = {
            "law": "slip_velocity",
            "kinetic": 0.5 * friction,
            "amplitude": 0.5 * friction,
            "halving_speed": float(10 ** rng.uniform(0.5, 2.0) * size * speed),
            "memory_distance": float(rng.choice([0.0, 0.1 * a])),
        }
        if case["friction"]["memory_distance"] > 0:
            case["friction"]["memory_speed"] = 0.1 * size * speed
    if kind != 1:
        elastic = SHEAR_MODULUS / a
        case["layer"] = {
            "thickness": float(rng.choice([0.0, 1e-5])),
            "shear_modulus": 8.2e9,
            "yield_stress": friction * peak * 10 ** rng.uniform(-1, 0.2),
            "hardening": float(elastic * rng.choice([-0.2, 0.0, 0.3, 10.0])),
            "plastic_rule": str(rng.choice(["path", "magnitude"])),
        }
    return case


def laws(case: dict[str, Any]):
    law, layer = case["friction"], case.get("layer", {})

    def mu(speed: float) -> float:
        if "coefficient" in law:
            return law["coefficient"]
        return law["kinetic"] + law["amplitude"] * 2 ** (-speed / law["halving_speed"])

    def tau(u: float) -> float:
        first = layer.get("yield_stress", np.inf)
        return max(first + layer.get("hardening", 0.0) * u, 0.1 * first)

    return mu, tau


@pytest.mark.parametrize("seed", range(30))
def test_steady_rolling(seed: int) -> None:
    case = random_case(seed)
    result = railpatch.solve(case, fields=True)
    assert result.status == "converged", case
    motion, layer = case["motion"], case.get("layer", {})
    direction, speed = motion["direction"], motion["rolling_speed"]
    x, y = result["x"], result["y"]
    mask = result["pressure"] > 0
    dx = x[1] - x[0]
    p, s, pressure = result["traction"], result["micro_slip"], result["pressure"]
    plastic = result.data.get("plastic_displacement", np.zeros_like(p))
    mu, tau = laws(case)
    # rows in the direction in which material moves: from the leading edge on
    increments = plastic_increments(plastic, mask, direction)
    scale = IMPOSED * pressure.max() * mu(0.0)
    flexibility = 0.0
    if layer.get("thickness", 0.0) > 0:
        flexibility = layer["thickness"] / layer["shear_modulus"]
    body = HalfSpace(mask.shape, dx, y[1] - y[0], SHEAR_MODULUS, POISSON, layer=flexibility)
    before = body.tangential(p, direction * dx)[:, mask]
    now = body.tangential(p)[:, mask]
    rows, columns = np.nonzero(mask)
    w = np.array(
        [
            motion["creepage"][0] - motion["spin_creepage"] * y[rows],
            motion["creepage"][1] + motion["spin_creepage"] * x[columns],
        ]
    )
    supply = -(p[:, mask] * w).sum() * dx * (y[1] - y[0]) * speed
    if not flexibility > 0:
        # without an elastic layer the spin is read a quarter of an element upstream
        w[1] += motion["spin_creepage"] * 0.25 * direction * dx
    total = w + (now - before) / dx + increments[:, mask] / dx
    # the solver's residual is |F| over all elements, in units of traction
    left = (total - s[:, mask]) * dx / body.flexibility(dx)
    assert np.sqrt((left**2).sum()) <= max(scale * np.sqrt(mask.sum()), IMPOSED * np.linalg.norm(p))
    check_states(case, result, increments, mask, mu, tau)
    assert result["friction_power"] >= 0
    if layer:
        assert result["plastic_power"] >= 0
    spent = result["friction_power"] + (result["plastic_power"] if layer else 0.0)
    assert spent == pytest.approx(supply, rel=1e-6)


def plastic_increments(plastic: Array, mask, direction: int) -> Array:
    """Plastic displacement of each element's own step, from that of the material."""
    increments = np.zeros_like(plastic)
    order = slice(None, None, -1) if direction > 0 else slice(None)
    for j in range(mask.shape[0]):
        at = np.nonzero(mask[j])[0][order]
        previous = np.zeros(2)
        for i in at:
            increments[:, j, i] = plastic[:, j, i] - previous
            previous = plastic[:, j, i]
    return increments


def check_states(case, result, increments: Array, mask, mu, tau) -> None:
    motion, law, layer = case["motion"], case["friction"], case.get("layer", {})
    direction, speed = motion["direction"], motion["rolling_speed"]
    dx = result["x"][1] - result["x"][0]
    p, s, pressure = result["traction"], result["micro_slip"], result["pressure"]
    division = result["element_division"]
    order = slice(None, None, -1) if direction > 0 else slice(None)
    distance, least = law.get("memory_distance", 0.0), law.get("memory_speed", 1e-3)
    for j in range(mask.shape[0]):
        coefficient, path, vector = mu(0.0), 0.0, np.zeros(2)
        for i in np.nonzero(mask[j])[0][order]:
            traction, slip, step = p[:, j, i], s[:, j, i], increments[:, j, i]
            size, rate = np.hypot(*traction), np.hypot(*slip) * speed
            way = max(rate, least) * dx / speed
            fresh = mu(rate)
            coefficient = (
                (distance * coefficient + way * fresh) / (distance + way) if distance > 0 else fresh
            )
            path += np.hypot(*step)
            vector = vector + step
            star = path if layer.get("plastic_rule") == "path" else np.hypot(*vector)
            bound, strength = coefficient * pressure[j, i], tau(star)
            assert size <= min(bound, strength if layer else np.inf) * (1 + 1e-9) + 1e-9 * strong(
                bound
            )
            assert result["friction"][j, i] == pytest.approx(coefficient, rel=1e-9)
            if layer:
                assert result["yield_stress"][j, i] == pytest.approx(strength, rel=1e-8)
                assert result["plastic_path"][j, i] == pytest.approx(star, rel=1e-8, abs=1e-18)
            if np.hypot(*slip) > 0:
                assert size == pytest.approx(bound, rel=1e-9)
                assert traction @ slip == pytest.approx(-size * np.hypot(*slip), rel=1e-9)
                assert division[j, i] in (SLIP, PLASTIC)
            if np.hypot(*step) > 1e-9 * (1e-12 + path):
                # with slip as well the yield stress has come up to friction at rest
                met = mu(0.0) * pressure[j, i] if distance == 0 else strength
                full = strength if np.all(slip == 0) else min(met, strength)
                assert full == pytest.approx(strength, rel=1e-7)
                assert np.any(slip != 0) or size == pytest.approx(strength, rel=1e-7)
                assert traction @ step == pytest.approx(size * np.hypot(*step), rel=1e-6)
                assert division[j, i] == PLASTIC
            if division[j, i] == STICK:
                assert np.all(slip == 0)


def strong(bound: float) -> float:
    """A bound's own size in rounding."""
    return max(bound, 1.0)
