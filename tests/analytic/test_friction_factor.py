"""Friction that varies over the lateral position or the angle of the rail's surface."""

from __future__ import annotations

import numpy as np
import pytest
import railpatch
from case_samples import PATCH, WHEELSET, with_values

WIDE = 0.1  # m, beyond any contact


def test_full_sliding_with_friction_linear_across_the_contact() -> None:
    """Fx = -mu Fn and Mz = mu slope int y^2 p dA, which is Fn b^2/5 for Hertz's pressure."""
    a, b, slope, force, mu = 0.005, 0.007, 60.0, 1e5, 0.3
    points = [[-WIDE, 1 - slope * WIDE + 5], [WIDE, 1 + slope * WIDE + 5]]
    case = with_values(
        PATCH,
        geometry={"semi_axes": [a, b]},
        load={"normal_force": force},
        grid={"elements": [60, 60]},
        motion={"creepage": [0.9, 0.0]},
        friction={"coefficient": mu, "factor": points},
        method={"normal": "hertz"},
    )
    result = railpatch.solve(case)
    assert result.status == "converged"
    # elastic micro-slip of the order of traction over G turns tractions by up to 0.03 rad
    assert result["creep_force"][0] == pytest.approx(-6 * mu * force, rel=0.03**2 / 2)
    # of elements: the second moment of their pressures is what is summed
    assert result["spin_moment"] == pytest.approx(mu * slope * force * b**2 / 5, rel=5e-3)


def test_a_constant_factor_is_a_coefficient() -> None:
    points = [[-1.0, 0.5], [0.0, 0.5], [1.0, 0.5]]
    factored = with_values(WHEELSET, friction={"coefficient": 0.4, "factor": points})
    plain = with_values(WHEELSET, friction={"coefficient": 0.2})
    assert railpatch.solve(factored)["force"] == railpatch.solve(plain)["force"]


def test_the_angle_counts_towards_the_gauge_face_on_either_side() -> None:
    """A wheelset in the mirror, with the same table: forces in the mirror."""
    table = [[-0.05, 1.2], [0.05, 0.4], [0.2, 0.3]]
    case = with_values(WHEELSET, friction={"coefficient": 0.3, "factor": table})
    right = railpatch.solve(with_values(case, wheelset__y=2e-3, wheelset__yaw=1e-3))
    left = railpatch.solve(with_values(case, wheelset__y=-2e-3, wheelset__yaw=-1e-3))
    np.testing.assert_allclose(
        np.multiply(left["force"], [1, -1, 1]), right["force"], rtol=1e-12, atol=1e-6
    )
    plain = with_values(case, friction={"coefficient": 0.3}, wheelset__y=2e-3, wheelset__yaw=1e-3)
    assert abs(railpatch.solve(plain)["force"][1] - right["force"][1]) > 100
