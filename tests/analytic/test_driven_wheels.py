"""Wheels whose pitch rate is found: by the torque about the axle, or by the longitudinal force.

Checked against cases with the pitch rate given: bisection on the reported force and torque, which
shares nothing with the search; a freely rolling wheel, whose creep force along the track is then 0;
and derivatives by differences.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import railpatch
from case_samples import WHEELSET, with_values
from railpatch.case.load import load_scene
from railpatch.contact import at_balance

SINGLE = with_values(
    WHEELSET,
    kind="wheel_rail",
    wheel={"side": "right"},
    grid=None,
    wheelset__z=None,
    wheelset__vertical_force=6e4,
    wheelset__y=1.5e-3,
    wheelset__yaw=1e-3,
    wheelset__speed=20.0,
    wheelset__pitch_rate="free",
    method={"tolerance": 1e-7},
)
PAIR = with_values(SINGLE, kind="wheelset", wheel=None, wheelset__vertical_force=1.2e5)
ROLLER = with_values(
    SINGLE,
    wheelset__speed=0.0,
    track={
        "kind": "roller",
        "roller_radius": 0.4,
        "roller_pitch_rate": 50.0,
        "gauge": 1.435,
        "gauge_height": 0.014,
    },
    profiles__rail="UIC60@1:40",
)
CASES = {"wheel": SINGLE, "wheelset": PAIR, "roller": ROLLER}


def along(result: railpatch.Result) -> float:
    """N, of all wheels along the track."""
    sides = [result[s] for s in ("left", "right")] if "left" in result.data else [result]
    return float(sum(side["force"][0] for side in sides))


@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize("force", [0.0, 4e3, -9e3])
def test_the_longitudinal_force_is_found(name: str, force: float) -> None:
    """And the wheel that turns so fast by itself has it."""
    case = with_values(CASES[name], wheelset__longitudinal_force=force)
    result = railpatch.solve(case)
    load = case["wheelset"]["vertical_force"]
    assert result.status == "converged"
    assert along(result) == pytest.approx(force, abs=1e-5 * load)
    given = with_values(CASES[name], wheelset__pitch_rate=result["pitch_rate"])
    assert along(railpatch.solve(given)) == pytest.approx(force, abs=1e-5 * load)
    if name == "wheel" and force == 0:
        # the only force along a level rail is that of creep
        patch = result["patches"][0]["creep_force"]
        assert abs(patch[0]) < 1e-4 * abs(patch[1])


@pytest.mark.parametrize("name", CASES)
def test_by_bisection(name: str) -> None:
    """The same pitch rate as halving finds it with the rate given."""
    for key, target in (("longitudinal_force", 3e3), ("axle_torque", 1.5e3)):
        found = railpatch.solve(with_values(CASES[name], **{f"wheelset__{key}": target}))
        assert found.status == "converged"
        middle, width = found["pitch_rate"], 2e-3 * abs(found["pitch_rate"])
        low, high = middle - width, middle + width
        contact = railpatch.Contact(
            with_values(PAIR if name == "wheelset" else CASES[name], wheelset__pitch_rate=low)
        )
        for _ in range(24):
            rate = 0.5 * (low + high)
            step = contact.step(pitch_rate=rate)
            if key == "longitudinal_force":
                value = along(step)
            else:
                sides = [step[s] for s in ("left", "right")] if name == "wheelset" else [step]
                roll, yaw = CASES[name]["wheelset"].get("roll", 0.0), 1e-3
                axis = np.array(
                    [-np.sin(yaw) * np.cos(roll), np.cos(yaw) * np.cos(roll), np.sin(roll)]
                )
                value = sum(float(axis @ side["moment"]) for side in sides)
            # turning forward faster drives ahead
            low, high = (rate, high) if value > target else (low, rate)
        assert 0.5 * (low + high) == pytest.approx(middle, rel=2e-8)


def test_torque_and_force_of_one_wheel() -> None:
    """The torque is about the rolling radius times the force, and drives where it is above 0."""
    result = railpatch.solve(with_values(SINGLE, wheelset__axle_torque=2e3))
    assert result["axle_torque"] == pytest.approx(2e3, abs=0.05)
    assert along(result) == pytest.approx(2e3 / 0.46, rel=0.02)
    free = railpatch.solve(SINGLE)
    assert free["axle_torque"] == pytest.approx(0.0, abs=0.05)
    assert result["pitch_rate"] < free["pitch_rate"] < 0


@pytest.mark.parametrize("name", ["wheel", "wheelset"])
@pytest.mark.parametrize("key", ["longitudinal_force", "axle_torque"])
def test_derivatives(name: str, key: str) -> None:
    case = with_values(
        CASES[name], **{f"wheelset__{key}": 2e3}, method={"tolerance": 1e-10, "derivatives": True}
    )
    contact = railpatch.Contact(case)
    contact.step()
    for moved, size in ((key, 1.0), ("y", 1e-7), ("vertical_force", 10.0)):
        rates = contact.differentiate(**{moved: 1.0})
        assert rates["kind"] == "exact"
        start = case["wheelset"][moved]
        both = [
            railpatch.solve(with_values(case, **{f"wheelset__{moved}": start + sign * size}))
            for sign in (1, -1)
        ]
        difference = (both[0]["pitch_rate"] - both[1]["pitch_rate"]) / (2 * size)
        assert rates["pitch_rate"] == pytest.approx(difference, rel=2e-3), moved
        if moved == "longitudinal_force":
            sides = [rates[s] for s in ("left", "right")] if name == "wheelset" else [rates]
            assert sum(side["force"][0] for side in sides) == pytest.approx(1.0, rel=1e-6)


def test_steps_and_what_friction_cannot_carry() -> None:
    contact = railpatch.Contact(with_values(SINGLE, wheelset__longitudinal_force=0.0))
    for force in (1e3, -5e3, 1.2e4, 0.0):
        assert along(contact.step(longitudinal_force=force)) == pytest.approx(force, abs=0.6)
    # 0.3 times 60 kN
    beyond = contact.step(longitudinal_force=2.5e4)
    assert beyond.status != "converged"
    assert "longitudinal_force is greater than what friction can carry" in beyond.reason


@pytest.mark.parametrize(
    ("change", "key"),
    [
        ({"wheelset__pitch_rate": -43.0, "wheelset__axle_torque": 1.0}, "wheelset.axle_torque"),
        (
            {"wheelset__pitch_rate": -43.0, "wheelset__longitudinal_force": 1.0},
            "longitudinal_force",
        ),
        (
            {"wheelset__axle_torque": 1.0, "wheelset__longitudinal_force": 1.0},
            "wheelset.axle_torque",
        ),
        ({"method__tangential": "none", "friction": None}, "wheelset.pitch_rate"),
        ({"wheelset__roll": "balanced"}, "wheelset.roll"),
    ],
)
def test_what_is_refused(change: dict[str, Any], key: str) -> None:
    with pytest.raises(railpatch.CaseError, match=key.replace(".", r"\.")):
        railpatch.Contact(with_values(SINGLE, **change))


def test_numbers_of_a_balance() -> None:
    """As an FMU of the scene starts: the rate that was found in place of what it was found by."""
    scene = load_scene(with_values(SINGLE, wheelset__longitudinal_force=2e3))
    numbers = at_balance(scene, "wheel").case.wheelset
    assert numbers.longitudinal_force is None
    found = railpatch.solve(with_values(SINGLE, wheelset__longitudinal_force=2e3))
    assert numbers.pitch_rate == found["pitch_rate"]


@pytest.mark.parametrize("key", ["axle_torque", "longitudinal_force"])
@pytest.mark.parametrize("name", CASES)
def test_more_than_friction_carries_is_refused_with_what_it_can(name: str, key: str) -> None:
    """The bound: Coulomb's law, friction coefficient times normal forces, about the axle by the
    rolling radius, which is the nominal one but for the contact's place on the profile."""
    case = CASES[name]
    load = case["wheelset"]["vertical_force"]
    most = 0.3 * load * (1 if key == "longitudinal_force" else 0.46)
    result = railpatch.solve(with_values(case, **{f"wheelset__{key}": -1.2 * most}))
    assert result["status"] == "out_of_range"
    # contacts are inclined: the normal force is a little more than the load
    text, _, value = result.reason.rpartition("(")
    assert float(value.rstrip(")")) == pytest.approx(most, rel=0.01)
    assert f"wheelset.{key} is greater than what friction can carry" in text
    below = railpatch.solve(with_values(case, **{f"wheelset__{key}": -0.8 * most}))
    assert below["status"] == "converged"


@pytest.mark.parametrize("name", CASES)
def test_what_stands_still_has_no_pitch_rate(name: str) -> None:
    case = with_values(CASES[name], wheelset__speed=0.0)
    if name == "roller":
        case = with_values(case, track__roller_pitch_rate=0.0)
    with pytest.raises(railpatch.CaseError, match="0 where pitch_rate is free or found"):
        railpatch.solve(case)
