"""Waves of a wheelset along its track, beside Klingel's (1883): 2 pi sqrt(r0 e0 / conicity)."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Vector = NDArray[np.float64]


@dataclass(frozen=True)
class Waves:
    """The wheelset's waves along the track.

    length: m, mean of those found. count: half waves between zero crossings of y. first, last: m,
    amplitudes. conicity: -, half the difference of the rolling radii over y, by least squares over
    the run. half_distance: m, of the contacts, mean. klingel: m, 2 pi sqrt(r0 e0 / conicity) of
    these. NaN where the run is too short.
    """

    length: float
    count: int
    first: float
    last: float
    conicity: float
    radius: float
    half_distance: float
    klingel: float


def waves(
    x: Vector, y: Vector, roll: Vector, radii: Vector, contacts: Vector, nominal_radius: float
) -> Waves:
    """Waves of the lateral position y over the distance x: m, [n].

    roll: rad, [n]. radii: m, [n, 2], rolling radii left and right. contacts: m, [n, 2], lateral
    positions of the contacts. nominal_radius: m.
    """
    crossings, peaks = half_waves(x, y)
    length = 2 * float(np.mean(np.diff(crossings))) if len(crossings) > 1 else math.nan
    conicity = conicity_of(y - nominal_radius * roll, radii)
    distance = 0.5 * mean(contacts[:, 1] - contacts[:, 0]) if len(contacts) else math.nan
    radius = mean(radii)
    curvature = conicity / (radius * distance) if distance > 0 else math.nan
    return Waves(
        length,
        max(0, len(crossings) - 1),
        float(abs(y[0])) if len(y) else math.nan,
        float(peaks[-1]) if len(peaks) else math.nan,
        conicity,
        radius,
        distance,
        2 * math.pi / math.sqrt(curvature) if curvature > 0 else math.nan,
    )


def half_waves(x: Vector, y: Vector) -> tuple[Vector, Vector]:
    """Zero crossings of y over x, [k], and the largest |y| between them, [k - 1].

    Crossings by a straight line between neighbours.
    """
    at = np.flatnonzero(y[1:] * y[:-1] < 0) if len(y) > 1 else np.zeros(0, dtype=int)
    crossings = x[at] - y[at] * (x[at + 1] - x[at]) / (y[at + 1] - y[at])
    pairs = itertools.pairwise(at)
    peaks = [float(np.abs(y[i + 1 : j + 1]).max()) for i, j in pairs]
    return crossings, np.array(peaks)


def conicity_of(y: Vector, radii: Vector) -> float:
    """Slope of half the radii's difference over y at the height of the rails, through the origin.

    The wheelset rolls about its axle, one radius above the rails, so that its tread moves by
    y - r0 roll; pure rolling makes that coordinate the one whose waves are Klingel's.
    """
    if len(y) < 2:
        return math.nan
    known = np.isfinite(radii).all(axis=1)
    if not (y[known] ** 2).sum() > 0:
        return math.nan
    half = 0.5 * (radii[known, 1] - radii[known, 0])
    return float((half @ y[known]) / (y[known] @ y[known]))


def mean(values: Vector) -> float:
    """Of those that are known."""
    known = values[np.isfinite(values)]
    return float(known.mean()) if known.size else math.nan
