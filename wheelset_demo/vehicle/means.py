"""Means of the wheels' forces over the last metres of way, of every time step."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from railpatch import _core
from railpatch.log.channels import LEAST_LOAD, SLIDING

Vector = NDArray[np.float64]
# of the force to the right on a wheel: Y is on the rail, outward > 0
OUTWARD = np.array([1.0, -1.0])


def rail_forces(wheels: Vector) -> tuple[Vector, Vector]:
    """N, [wheels] each, on the rails: Y, outward > 0, and Q, down, of left and right wheel of each
    wheelset. wheels: as ForceElement.wheels."""
    return (OUTWARD * wheels[:, :, 1]).ravel(), -wheels[:, :, 2].ravel()


@dataclass(frozen=True)
class Extremes:
    """[wheels] each, so far. ratios: -, greatest Y/Q, Y outward; none: 0. guiding: N, greatest Y,
    either way; outward_guiding: N, greatest Y outward, below 0 where it never was.
    least_loads, most_loads: N, Q. sums: N, [wheelsets], greatest sum of Y, either way."""

    ratios: tuple[float, ...]
    guiding: tuple[float, ...]
    outward_guiding: tuple[float, ...]
    least_loads: tuple[float, ...]
    most_loads: tuple[float, ...]
    sums: tuple[float, ...]


class SlidingMeans:
    """Of Y and Q over the last 2 m (EN 14363), and their extremes so far.

    guiding, loads: N, [wheels] each. Before 2 m are run they are means over the way there is, and
    so are the extremes; these begin anew with the first whole mean. ratio: -, greatest Y/Q of a
    wheel that carries something. load_range: N, least and greatest Q. sum: N, greatest force across
    the track on a wheelset, either way.
    extremes: of each wheel, as Extremes.
    """

    def __init__(self, wheels: Vector) -> None:
        """wheels: of the state at the start, as ForceElement.wheels."""
        self._core = _core.SlidingMeans(wheels, SLIDING, LEAST_LOAD)
        self._means = self._core.means
        self._count = len(self._means) // 2

    def add(self, way: float, wheels: Vector) -> None:
        """The state after a time step. way: m, run in it."""
        self._core.add(way, wheels)

    @property
    def compiled(self) -> _core.SlidingMeans:
        """The same in C++, for what is compiled beside it."""
        return self._core

    @property
    def guiding(self) -> Vector:
        """N, [wheels]."""
        return self._means[: self._count].copy()

    @property
    def loads(self) -> Vector:
        """N, [wheels]."""
        return self._means[self._count :].copy()

    @property
    def ratio(self) -> float:
        """-, so far; none: -inf."""
        return self._core.ratio

    @property
    def sum(self) -> float:
        """N, so far."""
        return self._core.sum

    @property
    def load_range(self) -> tuple[float, float]:
        """N, so far."""
        return self._core.load_range

    @property
    def extremes(self) -> Extremes:
        """Of each wheel."""
        core = self._core
        return Extremes(
            ratios=tuple(x if np.isfinite(x) else 0.0 for x in core.most_ratios),
            guiding=tuple(core.most_guiding),
            outward_guiding=tuple(core.most_outward_guiding),
            least_loads=tuple(core.least_loads),
            most_loads=tuple(core.most_loads),
            sums=tuple(core.most_sums[::2]),
        )
