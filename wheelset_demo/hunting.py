"""Hunting: the speed above which a wheelset's lateral motion grows.

Of the equations of motion, linearised at the wheelset that runs straight in the middle of the
track with the contact's exact derivatives: the critical speed is where the first eigenvalue crosses
the imaginary axis (Wickens, Fundamentals of Rail Vehicle Dynamics, 2003). And of runs in time:
where the waves of a wheelset released beside the middle neither grow nor die.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
import scipy
from railpatch import CaseError

from wheelset_demo.scene import WheelsetScene, refuse_bulk, refuse_changes
from wheelset_demo.simulation import Simulation
from wheelset_demo.start import released
from wheelset_demo.system import COUNT, System, Vector

PITCH = 5  # nothing depends on that angle
# 1/s: below it an eigenvalue is none of a wave
SLOWEST = 0.1
# 1/s: above it a motion without waves grows; below it is what solves leave of a zero
DRIFT = 1e-2
# m/s, by which speeds are tried, and -, to which the critical one is found
SPEED_STEP = 10.0
ACCURACY = 1e-3
# of runs: waves that count, and those before that do not, while the fast motions die
WAVES, FIRST_WAVES = 4.0, 1.0
LOGGED = 40  # points a wave
LONG_WAVES = 12.0  # of a run that is logged


@dataclass(frozen=True)
class Mode:
    """The wave that grows fastest, or dies most slowly. speed: m/s. growth: 1/s. frequency: Hz.
    share: [11], of coordinates without pitch and of rates, the greatest 1. divergence: 1/s, by
    which the motion beside it grows that is no wave; 0: none does."""

    speed: float
    growth: float
    frequency: float
    share: Vector
    divergence: float = 0.0

    @property
    def wave_length(self) -> float:
        """m."""
        return self.speed / self.frequency if self.frequency > 0 else math.inf

    @property
    def damping(self) -> float:
        """-, of critical; below 0 where it grows."""
        return -self.growth / math.hypot(self.growth, 2 * math.pi * self.frequency)


def linearised(scene: WheelsetScene, speed: float) -> Vector:
    """[11, 11], of the rates of coordinates without pitch and of velocities, straight on at a
    speed (m/s). Raises CaseError, ContactFailure."""
    refuse_bulk(scene.case, "the search for a hunting speed")
    refuse_changes(scene.case, "the search for a hunting speed")
    straight = scene.at_speed(speed, 0.0)
    system = System(straight, exact=True)
    state = released(straight, system)
    system.rates(state.time, state.motion)
    matrix = system.derivatives(state.motion).by_motion[: 2 * COUNT]
    return np.delete(np.delete(matrix, PITCH, axis=0), PITCH, axis=1)


def slowest_mode(scene: WheelsetScene, speed: float) -> Mode:
    """Of all waves at a speed (m/s)."""
    return mode_of(linearised(scene, speed), speed)


def mode_of(matrix: Vector, speed: float, counts: Callable[[Vector], bool] | None = None) -> Mode:
    """Of a matrix of rates at a speed (m/s). counts: whether a wave of this shape is looked at."""
    values, vectors = np.linalg.eig(matrix)
    waves = np.flatnonzero(values.imag > SLOWEST)
    if counts is not None:
        waves = np.array([k for k in waves if counts(np.abs(vectors[:, k]))], dtype=np.int64)
    if not waves.size:
        # no wave at all: nothing but decay, or drift
        waves = np.arange(len(values))
    first = waves[np.argmax(values[waves].real)]
    size = np.abs(vectors[:, first])
    value = values[first]
    others = values.real[np.abs(values.imag) <= SLOWEST]
    drift = float(others.max(initial=0.0))
    frequency = float(value.imag) / (2 * math.pi)
    divergence = drift if drift > DRIFT else 0.0
    return Mode(speed, float(value.real), frequency, size / size.max(), divergence)


@dataclass(frozen=True)
class Search:
    """Between two speeds. critical: at the lowest one where a wave begins to grow; None: nowhere.
    first: at the lowest speed. diverging: at the first speed tried where the wheelset leaves the
    middle without a wave; None: at none."""

    critical: Mode | None
    first: Mode
    diverging: Mode | None

    @property
    def below(self) -> bool:
        """Whether waves grow already at the lowest speed."""
        return self.first.frequency > 0 and self.first.growth > 0


def critical_mode(scene: WheelsetScene, lowest: float, highest: float) -> Mode | None:
    """Search.critical."""
    return search_modes(scene, lowest, highest).critical


def search_modes(scene: WheelsetScene, lowest: float, highest: float) -> Search:
    """Between these speeds (m/s), up to the critical one. Raises CaseError, ContactFailure."""
    return search(partial(slowest_mode, scene), lowest, highest)


def search(mode_at: Callable[[float], Mode], lowest: float, highest: float) -> Search:
    """The same of the slowest mode at each speed (m/s)."""
    found: dict[float, Mode] = {}

    def growth(speed: float) -> float:
        found[speed] = mode_at(speed)
        return found[speed].growth

    def result(critical: Mode | None) -> Search:
        tried = (found[speed] for speed in sorted(found))
        diverging = next((mode for mode in tried if mode.divergence > 0), None)
        return Search(critical, found[lowest], diverging)

    count = max(2, 1 + math.ceil((highest - lowest) / SPEED_STEP))
    speeds = np.linspace(lowest, highest, count).tolist()
    for before, speed in itertools.pairwise(speeds):
        # already at the first speed: the critical one is below all of them
        if growth(before) > 0:
            return result(None)
        if growth(speed) > 0:
            root = float(scipy.optimize.brentq(growth, before, speed, rtol=ACCURACY))
            growth(root)
            return result(found[root])
    return result(None)


@dataclass(frozen=True)
class Run:
    """A run in time. speed: m/s. growth: 1/s, of the waves. frequency: Hz. times, y: s, m."""

    speed: float
    growth: float
    frequency: float
    times: Vector
    y: Vector


def run_at(scene: WheelsetScene, speed: float, frequency: float) -> Run:
    """Waves of a wheelset released at the scene's y; frequency: Hz, expected, of their number.

    Raises CaseError, ContactFailure.
    """
    duration = (FIRST_WAVES + WAVES) / frequency
    every = max(1, round(1 / (LOGGED * frequency * scene.run.step)))
    table = scene.run.model_copy(
        update={"distance": speed * duration, "log_every": every, "snapshot_every": 0}
    )
    simulation = Simulation(replace(scene.at_speed(speed, scene.case.wheelset.y), run=table))
    trace = simulation.run()
    if trace.failure is not None:
        raise trace.failure
    times, y = np.array(trace.times), trace.coordinate(1)
    growth, found = waves_in(times, y, FIRST_WAVES / frequency)
    if math.isnan(growth):
        raise CaseError(f"run: the waves at {speed:.4g} m/s die too soon to be seen")
    return Run(speed, growth, found, times, y)


def long_run(scene: WheelsetScene, speed: float, frequency: float) -> WheelsetScene:
    """The scene of a run at a speed (m/s) that shows waves of a frequency (Hz) grow or die."""
    every = max(1, round(1 / (LOGGED * frequency * scene.run.step)))
    update = {"distance": speed * LONG_WAVES / frequency, "log_every": every}
    table = scene.run.model_copy(update=update)
    return replace(scene.at_speed(speed, scene.case.wheelset.y), run=table)


def waves_in(times: Vector, y: Vector, start: float) -> tuple[float, float]:
    """Growth (1/s) and frequency (Hz) of waves after a start (s), from their crests.

    Crests are those of the parabola through three points; their logarithms lie on a straight line.
    """
    crests = np.array([crest for crest in crests_of(times, y) if crest[0] >= start])
    if len(crests) < 3:
        return math.nan, math.nan
    at, height = crests.T
    growth = float(np.polyfit(at, np.log(height), 1)[0])
    return growth, 0.5 / float(np.diff(at).mean())


def crests_of(times: Vector, y: Vector) -> Iterator[tuple[float, float]]:
    """Times and heights of the greatest |y| between zero crossings."""
    size = np.abs(y)
    for i in range(1, len(y) - 1):
        if size[i] >= size[i - 1] and size[i] > size[i + 1] and y[i - 1] * y[i + 1] > 0:
            a, b, c = size[i - 1 : i + 2]
            shift = 0.5 * (a - c) / (a - 2 * b + c)
            yield times[i] + shift * (times[i + 1] - times[i]), b - 0.25 * (a - c) * shift


def critical_speed_in_time(
    scene: WheelsetScene, low: float, high: float, frequency: float
) -> tuple[float, list[Run]]:
    """m/s, where waves in time neither grow nor die, and the runs that say so.

    low, high: m/s, speeds at which they die and grow. frequency: Hz, expected. Brent's method on
    the growth. Raises CaseError where the speeds do not enclose it, ContactFailure.
    """
    runs: dict[float, Run] = {}

    def growth(speed: float) -> float:
        if speed not in runs:
            runs[speed] = run_at(scene, speed, frequency)
        return runs[speed].growth

    if growth(low) > 0 or growth(high) < 0:
        shown = ", ".join(f"{run.growth:.3g} 1/s at {run.speed:.4g} m/s" for run in runs.values())
        raise CaseError(f"run: waves grow by {shown}, allowed < 0 and > 0")
    return float(scipy.optimize.brentq(growth, low, high, rtol=ACCURACY)), list(runs.values())
