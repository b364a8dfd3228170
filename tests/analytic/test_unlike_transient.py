"""Transient rolling of unlike bodies: pressure and traction, and their displacements of the step
before, settle on the steady solution.

A step over one element has the equations of steady rolling once nothing changes any more.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from patch_cases import patch_case, solve

ALUMINIUM_ON_STEEL = {"shear_modulus": [23e9, 82e9], "poisson_ratio": [0.31, 0.28]}
STEEL_ON_RUBBER = {"shear_modulus": [82e9, 2e7], "poisson_ratio": [0.28, 0.4]}
A = 2e-3
LAYER = {"layer": {"thickness": 2e-5, "shear_modulus": 8e9}}


def radius_of(case: dict[str, Any]) -> float:
    """m, of the sphere on a plane that gives the circle under the load: Hertz, 4 E* a^3/(3 F)."""
    pairs = zip(case["material"]["shear_modulus"], case["material"]["poisson_ratio"], strict=True)
    modulus = 1 / sum((1 - nu) / (2 * g) for g, nu in pairs)
    return 4 * modulus * A**3 / (3 * case["load"]["normal_force"])


def line(material: dict[str, Any], elements: int) -> dict[str, Any]:
    # in plane strain displacement counts from a distance of about the width, which must be well
    # beyond the contact
    shape = {"line_contact_radius": 0.5, "width": 0.3}
    return patch_case(
        shape,
        force=3e4,
        elements=[elements, 1],
        creepage=[-1e-4, 2e-5],
        material=material,
        tolerance=1e-8,
    )


def point(material: dict[str, Any], elements: int) -> dict[str, Any]:
    return patch_case(
        {"semi_axes": [A, 1.5 * A]},
        force=1e3,
        elements=elements,
        creepage=[-1e-4, 2e-5],
        spin=0.05,
        material=material,
        tolerance=1e-8,
    )


@pytest.mark.parametrize("direction", [1, -1])
@pytest.mark.parametrize("material", [ALUMINIUM_ON_STEEL, STEEL_ON_RUBBER])
@pytest.mark.parametrize(("make", "elements"), [(line, 40), (point, 14)])
def test_it_settles_on_the_steady_solution(
    make: Any, elements: int, material: dict[str, Any], direction: int
) -> None:
    case = make(material, elements)
    case["motion"]["direction"] = direction
    steady = solve(case, fields=True)
    capacity = case["friction"]["coefficient"] * case["load"]["normal_force"]
    size = steady["x"][1] - steady["x"][0]
    found = {}
    for share in (1.0, 0.37):
        # shorter steps only come near
        steps = int((40 if share == 1.0 else 6) * elements / share)
        motion = {"regime": "transient_rolling", "steps": steps, "distance": steps * share * size}
        found[share] = solve({**case, "motion": {**case["motion"], **motion}})
    for component in range(2):
        force = steady["creep_force"][component]
        assert found[1.0]["creep_force"][component] == pytest.approx(force, abs=1e-5 * capacity)
        # another step discretises otherwise: an error of first order in the element size
        near = pytest.approx(force, abs=1.5 / elements * capacity)
        assert found[0.37]["creep_force"][component] == near
    assert found[1.0]["approach"] == pytest.approx(steady["approach"], rel=1e-5)
    # by the mean traction of a step's ends, as in steady rolling
    assert found[1.0]["friction_power"] == pytest.approx(steady["friction_power"], rel=1e-4)


@pytest.mark.parametrize("direction", [1, -1])
@pytest.mark.parametrize("extra", [{}, LAYER], ids=["plain", "layer"])
@pytest.mark.parametrize("material", [ALUMINIUM_ON_STEEL, STEEL_ON_RUBBER])
def test_friction_takes_what_creepages_and_the_pressures_moment_supply(
    material: dict[str, Any], extra: dict[str, Any], direction: int
) -> None:
    """In contact the gap is 0, so what pressure does on the normal displacement it does on the
    undeformed distance x^2/(2 R): V/R times its moment. Open by second order in the grid; by the
    traction at one end of a step it was of first order."""
    left = []
    for elements in (12, 24, 48):
        case = point(material, elements) | extra
        case["geometry"] = {"semi_axes": [A, A]}
        case["motion"]["direction"] = direction
        result = solve(case, fields=True)
        x, pressure = np.array(result["x"]), np.array(result["pressure"])
        radius = radius_of(case)
        moment = float((pressure * x).sum()) * (x[1] - x[0]) ** 2
        speed = case["motion"]["rolling_speed"]
        supplied = result["creep_power"] + direction * speed * moment / radius
        taken = result["friction_power"]
        left.append(abs(supplied - taken) / taken)
    # of first order a fourth would be left, of second a sixteenth
    assert left[2] < left[0] / 8, left
