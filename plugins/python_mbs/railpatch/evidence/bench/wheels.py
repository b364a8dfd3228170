"""A wheel on its rail, moving as in a simulation: the shape of its contact changes too."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from railpatch.case.load import load_scene
from railpatch.case.moving import changed_case
from railpatch.case.to_core import input_of
from railpatch.evidence.bench.problems import FRICTION, Scales, merged
from railpatch.evidence.bench.shapes import Floats, hertz_pressure
from railpatch.evidence.bench.surfaces import MANCHESTER

WHEEL_LOAD = 1e4  # N
# m: lateral position and the height at which the wheel carries that load with one patch, the
# wheelset rolled by ROLL times the lateral position
ROLL = -0.05  # rad/m
HEIGHTS = np.array(
    [
        [1.4e-3, 1.6907e-4],
        [2.0e-3, 1.4356e-4],
        [2.6e-3, 1.1405e-4],
        [3.2e-3, 8.0082e-5],
        [3.8e-3, 4.0884e-5],
        [4.4e-3, -4.8e-6],
    ]
)
BOX = (3.7e-3, 2.0e-3)  # m, half the size of the contact there, along rolling and lateral
APPROACH = 2.5e-5  # m, there
PITCH_RATE = -4.3462  # rad/s, of nearly free rolling
# what a step of size one changes, and where the walk is kept: y (m), height over the approach,
# yaw (rad), pitch rate over that above
UNITS = np.array([1e-3, 1.0, 1e-3, 1e-3])
LOWEST = np.array([1.5e-3, -0.2, -1.2e-3, -5e-4])
HIGHEST = np.array([4.0e-3, 0.2, 1.2e-3, 5e-4])


@dataclass(frozen=True, eq=False)
class WheelRun:
    """Steps of one wheel: states [n, 4], of UNITS. Otherwise as ``problems.Batch``."""

    name: str
    states: Floats
    ordered = True
    exact_pressure = False
    axis_ratio = BOX[0] / BOX[1]

    def __len__(self) -> int:
        return len(self.states)

    def case(self, overrides: Mapping[str, Any], elements: int) -> dict[str, Any]:
        """Elements of one size on all steps: so many across the usual contact."""
        size = [2 * half / elements for half in BOX]
        own = {"wheelset": {"vertical_force": None, "z": 0.0}, "grid": {"element_size": size}}
        return merged(merged(MANCHESTER, own), overrides)

    def inputs(self) -> list[dict[str, Any]]:
        """Fields of rp_input for each step."""
        case = load_scene(self.case({}, 8)).case
        height = CubicSpline(*HEIGHTS.T)
        return [
            input_of(
                changed_case(
                    case,
                    {
                        "y": float(y),
                        "z": float(height(y) + lower * APPROACH),
                        "roll": float(ROLL * y),
                        "yaw": float(yaw),
                        "pitch_rate": float(PITCH_RATE * (1 + faster)),
                    },
                )
            )
            for y, lower, yaw, faster in self.states
        ]

    def take(self, chosen: NDArray[np.int64]) -> WheelRun:
        """The steps with these indices."""
        return replace(self, states=self.states[chosen])

    def scales(self) -> Scales:
        """Those of the usual load and contact; powers are not compared."""
        n = len(self)
        force, nothing = np.full(n, FRICTION * WHEEL_LOAD), np.full(n, np.nan)
        pressure = hertz_pressure(np.tile(BOX, (n, 1)), np.full(n, WHEEL_LOAD))
        length = np.full(n, np.sqrt(BOX[0] * BOX[1]))
        return Scales(force, length, pressure, slip=nothing, power=nothing)

    def true_power(self, _force: Floats, _moment: Floats) -> Floats:
        """The creepages are results here: no power without them."""
        return np.full(len(self), np.nan)

    def checksum(self) -> float:
        """A number that tells these steps from others."""
        return float((self.states / UNITS).sum())


def random_run(name: str, steps: int, random: np.random.Generator) -> WheelRun:
    """Each step changes everything by 0.1 to 10 % of its unit."""
    state = np.array([2.5e-3, 0.0, 4e-4, 0.0])
    rows = []
    for size in 10 ** random.uniform(-3, -1, steps):
        rows.append(state.copy())
        step = random.standard_normal(4)
        state = np.clip(state + size * UNITS * step / np.linalg.norm(step), LOWEST, HIGHEST)
    return WheelRun(name, np.array(rows))
