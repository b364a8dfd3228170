"""What engineers read of a result, computed again from its other numbers and fields."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from railpatch import Contact, solve
from railpatch.profiles import load_profile

WHEELSET = {
    "kind": "wheelset",
    "wheelset": {"y": 0.003, "vertical_force": 120e3, "speed": 20.0, "yaw": 2e-3,
                 "pitch_rate": -20 / 0.46, "nominal_radius": 0.46, "roll": "balanced",
                 "flange_back_distance": 1.36, "flange_back_position": -0.07},
    "track": {"kind": "rail", "gauge": 1.435, "gauge_height": 0.014},
    "profiles": {"wheel": "S1002", "rail": "UIC60@1:40"},
    "friction": {"coefficient": 0.3},
}  # fmt: skip
LAW = {"law": "slip_velocity", "kinetic": 0.2, "amplitude": 0.2, "halving_speed": 0.01}


def patch(**tables: Any) -> dict[str, Any]:
    """A rolling ellipse, with some tables changed."""
    return {
        "kind": "patch",
        "geometry": {"semi_axes": [0.006, 0.004]},
        "load": {"normal_force": 8e4},
        "motion": {"regime": "steady_rolling", "creepage": [1e-3, -5e-4], "spin_creepage": 0.3,
                   "rolling_speed": 10.0},
        "friction": {"coefficient": 0.3},
        **tables,
    }  # fmt: skip


def wear_number(of: Any) -> float:
    """N, T gamma of Pearce and Sherratt (1991) with each product by its size."""
    forces = [*of["creep_force"], of["spin_moment"]]
    creepages = [*of["creepage"], of["spin_creepage"]]
    return sum(abs(force * creepage) for force, creepage in zip(forces, creepages, strict=True))


METHODS: list[dict[str, Any]] = [
    {},
    {"normal": "hertz"},
    {"normal": "hertz", "tangential": "fastsim"},
    {"normal": "kik_piotrowski", "tangential": "fastsim"},
    {"fitted": True},
    {"tangential": "polach"},
    {"tangential": "none"},
]


@pytest.mark.parametrize("method", METHODS, ids=str)
def test_a_patch_by_its_numbers_and_fields(method: dict[str, Any]) -> None:
    """Each theory; the ellipse's extent within an element, rows' and closed forms within 1 %."""
    case = patch(method=dict(method))
    if method.get("tangential") == "none":
        del case["friction"]
    if case["method"].pop("fitted", False):
        case["grid"] = {"fitted": [16, 16]}
    result = solve(case, fields=True)
    assert result.solved
    dx, dy = 0.012 / 24, 0.008 / 24
    np.testing.assert_allclose(result["contact_size"], [0.012, 0.008], atol=1.001 * max(dx, dy))
    if method.get("normal") == "hertz":
        np.testing.assert_allclose(result["contact_size"], [0.012, 0.008], rtol=1e-9)
    if method.get("tangential") == "none":
        for name in ("wear_number", "traction_coefficient", "utilised_friction", "max_traction"):
            assert result.to_dict()[name] is None, name
        return
    given = {**result.data, **case["motion"]}
    assert result["wear_number"] == pytest.approx(wear_number(given), rel=1e-12)
    force = np.hypot(*result["creep_force"])
    assert result["traction_coefficient"] == pytest.approx(force / 8e4, rel=1e-4)
    assert result["utilised_friction"] == pytest.approx(force / (0.3 * 8e4), rel=1e-4)
    if method.get("tangential") == "polach":
        assert result.to_dict()["max_traction"] is None
    else:
        greatest = np.hypot(*result["traction"]).max()
        assert result["max_traction"] == pytest.approx(greatest, rel=1e-12)


@pytest.mark.parametrize(
    "friction",
    [LAW, {"coefficient": 0.3, "factor": [[-0.004, 0.5], [0.0, 1.0], [0.004, 1.5]]}],
    ids=["slip velocity", "factor"],
)
def test_utilised_friction_by_the_elements_own(friction: dict[str, Any]) -> None:
    """What friction could carry is the sum over elements, not one coefficient times the force."""
    result = solve(patch(friction=friction), fields=True)
    x, y, pressure = (np.asarray(result[name]) for name in ("x", "y", "pressure"))
    area = (x[1] - x[0]) * (y[1] - y[0])
    if "factor" in friction:
        points = np.array(friction["factor"])
        coefficient = 0.3 * np.interp(y, *points.T)[:, None] * np.ones_like(pressure)
    else:
        coefficient = np.asarray(result["friction"])
        assert np.ptp(coefficient[pressure > 0]) > 0.01
    capacity = float(np.sum(coefficient * pressure)) * area
    used = np.hypot(*result["creep_force"]) / capacity
    assert result["utilised_friction"] == pytest.approx(used, rel=1e-9)
    assert 0 < used <= 1 + 1e-9


def test_nothing_touches() -> None:
    """Extent and wear number are zero, what has no meaning is left out."""
    found = solve(patch(load={"normal_force": 0.0})).to_dict()
    assert found["wear_number"] == 0
    assert found["contact_size"] == [0, 0]
    assert found["traction_coefficient"] is None
    assert found["utilised_friction"] is None


def test_a_wheelset_by_its_forces_and_places() -> None:
    """Y, Q, sums, rolling radii; contact references lie on the profiles as their files have them.

    The rail's reference is on its surface; the wheel's lies the approach below it, on the wheel
    within what the greatest approach of the patch differs from that at the reference.
    """
    result = solve(WHEELSET)
    assert result.solved
    sums = 0.0
    for side, outward in (("left", 1.0), ("right", -1.0)):
        found = result[side]
        assert found["guiding_force"] == outward * found["force"][1]
        assert found["wheel_load"] == -found["force"][2]
        quotient = found["guiding_force"] / found["wheel_load"]
        assert found["derailment_quotient"] == pytest.approx(quotient, rel=1e-14)
        for one in found["patches"]:
            assert one["wear_number"] == pytest.approx(wear_number(one), rel=1e-12)
        sums += found["wear_number"]
    assert result["wear_number"] == pytest.approx(sums, rel=1e-14)
    difference = result["right"]["rolling_radius"] - result["left"]["rolling_radius"]
    assert difference > 0
    assert result["rolling_radius_difference"] == difference
    assert result["conicity"] == pytest.approx(difference / (2 * 0.003), rel=1e-12)
    assert 0.01 < result["conicity"] < 0.5
    middle = {**WHEELSET, "wheelset": {**WHEELSET["wheelset"], "y": 0.0, "yaw": 0.0}}
    assert solve(middle).to_dict()["conicity"] is None


@pytest.mark.parametrize("name", ["wheel", "rail"])
def test_places_are_on_the_profiles(name: str) -> None:
    """Both sides, with a wheel and a rail that are turned and moved from their design."""
    moved = {"offset": [0.0, 1e-3, -4e-4], "rotation": [4e-3, 0.0, 0.0]}
    case = {
        **WHEELSET,
        "wheelset": {**WHEELSET["wheelset"], "right": moved},
        "track": {**WHEELSET["track"], "cant": 0.025, "left": moved},
    }
    result = solve(case)
    profile = load_profile(WHEELSET["profiles"][name], name)
    order = np.argsort(profile.y)
    y, z = profile.y[order], profile.z[order]
    for side in ("left", "right"):
        for one in result[side]["patches"]:
            at = one[f"{name}_profile_position"]
            error = abs(np.interp(at[0], y, z) - at[1])
            assert error < (2e-6 if name == "rail" else 3e-5), (side, at, error)
            assert abs(at[0]) < 0.04


def test_mirror() -> None:
    """The mirror image has the same numbers, on the other side."""
    turned = {**WHEELSET["wheelset"], "y": -0.003, "yaw": -2e-3}
    right, left = solve(WHEELSET), solve({**WHEELSET, "wheelset": turned})
    for name in ("guiding_force", "wheel_load", "derailment_quotient", "wear_number"):
        assert right["right"][name] == left["left"][name]
    for name in ("wheel_profile_position", "rail_profile_position", "contact_size"):
        assert right["right"]["patches"][0][name] == left["left"]["patches"][0][name]
    assert right["conicity"] == left["conicity"]
    assert right["rolling_radius_difference"] == -left["rolling_radius_difference"]


def test_derivatives() -> None:
    """Exact ones of Y, Q, Y/Q, T gamma, places, radii against differences of solutions."""
    balanced = solve(WHEELSET)
    case = {
        **WHEELSET,
        "wheelset": {**WHEELSET["wheelset"], **{key: balanced[key] for key in ("roll", "z")}},
        "method": {"derivatives": True, "tolerance": 1e-9},
        "grid": {"elements": [12, 12]},
    }
    del case["wheelset"]["vertical_force"]
    contact = Contact(case)
    contact.step()
    rates = contact.differentiate(vy=1.0, y=0.0)
    assert rates["kind"] == "exact"
    step = 1e-7
    values = [Contact(case).step(vy=sign * step) for sign in (-1, 1)]
    for side in ("left", "right"):
        for name in ("guiding_force", "derailment_quotient", "wear_number"):
            low, high = (value[side][name] for value in values)
            assert rates[side][name] == pytest.approx((high - low) / (2 * step), rel=2e-3), name
        found = rates[side]["patches"][0]
        low, high = (value[side]["patches"][0]["utilised_friction"] for value in values)
        assert found["utilised_friction"] == pytest.approx((high - low) / (2 * step), rel=2e-3)
        assert np.isnan(found["max_traction"])
    rates = contact.differentiate(y=1.0)
    values = [Contact(case).step(y=0.003 + sign * step) for sign in (-1, 1)]
    low, high = (value["rolling_radius_difference"] for value in values)
    assert rates["rolling_radius_difference"] == pytest.approx((high - low) / (2 * step), rel=2e-3)
    low, high = (value["conicity"] for value in values)
    assert rates["conicity"] == pytest.approx((high - low) / (2 * step), rel=2e-3)
    for side in ("left", "right"):
        for name in ("wheel_profile_position", "rail_profile_position", "contact_size"):
            low, high = (np.array(value[side]["patches"][0][name]) for value in values)
            slope = (high - low) / (2 * step)
            found = np.array(rates[side]["patches"][0][name])
            np.testing.assert_allclose(found, slope, rtol=5e-3, atol=2e-4, err_msg=name)
