"""S1002 and UIC60 by formula against the profiles of the Manchester benchmark.

Shackleton, Iwnicki: Comparison of wheel-rail contact codes for railway vehicle simulation: an
introduction to the Manchester Contact Benchmark, VSD 46 (2008). Points are given to eight digits.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from published_data import MANCHESTER
from railpatch.profiles import Profile, RawProfile, load_profile, read_profile
from railpatch.profiles.formulas import (
    S1002_JOINTS,
    UIC60_DEPTH,
    UIC60_SIDE,
    s1002_depth,
    uic60_depth,
)

# mm: the benchmark's rail is turned by atan(1/40) about the crown and then moved by this; its
# highest point lies 0.006 mm beside the exact one of the formula
UIC60_MOVE = (-7.4917, 0.0937067)


def normal_distance(profile: Profile, raw: RawProfile) -> np.ndarray:
    """m, distance of the points from the curve."""
    s = np.linspace(0.0, profile.arc_length[-1], 100_001)
    y, z = profile.evaluate(s)
    found = []
    for py, pz in zip(raw.y, raw.z, strict=True):
        k = int(np.clip(np.argmin((y - py) ** 2 + (z - pz) ** 2), 1, s.size - 2))
        ty, tz = y[k + 1] - y[k - 1], z[k + 1] - z[k - 1]
        found.append(abs((py - y[k]) * tz - (pz - z[k]) * ty) / math.hypot(ty, tz))
    return np.array(found)


def test_s1002_formula_is_the_measured_profile() -> None:
    raw = read_profile(MANCHESTER["wheel"], "wheel")
    assert raw.y.size == 399
    np.testing.assert_allclose(s1002_depth(1e3 * raw.y), 1e3 * raw.z, rtol=0, atol=2e-6)


def test_uic60_formula_is_the_measured_profile() -> None:
    raw = read_profile(MANCHESTER["rail"], "rail")
    angle = math.atan(1 / 40)
    y, z = 1e3 * raw.y - UIC60_MOVE[0], 1e3 * raw.z - UIC60_MOVE[1]
    y, z = (
        math.cos(angle) * y - math.sin(angle) * z,
        math.sin(angle) * y + math.cos(angle) * z,
    )
    head = np.abs(y) < 35.9  # steeper beyond: there y is compared
    np.testing.assert_allclose(z[head], uic60_depth(y[head]), rtol=0, atol=9e-6)
    side = z > 14.26
    assert np.count_nonzero(side) > 100
    np.testing.assert_allclose(
        np.abs(y[side]), UIC60_SIDE[0] + UIC60_SIDE[1] * z[side], rtol=0, atol=9e-6
    )
    assert z.max() == pytest.approx(UIC60_DEPTH, abs=1e-4)


def test_built_in_s1002_is_the_measured_profile() -> None:
    raw = read_profile(MANCHESTER["wheel"], "wheel")
    distance = 1e3 * normal_distance(load_profile("S1002", "wheel"), raw)
    zone_c = (raw.y > 1e-3 * S1002_JOINTS[3]) & (raw.y < 1e-3 * S1002_JOINTS[2])
    assert distance[~zone_c].max() < 2e-6
    assert distance[zone_c].max() < 1.2e-4  # the jump of the published formula is taken up here


def test_built_in_uic60_is_the_measured_profile() -> None:
    raw = read_profile(MANCHESTER["rail"], "rail")
    angle = math.atan(1 / 40)
    crown = 300 * math.sin(angle)  # mm, where the rail's crown touches a line of that angle
    exact = -(math.cos(angle) * crown + math.sin(angle) * (300 - 300 * math.cos(angle)))
    built_in = load_profile("UIC60@1:40", "rail").moved(1e-3 * (UIC60_MOVE[0] - exact), 0.0)
    # 4.4e-5 mm: the step of the published arcs at R80/R13 that the curve closes
    assert 1e3 * normal_distance(built_in, raw).max() < 6e-5


@pytest.mark.parametrize("joint", S1002_JOINTS[1:-1])
def test_s1002_formula_jumps_less_than_published(joint: float) -> None:
    below, above = s1002_depth([joint - 1e-9, joint + 1e-9])
    assert abs(above - below) < 1.2e-4 + 6e-9


def test_formulas_are_undefined_outside() -> None:
    assert np.isnan(s1002_depth([-70.1, 60.1])).all()
    assert np.isnan(uic60_depth([-36.1, 36.1])).all()
