"""Friction that follows the speed of slip in fast theories: that of the rigid slip, V |w|.

Without spin it is one coefficient, so that Coulomb's law with the law's value at V times the
creepage gives the same; with spin each element has its own.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import railpatch
from patch_cases import patch_case, solve

THEORIES = ("fastsim", "fastrip", "polach")
MODIFIED = {"fastsim_k0": 0.54, "fastsim_alpha": 0.02, "fastsim_beta": 0.62}
KINETIC, AMPLITUDE, HALVING, SPEED = 0.12, 0.25, 0.3, 12.0
LAW: dict[str, Any] = {
    **{"law": "slip_velocity", "kinetic": KINETIC, "amplitude": AMPLITUDE},
    "halving_speed": HALVING,
}
SHAPES = {
    "exponential": lambda u: 0.5**u,
    "rational": lambda u: 1 / (1 + u),
    "linear": lambda u: np.maximum(0.0, 1 - u / 2),
}
ROUNDED = 1e-12


def case_of(friction: dict[str, Any], theory: str, normal: str = "hertz", **motion: Any) -> dict:
    shape = {"semi_axes" if normal == "hertz" else "curvatures": [6e-3, 4e-3]}
    if normal != "hertz":
        shape = {"curvatures": [0.8, 1.7]}
    method = MODIFIED if theory == "fastsim" else {}
    case = patch_case(
        shape, force=9e4, elements=20, normal=normal, tangential=theory, speed=SPEED, **method,
        **motion,
    )  # fmt: skip
    case["friction"] = friction
    return case


def coefficient(speed: Any, shape: str = "exponential") -> Any:
    return KINETIC + AMPLITUDE * SHAPES[shape](speed / HALVING)


def same(one: railpatch.Result, other: railpatch.Result) -> None:
    scale = np.abs(other["creep_force"]).max()
    assert one["creep_force"] == pytest.approx(other["creep_force"], abs=ROUNDED * scale)
    assert one["spin_moment"] == pytest.approx(other["spin_moment"], abs=ROUNDED * scale)
    assert one["friction_power"] == pytest.approx(other["friction_power"], rel=ROUNDED)


@pytest.mark.parametrize("normal", ["hertz", "half_space", "kik_piotrowski_corrected"])
@pytest.mark.parametrize("theory", THEORIES)
def test_without_spin_it_is_coulombs(theory: str, normal: str) -> None:
    for shape in SHAPES:
        for creepage in ([-4e-4, 0.0], [3e-3, -2e-3], [-0.02, 0.05]):
            motion = {"creepage": creepage, "direction": 1 if creepage[0] > 0 else -1}
            found = solve(case_of({**LAW, "shape": shape}, theory, normal, **motion))
            mu = coefficient(SPEED * np.hypot(*creepage), shape)
            same(found, solve(case_of({"coefficient": mu}, theory, normal, **motion)))
            assert np.isnan(found["error_estimate"]["creep_force"])


@pytest.mark.parametrize("theory", THEORIES)
def test_law_that_does_not_fall(theory: str) -> None:
    flat = {**LAW, "amplitude": 0.0}
    for spin in (0.0, 0.3, -2.0):
        motion = {"creepage": [1e-3, 5e-4], "spin": spin}
        found = solve(case_of(flat, theory, **motion))
        same(found, solve(case_of({"coefficient": KINETIC}, theory, **motion)))


@pytest.mark.parametrize("theory", ["fastsim", "fastrip"])
@pytest.mark.parametrize("direction", [1, -1])
def test_elements_that_slip_are_at_their_own_bound(theory: str, direction: int) -> None:
    xi, eta, spin = 0.012, -6e-3, 2.5
    motion = {"creepage": [xi, eta], "spin": spin, "direction": direction}
    result = solve(case_of(LAW, theory, **motion), fields=True)
    x, y = np.meshgrid(result["x"], result["y"])
    speed = SPEED * np.hypot(xi - spin * y, eta + spin * x)
    bound = coefficient(speed) * np.array(result["pressure"])
    slips = np.array(result["element_division"]) == 2
    assert slips.sum() > 50
    assert np.ptp(coefficient(speed)[slips]) > 0.03
    traction = np.hypot(*np.array(result["traction"]))
    assert (traction <= bound * (1 + 1e-9)).all()
    # strips may change from stick to slip within an element
    at_bound = traction[slips] >= bound[slips] * (1 - 1e-9)
    assert at_bound.mean() > (0.9 if theory == "fastrip" else 1 - 1e-9)


@pytest.mark.parametrize("theory", THEORIES)
def test_standstill_and_rates(theory: str) -> None:
    """At rest the law is that at rest; the derivative is that of steps beside."""
    still = case_of(LAW, theory, creepage=[1e-3, 0.0])
    still["motion"]["rolling_speed"] = 0.0
    assert railpatch.solve(still)["creep_force"] == [0.0, 0.0]
    case = case_of(LAW, theory, creepage=[8e-3, 4e-3], spin=0.1)
    case["method"]["derivatives"] = True
    contact = railpatch.Contact(case)
    contact.step()
    rate = contact.differentiate(rolling_speed=1.0)["creep_force"]
    forces = [np.array(contact.step(rolling_speed=SPEED + h)["creep_force"]) for h in (1e-3, -1e-3)]
    difference = (forces[0] - forces[1]) / 2e-3
    assert np.abs(difference).max() > 10.0
    np.testing.assert_allclose(rate, difference, rtol=1e-4, atol=1e-3)


@pytest.mark.parametrize(
    ("method", "friction", "text"),
    [
        (
            {"tangential": "fastsim"},
            {"memory_distance": 1e-5},
            "friction.memory_distance: value is",
        ),
        ({"tangential": "linear"}, {}, "'full' or 'polach' or 'fastsim' or 'fastrip' with"),
        ({"tangential": "table"}, {}, "'full' or 'polach' or 'fastsim' or 'fastrip' with"),
        ({"tangential": "full"}, {"fitted": True}, "grid.fitted"),
    ],
)
def test_what_is_refused(method: dict[str, Any], friction: dict[str, Any], text: str) -> None:
    fitted = {"fitted": [8, 8]} if friction.pop("fitted", False) else {}
    case = case_of({**LAW, **friction}, "polach", creepage=[1e-3, 0.0])
    case["method"] = {"normal": "hertz", **method}
    case["grid"] |= fitted
    with pytest.raises(railpatch.CaseError, match=text):
        railpatch.Contact(case)
