"""What a run has shown: waves, energies, work."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from railpatch.case.types import SIDES
from railpatch.pressure_error import run_doubts

from wheelset_demo.system import WORKS
from wheelset_demo.trace import Trace

Vector = NDArray[np.float64]


@dataclass(frozen=True)
class Waves:
    """The wheelset's waves along the track.

    length: m, mean of those found. count: half waves between zero crossings of y. first, last: m,
    amplitudes. conicity: -, half the difference of the rolling radii over y, by least squares over
    the run. half_distance: m, of the contacts, mean. klingel: m, 2 pi sqrt(r0 e0 / conicity) of
    these. NaN where the run is too short.
    """

    length: float
    count: int
    first: float
    last: float
    conicity: float
    radius: float
    half_distance: float
    klingel: float


@dataclass(frozen=True)
class Summary:
    """A run in numbers. Energies in J since the start; wall_time in s; logging_share of it in the
    log.

    Errors of the balances are parts of the energy lost, and of momentum and moment of momentum at
    the start.
    """

    good: bool
    message: str
    steps: int
    distance: float
    duration: float
    waves: Waves
    energies: dict[str, float]
    mechanical_error: float
    contact_error: float
    momentum_error: float
    turning_error: float
    in_the_air: dict[str, int]
    warnings: list[str]
    evaluations: int
    solve_seconds: float
    wall_time: float
    logging_share: float

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers; None for what is not known."""
        values = dict(self.__dict__) | {"waves": dict(self.waves.__dict__)}
        return {key: plain(value) for key, value in values.items()}

    def text(self) -> str:
        """A few lines for the terminal."""
        w, e = self.waves, self.energies
        lines = [
            ("distance", f"{self.distance:.2f} m in {self.duration:.3f} s, {self.steps} steps"),
            ("wave length", f"{w.length:.3f} m, mean of {w.count} half waves"),
            ("Klingel", f"{w.klingel:.3f} m with conicity {w.conicity:.5f} found in the run"),
            ("amplitude", f"{1e3 * w.first:.3f} mm at first, {1e3 * w.last:.3f} mm at last"),
            ("drive", f"{e['drive']:.4g} J put in"),
            ("lost", f"{e['friction']:.4g} J in friction, {e['damping']:.4g} J in dampers"),
            (
                "balance",
                f"open by {100 * self.mechanical_error:.2g} % (bodies and springs), "
                f"{100 * self.contact_error:.2g} % (contacts) of what was lost",
            ),
            (
                "momentum",
                f"open by {self.momentum_error:.2g}, about the centre by {self.turning_error:.2g} "
                "of the wheelset's own",
            ),
            ("in the air", ", ".join(f"{s} {n} steps" for s, n in self.in_the_air.items())),
            (
                "wall time",
                f"{self.wall_time:.2f} s, of it contact {self.solve_seconds:.2f} s "
                f"in {self.evaluations} evaluations",
            ),
        ]
        if math.isfinite(self.logging_share):
            lines.append(("logging", f"{100 * self.logging_share:.2g} % of the run's wall time"))
        return "\n".join(f"{name:<16}{value}" for name, value in lines)


def plain(value: Any) -> Any:
    """NaN as None, also inside dictionaries."""
    if isinstance(value, dict):
        return {key: plain(item) for key, item in value.items()}
    return None if isinstance(value, float) and not math.isfinite(value) else value


def summarise(
    trace: Trace, wall_time: float = math.nan, logging_share: float = math.nan
) -> Summary:
    """Of a run that may have ended early, even at its start."""
    logged = bool(trace.times)
    energies = {name: last(trace.work(name)) for name in WORKS}
    lost = energies["friction"] + energies["damping"]
    momentum, turning = trace.momentum_errors() if logged else (math.nan, math.nan)
    return Summary(
        good=trace.failure is None,
        message=str(trace.failure or ""),
        steps=round(last(trace.times) / trace.scene.run.step) if logged else 0,
        distance=last(trace.coordinate(0)),
        duration=last(trace.times),
        waves=waves_of(trace),
        energies=energies,
        mechanical_error=largest(trace.mechanical_residual()) / lost if lost > 0 else math.nan,
        contact_error=largest(trace.contact_residual()) / lost if lost > 0 else math.nan,
        momentum_error=momentum,
        turning_error=turning,
        in_the_air={
            side: sum(status[side] == "no_contact" for status in trace.statuses) for side in SIDES
        },
        warnings=[*run_doubts(trace.scene.case, Path()), *trace.warned.lines()],
        evaluations=trace.evaluations,
        solve_seconds=trace.solve_seconds,
        wall_time=wall_time,
        logging_share=logging_share,
    )


def last(values: Any) -> float:
    """The last one, NaN if there is none."""
    return float(values[-1]) if len(values) else math.nan


def largest(values: Vector) -> float:
    """By size."""
    return float(np.abs(values).max()) if len(values) else math.nan


def waves_of(trace: Trace) -> Waves:
    """Waves of the lateral position over the distance run."""
    x, y = trace.coordinate(0), trace.coordinate(1)
    crossings, peaks = half_waves(x, y)
    length = 2 * float(np.mean(np.diff(crossings))) if len(crossings) > 1 else math.nan
    conicity, distance = conicity_of(trace), half_distance_of(trace)
    radius = mean(np.array(trace.radii))
    curvature = conicity / (radius * distance) if distance > 0 else math.nan
    return Waves(
        length,
        max(0, len(crossings) - 1),
        float(abs(y[0])) if len(y) else math.nan,
        float(peaks[-1]) if len(peaks) else math.nan,
        conicity,
        radius,
        distance,
        2 * math.pi / math.sqrt(curvature) if curvature > 0 else math.nan,
    )


def half_waves(x: Vector, y: Vector) -> tuple[Vector, Vector]:
    """Zero crossings of y over x, [k], and the largest |y| between them, [k - 1].

    Crossings by a straight line between neighbours.
    """
    at = np.flatnonzero(y[1:] * y[:-1] < 0) if len(y) > 1 else np.zeros(0, dtype=int)
    crossings = x[at] - y[at] * (x[at + 1] - x[at]) / (y[at + 1] - y[at])
    pairs = itertools.pairwise(at)
    peaks = [float(np.abs(y[i + 1 : j + 1]).max()) for i, j in pairs]
    return crossings, np.array(peaks)


def conicity_of(trace: Trace) -> float:
    """Slope of half the radii's difference over y at the height of the rails, through the origin.

    The wheelset rolls about its axle, one radius above the rails, so that its tread moves by
    y - r0 roll; pure rolling makes that coordinate the one whose waves are Klingel's.
    """
    if len(trace.times) < 2:
        return math.nan
    radius = trace.scene.case.wheelset.nominal_radius
    y = trace.coordinate(1) - radius * trace.coordinate(3)
    radii = np.array(trace.radii)
    known = np.isfinite(radii).all(axis=1)
    if not (y[known] ** 2).sum() > 0:
        return math.nan
    half = 0.5 * (radii[known, 1] - radii[known, 0])
    return float((half @ y[known]) / (y[known] @ y[known]))


def half_distance_of(trace: Trace) -> float:
    """m, mean half distance of the contacts."""
    contacts = np.array(trace.contacts)
    return 0.5 * mean(contacts[:, 1] - contacts[:, 0]) if len(contacts) else math.nan


def mean(values: Vector) -> float:
    """Of those that are known."""
    known = values[np.isfinite(values)]
    return float(known.mean()) if known.size else math.nan
