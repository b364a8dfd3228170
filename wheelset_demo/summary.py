"""What a run has shown: waves, energies, work."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from railpatch.case.types import SIDES
from railpatch.log.waves import Waves, waves
from railpatch.pressure_error import run_doubts

from wheelset_demo.system import WORKS
from wheelset_demo.trace import Trace

Vector = NDArray[np.float64]


@dataclass(frozen=True)
class Summary:
    """A run in numbers. Energies in J since the start; wall_time in s; logging_share of it in the
    log. wear: as RunWear.summary(), of [damage]; wear_text: for the terminal.

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
    wear: dict[str, Any] | None = None
    wear_text: str = ""

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers; None for what is not known."""
        values = dict(self.__dict__) | {"waves": dict(self.waves.__dict__)}
        del values["wear_text"]
        return {key: plain(value) for key, value in values.items()}

    def text(self) -> str:
        """A few lines for the terminal."""
        w, e = self.waves, self.energies
        lines = [
            ("distance", f"{self.distance:.2f} m in {self.duration:.3f} s, {self.steps} steps"),
            *waves_in_words(w, self.distance),
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
        if self.wear_text:
            lines.append(("wear", self.wear_text))
        if math.isfinite(self.logging_share):
            lines.append(("logging", f"{100 * self.logging_share:.2g} % of the run's wall time"))
        return "\n".join(f"{name:<16}{value}" for name, value in lines)


def waves_in_words(w: Waves, distance: float) -> list[tuple[str, str]]:
    """Lines for the terminal, also on what a run is too short for. distance: m."""
    if math.isfinite(w.length):
        length = f"{w.length:.3f} m, mean of {w.count} half waves"
    else:
        length = f"none in {distance:.2f} m: y crosses the middle less than twice"
    found = f"conicity {w.conicity:.5f} found in the run"
    if math.isfinite(w.klingel):
        klingel = f"{w.klingel:.3f} m with {found}"
    elif math.isfinite(w.conicity):
        klingel = f"none with {found}"
    else:
        klingel = "none: the run shows no conicity"
    first = f"{1e3 * w.first:.3f} mm at first, " if math.isfinite(w.first) else ""
    after = f"{1e3 * w.last:.3f} mm at last" if math.isfinite(w.last) else "no half wave after that"
    return [("wave length", length), ("Klingel", klingel), ("amplitude", first + after)]


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
        wear=None if trace.wear is None else trace.wear.summary(),
        wear_text="" if trace.wear is None else trace.wear.text(),
    )


def last(values: Any) -> float:
    """The last one, NaN if there is none."""
    return float(values[-1]) if len(values) else math.nan


def largest(values: Vector) -> float:
    """By size."""
    return float(np.abs(values).max()) if len(values) else math.nan


def waves_of(trace: Trace) -> Waves:
    """Waves of the lateral position over the distance run."""
    count = len(trace.times)
    return waves(
        trace.coordinate(0),
        trace.coordinate(1),
        trace.coordinate(3),
        np.array(trace.radii).reshape(count, 2),
        np.array(trace.contacts).reshape(count, 2),
        trace.scene.case.wheelset.nominal_radius,
    )
