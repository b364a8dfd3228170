"""Curves that noise might have made: against the spline's transfer function."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from railpatch.profiles import RawProfile, builtin_profile, fit_profile
from railpatch.profiles.curve import Scatter
from railpatch.profiles.noise import INTEGRAL
from railpatch.profiles.scatter import deviations, drawn
from railpatch.profiles.spline import slopes


def flat(noise: float, spacing: float, smoothing: float, *, wave: float = 0.0) -> RawProfile:
    y = spacing * np.arange(1500)
    z = 1e-5 * np.cos(2 * np.pi * y / wave) if wave else np.zeros(y.size)
    z = z + noise * np.random.default_rng(2).standard_normal(y.size)
    return RawProfile("made", "rail", y, z, np.ones(y.size), np.arange(y.size), measured=False)


@pytest.mark.parametrize(("spacing", "smoothing"), [(1e-4, 5e-3), (5e-4, 3e-3)])
def test_drawn_noise_has_the_spectrum_of_smoothed_noise(spacing: float, smoothing: float) -> None:
    """Drawn on its own grid: the curvature's standard deviation is that of the formula in
    profiles.noise, whatever the spacing."""
    noise = 4e-6
    s = 2e-4 * np.arange(1000)
    scatter = Scatter(noise, spacing, np.full(s.size, smoothing), np.zeros(s.size))
    across = deviations(scatter, s, 12, (1,))
    curvature = np.gradient(np.gradient(across, s, axis=0), s, axis=0)[100:-100]
    expected = noise * (spacing * INTEGRAL / 2 / np.pi) ** 0.5 * (2 * np.pi / smoothing) ** 2.5
    # 12 curves with some 2 x 0.16 m / 4 mm independent places each: 5 %
    assert np.std(curvature) == pytest.approx(expected, rel=0.15)


def test_what_smoothing_takes_once_more_is_that_of_its_formula() -> None:
    # a wave of the length of which half the amplitude is kept: a half, and a quarter once more
    profile = fit_profile(flat(1e-6, 1e-4, 4e-3, wave=4e-3), 4e-3)
    assert profile.scatter is not None
    wave = np.cos(2 * np.pi * profile.y / 4e-3)
    inner = slice(200, -220)  # whole waves
    left = 2 * np.mean((profile.z * wave)[inner])
    taken = 2 * np.mean((profile.scatter.flattened * wave)[inner])
    assert left == pytest.approx(0.5e-5, rel=0.02)
    assert taken == pytest.approx(-0.25e-5, rel=0.03)


def test_draws_lie_about_the_curve_and_are_the_same_again() -> None:
    wheel = builtin_profile("S1002", "wheel")
    assert wheel is not None
    s = wheel.arc_length
    given = replace(wheel, scatter=Scatter(5e-6, 2e-4, np.full(s.size, 5e-3), np.zeros(s.size)))
    first, again, other = drawn(given, 3, (1,)), drawn(given, 3, (1,)), drawn(given, 3, (2,))
    # every second knot: 0.4 mm and a length of 5 mm
    base = first[0]
    assert np.array_equal(base.z[:-1], wheel.z[::2][: base.z.size - 1])
    for one, two, three in zip(first[1:], again[1:], other[1:], strict=True):
        assert np.array_equal(one.z, two.z)
        assert not np.array_equal(one.z, three.z)
        off = (one.z - base.z) * base.dy - (one.y - base.y) * base.dz
        # of the noise what lies below the wave length: s sqrt(d / L) some 0.2 of it
        assert 0.1 * 5e-6 < np.std(off) < 0.4 * 5e-6


def test_slopes_belong_to_the_points() -> None:
    raw = flat(5e-6, 2e-4, 5e-3, wave=30e-3)
    profile = fit_profile(raw)
    base, *others = drawn(profile, 2, (1,))
    for one in others:
        change = slopes(one.arc_length, one.z - base.z, "natural")
        assert np.abs(change - (one.dz - base.dz)).max() < 0.02 * np.std(change)


def test_without_noise_there_is_nothing_to_draw() -> None:
    profile = fit_profile(flat(0.0, 2e-4, 0.0, wave=30e-3))
    assert profile.scatter is None
    assert drawn(profile, 2, (1,)) == [profile] * 3
