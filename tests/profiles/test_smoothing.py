"""Clean-up and smoothing of points."""

from __future__ import annotations

import numpy as np
import pytest
from railpatch.profiles import ProfileError, RawProfile, fit_profile
from railpatch.profiles.noise import wavelength_for
from railpatch.profiles.raw import Array


def rail(y: Array, z: Array, *, measured: bool = True) -> RawProfile:
    lines = np.arange(1, y.size + 1)
    return RawProfile("made", "rail", y, z, np.ones(y.size), lines, measured)


def wave_left(length: float, spacing: float, wavelength: float) -> float:
    """Share of a wave's amplitude that smoothing leaves, away from the ends."""
    y = np.arange(-0.05, 0.05, spacing)
    z = 1e-6 * np.sin(2 * np.pi * y / length)
    profile = fit_profile(rail(y, z), wavelength)
    middle = np.abs(profile.y) < 0.02
    return float(np.dot(profile.z[middle], z[middle]) / np.dot(z[middle], z[middle]))


@pytest.mark.parametrize("spacing", [0.25e-3, 0.13e-3])
@pytest.mark.parametrize(
    ("length", "left"),
    # 1 / (1 + (wavelength / length)^4)
    [(5e-3, 0.5), (10e-3, 16 / 17), (2.5e-3, 1 / 17)],
)
def test_smoothing_passes_waves_by_its_formula(length: float, left: float, spacing: float) -> None:
    # samples per wave: 10 at the least, so the discrete spline is near the continuous one
    assert wave_left(length, spacing, 5e-3) == pytest.approx(left, abs=0.01)


def test_default_smoothing_is_for_measurements_and_for_noise() -> None:
    y = np.linspace(-0.03, 0.03, 241)
    clean = 2 * y**2
    z = clean + 3e-6 * np.random.default_rng(7).standard_normal(y.size)
    for measured in (True, False):
        raw = rail(y, z, measured=measured)
        smooth = fit_profile(raw)
        # what is left of the noise: its share below the wave length of 4.6 mm
        assert np.std((smooth.z - clean)[20:-20]) < 1.2e-6
        np.testing.assert_array_equal(fit_profile(raw, 0.0).z, z)
        told = " ".join(fit_profile(raw, 1e-3).notes)
        assert "smoothing over 1 mm leaves noise in the curvature" in told
    np.testing.assert_array_equal(fit_profile(rail(y, clean, measured=False)).z, clean)


def test_smoothing_goes_with_the_curvature() -> None:
    """Longer on an even crown, shorter about a corner of 13 mm radius and beside it."""
    angle = np.linspace(0.0, 1.2, 79)
    crown = np.linspace(-0.03, 0.0, 151)[:-1]
    y = np.concatenate([crown, 0.013 * np.sin(angle)])
    z = np.concatenate([np.zeros(crown.size), 0.013 * (1 - np.cos(angle))])
    z = z + 2e-6 * np.random.default_rng(1).standard_normal(y.size)
    raw = rail(y, z, measured=False)
    profile = fit_profile(raw)
    assert profile.scatter is not None
    needed = wavelength_for(profile.scatter.noise, profile.scatter.spacing)
    found = profile.scatter.smoothing
    # noise leaves curvature by the length to the power -8/3: 0.3 1/m, and 7 % of 1 / 13 mm
    np.testing.assert_allclose(found[20:100], needed * 0.3**-0.375, rtol=1e-12)
    np.testing.assert_allclose(found[170:200], needed * (0.07 / 0.013) ** -0.375, rtol=0.05)
    assert (np.diff(found[100:160]) <= 1e-12).all()
    assert f"half amplitude at {1e3 * found.min():.3g} to {1e3 * found.max():.3g} mm" in str(
        profile.notes
    )
    # as said, for all alike
    said = fit_profile(raw, 3e-3)
    assert said.scatter is not None
    assert (said.scatter.smoothing == 3e-3).all()


def test_interpolation_meets_a_circle() -> None:
    # chord spline of an arc: fourth order; 80 mm radius, 1 mm spacing
    angle = np.linspace(-0.4, 0.4, 65)
    profile = fit_profile(rail(0.08 * np.sin(angle), 0.08 * (1 - np.cos(angle)), measured=False))
    assert profile.arc_length[-1] == pytest.approx(0.064, rel=1e-6)
    s = np.linspace(0.016, 0.048, 1001)  # away from the natural ends
    y, z = profile.evaluate(s)
    radius = np.hypot(y, z - 0.08)
    np.testing.assert_allclose(radius, 0.08, rtol=0, atol=2e-10)


def test_duplicates_and_an_outlier_are_left_out_and_told() -> None:
    y = np.linspace(-0.03, 0.03, 121)
    z = 2 * y**2
    y, z = np.insert(y, 40, y[40]), np.insert(z, 40, z[40])
    z[80] += 2e-3  # four times the spacing
    profile = fit_profile(rail(y, z, measured=False))
    assert profile.y.size == 120
    assert profile.notes == (
        "1 duplicate points left out",
        "1 points left out where the profile turned back",
    )
    np.testing.assert_allclose(profile.z, 2 * profile.y**2, rtol=0, atol=1e-15)


def test_shuffled_points_are_refused_with_their_line() -> None:
    y = np.random.default_rng(3).permutation(np.linspace(-0.03, 0.03, 121))
    with pytest.raises(ProfileError, match=r"made:\d+: the points turn back at \d+ of 121"):
        fit_profile(rail(y, 2 * y**2))


@pytest.mark.parametrize("value", [-1e-3, 0.2, float("nan")])
def test_smoothing_has_a_range(value: float) -> None:
    y = np.linspace(-0.03, 0.03, 121)
    with pytest.raises(ProfileError, match=r"smoothing is .*, allowed 0 \.\.\. 0.1 m"):
        fit_profile(rail(y, 2 * y**2), value)
