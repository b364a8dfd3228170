"""A contact whose regime changes from step to step keeps its tractions.

Cattaneo's shift of a cylinder (Johnson 1985, section 7.2: stick over c = a (1 - Q/(mu P))^(1/2))
is followed by rolling, in which its tractions leave the contact and Carter's (1926) remain: force
mu P (1 - (1 - |xi| R/(mu a))^2), stick over 1 - |xi| R/(mu a) of the contact at its leading edge.
A step of steady rolling does not know what was before; a step of transient rolling over one element
has the same equations, so it leaves the steady tractions as they are.
"""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np
import pytest
import railpatch
from case_samples import PATCH, WHEELSET, with_values
from patch_cases import Line, check, solve

A, RADIUS, LOAD, FRICTION = 1e-3, 0.5, 178.90, 0.3
ELEMENTS = 100
ELEMENT = 2 * A / ELEMENTS
CREEPAGE = -2.4e-4
BOUND = FRICTION * LOAD


def line(**motion: Any) -> dict[str, Any]:
    return {
        "kind": "patch",
        "geometry": {"line_contact_radius": RADIUS, "width": 1e-3},
        "load": {"normal_force": LOAD},
        "grid": {"elements": [ELEMENTS, 1]},
        "motion": {"rolling_speed": 1.0, **motion},
        "friction": {"coefficient": FRICTION},
        "method": {"tolerance": 1e-8},
    }


def point(**more: Any) -> dict[str, Any]:
    case = {
        "kind": "patch",
        "geometry": {"semi_axes": [3e-3, 4e-3]},
        "load": {"normal_force": 3e4},
        "grid": {"elements": [14, 14]},
        "motion": {
            "regimes": ["steady_rolling"],
            "creepage": [1e-3, 5e-4],
            "spin_creepage": 0.1,
            "rolling_speed": 5.0,
            "distance": 6e-3 / 14,
        },
        "friction": {"coefficient": 0.3},
        "method": {"tolerance": 1e-9},
    }
    return with_values(case, **more)


def test_shift_then_rolling_then_steady() -> None:
    """Cattaneo's stick area, then Carter's force after some lengths, and the steady step's."""
    ratio = 0.6
    shift = solve(line(regime="shift", tangential_force=[ratio * BOUND, "creepage"]), fields=True)
    x, sticks = np.array(shift["x"]), np.array(shift["element_division"])[0] == 1
    half = A * np.sqrt(1 - ratio)
    moved = shift["creepage"][0]
    count = 4 * ELEMENTS
    regimes = ["shift", *["transient_rolling"] * count, "steady_rolling"]
    pairs = [[moved, 0.0], *[[CREEPAGE, 0.0]] * (count + 1)]
    result = solve(line(regimes=regimes, creepage=pairs, distance=count * ELEMENT))
    steps = result["steps"]
    assert [step["regime"] for step in steps] == regimes
    force = np.array([step["creep_force"][0] for step in steps]) / BOUND
    carter = 1 - (1 - abs(CREEPAGE) * RADIUS / (FRICTION * A)) ** 2
    first = solve(line(regime="transient_rolling", creepage=[CREEPAGE, 0.0], distance=ELEMENT))
    check(
        [
            Line("outermost stick of the shift (m)", np.abs(x[sticks]).max(), half, ELEMENT),
            Line("force after the shift", force[0], ratio, 1e-6),
            Line("force after four lengths, Carter", force[-2], carter, 0.01),
            Line("the steady step after them", force[-1] / force[-2], 1.0, 1e-5),
        ]
    )
    # the first rolled element takes along what the shift left, which a fresh contact has not
    assert first["creep_force"][0] / BOUND < 0.05
    assert abs(force[1] - ratio) < 0.05
    fresh = solve(line(creepage=[CREEPAGE, 0.0]))
    assert steps[-1]["creep_force"][0] == pytest.approx(fresh["creep_force"][0], rel=1e-7)
    # after two lengths nothing of the shift is left
    assert np.all(np.abs(force[2 * ELEMENTS : -1] / force[-1] - 1) < 0.002)


def test_each_step_equals_a_restored_contact() -> None:
    regimes = ["shift", "transient_rolling", "transient_rolling", "steady_rolling"]
    regimes += ["transient_rolling", "shift", "steady_rolling", "shift"]
    contact = railpatch.Contact(point())
    moves = {"shift": [1e-6, -2e-6], "transient_rolling": [8e-4, 4e-4]}
    for regime in regimes:
        changes = {"regime": regime, "creepage": moves.get(regime, [1e-3, 5e-4])}
        if regime == "shift":
            changes["spin_creepage"] = 1e-4
        else:
            changes["spin_creepage"] = 0.1
        state = contact.save()
        result = contact.step(fields=True, **changes)
        assert result.status == "converged"
        other = railpatch.Contact(point())
        other.restore(state)
        again = other.step(fields=True, **changes)
        for key in ("creep_force", "friction_power", "elastic_energy", "traction", "micro_slip"):
            assert np.array_equal(again[key], result[key]), (regime, key)
        assert other.save() == contact.save()


FEATURES: dict[str, dict[str, Any]] = {
    "plain": {},
    "elastic layer": {"layer": {"thickness": 2e-5, "shear_modulus": 1e9}},
    "plastic layer": {"layer": {"thickness": 0.0, "yield_stress": 1.5e8, "hardening": 1e12}},
    "unlike bodies": {"material": {"shear_modulus": [82e9, 60e9]}},
    "falling friction": {
        "friction": {
            "law": "slip_velocity",
            "kinetic": 0.2,
            "amplitude": 0.1,
            "halving_speed": 1.0,
        }
    },
    "rows": {"friction": {"coefficient": 0.3, "factor": [[-3e-3, 1.0], [3e-3, 0.6]]}},
}


@pytest.mark.parametrize("name", FEATURES)
def test_rolling_on_from_the_steady_state(name: str) -> None:
    """Steps over one element leave the steady state, spin read at the element itself."""
    case = point(method__spin_offset="none", **FEATURES[name])
    contact = railpatch.Contact(case)
    alone = railpatch.solve(with_values(case, motion__regimes=None, motion__distance=None))
    contact.step(regime="transient_rolling", creepage=[-2e-3, 1e-3])
    steady = contact.step(regime="steady_rolling", creepage=[1e-3, 5e-4])
    force = np.array(steady["creep_force"])
    size = np.hypot(*force)
    # whatever was before
    assert np.abs(force - alone["creep_force"]).max() < 1e-6 * size
    for key in ("friction_power", "elastic_energy", "creep_power"):
        assert steady[key] == pytest.approx(alone[key], rel=1e-6), key
    for _ in range(3):
        result = contact.step(regime="transient_rolling")
        assert result.status == "converged"
        assert np.abs(np.array(result["creep_force"]) - force).max() < 1e-5 * size
        # of unlike bodies it is summed otherwise in a step, by elements that have left contact too
        rel = 1e-2 if name == "unlike bodies" else 2e-3
        assert result["friction_power"] == pytest.approx(steady["friction_power"], rel=rel)


def test_one_regime_is_as_without_changes() -> None:
    """To the bit."""
    motion = point()["motion"]
    for regime in ("shift", "transient_rolling"):
        plain = {**motion, "regime": regime, "steps": 3}
        del plain["regimes"]
        if regime == "shift":
            del plain["distance"]
            plain |= {"creepage": [1e-6, 2e-6], "spin_creepage": 0.0}
        named = {**plain, "regimes": [regime] * 3}
        del named["regime"]
        a = railpatch.solve({**point(), "motion": plain}, fields=True)
        b = railpatch.solve({**point(), "motion": named}, fields=True)
        assert np.array_equal(a["traction"], b["traction"])
        for one, other in zip(a["steps"], b["steps"], strict=True):
            assert other.pop("regime") == regime
            assert repr(one) == repr(other)


def test_work_through_a_change() -> None:
    """What creepages supply is friction's work and the change of elastic energy, also of the step
    after one of steady rolling; friction by the means of each material's tractions and its slip,
    summed here."""
    contact = railpatch.Contact(point())
    last = contact.step(regime="steady_rolling", fields=True)
    size = 6e-3 / 14
    area = size * 8e-3 / 14
    cycle = (("transient_rolling", [5e-4, 5e-4]), ("shift", [2e-6, 0.0]))
    for regime, creepage in itertools.chain(cycle, cycle):
        now = contact.step(
            regime=regime,
            creepage=creepage,
            spin_creepage=0.0 if regime == "shift" else 0.1,
            fields=True,
        )
        rolls = regime == "transient_rolling"
        rate = 5.0 / size if rolls else 1.0
        grown = (now["elastic_energy"] - last["elastic_energy"]) * rate
        assert now["creep_power"] - grown == pytest.approx(now["friction_power"], rel=1e-6)
        if not rolls:
            # of rolling, what has just left contact slips too, and no field shows it. Here what
            # slid on the same way slides on, and other elements slide once they are at the bound
            before, traction = np.array(last["traction"]), np.array(now["traction"])
            bound = 0.3 * np.array(now["pressure"])
            slid = np.hypot(*before) > (1 - 1e-6) * bound
            slid &= (before * traction).sum(axis=0) > 0
            against = np.where(slid, 0.5 * (before + traction), traction)
            taken = -(against * np.array(now["micro_slip"])).sum() * area
            assert taken == pytest.approx(now["friction_power"], rel=1e-5)
        last = now


def test_wheels_roll_on_from_the_steady_state() -> None:
    case = with_values(
        WHEELSET,
        grid={"element_size": [5e-4, 5e-4]},
        motion={"regime_changes": True},
        wheelset__z=None,
        wheelset__vertical_force=1e5,
        wheelset__yaw=2e-3,
        method__tolerance=1e-6,
    )
    speed = case["wheelset"]["speed"]
    contact = railpatch.Contact(with_values(case, wheelset__time_step=5e-4 / speed))
    alone = railpatch.solve(with_values(case, motion=None, wheelset__time_step=None))
    steady = contact.step()
    rows = [contact.step(regime="transient_rolling") for _ in range(3)]
    for side in ("left", "right"):
        force = np.array(steady[side]["force"])
        assert np.abs(force - alone[side]["force"]).max() == 0
        size = np.abs(force).max()
        for row in rows:
            assert np.abs(np.array(row[side]["force"]) - force).max() < 2e-3 * size
    # without it rolling begins from nothing
    fresh = railpatch.Contact(
        with_values(case, motion={"regime": "transient_rolling"}, wheelset__time_step=5e-4 / speed)
    ).step()
    patch = steady["right"]["patches"][0]["creep_force"]
    assert np.hypot(*fresh["right"]["patches"][0]["creep_force"]) < 0.5 * np.hypot(*patch)


REFUSED = [
    ({"temperature": {"wheel": 20.0, "rail": 20.0}}, "temperature"),
    ({"grid": {"fitted": [10, 10]}, "method__normal": "hertz"}, "grid.fitted"),
    ({"method__tangential": "fastsim"}, "method.tangential"),
    ({"motion__regimes": []}, "motion.regimes"),
    ({"motion__regimes": ["none"]}, "motion.regimes"),
    ({"motion__steps": 3}, "motion.steps"),
    ({"motion__regime": "shift"}, "motion.regime: value is 'shift', allowed 'steady"),
    ({"motion__regimes": ["transient_rolling"], "motion__distance": None}, "motion.distance"),
    (
        {"motion__regimes": ["shift"], "friction": FEATURES["falling friction"]["friction"]},
        "motion.regime",
    ),
]


@pytest.mark.parametrize(("change", "key"), REFUSED)
def test_what_is_refused(change: dict[str, Any], key: str) -> None:
    with pytest.raises(railpatch.CaseError, match=key.replace(".", r"\.")):
        railpatch.Contact(point(**change))


def test_steps_are_refused_by_name() -> None:
    falling = railpatch.Contact(point(**FEATURES["falling friction"]))
    with pytest.raises(railpatch.CaseError, match="regime"):
        falling.step(regime="shift")
    with pytest.raises(railpatch.CaseError, match="regime"):
        railpatch.Contact(PATCH).step(regime="shift")


def test_wear_number_is_of_rolling() -> None:
    """|Fx xi| + |Fy eta| + |M phi| of each step that rolls, as it ends, whatever was before, by the
    metre: of a shift and without tractions there is none, at standstill nothing is worn."""
    contact = railpatch.Contact(point())
    for regime in ("shift", "transient_rolling", "steady_rolling", "shift", "transient_rolling"):
        rolls = regime != "shift"
        creepage = [8e-4, 4e-4] if rolls else [1e-6, -2e-6]
        spin = 0.1 if rolls else 0.0
        now = contact.step(regime=regime, creepage=creepage, spin_creepage=spin)
        parts = [*(np.array(now["creep_force"]) * creepage), now["spin_moment"] * spin]
        found = now["wear_number"]
        assert found == pytest.approx(np.abs(parts).sum(), rel=1e-12) if rolls else np.isnan(found)
    still = contact.step(regime="transient_rolling", rolling_speed=0.0)
    assert np.hypot(*still["creep_force"]) > 0
    assert still["wear_number"] == still["creep_power"] == 0
    alone = railpatch.solve(with_values(point(), motion={"regime": "none"}, friction=None))
    assert np.isnan(alone["wear_number"])
