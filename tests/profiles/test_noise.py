"""Noise of points, found and smoothed: against the noise that was put on, and the spline's own
transfer function."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from railpatch.profiles import (
    ProfileError,
    RawProfile,
    builtin_profile,
    fit_profile,
    load_profile,
)
from railpatch.profiles.noise import (
    INTEGRAL,
    ROUGHNESS,
    five_point_weights,
    noise_of,
    outliers,
    rounding_of,
    wavelength_for,
)
from railpatch.profiles.shape import shape_of
from railpatch.profiles.smooth import chord_length


def noisy(name: str, role: str, spacing: float, noise: float, seed: int) -> RawProfile:
    """Points of a built-in profile, moved across it."""
    profile = builtin_profile(name, role)
    s = np.arange(profile.arc_length[0], profile.arc_length[-1], spacing)
    y, z = profile.evaluate(s)
    ahead = np.array(profile.evaluate(s + 1e-6)) - (y, z)
    tangent = ahead / np.hypot(*ahead)
    off = noise * np.random.default_rng(seed).standard_normal(s.size)
    y, z = y - off * tangent[1], z + off * tangent[0]
    return RawProfile(name, role, y, z, np.ones(s.size), np.arange(s.size), measured=False)


@pytest.mark.parametrize(("name", "role"), [("S1002", "wheel"), ("UIC60@1:40", "rail")])
@pytest.mark.parametrize("spacing", [5e-5, 2e-4, 5e-4])
@pytest.mark.parametrize("noise", [1e-6, 5e-6, 2e-5])
def test_noise_that_was_put_on_is_found(name: str, role: str, spacing: float, noise: float) -> None:
    raw = noisy(name, role, spacing, noise, 3)
    s = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(raw.y), np.diff(raw.z)))])
    # the median of n neighbouring residuals scatters by some 1.2 sqrt(2 / n)
    assert noise_of(raw.y, raw.z, s) == pytest.approx(noise, rel=4 * 1.2 * (2 / s.size) ** 0.5)


def test_noise_in_height_alone_is_found_on_the_level_part() -> None:
    """As of an instrument that samples over y; on flanks it moves points along them."""
    profile = builtin_profile("UIC60@1:40", "rail")
    s = np.arange(profile.arc_length[0], profile.arc_length[-1], 2e-4)
    y, z = profile.evaluate(s)
    z = z + 4e-6 * np.random.default_rng(11).standard_normal(s.size)
    level = np.abs(np.gradient(z, y)) < 0.5
    found = noise_of(y, z, s)
    assert found == pytest.approx(4e-6, rel=4 * 1.2 * (2 / np.count_nonzero(level)) ** 0.5)


def test_designed_points_have_none() -> None:
    for name, role in (("S1002", "wheel"), ("UIC60", "rail"), ("cone@1:20", "wheel")):
        raw = noisy(name, role, 2e-4, 0.0, 0)
        assert noise_of(raw.y, raw.z, raw.y) < 1e-8
        assert not any("noise" in note for note in fit_profile(raw).notes)


def test_weights_vanish_on_cubics() -> None:
    s = np.sort(np.random.default_rng(5).uniform(0, 1, 40))
    weights, gain = five_point_weights(s)
    windows = np.lib.stride_tricks.sliding_window_view(s**3 - 2 * s**2 + s - 4, 5)
    np.testing.assert_allclose((weights * windows).sum(axis=1), 0, atol=1e-12 * gain.max())
    # equal spacing: the middle point less (-1, 4, 4, -1) / 6 of its neighbours
    weights, gain = five_point_weights(np.arange(9.0))
    np.testing.assert_allclose(6 * weights[0], [1, -4, 6, -4, 1], atol=1e-14)
    assert gain[0] == pytest.approx(70**0.5 / 6)


def test_the_wave_length_bounds_the_curvature() -> None:
    """White noise through the smoothing spline, on a flat rail: numbers of the fit itself."""
    spacing, noise = 2e-4, 5e-6
    length = wavelength_for(noise, spacing)
    y = spacing * np.arange(4000)
    curvatures = []
    for seed in range(3):
        z = noise * np.random.default_rng(seed).standard_normal(y.size)
        raw = RawProfile("made", "rail", y, z, np.ones(y.size), np.arange(y.size), measured=False)
        curvature = shape_of(fit_profile(raw, length)).curvature
        curvatures.append(curvature[200:-200])
    assert np.std(curvatures) == pytest.approx(ROUGHNESS, rel=0.05)


def test_the_integral() -> None:
    u = np.linspace(0, 200, 2_000_001)
    assert 2 * np.trapezoid(u**4 / (1 + u**4) ** 2, u) == pytest.approx(INTEGRAL, rel=1e-6)


@pytest.mark.parametrize("step", [1e-3, 5e-3, 0.01, 0.02])
@pytest.mark.parametrize("spacing", [5e-5, 2e-4, 5e-4])
def test_rounding_is_found(step: float, spacing: float) -> None:
    z = 1e3 * noisy("S1002", "wheel", spacing, 0.0, 0).z
    rounded = step * np.round(z / step)
    assert rounding_of(rounded) == pytest.approx(step, rel=1e-12)
    rounded[::20] += 0.3 * step  # most, not all
    assert rounding_of(rounded) == pytest.approx(step, rel=1e-12)
    assert rounding_of(z) == 0.0


def test_whole_heights_by_their_making_are_no_rounding() -> None:
    y = np.arange(-60.0, 60.0)
    assert rounding_of(y / 20) == 0.0
    assert rounding_of(np.full(50, 3.0)) == 0.0
    # a parabola at whole places: fourth differences vanish
    assert rounding_of(0.01 * y * y) == 0.0


def test_rounding_is_noise_of_its_step(tmp_path: Path) -> None:
    """Uniform between half a step on either side: step / sqrt(12)."""
    raw = noisy("UIC60@1:40", "rail", 2e-4, 0.0, 0)
    path = tmp_path / "r.dat"
    np.savetxt(path, 1e3 * np.column_stack([raw.y, raw.z]), fmt="%.2f")
    profile = load_profile(path, "rail")
    assert "heights rounded to 10 um, taken as noise of 2.9 um" in profile.notes
    assert profile.scatter is not None
    assert profile.scatter.noise >= 1e-5 / 12**0.5
    # less than that about the small radii of the head's corners alone
    longer = profile.scatter.smoothing >= wavelength_for(1e-5 / 12**0.5, 1.9e-4)
    assert np.mean(longer) > 0.5


def test_noise_beyond_what_arcs_bear_is_refused() -> None:
    raw = noisy("S1002", "wheel", 5e-4, 2e-5, 1)
    with pytest.raises(ProfileError, match=r"asks for smoothing over 11 mm: allowed"):
        fit_profile(raw)
    notes = fit_profile(raw, 0.011).notes
    assert notes[-1] == "smoothed over more than the arcs of wheels and rails bear"


@pytest.mark.parametrize(("name", "role"), [("S1002", "wheel"), ("UIC60@1:40", "rail")])
@pytest.mark.parametrize("noise", [0.0, 2e-6])
@pytest.mark.parametrize("off", [5e-5, -5e-5])
def test_a_single_point_off_the_curve_is_left_out(
    name: str, role: str, noise: float, off: float
) -> None:
    """Dirt on a rail: 0.05 mm, which the median of the noise does not see."""
    raw = noisy(name, role, 2.5e-4, noise, 7)
    clean = fit_profile(raw)
    at = int(np.argmin(np.abs(raw.y - 2e-3)))
    raw.z[at] += off
    fitted = fit_profile(raw)
    (note,) = [text for text in fitted.notes if "left out" in text]
    assert f"a point left out at y = {1e3 * raw.y[at]:.4g} mm" in note
    s = clean.arc_length[5:-5]
    there, here = np.array(clean.evaluate(s)), np.array(fitted.evaluate(s))
    # what the cubic across the hole, and one point less of noise, leave
    assert np.abs(there - here).max() < 2e-7 + 2 * noise


def test_corners_are_no_points_off_the_curve() -> None:
    y = np.linspace(-30e-3, 30e-3, 241)
    for angle in (2e-3, 0.1, 1.0):
        z = angle * np.abs(y)
        assert outliers(y, z, chord_length(y, z), 0.0) == []


def test_stretches_without_points_are_told() -> None:
    raw = noisy("S1002", "wheel", 2.5e-4, 0.0, 0)
    keep = np.abs(raw.y - 10e-3) > 7.5e-3
    for name in ("y", "z", "weight", "line"):
        setattr(raw, name, getattr(raw, name)[keep])
    (note,) = [text for text in fit_profile(raw).notes if "no points over" in text]
    assert note.startswith("no points over 15")
    whole = fit_profile(noisy("S1002", "wheel", 2.5e-4, 0.0, 0))
    assert not any("no points" in text for text in whole.notes)
