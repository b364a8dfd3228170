"""Large spin on an ellipse with a/b = 2: the program CONTACT on the same grid, digit by digit.

CONTACT 25.2 with 40 x 40 elements over the ellipse's box, edges on the axes, pressure of the
half-space and its term dq/6 in the rigid slip: F_y / (mu F_n) = -0.6074, M_z = -48.21 N m, reading
error half a unit of the last digit.
"""

from __future__ import annotations

import numpy as np
from patch_cases import Line, check, patch_case, solve

FORCE, FRICTION = 82e3, 0.3
SIZE = (4e-4, 2e-4)


def spin_case(offset: str, refinement: float = 1.0, tolerance: float = 1e-6):
    return patch_case(
        {"semi_axes": [8e-3, 4e-3]},
        force=FORCE,
        element_size=[v / refinement for v in SIZE],
        creepage=[0.0, -6.25e-4],
        spin=0.625,
        friction=FRICTION,
        spin_offset=offset,
        tolerance=tolerance,
    )


def test_the_same_grid_gives_the_same_digits() -> None:
    result = solve(spin_case("sixth"))
    check(
        [
            Line("F_y / (mu F_n)", result["creep_force"][1] / (FRICTION * FORCE), -0.6074, 6e-5),
            Line("M_z", result["spin_moment"], -48.21, 6e-3),
            Line("F_x / (mu F_n)", result["creep_force"][0] / (FRICTION * FORCE), 0, 1e-5),
            Line("elements in stick", result["elements"]["stick"], 356, 3),
            Line("elements in slip", result["elements"]["slip"], 920, 3),
        ]
    )


def test_both_rules_tend_to_the_same_limit() -> None:
    """The offset of a sixth of an element is of the order of the discretisation error."""
    refinements = (0.5, 1.0, 2.0)
    values = {
        offset: np.array(
            [
                [r["creep_force"][1] / (FRICTION * FORCE), r["spin_moment"]]
                for r in (solve(spin_case(offset, k)) for k in refinements)
            ]
        )
        for offset in ("none", "sixth")
    }
    gap = np.abs(values["sixth"] - values["none"])
    print("\nrefinement, F_y and M_z without, with the offset")
    for row, k in enumerate(refinements):
        print(f"{k:4.1f} {values['none'][row]} {values['sixth'][row]}")
    # the difference halves with the elements
    ratios = gap[1:] / gap[:-1]
    assert np.all((ratios > 0.35) & (ratios < 0.65)), ratios
    limits = {offset: 2 * v[2] - v[1] for offset, v in values.items()}
    check(
        [
            Line("limit of F_y / (mu F_n)", limits["sixth"][0], limits["none"][0], 3e-3),
            Line("limit of M_z", limits["sixth"][1], limits["none"][1], 0.2),
        ]
    )


def test_fitted_rows_give_the_limit_of_uniform_grids() -> None:
    """The uniform grids' error is of first order, so that the two finest extrapolate."""
    case = spin_case("none")
    case["grid"] = {"fitted": [24, 16]}
    case["method"]["normal"] = "hertz"
    rows = solve(case)
    grids = [solve(spin_case("none", k)) for k in (1.0, 2.0, 4.0)]
    length = np.sqrt(8e-3 * 4e-3)

    def wrench(result) -> np.ndarray:
        return np.array([*result["creep_force"], result["spin_moment"] / length]) / (
            FRICTION * FORCE
        )

    values = [wrench(result) for result in grids]
    for value in values:
        print(value)
    limit = 2 * values[2] - values[1]
    # the limit is known to half of what is asked of the rows
    before = 2 * values[1] - values[0]
    assert np.all(np.abs(limit - before) < 2.5e-3), (before, limit)
    names = ("F_x", "F_y", "M_z")
    check(
        [
            Line(f"{n} / (mu F_n)", float(v), float(t), 5e-3)
            for n, v, t in zip(names, wrench(rows), limit, strict=True)
        ]
    )
