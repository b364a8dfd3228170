"""Friction that varies over the lateral position or the angle of the rail's surface."""

from __future__ import annotations

from typing import Any

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


def test_the_field_of_a_temperature_law_has_the_factor() -> None:
    """Full sliding: |p| is friction times pressure in every element."""
    law = {
        "law": "temperature",
        "reference": 0.3,
        "change": -0.1,
        "reference_temperature": 20.0,
        "temperature_range": 500.0,
        "factor": [[-0.004, 0.5], [0.004, 1.5]],
    }
    case = with_values(
        PATCH,
        friction=law,
        temperature={"wheel": 20.0, "rail": 20.0},
        motion={"creepage": [0.3, 0.0]},
    )
    result = railpatch.solve(case, fields=True)
    assert result.status == "converged"
    bound = result["friction"] * result["pressure"]
    np.testing.assert_allclose(np.hypot(*result["traction"]), bound, rtol=1e-5, atol=1.0)


@pytest.mark.parametrize(
    ("law", "most"),
    [
        ({"coefficient": 0.3, "factor": [[-1.0, 0.5], [1.0, 2.0]]}, 0.6),
        ({"law": "slip_velocity", "kinetic": 0.1, "amplitude": 0.05, "halving_speed": 1.0}, 0.15),
    ],
)
def test_a_prescribed_force_is_bounded_by_the_law(law: dict[str, Any], most: float) -> None:
    force = PATCH["load"]["normal_force"]
    beyond = with_values(
        PATCH, friction=law, motion={"tangential_force": [-1.01 * most * force, 0.0]}
    )
    with pytest.raises(railpatch.CaseError, match="the greatest friction coefficient"):
        railpatch.solve(beyond)
    within = with_values(
        PATCH, friction=law, motion={"tangential_force": [-0.5 * most * force, 0.0]}
    )
    found = railpatch.solve(within)
    assert found.status in ("converged", "out_of_range")


def test_a_step_takes_one_creepage() -> None:
    motion = {"regime": "shift", "creepage": [[1e-6, 0.0], [2e-6, 0.0]], "steps": 2}
    case = with_values(PATCH, motion=motion)
    assert railpatch.solve(case).status == "converged"
    contact = railpatch.Contact(case)
    with pytest.raises(railpatch.CaseError, match="one pair for a step"):
        contact.step()
    assert contact.step(creepage=[1e-6, 0.0]).status == "converged"
