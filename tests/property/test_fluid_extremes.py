"""A liquid in the corners of what wheels meet: 0.01 to 150 m/s, layers of 1 nm to 10 um, -10 (water
0) to 100 degrees C, loads from 100 N. Every result is finite and within its bounds, or the status
or an error says why not; and from wet to dry nothing jumps."""

from __future__ import annotations

import itertools
import math
from typing import Any

import numpy as np
import pytest
import railpatch

DRY, BOUNDARY = 0.5, 0.2
# of Eyring's friction by default, and of the regimes' knots
LIMITING, OF_KNOTS = 0.07, 0.55
SPEEDS, LOADS = (0.01, 150.0), (100.0, 3e5)
ROUGHNESS = (1e-8, 1e-5)
FAST = {"normal": "hertz", "tangential": "fastsim"}
FULL = {"normal": "half_space", "tangential": "full"}
FILM = {"model": "film", "boundary_friction": BOUNDARY}
STRIP = {"model": "strip", "boundary_friction": BOUNDARY}
PASTE = {"oxide": {"solid_content": 0.5}}
SHARED = {"share": "load_sharing"}
# a shape that is no ellipse, so that each row is solved
ROWS = {"geometry": {"undeformed_distance": "fourth power"}}
# model: keys of [fluid], of [method], and what else
MODELS: dict[str, tuple[dict[str, Any], dict[str, Any], dict[str, Any]]] = {
    "film": (FILM, FAST, {}),
    "film, full theory": (FILM, FULL, {}),
    "load sharing": ({**FILM, **SHARED}, FAST, {}),
    "load sharing, the contact's pressure": (
        {**FILM, **SHARED, "mean_pressure": "contact"},
        FAST,
        {},
    ),
    "oxide": ({**FILM, **PASTE}, FAST, {}),
    "oxide, load sharing": ({**FILM, **PASTE, **SHARED}, FAST, {}),
    "strip by its table": (STRIP, FULL, {}),
    "strip by rows": (STRIP, FULL, ROWS),
    "strip, oxide": ({**STRIP, **PASTE}, FULL, {}),
    "ehl": ({**STRIP, "model": "ehl"}, FULL, {}),
}
LIQUIDS: dict[str, dict[str, Any]] = {
    "cold water": {"liquid": "water", "temperature": 0.0},
    "hot water": {"liquid": "water", "temperature": 100.0},
    "cold oil": {"liquid": "oil", "viscosity": 0.1, "temperature": -10.0},
    "hot oil": {"liquid": "oil", "viscosity": 0.1, "temperature": 100.0},
}
SUPPLIES: tuple[dict[str, float], ...] = ({}, {"oil_film": 1e-9}, {"oil_film": 1e-5})


def case_of(
    model: str, liquid: str, supply: dict[str, float], force: float, roughness: float
) -> dict[str, Any]:
    fluid, method, tables = MODELS[model]
    axis = 6e-3 * (force / 1e5) ** (1 / 3)
    case: dict[str, Any] = {
        "kind": "patch",
        "geometry": {"semi_axes": [axis, 0.8 * axis]},
        "load": {"normal_force": force},
        "grid": {"elements": [12, 8]},
        "motion": {"creepage": [2e-3, 1e-3], "rolling_speed": 1.0},
        "friction": {"coefficient": DRY},
        "fluid": {**fluid, **LIQUIDS[liquid], **supply, "roughness": roughness},
        "method": method,
    }
    if "geometry" in tables:
        place = (np.arange(12) - 5.5) / 5
        x, y = np.meshgrid(place, place)
        # of a contact that touches on most of its 12 x 12 elements
        high = 3.0 * axis**2 * (0.4 * (x**2 + y**2) + 0.6 * (x**4 + y**4))
        case["geometry"] = {"undeformed_distance": high.tolist()}
        case["grid"] = {"element_size": [axis / 5, axis / 5]}
    return case


def problems_of(result: Any, force: float, most: float) -> list[str]:
    """What is no number, or out of its bounds."""
    found = []
    names = (
        "mean_asperity_share",
        "effective_friction",
        "central_film_thickness",
        "friction_power",
    )
    for name in (*names, "fluid_temperature", "max_pressure", "contact_area", "fluid_power"):
        if result[name] is None or not math.isfinite(result[name]):
            found.append(f"{name} is {result[name]}")
    pull = math.hypot(*result["creep_force"])
    thick = any("a film is thicker than 0.1 mm" in text for text in result.warnings)
    within = {
        "share": (0.0, result["mean_asperity_share"], 1.0),
        "friction": (0.0, result["effective_friction"], most),
        "force": (0.0, pull, most * force),
        # what no wheel has is said
        "film": (0.0, result["central_film_thickness"], math.inf if thick else 1e-4),
        "power": (0.0, result["friction_power"], math.inf),
    }
    for name, (low, value, high) in within.items():
        if not low - 1e-9 <= value <= high * (1 + 1e-9) + 1e-9:
            found.append(f"{name} is {value}, allowed {low} to {high}")
    return found


def wrong(
    model: str, liquid: str, supply: dict[str, float], force: float, rough: float
) -> list[str]:
    """Of all speeds of a corner."""
    case = case_of(model, liquid, supply, force, rough)
    unread = supply and MODELS[model][0]["model"] == "strip"
    try:
        contact = railpatch.Contact(case)
    except railpatch.CaseError as error:
        named = all("fluid.oil_film" in text for text in error.problems)
        return [] if unread and named else error.problems
    if unread:
        return ["what the strips do not read is taken"]
    found = []
    for speed in SPEEDS:
        result = contact.step(rolling_speed=speed)
        where = f"{model}, {liquid}, {supply}, {force:g} N, {rough:g} m, {speed:g} m/s: "
        if result.status != "converged":
            # smooth films much thinner than the grid resolves have no solution on it (docs/ehl.md)
            if MODELS[model][0]["model"] != "ehl" or not result.reason:
                found.append(f"{where}{result.status}, {result.reason}")
            continue
        most = max(DRY if supply else BOUNDARY, LIMITING)
        found += [where + text for text in problems_of(result, force, most)]
    return found


QUICK = [name for name in MODELS if name != "ehl"]


@pytest.mark.parametrize("model", QUICK)
def test_corners(model: str) -> None:
    """The extremes of load and layer, of the coldest oil and the hottest water."""
    found = []
    for liquid, supply, force in itertools.product(("cold oil", "hot water"), SUPPLIES, LOADS):
        found += wrong(model, liquid, supply, force, ROUGHNESS[0] if supply else ROUGHNESS[1])
    assert found == []


@pytest.mark.long
@pytest.mark.parametrize("model", MODELS)
def test_all_of_them(model: str) -> None:
    found = []
    for corner in itertools.product(LIQUIDS, SUPPLIES, (100.0, 1e4, 3e5), (1e-8, 5e-7, 1e-5)):
        found += wrong(model, *corner)
    assert found == []


@pytest.mark.parametrize("model", ["film", "load sharing", "oxide", "regimes"])
@pytest.mark.parametrize("speed", [0.01, 20.0, 150.0])
def test_from_wet_to_dry_nothing_jumps(model: str, speed: float) -> None:
    """As the rate goes to 0 force and friction go to those of rate 0, which are dry ones."""
    force = 8e4
    if model == "regimes":
        case = case_of("film", "cold water", {}, force, 5e-7)
        case |= {"fluid": {"model": "regimes", "water_rate": 1e-8}, "friction": None}
        case["method"] = {"normal": "hertz", "tangential": "polach"}
    else:
        case = case_of(model, "cold water", {"water_rate": 1e-8}, force, 5e-7)
    contact = railpatch.Contact(case)

    def over(count: int) -> list[float]:
        """Forces at rates from 1e-5 to 1e-17 m^3/s, and last at 0."""
        rates = [*np.geomspace(1e-5, 1e-17, count), 0.0]
        steps = (contact.step(rolling_speed=speed, water_rate=float(rate)) for rate in rates)
        return [float(np.hypot(*step["creep_force"])) for step in steps]

    pulls = over(121)
    dry = pulls[-1]
    gaps = [abs(pull - dry) / dry for pull in pulls[:-1]]
    assert gaps[-1] < 1e-6
    assert gaps[-21] >= gaps[-11] >= gaps[-1]
    # the greatest change from a rate to the next shrinks with their distance, but that of a jump
    coarse, fine = (max(np.abs(np.diff(found))) for found in (pulls[::2], pulls))
    assert fine < 0.65 * coarse
    if model != "regimes":
        without = {key: table for key, table in case.items() if key != "fluid"}
        plain = railpatch.Contact(without).step(rolling_speed=speed)["creep_force"]
        assert np.hypot(*plain) == pytest.approx(dry, rel=1e-9)


def test_pressures_of_which_the_search_is_given_up() -> None:
    """Smooth bodies under 300 kN on a grid too coarse for their film: the last pressures of the
    liquid bear more than the load, shares and friction stay what they can be."""
    case = {
        "kind": "patch",
        "material": {"shear_modulus": 80.77e9, "poisson_ratio": 0.3},
        "geometry": {"curvatures": [0.5 / 0.46, 0.5 / 0.30]},
        "load": {"normal_force": 3e5},
        "grid": {"elements": [32, 12]},
        "motion": {"creepage": [5e-3, 0.0], "rolling_speed": 0.01},
        "friction": {"coefficient": 0.4},
        "fluid": {
            "model": "ehl",
            "roughness": 1e-9,
            "boundary_friction": BOUNDARY,
            "liquid": "water",
            "temperature": 0.0,
        },
    }
    found = railpatch.Contact(case).step()
    assert 0 <= found["mean_asperity_share"] <= 1
    assert 0 <= found["effective_friction"] <= BOUNDARY + LIMITING
    if found.status != "converged":
        assert found.status == "not_converged"
        assert "finer elements" in str(found.reason)
