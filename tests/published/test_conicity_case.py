"""Equivalent conicity of a published rolling radius difference with jumps and unequal radii.

Source: EN 15302:2008, annex E, case E.7 (wheels H of 920 and 918 mm diameter on rail A), as the
public benchmark program B_ECC reproduces it: rolling radius difference at every 0.1 mm, and
tan(gamma), printed to 0.001. Between its jumps at +-2.55 mm the difference is linear: about the
1 mm of the unequal radii it is odd, with slope 1/20 inside and 0.225 outside. Equilibrium is in the
jump at -2.55 mm. The standard accepts 0.05; the bound here is one unit of the last digit printed:
the samples are rounded, too, and the standard leaves the method of integration open.
"""

from __future__ import annotations

import numpy as np
import pytest
from railpatch.profiles.pairing.conicity import equivalent_conicity

# amplitude (mm), tan(gamma)
PRINTED = {
    1.0: 0.712,
    1.5: 0.491,
    2.0: 0.381,
    2.5: 0.314,
    3.0: 0.270,
    3.5: 0.238,
    4.0: 0.217,
    # here the wave's other end has reached the jump at 2.55 mm
    4.1: 0.243,
    4.5: 0.271,
    5.0: 0.275,
}


def difference(y: np.ndarray) -> np.ndarray:
    """mm at y in mm, as described above."""
    outside = np.sign(y) * (2.407 + 0.225 * (np.abs(y) - 2.6))
    return 1.0 + np.where(np.abs(y) < 2.55, y / 20, outside)


@pytest.mark.parametrize("amplitude", PRINTED)
def test_case_e7(amplitude: float) -> None:
    y = np.arange(-67, 68) / 10
    found = equivalent_conicity(1e-3 * y, 1e-3 * difference(y), 1e-3 * amplitude)
    assert found == pytest.approx(PRINTED[amplitude], abs=1e-3)
