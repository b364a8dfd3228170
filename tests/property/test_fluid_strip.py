"""Liquid by strips in the full theory: the laws of friction with the bound of the asperities alone,
checked from the fields; energy; heat; what goes over to dry."""

from __future__ import annotations

import random
from typing import Any

import numpy as np
import pytest
import railpatch
from case_samples import WHEELSET, with_values

BASE: dict[str, Any] = {
    "kind": "patch",
    "geometry": {"semi_axes": [6e-3, 5e-3]},
    "load": {"normal_force": 8e4},
    "grid": {"elements": [20, 20]},
    "motion": {"creepage": [1.5e-3, 5e-4], "spin_creepage": 0.2, "rolling_speed": 20.0},
    "friction": {"coefficient": 0.4},
    "fluid": {
        "model": "strip",
        "roughness": 5e-7,
        "boundary_friction": 0.15,
        "liquid": "water",
        "temperature": 20.0,
    },
    "method": {"tolerance": 1e-8},
}
WARM = {"wheel": 20.0, "rail": 20.0}


def solved(case: dict[str, Any], **changes: Any) -> railpatch.Result:
    result = railpatch.Contact(case).step(fields=True, **changes)
    assert result.status == "converged", result.reason
    return result


def random_cases() -> list[dict[str, Any]]:
    draw = random.Random(21)
    cases = []
    for _ in range(12):
        fluid = {**BASE["fluid"], "roughness": 10 ** draw.uniform(-6.7, -5.7)}
        motion = {
            "creepage": [draw.uniform(-4e-3, 4e-3), draw.uniform(-4e-3, 4e-3)],
            "spin_creepage": draw.uniform(-1, 1),
            "rolling_speed": 10 ** draw.uniform(-1, 2),
            "direction": draw.choice([1, -1]),
        }
        geometry = {"semi_axes": [draw.uniform(2e-3, 9e-3), draw.uniform(2e-3, 9e-3)]}
        cases.append({**BASE, "fluid": fluid, "motion": motion, "geometry": geometry})
    return cases


@pytest.mark.parametrize("case", random_cases())
def test_laws_of_friction(case: dict[str, Any]) -> None:
    """|p| <= mu_b (p_n - p_f); where it slips equality, and slip opposite to the traction."""
    r = solved(case)
    pressure, fluid = np.array(r["pressure"]), np.array(r["fluid_pressure"])
    assert (fluid >= 0).all()
    assert (fluid <= pressure).all()
    bound = 0.15 * (pressure - fluid)
    traction, slip = np.array(r["traction"]), np.array(r["micro_slip"])
    size, speed = np.hypot(*traction), np.hypot(*slip)
    unit = bound.max()
    assert (size - bound).max() < 1e-6 * unit
    slips = np.array(r["element_division"]) == 2
    assert np.abs(size - bound)[slips].max(initial=0) < 1e-6 * unit
    across = traction[0] * slip[1] - traction[1] * slip[0]
    along = (traction * slip).sum(axis=0)
    assert np.abs(across)[slips].max(initial=0) < 1e-5 * unit * speed.max(initial=1e-12)
    assert along[slips].max(initial=-1.0) <= 0
    sticks = np.array(r["element_division"]) == 1
    scale = np.hypot(*case["motion"]["creepage"]) + abs(case["motion"]["spin_creepage"]) * 5e-3
    assert speed[sticks].max(initial=0) < 1e-5 * scale
    assert r["mean_asperity_share"] == pytest.approx(1 - fluid.sum() / pressure.sum(), abs=1e-12)
    share = np.array(r["asperity_share"])
    inside = pressure > 0
    assert share[inside] == pytest.approx((1 - fluid[inside] / pressure[inside]), abs=1e-12)
    forces = np.hypot(*r["creep_force"])
    borne = bound.sum() / pressure.sum() * r["normal_force"]
    assert r["utilised_friction"] == pytest.approx(forces / borne, rel=1e-6)
    # what creepages and spin supply is what friction takes
    assert r["friction_power"] == pytest.approx(r["creep_power"], rel=1e-6)


def test_liquid_is_ahead_of_the_middle() -> None:
    """Pressure builds up in the inlet, at +x where it rolls towards +x, and cavitates behind."""
    for direction in (1, -1):
        motion = {**BASE["motion"], "direction": direction}
        r = solved({**BASE, "motion": motion})
        fluid, x = np.array(r["fluid_pressure"]), np.array(r["x"])
        assert direction * (fluid.sum(axis=0) * x).sum() > 0
        last = fluid[:, 0 if direction > 0 else -1]
        assert (last == 0).all()


@pytest.mark.parametrize("tangential", ["full", "fastsim", "fastrip", "polach", "table"])
@pytest.mark.parametrize("normal", ["hertz", "half_space", "kik_piotrowski"])
def test_every_theory_slides_at_the_same_friction(normal: str, tangential: str) -> None:
    method = {"normal": normal, "tangential": tangential}
    motion = {"creepage": [0.05, 0.0], "rolling_speed": 20.0}
    r = railpatch.Contact({**BASE, "method": method, "motion": motion}).step()
    force = -r["creep_force"][0] / r["normal_force"]
    assert force == pytest.approx(r["effective_friction"], rel=0.01)
    assert r["mean_asperity_share"] == pytest.approx(0.648, abs=0.03)


def test_slow_and_cold_is_dry() -> None:
    of = railpatch.Contact(BASE)
    dry = {name: value for name, value in BASE.items() if name != "fluid"}
    plain = railpatch.Contact({**dry, "friction": {"coefficient": 0.15}})
    for speed in (1e-4, 1e-5):
        r, other = of.step(rolling_speed=speed), plain.step(rolling_speed=speed)
        assert r["mean_asperity_share"] == pytest.approx(1, abs=0.05 * speed)
        assert r["creep_force"] == pytest.approx(other["creep_force"], rel=1e-4)


def test_the_liquid_is_as_warm_as_the_surfaces() -> None:
    fluid = {name: value for name, value in BASE["fluid"].items() if name != "temperature"}
    case = {**BASE, "fluid": fluid, "temperature": WARM}
    case = {**case, "motion": {"creepage": [0.03, 0.0], "rolling_speed": 20.0}}
    r = solved(case)
    pressure, surfaces = np.array(r["pressure"]), np.array(r["temperature"])
    mean = (pressure * surfaces.mean(axis=0)).sum() / pressure.sum()
    assert r["fluid_temperature"] == pytest.approx(mean, abs=1e-4)
    assert mean > 40
    cold = railpatch.Contact({**case, "fluid": BASE["fluid"]}).step()
    assert cold["fluid_temperature"] == 20.0
    assert r["effective_friction"] > cold["effective_friction"] + 0.01
    # the same again with that temperature given
    given = {**fluid, "temperature": r["fluid_temperature"]}
    again = railpatch.Contact({**case, "fluid": given}).step()
    assert again["effective_friction"] == pytest.approx(r["effective_friction"], rel=1e-6)
    assert r["wheel_heat"] + r["rail_heat"] == pytest.approx(r["friction_power"], rel=1e-6)


def test_friction_by_temperature_on_the_asperities() -> None:
    """g = mu(T) p_a, of each element."""
    law = {
        "law": "temperature",
        "reference": 0.3,
        "change": -0.2,
        "reference_temperature": 20.0,
        "temperature_range": 300.0,
    }
    fluid = {"model": "strip", "roughness": 5e-7, "liquid": "water"}
    motion = {"creepage": [0.05, 0.0], "rolling_speed": 20.0}
    case = {**BASE, "friction": law, "fluid": fluid, "motion": motion, "temperature": WARM}
    r = solved(case)
    hottest = np.array(r["temperature"]).max(axis=0)
    mu = 0.3 - 0.2 * np.clip((hottest - 20) / 300, 0, 1)
    bound = mu * (np.array(r["pressure"]) - np.array(r["fluid_pressure"]))
    slips = np.array(r["element_division"]) == 2
    size = np.hypot(*np.array(r["traction"]))
    assert np.abs(size - bound)[slips].max() < 1e-4 * bound.max()
    area = (r["x"][1] - r["x"][0]) * (r["y"][1] - r["y"][0])
    assert r["effective_friction"] == pytest.approx(bound.sum() * area / 8e4, rel=1e-4)


def test_wheels() -> None:
    fluid = {**BASE["fluid"], "roughness": 1e-6}
    load = {"wheelset__z": None, "wheelset__vertical_force": 1.5e5}
    case = with_values(
        WHEELSET, fluid=fluid, **load, wheelset__speed=20.0, wheelset__pitch_rate=-43.6
    )
    patch = railpatch.Contact(case).step(fields=True)["right"]["patches"][0]
    assert 0.2 < patch["mean_asperity_share"] < 1
    bound = 0.15 * (np.array(patch["pressure"]) - np.array(patch["fluid_pressure"]))
    assert (np.hypot(*np.array(patch["traction"])) - bound).max() < 1e-4 * bound.max()
