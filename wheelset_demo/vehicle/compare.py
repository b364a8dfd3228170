"""One scene with several contact theories: run times beside published ones."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from railpatch.case.common import Grid
from railpatch.case.load import check_case
from railpatch.errors import CaseError

from wheelset_demo.vehicle.scene import VehicleScene
from wheelset_demo.vehicle.simulation import Simulation
from wheelset_demo.vehicle.system import VehicleState
from wheelset_demo.vehicle.trace import VehicleSummary, run_vehicle, summarise


@dataclass(frozen=True)
class Theory:
    """A choice of [method] and [grid]. published: s, CPU time of the scene "Vehicle (50 dof) curve,
    irreg., 20 s, 300 km/h" with a code's like theory; NaN: none."""

    normal: str
    tangential: str
    grid: dict[str, list[int]]
    published: float = math.nan
    code: str = ""

    @property
    def text(self) -> str:
        """A name for tables."""
        size = " + ".join(f"{part[0]} x {part[1]}" for part in self.grid.values())
        return f"{NAMES[self.normal]}, {self.tangential}, {size}"


NAMES = {
    "half_space": "half-space",
    "hertz": "Hertz",
    "kik_piotrowski": "Kik-Piotrowski",
    "analyn": "ANALYN",
}
FINE, FAST = {"elements": [16, 16]}, {"elements": [10, 10]}
# FRA report, Table 5
THEORIES = {
    "full": Theory("half_space", "full", FINE, 383.0, "CONTACT"),
    # tangential problem on rows fitted to the contact, ten times as exact
    "fitted": Theory("half_space", "full", {**FINE, "fitted": [10, 10]}, 383.0, "CONTACT"),
    "fastsim": Theory("hertz", "fastsim", FAST, 17.36, "Hertz, FASTSIM"),
    "kik": Theory("kik_piotrowski", "fastsim", FAST, 25.97, "Kik-Piotrowski"),
    "analyn": Theory("analyn", "fastsim", FAST),
    "polach": Theory("hertz", "polach", FAST),
}
# that all others are compared with, and what --compare runs
BASE = "fastsim"
COMPARED = ("fastsim", "kik", "full")
# s, simulated by the published runs
PUBLISHED_DURATION = 20.0
HEADER = (
    *("theory", "total s", "CPU s", "contact s"),
    *("total ratio", "CPU ratio", "contact ratio", "published"),
    *("real time", "by CPU", "published"),
)


def with_theory(scene: VehicleScene, name: str) -> VehicleScene:
    """The scene with another theory. Raises CaseError where that cannot have what the scene has."""
    theory = THEORIES[name]
    choice = {"normal": theory.normal, "tangential": theory.tangential, "accuracy": None}
    found = scene.with_method(**choice, grid=Grid(**theory.grid))
    try:
        check_case(found.case.model_dump())
    except CaseError as error:
        raise CaseError(f"--method {name}: {problem}" for problem in error.problems) from None
    return found


def run_summary(
    scene: VehicleScene,
    advance: Callable[[VehicleState], Any] | None = None,
    output: Path | None = None,
    *,
    step_times: bool = False,
) -> VehicleSummary:
    """One run. output: its log. step_times: of each step. Raises CaseError, ProfileError,
    OSError."""
    simulation = Simulation(scene, step_times=step_times)
    return summarise(run_vehicle(simulation, advance, output), simulation)


def rows_of(found: dict[str, VehicleSummary]) -> list[list[str]]:
    """Of the table of times, by theory; HEADER has the columns' names."""
    base = found.get(BASE)
    return [row_of(name, summary, base) for name, summary in found.items()]


def row_of(name: str, summary: VehicleSummary, base: VehicleSummary | None) -> list[str]:
    """One theory's."""
    theory, seconds = THEORIES[name], summary.seconds
    ratios = [
        number(seconds[key] / base.seconds[key] if base else math.nan)
        for key in ("total", "cpu", "contact")
    ]
    published = theory.published / THEORIES[BASE].published
    return [
        theory.text,
        *(number(seconds[key]) for key in ("total", "cpu", "contact")),
        *ratios,
        number(published),
        number(summary.real_time),
        number(seconds["cpu"] / summary.duration if summary.duration > 0 else math.nan),
        number(theory.published / PUBLISHED_DURATION),
    ]


def number(value: float) -> str:
    """Three figures; a dash where there is none."""
    return "-" if math.isnan(value) else f"{value:.3g}"


def table_of(found: dict[str, VehicleSummary]) -> str:
    """Lines for the terminal."""
    rows = [list(HEADER), *rows_of(found)]
    widths = [max(len(row[k]) for row in rows) for k in range(len(HEADER))]
    lines = []
    for row in rows:
        cells = [row[0].ljust(widths[0])]
        cells += [cell.rjust(width) for cell, width in zip(row[1:], widths[1:], strict=True)]
        lines.append("  ".join(cells).rstrip())
    times = {theory.code: theory.published for theory in THEORIES.values() if theory.code}
    published = "; ".join(f"{code} {time:g} s" for code, time in times.items())
    lines.append(f"published CPU times of 20 s: {published}")
    return "\n".join(lines)
