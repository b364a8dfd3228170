"""Derivatives of a patch's result: central differences of steps, and closed forms."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import railpatch
from case_samples import with_values
from patch_cases import patch_case
from railpatch import _core
from railpatch.errors import CaseError
from railpatch.result import PATCH_UNITS

TOLERANCE = 1e-12
STEP = 2e-5  # of differences, relative to what makes an input a good part of its range
BOUND = 1e-5
# all that has a rate
OUTPUTS = [
    name for name in PATCH_UNITS if _core.QUANTITIES["patch"].get(name, {}).get("role") == "number"
]


def numbers(result: railpatch.Result, name: str) -> np.ndarray:
    value = result[name]
    return np.atleast_1d(np.array(math.nan if value is None else value, dtype=float))


def random_case(rng: np.random.Generator) -> tuple[dict[str, Any], dict[str, Any]]:
    """A case, and by input the scale of its changes."""
    ratio = math.exp(rng.uniform(math.log(0.2), math.log(5.0)))
    shape = str(rng.choice(["semi_axes", "curvatures", "line_contact_radius", "gap"]))
    across = [int(n) for n in rng.integers(9, 29, 2)]
    if shape == "line_contact_radius":
        across[1] = 1
    geometry: dict[str, Any] = {
        "semi_axes": {"semi_axes": [5e-3 * ratio**0.5, 5e-3 * ratio**-0.5]},
        "curvatures": {"curvatures": [0.8 * ratio**-0.7, 0.8 * ratio**0.7]},
        "line_contact_radius": {"line_contact_radius": 0.4, "width": 0.01},
        "gap": {},
    }[shape]
    size = None
    if shape == "gap" or (shape in ("semi_axes", "curvatures") and rng.random() < 0.3):
        size = [1.2e-2 * ratio**0.5 / across[0], 1.2e-2 * ratio**-0.5 / across[1]]
    if shape == "gap":
        assert size is not None
        x, y = ((np.arange(n + 8) - 0.5 * (n + 7)) * d for n, d in zip(across, size, strict=True))
        gap = 0.9 * (x**2)[None, :] / ratio + 0.9 * ratio * (y**2)[:, None]
        gap = gap + 1e-6 * np.sin(900 * y)[:, None] + 2e-7 * np.cos(1500 * x)[None, :]
        geometry = {"undeformed_distance": gap.tolist()}
    part = {"line_contact_radius": 0.2, "gap": 0.3}.get(shape, 1.0)
    force = float(rng.uniform(2e4, 1.5e5)) * part
    position = shape != "line_contact_radius" and rng.random() < 0.4
    slip, angle = 10 ** rng.uniform(-4.5, -1.8), rng.uniform(0, 2 * math.pi)
    hertz = shape != "gap" and rng.random() < 0.3
    case = patch_case(
        geometry,
        force=None if position else force,
        approach=float(rng.uniform(3e-5, 1.2e-4)) * part**0.67 if position else None,
        elements=None if size else across,
        element_size=size,
        creepage=[float(slip * math.cos(angle)), float(slip * math.sin(angle))],
        spin=float(rng.uniform(-100, 100) * slip) if rng.random() < 0.7 else 0.0,
        direction=int(rng.choice([1, -1])),
        speed=float(rng.uniform(1, 50)),
        layer={"shear_modulus": 5e9, "thickness": 2e-5} if rng.random() < 0.3 else None,
        tolerance=TOLERANCE,
        max_iterations=3000,
        derivatives=True,
        normal="hertz" if hertz else "half_space",
        spin_offset="sixth" if rng.random() < 0.2 else "automatic",
    )
    if rng.random() < 0.1:
        case = with_values(case, layer=None, method__spin_offset=None, method__tangential="none")
    if shape in ("semi_axes", "curvatures") and rng.random() < 0.3:
        case["friction"]["factor"] = [[-3e-3, 0.7], [1e-3, 1.2], [3e-3, 0.9]]
    if case["method"].get("tangential") == "none":
        del case["friction"]
    load = "approach" if position else "normal_force"
    scales = {
        load: case["load"][load],
        "creepage": [slip, slip],
        "spin_creepage": 100 * slip,
        "rolling_speed": case["motion"]["rolling_speed"],
    }
    return case, scales


def moved(case: dict[str, Any], rates: dict[str, Any], length: float) -> dict[str, Any]:
    """The inputs of a step at a distance along the direction."""
    at = {**case["load"], **case["motion"]}
    return {
        key: (np.asarray(at[key]) + length * np.asarray(rate)).tolist()
        for key, rate in rates.items()
    }


def division(result: railpatch.Result) -> list[Any]:
    """What must not change between the steps of a difference."""
    parts = [np.asarray(result["pressure"]) > 0]
    if result["element_division"] is not None:
        parts.append(np.asarray(result["element_division"]))
    return parts


def same(a: list[Any], b: list[Any]) -> bool:
    return all(np.array_equal(x, y) for x, y in zip(a, b, strict=True))


def compare(rng: np.random.Generator, number: int) -> float | None:
    """Greatest error over the bound; None where an element changes its state."""
    case, scales = random_case(rng)
    keys = [str(k) for k in rng.permutation(list(scales))[: int(rng.integers(1, 3))]]
    rates = {key: (np.asarray(scales[key]) * rng.uniform(-1, 1)).tolist() for key in keys}
    contact = railpatch.Contact(case)
    base = contact.step(fields=True)
    assert base.status in ("converged",), (number, case, base.status)
    change = contact.differentiate(**rates)
    assert change["kind"] == "exact"
    assert change.status == "converged"
    # the scale of each output's row: what its inputs do one by one
    single = [contact.differentiate(**{key: rate}) for key, rate in rates.items()]
    ends = [contact.step(fields=True, **moved(case, rates, s * STEP)) for s in (1, -1)]
    if not all(same(division(base), division(end)) for end in ends):
        return None
    worst = 0.0
    for name in OUTPUTS:
        value, rate = numbers(base, name), numbers(change, name)
        high, low = (numbers(end, name) for end in ends)
        assert np.array_equal(np.isnan(value), np.isnan(rate)), (number, name, case)
        if np.isnan(value).any():
            continue
        if name == "wear_number" and case["motion"].get("spin_creepage") == 0:
            # a kink: the difference of both sides is off by the step
            continue
        row = sum(np.linalg.norm(numbers(part, name)) for part in single)
        # what the steps themselves are good for: their tolerance, and rounding
        noise = 5 * TOLERANCE * np.linalg.norm(value) / STEP
        error = np.linalg.norm((high - low) / (2 * STEP) - rate)
        ratio = error / (BOUND * row + noise) if error > 0 else 0.0
        assert ratio <= 1, (
            f"state {number}, {name}: {rate} against {(high - low) / (2 * STEP)}, "
            f"row {row}, noise {noise}, direction {rates}, case {case}"
        )
        worst = max(worst, ratio)
    return worst


def test_random_states_against_central_differences() -> None:
    """320 states; few have an element that changes its state between the two steps."""
    rng = np.random.default_rng(20261121)
    found = [compare(rng, number) for number in range(320)]
    errors = [error for error in found if error is not None]
    print(f"{len(found) - len(errors)} of {len(found)} states with a change of state left out")
    assert len(errors) > 0.85 * len(found)
    assert np.median(errors) < 0.1


# --- closed forms -------------------------------------------------------------------------------

CURVATURES = {"curvatures": [0.7, 1.3]}


def derivative(case: dict[str, Any], **direction: Any) -> tuple[railpatch.Result, railpatch.Result]:
    case["method"]["derivatives"] = True
    contact = railpatch.Contact(case)
    return contact.step(), contact.differentiate(**direction)


@pytest.mark.parametrize("normal", ["hertz", "half_space"])
def test_powers_of_hertz(normal: str) -> None:
    """approach ~ F^(2/3), p0 ~ F^(1/3), area ~ F^(2/3), energy ~ F^(5/3); a grid that scales with
    the contact obeys the same laws."""
    case = patch_case(CURVATURES, force=8e4, elements=12, normal=normal, tolerance=1e-12)
    base, change = derivative(case, normal_force=1.0)
    powers = {
        "normal_force": 1.0,
        "approach": 2 / 3,
        "max_pressure": 1 / 3,
        "contact_area": 2 / 3,
        "elastic_energy": 5 / 3,
    }
    for name, power in powers.items():
        assert change[name] * 8e4 / base[name] == pytest.approx(power, rel=1e-8), name


@pytest.mark.parametrize("normal", ["hertz", "half_space"])
def test_powers_of_hertz_over_the_approach(normal: str) -> None:
    """F ~ approach^(3/2)."""
    case = patch_case(CURVATURES, approach=7e-5, elements=12, normal=normal, tolerance=1e-12)
    base, change = derivative(case, approach=1.0)
    assert change["normal_force"] * 7e-5 / base["normal_force"] == pytest.approx(1.5, rel=1e-8)
    assert change["approach"] == pytest.approx(1.0, rel=1e-14)


def test_full_sliding() -> None:
    """Creep force -mu F against the creepage: its rate is -mu by the load, and 0 by the size of the
    creepage, to the share of the elastic slip."""
    case = patch_case(CURVATURES, force=8e4, elements=12, creepage=[1.0, 0.0], tolerance=1e-12)
    _, by_load = derivative(case, normal_force=1.0)
    base, by_creepage = derivative(case, creepage=[1.0, 0.0])
    _, turned = derivative(case, creepage=[0.0, 1.0])
    assert base["elements"]["stick"] == 0
    assert by_load["creep_force"][0] == pytest.approx(-0.3, rel=1e-4)
    assert abs(by_creepage["creep_force"][0]) < 1e-4 * 0.3 * 8e4
    assert turned["creep_force"][1] == pytest.approx(-0.3 * 8e4, rel=1e-2)


def test_full_sliding_by_the_coefficient() -> None:
    """Creep force -mu F, to the share of the elastic slip."""
    case = patch_case(CURVATURES, force=8e4, elements=12, creepage=[1.0, 0.0], tolerance=1e-12)
    _, change = derivative(case, friction_coefficient=1.0)
    assert change["creep_force"][0] == pytest.approx(-8e4, rel=1e-4)


@pytest.mark.parametrize("method", [{}, {"normal": "hertz", "tangential": "fastsim"}])
def test_friction_and_creepages_scale_together(method: dict[str, str]) -> None:
    """Tractions are homogeneous of degree 1 in coefficient and creepages, their power of degree 2
    (Euler's theorem); FASTSIM by differences, where an element may change its state."""
    motion = {"creepage": [8e-4, -5e-4], "spin": 0.2}
    case = patch_case(CURVATURES, force=8e4, elements=14, tolerance=1e-12, **motion, **method)
    base, change = derivative(
        case,
        friction_coefficient=case["friction"]["coefficient"],
        creepage=motion["creepage"],
        spin_creepage=motion["spin"],
    )
    bound = 1e-3 if method else 1e-9
    for name, degree in (("creep_force", 1), ("spin_moment", 1), ("friction_power", 2)):
        wanted = degree * numbers(base, name)
        assert numbers(change, name) == pytest.approx(wanted, rel=bound), name
    _, alone = derivative(case, friction_coefficient=1.0)
    assert np.linalg.norm(alone["creep_force"]) > 0.1 * np.linalg.norm(base["creep_force"])


def test_only_coulombs_law_has_a_coefficient() -> None:
    contact = railpatch.Contact({**PLAIN, "friction": SLIP_LAW})
    contact.step()
    with pytest.raises(CaseError, match="friction_coefficient"):
        contact.differentiate(friction_coefficient=1.0)


def test_no_creepage_gives_the_linear_slope() -> None:
    """All of the contact sticks: the force is linear in small creepages, with Kalker's slope to the
    error of the grid (5 % at 16 elements across, halved at twice as many)."""
    grid = {"elements": 32, "creepage": [0.0, 0.0], "tolerance": 1e-12}
    ellipse = {"semi_axes": [6e-3, 4e-3]}
    case = patch_case(ellipse, force=8e4, **grid)
    linear = patch_case(
        ellipse, force=8e4, elements=8, creepage=[0, 0], normal="hertz", tangential="linear"
    )
    for unit, index in (([1.0, 0.0], 0), ([0.0, 1.0], 1)):
        _, change = derivative(case, creepage=unit)
        linear["motion"]["creepage"] = [1e-6 * u for u in unit]
        slope = railpatch.solve(linear)["creep_force"][index] / 1e-6
        assert change["creep_force"][index] == pytest.approx(slope, rel=0.04)
        tiny = patch_case(ellipse, force=8e4, **{**grid, "creepage": [1e-9 * u for u in unit]})
        small = railpatch.solve(tiny)["creep_force"][index] / 1e-9
        assert change["creep_force"][index] == pytest.approx(small, rel=1e-8)


def test_no_friction_and_standstill_give_no_rate() -> None:
    for friction, speed in ((0.0, 10.0), (0.3, 0.0)):
        case = patch_case(
            CURVATURES,
            force=8e4,
            elements=10,
            creepage=[1e-3, 1e-3],
            friction=friction,
            speed=speed,
        )
        _, change = derivative(case, creepage=[1.0, 1.0], normal_force=1.0)
        assert change["creep_force"] == [0.0, 0.0]
        assert change["approach"] > 0


# --- what the call leaves alone -------------------------------------------------------------------

PLAIN = patch_case(
    CURVATURES, force=8e4, elements=14, creepage=[8e-4, -5e-4], spin=0.2, derivatives=True
)
SLIP_LAW = {"law": "slip_velocity", "kinetic": 0.2, "amplitude": 0.2, "halving_speed": 0.5}
SCENES: dict[str, Callable[[], dict[str, Any]]] = {
    "exact": lambda: PLAIN,
    "slip law": lambda: {**PLAIN, "friction": SLIP_LAW},
    "fastsim": lambda: {**PLAIN, "method": {"tangential": "fastsim", "derivatives": True}},
    "fitted": lambda: {**PLAIN, "grid": {"elements": [14, 14], "fitted": [10, 10]}},
    "unlike": lambda: {**PLAIN, "material": {"shear_modulus": [82e9, 30e9], "poisson_ratio": 0.28}},
    "transient": lambda: {
        **PLAIN,
        "grid": {"element_size": [8e-4, 8e-4], "max_elements": [24, 24]},
        "motion": {**PLAIN["motion"], "regime": "transient_rolling", "distance": 4e-4, "steps": 1},
    },
}


@pytest.mark.parametrize("name", SCENES)
def test_steps_and_state_stay_the_same(name: str) -> None:
    plain, used = (railpatch.Contact(SCENES[name]()) for _ in range(2))
    for scale in (1.0, 1.02, 0.97):
        inputs = {"normal_force": 8e4 * scale, "creepage": [8e-4 * scale, -5e-4]}
        expected, result = plain.step(**inputs).to_dict(), used.step(**inputs).to_dict()
        for skipped in ("wall_time",):
            del expected[skipped], result[skipped]
        assert result == expected
        first = used.differentiate(creepage=[1.0, 0.3], normal_force=1e6)
        second = used.differentiate(creepage=[1.0, 0.3], normal_force=1e6)
        assert first["kind"] == ("exact" if name == "exact" else "differences")
        for k in OUTPUTS:
            assert np.array_equal(numbers(first, k), numbers(second, k), equal_nan=True), k
        assert used.save() == plain.save()


@pytest.mark.parametrize("name", [name for name in SCENES if name != "exact"])
def test_differences_match_differences_from_outside(name: str) -> None:
    """Steps of a contact of its own, each from the state before the step."""
    case = SCENES[name]()
    case = {**case, "method": {**case["method"], "tolerance": 1e-10}}
    contact, other = railpatch.Contact(case), railpatch.Contact(case)
    contact.step()
    other.step()
    state = other.save()
    inputs = {"normal_force": 8.1e4, "creepage": [8.2e-4, -5e-4]}
    contact.step(**inputs)
    change = contact.differentiate(creepage=[1.0, 0.5])
    length = 1e-7
    ends = []
    for sign in (1, -1):
        other.restore(state)
        pair = [8.2e-4 + sign * length, -5e-4 + 0.5 * sign * length]
        ends.append(other.step(normal_force=8.1e4, creepage=pair))
    for output in ("creep_force", "spin_moment"):
        high, low, rate = (numbers(r, output) for r in (*ends, change))
        difference = (high - low) / (2 * length)
        # differences over 1e-3 and over 1e-4 of the creepage meet but for elements that change
        assert np.linalg.norm(rate - difference) < 0.02 * np.linalg.norm(difference), output


def test_refusals() -> None:
    contact = railpatch.Contact(patch_case(CURVATURES, force=8e4, elements=10, creepage=[0, 0]))
    contact.step()
    with pytest.raises(CaseError, match=r"method\.derivatives: value is False"):
        contact.differentiate(normal_force=1.0)
    contact = railpatch.Contact(PLAIN)
    with pytest.raises(CaseError, match="needs a step"):
        contact.differentiate(normal_force=1.0)
    contact.step()
    contact.differentiate(normal_force=1.0)
    for wrong, message in (
        ({"direction": 1}, "direction: value is 1"),
        ({"approach": 1.0}, "approach: value is 1.0"),
        ({"creepage": [1.0]}, "creepage: value is"),
        ({"spin_creepage": math.nan}, "spin_creepage: value is nan"),
        ({"normal_force": "1"}, "normal_force: value is '1'"),
    ):
        with pytest.raises(CaseError, match=message):
            contact.differentiate(**wrong)
    contact.reset()
    with pytest.raises(CaseError, match="needs a step"):
        contact.differentiate(normal_force=1.0)
