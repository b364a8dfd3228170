"""Contact points of a pair against cones by hand and a search over densely sampled profiles."""

from __future__ import annotations

import math

import numpy as np
import pytest
from railpatch.profiles import load_profile
from railpatch.profiles.pairing.contact_points import Dimensions, contact_points, positions


def test_cone_on_an_arc_by_hand() -> None:
    """A cone touches a crown of radius R where that is as inclined: R sin(angle) off its top."""
    cone, crown = 1 / 20, 0.3
    points = contact_points("cone@1:20", f"arc@{crown}", positions(4e-3, 1e-3))
    half_width = 0.07  # the built-in arc ends there, above 14 mm depth
    assert crown - math.sqrt(crown**2 - half_width**2) < 0.014
    top = 0.5 * 1.435 + half_width
    # the cone is higher towards the field side: it touches the crown on its gauge side
    angle = -math.atan(cone)
    # the load of 1 N flattens by some 5e-8 m: so much may contact places differ, and angles so
    # much over the radius
    flat = 5e-8
    np.testing.assert_allclose(points.contact_angle, angle, rtol=0, atol=flat / crown)
    place = top + crown * math.sin(angle)
    np.testing.assert_allclose(points.position, place, rtol=0, atol=flat)
    on_wheel = place - points.y - (0.68 + 0.07)
    np.testing.assert_allclose(points.on_wheel, on_wheel, rtol=0, atol=flat)
    radius = 0.46 - cone * on_wheel
    np.testing.assert_allclose(points.rolling_radius, radius, rtol=0, atol=flat)
    assert (points.touches == 1).all()


def test_s1002_on_uic60_by_dense_search() -> None:
    sizes = Dimensions(gauge=1.432)
    points = contact_points("S1002", "UIC60@1:40", positions(7.5e-3, 1.5e-3), sizes)
    rail, wheel = load_profile("UIC60@1:40", "rail"), load_profile("S1002", "wheel")
    y_rail, z_rail = rail.evaluate(np.linspace(0, rail.arc_length[-1], 400_001))
    y_wheel, z_wheel = wheel.evaluate(np.linspace(0, wheel.arc_length[-1], 400_001))
    # of the rail's gauge side: the least y within 14 mm below its top
    marker = 0.5 * sizes.gauge - y_rail[z_rail <= sizes.gauge_height].min()
    upper = np.argmax(y_rail), np.argmin(y_rail)
    keep = slice(min(upper), max(upper) + 1)
    ordered = np.argsort(y_wheel)
    for index, y in enumerate(points.y):
        at = y_rail[keep] + marker - y - sizes.marker
        gap = z_rail[keep] - np.interp(at, y_wheel[ordered], z_wheel[ordered])
        least = np.argmin(gap)
        assert points.on_wheel[index] == pytest.approx(at[least], abs=2e-5)
        radius = sizes.nominal_radius + np.interp(at[least], y_wheel[ordered], z_wheel[ordered])
        assert points.rolling_radius[index] == pytest.approx(radius, abs=2e-6)


def test_the_difference_is_antisymmetric() -> None:
    difference = contact_points("S1002", "UIC60").rolling_radius_difference
    np.testing.assert_array_equal(difference, -difference[::-1])
    assert (difference[difference.size // 2 + 1 :] > 0).all()


def test_positions_must_be_symmetric() -> None:
    for wrong in ([0.0], [-1e-3, 0.0, 2e-3], [1e-3, 0.0, -1e-3]):
        with pytest.raises(ValueError, match="symmetric about 0"):
            contact_points("S1002", "UIC60", wrong)
