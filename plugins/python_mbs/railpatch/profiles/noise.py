"""How noisy the points of a profile are, and how far they are to be smoothed for it.

Across a piece that is smooth over five points each of them lies where the four others say; what it
is off by is noise. A smoothing spline that keeps half the amplitude at the wave length L leaves of
noise s at points d apart a curvature whose standard deviation is

    s_k = s sqrt(d I / 2 pi) (2 pi / L)^2.5,  I = integral of u^4 / (1 + u^4)^2 = 0.5554

(its transfer function 1 / (1 + (L / wave length)^4) on white noise of the spectrum s^2 d). The
curvatures of wheel and rail tell the pressure, so s_k is what is bounded.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from railpatch.profiles.elementary import hypot

Array = NDArray[np.float64]

# integral of u^4 / (1 + u^4)^2 over the whole line: pi sqrt(2) / 8
INTEGRAL = 0.5553603672697958
# 1/m, standard deviation of the curvature that noise may leave: a head's crown has 3.3
ROUGHNESS = 1.0
# -, of the values, which are multiples of a step where they are rounded to it; of the step, that
# their unevenness has at the least
MOSTLY, UNEVEN = 0.9, 0.05
# sine of the greatest inclination that counts as level; windows of five points that tell the noise
# there; how many times that of all it must be to count alone
LEVEL, ENOUGH, MORE = 0.5, 50, 1.25
# of the noise, and m: how far off a point has to be to be left out; of that, what its neighbours
# may be off without it
FAR_OFF, SEEN, AGREED = 10.0, 5e-6, 0.2
# the standard deviation over the median of the deviations of normal noise
NORMAL = 1.4826022185056018


def noise_of(y: Array, z: Array, s: Array) -> float:
    """m, standard deviation of the points across the profile; 0 for fewer than nine points.

    Where an instrument errs in height alone, steep flanks show little of it: the noise is then that
    of the level part, where contact is.
    """
    if y.size < 9:
        return 0.0
    across, gain = off_neighbours(y, z, s)
    off = np.abs(across) / gain
    noise = float(NORMAL * np.median(off))
    ty, tz = y[4:] - y[:-4], z[4:] - z[:-4]
    level = np.abs(tz) <= LEVEL * hypot(ty, tz)
    if np.count_nonzero(level) < ENOUGH:
        return noise
    there = float(NORMAL * np.median(off[level]))
    return there if there > MORE * noise else noise


def off_neighbours(y: Array, z: Array, s: Array) -> tuple[Array, Array]:
    """m, [n - 4], how far each point but the first and last two is off the cubic through its two
    neighbours on either side, across the profile; and the factor by which that is noisier than a
    point."""
    weights, gain = five_point_weights(s)
    parts = []
    for values in (y, z):
        windows = np.lib.stride_tricks.sliding_window_view(values, 5)
        parts.append((windows * weights).sum(axis=1))
    ty, tz = y[4:] - y[:-4], z[4:] - z[:-4]
    return (parts[1] * ty - parts[0] * tz) / hypot(ty, tz), gain


def outliers(y: Array, z: Array, s: Array, noise: float) -> list[int]:
    """Single points that lie off a curve which their neighbours agree on: indices.

    noise: m, of the points. Without such a point its neighbours fit, which they do not where it is
    a corner's.
    """
    if y.size < 9:
        return []
    across, gain = off_neighbours(y, z, s)
    off = np.abs(across) / gain
    found: list[int] = []
    for i in (2 + np.flatnonzero(off > max(FAR_OFF * noise, SEEN))).tolist():
        if off[i - 2] < off[max(i - 4, 0) : i + 1].max():
            continue
        begin = max(i - 4, 0)
        near = [k for k in range(begin, min(i + 5, y.size)) if k != i]
        left, factor = off_neighbours(y[near], z[near], s[near])
        if left.size > 0 and np.abs(left / factor).max() < AGREED * off[i - 2]:
            found.append(i)
    return found


def rounding_of(values: Array) -> float:
    """The step that most values are multiples of, one, two or five of a power of ten; 0 for none.

    Where they are whole by their making, as a cone's heights at whole places, it is no rounding:
    that leaves them beside the cubic through their neighbours.
    """
    if values.size < 9:
        return 0.0
    size = float(np.abs(values).max())
    for power in range(int(np.floor(np.log10(size))) if size > 0 else -99, -7, -1):
        for one in (5.0, 2.0, 1.0):
            step = one * 10.0**power
            share = values / step
            whole = np.abs(share - np.round(share)) < 1e-6
            if np.mean(whole) >= MOSTLY:
                return step if uneven(values) > UNEVEN * step else 0.0
    return 0.0


def uneven(values: Array) -> float:
    """Root mean square of the values' fourth differences, over what independent errors get."""
    fourth = np.diff(values, 4)
    return float(np.sqrt(np.mean(fourth * fourth) / 70.0))


def five_point_weights(s: Array) -> tuple[Array, Array]:
    """Of each five neighbours: those whose sum is how far the middle one is off the cubic through
    the others; and the factor by which the sum is noisier than a point. [n - 4, 5], [n - 4]."""
    window = np.lib.stride_tricks.sliding_window_view(s, 5)
    others = (0, 1, 3, 4)
    weights = np.ones(window.shape)
    for i in others:
        for j in others:
            if j != i:
                weights[:, i] *= (window[:, 2] - window[:, j]) / (window[:, i] - window[:, j])
        weights[:, i] *= -1.0
    return weights, np.sqrt((weights * weights).sum(axis=1))


def wavelength_for(noise: float, spacing: float) -> float:
    """m, at which half the amplitude is kept, so that noise (m) leaves the curvature ROUGHNESS.

    spacing: m, of the points.
    """
    share = noise * np.sqrt(spacing * INTEGRAL / (2 * np.pi)) / ROUGHNESS
    return float(2 * np.pi * share**0.4)
