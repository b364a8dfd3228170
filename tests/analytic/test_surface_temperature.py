"""Surface temperature with the elastic problem around it: limits of transient rolling, energy,
plastic work, and friction that follows the temperature, checked from the fields alone."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import railpatch
from patch_cases import solve
from railpatch.evidence.stress.half_space import HalfSpace

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


def friction_flux(result: railpatch.Result, case: dict[str, Any]) -> np.ndarray:
    """W/m^2, -V s . (p + p_before)/2 of material that moves by an element; where it has just left
    contact, with the slip of displacements by other code. No element gives heat back, and the sum
    is the friction power: what that and the place of the spin term leave of it goes to the elements
    by their share."""
    motion = case["motion"]
    (xi, eta), phi = motion["creepage"], motion.get("spin_creepage", 0.0)
    direction = motion.get("direction", 1)
    y, x = np.meshgrid(result["y"], result["x"], indexing="ij")
    dx, dy = x[0, 1] - x[0, 0], y[1, 0] - y[0, 0]
    traction = np.array(result["traction"])
    before = np.zeros_like(traction)
    if direction > 0:
        before[..., :-1] = traction[..., 1:]
    else:
        before[..., 1:] = traction[..., :-1]
    steel = case["material"]
    space = HalfSpace(x.shape, dx, dy, steel["shear_modulus"], steel["poisson_ratio"])
    change = space.tangential(traction) - space.tangential(traction, direction * dx)
    beside = np.array([xi - phi * y, eta + phi * (x + 0.25 * direction * dx)]) + change / dx
    slip = np.where(result["pressure"] > 0, result["micro_slip"], beside)
    flux = -0.5 * motion["rolling_speed"] * ((traction + before) * slip).sum(axis=0)
    flux = np.maximum(flux, 0.0)
    return flux * result["friction_power"] / (flux.sum() * dx * dy)


def rise_of(result: railpatch.Result, case: dict[str, Any]) -> np.ndarray:
    """K, by the sum over the elements ahead of each, from tractions and micro-slip."""
    speed, direction = case["motion"]["rolling_speed"], case["motion"].get("direction", 1)
    x = np.array(result["x"])
    dx = x[1] - x[0]
    ahead = direction * (x[None, :] - x[:, None]) / dx  # of the source, in elements
    # an element's work is that of its way from the next one upstream
    near = np.maximum(ahead, 0.0)
    weight = np.where(ahead > -0.25, 2 * (np.sqrt(near + 1) - np.sqrt(near)), 0.0)
    flux = friction_flux(result, case)
    return np.sqrt(dx / (np.pi * speed)) / (2 * EFFUSIVITY) * flux @ weight.T


@pytest.mark.parametrize("direction", [1, -1])
def test_rise_from_the_fields(direction: int) -> None:
    case = heated(motion={"direction": direction})
    result = solve(case, fields=True)
    touching = np.array(result["pressure"]) > 0
    for surface in np.array(result["temperature"]):
        expected = 40.0 + rise_of(result, case)
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


@pytest.mark.parametrize("elements", [16, 48])
def test_flux_is_the_friction_power(elements: int) -> None:
    """Heat of the elements against the power that the creepages supply: without spin the same to
    the solver's tolerance on any grid, as it is with the mean traction alone."""
    case = heated(elements, motion={"spin_creepage": 0.0})
    result = solve(case, fields=True)
    area = (result["x"][1] - result["x"][0]) * (result["y"][1] - result["y"][0])
    traction = np.array(result["traction"])
    mean = 0.5 * (traction + np.roll(traction, -1, axis=2))
    touching = np.array(result["pressure"]) > 0
    here = -20.0 * (mean * result["micro_slip"]).sum(axis=0)[touching].sum() * area
    flux = friction_flux(result, case)
    assert here + flux[~touching].sum() * area == pytest.approx(result["friction_power"], rel=1e-5)
    assert flux.min() >= -1e-6 * flux.max()
    assert result["friction_power"] == pytest.approx(result["creep_power"], rel=1e-5)


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
        # which is in the proportion of the elements' work
        flux *= whole["plastic_power"] / (flux.sum() * dx * (whole["y"][1] - whole["y"][0]))
        index = np.arange(len(whole["x"]))
        ahead = index[None, :] - index[:, None]
        edges = np.sqrt(np.maximum(np.stack([ahead + 1, ahead]), 0.0))
        weight = 2 * (edges[0] - edges[1]) * np.sqrt(dx / (np.pi * 20.0)) / (2 * EFFUSIVITY)
        np.testing.assert_allclose(added[1][0], flux @ weight.T, rtol=1e-6, atol=1e-6)


@pytest.mark.parametrize("change", [-0.3, -0.1, 0.2])
@pytest.mark.parametrize("span", [400.0, 40.0, 4.0])
@pytest.mark.parametrize("creepage", [1e-3, 4e-3, 5e-2])
def test_friction_is_that_of_the_temperature(change: float, span: float, creepage: float) -> None:
    """On the law's graph in every element: by coefficient, or by temperature where it is steep."""
    # an element that heats itself into more friction has two stable states, which the passes may
    # not settle between; here from some 5 K on
    if change > 0:
        span = max(span, 6.0)
    case = heated(16, friction=law(change, span), motion={"creepage": [-creepage, 0.0]})
    result = solve(case, fields=True)
    touching = np.array(result["pressure"]) > 0
    mu = np.array(result["friction"])[touching]
    rise = rise_of(result, case)[touching]
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
    with pytest.raises(
        railpatch.CaseError, match=r"temperature\.wheel, temperature\.rail\) must be"
    ):
        contact.step(temperature={"wheel": 60.0})
    with pytest.raises(railpatch.CaseError, match=r"temperature\.depth: value is 0\.1, but"):
        contact.step(temperature={"depth": 0.1})
