"""Energy that the coupling makes or loses at the interface.

Both sides integrate the power that the contact gives the wheelset: the FMU's from its own inputs
(its output ``power``, trapezoidal rule over communication points), the multibody side along its own
motion. What they differ by is energy out of nowhere, below 0 lost. Beside it stands what friction
turned into heat in the same time.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from wheelset_demo.coupling.masters import MASTERS
from wheelset_demo.coupling.multibody import Multibody
from wheelset_demo.coupling.slave import ContactSlave, CouplingFailure
from wheelset_demo.scene import WheelsetScene
from wheelset_demo.start import released
from wheelset_demo.system import System, Vector

RELEASED = 2e-3  # m, off-centre
DURATION = 0.05  # s
FEWEST, MOST = 20, 1000  # steps


@dataclass(frozen=True)
class Balance:
    """Of a run. step, duration: s. error, friction: J; error: taken by the multibody side and not
    given by the FMU's. NaN where the run failed."""

    master: str
    speed: float
    step: float
    duration: float
    error: float
    friction: float

    @property
    def share(self) -> float:
        """-, of the friction work."""
        return abs(self.error) / self.friction


def release(scene: WheelsetScene, speed: float) -> tuple[WheelsetScene, Vector]:
    """A scene at a speed (m/s) and the motion it starts with, off-centre. Raises CaseError."""
    moving = scene.at_speed(speed, RELEASED)
    return moving, released(moving, System(moving)).motion


def balance(
    scene: WheelsetScene,
    start: Vector,
    slave: ContactSlave,
    name: str,
    step: float,
    duration: float = DURATION,
) -> Balance:
    """Of a run of a duration (s), but 20 steps at least and 1000 at most."""
    count = min(MOST, max(FEWEST, math.ceil(duration / step)))
    master = MASTERS[name](Multibody(scene), slave)
    try:
        point = master.begin(0.0, start)
        for _ in range(count):
            point = master.step(point, step)
        error, friction = point.taken - point.given, point.friction
    except CouplingFailure:
        error = friction = np.nan
    return Balance(name, scene.speed, step, count * step, error, friction)
