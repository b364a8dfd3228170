"""Conformal contact that rolls on from step to step.

Steps of one element at a constant motion settle on steady rolling, whose difference over an element
is the same: forces, power and energy. Sums over rows of other curves: tests/cpp/test_conformal.cpp.
Two equal convex arcs have a straight curve midway between them: there every step is the plane's.
"""

from __future__ import annotations

import copy
from typing import Any

import numpy as np
import pytest
import railpatch
from case_samples import with_values
from conformal_samples import PLACES, wheel_case
from law_samples import LAWS

SIZE = 1e-3  # m, of the elements
GOES = ("coulomb", "exponential", "memory", "factor", "elastic layer", "falling on a layer")


def curved_case(y: float, **options: Any) -> dict[str, Any]:
    case = wheel_case(y, "full", tolerance=1e-9, spin_offset="none", **options)
    case["grid"] = {"element_size": [SIZE, SIZE]}
    alone = with_values(case, method__tangential="none", method__spin_offset=None, friction=None)
    z = railpatch.solve(alone)["z"]
    case["wheelset"] |= {"z": z, "pitch_rate": -20 / 0.4625}
    del case["wheelset"]["vertical_force"]
    return case


def rolling(case: dict[str, Any], step: float) -> dict[str, Any]:
    wheelset = {**case["wheelset"], "time_step": step}
    return {**case, "wheelset": wheelset, "motion": {"regime": "transient_rolling"}}


@pytest.mark.parametrize("y", PLACES)
def test_settles_on_steady_rolling(y: float) -> None:
    case = curved_case(y)
    steady = railpatch.solve(case)
    (patch,) = steady["patches"]
    contact = railpatch.Contact(rolling(case, SIZE / patch["rolling_speed"]))
    for _ in range(60):
        result = contact.step()
    assert result.status == "converged"
    size = 0.3 * patch["normal_force"]
    assert np.abs(np.subtract(result["force"], steady["force"])).max() < 1e-6 * size
    (now,) = result["patches"]
    for name in ("creep_power", "elastic_energy", "pressure_energy"):
        assert now[name] == pytest.approx(patch[name], rel=1e-5), name
    # both by the mean of a step's tractions
    assert now["friction_power"] == pytest.approx(patch["friction_power"], rel=1e-6)


def arcs(law: str, surface: str) -> dict[str, Any]:
    case = {**wheel_case(0.0, "full", surface), **copy.deepcopy(LAWS[law])}
    if law in ("exponential", "falling on a layer"):
        # in short steps elasticity follows no steeper fall
        case["friction"]["halving_speed"] = 1.0
    case["profiles"] = {"wheel": "arc@0.3", "rail": "arc@0.3"}
    case["track"] = {"gauge": 1.36}
    case["wheelset"] |= {"yaw": 0.0, "vy": 0.02, "yaw_rate": 0.3}
    case["grid"] = {"element_size": [SIZE, SIZE]}
    case["method"] |= {"tolerance": 1e-10, "patch_rule": "contact"}
    return case


# of less than one element, and of several
@pytest.mark.parametrize("step", [0.4 * SIZE / 20, 3.3 * SIZE / 20])
@pytest.mark.parametrize("law", GOES)
def test_a_straight_curve_rolls_as_the_plane(law: str, step: float) -> None:
    plane, curved = (
        railpatch.Contact(rolling(arcs(law, surface), step)) for surface in ("plane", "curved")
    )
    for n in range(4):
        motion = {"vy": 0.02 + 0.01 * n, "yaw_rate": 0.3 + 0.1 * n}
        flat, bent = plane.step(**motion), curved.step(**motion)
        assert flat.status == bent.status == "converged"
        size = np.linalg.norm(flat["force"])
        assert np.abs(np.subtract(bent["force"], flat["force"])).max() < 1e-6 * size
        (a,), (b,) = flat["patches"], bent["patches"]
        for name in ("friction_power", "creep_power", "elastic_energy"):
            assert b[name] == pytest.approx(a[name], rel=1e-6), name


@pytest.mark.parametrize("y", PLACES)
def test_what_is_supplied_rubs_or_is_stored(y: float) -> None:
    """Stick alone takes nothing: the work of a first step is all stored, far below the bound."""
    case = curved_case(y)
    case["friction"] = {"coefficient": 1.0}
    contact = railpatch.Contact(rolling(case, 1e-3 * SIZE / 20))
    patch = contact.step()["patches"][0]
    slipping = patch["elements"]["slip"]
    assert patch["elements"]["stick"] > 5 * slipping
    assert 0 <= patch["friction_power"] < 0.3 * patch["elastic_energy"] / (1e-3 * SIZE / 20)


def test_state_goes_on_to_the_bit() -> None:
    contact = railpatch.Contact(rolling(curved_case(6.5e-3), 0.7 * SIZE / 20))
    moves = [{"y": 6.5e-3 + 2e-5 * n} for n in range(5)]
    for move in moves[:2]:
        contact.step(**move)
    state = contact.save()
    expected = [contact.step(**move)["force"] for move in moves[2:]]
    other = railpatch.Contact(rolling(curved_case(6.5e-3), 0.7 * SIZE / 20))
    other.restore(state)
    assert [other.step(**move)["force"] for move in moves[2:]] == expected


@pytest.mark.parametrize("regime", ["steady_rolling", "transient_rolling"])
def test_regimes_change_on_a_curve(regime: str) -> None:
    """Steps that begin steadily and go on: of one element at a constant motion nothing changes."""
    case = curved_case(6.5e-3)
    steady = railpatch.solve(case)
    step = SIZE / steady["patches"][0]["rolling_speed"]
    case = rolling(case, step)
    case["motion"] = {"regime": "steady_rolling", "regime_changes": True}
    contact = railpatch.Contact(case)
    contact.step(regime="steady_rolling")
    result = contact.step(regime=regime)
    size = 0.3 * steady["patches"][0]["normal_force"]
    assert np.abs(np.subtract(result["force"], steady["force"])).max() < 1e-6 * size
