"""Surface temperature with the elastic problem around it: limits of transient rolling, energy,
plastic work, and friction that follows the temperature, checked from the fields alone."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import railpatch
from patch_cases import solve

EFFUSIVITY = np.sqrt(50.0 * 450.0 * 7850.0)
A = 5e-3


def heated(elements: int = 24, **tables: Any) -> dict[str, Any]:
    case: dict[str, Any] = {
        "kind": "patch",
        "material": {"shear_modulus": 82e9, "poisson_ratio": 0.28},
        "geometry": {"semi_axes": [A, 4e-3]},
        "load": {"normal_force": 5e4},
        "grid": {"elements": [elements, elements]},
        "motion": {"creepage": [-4e-3, 1e-3], "spin_creepage": 0.2, "rolling_speed": 20.0},
        "friction": {"coefficient": 0.3},
        "temperature": {"wheel": 60.0, "rail": 20.0},
        "method": {"normal": "hertz", "tolerance": 1e-7},
    }
    for name, table in tables.items():
        case[name] = {**case.get(name, {}), **table} if name == "motion" else table
    return case


def law(change: float, span: float, start: float = 60.0) -> dict[str, Any]:
    return {
        "law": "temperature",
        "reference": 0.35,
        "change": change,
        "reference_temperature": start,
        "temperature_range": span,
    }


def rise_of(result: railpatch.Result, speed: float, direction: int = 1) -> np.ndarray:
    """K, by the sum over the elements ahead of each, from tractions and micro-slip."""
    x = np.array(result["x"])
    dx = x[1] - x[0]
    flux = speed * np.hypot(*result["traction"]) * np.hypot(*result["micro_slip"])
    ahead = direction * (x[None, :] - x[:, None]) / dx  # of the source, in elements
    near = np.maximum(ahead - 0.5, 0.0)
    weight = np.where(ahead > -0.25, 2 * (np.sqrt(np.maximum(ahead + 0.5, 0)) - np.sqrt(near)), 0.0)
    return np.sqrt(dx / (np.pi * speed)) / (2 * EFFUSIVITY) * flux @ weight.T


@pytest.mark.parametrize("direction", [1, -1])
def test_rise_from_the_fields(direction: int) -> None:
    case = heated(motion={"direction": direction})
    result = solve(case, fields=True)
    touching = np.array(result["pressure"]) > 0
    for surface in np.array(result["temperature"]):
        expected = 40.0 + rise_of(result, 20.0, direction)
        np.testing.assert_allclose(surface[touching], expected[touching], rtol=1e-11)


@pytest.mark.parametrize("direction", [1, -1])
def test_transient_rolling_ends_in_steady_rolling(direction: int) -> None:
    steady = solve(heated(motion={"direction": direction}), fields=True)
    dx = 2 * A / 24
    moving = {
        "regime": "transient_rolling",
        "distance": 80 * dx,
        "steps": 80,
        "direction": direction,
    }
    rolled = solve(heated(motion=moving), fields=True)
    touching = np.array(steady["pressure"]) > 0
    now, end = np.array(rolled["temperature"]), np.array(steady["temperature"])
    greatest = (end - 40.0)[:, touching].max()
    assert np.abs(now - end)[:, touching].max() < 0.002 * greatest
    assert rolled["max_temperature"] == pytest.approx(steady["max_temperature"], rel=0.002)


def test_transient_heats_up_from_bulk_temperature() -> None:
    moving = {"regime": "transient_rolling", "distance": 2e-3, "steps": 1}
    contact = railpatch.Contact(heated(motion=moving, temperature={}))
    before = 0.0
    for _ in range(6):
        result = contact.step(distance=8e-4)
        assert result.status == "converged"
        assert result["max_temperature"] > before
        before = result["max_temperature"]


def test_a_restored_state_remembers_the_heat() -> None:
    case = heated(
        motion={"regime": "transient_rolling", "distance": 3e-4, "steps": 1},
        friction=law(-0.2, 100.0),
    )
    contact = railpatch.Contact(case)
    for _ in range(5):
        contact.step()
    other = railpatch.Contact(case)
    other.restore(contact.save())
    first, second = contact.step(fields=True), other.step(fields=True)
    np.testing.assert_array_equal(first["temperature"], second["temperature"])
    np.testing.assert_array_equal(first["friction"], second["friction"])


def test_flux_is_the_friction_power() -> None:
    """Heat of the elements against the power that the creepages supply: the same up to the error
    of the grid, which falls with it."""
    errors = []
    for elements in (16, 48):
        result = solve(heated(elements), fields=True)
        area = (result["x"][1] - result["x"][0]) * (result["y"][1] - result["y"][0])
        flux = 20.0 * np.hypot(*result["traction"]) * np.hypot(*result["micro_slip"])
        errors.append(abs(flux.sum() * area / result["friction_power"] - 1))
    assert errors[1] < 0.6 * errors[0]
    assert errors[1] < 0.03


@pytest.mark.parametrize("regime", ["steady_rolling", "transient_rolling"])
def test_plastic_work_heats(regime: str) -> None:
    """The rise is that of friction plus the given fraction of the plastic work."""
    motion: dict[str, Any] = {"regime": regime}
    if regime == "transient_rolling":
        motion.update(distance=0.02, steps=100)

    def run(fraction: float) -> railpatch.Result:
        layer = {"thickness": 0.0, "yield_stress": 1e8, "plastic_heat_fraction": fraction}
        heat = {"wheel": 0.0, "rail": 0.0}
        return solve(heated(motion=motion, layer=layer, temperature=heat), fields=True)

    none, most, whole = (run(fraction) for fraction in (0.0, 0.9, 1.0))
    assert most["plastic_power"] > 0
    added = [np.array(r["temperature"]) - np.array(none["temperature"]) for r in (most, whole)]
    assert added[1].max() > 1.0
    np.testing.assert_allclose(added[0], 0.9 * added[1], rtol=1e-9, atol=1e-9)
    # heat passes out of the grid behind the contact: what is added there is the plastic power
    if regime == "steady_rolling":
        path = np.array(whole["plastic_path"])
        dx = whole["x"][1] - whole["x"][0]
        work = np.diff(path[:, ::-1], axis=1, prepend=0.0)[:, ::-1]
        work[np.array(whole["pressure"]) == 0] = 0.0
        flux = 20.0 / dx * np.hypot(*whole["traction"]) * np.maximum(work, 0.0)
        index = np.arange(len(whole["x"]))
        ahead = index[None, :] - index[:, None]
        edges = np.sqrt(np.maximum(np.stack([ahead + 0.5, ahead - 0.5]), 0.0))
        weight = 2 * (edges[0] - edges[1]) * np.sqrt(dx / (np.pi * 20.0)) / (2 * EFFUSIVITY)
        np.testing.assert_allclose(added[1][0], flux @ weight.T, rtol=1e-6, atol=1e-6)


@pytest.mark.parametrize("change", [-0.3, -0.1, 0.2])
@pytest.mark.parametrize("span", [400.0, 40.0, 4.0])
@pytest.mark.parametrize("creepage", [1e-3, 4e-3, 5e-2])
def test_friction_is_that_of_the_temperature(change: float, span: float, creepage: float) -> None:
    """On the law's graph in every element: by coefficient, or by temperature where it is steep."""
    case = heated(16, friction=law(change, span), motion={"creepage": [-creepage, 0.0]})
    result = solve(case, fields=True)
    touching = np.array(result["pressure"]) > 0
    mu = np.array(result["friction"])[touching]
    rise = rise_of(result, 20.0)[touching]
    temperature = 40.0 + rise
    by_law = 0.35 + change * np.clip((temperature - 60.0) / span, 0, 1)
    at_law = 60.0 + span * (mu - 0.35) / change
    away = np.minimum(np.abs(by_law - mu) / 0.35, np.abs(at_law - temperature) / rise.max())
    assert away.max() < 1e-5
    bound = mu * np.array(result["pressure"])[touching]
    assert np.all(np.hypot(*result["traction"])[touching] <= bound * (1 + 1e-9))


def test_depth() -> None:
    """Far below the surface it is the bulk's temperature; near it the surface's."""
    heat = {"wheel": 60.0, "rail": 20.0}
    surface = solve(heated(temperature=heat), fields=True)
    near = solve(heated(temperature={**heat, "depth": 1e-9}), fields=True)
    deep = solve(heated(temperature={**heat, "depth": 0.05}), fields=True)
    touching = np.array(surface["pressure"]) > 0
    np.testing.assert_allclose(
        np.array(near["temperature"])[:, touching],
        np.array(surface["temperature"])[:, touching],
        rtol=1e-3,
    )
    np.testing.assert_allclose(np.array(deep["temperature"])[0], 60.0)
    np.testing.assert_allclose(np.array(deep["temperature"])[1], 20.0)


def test_no_table_no_stage() -> None:
    case = heated()
    del case["temperature"]
    contact = railpatch.Contact(case)
    result = contact.step(fields=True)
    assert np.isnan(result["max_temperature"])
    assert result["temperature"] is None
    stage = next(s for s in contact.stages() if s["name"] == "temperature")
    assert not stage["present"]
    assert stage["bytes"] == 0
    warm = next(s for s in railpatch.Contact(heated()).stages() if s["name"] == "temperature")
    assert warm["present"]
    assert warm["bytes"] > 0


@pytest.mark.parametrize("friction", [{"coefficient": 0.3}, law(-0.2, 300.0)])
def test_bulk_temperatures_are_inputs_of_a_step(friction: dict[str, Any]) -> None:
    """A wheel that the brakes warm: as a case with that temperature from the start."""
    contact = railpatch.Contact(
        heated(friction=friction, temperature={"wheel": 20.0, "rail": 20.0, "exchange": True})
    )
    contact.step()
    contact.reset()
    moved = contact.step(temperature={"wheel": 180.0}, fields=True)
    fresh = solve(
        heated(friction=friction, temperature={"wheel": 180.0, "rail": 20.0}), fields=True
    )
    assert moved["creep_force"] == fresh["creep_force"]
    np.testing.assert_array_equal(moved["temperature"], fresh["temperature"])
    assert contact.case.temperature.wheel == 180.0


def test_unequal_bulk_temperatures_need_an_exchange() -> None:
    contact = railpatch.Contact(heated(temperature={"wheel": 20.0, "rail": 20.0}))
    assert contact.step(temperature={"wheel": 50.0, "rail": 50.0})["max_temperature"] > 50
    with pytest.raises(railpatch.CaseError, match="bulk_temperature of wheel and rail"):
        contact.step(temperature={"wheel": 60.0})
    with pytest.raises(railpatch.CaseError, match=r"temperature\.depth: value is 0\.1, but"):
        contact.step(temperature={"depth": 0.1})
