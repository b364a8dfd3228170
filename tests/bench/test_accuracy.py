"""Sizes of fitted rows for a scale."""

from __future__ import annotations

import pytest
from railpatch.accuracy import fitted_size


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
