"""Transient rolling: from rest to the steady solution, in two and in three dimensions.

A step over one element has the same equations as steady rolling once tractions no longer change, so
both must agree to the solver's tolerance; other steps discretise otherwise and tend to the same
limit. Carter's force (test_carter.py) is that limit in two dimensions.
"""

from __future__ import annotations

import numpy as np
import pytest
import railpatch
from patch_cases import Line, check, solve

A = 1e-3
ELEMENTS = 100
ELEMENT = 2 * A / ELEMENTS


def carter(**motion) -> dict:
    """Half-length 1 mm and |F|/(mu F_n) = 0.64 (reference: R = 500 mm, F_n = 178.90 N/mm)."""
    return {
        "kind": "patch",
        "geometry": {"line_contact_radius": 0.5, "width": 1e-3},
        "load": {"normal_force": 178.90},
        "grid": {"elements": [ELEMENTS, 1]},
        "motion": {"creepage": [-2.4e-4, 0.0], "rolling_speed": 1.0, **motion},
        "friction": {"coefficient": 0.3},
        "method": {"tolerance": 1e-8},
    }


def point(**motion) -> dict:
    return {
        "kind": "patch",
        "geometry": {"semi_axes": [4e-3, 4e-3]},
        "load": {"normal_force": 3e4},
        "grid": {"elements": [20, 20]},
        "motion": {"creepage": [1e-3, 5e-4], "spin_creepage": 0.1, "rolling_speed": 1.0, **motion},
        "friction": {"coefficient": 0.3},
        "method": {"tolerance": 1e-8},
    }


def rolled(make, element: float, steps: int, share: float = 1.0, **motion) -> railpatch.Result:
    way = {"distance": share * element * steps, "steps": steps}
    return solve(make(regime="transient_rolling", **way, **motion))


@pytest.mark.parametrize("direction", [1, -1])
def test_carter_settles_on_the_steady_solution(direction: int) -> None:
    steady = solve(carter(direction=direction))["creep_force"][0]
    result = rolled(carter, ELEMENT, 400, direction=direction)
    force = result["creep_force"][0]
    check([Line(f"direction {direction}", force / steady, 1.0, 0.002)])
    # 400 elements are four contact lengths: nothing changes any more
    assert force == pytest.approx(steady, rel=1e-5)


def test_traction_grows_over_a_contact_length() -> None:
    """At first nothing is transmitted; the steady state sets in within some two lengths."""
    force = np.array([s["creep_force"][0] for s in rolled(carter, ELEMENT, 300)["steps"]])
    ratio = force / solve(carter())["creep_force"][0]
    assert ratio[0] < 0.05
    assert np.all(np.diff(ratio[:50]) > 0)
    assert np.all(np.abs(ratio[200:] - 1) < 0.002)


def test_any_step() -> None:
    """Steps tend to Carter's 0.64 with their length, from a tenth of an element on."""
    bound = 0.3 * 178.90
    lines = []
    for share, steps, error in ((0.1, 3000, 0.01), (0.5, 600, 0.01), (2.5, 200, 0.02)):
        force = rolled(carter, ELEMENT, steps, share)["creep_force"][0] / bound
        lines.append(Line(f"step of {share} elements", force, 0.64, error * 0.64))
    check(lines)
    far = rolled(carter, ELEMENT, 5, 1000.0)
    # ten lengths in a step: all has slipped but what the step's end leaves in stick
    assert 0 < far["creep_force"][0] / bound <= 1 + 1e-9


@pytest.mark.parametrize("layer", [None, {"thickness": 1e-5, "shear_modulus": 8.2e9}])
def test_cattaneo_to_carter_in_three_dimensions(layer) -> None:
    """First a shift, as the peer's own test does (DOT/FRA/ORD-24/18, figure 38), then rolling."""

    def make(**motion) -> dict:
        return point(**motion) if layer is None else {**point(**motion), "layer": layer}

    steady = solve(make())
    settled = rolled(make, 4e-4, 200)
    check(
        [
            Line(f"F_{axis}", settled["creep_force"][k] / steady["creep_force"][k], 1.0, 0.002)
            for k, axis in enumerate("xy")
        ]
        + [Line("M", settled["spin_moment"] / steady["spin_moment"], 1.0, 0.002)]
        + [
            Line(
                "first step",
                settled["steps"][0]["creep_force"][0] / steady["creep_force"][0],
                0.1,
                0.1,
            )
        ]
    )


def test_rolling_either_way_is_mirrored() -> None:
    ahead = rolled(point, 4e-4, 10)
    back = rolled(
        lambda **motion: point(**{**motion, "creepage": [-1e-3, 5e-4], "spin_creepage": -0.1}),
        4e-4,
        10,
        direction=-1,
    )
    assert back["creep_force"][0] == pytest.approx(-ahead["creep_force"][0], rel=1e-6)
    assert back["creep_force"][1] == pytest.approx(ahead["creep_force"][1], rel=1e-6)


def test_reversal_and_steps_of_their_own() -> None:
    """Creepage of each step; rolling on freely takes the traction out of the contact."""
    pairs = [[-2.4e-4, 0.0]] * 100 + [[0.0, 0.0]] * 700
    result = rolled(carter, ELEMENT, 800, creepage=pairs)
    forces = np.array([step["creep_force"][0] for step in result["steps"]])
    assert forces[99] > 0.5 * 0.3 * 178.90
    assert abs(forces[-1]) < 1e-3 * 0.3 * 178.90
    assert len(result["steps"]) == 800


def test_standstill_keeps_tractions() -> None:
    contact = railpatch.Contact(
        point(regime="transient_rolling", distance=4e-4, steps=1, spin_creepage=0.0)
    )
    for _ in range(5):
        before = contact.step()
    still = contact.step(rolling_speed=0.0)
    assert still.status == "converged"
    np.testing.assert_allclose(still["creep_force"], before["creep_force"], rtol=1e-6)
    assert still["friction_power"] == 0
    on = contact.step(rolling_speed=1.0)
    assert abs(on["creep_force"][0]) > abs(before["creep_force"][0])


def test_prescribed_force_settles() -> None:
    force = [solve(carter())["creep_force"][0], "creepage"]
    result = rolled(carter, ELEMENT, 400, tangential_force=force, creepage=[0.0, 0.0])
    check([Line("creepage", result["creepage"][0], -2.4e-4, 0.002 * 2.4e-4)])


def test_state_goes_on() -> None:
    make = {**point(regime="transient_rolling", distance=4e-4, steps=1)}
    make["layer"] = {"thickness": 0.0, "yield_stress": 1e8, "hardening": 1e12}
    contact, other = railpatch.Contact(make), railpatch.Contact(make)
    for _ in range(4):
        contact.step()
    other.restore(contact.save())
    first, second = contact.step(fields=True), other.step(fields=True)
    assert first["creep_force"] == second["creep_force"]
    np.testing.assert_array_equal(first["plastic_displacement"], second["plastic_displacement"])
