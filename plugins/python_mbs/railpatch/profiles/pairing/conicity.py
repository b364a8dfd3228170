"""Equivalent conicity: the cone whose kinematic wave is as long as that of the real profiles.

A wheelset that rolls without slip on straight track moves by (UIC 519; EN 15302, chapter 9.1)

    y'' + dr(y) / (e r0) = 0       per metre of track,

dr the rolling radius of the right wheel minus that of the left one, e the distance between the
contact points, r0 the nominal radius. With a cone dr = 2 y tan(gamma), so its waves have Klingel's
(1883) length L = 2 pi sqrt(e r0 / (2 tan(gamma))) at every amplitude. With S the integral of dr
over y, the first integral of the motion between its turning points y1 and y2 is

    y'^2 = 2 (S(y1) - S(y)) / (e r0),   S(y1) = S(y2),   y2 - y1 = 2 amplitude,

and half a wave length is the integral of dy / y' from y1 to y2. Put into Klingel's formula, e and
r0 drop out:

    tan(gamma) = (pi / I)^2,   I = integral from y1 to y2 of dy / sqrt(S(y1) - S(y)).
"""

from __future__ import annotations

import math

import numpy as np
import scipy
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]
# of the integral over the phase angle
PHASES = 4000
# m, a rolling radius difference below this is rounding: no wave, conicity 0
NO_DIFFERENCE = 1e-13


class RadiusIntegral:
    """S(y) in m^2: the integral of a rolling radius difference that is linear between samples."""

    def __init__(self, y: Array, difference: Array) -> None:
        self.y, self.difference = y, difference
        mean = 0.5 * (difference[1:] + difference[:-1])
        self.sums = np.concatenate([[0.0], np.cumsum(mean * np.diff(y))])

    def __call__(self, y: ArrayLike) -> Array:
        at = np.asarray(y, dtype=float)
        k = np.clip(np.searchsorted(self.y, at) - 1, 0, self.y.size - 2)
        step = at - self.y[k]
        bend = (self.difference[k + 1] - self.difference[k]) / (self.y[k + 1] - self.y[k])
        return self.sums[k] + step * (self.difference[k] + 0.5 * step * bend)

    def middle(self, amplitude: float) -> float:
        """m, middle of the wave: S is the same on both of its ends; NaN where there is none."""

        def rise(middle: float) -> float:
            ends = self([middle - amplitude, middle + amplitude])
            return float(ends[1] - ends[0])

        low, high = self.y[0] + amplitude, self.y[-1] - amplitude
        if not low <= high:
            return math.nan
        # a symmetric pair, also where the wave is as wide as the samples
        if low <= 0.0 <= high and rise(0.0) == 0.0:
            return 0.0
        if rise(low) * rise(high) > 0:
            return math.nan
        return float(scipy.optimize.brentq(rise, low, high, xtol=1e-15))


def equivalent_conicity(
    y: ArrayLike, rolling_radius_difference: ArrayLike, amplitude: float
) -> float:
    """tan(gamma) (-) of the cone with the same kinematic wave length at this amplitude.

    By integration of the kinematic motion, after UIC 519 and EN 15302 (this module's formulas).
    y: m, lateral positions of the wheelset, increasing. rolling_radius_difference: m, right minus
    left at these, linear between. amplitude: m, half of the wave's lateral extent; its middle is
    where the wheelset rolls straight ahead on the mean, not y = 0.

    Below 0 where the difference drives the wheelset away from the middle: minus the conicity of
    the opposite difference. NaN where the samples do not reach the amplitude, or hold more than one
    place of equilibrium so that no wave of this amplitude runs around the middle.
    Raises ValueError for samples that do not increase and an amplitude that is not above 0.
    """
    at = np.asarray(y, dtype=float)
    difference = np.asarray(rolling_radius_difference, dtype=float)
    if at.ndim != 1 or at.shape != difference.shape or at.size < 2:
        raise ValueError("y and rolling_radius_difference must hold the same number of samples")
    if not (np.isfinite(difference).all() and (np.diff(at) > 0).all()):
        raise ValueError("y must increase and rolling_radius_difference be finite")
    if not amplitude > 0:
        raise ValueError(f"amplitude is {amplitude}, allowed > 0 m")
    if np.abs(difference).max() < NO_DIFFERENCE:
        return 0.0
    integral = RadiusIntegral(at, difference)
    middle = integral.middle(amplitude)
    if math.isnan(middle):
        return math.nan
    phase = math.pi * ((np.arange(PHASES) + 0.5) / PHASES - 0.5)
    ends = integral([middle - amplitude, middle + amplitude])
    # S(y1) - S(y), against phase y = middle + amplitude sin(phase): no singularity at the ends
    potential = ends.mean() - integral(middle + amplitude * np.sin(phase))
    sign = np.sign(potential[PHASES // 2])
    if sign == 0 or not (sign * potential > 0).all():
        return math.nan
    root = np.sqrt(sign * potential)
    return float(sign / np.mean(amplitude * np.cos(phase) / root) ** 2)
