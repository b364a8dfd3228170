"""Three Hertzian cases with creepage and spin, results of the program CONTACT.

Published CONTACT results for a = 7.257 mm, b = 5.155 mm, G = 82 GPa, nu = 0.28, mu = 0.3, forces on
the wheel, printed to four digits. Their grids are not known: fine grids reproduce them within 0.5 %
of mu F_n.
"""

from __future__ import annotations

import pytest
from patch_cases import Line, check, patch_case, solve

A, B = 7.257e-3, 5.155e-3
FRICTION = 0.3
# force, creepage, spin (1/m): Fx, Fy (N), Mz (N m)
CASES = {
    "partial slip": (90e3, (0.002, 0.003), 0.1, -14350, -22320, None),
    "full sliding": (90e3, (0.03, 0.02), 1.0, -22270, -15110, -6.393),
    "half the load": (45e3, (0.003, 0.002), 0.1, -10960, -7827, -2.605),
}
ELEMENTS = 48
OF_CAPACITY = 5e-3  # discretisation of both sides and the digits given
OF_MOMENT = 0.02


# fitted rows: 1.5 % of mu F_n is wanted of twelve nodes across, of twice as many what fine grids do
GRIDS = {
    "uniform 48": ({"elements": ELEMENTS}, OF_CAPACITY),
    "fitted 12": ({"fitted": [12, 12], "normal": "hertz"}, 3 * OF_CAPACITY),
    "fitted 24": ({"fitted": [24, 24], "normal": "hertz"}, OF_CAPACITY),
}


@pytest.mark.parametrize("grid", GRIDS)
@pytest.mark.parametrize("name", CASES)
def test_case(name: str, grid: str) -> None:
    force, creepage, spin, fx, fy, mz = CASES[name]
    options, of_capacity = GRIDS[grid]
    case = patch_case(
        {"semi_axes": [A, B]},
        force=force,
        creepage=creepage,
        spin=spin,
        friction=FRICTION,
        **options,
    )
    result = solve(case)
    bound = of_capacity * FRICTION * force
    lines = [
        Line("F_x", result["creep_force"][0], fx, bound),
        Line("F_y", result["creep_force"][1], fy, bound),
    ]
    if mz is not None:
        lines.append(Line("M_z", result["spin_moment"], mz, OF_MOMENT * abs(mz)))
    check(lines)
