"""Prescribed creep force: the creepage found is that of closed forms, and leads back to the force.

Carter 1926 (see test_carter.py) solved for the creepage: xi = -sign(F) mu (a - a') / R with
a' = a sqrt(1 - |F| / (mu F_n)).
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
import railpatch
from patch_cases import STEEL, Line, check, modulus, patch_case, solve

RADIUS, FRICTION, LOAD = 0.5, 0.3, 178.90e3
MOST = FRICTION * LOAD
A = math.sqrt(4 * LOAD * RADIUS / (math.pi * modulus()))
FULL_SLIP = FRICTION * A / RADIUS
LINE = {"line_contact_radius": RADIUS, "width": 1.0}
ELLIPSE = {"semi_axes": [0.006, 0.004]}
TOLERANCE = 1e-5
LAYOUTS = {"uniform": {"elements": [16, 16]}, "fitted": {"fitted": [10, 10]}}


def forced(
    geometry: dict[str, Any], grid: dict[str, Any], force: list[Any], **options: Any
) -> dict[str, Any]:
    """A case of the load LOAD with a prescribed force."""
    creepage = options.pop("creepage", [0.0, 0.0])
    case = patch_case(
        geometry, force=LOAD, elements=1, creepage=creepage, friction=FRICTION, **options
    )
    case["grid"] = grid
    case["motion"]["tangential_force"] = force
    return case


def carter_force(creepage: float) -> float:
    stick = max(0.0, 1 - abs(creepage) / FULL_SLIP)
    return -math.copysign(1 - stick**2, creepage)


def carter_creepage(share: float) -> float:
    return -math.copysign(1 - math.sqrt(1 - abs(share)), share) * FULL_SLIP


@pytest.mark.parametrize("direction", [1, -1])
@pytest.mark.parametrize(
    ("grid", "bound"),
    # error of the force: of test_carter.py, and of fitted rows 0.3 % with eight nodes
    [({"elements": [100, 1]}, 0.01), ({"fitted": [16, 1]}, 0.003)],
    ids=["uniform", "fitted"],
)
def test_carter(grid: dict[str, Any], bound: float, direction: int) -> None:
    lines = []
    for share in (0.02, 0.1, -0.3, 0.5, 0.7, -0.9, 0.97, 0.999):
        result = solve(forced(LINE, grid, [share * MOST, 0.0], direction=direction))
        found, across = result["creepage"]
        lines.append(Line(f"force at {found:.4e}", carter_force(found), share, bound))
        # what this error of the force is in creepage, while the curve still rises
        if abs(share) < 0.8:
            slope = 2 * math.sqrt(1 - abs(share))
            exact = carter_creepage(share)
            bound_of_creepage = 1.1 * bound / slope * FULL_SLIP
            lines.append(Line(f"creepage for {share}", found, exact, bound_of_creepage))
        lines.append(Line("creepage across", across, 0, 1e-6 * FULL_SLIP))
        lines.append(Line("force", result["creep_force"][0] / MOST, share, TOLERANCE))
    check(lines)


def test_creepage_converges_with_first_order() -> None:
    counts = np.array([25, 50, 100, 200])
    exact = carter_creepage(0.64)
    cases = [forced(LINE, {"elements": [int(n), 1]}, [0.64 * MOST, 0.0]) for n in counts]
    errors = np.array([solve(case)["creepage"][0] / exact - 1 for case in cases])
    orders = -np.diff(np.log(np.abs(errors))) / np.diff(np.log(counts))
    assert np.all((orders > 0.8) & (orders < 1.2)), (errors, orders)
    assert abs(2 * errors[1] - errors[0]) < 2e-3, errors


@pytest.mark.parametrize("layout", LAYOUTS)
def test_a_third_of_it_lateral_in_plane_strain(layout: str) -> None:
    """A small force: with u_y = u_x / (1 - nu) the creepages are as F_x to F_y / (1 - nu)."""
    grid = {"uniform": {"elements": [60, 1]}, "fitted": {"fitted": [12, 1]}}[layout]
    force = 1e-3 * MOST
    creepage = solve(forced(LINE, grid, [force, force / 3]))["creepage"]
    expected = creepage[0] / 3 / (1 - STEEL["poisson_ratio"])
    # of second order in the force
    check([Line("lateral creepage", creepage[1], expected, 2e-3 * abs(expected))])


@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize("spin", [0.0, 0.4])
def test_force_creepage_force(layout: str, spin: float) -> None:
    """Solving again with the creepage found gives the prescribed force."""
    tolerance = 1e-8
    lines = []
    for share in (0.0, 0.1, 0.5, 0.9, 0.99):
        for angle in (0.2, 1.7, 3.3, 5.5):
            force = [share * MOST * math.cos(angle), share * MOST * math.sin(angle)]
            case = forced(ELLIPSE, LAYOUTS[layout], force, spin=spin, tolerance=tolerance)
            found = solve(case)
            del case["motion"]["tangential_force"]
            case["motion"]["creepage"] = found["creepage"]
            again = solve(case)
            for k in range(2):
                name = f"share {share} at {angle}, component {k}"
                target = force[k] / MOST
                lines.append(Line(name, found["creep_force"][k] / MOST, target, tolerance))
                # two solves, each to the tolerance, and the tractions' sum
                lines.append(Line(name, again["creep_force"][k] / MOST, target, 100 * tolerance))
            moment = abs(found["spin_moment"]) + 1e-3 * MOST * 0.006
            lines.append(
                Line("spin moment", again["spin_moment"], found["spin_moment"], 1e-5 * moment)
            )
    check(lines)


@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize("direction", [1, -1])
def test_at_the_edge_of_saturation(layout: str, direction: int) -> None:
    creepages = []
    for share in (0.9, 0.99, 0.999, 0.9999):
        force = [-0.8 * share * MOST, 0.6 * share * MOST]
        result = solve(forced(ELLIPSE, LAYOUTS[layout], force, direction=direction))
        for k in range(2):
            assert abs(result["creep_force"][k] - force[k]) <= 1.01 * TOLERANCE * MOST
        creepages.append(math.hypot(*result["creepage"]))
    assert all(np.diff(creepages) > 0), creepages


@pytest.mark.parametrize("layout", LAYOUTS)
def test_layer_adds_creepage(layout: str) -> None:
    """At vanishing slip a layer adds its flexibility: force = area integral of xi x / flexibility
    where it is much softer than the bodies (Kalker 1982: F = -8 a^2 b xi / (3 L))."""
    flexibility = 1e-12  # m/Pa, some twenty times that of the bodies
    layer = {"shear_modulus": 1e9, "thickness": flexibility * 1e9}
    force = 1e-3 * MOST
    a, b = ELLIPSE["semi_axes"]
    count = 40 if layout == "uniform" else 16
    grid = {"elements" if layout == "uniform" else "fitted": [count, count]}
    creepage = solve(forced(ELLIPSE, grid, [-force, 0.0], layer=layer))["creepage"][0]
    softest = 3 * flexibility * force / (8 * a * a * b)
    bodies = solve(forced(ELLIPSE, grid, [-force, 0.0]))["creepage"][0]
    # between the layer alone and both in series, but for the elements' first-order error
    low, high = softest, softest + bodies
    assert low * (1 - 1 / count) < creepage < high * (1 + 1 / count), (creepage, low, high)


def test_either_component() -> None:
    for layout, grid in LAYOUTS.items():
        both = solve(forced(ELLIPSE, grid, [0.3 * MOST, -0.4 * MOST], spin=0.2))
        xi, eta = both["creepage"]
        first = forced(ELLIPSE, grid, [0.3 * MOST, "creepage"], creepage=[0.0, eta], spin=0.2)
        second = forced(ELLIPSE, grid, ["creepage", -0.4 * MOST], creepage=[xi, 0.0], spin=0.2)
        for case in (first, second):
            found = solve(case)
            size = math.hypot(xi, eta)
            for k in range(2):
                name = f"{layout} component {k}"
                check(
                    [
                        Line(name, found["creepage"][k], both["creepage"][k], 1e-4 * size),
                        Line(name, found["creep_force"][k], both["creep_force"][k], 1e-4 * MOST),
                    ]
                )


def test_force_beyond_friction() -> None:
    grid = LAYOUTS["uniform"]
    # at the very most the solve depends on the normal force's own tolerance
    solve(forced(ELLIPSE, grid, [(1 - 10 * TOLERANCE) * MOST, 0.0]))
    for force in ([1.001 * MOST, 0.0], [0.8 * MOST, 0.7 * MOST]):
        with pytest.raises(
            railpatch.CaseError, match=r"tangential_force: value is .* allowed at m"
        ):
            railpatch.solve(forced(ELLIPSE, grid, force))
    contact = railpatch.Contact(forced(ELLIPSE, grid, [0.5 * MOST, 0.0]))
    for changes in ({"tangential_force": [0.0, 1.1 * MOST]}, {"normal_force": 0.4 * LOAD}):
        with pytest.raises(railpatch.CaseError, match="tangential_force"):
            contact.step(**changes)
    # what is prescribed stays so
    with pytest.raises(railpatch.CaseError, match="does not change"):
        contact.step(tangential_force=[0.0, "creepage"])
    with pytest.raises(railpatch.CaseError, match="creepage"):
        contact.step(creepage=[1e-3, 0.0])
    assert contact.step(tangential_force=[0.0, 0.999 * MOST]).status == "converged"


@pytest.mark.parametrize("layout", LAYOUTS)
def test_what_spin_does_not_let_through(layout: str) -> None:
    """Spin turns the tractions: all of friction in one direction needs infinite creepage."""
    case = forced(ELLIPSE, LAYOUTS[layout], [0.0, MOST], spin=0.5, tolerance=1e-9)
    result = railpatch.solve(case)
    assert result.status in ("out_of_range", "not_converged")
    assert 1e-9 < result["residual"] < 1e-2
    assert result["iterations"] <= 200
    missing = abs(result["creep_force"][1] - MOST) / MOST
    assert 0 < missing <= 2 * result["residual"]


def test_json() -> None:
    case = forced(ELLIPSE, LAYOUTS["uniform"], [0.3 * MOST, "creepage"], creepage=[0.0, 1e-4])
    found = railpatch.solve(case).to_dict()["creepage"]
    assert found[0] < 0
    assert found[1] == 1e-4
    del case["motion"]["tangential_force"]
    assert "creepage" not in railpatch.solve(case).to_dict()


def test_fast_theories_refuse() -> None:
    case = forced(ELLIPSE, LAYOUTS["uniform"], [0.0, 0.0], tangential="fastsim")
    with pytest.raises(
        railpatch.CaseError, match=r"method.tangential: value is 'fastsim', allowed"
    ):
        railpatch.solve(case)
