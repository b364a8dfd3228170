"""Built-in profiles: continuity, exact shape, names."""

from __future__ import annotations

import math

import numpy as np
import pytest
from railpatch.profiles import Profile, ProfileError, builtin_profile, load_profile
from railpatch.profiles.formulas import S1002_JOINTS, s1002_depth
from railpatch.profiles.worn import RAIL, WAVE_HEIGHT, WAVES, WHEEL

EVERY = [
    ("S1002", "wheel"),
    ("UIC60", "rail"),
    ("UIC60@1:20", "rail"),
    ("60E1", "rail"),
    ("54E1@1:20", "rail"),
    ("cone@1:20", "wheel"),
    ("cylinder", "rail"),
    ("arc@0.3", "rail"),
    ("arc@0.02", "wheel"),
    ("worn@7", "wheel"),
    ("worn@12", "rail"),
]


def slopes(profile: Profile, s: np.ndarray, step: float) -> np.ndarray:
    """rad, direction of the curve between s - step and s + step."""
    y0, z0 = profile.evaluate(s - step)
    y1, z1 = profile.evaluate(s + step)
    return np.arctan2(z1 - z0, y1 - y0)


@pytest.mark.parametrize(("name", "role"), EVERY)
def test_knots_are_in_arc_length_and_right_handed(name: str, role: str) -> None:
    profile = load_profile(name, role)
    np.testing.assert_allclose(np.hypot(profile.dy, profile.dz), 1.0, rtol=0, atol=1e-12)
    assert profile.y[0] < profile.y[-1]
    # length of a fine polygon: second order from below
    y, z = profile.evaluate(np.linspace(0, profile.arc_length[-1], 200_001))
    length = np.hypot(np.diff(y), np.diff(z)).sum()
    assert profile.arc_length[-1] == pytest.approx(length, rel=1e-8)


@pytest.mark.parametrize(("name", "role"), EVERY)
def test_curves_have_no_kinks(name: str, role: str) -> None:
    profile = load_profile(name, role)
    for s in profile.arc_length[1:-1]:
        step = 1e-8  # m; a curvature of 1/(12 mm) turns by 1e-6 over it
        before, after = slopes(profile, np.array([s - step, s + step]), step)
        assert abs(after - before) < 1e-5


def test_s1002_has_the_curvature_of_its_zones() -> None:
    profile = load_profile("S1002", "wheel")
    # arcs of 13, 20, 12 and 20.5 mm: EN 13715; curvature above 0 turns z upwards with y
    for low, high, radius in (
        (S1002_JOINTS[4], S1002_JOINTS[3], 0.013),
        (S1002_JOINTS[6], S1002_JOINTS[5], -0.020),
        (S1002_JOINTS[7], S1002_JOINTS[6], -0.012),
        (S1002_JOINTS[8], S1002_JOINTS[7], -0.0205),
    ):
        inside = (profile.y > 1e-3 * low) & (profile.y < 1e-3 * high)
        s = profile.arc_length[inside][1:-1]
        turn = np.diff(slopes(profile, s, 1e-6)) / np.diff(s)
        np.testing.assert_allclose(turn, 1 / radius, rtol=1e-3)


def test_s1002_passes_between_its_knots_through_the_formula() -> None:
    profile = load_profile("S1002", "wheel")
    middle = 0.5 * (profile.arc_length[1:] + profile.arc_length[:-1])
    y, z = profile.evaluate(middle)
    tread = y > -0.0259
    expected = 1e-3 * s1002_depth(1e3 * y[tread])
    np.testing.assert_allclose(z[tread], expected, rtol=0, atol=1e-11)


def test_canted_rail_has_its_highest_point_at_the_origin() -> None:
    rail = load_profile("UIC60@1:40", "rail")
    y, z = rail.evaluate(np.linspace(0.0, rail.arc_length[-1], 20_001))
    assert z.min() == pytest.approx(0.0, abs=1e-10)
    assert abs(y[np.argmin(z)]) < 1e-5
    # inclined towards the track's centre: the gauge side hangs over, the field side falls back
    assert rail.y[0] == pytest.approx(-0.0437109, abs=1e-6)
    assert rail.y[-1] == pytest.approx(0.0305900, abs=1e-6)


@pytest.mark.parametrize(("name", "width"), [("60E1", 0.072), ("54E1", 0.070)])
def test_drawn_heads_are_as_wide_as_drawn(name: str, width: float) -> None:
    """The arcs follow from radii and inner widths; the head's width then is a check of them."""
    rail = load_profile(name, "rail")
    side = np.hypot(1, 1 / 20)
    # where the straight sides begin: the first and last knots with their direction
    straight = np.abs(np.abs(rail.dy) - 1 / 20 / side) < 1e-9
    assert 2 * np.abs(rail.y[straight]).min() == pytest.approx(width, abs=1e-6)
    np.testing.assert_allclose(rail.y, -rail.y[::-1], rtol=0, atol=1e-12)
    np.testing.assert_allclose(rail.z, rail.z[::-1], rtol=0, atol=1e-12)
    # EN 13674-1: crown of 300 mm
    crown = np.abs(rail.y) < 0.010
    expected = 0.3 - np.sqrt(0.3**2 - rail.y[crown] ** 2)
    np.testing.assert_allclose(rail.z[crown], expected, rtol=0, atol=1e-12)


def test_60e1_against_the_benchmarks_uic60() -> None:
    """R80 begins at 10.228 mm in place of 10.5 mm, which inclines it by that times the change of
    curvature."""
    new, old = (load_profile(name, "rail") for name in ("60E1", "UIC60"))
    y = np.linspace(0.012, 0.025, 50)
    depth = [np.interp(y, rail.y, rail.z) for rail in (new, old)]
    inclined = (0.0105 - 0.010228) * (1 / 0.080 - 1 / 0.300)
    np.testing.assert_allclose(depth[0] - depth[1], inclined * (y - 0.010364), rtol=0.08)


@pytest.mark.parametrize(("role", "sign"), [("rail", 1), ("wheel", -1)])
def test_arcs_are_convex_bodies(role: str, sign: int) -> None:
    profile = load_profile("arc@0.3", role)
    expected = sign * (0.3 - np.sqrt(0.3**2 - profile.y**2))
    np.testing.assert_allclose(profile.z, expected, rtol=0, atol=1e-15)


def test_cone_rises_towards_the_field_side() -> None:
    profile = load_profile("cone@1:20", "wheel")
    np.testing.assert_allclose(profile.z, -profile.y / 20, rtol=0, atol=1e-15)
    assert profile.arc_length[-1] == pytest.approx(0.14 * math.hypot(1, 1 / 20), rel=1e-14)


@pytest.mark.parametrize(
    ("name", "role", "words"),
    [
        ("S1002", "rail", "is a wheel"),
        ("UIC60@1:40", "wheel", "is a rail"),
        ("UIC60@40", "rail", "allowed '1:n'"),
        ("cone@1:0.5", "wheel", "allowed '1:n'"),
        ("cone", "wheel", "needs a number"),
        ("arc@-0.3", "rail", "allowed 0.01"),
        ("arc@nan", "rail", "allowed 0.01"),
        ("cylinder@2", "wheel", "is written 'cylinder'"),
        ("S1003", "wheel", "not the name of a built-in"),
    ],
)
def test_wrong_names_are_refused(name: str, role: str, words: str) -> None:
    with pytest.raises(ProfileError, match=words) as caught:
        load_profile(name, role)
    assert name in str(caught.value)


def test_a_path_is_no_built_in() -> None:
    assert builtin_profile("profiles/S1002.prw", "wheel") is None


def test_worn_shapes_lose_what_is_stated() -> None:
    # a shape's greatest distance from the new one is within the sum of the stated depths
    for role, new, bumps in (("wheel", "S1002", WHEEL), ("rail", "UIC60@1:40", RAIL)):
        base = load_profile(new, role)
        limit = sum(bump.depth[1] for bump in bumps) + WAVES * WAVE_HEIGHT
        depths = []
        for number in range(20):
            shape = load_profile(f"worn@{number}", role)
            depths.append(np.hypot(shape.y - base.y, shape.z - base.z).max())
            assert np.array_equal(shape.y, builtin_profile(f"worn@{number}", role).y)
        assert max(depths) < limit
        assert min(depths) > 1e-4
        assert len(set(depths)) == 20


@pytest.mark.parametrize("name", ["worn", "worn@", "worn@-1", "worn@1.5", "worn@1000000"])
def test_worn_shapes_have_numbers(name: str) -> None:
    with pytest.raises(ProfileError, match=r"number"):
        load_profile(name, "wheel")
