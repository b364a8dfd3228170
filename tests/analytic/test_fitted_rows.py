"""Rows fitted to the contact area against closed forms and quadrature.

Carter 1926, Proc. R. Soc. Lond. A 112 (see test_carter.py); full sliding, where every traction is
the bound against the rigid slip; and refinement of the rows themselves.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from patch_cases import Line, check, modulus, patch_case, solve
from scipy.integrate import dblquad

FRICTION = 0.3

# --- line contact ------------------------------------------------------------------------------

RADIUS = 0.5
LOAD = 178.90e3  # N/m, which makes a = 1 mm
A = np.sqrt(4 * LOAD * RADIUS / (np.pi * modulus()))
FULL_SLIP = FRICTION * A / RADIUS
PEAK = 2 * LOAD / (np.pi * A)


def carter_case(nodes: int, creepage: float, **options: Any) -> dict[str, Any]:
    return patch_case(
        {"line_contact_radius": RADIUS, "width": 1.0},
        force=LOAD,
        fitted=[nodes, 1],
        creepage=[creepage, 0.0],
        friction=FRICTION,
        normal="hertz",
        **options,
    )


def carter(creepage: float) -> float:
    """F over mu F_n."""
    stick = max(0.0, 1 - abs(creepage) / FULL_SLIP)
    return -np.sign(creepage) * (1 - stick**2)


# what a fitted discretisation is for: a per cent with ten nodes, 3 per mille with twenty
@pytest.mark.parametrize(("nodes", "bound"), [(8, 1e-2), (12, 1e-2), (20, 3e-3), (40, 3e-3)])
def test_force_on_the_creep_curve(nodes: int, bound: float) -> None:
    lines = []
    for share in (0.02, 0.1, 0.2, 0.4, 0.6, 0.8, 0.9, 1.1, 3.0):
        for direction in (1, -1):
            creepage = -share * FULL_SLIP
            found = solve(carter_case(nodes, creepage, direction=direction))["creep_force"][0]
            lines.append(
                Line(f"{share} {direction}", found / (FRICTION * LOAD), carter(creepage), bound)
            )
    check(lines)


@pytest.mark.parametrize("direction", [1, -1])
@pytest.mark.parametrize("stick", [0.3, 0.6, 0.85])
@pytest.mark.parametrize("nodes", [20, 40])
def test_traction_and_stick(nodes: int, stick: float, direction: int) -> None:
    case = carter_case(nodes, -(1 - stick) * FULL_SLIP, direction=direction)
    result = solve(case, fields=True)
    x, traction = result["x"].ravel() / A, result["traction"][0, 0]

    def ellipse(u: np.ndarray) -> np.ndarray:
        return np.sqrt(np.maximum(0.0, 1 - u**2))

    middle = direction * (1 - stick)
    exact = FRICTION * PEAK * (ellipse(x) - stick * ellipse((x - middle) / stick))
    error = np.abs(traction - exact) / (FRICTION * PEAK)
    # stick ends with an infinite slope: an error of a node's place there is one of its square root
    lines = [
        Line("mean error / (mu p0)", float(np.mean(error)), 0, 1.5 / nodes),
        Line("greatest error / (mu p0)", float(np.max(error)), 0, 2 / np.sqrt(nodes)),
    ]
    sticking = result["element_division"][0] == 1
    # where stick ends, from the leading edge on, to the distance of two nodes
    end = direction * (1 - 2 * stick)
    last = x[sticking].min() if direction > 0 else x[sticking].max()
    lines.append(Line("end of stick / a", float(last), end, 2 * np.pi / (nodes + 1)))
    check(lines)
    # stick is one piece at the leading edge
    from_leading_edge = sticking[::-1] if direction > 0 else sticking
    assert np.all(np.diff(from_leading_edge.astype(int)) <= 0)


# --- full sliding ------------------------------------------------------------------------------

AXES = (0.006, 0.004)
FORCE = 1e5
BOUND = FRICTION * FORCE
LENGTH = float(np.sqrt(AXES[0] * AXES[1]))
# the surfaces' own displacements turn no slip by more than 1e-5 of it
FAST = 1e3


def ellipse_case(fitted: list[int], creepage: list[float], spin: float, **options: Any):
    options = {"normal": "hertz", "friction": FRICTION, "force": FORCE, **options}
    return patch_case(
        {"semi_axes": list(AXES)}, fitted=fitted, creepage=creepage, spin=spin, **options
    )


@pytest.mark.parametrize("angle", [0, 40, 90, 180, 250])
@pytest.mark.parametrize("fitted", [[3, 3], [8, 5], [12, 16]])
def test_full_sliding_is_the_bound(fitted: list[int], angle: float) -> None:
    way = np.array([np.cos(np.radians(angle)), np.sin(np.radians(angle))])
    result = solve(ellipse_case(fitted, list(FAST * way), 0.0, tolerance=1e-10))
    force = np.array(result["creep_force"])
    assert result["elements"]["stick"] == 0
    check(
        [
            Line("along", float(force @ -way) / BOUND, 1.0, 1e-8),
            Line("across", float(force @ [-way[1], way[0]]) / BOUND, 0.0, 1e-5),
        ]
    )


def sliding(creepage: list[float], spin: float) -> np.ndarray:
    """F_x, F_y and M_z over the square root of a b, over mu F_n, of p = mu p_n (-w/|w|)."""

    def integrand(angle: float, height: float, component: int) -> float:
        # x = a cos(v) sin(u), y = b sin(v): the pressure's root becomes smooth
        root = np.cos(height)
        x, y = AXES[0] * root * np.sin(angle), AXES[1] * np.sin(height)
        w = np.array([creepage[0] - spin * y, creepage[1] + spin * x])
        p = -w / max(float(np.hypot(*w)), 1e-300)
        value = (p[0], p[1], (x * p[1] - y * p[0]) / LENGTH)[component]
        # 3/(2 pi) sqrt(1 - x^2/a^2 - y^2/b^2) dx dy/(a b)
        return 3 / (2 * np.pi) * value * (root * np.cos(angle)) ** 2 * root

    half = np.pi / 2
    return np.array(
        [
            dblquad(integrand, -half, half, -half, half, args=(k,), epsabs=1e-4, epsrel=1e-4)[0]
            for k in range(3)
        ]
    )


# the point about which the contact turns: outside, beside and inside the ellipse
POLES = {
    "outside": (0.0, 0.012),
    "beside": (0.008, 0.003),
    "inside": (0.002, -0.001),
    "middle": (0.0, 0.0),
}


@pytest.mark.parametrize("nodes", [20, 40])
@pytest.mark.parametrize("name", POLES)
def test_full_sliding_with_spin_is_a_quadrature(name: str, nodes: int) -> None:
    spin = FAST / LENGTH
    x, y = POLES[name]
    # w = 0 at the pole
    creepage = [spin * y, -spin * x]
    result = solve(ellipse_case([nodes, nodes], creepage, spin))
    found = np.array([*result["creep_force"], result["spin_moment"] / LENGTH]) / BOUND
    # around a pole in contact the slip is taken up to half a step dx ahead of the node, by the
    # share dx^2/(y^2 + dx^2) in the row at the distance y. With the peak pressure there and the
    # jump 2 mu p of the traction that is 3/(2 pi a b) 2 (dx/2) pi dx of mu F_n
    step = np.pi / (nodes + 1) * AXES[0]
    inside = name in ("inside", "middle")
    bound = 5e-3 + (1.5 * step**2 / LENGTH**2 if inside else 0.0)
    target = sliding(creepage, spin)
    names = ("F_x", "F_y", "M_z")
    check(
        [Line(n, float(v), float(t), bound) for n, v, t in zip(names, found, target, strict=True)]
    )


# --- refinement --------------------------------------------------------------------------------

UNIT = BOUND / (4 * 82e9 * AXES[0] * AXES[1])  # creepage at which the linear theory saturates
MOTIONS = {
    "longitudinal": ([0.7 * UNIT, 0.0], 0.0),
    "lateral": ([0.0, 0.5 * UNIT], 0.0),
    "creepages and spin": ([0.5 * UNIT, -0.3 * UNIT], 0.4 * UNIT / LENGTH),
    "spin": ([0.0, 0.0], 0.8 * UNIT / LENGTH),
}


@pytest.mark.parametrize("name", MOTIONS)
def test_errors_fall_with_the_rows(name: str) -> None:
    creepage, spin = MOTIONS[name]

    def wrench(n: int) -> np.ndarray:
        result = solve(ellipse_case([n, n], creepage, spin, tolerance=1e-7))
        return np.array([*result["creep_force"], result["spin_moment"] / LENGTH]) / BOUND

    counts, finest = (8, 12, 16, 24), wrench(32)
    errors = np.array([np.linalg.norm(wrench(n) - finest) for n in counts])
    order = -np.polyfit(np.log(counts), np.log(errors), 1)[0]
    print(f"\n{name}: limit {finest}, errors at {counts}: {errors}, order {order:.2f}")
    assert order >= 1.0
    # ten nodes across give a per cent
    assert errors[1] <= 0.01


def test_symmetric_rows_give_symmetric_forces() -> None:
    """Longitudinal creepage alone has no lateral force, to rounding of the solve."""
    result = solve(ellipse_case([9, 8], [UNIT, 0.0], 0.0, tolerance=1e-10))
    force, moment = result["creep_force"], result["spin_moment"]
    assert abs(force[1]) <= 1e-8 * BOUND
    assert abs(moment) <= 1e-8 * BOUND * LENGTH


# --- other normal theories ---------------------------------------------------------------------


@pytest.mark.parametrize("normal", ["half_space", "analyn"])
def test_any_pressure_of_an_ellipse_gives_the_ellipse_s_forces(normal: str) -> None:
    """Where the surfaces are quadratic both pressures are Hertz's, as far as a grid shows them."""
    axes = (0.005, 0.005)
    radius = patch_radius(axes[0])
    creepage, spin = [0.6 * UNIT, -0.3 * UNIT], 0.2 * UNIT / LENGTH

    def wrench(normal: str, **grid: Any) -> np.ndarray:
        geometry = {"curvatures": [1 / (2 * radius)] * 2}
        options = {"force": FORCE, "friction": FRICTION, "spin": spin}
        case = patch_case(
            geometry, fitted=[12, 12], creepage=creepage, normal=normal, **options, **grid
        )
        result = solve(case)
        return np.array([*result["creep_force"], result["spin_moment"] / axes[0]]) / BOUND

    found, target = wrench(normal, elements=30), wrench("hertz")
    names = ("F_x", "F_y", "M_z")
    # the circle's edge is known to part of an element, one of thirty across; forces grow with the
    # radius at constant load at most linearly, which is what 1 % allows
    check([Line(n, float(v), float(t), 0.01) for n, v, t in zip(names, found, target, strict=True)])


def patch_radius(a: float) -> float:
    """m, combined radius of a ball on a plane with the contact radius a (Johnson 1985, 4.2)."""
    return 4 * modulus() * a**3 / (3 * FORCE)


@pytest.mark.parametrize("layer", [None, {"shear_modulus": 8.2e9, "thickness": 5e-5}])
@pytest.mark.parametrize("direction", [1, -1])
@pytest.mark.parametrize("name", MOTIONS)
def test_elastic_energy_of_the_tractions(name: str, direction: int, layer: Any) -> None:
    """The same as uniform grids', whose error is of first order and extrapolated."""
    creepage, spin = MOTIONS[name]

    def energy(**options: Any) -> float:
        case = patch_case(
            {"semi_axes": list(AXES)},
            force=FORCE,
            creepage=creepage,
            spin=spin,
            direction=direction,
            friction=FRICTION,
            layer=layer,
            normal="hertz",
            **options,
        )
        if options.get("tangential") == "none":
            del case["friction"]
            case.pop("layer", None)
        return solve(case)["elastic_energy"]

    normal = energy(tangential="none", elements=16)
    coarse, fine = (energy(elements=n) - normal for n in (30, 60))
    limit = 2 * fine - coarse
    found = energy(fitted=[16, 16]) - normal
    check([Line(name, found, limit, 0.02 * limit)])


# --- odd shapes --------------------------------------------------------------------------------


@pytest.mark.parametrize("ratio", [0.01, 0.1, 5.0, 20.0])
@pytest.mark.parametrize("fitted", [[3, 3], [12, 24], [24, 8], [8, 40]])
def test_rows_much_narrower_than_their_nodes_are_apart(ratio: float, fitted: list[int]) -> None:
    """Any shape of ellipse with any rows: converged from a cold start, and within the bound."""
    axes = [0.004 * ratio**0.5, 0.004 * ratio**-0.5]
    linear = FRICTION * FORCE / (4 * 82e9 * 0.004**2)
    for share, spin in ((1e-4, 0.0), (0.5, 0.5), (0.0, 1.0), (20.0, 5.0)):
        creepage = [share * linear, share * linear / 3]
        case = patch_case(
            {"semi_axes": axes},
            force=FORCE,
            fitted=fitted,
            creepage=creepage,
            spin=spin * linear / 0.004,
            friction=FRICTION,
            normal="hertz",
        )
        result = solve(case)
        force = np.hypot(*result["creep_force"]) / BOUND
        assert force <= 1 + 1e-9, (share, spin)
        assert result["friction_power"] > 0


@pytest.mark.parametrize("elements", [[2, 2], [2, 8], [8, 2], [3, 3], [40, 5]])
@pytest.mark.parametrize("normal", ["half_space", "kik_piotrowski", "analyn"])
def test_rows_on_the_pressure_of_a_few_elements(normal: str, elements: list[int]) -> None:
    case = patch_case(
        {"curvatures": [1.0, 1.3]},
        force=1e4,
        elements=elements,
        fitted=[8, 8],
        creepage=[1e-3, 5e-4],
        spin=0.1,
        normal=normal,
    )
    result = solve(case)
    assert np.hypot(*result["creep_force"]) <= 0.3 * 1e4 * (1 + 1e-9)
    assert result["friction_power"] > 0
    case["method"]["tangential"] = "none"
    del case["friction"], case["grid"]["fitted"]
    # tractions add to the energy of the pressure, here less than mu^2 (2 - nu)/(1 - nu) of it
    assert 1 < result["elastic_energy"] / solve(case)["elastic_energy"] < 1.2
