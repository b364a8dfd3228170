"""The largest stable communication step of a master, by runs of the real FMU and by matrices.

A run starts straight on with a small disturbance of all that can oscillate: bounce, roll, creepages
and lateral position. Its size is the square root of an energy: of the velocities with the inertia,
and of the coordinates with contact and suspension stiffness. A step is *stable* where

- the size is never above 5 times that of the start, and
- a line through its logarithm in the second half of the run rises by less than 0.8 1/s, or by what
  it does in a reference run, which grows above the critical speed; or the size is there below that
  of the reference run, or below a twentieth of the start's.

The reference run has the same start, in this process, by ros2 with short steps. A step that the FMU
discards, or whose iteration does not converge, is not stable. Runs take 0.05 s, but 60 steps at
least and 2000 at most (300 where a step is an iteration); the rate that passes is more in shorter
ones, 0.02 over half of their length and again as much shorter as they are. Matrices may grow at
that rate, too.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from wheelset_demo.coupling.linear import KEPT, PLACES, Linearised, linearise, stable
from wheelset_demo.coupling.masters import ARM, MASTERS, Iterate, Master
from wheelset_demo.coupling.multibody import Multibody
from wheelset_demo.coupling.slave import ContactSlave, CouplingFailure
from wheelset_demo.scene import WheelsetScene
from wheelset_demo.steppers import Ros2
from wheelset_demo.system import WORKS, State, System, Vector

RISE, GONE = 0.02, 0.05
DURATION = 0.05  # s
FEWEST, MOST, MOST_ITERATED = 60, 2000, 300
LOST = 5.0  # times the first size
SMALLEST, LARGEST = 1e-6, 2e-2  # s
CLOSE = 1.06  # ratio of the steps between which the bound is found
BESIDE = 0.972  # of the eigenvalues' bound: where runs begin, on either side
WIDER = 1.25
REFERENCE_STEP = 5e-4  # s
# of the start: m of the lateral position, m of the bounce, m/s of sliding: mostly bounce, as slow
# waves would hide its growth
OFFSET, BOUNCE, SLIDING = 4e-9, 2e-9, 1e-7
# wrench that belongs to a velocity: speed, vy, vz, roll, yaw and pitch rate
WRENCH_OF = (0, 1, 2, 3, 5, 4)


@dataclass(frozen=True)
class Bound:
    """Largest stable step of a master at a speed (m/s), s; LARGEST where none was unstable, 0 where
    none was stable. by_runs: of the FMU. by_matrix: of the eigenvalues with the same allowance."""

    master: str
    speed: float
    by_runs: float
    by_matrix: float
    runs: int = 0


class Rolling:
    """Straight running at a speed, what disturbs it and how the disturbance is measured.

    system: linearised. scale: [11], J^0.5 over units of coordinates and velocities. start: [12],
    the disturbed motion.
    """

    def __init__(self, scene: WheelsetScene, speed: float) -> None:
        """Raises CaseError, ContactFailure."""
        self.scene, self.speed = scene.at_speed(speed, 0.0), speed
        self.system: Linearised = linearise(scene, speed)
        self.scale = np.sqrt(energy_weights(self.system))
        disturbed = np.zeros(len(KEPT))
        disturbed[[1, 2, 3]] = [OFFSET, BOUNCE, BOUNCE / ARM]
        disturbed[PLACES + 1], disturbed[[PLACES + 4, PLACES + 5]] = SLIDING, SLIDING / ARM
        self.start = self.system.motion.copy()
        self.start[KEPT] += disturbed
        self._sizes: list[float] = []
        self._reference: Iterator[float] | None = None

    def size(self, time: float, motion: Vector) -> float:
        """J^0.5, of the disturbance."""
        off = (motion - self.system.motion)[KEPT]
        off[0] -= self.speed * time
        return float(np.linalg.norm(self.scale * off))

    def reference(self, duration: float) -> list[float]:
        """Sizes in the reference run over a duration (s)."""
        if self._reference is None:
            self._reference = self._run_reference()
        count = math.ceil(duration / REFERENCE_STEP) + 1
        while len(self._sizes) < count:
            self._sizes.append(next(self._reference))
        return self._sizes[:count]

    def _run_reference(self) -> Iterator[float]:
        system = System(self.scene, exact=True)
        stepper = Ros2(system, REFERENCE_STEP)
        state = State(0.0, self.start, np.zeros(len(WORKS)))
        while True:
            yield self.size(state.time, state.motion)
            state = stepper.step(state, system.rates(state.time, state.motion))


def energy_weights(system: Linearised) -> Vector:
    """[11], J over squared units of coordinates and velocities."""
    inertia = np.array([1 / system.b[PLACES + k, WRENCH_OF[k]] for k in range(6)])
    stiffness = np.abs(np.diag(system.whole[PLACES : 2 * PLACES, :PLACES]))
    return 0.5 * np.concatenate([inertia[:PLACES] * stiffness, inertia])


def growth_of(sizes: list[float], duration: float) -> float:
    """1/s, by a line through the logarithm over the second half of a run that took so long (s)."""
    half = np.log(sizes[len(sizes) // 2 :])
    return float(np.polyfit(np.linspace(0.0, 0.5 * duration, len(half)), half, 1)[0])


def latest(sizes: list[float]) -> float:
    """The greatest of the second half."""
    return max(sizes[len(sizes) // 2 :])


def step_count(name: str, step: float) -> int:
    """Of a run."""
    most = MOST_ITERATED if issubclass(MASTERS[name], Iterate) else MOST
    return min(most, max(FEWEST, math.ceil(DURATION / step)))


def allowed_rate(duration: float) -> float:
    """1/s, that passes for stable in a run of a duration (s)."""
    return RISE / (0.5 * duration) * max(1.0, DURATION / duration)


def is_stable(rolling: Rolling, master: Master, step: float) -> bool:
    """Whether a run with that step (s) is."""
    count = step_count(master.name, step)
    duration = count * step
    true = rolling.reference(max(duration, DURATION))
    most = LOST * max(true)
    try:
        point = master.begin(0.0, rolling.start)
        sizes = [rolling.size(0.0, point.motion)]
        for _ in range(count):
            point = master.step(point, step)
            sizes.append(rolling.size(point.time, point.motion))
            if not sizes[-1] <= most:
                return False
    except CouplingFailure:
        return False
    if latest(sizes) <= max(GONE * sizes[0], latest(rolling.reference(duration))):
        return True
    allowed = allowed_rate(duration) + max(0.0, growth_of(true, max(duration, DURATION)))
    return growth_of(sizes, duration) <= allowed


def largest(good: Callable[[float], bool], guess: float = 0.0) -> float:
    """Largest step (s) that is good, with one that is not close above it; 0: none, or LARGEST.

    guess: where to look first, after longer steps have been tried by halves: two good ones in turn
    end that.
    """
    step = LARGEST
    while step > 2 * max(guess, SMALLEST):
        if good(step) and good(0.5 * step):
            return between(good, step, 2 * step) if step < LARGEST else step
        step *= 0.5
    guess = guess or SMALLEST
    low, high = min(guess * BESIDE, LARGEST), min(guess / BESIDE, LARGEST)
    if good(low):
        while good(high):
            if high >= LARGEST:
                return LARGEST
            low, high = high, min(WIDER * high, LARGEST)
        return between(good, low, high)
    high = low
    while not good(low):
        if low <= SMALLEST:
            return 0.0
        low, high = max(low / WIDER, SMALLEST), low
    return between(good, low, high)


def between(good: Callable[[float], bool], low: float, high: float) -> float:
    """Of a good step and one that is not, by bisection."""
    while high > CLOSE * low:
        middle = math.sqrt(low * high)
        low, high = (middle, high) if good(middle) else (low, middle)
    return low


def bound_by_runs(rolling: Rolling, slave: ContactSlave, name: str) -> tuple[float, int]:
    """Largest stable step (s) and the number of runs, which begin beside the eigenvalues' bound."""
    side = Multibody(rolling.scene)
    tried: dict[float, bool] = {}

    def good(step: float) -> bool:
        if step not in tried:
            tried[step] = is_stable(rolling, MASTERS[name](side, slave), step)
        return tried[step]

    return largest(good, bound_by_matrix(rolling.system, name)), len(tried)


def bound_by_matrix(system: Linearised, name: str) -> float:
    """Largest step (s) below which all are stable by their eigenvalues."""

    def good(step: float) -> bool:
        allowed = allowed_rate(step * step_count(name, step))
        return stable(name, system, step, allowed + max(0.0, system.growth))

    steps = np.geomspace(SMALLEST, LARGEST, 200).tolist()
    first = next((i for i, step in enumerate(steps) if not good(step)), None)
    if first is None:
        return LARGEST
    if first == 0:
        return 0.0
    low, high = steps[first - 1], steps[first]
    while high > 1.001 * low:
        middle = math.sqrt(low * high)
        low, high = (middle, high) if good(middle) else (low, middle)
    return low
