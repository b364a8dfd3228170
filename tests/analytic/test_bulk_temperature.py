"""Bulk temperature in a run: each body is one mass that the contacts' heat warms and the air cools,
m c dT/dt = F + G (T_other - T) - H (T - T_air). With the heat F of friction and the exchange G held
over a step its solution is that of a linear system."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import railpatch
from bulk_samples import HEAT_CAPACITY, exchange_of, lumped
from case_samples import with_values

EFFUSIVITY = np.sqrt(50.0 * 450.0 * 7850.0)
AIR = 15.0


def wheel(**values: Any) -> dict[str, Any]:
    case: dict[str, Any] = {
        "kind": "wheel_rail",
        "grid": {"element_size": [8e-4, 8e-4]},
        "friction": {"coefficient": 0.3},
        "temperature": {
            "wheel": 60.0,
            "rail": 20.0,
            "bulk": {
                "mass": [3.0, 5.0],
                "air_conductance": [12.0, 30.0],
                "air_temperature": AIR,
            },
        },
        "method": {"tolerance": 1e-7},
        "wheelset": {
            "vertical_force": 6e4,
            "speed": 20.0,
            "pitch_rate": -20.0 / 0.46 * 1.02,
            "nominal_radius": 0.46,
            "flange_back_distance": 1.36,
            "flange_back_position": -0.07,
        },
        "track": {"kind": "rail", "gauge": 1.435, "gauge_height": 0.014},
        "profiles": {"wheel": "S1002", "rail": "UIC60@1:40"},
        "wheel": {"side": "left"},
    }
    return with_values(case, **values)


@pytest.mark.parametrize("conductance", [[12.0, 30.0], [0.0, 0.0], [0.0, 30.0]])
def test_steps_follow_the_closed_form(conductance: list[float]) -> None:
    """And heat of friction is what the bodies store and what the air takes, step by step."""
    case = wheel(temperature__bulk__air_conductance=conductance)
    if not any(conductance):
        del case["temperature"]["bulk"]["air_temperature"]
    contact = railpatch.Contact(case)
    before = contact.step(time_step=0.0)
    assert before.status == "converged"
    assert before["wheel_temperature"] == 60.0
    capacity = np.array([3.0, 5.0]) * HEAT_CAPACITY
    friction, kept = 0.0, 0.0
    for time in (1e-3, 0.5, 4.0, 30.0, 0.0, 20.0):
        after_it = contact.step(time_step=time)
        assert after_it.status == "converged"
        wanted, lost = lumped(case["temperature"]["bulk"], before, time)
        found = np.array([after_it[f"{body}_temperature"] for body in ("wheel", "rail")])
        # the exchange is read from a difference of heat flows
        np.testing.assert_allclose(found, wanted, rtol=1e-9)
        started = [before[f"{body}_temperature"] for body in ("wheel", "rail")]
        friction += before["friction_power"] * time
        kept += (capacity * (found - started)).sum() + lost.sum()
        # temperatures are rounded: so is the heat that the bodies hold
        rounded = 4 * np.finfo(float).eps * (capacity * np.abs(found)).sum()
        assert kept == pytest.approx(friction, rel=1e-9 if any(conductance) else 1e-12, abs=rounded)
        before = after_it


def test_no_step_is_too_long() -> None:
    """Bodies of half a gram beside a contact that levels them within milliseconds: a step of any
    length goes to the balance, where both are as warm as friction and the air make them, and the
    next one stays."""
    case = wheel(temperature__bulk={"mass": [0.0004, 0.0005], "air_conductance": [40.0, 60.0],
                                    "air_temperature": AIR})  # fmt: skip
    contact = railpatch.Contact(case)
    first = contact.step()
    g, friction = exchange_of(first), 0.5 * first["friction_power"]
    assert 0.0004 * HEAT_CAPACITY / g < 0.01
    balance = np.linalg.solve([[g + 40.0, -g], [-g, g + 60.0]],
                              [friction + 40.0 * AIR, friction + 60.0 * AIR])  # fmt: skip
    for time in (1e3, 1e9, 1e3):
        result = contact.step(time_step=time)
        assert result.status == "converged"
        found = [result["wheel_temperature"], result["rail_temperature"]]
        np.testing.assert_allclose(found, balance, rtol=1e-6)


def test_steps_converge_with_their_length() -> None:
    """Friction that falls with temperature is held over a step: first order in time, against
    steps an eighth as long as the shortest."""
    law = {"law": "temperature", "reference": 0.35, "change": -0.2, "reference_temperature": 20.0,
           "temperature_range": 400.0}  # fmt: skip
    case = wheel(friction=law, temperature__bulk__mass=[0.5, 0.8],
                 grid={"element_size": [1.6e-3, 1.6e-3]})  # fmt: skip

    def end(steps: int) -> float:
        contact = railpatch.Contact(case)
        contact.step()
        for _ in range(steps):
            result = contact.step(time_step=16.0 / steps)
        return result["wheel_temperature"]

    fine = end(64)
    coarse, half = abs(end(4) - fine), abs(end(8) - fine)
    # of first order, whose reference errs too: (1/4 - 1/64)/(1/8 - 1/64) = 15/7
    assert coarse / half == pytest.approx(15 / 7, rel=0.15)


def test_heat_is_that_of_friction_and_of_the_other_body() -> None:
    """Both together take all of friction; what one gives, the other gets: in rows that touch once
    B (T_rail - T_wheel) V 2 sqrt(L/(pi V)) of a row's width (Ertz and Knothe 2002), B the product
    of the effusivities over their sum."""
    result = railpatch.solve(wheel(), fields=True)
    patch = result["patches"][0]
    assert len(result["patches"]) == 1
    assert result["wheel_heat"] + result["rail_heat"] == pytest.approx(
        result["friction_power"], rel=1e-9
    )
    speed = patch["rolling_speed"]
    touching = np.array(patch["pressure"]) > 0
    dx, dy = patch["x"][1] - patch["x"][0], patch["y"][1] - patch["y"][0]
    length = touching.sum(axis=1) * dx
    passed = 0.5 * EFFUSIVITY * 40.0 * speed * (2 * np.sqrt(length / (np.pi * speed))).sum() * dy
    assert passed > 100.0
    half = 0.5 * result["friction_power"]
    assert result["wheel_heat"] == pytest.approx(half - passed, rel=1e-9)
    assert result["rail_heat"] == pytest.approx(half + passed, rel=1e-9)


def test_tends_to_the_balance_with_the_air() -> None:
    """Long after: heat and air in balance, and friction that falls with temperature with it."""
    law = {"law": "temperature", "reference": 0.35, "change": -0.2, "reference_temperature": 20.0,
           "temperature_range": 400.0}  # fmt: skip
    case = wheel(friction=law, temperature__wheel=20.0, temperature__bulk__mass=[4.0, 0.0],
                 temperature__bulk__air_conductance=[40.0, 0.0])  # fmt: skip
    contact = railpatch.Contact(case)
    first = contact.step()
    for _ in range(60):
        last = contact.step(time_step=6.0)
    assert last.status == "converged"
    assert last["rail_temperature"] == 20.0
    balance = 40.0 * (last["wheel_temperature"] - AIR)
    assert last["wheel_heat"] == pytest.approx(balance, rel=1e-6)
    assert last["wheel_temperature"] > first["wheel_temperature"] + 20
    assert last["max_temperature"] > first["max_temperature"]
    assert last["friction_power"] < first["friction_power"]
    # the same as a case whose wheel is given that warm
    given = wheel(friction=law, temperature={"wheel": last["wheel_temperature"], "rail": 20.0})
    same = railpatch.solve(given)
    assert same["friction_power"] == pytest.approx(last["friction_power"], rel=1e-5)


def test_state_and_reset() -> None:
    contact = railpatch.Contact(wheel())
    first = contact.step(time_step=2.0)["wheel_temperature"]
    contact.step()
    state = contact.save()
    other = railpatch.Contact(wheel())
    other.restore(state)
    a, b = contact.step(), other.step()
    for key in ("wheel_temperature", "rail_temperature", "wheel_heat", "force"):
        assert a[key] == b[key]
    assert a["wheel_temperature"] != first
    contact.reset()
    assert contact.step()["wheel_temperature"] == first == 60.0


def test_wheels_of_a_wheelset_have_their_own() -> None:
    case = {**wheel(), "kind": "wheelset"}
    del case["wheel"]
    case["wheelset"] |= {"vertical_force": 1.2e5, "y": 0.003}
    contact = railpatch.Contact(case)
    for _ in range(3):
        result = contact.step(time_step=5.0)
    assert result.status == "converged"
    left, right = (result[side]["wheel_temperature"] for side in ("left", "right"))
    assert abs(left - right) > 0.1
    assert result["wheel_heat"] == pytest.approx(
        sum(result[side]["wheel_heat"] for side in ("left", "right")), rel=1e-12
    )


@pytest.mark.parametrize(
    ("changes", "key"),
    [
        ({"temperature__bulk": {"mass": 0.0}}, "mass"),
        ({"temperature__bulk": {"mass": [1.0, 0.0], "air_conductance": 2.0}}, "air_conductance"),
        ({"temperature__bulk": {"mass": 1.0, "air_temperature": 3.0}}, "air_temperature"),
        ({"temperature__bulk": {"mass": -1.0}}, "mass"),
    ],
)
def test_what_does_nothing_is_refused(changes: dict[str, Any], key: str) -> None:
    with pytest.raises(railpatch.CaseError, match=rf"temperature\.bulk.*{key}"):
        railpatch.Contact(wheel(**changes))


def test_a_single_solve_says_that_no_time_passes() -> None:
    case = wheel()
    alone = railpatch.solve(case)
    (note,) = alone["notes"]
    assert note.startswith("temperature.bulk: no time passes")
    del case["temperature"]["bulk"]
    without = railpatch.solve(case)
    assert "notes" not in without.data
    assert alone["wheel_heat"] == without["wheel_heat"]


def test_a_found_temperature_is_no_input() -> None:
    contact = railpatch.Contact(wheel())
    with pytest.raises(railpatch.CaseError, match=r"temperature\.wheel"):
        contact.step(temperature={"wheel": 30.0})
