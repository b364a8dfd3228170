"""Results as arrays over their scales."""

from __future__ import annotations

import numpy as np
import pytest
from railpatch.errors import CaseError
from railpatch.evidence.bench.problems import merged
from railpatch.evidence.bench.sets import hertz_batch
from railpatch.evidence.bench.steps import contact_of, estimates, steps_of

BATCH = hertz_batch(1.0, [0.0, 1.0], np.radians([30.0]), [0.0, 1.1])


def test_scaled_results() -> None:
    contact = contact_of(BATCH, {"method": {"normal": "hertz"}}, 12)
    inputs = BATCH.inputs()
    _, results = contact.time_steps(inputs, [True] * 4, 1)
    steps = steps_of(BATCH, results)
    patch = results[1]["right"]["patches"][0]
    assert steps.force[1] * 0.3 * 82e3 == pytest.approx(patch["creep_force"])
    assert steps.moment[3] * 0.3 * 82e3 * 9e-3 == pytest.approx(
        results[3]["right"]["patches"][0]["spin_moment"]
    )
    assert steps.pressure == pytest.approx(np.ones(4))
    # power over mu F V and the rigid slip: without slip there is none
    assert steps.power[0] == 0
    slip = np.linalg.norm(BATCH.creepage[1])
    assert steps.power[1] * 0.3 * 82e3 * 10 * slip == pytest.approx(patch["friction_power"])
    # the power that the creepages supply, from the forces alone, is the same
    assert BATCH.true_power(steps.force, steps.moment) == pytest.approx(steps.power, rel=1e-4)


def test_estimates() -> None:
    unit = BATCH.scales()
    pressure = np.full(4, 2e9)
    given = [
        {"creep_force": 246.0, "spin_moment": None, "max_pressure": 2e7},
        [246.0, 2.214, 2e7],
        None,
        float("nan"),
    ]
    found = estimates([{"error_estimate": value} for value in given], unit, pressure)
    # 246 N of 0.3 * 82 kN, 2.214 N m of that times 9 mm
    assert found[1] == pytest.approx([0.01, 0.01, 0.01])
    assert found[0, 0] == pytest.approx(0.01)
    assert np.isnan(found[0, 1])
    assert np.isnan(found[2:]).all()


def test_merged_cases() -> None:
    case = {"kind": "patch", "grid": {"elements": [8, 8]}, "method": {"normal": "hertz"}}
    changed = merged(case, {"grid": None, "method": {"tolerance": 1e-7, "normal": None}})
    assert changed == {"kind": "patch", "method": {"tolerance": 1e-7}}
    assert case["grid"] == {"elements": [8, 8]}
    assert merged(case, {"layer": {"thickness": 0.1}})["layer"] == {"thickness": 0.1}


def test_refused_case() -> None:
    with pytest.raises(CaseError, match=r"method\.tangential"):
        contact_of(BATCH, {"method": {"tangential": "unheard_of"}}, 8)
