"""Signals at other times: a low-pass filter without delay, straight lines, gaps that stay gaps."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

# of the Butterworth filter, which goes over the signal forward and back
ORDER = 2
# of the rate, above which a cut-off is no filter
HIGHEST = 0.45


def step_of(time: Array) -> float:
    """s, the usual time between rows."""
    return float(np.median(np.diff(time)))


def low_passed(time: Array, values: Array, cutoff: float) -> Array:
    """Without what is faster than ``cutoff`` (Hz), at the same times (s); no delay.

    A Butterworth filter of second order, forward and back; at the cut-off an amplitude falls to
    1/sqrt(2) in both passes together. Gaps (NaN) are bridged by straight lines for the filter and
    stay gaps.
    """
    # it takes a while to import; logs that are read need no filter
    from scipy.signal import butter, sosfiltfilt

    present = np.isfinite(values)
    if np.count_nonzero(present) < 2:
        return values
    step = step_of(time)
    even = np.arange(time[0], time[-1] + 0.5 * step, step)
    signal = np.interp(even, time[present], values[present])
    # each of two passes has a gain of 2^(-1/4) at the cut-off: 1 + (w/wc)^(2 n) = sqrt(2)
    angle = math.tan(math.pi * cutoff * step) / (math.sqrt(2) - 1) ** (1 / (2 * ORDER))
    sections = butter(ORDER, math.atan(angle) / math.pi, fs=1.0, output="sos")
    pad = min(len(even) - 1, 3 * math.ceil(1 / (cutoff * step)))
    smooth = sosfiltfilt(sections, signal, padlen=pad)
    return np.where(present, np.interp(time, even, smooth), np.nan)


def resampled(time: Array, values: Array, at: Array) -> Array:
    """Straight lines between rows; NaN beside a gap and beyond the ends."""
    after = np.clip(np.searchsorted(time, at, side="left"), 0, len(time) - 1)
    hit = time[after] == at
    before = np.where(hit, after, np.maximum(after - 1, 0))
    inside = (at >= time[0]) & (at <= time[-1])
    width = np.where(after > before, time[after] - time[before], 1.0)
    part = np.where(after > before, (at - time[before]) / width, 0.0)
    found = values[before] + part * (values[after] - values[before])
    return np.where(inside, np.where(hit, values[after], found), np.nan)
