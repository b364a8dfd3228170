"""Curves that noise might have made of a profile as well: a parametric bootstrap.

The fitted curve stands for the true one. Noise of the size that was found is put on it and smoothed
as the points were, and with it goes what the smoothing takes from the shape, seen by smoothing the
fit once more (Tukey's twicing). The noise is taken to be white: its spectrum, standard deviation
squared times spacing, is all that a smoothing much longer than the spacing leaves to matter, so it
is drawn on fewer points.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from railpatch.profiles.curve import Profile, Scatter
from railpatch.profiles.spline import cubic_spline, slopes, smoothed_values

Array = NDArray[np.float64]

# points a wave length of which half the amplitude is kept, at the least
POINTS = 6


def drawn(profile: Profile, count: int, seed: tuple[int, ...]) -> list[Profile]:
    """The curve smoothed once more, and with it count others that noise of the same size might have
    left, the same for the same seed.

    Without scatter the profile itself, each time. Knots closer than twice POINTS a wave length
    are left out: the curve is smooth between them.
    """
    if profile.scatter is None:
        return [profile] * (1 + count)
    profile, bend_y, bend_z = thinned(profile)
    scatter, s = profile.scatter, profile.arc_length
    assert scatter is not None
    flattened = scatter.flattened[:, None]
    across = np.hstack([flattened, flattened + deviations(scatter, s, count, seed)])
    rate = slopes(s, across, "natural")
    found = []
    for k in range(1 + count):
        d, slope = across[:, k], rate[:, k]
        found.append(
            replace(
                profile,
                y=profile.y - d * profile.dz,
                z=profile.z + d * profile.dy,
                dy=profile.dy - slope * profile.dz - d * bend_z,
                dz=profile.dz + slope * profile.dy + d * bend_y,
                scatter=None,
            )
        )
    return found


def thinned(profile: Profile) -> tuple[Profile, Array, Array]:
    """With every so many of its knots, twice POINTS a wave length; rates of its slopes there."""
    scatter, s = profile.scatter, profile.arc_length
    assert scatter is not None
    bend_y, bend_z = np.gradient(profile.dy, s), np.gradient(profile.dz, s)
    every = max(1, int(0.5 * float(scatter.smoothing.min()) / POINTS / scatter.spacing))
    keep = np.unique(np.append(np.arange(0, s.size, every), s.size - 1))
    curve = {key: getattr(profile, key)[keep] for key in ("arc_length", "y", "z", "dy", "dz")}
    left = replace(scatter, smoothing=scatter.smoothing[keep], flattened=scatter.flattened[keep])
    return replace(profile, **curve, scatter=left), bend_y[keep], bend_z[keep]


def deviations(scatter: Scatter, s: Array, count: int, seed: tuple[int, ...]) -> Array:
    """m, [n, count], of smoothed noise at the knots s, m, across the profile."""
    step = float(scatter.smoothing.min()) / POINTS
    knots = s
    if step > scatter.spacing:
        knots = np.linspace(s[0], s[-1], int(np.ceil((s[-1] - s[0]) / step)) + 1)
    share = np.gradient(knots)
    size = scatter.noise * np.sqrt(scatter.spacing / share)[:, None]
    values = size * np.random.default_rng(seed).standard_normal((knots.size, count))
    if step > 0.0:
        square = (np.interp(knots, s, scatter.smoothing) / (2 * np.pi)) ** 2
        values = smoothed_values(knots, values, share / (square * square), 1.0)
    return np.asarray(cubic_spline(knots, values, "natural")(s))
