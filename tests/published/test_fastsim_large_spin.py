"""Large spin on an ellipse with a/b = 2 by FASTSIM: the program CONTACT on the same grid.

CONTACT 25.2, FASTSIM with its blending of flexibilities and the term dq/6, 40 x 40 elements over
the ellipse's box: F_y / (mu F_n) and M_z in N m, reading error half a unit of the last digit.
Three digits are asked for.
"""

from __future__ import annotations

import pytest
from patch_cases import Line, check, patch_case, solve

FORCE, FRICTION = 82e3, 0.3
PUBLISHED = {"parabolic": (-0.6118, -39.00), "elliptic": (-0.6016, -48.29)}


@pytest.mark.parametrize("bound", PUBLISHED)
def test_the_same_grid_gives_the_same_digits(bound: str) -> None:
    result = solve(
        patch_case(
            {"semi_axes": [8e-3, 4e-3]},
            force=FORCE,
            element_size=[4e-4, 2e-4],
            creepage=[0.0, -6.25e-4],
            spin=0.625,
            friction=FRICTION,
            normal="hertz",
            tangential="fastsim",
            traction_bound=bound,
            flexibility_blending="contact",
            spin_offset="sixth",
        )
    )
    force, moment = PUBLISHED[bound]
    found = result["creep_force"][1] / (FRICTION * FORCE)
    check(
        [
            Line("F_y / (mu F_n)", found, force, 5e-4 * abs(force)),
            Line("M_z", result["spin_moment"], moment, 5e-4 * abs(moment)),
        ]
    )
