"""Elastohydrodynamic lubrication by a case: loads, laws of friction with the bound of asperities
and liquid, energy, heat, the dry limit, starvation; what is refused."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import railpatch
from case_samples import WHEELSET

BASE: dict[str, Any] = {
    "kind": "patch",
    "geometry": {"semi_axes": [6e-3, 5e-3]},
    "load": {"normal_force": 8e4},
    "grid": {"elements": [32, 16]},
    "motion": {"creepage": [1.5e-3, 5e-4], "spin_creepage": 0.2, "rolling_speed": 20.0},
    "friction": {"coefficient": 0.4},
    "fluid": {
        "model": "ehl",
        "roughness": 5e-7,
        "boundary_friction": 0.15,
        "liquid": "water",
        "temperature": 20.0,
    },
    "method": {"tolerance": 1e-8},
}
OIL = {
    "model": "ehl",
    "roughness": 5e-7,
    "boundary_friction": 0.15,
    "liquid": "oil",
    "viscosity": 0.1,
    "temperature": 40.0,
}


def with_fluid(**changes: Any) -> dict[str, Any]:
    return {**BASE, "fluid": {**BASE["fluid"], **changes}}


def solved(case: dict[str, Any], **changes: Any) -> railpatch.Result:
    result = railpatch.Contact(case).step(fields=True, **changes)
    assert result.status == "converged", result.reason
    return result


@pytest.mark.parametrize("speed", [0.0, 1.0, 20.0])
def test_the_area_is_that_of_the_dry_contact(speed: float) -> None:
    """However far before it liquid presses."""
    motion = {**BASE["motion"], "rolling_speed": speed}
    wet = solved({**BASE, "motion": motion})
    dry = solved({name: table for name, table in BASE.items() if name != "fluid"})
    for name in ("contact_area", "contact_size"):
        assert wet[name] == pytest.approx(dry[name], rel=0.06), name
    assert wet["contact_area"] == pytest.approx(np.pi * 6e-3 * 5e-3, rel=0.1)
    x, y = np.array(wet["x"]), np.array(wet["y"])
    bears = (np.array(wet["pressure"]) > 0).sum() * (x[1] - x[0]) * (y[1] - y[0])
    assert (bears > 1.5 * wet["contact_area"]) == (speed > 0.0)


@pytest.mark.parametrize("speed", [0.01, 1.0, 20.0, 100.0])
@pytest.mark.parametrize("direction", [1, -1])
def test_laws_of_friction(speed: float, direction: int) -> None:
    """|p| <= mu_b p_a; where it slips equality, slip opposite to the traction; loads add up."""
    motion = {**BASE["motion"], "rolling_speed": speed, "direction": direction}
    r = solved({**BASE, "motion": motion})
    pressure, fluid = np.array(r["pressure"]), np.array(r["fluid_pressure"])
    asperities = pressure - fluid
    assert (fluid >= 0).all()
    assert (asperities >= -1e-9 * pressure.max()).all()
    x, y = np.array(r["x"]), np.array(r["y"])
    cell = (x[1] - x[0]) * (y[1] - y[0])
    # but for elements of less than a millionth of the greatest pressure
    assert pressure.sum() * cell == pytest.approx(8e4, rel=1e-5)
    assert asperities.sum() * cell / 8e4 == pytest.approx(r["mean_asperity_share"], abs=1e-5)
    traction, slip = np.array(r["traction"]), np.array(r["micro_slip"])
    length = np.hypot(*traction)
    bound = 0.15 * asperities
    assert (length <= bound + 1e-6 * bound.max()).all()
    division = np.array(r["element_division"])
    slips = (division == 2) & (bound > 1e-3 * bound.max())
    assert np.allclose(length[slips], bound[slips], rtol=1e-6)
    cross = traction[0] * slip[1] - traction[1] * slip[0]
    size = length * np.hypot(*slip)
    assert (np.abs(cross[slips]) <= 1e-4 * size.max()).all()
    assert ((traction * slip).sum(axis=0)[slips] <= 0).all()
    assert r["friction_power"] == pytest.approx(r["creep_power"], rel=1e-6)


def test_faster_wetter() -> None:
    """More speed: a thicker film, less on asperities; warmer water and rougher surfaces: more."""
    contact = railpatch.Contact(BASE)
    steps = [contact.step(rolling_speed=v) for v in (1.0, 5.0, 20.0, 80.0)]
    films = [s["central_film_thickness"] for s in steps]
    shares = [s["mean_asperity_share"] for s in steps]
    assert films == sorted(films)
    assert shares == sorted(shares, reverse=True)
    assert shares[0] > 0.95
    assert shares[-1] < 0.8
    warm = contact.step(rolling_speed=20.0, water_temperature=60.0)
    assert warm["mean_asperity_share"] > shares[2]
    rough = solved(with_fluid(roughness=1e-6))
    assert rough["mean_asperity_share"] > shares[2]
    # the same, whatever was before
    again = contact.step(rolling_speed=20.0, water_temperature=20.0)
    assert again["mean_asperity_share"] == pytest.approx(shares[2], rel=1e-9)


def test_dry_limit() -> None:
    """Little roughness and speed: pressure, approach and creep force of the dry case."""
    # bodies so hard that valleys stay open and trap nothing
    fluid = {**BASE["fluid"], "roughness": 1e-7, "hardness": 1e10}
    motion = {**BASE["motion"], "rolling_speed": 1e-3}
    wet = solved({**BASE, "fluid": fluid, "motion": motion})
    dry_case = {k: v for k, v in BASE.items() if k != "fluid"}
    dry = solved({**dry_case, "friction": {"coefficient": 0.15}, "motion": motion})
    assert wet["mean_asperity_share"] == pytest.approx(1, abs=1e-3)
    # heights of a thousandth of the approach remain
    assert wet["approach"] == pytest.approx(dry["approach"], rel=5e-3)
    assert wet["max_pressure"] == pytest.approx(dry["max_pressure"], rel=5e-3)
    assert np.allclose(wet["creep_force"], dry["creep_force"], rtol=5e-3)
    stands = solved({**BASE, "motion": {**BASE["motion"], "rolling_speed": 0.0}})
    assert stands["mean_asperity_share"] == 1


def test_oil_has_friction_of_its_own() -> None:
    """Where no asperity touches the force is the liquid's shear, which is friction's work."""
    fluid = {**OIL, "eyring_stress": 5e6, "roughness": 1e-7}
    r = solved({**BASE, "fluid": fluid})
    assert r["mean_asperity_share"] < 1e-6
    assert r["central_film_thickness"] > 1e-6
    fx, fy = r["creep_force"]
    assert 0.001 < np.hypot(fx, fy) / 8e4 < 0.07 * (1 + 1e-9)
    assert r["friction_power"] == pytest.approx(r["creep_power"], rel=1e-6)
    assert r["effective_friction"] == pytest.approx(np.hypot(fx, fy) / 8e4, rel=0.3)
    none = solved({**BASE, "fluid": {**OIL, "eyring_stress": 0.0, "roughness": 1e-7}})
    assert np.hypot(*none["creep_force"]) < 1e-3 * np.hypot(fx, fy)


def test_starved() -> None:
    """A layer of oil thinner than the film that could be passes as it comes."""
    plenty = solved({**BASE, "fluid": {**OIL, "roughness": 1e-7}})["central_film_thickness"]
    thin = solved({**BASE, "fluid": {**OIL, "roughness": 1e-7, "oil_film": 0.2 * plenty}})
    assert thin["central_film_thickness"] == pytest.approx(0.2 * plenty, rel=0.02)
    much = solved({**BASE, "fluid": {**OIL, "roughness": 1e-7, "oil_film": 100 * plenty}})
    assert much["central_film_thickness"] == pytest.approx(plenty, rel=1e-6)


@pytest.mark.parametrize("supply", ["water_rate", "oil_film"])
def test_without_supply_it_is_dry(supply: str) -> None:
    """No liquid at all is not plenty; friction goes over to that of dry surfaces without a jump."""
    motion = {"creepage": [0.05, 0.0], "rolling_speed": 20.0}
    case = {**BASE, "motion": motion, "grid": {"elements": [16, 12]}}
    steps = {}
    for amount in (0.0, 1e-18, 1e-13):
        r = solved({**case, "fluid": {**BASE["fluid"], supply: amount}})
        assert r["mean_asperity_share"] == pytest.approx(1, abs=1e-6)
        steps[amount] = np.hypot(*r["creep_force"]) / 8e4
    # but for elements of less than a millionth of the greatest pressure, which have no traction
    assert steps[0.0] == pytest.approx(0.4, rel=1e-4)
    assert steps[1e-18] == pytest.approx(steps[0.0], rel=1e-8)
    assert steps[1e-13] == pytest.approx(steps[0.0], rel=1e-5)
    # and of a layer asperities that no liquid reaches are dry, as with film
    layer = 3e-8
    r = solved({**case, "fluid": {**BASE["fluid"], "oil_film": layer}})
    wetted = 0.15 + (0.4 - 0.15) * np.exp(-layer / 5e-7)
    assert r["effective_friction"] == pytest.approx(wetted * r["mean_asperity_share"], rel=1e-9)


REACH = "the liquid's film begins before the grid, which must reach farther ahead of the contact"
SMOOTH = {**OIL, "roughness": 1e-8}


@pytest.mark.parametrize("direction", [1, -1])
def test_grids_reach_to_where_a_film_begins(direction: int) -> None:
    """Their film is that of one given much greater; one too short is warned of."""
    motion = {"creepage": [0.0, 0.0], "rolling_speed": 60.0, "direction": direction}
    curvatures, half = [1.0, 1.5], 8  # elements of a semi-axis
    case = {**BASE, "fluid": SMOOTH, "motion": motion, "grid": {"elements": [2 * half, 10]}}
    own = solved({**case, "geometry": {"curvatures": curvatures}})
    x, y = np.array(own["x"]), np.array(own["y"])
    size = [float(x[1] - x[0]), float(y[1] - y[0])]
    behind, ahead = (direction * x).min(), (direction * x).max()
    assert ahead > 2.2 * half * size[0]
    assert 1.5 * half * size[0] < -behind < 1.8 * half * size[0]
    assert REACH not in own.warnings

    def given(ahead: float) -> railpatch.Result:
        """On a grid of the user's, so many semi-axes ahead of the middle."""
        place = behind + size[0] * np.arange(round((1.6 + ahead) * half))
        gap = curvatures[0] * place**2 + curvatures[1] * y[:, None] ** 2
        shape = {"undeformed_distance": gap[:, ::direction].tolist()}
        return solved({**case, "geometry": shape, "grid": {"element_size": size}})

    far, short = given(6.0), given(1.6)
    assert REACH not in far.warnings
    film = "central_film_thickness"
    assert own[film] == pytest.approx(far[film], rel=0.015)
    assert REACH in short.warnings
    assert short[film] < 0.97 * far[film]


COARSE = "the grid is too coarse for the film that was found: more elements along rolling"


@pytest.mark.parametrize("direction", [1, -1])
@pytest.mark.parametrize("fluid", [BASE["fluid"], {**OIL, "roughness": 1e-8}])
def test_a_grid_too_coarse_for_the_film_is_warned_of(fluid: dict[str, Any], direction: int) -> None:
    """By the rise of the reduced pressure, recomputed from the field; on a fine one: none."""
    alpha = 5e-10 if fluid["liquid"] == "water" else 20e-9
    films = []
    for elements, warned in ((24, True), (96, False)):
        case = {**BASE, "fluid": fluid, "grid": {"elements": [elements, 12]}}
        motion = {"creepage": [1.5e-3, 0.0], "rolling_speed": 20.0, "direction": direction}
        r = solved({**case, "motion": motion})
        flow = np.array(r["fluid_pressure"])[:, ::-direction]
        reduced = 1 - np.exp(-alpha * flow)
        rise = np.diff(reduced, axis=1, prepend=0.0).max() / reduced.max()
        assert (rise > 0.1) == warned
        assert (COARSE in r.warnings) == warned
        films.append(r["central_film_thickness"])
    # what the warning means: films too thin
    assert films[0] < 0.95 * films[1]


def test_line_contact_and_approach() -> None:
    """Of a line contact; and an approach that gives back the force."""
    case = {**BASE, "motion": {"creepage": [1e-3, 0.0], "rolling_speed": 20.0}}
    line = solved(
        {
            **case,
            "geometry": {"line_contact_radius": 0.5, "width": 0.01},
            "grid": {"elements": [64, 1]},
        }
    )
    assert 0.2 < line["mean_asperity_share"] < 0.9
    by_force = solved(BASE)
    by_approach = solved(
        {**BASE, "geometry": {"curvatures": [1.0, 1.5]}, "load": {"normal_force": 8e4}}
    )
    back = solved(
        {
            **BASE,
            "geometry": {"curvatures": [1.0, 1.5]},
            "load": {"approach": by_approach["approach"]},
        }
    )
    assert back["normal_force"] == pytest.approx(8e4, rel=0.01)
    assert by_force["normal_force"] == pytest.approx(8e4, rel=1e-9)


def test_liquid_as_warm_as_the_surfaces() -> None:
    """Friction heats the surfaces, they the liquid, which bears less: a loop that settles."""
    case = {**BASE, "temperature": {"wheel": 20.0, "rail": 20.0}}
    case["fluid"] = {k: v for k, v in BASE["fluid"].items() if k != "temperature"}
    case["motion"] = {**BASE["motion"], "creepage": [0.02, 0.0]}
    warm = solved(case)
    cold = solved({**case, "fluid": BASE["fluid"]})
    assert warm["fluid_temperature"] > 25
    assert warm["mean_asperity_share"] > cold["mean_asperity_share"]


@pytest.mark.parametrize(
    ("changes", "named"),
    [
        ({"method": {"normal": "hertz"}}, "method.normal"),
        (with_fluid(starvation=0.5), "starvation"),
        (with_fluid(share="load_sharing"), "share"),
        ({"grid": {"elements": [16, 16], "fitted": [12, 12]}}, "grid.fitted"),
    ],
)
def test_refused(changes: dict[str, Any], named: str) -> None:
    """By name."""
    with pytest.raises(railpatch.CaseError, match=named):
        railpatch.solve({**BASE, **changes})


def test_refused_on_wheels() -> None:
    """The liquid comes from beyond the grids of wheels."""
    with pytest.raises(railpatch.CaseError, match=r"fluid\.model"):
        railpatch.solve({**WHEELSET, "fluid": BASE["fluid"]})


@pytest.mark.parametrize("fluid", [{}, OIL])
def test_utilised_friction_is_of_what_can_slip(fluid: dict[str, Any]) -> None:
    """Over the asperities' and the liquid's bound, not over the load: one where all slips, but for
    what tractions lean to the sides."""
    motion = {"creepage": [1e-2, 0.0], "rolling_speed": 20.0}
    r = solved({**with_fluid(**fluid), "motion": motion})
    assert r["utilised_friction"] == pytest.approx(1.0, abs=1e-4)
    less = solved(with_fluid(**fluid))
    most = less["effective_friction"] * less["normal_force"]
    used = np.hypot(*less["creep_force"]) / most
    assert less["utilised_friction"] == pytest.approx(used, rel=1e-6)
    assert used < 0.999
