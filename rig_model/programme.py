"""The programme of a run: yaw angle and lateral position over the progress of the run."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import PchipInterpolator


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


def polygon(table: Sequence[Sequence[float]], at: NDArray[np.float64]) -> list[float]:
    """Straight lines through the rows (progress, value)."""
    rows = np.array(table, dtype=float)
    return np.interp(at, rows[:, 0], rows[:, 1]).tolist()


def monotone(table: Sequence[Sequence[float]], at: NDArray[np.float64]) -> list[float]:
    """Cubic through the rows (progress, value) without overshoot (Fritsch and Butland 1984)."""
    rows = np.array(table, dtype=float)
    return PchipInterpolator(rows[:, 0], rows[:, 1])(at).tolist()
