"""Means of the wheels' forces over the last metres of way, of every time step."""

from __future__ import annotations

from collections import deque

import numpy as np
from numpy.typing import NDArray
from railpatch.log.channels import LEAST_LOAD, SLIDING

from wheelset_demo.vehicle.scene import WHEELSETS

Vector = NDArray[np.float64]
# of the force to the right on a wheel: Y is on the rail, outward > 0
OUTWARD = np.tile([1.0, -1.0], WHEELSETS)


def rail_forces(wheels: Vector) -> tuple[Vector, Vector]:
    """N, [8] each, on the rails: Y, outward > 0, and Q, down, of left and right wheel of each
    wheelset. wheels: as ForceElement.wheels."""
    return OUTWARD * wheels[:, :, 1].ravel(), -wheels[:, :, 2].ravel()


class SlidingMeans:
    """Of Y and Q over the last 2 m (EN 14363), and their extremes so far.

    guiding, loads: N, [8] each. Before 2 m are run they are means over the way there is, and so are
    the extremes; these begin anew with the first whole mean. ratio: -, greatest Y/Q of a wheel that
    carries something. load_range: N, least and greatest Q. sum: N, greatest force across the track
    on a wheelset, either way.
    """

    def __init__(self, wheels: Vector) -> None:
        """wheels: of the state at the start, as ForceElement.wheels."""
        self._forces = np.concatenate(rail_forces(wheels))
        # way (m) and integral of the forces over it (J)
        self._rows = deque([(0.0, np.zeros_like(self._forces))])
        self._whole = False
        self._forget()
        self._found(self._forces)

    def _forget(self) -> None:
        self.ratio, self.sum, self.load_range = -np.inf, 0.0, (np.inf, -np.inf)

    def add(self, way: float, wheels: Vector) -> None:
        """The state after a time step. way: m, run in it."""
        before, self._forces = self._forces, np.concatenate(rail_forces(wheels))
        if not way > 0:
            return
        last, integral = self._rows[-1]
        now = last + way, integral + 0.5 * way * (before + self._forces)
        self._rows.append(now)
        begin = now[0] - SLIDING
        while self._rows[1][0] <= begin:
            self._rows.popleft()
        (first, low), (second, high) = self._rows[0], self._rows[1]
        # the way's begin lies between the first two
        share = max(0.0, (begin - first) / (second - first))
        if begin >= 0 and not self._whole:
            self._whole = True
            self._forget()
        from_there = now[1] - low - share * (high - low)
        self._found(from_there / (now[0] - max(begin, first)))

    def _found(self, means: Vector) -> None:
        self.guiding, self.loads = means[: 2 * WHEELSETS], means[2 * WHEELSETS :]
        carrying = self.loads > LEAST_LOAD
        ratios = self.guiding[carrying] / self.loads[carrying]
        self.ratio = max(self.ratio, float(ratios.max(initial=-np.inf)))
        low, high = self.load_range
        self.load_range = min(low, float(self.loads.min())), max(high, float(self.loads.max()))
        across = (OUTWARD * self.guiding).reshape(WHEELSETS, 2).sum(axis=1)
        self.sum = max(self.sum, float(np.abs(across).max()))
