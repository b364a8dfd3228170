"""The independent check finds what is wrong: each field of a good solution spoilt in turn."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from railpatch import _core
from railpatch.case.load import load_scene
from railpatch.case.to_core import config_of, input_of
from railpatch.evidence.stress.conditions import energy_balance, findings
from railpatch.evidence.stress.fitted_rows import Rows, rectangle_findings
from railpatch.evidence.stress.half_space import Array
from railpatch.evidence.stress.liquids import wet_mixture
from railpatch.evidence.stress.plan import SEED
from railpatch.evidence.stress.run import (
    CLEAN,
    no_numbers,
    run_trial,
    steps_of,
    too_many_iterations,
)
from railpatch.evidence.stress.step import Step
from railpatch.evidence.stress.trial import CREEPAGE, METHODS, SPIN, nominal


def solved(*changes: dict[str, Any]) -> Step:
    scene = load_scene(nominal(*changes))
    contact, values = _core.Contact(config_of(scene), False), input_of(scene.case)
    return steps_of(contact, scene.case, values, contact.step(values), None)[0]


MOTION = {"creepage": [0.5 * CREEPAGE, 0.2 * CREEPAGE], "spin_creepage": 0.3 * SPIN}


@pytest.fixture(scope="module")
def step() -> Step:
    return solved({"motion": MOTION, "grid": {"elements": [16, 20]}})


def worst(step: Step) -> dict[str, float]:
    return {finding.name: finding.share for finding in findings(step)}


def spoilt(step: Step, name: str, change: Callable[[Array], Array]) -> Step:
    return replace(step, fields={**step.fields, name: change(step[name])})


def test_a_solution_is_clean(step: Step) -> None:
    shares = worst(step)
    assert step.good
    assert {"gap in contact", "interpenetration", "stick and slip", "micro-slip"} <= set(shares)
    assert max(shares.values()) <= 1
    assert energy_balance(step) <= 1e-4


@pytest.mark.parametrize(
    ("name", "change", "found"),
    [
        ("pressure", lambda p: np.where(p == p.max(), -p, p), "negative pressure"),
        ("pressure", lambda p: 1.001 * p, "sum of pressure"),
        ("pressure", lambda p: np.roll(p, 1, axis=1), "gap in contact"),
        ("traction", lambda p: 1.001 * p, "traction over its bound"),
        ("traction", lambda p: 0.999 * p, "sum of tractions"),
        ("traction", lambda p: 0.999 * p, "stick and slip"),
        ("traction", lambda p: -p, "micro-slip along the traction"),
        ("traction", lambda p: p + 1.0, "traction outside"),
        ("micro_slip", lambda s: -s, "micro-slip along the traction"),
        ("micro_slip", lambda s: 1.01 * s, "micro-slip"),
        ("micro_slip", lambda s: s + 1e-9, "micro-slip outside slip"),
        ("element_division", lambda d: np.where(d == 1, 2, d), "count of elements"),
    ],
)
def test_a_spoilt_field_is_found(
    step: Step, name: str, change: Callable[[Array], Array], found: str
) -> None:
    assert worst(spoilt(step, name, change))[found] > 1


@pytest.mark.parametrize(
    ("key", "factor", "found"),
    [
        ("creep_force", 1.01, "sum of tractions"),
        ("creep_force", 100.0, "creep force over friction"),
        ("spin_moment", 1.01, "moment of tractions"),
        ("friction_power", 1.01, "power supplied"),
        ("friction_power", -1.0, "friction takes power"),
        ("normal_force", 1.01, "normal force"),
        ("max_pressure", -1.0, "pressure of contact"),
    ],
)
def test_a_spoilt_number_is_found(step: Step, key: str, factor: float, found: str) -> None:
    value = (factor * np.array(step.patch[key])).tolist()
    assert worst(replace(step, patch={**step.patch, key: value}))[found] > 1


def test_energy_of_a_spoilt_field(step: Step) -> None:
    assert energy_balance(spoilt(step, "micro_slip", lambda s: 1.1 * s)) > 1e-3


@pytest.fixture(scope="module", params=["transient_rolling", "shift"])
def later(request: pytest.FixtureRequest) -> Step:
    """What goes on from steps before, and slides in part."""
    motion: dict[str, Any] = {**MOTION, "regime": request.param}
    if request.param == "transient_rolling":
        motion |= {"distance": 7.5e-4, "steps": 1}
    else:
        motion |= {"creepage": [8e-6, 2e-6], "spin_creepage": 2e-4}
    scene = load_scene(nominal({"motion": motion, "grid": {"elements": [16, 20]}}))
    contact, values = _core.Contact(config_of(scene), False), input_of(scene.case)
    step = None
    for _ in range(8):
        step = steps_of(contact, scene.case, values, contact.step(values), step)[0]
    assert step is not None
    return step


def test_energies_of_a_step(later: Step) -> None:
    assert later.good
    assert later.history is not None
    assert max(worst(later).values()) <= 1
    assert energy_balance(later) <= 1e-5


@pytest.mark.parametrize("name", ["traction", "micro_slip"])
def test_energy_of_a_spoilt_field_of_a_step(later: Step, name: str) -> None:
    assert energy_balance(spoilt(later, name, lambda p: 1.1 * p)) > 1e-3


@pytest.mark.parametrize("name", ["friction_power", "creep_force"])
def test_energy_of_a_spoilt_power(step: Step, later: Step, name: str) -> None:
    for one in (step, later):
        value = (1.1 * np.array(one.patch[name])).tolist()
        assert energy_balance(replace(one, patch={**one.patch, name: value})) > 1e-3


def test_energy_of_another_step_before(later: Step) -> None:
    assert later.before is not None
    other = spoilt(later.before, "traction", lambda p: 1.1 * p)
    assert energy_balance(replace(later, before=other)) > 1e-3


def test_no_number_is_found(step: Step) -> None:
    assert not list(no_numbers(step))
    hole = spoilt(step, "traction", lambda p: np.where(p == p.min(), np.nan, p))
    assert list(no_numbers(hole)) == ["traction holds 1 that are no numbers"]
    for name in ("creep_force", "friction_power", "approach"):
        found = list(no_numbers(replace(step, patch={**step.patch, name: float("nan")})))
        assert found == [f"{name} is no number"]


def test_iterations_are_bounded(step: Step) -> None:
    assert not list(too_many_iterations(step))
    many = replace(step, patch={**step.patch, "newton_iterations": 101})
    assert list(too_many_iterations(many)) == ["newton_iterations are 101, allowed 100"]


def test_prescribed_force_is_met() -> None:
    force = {"motion": {"creepage": None, "tangential_force": [1e4, "creepage"]}}
    step = solved(force)
    assert worst(step)["prescribed force"] <= 1
    values = {**step.values, "tangential_force": [1.001e4, 0.0]}
    assert worst(replace(step, values=values))["prescribed force"] > 1


def test_rows_are_judged_by_the_traction_that_they_stand_for() -> None:
    """The pole of spin lies within a step of these nodes: by sines through them, in place of
    cubics, the slip of what sticks is 1.1 of what is allowed on any number of rectangles."""
    row = run_trial(wet_mixture(SEED, 179))
    assert row.method == "fitted rows"
    assert row.verdict == CLEAN, row.reason
    assert row.conditions < 0.3


def test_regimes_have_no_friction_beside_their_own() -> None:
    """With one, a case is refused: all 447 trials of regimes were."""
    trial = wet_mixture(SEED, 0)
    assert trial.case["fluid"]["model"] == "regimes"
    row = run_trial(trial)
    assert row.verdict == CLEAN, row.reason


def test_traction_between_nodes_is_a_cubic() -> None:
    """Of the angle, through the nodes, odd at both edges: what is such a cubic is met."""
    count, length, width = 12, 4e-3, 1e-3
    step = np.pi / (count + 1)
    nodes = step * np.arange(1, count + 1)
    x = (length * np.cos(nodes))[::-1]

    def rows_of(function: Callable[[Array], Array]) -> Rows:
        traction = np.tile(function(nodes)[::-1], (2, 3, 1))
        return Rows(np.tile(x, (3, 1)), width * np.arange(3), traction)

    angles = np.linspace(1e-3, np.pi - 1e-3, 200)
    random = np.random.default_rng(3).normal(size=count)
    assert rows_of(lambda _: random).between_nodes(nodes) == pytest.approx(
        np.tile(random, (2, 3, 1))
    )
    middle = (angles >= 2 * step) & (angles <= np.pi - 2 * step)
    found = rows_of(lambda t: t**3 - 2 * t**2 + 0.3).between_nodes(angles)[1, 2]
    assert found[middle] == pytest.approx((angles**3 - 2 * angles**2 + 0.3)[middle])
    first = angles <= step
    found = rows_of(lambda t: t**3 - 2 * t).between_nodes(angles)[0, 1]
    assert found[first] == pytest.approx((angles**3 - 2 * angles)[first])


def test_spoilt_rows_are_found() -> None:
    """A traction a tenth too small, and a micro-slip three tenths too great."""
    step = solved(METHODS["fitted rows"], {"motion": MOTION})

    def shares(step: Step) -> dict[str, float]:
        return {finding.name: finding.share for finding in rectangle_findings(step)}

    assert shares(spoilt(step, "traction", lambda p: 0.9 * p))["slip in stick"] > 1
    found = shares(spoilt(step, "micro_slip", lambda s: 1.3 * s))
    assert found["micro-slip"] > 1 > found["slip in stick"]
