"""Kik-Piotrowski and ANALYN, where closed forms and symmetries say what they must give.

Quadratic surfaces: ANALYN is Hertz's solution (Sichani, Enblom and Berg 2014). Kik-Piotrowski is
not (Piotrowski and Kik 2008): from its rules follows an ellipse of Hertz's axis ratio and the area
pi 0.55 d/sqrt(A B), with semi-elliptic pressure that gives the displacement d at the centre. If
that ellipse is s times as long and wide as Hertz's at the approach d, it carries s times the force
at 1/s of the peak pressure. Corrected it is Hertz's, s = 1.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import railpatch
from patch_cases import Line, check, modulus, patch_case, solve
from scipy.special import ellipe, ellipk

METHODS = ("kik_piotrowski", "kik_piotrowski_corrected", "analyn")
TABLE = 1e-8  # relative: the functions of the curvatures' ratio are interpolated
EXACT = 1e-11  # relative: rounding
APPROACH = 5e-5
RATIOS = (0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0)


def hertz(a: float, b: float) -> tuple[list[float], dict[str, float]]:
    """Curvatures (1/m) and results of the contact ellipse at APPROACH; Johnson 1985, chapter 4."""
    major, minor = max(a, b), min(a, b)
    m = 1 - (minor / major) ** 2
    k, e = ellipk(m), ellipe(m)
    force = 2 * np.pi * modulus() * major * APPROACH / (3 * k)
    size = 3 * force / (2 * np.pi * modulus())
    small = (k - e) / (m * major**3) if m else np.pi / (4 * major**3)
    large = (e / (1 - m) - k) / (m * major**3) if m else small
    curvatures = [size * small, size * large] if a >= b else [size * large, size * small]
    return curvatures, {
        "normal_force": force,
        "approach": APPROACH,
        "max_pressure": 3 * force / (2 * np.pi * a * b),
        "contact_area": np.pi * a * b,
    }


def axes(ratio: float) -> tuple[float, float]:
    return 0.005 * np.sqrt(ratio), 0.005 / np.sqrt(ratio)


@pytest.mark.parametrize("load", ["force", "approach"])
@pytest.mark.parametrize("elements", [[8, 13], [24, 24]])
@pytest.mark.parametrize("ratio", RATIOS)
def test_analyn_is_hertz(ratio: float, elements: list[int], load: str) -> None:
    curvatures, target = hertz(*axes(ratio))
    given = {load: target["normal_force" if load == "force" else "approach"]}
    result = solve(
        patch_case({"curvatures": curvatures}, elements=elements, normal="analyn", **given)
    )
    target["elastic_energy"] = 0.4 * target["normal_force"] * target["approach"]
    # int l dy by quadrature over strips, int l^4 dy likewise
    bound = {"contact_area": 1e-4, "elastic_energy": 1e-4}
    check(
        [
            Line(f"{ratio} {elements} {name}", result[name], value, bound.get(name, TABLE) * value)
            for name, value in target.items()
        ]
    )


@pytest.mark.parametrize("ratio", RATIOS)
def test_kik_piotrowski_on_quadratic_surfaces(ratio: float) -> None:
    a, b = axes(ratio)
    curvatures, target = hertz(a, b)
    size = np.sqrt(0.55 * APPROACH / np.sqrt(np.prod(curvatures)) / (a * b))
    for name, factor in (("normal_force", size), ("max_pressure", 1 / size)):
        target[name] *= factor
    target["contact_area"] *= size**2
    errors = {}
    for elements in (8, 16, 32, 64):
        case = patch_case(
            {"curvatures": curvatures},
            approach=APPROACH,
            elements=elements,
            normal="kik_piotrowski",
        )
        result = solve(case)
        errors[elements] = {name: result[name] / value - 1 for name, value in target.items()}
    print(f"\na/b = {ratio}, s = {size}: {errors}")
    # the displacement is integrated over strips, whose edges fall anywhere
    for name in target:
        assert abs(errors[16][name]) < 5e-3
        assert abs(errors[64][name]) < 5e-4


@pytest.mark.parametrize("load", ["force", "approach"])
@pytest.mark.parametrize("ratio", [*RATIOS, 0.14, 0.33, 0.7, 1.5, 3.0, 7.0])
def test_corrected_kik_piotrowski_is_hertz(ratio: float, load: str) -> None:
    """Its ellipse is Hertz's to what the displacement's quadrature over strips leaves."""
    curvatures, target = hertz(*axes(ratio))
    given = {load: target["normal_force" if load == "force" else "approach"]}
    for elements, bound in ((8, 0.02), (16, 5e-3), (64, 5e-4)):
        case = patch_case(
            {"curvatures": curvatures},
            elements=elements,
            normal="kik_piotrowski_corrected",
            **given,
        )
        result = solve(case)
        for name, value in target.items():
            assert result[name] == pytest.approx(value, rel=bound), (elements, name)


@pytest.mark.parametrize("method", METHODS)
def test_published_error_on_a_circle(method: str) -> None:
    """On a circle s is sqrt(1.1): at given force Kik-Piotrowski's peak is 1.1^(-2/3) of Hertz's."""
    curvatures, target = hertz(0.005, 0.005)
    result = solve(
        patch_case(
            {"curvatures": curvatures}, force=target["normal_force"], elements=32, normal=method
        )
    )
    expected = 1.1 ** (-2 / 3) if method == "kik_piotrowski" else 1.0
    assert result["max_pressure"] / target["max_pressure"] == pytest.approx(expected, rel=1e-4)


def bumpy(shift: float = 0.0, flip: tuple[int, int] = (1, 1)) -> np.ndarray:
    """m, [41, 61] at 0.3 mm: a skewed valley along rolling whose bottom is a lopsided quartic."""
    x = 3e-4 * (np.arange(61) - 30)[None, :] * flip[0]
    y = 3e-4 * (np.arange(41) - 20)[:, None] * flip[1] - shift
    along = 1.1 * (1 + 20 * y) * (x - 0.05 * y) ** 2
    return along + 0.4 * y**2 + 9e1 * y**3 + 4e4 * y**4


def gap_case(gap: np.ndarray, method: str, scale: float = 1.0, **given: Any) -> dict[str, Any]:
    return patch_case(
        {"undeformed_distance": (scale * gap).tolist()},
        element_size=[3e-4 * scale, 3e-4 * scale],
        normal=method,
        **given,
    )


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("gap", ["quadratic", "bumpy"])
def test_prescribed_force_is_met(method: str, gap: str) -> None:
    distance = bumpy()
    if gap == "quadratic":
        x, y = np.meshgrid(3e-4 * (np.arange(61) - 30.3), 3e-4 * (np.arange(41) - 19.6))
        distance = 1.1 * x**2 + 0.8 * y**2
    for force in (10.0, 1e3, 2e4):
        by_force = solve(gap_case(distance, method, force=force), fields=True)
        assert by_force["normal_force"] == force
        assert by_force["residual"] < 1e-9
        pressure = np.array(by_force["pressure"])
        assert pressure.sum() * 9e-8 == pytest.approx(force, rel=EXACT)
        by_approach = solve(gap_case(distance, method, approach=by_force["approach"]))
        check(
            [
                Line(f"{force} {name}", by_approach[name], by_force[name], 1e-9 * by_force[name])
                for name in ("normal_force", "max_pressure", "contact_area", "elastic_energy")
            ]
        )


def test_edges_fall_anywhere_in_an_element() -> None:
    """Moved on its grid in both directions, a quadratic surface gives ANALYN the same contact."""
    _, target = hertz(0.005, 0.004)
    curvatures, _ = hertz(0.005, 0.004)
    for shift in np.linspace(0, 1, 7):
        x, y = np.meshgrid(4e-4 * (np.arange(40) - 19 - shift), 5e-4 * (np.arange(30) - 14 - shift))
        gap = curvatures[0] * x**2 + curvatures[1] * y**2
        result = solve(
            patch_case(
                {"undeformed_distance": gap.tolist()},
                element_size=[4e-4, 5e-4],
                approach=APPROACH,
                normal="analyn",
            )
        )
        for name in ("normal_force", "max_pressure"):
            assert result[name] == pytest.approx(target[name], rel=TABLE), shift


@pytest.mark.parametrize("method", METHODS)
def test_mirrored_surfaces(method: str) -> None:
    result = solve(gap_case(bumpy(), method, approach=6e-5), fields=True)
    pressure = np.array(result["pressure"])
    for flip in ((-1, 1), (1, -1), (-1, -1)):
        other = solve(gap_case(bumpy(flip=flip), method, approach=6e-5), fields=True)
        for name in ("normal_force", "max_pressure", "contact_area", "elastic_energy"):
            assert other[name] == pytest.approx(result[name], rel=EXACT)
        mirrored = np.array(other["pressure"])[:: flip[1], :: flip[0]]
        np.testing.assert_allclose(mirrored, pressure, rtol=0, atol=1e-9 * pressure.max())


@pytest.mark.parametrize("method", METHODS)
def test_change_of_units(method: str) -> None:
    """Lengths times L, moduli times M: forces times M L^2, pressures times M."""
    length, stiffness = 7.0, 0.3
    result = solve(gap_case(bumpy(), method, approach=6e-5))
    case = gap_case(bumpy(), method, scale=length, approach=6e-5 * length)
    case["material"]["shear_modulus"] *= stiffness
    other = solve(case)
    factors = {
        "normal_force": stiffness * length**2,
        "max_pressure": stiffness,
        "contact_area": length**2,
        "elastic_energy": stiffness * length**3,
    }
    for name, factor in factors.items():
        assert other[name] == pytest.approx(factor * result[name], rel=1e-10), name


@pytest.mark.parametrize("method", METHODS)
def test_pressure_is_semi_elliptic_along_rolling(method: str) -> None:
    """In each row p^2 is a quadratic function of x that falls to zero at the chord's ends."""
    curvatures, _ = hertz(0.006, 0.004)
    case = patch_case(
        {"curvatures": curvatures}, approach=APPROACH, elements=[32, 16], normal=method
    )
    result = solve(case, fields=True)
    x, pressure = np.array(result["x"]), np.array(result["pressure"])
    rows = 0
    for row in pressure:
        inside = row > 0
        if inside.sum() < 6:
            continue
        rows += 1
        fit = np.polyfit(x[inside] ** 2, row[inside] ** 2, 1)
        np.testing.assert_allclose(
            np.polyval(fit, x[inside] ** 2), row[inside] ** 2, atol=1e-9 * fit[1]
        )
        ends = np.sqrt(-fit[1] / fit[0])
        assert np.all(inside == (np.abs(x) < ends))
    assert rows >= 14


@pytest.mark.parametrize("method", METHODS)
def test_apart(method: str) -> None:
    result = railpatch.solve(gap_case(bumpy(), method, approach=-1e-6))
    assert result.status == "no_contact"
    assert result["normal_force"] == result["contact_area"] == 0


@pytest.mark.parametrize("method", METHODS)
def test_contact_beyond_the_grid(method: str) -> None:
    result = railpatch.solve(gap_case(bumpy()[15:25], method, approach=6e-5))
    assert result.status == "out_of_range"


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("direction", [1, -1])
def test_full_sliding(method: str, direction: int) -> None:
    """Creep force = coefficient of friction times normal force; FASTSIM's may turn a little."""
    for tangential in ("fastsim", "full"):
        case = gap_case(bumpy(), method, approach=6e-5, creepage=[3, 4], direction=direction)
        case["method"]["tangential"] = tangential
        result = solve(case)
        force = 0.3 * result["normal_force"]
        assert np.hypot(*result["creep_force"]) == pytest.approx(force, rel=1e-3)
        if tangential == "full":
            assert result["creep_force"] == pytest.approx([-0.6 * force, -0.8 * force], rel=1e-3)
        assert result["elements"]["stick"] == 0
