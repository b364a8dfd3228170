"""Hertz contact against closed forms by elliptic integrals.

Johnson 1985, Contact mechanics, section 3.3 and chapter 4: for p = p0 sqrt(1 - (x/a)^2 - (y/b)^2),
p0 = 3 F / (2 pi a b), with m = 1 - (minor/major)^2 the approach is 3 F K(m) / (2 pi E* major) and
the undeformed distance has the curvatures F/(2 pi E*) times the integrals below.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest
import railpatch
from patch_cases import Line, check, modulus, patch_case, solve
from scipy.special import ellipe, ellipk

FORCE = 1e5
MINOR = 0.004
RATIOS = (0.5, 1.0, 2.0, 5.0)
COUNTS = (8, 12, 16, 24, 32, 48, 64, 96)
DISCRETISATION = 5e-3  # at 24 x 24
CLOSED_FORM = 1e-10
TOLERANCE = 1e-5  # of the solver


@dataclass(frozen=True)
class Ellipse:
    """Semi-axes along rolling and lateral, and what follows from the force."""

    a: float
    b: float
    force: float = FORCE

    @property
    def pressure(self) -> float:
        return 3 * self.force / (2 * np.pi * self.a * self.b)

    @property
    def approach(self) -> float:
        major, minor = max(self.a, self.b), min(self.a, self.b)
        m = 1 - (minor / major) ** 2
        return 3 * self.force * ellipk(m) / (2 * np.pi * modulus() * major)

    @property
    def curvatures(self) -> list[float]:
        major, minor = max(self.a, self.b), min(self.a, self.b)
        m = 1 - (minor / major) ** 2
        size = 3 * self.force / (2 * np.pi * modulus() * major)
        if m == 0:
            along = across = size * np.pi / (4 * major**2)
        else:
            along = size * (ellipk(m) - ellipe(m)) / (m * major**2)
            across = size * (ellipe(m) / (1 - m) - ellipk(m)) / (m * major**2)
        # the greater curvature lies along the shorter axis
        return [along, across] if self.a >= self.b else [across, along]

    @property
    def axes(self) -> dict[str, list[float]]:
        return {"semi_axes": [self.a, self.b]}


def ellipse(ratio: float) -> Ellipse:
    return Ellipse(MINOR * ratio, MINOR) if ratio > 1 else Ellipse(MINOR, MINOR / ratio)


def test_half_space_at_24_elements() -> None:
    lines = []
    for ratio in RATIOS:
        e = ellipse(ratio)
        result = solve(patch_case(e.axes, force=FORCE, elements=24))
        for name, target in (("max_pressure", e.pressure), ("approach", e.approach)):
            lines.append(
                Line(f"a/b = {ratio} {name}", result[name], target, DISCRETISATION * target)
            )
        lines.append(
            Line(f"a/b = {ratio} normal_force", result["normal_force"], FORCE, 1e-9 * FORCE)
        )
        # the area is a count of elements: right to half an element along the edge
        area, found = np.pi * e.a * e.b, result["contact_area"]
        lines.append(Line(f"a/b = {ratio} contact_area", found, area, area / 24))
        energy = 0.4 * FORCE * e.approach
        lines.append(
            Line(f"a/b = {ratio} elastic_energy", result["elastic_energy"], energy, 0.01 * energy)
        )
    check(lines)


@pytest.mark.parametrize("ratio", RATIOS)
def test_convergence_is_of_second_order(ratio: float) -> None:
    """The peak is sampled half an element beside the middle, so its error is 1/n^2 of it; the
    approach, a mean over the contact, converges at least as fast."""
    e = ellipse(ratio)
    errors = []
    for n in COUNTS:
        result = solve(patch_case(e.axes, force=FORCE, elements=n, tolerance=1e-9))
        errors.append(
            [result["max_pressure"] / e.pressure - 1, result["approach"] / e.approach - 1]
        )
    found = np.abs(errors)
    orders = -np.polyfit(np.log(COUNTS), np.log(found), 1)[0]
    table = "\n".join(
        f"{n:4d} x {n:<4d} peak {p: .2e}  approach {d: .2e}"
        for n, (p, d) in zip(COUNTS, errors, strict=True)
    )
    print(f"\na/b = {ratio}\n{table}\norder of peak {orders[0]:.2f}, of approach {orders[1]:.2f}")
    assert 1.8 < orders[0] < 2.3, table
    assert 1.8 < orders[1] < 2.6, table
    assert np.all(np.diff(found[:, 0]) < 0), table


@pytest.mark.parametrize("ratio", RATIOS)
def test_force_and_approach_prescribed_agree(ratio: float) -> None:
    """With curvatures and an element size given, both ways discretise the same problem."""
    e = ellipse(ratio)
    shape = {"curvatures": e.curvatures}
    size = [2 * e.a / 23.5, 2 * e.b / 23.5]
    by_force = solve(patch_case(shape, force=FORCE, element_size=size))
    by_approach = solve(patch_case(shape, approach=by_force["approach"], element_size=size))
    bound = 10 * TOLERANCE
    check(
        [
            Line(f"a/b = {ratio} {name}", by_approach[name], by_force[name], bound * by_force[name])
            for name in ("normal_force", "max_pressure", "contact_area", "elastic_energy")
        ]
    )


@pytest.mark.parametrize("ratio", [*RATIOS, 0.1, 10.0])
@pytest.mark.parametrize("shape", ["semi_axes", "curvatures"])
@pytest.mark.parametrize("load", ["force", "approach"])
def test_hertz_method_is_the_closed_form(ratio: float, shape: str, load: str) -> None:
    e = ellipse(ratio)
    geometry = e.axes if shape == "semi_axes" else {"curvatures": e.curvatures}
    given = {"force": FORCE} if load == "force" else {"approach": e.approach}
    result = solve(patch_case(geometry, elements=16, normal="hertz", **given))
    targets = {
        "normal_force": FORCE,
        "approach": e.approach,
        "max_pressure": e.pressure,
        "contact_area": np.pi * e.a * e.b,
        "elastic_energy": 0.4 * FORCE * e.approach,
    }
    check(
        [
            Line(f"a/b = {ratio} {shape} {load} {name}", result[name], target, CLOSED_FORM * target)
            for name, target in targets.items()
        ]
    )


def test_no_contact_without_approach() -> None:
    for approach in (0.0, -1e-5):
        case = patch_case({"semi_axes": [0.006, 0.006]}, approach=approach, elements=16)
        result = railpatch.solve(case)
        assert result.status == "no_contact"
        assert result["normal_force"] == 0
        assert result["contact_area"] == 0


def test_line_contact_pressure() -> None:
    """Johnson 1985, chapter 4: a^2 = 4 f R / (pi E*), p0 = 2 f / (pi a)."""
    radius, force, width = 0.5, 178.9e3, 1.0
    a = np.sqrt(4 * force / width * radius / (np.pi * modulus()))
    shape = {"line_contact_radius": radius, "width": width}
    lines = []
    for n in (25, 50, 100, 200):
        result = solve(patch_case(shape, force=force, elements=[n, 1]), fields=True)
        peak = 2 * force / width / (np.pi * a)
        x, p = result["x"], result["pressure"][0]
        lines.append(Line(f"{n} elements peak", result["max_pressure"], peak, peak / n))
        # inside the contact, away from the infinite slope at its edges
        inner = np.abs(x) < 0.9 * a
        exact = peak * np.sqrt(1 - (x[inner] / a) ** 2)
        worst = float(np.max(np.abs(p[inner] - exact)) / peak)
        lines.append(Line(f"{n} elements greatest error of p / p0", worst, 0, 1 / n))
    check(lines)
