"""Sizes of fitted rows for a scale, and the accuracy that a scale is chosen for."""

from __future__ import annotations

import numpy as np
import pytest
import railpatch
from railpatch.case.accuracy import fitted_size
from railpatch.case.choice import ROWS_ON_PRESSURE, smallest
from railpatch.evidence.bench.reach import fitted
from railpatch.evidence.bench.samples import STEPS, Problem, fine_truth, measured, random_position


def test_sizes() -> None:
    assert fitted_size(10) == (10, 10)
    # 2^0.22 = 1.165, 5^0.22 = 1.425
    assert fitted_size(20, 2.0) == (23, 17)
    assert fitted_size(20, 0.5) == (17, 23)
    # no fewer rows than 0.8 of the scale: 20/1.425 = 14
    assert fitted_size(20, 5.0) == (28, 16)
    assert fitted_size(20, 0.2) == (14, 28)


@pytest.mark.parametrize(("scale", "ratio"), [(2, 1.0), (65, 1.0), (50, 5.0), (10, 0.0)])
def test_sizes_that_no_grid_takes(scale: float, ratio: float) -> None:
    with pytest.raises(ValueError, match="allowed"):
        fitted_size(scale, ratio)


@pytest.mark.parametrize("axes", [[0.02, 0.0019], [0.001, 0.011]])
def test_long_ellipses_are_refused(axes: list[float]) -> None:
    case = {
        "kind": "patch",
        "geometry": {"semi_axes": axes},
        "load": {"normal_force": 1e4},
        "motion": {"creepage": [1e-3, 0.0]},
        "friction": {"coefficient": 0.3},
        "method": {"accuracy": 0.01},
    }
    with pytest.raises(railpatch.CaseError, match=r"a/b of 0\.1 \.\.\. 10; for others give"):
        railpatch.solve(case)


def test_accuracy_is_reached_on_wheels() -> None:
    """accuracy = 0.01 on wheels at random positions, against finer, extrapolated rows."""
    accuracy, positions = 0.01, 10
    scale = smallest(ROWS_ON_PRESSURE, accuracy)
    random = np.random.default_rng(20261127)
    errors = []
    for index in range(positions):
        batch = random_position(random, index)
        problem = Problem(batch, fine_truth(batch, {}), {}, "position")
        errors += list(measured(problem, fitted(scale, problem, "half_space")).errors[:, 0])
    assert len(errors) == positions * STEPS
    # 95 % on many cases; here with the scatter of so few: three standard deviations
    assert np.mean(np.array(errors) <= accuracy) >= 0.90
