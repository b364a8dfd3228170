"""Slope, curvature and kinks of a profile along its arc length."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from railpatch.profiles import Profile

Array = NDArray[np.float64]
# 1/m, a step of the curvature that is marked: a joint of arcs, not the rounding of a spline
CURVATURE_STEP = 2.0
# m, a sharper bend than this radius is marked: no arc of a wheel or rail in use is as small
CORNER_RADIUS = 0.003


@dataclass(frozen=True)
class Shape:
    """A profile's curve from both sides of its knots: [2 intervals], begin and end of each."""

    arc_length: Array  # m
    y: Array  # m
    z: Array  # m, down
    slope: Array  # rad, of the curve from y towards z
    curvature: Array  # 1/m, above 0 where the curve bends towards z, downwards
    steps: NDArray[np.intp]  # indices of those ends of intervals where the curvature steps
    corners: NDArray[np.intp]  # indices of the sharpest points of corners


def shape_of(profile: Profile) -> Shape:
    """The exact derivatives of the profile's cubic pieces, at their ends."""
    h = np.diff(profile.arc_length)
    y2, z2 = (
        second_derivative(value, rate, h)
        for value, rate in ((profile.y, profile.dy), (profile.z, profile.dz))
    )
    s, y, z, dy, dz = (
        np.repeat(values, 2)[1:-1]
        for values in (profile.arc_length, profile.y, profile.z, profile.dy, profile.dz)
    )
    curvature = (dy * z2 - dz * y2) / np.hypot(dy, dz) ** 3
    # ends of intervals, each followed by the begin of the next one
    inner = np.arange(1, curvature.size - 1, 2)
    steps = inner[np.abs(curvature[inner + 1] - curvature[inner]) > CURVATURE_STEP]
    return Shape(s, y, z, np.arctan2(dz, dy), curvature, steps, corners(curvature))


def second_derivative(value: Array, rate: Array, h: Array) -> Array:
    """Of the Hermite cubics with these knots: at begin and end of each interval, [2 intervals]."""
    rise = np.diff(value) / h
    begin = (6 * rise - 4 * rate[:-1] - 2 * rate[1:]) / h
    end = (2 * rate[:-1] + 4 * rate[1:] - 6 * rise) / h
    return np.column_stack([begin, end]).ravel()


def corners(curvature: Array) -> NDArray[np.intp]:
    """The sharpest point of each stretch that is sharper than CORNER_RADIUS."""
    sharp = np.flatnonzero(np.abs(curvature) > 1 / CORNER_RADIUS)
    if not sharp.size:
        return sharp
    groups = np.split(sharp, np.flatnonzero(np.diff(sharp) > 1) + 1)
    return np.array([group[np.argmax(np.abs(curvature[group]))] for group in groups])
