"""Transient rolling with friction that falls with slip and has no memory."""

from __future__ import annotations

import numpy as np
import pytest
import railpatch
from case_samples import PATCH, with_values

SPEED, SIZE = 10.0, 0.012 / 16
STEPS = 30
KINETIC, AMPLITUDE = 0.15, 0.2


@pytest.mark.parametrize("elements", [0.5, 1.0])
@pytest.mark.parametrize("creepage", [2e-3, 4e-3, 1e-2])
@pytest.mark.parametrize("halving_speed", [0.07, 0.1, 0.2, 0.3])
def test_each_step_is_solved(halving_speed: float, creepage: float, elements: float) -> None:
    """From rest to sliding; in slip the traction is that of the law at the slip found."""
    friction = {"kinetic": KINETIC, "amplitude": AMPLITUDE, "halving_speed": halving_speed}
    case = with_values(
        PATCH,
        motion__creepage=[creepage, 0.0],
        motion__regime="transient_rolling",
        motion__distance=elements * SIZE,
        motion__rolling_speed=SPEED,
        friction={"law": "slip_velocity", **friction},
    )
    contact = railpatch.Contact(case)
    slipped = 0
    for step in range(STEPS):
        result = contact.step(fields=True)
        assert result.status == "converged", step
        inside = result["pressure"] > 0
        pressure = result["pressure"][inside]
        traction = np.hypot(*result["traction"][:, inside])
        slip = np.hypot(*result["micro_slip"][:, inside])
        slips = slip > 0
        law = KINETIC + AMPLITUDE * 2 ** (-slip * SPEED / halving_speed)
        assert traction[slips] == pytest.approx((law * pressure)[slips], rel=1e-6)
        assert (traction[~slips] <= (KINETIC + AMPLITUDE) * pressure[~slips] * (1 + 1e-9)).all()
        slipped += int(slips.sum())
    assert slipped > 10 * STEPS
