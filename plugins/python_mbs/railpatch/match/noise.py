"""What a search carries along: noise of the points, derivatives around where they were found."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Noise:
    """Of what is left. error: [observed], SI units, of each point. size: -, over that, how much
    belongs together. length: over which, in standard deviations of the inputs. degrees: -, of
    freedom that the errors are known by; infinite where they are given."""

    error: Array
    size: float = 0.0
    length: float = 1.0
    degrees: float = np.inf

    def covariance(self, apart: Array) -> Array:
        """[m, m], over the squared error. apart: [m, m], squared distances of the inputs."""
        own = np.eye(len(apart))
        if self.size == 0:
            return own
        return own + self.size**2 * np.exp(-0.5 * apart / self.length**2)


@dataclass
class Near:
    """Derivatives that serve around where they were found. start: where; shares, computed: where
    they were corrected last. slopes: [observed, m, p]."""

    start: Array
    shares: Array
    computed: Array
    slopes: Array | None

    def go_to(self, shares: Array, computed: Array) -> None:
        """To a point that was computed."""
        assert self.slopes is not None
        step = shares - self.shares
        if (size := float(step @ step)) > 0:
            missed = computed - self.computed - self.slopes @ step
            self.slopes = self.slopes + missed[..., None] * step / size
        self.shares, self.computed = shares.copy(), computed
