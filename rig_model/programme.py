"""The programme of a run: yaw angle and lateral position over the progress of the run."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy
from numpy.typing import NDArray
from railpatch.profiles.spline import cubic_spline


@dataclass(frozen=True)
class Position:
    """One position of the run.

    progress: 0 to 1. time: s from the start. y: m, lateral position of the wheelset's centre.
    yaw: rad. vertical_force: N, on both wheels together, and roller_pitch_rate: rad/s, where they
    vary over the run; None: those of the scene.
    """

    index: int
    progress: float
    time: float
    y: float
    yaw: float
    vertical_force: float | None = None
    roller_pitch_rate: float | None = None


def positions(
    count: int,
    duration: float,
    yaw: Sequence[Sequence[float]],
    lateral_position: Sequence[Sequence[float]],
) -> list[Position]:
    """``count`` positions, evenly spaced over the ``duration`` (s).

    yaw: rows of progress and rad, straight lines between them: the actuators move at constant
    rates. lateral_position: rows of progress and m, monotone between them.
    """
    progress = np.linspace(0.0, 1.0, count)
    angles = polygon(yaw, progress)
    lateral = monotone(lateral_position, progress)
    return [
        Position(i, float(progress[i]), float(progress[i] * duration), lateral[i], angles[i])
        for i in range(count)
    ]


def drifted(
    positions: list[Position], yaw: Sequence[float] | None, lateral: Sequence[float] | None
) -> list[Position]:
    """The positions with offsets of yaw angle (rad) and lateral position (m) over the progress."""
    progress = np.array([position.progress for position in positions])
    turned, shifted = drift(yaw or [0.0], progress), drift(lateral or [0.0], progress)
    return [
        replace(position, yaw=position.yaw + turned[i], y=position.y + shifted[i])
        for i, position in enumerate(positions)
    ]


def drift(values: Sequence[float], at: NDArray[np.float64]) -> list[float]:
    """Natural cubic spline through values at evenly spaced progress from 0 to 1: it is linear in
    each of them. Two: a straight line; one: a constant."""
    if len(values) == 1:
        return [values[0]] * len(at)
    knots = np.linspace(0.0, 1.0, len(values))
    return cubic_spline(knots, np.array(values, dtype=float), "natural")(at).tolist()


def polygon(table: Sequence[Sequence[float]], at: NDArray[np.float64]) -> list[float]:
    """Straight lines through the rows (progress, value)."""
    rows = np.array(table, dtype=float)
    return np.interp(at, rows[:, 0], rows[:, 1]).tolist()


def monotone(table: Sequence[Sequence[float]], at: NDArray[np.float64]) -> list[float]:
    """Cubic through the rows (progress, value) without overshoot (Fritsch and Butland 1984)."""
    rows = np.array(table, dtype=float)
    return scipy.interpolate.PchipInterpolator(rows[:, 0], rows[:, 1])(at).tolist()
