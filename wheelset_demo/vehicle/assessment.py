"""A run's forces and accelerations as EN 14363 counts them.

Filters, percentiles and limits are those of EN 14363:2016, stated from memory, without its text at
hand: wheel forces and accelerations with a low pass of 20 Hz (Butterworth, order 4), forces as
means over 2 m at every 0.5 m, percentiles 0.15, 50 and 99.85 %; Y/Q at most 0.8 (Nadal 1896 gives
the form), a wheelset's sum of Y at most k (10 kN + P0/3) with P0 its load at rest (Prud'homme
1967); a wheel's load at least 40 % of that at rest. Y/Q is that of the means. The whole run is one
section: the standard's sorting by radius and its statistics over many sections are left to who runs
several.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
import scipy
from numpy.typing import NDArray
from railpatch.log.channels import LEAST_LOAD, SLIDING

from wheelset_demo.scene import GRAVITY

Vector = NDArray[np.float64]
CORNER = 20.0  # Hz
ORDER = 4
# Hz, of kept steps, that a low pass at CORNER needs
LEAST_RATE = 5 * CORNER
SPACING = 0.5  # m, of the means
LEAST_WAY = 50.0  # m, of means
PERCENTILES = (0.15, 50.0, 99.85)
RANKS = ("lower", "higher")  # between which a percentile lies
RATIO_LIMIT = 0.8
BASE_SHIFT = 10e3  # N
UNLOADING_LIMIT = 0.6  # of the wheel's load at rest


class Kept(Protocol):
    """Kept steps of a run, as wheelset_demo.vehicle.trace.VehicleTrace has them."""

    def array(self, name: str) -> Vector:
        """[n, ...], by name."""
        ...


@dataclass(frozen=True)
class Assessment:
    """SI. ratio: greatest 99.85 % of a wheel's Y/Q, Y outward. shift: N, greatest of a wheelset's
    sum of Y by 0.15 and 99.85 %, either way. guiding: N, likewise of each wheel's Y;
    outward_guiding: N, 99.85 % of it outward, of Y/Q's sign. load, median_load: N, greatest 99.85 %
    and 50 % of a wheel's Q. acceleration: m/s^2, lateral, vertical, the greater of 0.15 and
    99.85 %, without gravity's. ratios, loads, median_loads: the same of each wheel, shifts: of each
    wheelset. places: number of the places that they are of."""

    ratio: float
    shift: float
    load: float
    median_load: float
    acceleration: tuple[float, float]
    ratios: tuple[float, ...] = ()
    shifts: tuple[float, ...] = ()
    loads: tuple[float, ...] = ()
    median_loads: tuple[float, ...] = ()
    guiding: tuple[float, ...] = ()
    outward_guiding: tuple[float, ...] = ()
    places: int = 0


def shift_limit(axle_load: float, factor: float) -> float:
    """N, of a wheelset's sum of Y. axle_load: N."""
    return factor * (BASE_SHIFT + axle_load / 3)


def unloading(least_loads: Sequence[float], static_loads: Sequence[float]) -> tuple[float, ...]:
    """-, [wheels]: what a wheel's least load is below that at rest, a half of its wheelset's, as a
    share of it. least_loads: N, [wheels]; static_loads: N, [wheelsets]."""
    at_rest = np.repeat(np.asarray(static_loads) / 2, 2)
    return tuple((1 - np.asarray(least_loads) / at_rest).tolist())


def assess(trace: Kept, interval: float) -> Assessment | None:
    """Of the kept steps, ``interval`` s apart; None where they are too few or too far apart."""
    if interval * LEAST_RATE > 1 + 1e-9:
        return None
    times, positions = trace.array("times"), trace.array("positions")
    way = positions.mean(axis=1)
    way = way - way[0]
    # the last step that is kept may come sooner; the first metres have no whole mean
    used = np.flatnonzero((way >= SLIDING) & (np.abs(times / interval % 1 - 0.5) > 0.499))
    if len(used) < 2 or way[used[-1]] - way[used[0]] < LEAST_WAY:
        return None
    places = np.arange(way[used[0]], way[used[-1]], SPACING)

    def filtered(name: str) -> Vector:
        values = low_passed(trace.array(name)[used], interval)
        return np.stack([np.interp(places, way[used], column) for column in values.T], axis=1)

    guiding, loads, felt = (filtered(n) for n in ("mean_guiding", "mean_loads", "felt"))
    ratios = np.full_like(guiding, -np.inf)
    np.divide(guiding, loads, out=ratios, where=loads > LEAST_LOAD)
    low, _, high = np.percentile(guiding[:, ::2] - guiding[:, 1::2], PERCENTILES, axis=0)
    _, median, most = np.percentile(loads, PERCENTILES, axis=0)
    # what is felt at rest is gravity alone
    moved = felt[:, 1:] + np.array([0.0, GRAVITY])
    least, _, greatest = np.percentile(moved, PERCENTILES, axis=0)
    lateral, vertical = np.maximum(np.abs(least), np.abs(greatest)).tolist()
    # a wheel in the air has no ratio: nothing is interpolated from there
    lower, upper = (np.percentile(ratios, PERCENTILES[-1], axis=0, method=m) for m in RANKS)
    part = 0.01 * PERCENTILES[-1] * (len(places) - 1) % 1
    with np.errstate(invalid="ignore"):
        by_wheel = np.where(np.isfinite(lower), lower + part * (upper - lower), upper)
    inward, outward = np.percentile(guiding, PERCENTILES[::2], axis=0)
    ratio, shifts = by_wheel.max(), np.maximum(np.abs(low), np.abs(high))
    return Assessment(
        ratio=float(ratio) if np.isfinite(ratio) else 0.0,
        shift=float(shifts.max()),
        load=float(most.max()),
        median_load=float(median.max()),
        acceleration=(lateral, vertical),
        ratios=tuple(np.where(np.isfinite(by_wheel), by_wheel, 0.0).tolist()),
        shifts=tuple(shifts.tolist()),
        loads=tuple(most.tolist()),
        median_loads=tuple(median.tolist()),
        guiding=tuple(np.maximum(np.abs(inward), np.abs(outward)).tolist()),
        outward_guiding=tuple(outward.tolist()),
        places=len(places),
    )


def low_passed(values: Vector, interval: float) -> Vector:
    """[n, columns], by 20 Hz; as if the first values had always been there. interval: s."""
    sections = scipy.signal.butter(ORDER, CORNER, fs=1 / interval, output="sos")
    rest = scipy.signal.sosfilt_zi(sections)[:, :, None] * values[0]
    found, _ = scipy.signal.sosfilt(sections, values, axis=0, zi=rest)
    return np.asarray(found)
