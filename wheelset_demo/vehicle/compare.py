"""One scene with several contact theories: run times beside published ones."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from wheelset_demo.vehicle.scene import VehicleScene
from wheelset_demo.vehicle.simulation import Simulation
from wheelset_demo.vehicle.system import VehicleState
from wheelset_demo.vehicle.trace import VehicleSummary, run_vehicle, summarise


@dataclass(frozen=True)
class Theory:
    """A choice of [method]. published: s, CPU time of the scene "Vehicle (50 dof) curve, irreg.,
    20 s, 300 km/h", with which code; NaN: none."""

    text: str
    normal: str
    tangential: str
    published: float = math.nan
    code: str = ""


THEORIES = {
    "full": Theory("half-space, full", "half_space", "full", 383.0, "CONTACT"),
    "fastsim": Theory("Hertz, FASTSIM", "hertz", "fastsim", 17.36, "Hertz, FASTSIM"),
    "kik": Theory("Kik-Piotrowski, FASTSIM", "kik_piotrowski", "fastsim", 25.97, "Kik-Piotrowski"),
    "analyn": Theory("ANALYN, FASTSIM", "analyn", "fastsim"),
    "polach": Theory("Hertz, Polach", "hertz", "polach"),
    "table": Theory("Hertz, table", "hertz", "table"),
}
# that all others are compared with, and what --compare runs
BASE = "fastsim"
COMPARED = ("fastsim", "kik", "full")
# s, simulated by the published runs; FRA report, Table 5
PUBLISHED_DURATION = 20.0
HEADER = (
    *("theory", "total s", "CPU s", "contact s"),
    *("total ratio", "CPU ratio", "contact ratio", "published"),
    *("real time", "published"),
)


def with_theory(scene: VehicleScene, name: str) -> VehicleScene:
    """The scene with another theory."""
    theory = THEORIES[name]
    return scene.with_method(normal=theory.normal, tangential=theory.tangential)


def run_summary(
    scene: VehicleScene, advance: Callable[[VehicleState], Any] | None = None
) -> VehicleSummary:
    """One run. Raises CaseError, ProfileError."""
    simulation = Simulation(scene)
    return summarise(run_vehicle(simulation, advance), simulation)


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
    published = ", ".join(
        f"{theory.code} {theory.published:g} s" for theory in THEORIES.values() if theory.code
    )
    lines.append(f"published CPU times of 20 s: {published}")
    return "\n".join(lines)
