"""Derivatives with a liquid's film: central differences of steps, and closed forms."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
import railpatch
from case_samples import with_values
from patch_cases import patch_case
from published_data import MANCHESTER

TOLERANCE = 1e-12
STEP = 2e-5  # of differences, by the scale of an input
BOUND = 2e-6  # of the film's own numbers; of forces as without a liquid
FILM = ("central_film_thickness", "mean_asperity_share", "fluid_temperature", "effective_friction")
FORCES = ("creep_force", "spin_moment", "friction_power", "utilised_friction", "normal_force")
FORCES += ("fluid_power",)


def numbers(result: railpatch.Result, name: str) -> np.ndarray:
    return np.atleast_1d(np.array(result[name], dtype=float))


def random_fluid(rng: np.random.Generator) -> tuple[dict[str, Any], dict[str, float]]:
    """A liquid's table, and the scales of its inputs."""
    oil, scales = bool(rng.random() < 0.4), {"water_temperature": 20.0}
    fluid: dict[str, Any] = {
        "model": "film",
        "share": str(rng.choice(["film_ratio", "load_sharing"])),
        "roughness": float(10 ** rng.uniform(-6.7, -5.8)),
        "temperature": float(rng.uniform(5, 60)),
    }
    if rng.random() < 0.7:
        fluid["boundary_friction"] = 0.13
    if oil:
        fluid |= {
            "liquid": "oil",
            "viscosity": 0.05,
            "eyring_stress": float(10 ** rng.uniform(6, 8)),
        }
    else:
        fluid["liquid"] = "water"
    if fluid["share"] == "load_sharing" and rng.random() < 0.5:
        fluid["mean_pressure"] = "contact"
    if rng.random() < 0.4:
        fluid["inlet_heating"] = True
    supply = rng.random()
    if supply < 0.3:
        fluid["oil_film"] = float(10 ** rng.uniform(-7, -5.5))
        scales["oil_film"] = fluid["oil_film"]
    elif supply < 0.6:
        fluid["water_rate"] = float(10 ** rng.uniform(-9, -7))
        scales["water_rate"] = fluid["water_rate"]
    if rng.random() < 0.2:
        fluid["starvation"] = 0.7
    return fluid, scales


def random_case(rng: np.random.Generator) -> tuple[dict[str, Any], dict[str, Any]]:
    ratio = math.exp(rng.uniform(-1.2, 1.2))
    shape = str(rng.choice(["semi_axes", "curvatures", "gap"]))
    across = [int(n) for n in rng.integers(10, 20, 2)]
    size = [1.2e-2 * ratio**0.5 / across[0], 1.2e-2 * ratio**-0.5 / across[1]]
    geometry: dict[str, Any] = {
        "semi_axes": {"semi_axes": [5e-3 * ratio**0.5, 5e-3 * ratio**-0.5]},
        "curvatures": {"curvatures": [0.8 * ratio**-0.7, 0.8 * ratio**0.7]},
    }.get(shape, {})
    if shape == "gap":
        x, y = ((np.arange(n + 8) - 0.5 * (n + 7)) * d for n, d in zip(across, size, strict=True))
        gap = 0.9 * (x**2)[None, :] / ratio + 0.9 * ratio * (y**2)[:, None]
        geometry = {"undeformed_distance": (gap + 1e-6 * np.sin(900 * y)[:, None]).tolist()}
    force = float(rng.uniform(2e4, 1.2e5)) * (0.4 if shape == "gap" else 1.0)
    slip, angle = 10 ** rng.uniform(-4, -2), rng.uniform(0, 2 * math.pi)
    case = patch_case(
        geometry,
        force=force,
        elements=None if shape == "gap" else across,
        element_size=size if shape == "gap" else None,
        creepage=[float(slip * math.cos(angle)), float(slip * math.sin(angle))],
        spin=float(rng.uniform(-50, 50) * slip),
        speed=float(10 ** rng.uniform(0, 1.8)),
        friction=0.4,
        tolerance=TOLERANCE,
        max_iterations=3000,
        derivatives=True,
        normal="hertz" if shape != "gap" and rng.random() < 0.5 else "half_space",
    )
    fluid, scales = random_fluid(rng)
    motion = case["motion"]
    own = {
        "normal_force": force,
        "creepage": [slip, slip],
        "spin_creepage": 50 * slip,
        "rolling_speed": motion["rolling_speed"],
    }
    return {**case, "fluid": fluid}, own | scales


def inputs(case: dict[str, Any], rates: dict[str, Any], length: float) -> dict[str, Any]:
    fluid = case["fluid"]
    at = {**case["load"], **case["motion"], **fluid, "water_temperature": fluid["temperature"]}
    return {
        key: (np.asarray(at[key]) + length * np.asarray(rate)).tolist()
        for key, rate in rates.items()
    }


def division(result: railpatch.Result) -> np.ndarray:
    return np.asarray(result["element_division"])


def compare(rng: np.random.Generator, number: int) -> float | None:
    case, scales = random_case(rng)
    names = [str(k) for k in rng.permutation(list(scales))[:2]]
    rates = {key: (np.asarray(scales[key]) * rng.uniform(0.3, 1)).tolist() for key in names}
    contact = railpatch.Contact(case)
    base = contact.step(fields=True)
    assert base.status == "converged", (number, case)
    change = contact.differentiate(**rates)
    assert change["kind"] == "exact"
    assert change.status == "converged"
    single = [contact.differentiate(**{key: rate}) for key, rate in rates.items()]
    # fourth order: (8 D(h) - D(2h))/6, of central differences
    ends = [contact.step(fields=True, **inputs(case, rates, s * STEP)) for s in (1, -1, 2, -2)]
    if not all(np.array_equal(division(base), division(end)) for end in ends):
        return None
    worst = 0.0
    for name in FILM + FORCES:
        value, rate = numbers(base, name), numbers(change, name)
        e = [numbers(end, name) for end in ends]
        difference = (8 * (e[0] - e[1]) - (e[2] - e[3])) / (12 * STEP)
        row = sum(np.linalg.norm(numbers(part, name)) for part in single)
        noise = (1e-13 if name in FILM else 5 * TOLERANCE) * np.linalg.norm(value) / STEP
        bound = BOUND if name in FILM else 1e-5
        error = float(np.linalg.norm(difference - rate))
        assert error <= bound * row + noise, (number, name, rate, difference, rates, case)
        if row > 0:
            worst = max(worst, error / (bound * row + noise))
    return worst


def test_random_states_against_central_differences() -> None:
    rng = np.random.default_rng(21)
    found = [compare(rng, number) for number in range(160)]
    errors = [error for error in found if error is not None]
    assert len(errors) > 0.8 * len(found)
    assert np.median(errors) < 0.2


WET = {
    **patch_case(
        {"curvatures": [1 / 0.92, 1 / 0.60]},
        force=8e4,
        elements=16,
        creepage=[0.05, 0.0],
        speed=20.0,
        friction=0.4,
        normal="hertz",
        derivatives=True,
    ),
    "fluid": {"model": "film", "roughness": 5e-7, "boundary_friction": 0.15, "liquid": "water"},
}


def rates_of(case: dict[str, Any], **direction: Any) -> tuple[railpatch.Result, railpatch.Result]:
    contact = railpatch.Contact(case)
    return contact.step(), contact.differentiate(**direction)


def test_thin_supply_is_the_film() -> None:
    """A layer far thinner than the flooded film is the film: its rate is 1, and that of
    mu = mu_dry + (mu_b - mu_dry)(1 - exp(-h/sigma)) times f = exp(-1.8 (h/sigma)^1.2)."""
    layer, sigma = 2e-9, 5e-7
    case = with_values(WET, fluid__oil_film=layer)
    base, change = rates_of(case, oil_film=1.0)
    assert base["central_film_thickness"] == pytest.approx(layer, rel=1e-3)
    assert change["central_film_thickness"] == pytest.approx(1.0, rel=1e-3)
    r = base["central_film_thickness"] / sigma
    share = math.exp(-1.8 * r**1.2)
    share_rate = -1.8 * 1.2 * r**0.2 / sigma * share * change["central_film_thickness"]
    decay = math.exp(-layer / sigma)
    asperity, asperity_rate = 0.4 - 0.25 * (1 - decay), -0.25 * decay / sigma
    assert change["mean_asperity_share"] == pytest.approx(share_rate, rel=1e-12)
    expected = asperity_rate * share + asperity * share_rate
    assert change["effective_friction"] == pytest.approx(expected, rel=1e-12)


def test_full_sliding_follows_the_film() -> None:
    """Creep force mu F where all slides: its rate by the speed is that of mu."""
    base, change = rates_of(WET, rolling_speed=1.0)
    assert base["elements"]["stick"] == 0
    assert change["creep_force"][0] == pytest.approx(-8e4 * change["effective_friction"], rel=1e-3)
    assert change["effective_friction"] < 0 < change["central_film_thickness"]


def test_dry_friction_counts_by_the_share() -> None:
    """Flooded, without a boundary friction of its own: mu = mu_dry f, its rate f."""
    fluid = {k: v for k, v in WET["fluid"].items() if k != "boundary_friction"}
    base, change = rates_of({**WET, "fluid": fluid}, friction_coefficient=1.0)
    assert change["effective_friction"] == pytest.approx(base["mean_asperity_share"], rel=1e-12)
    base, change = rates_of(WET, friction_coefficient=1.0)
    assert change["effective_friction"] == 0


@pytest.mark.parametrize(
    "fluid",
    [{"model": "strip", "water_rate": None}, {"model": "regimes", "water_rate": 1e-8}],
)
def test_other_models_are_by_differences(fluid: dict[str, Any]) -> None:
    table = {k: v for k, v in {**WET["fluid"], **fluid}.items() if v is not None}
    case = {**WET, "fluid": table}
    if table["model"] == "regimes":
        case |= {"fluid": fluid, "friction": None}
        case["method"] = {"normal": "hertz", "tangential": "polach", "derivatives": True}
    _, change = rates_of(case, rolling_speed=1.0)
    assert change["kind"] == "differences"
    assert change["creep_force"][0] != 0


def test_wheels_on_measured_profiles() -> None:
    """The matrix of a wheelset in the rain against fourth-order differences of its steps."""
    case: dict[str, Any] = {
        "kind": "wheelset",
        "profiles": MANCHESTER,
        "wheelset": {
            "z": 0.0,
            "nominal_radius": 0.46,
            "flange_back_distance": 1.36,
            "flange_back_position": -0.07,
        },
        "track": {"kind": "rail", "gauge": 1.435, "gauge_height": 0.014},
        "grid": {"element_size": [6e-4, 6e-4]},
        "friction": {"coefficient": 0.4},
        "fluid": {**WET["fluid"], "temperature": 15.0, "share": "load_sharing"},
        "method": {"tolerance": 1e-11, "max_iterations": 1000, "derivatives": True},
    }
    free = {k: v for k, v in case["wheelset"].items() if k != "z"}
    find = railpatch.Contact({**case, "wheelset": {**free, "vertical_force": 1e5}})
    contact, compared = railpatch.Contact(case), 0
    scale = {"y": 1e-3, "yaw": 1e-3, "vy": 0.01, "pitch_rate": 1.0, "speed": 1.0}
    step = {"y": 1e-8, "yaw": 4e-7, "vy": 2e-5, "pitch_rate": 2e-5, "speed": 2e-5}
    for y in (-3e-3, 0.0, 2.2e-3):
        state = {"y": y, "yaw": 1e-3, "speed": 20.0, "pitch_rate": -43.5, "vy": 0.01}
        state["z"] = find.step(**state)["z"]

        def rows(result: railpatch.Result) -> np.ndarray:
            return np.array([*result["right"]["force"], *result["right"]["moment"]])

        def parts(result: railpatch.Result) -> list[bytes]:
            return [division(p).tobytes() for p in result["right"]["patches"]]

        base = contact.step(fields=True, **state)
        found = contact.jacobian()
        assert found["kind"] == "exact"
        columns = {"y": 1, "yaw": 4, "speed": 6, "vy": 7, "pitch_rate": 11}
        usual = np.array([1, 1e-3, 1e-4, 1e-4, 1e-3, 1e-3, 1, *[0.01] * 4, 1])
        row = np.abs(found["right"] * usual).max(axis=1)
        for name, column in columns.items():
            h = step[name]
            ends = [
                contact.step(fields=True, **{**state, name: state[name] + s * h}) for s in (1, -1)
            ]
            if any(parts(end) != parts(base) for end in ends):
                continue
            compared += 1
            expected = (rows(ends[0]) - rows(ends[1])) / (2 * h)
            missed = np.abs(found["right"][:, column] - expected) * scale[name]
            assert (missed <= 1e-5 * row).all(), (y, name, missed / row)
    assert compared >= 10
