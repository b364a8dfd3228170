"""What this version wants to reach, and what the peer reaches, beside what was measured.

The peer is the program CONTACT 25.2 (open source, 2025; gfortran -O3, MKL, one thread), measured in
November 2026 on one core of an AMD EPYC machine where one real 64 x 64 FFT takes 8.8 us.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from railpatch.evidence.bench.cost import SizeCost, WheelCost, growth_points
from railpatch.evidence.bench.methods import UNIFORM
from railpatch.evidence.bench.statistics import Summary, fastest_within, growth

MS, US = 1e3, 1e6


@dataclass(frozen=True)
class PeerPoint:
    """Published point of the peer: elements across, 95th percentile of the force error over
    friction coefficient times normal force (90 random Hertzian cases), s a cold patch."""

    across: int
    error: float
    time: float


PEER = (
    PeerPoint(20, 0.019, 12e-3),
    PeerPoint(31, 0.013, 70e-3),
    PeerPoint(53, 0.0085, 0.7),
    PeerPoint(86, 0.005, 6.0),
)
# elements in contact and s: its default solver, steady rolling, cold
PEER_COST = ((80, 1.9e-3), (208, 5.6e-3), (316, 13e-3), (812, 85e-3), (1828, 0.43), (3248, 1.78))


@dataclass(frozen=True)
class Outcome:
    """All that targets are compared with."""

    summaries: list[Summary]
    costs: list[SizeCost]
    normal: tuple[float, float]
    wheel: WheelCost

    def of_set(self, name: str) -> list[Summary]:
        """Summaries of one set."""
        return [s for s in self.summaries if s.problem_set == name]


@dataclass(frozen=True)
class Target:
    """must, aim: largest values. measured: the values, or why there are none.

    The values stand in the order of the title, in its unit.
    """

    title: str
    must: tuple[float, ...]
    aim: tuple[float, ...]
    measured: Callable[[Outcome], tuple[float, ...] | str]


@dataclass(frozen=True)
class Row:
    """A line of the table. verdict: "aim", "must", "missed" or "-"."""

    title: str
    measured: str
    must: str
    aim: str
    verdict: str


def equal_grid(across: int) -> Callable[[Outcome], tuple[float, ...] | str]:
    """Cold and warm median of the uniform grid on set A."""

    def measured(outcome: Outcome) -> tuple[float, ...] | str:
        for s in outcome.of_set("A"):
            if s.method == UNIFORM.name and s.elements == across:
                return MS * s.values["cold_median"], MS * s.values["warm_median"]
        return "grid not measured"

    return measured


def within(error: float, unit: float, method: str | None = None) -> Callable[..., object]:
    """Warm median of the fastest method whose force error is small enough on set A."""

    def measured(outcome: Outcome) -> tuple[float, ...] | str:
        summaries = [s for s in outcome.of_set("A") if method in (None, s.method)]
        if not summaries:
            return "method not measured"
        best = fastest_within(summaries, error)
        return (unit * best.values["warm_median"],) if best else "no method is so exact"

    return measured


def exponent(outcome: Outcome) -> tuple[float, ...] | str:
    """Of the cost over elements, the uniform grid: cold, then warm."""
    costs = [c for c in outcome.costs if c.method is UNIFORM]
    if len(costs) < 2:
        return "not measured"
    elements, cold, warm = growth_points(costs)
    return growth(elements, cold), growth(elements, warm)


TARGETS = (
    Target("equal grid, 16 across, cold / warm, ms", (1.2, 0.5), (0.8, 0.25), equal_grid(16)),
    Target("equal grid, 32 across, cold / warm, ms", (8, 2.5), (4, 1.2), equal_grid(32)),
    Target("equal grid, 64 across, cold / warm, ms", (60, 15), (25, 6), equal_grid(64)),
    Target("force error of at most 1 %, warm, ms", (0.6,), (0.2,), within(0.01, MS)),
    Target("force error of at most 0.3 %, warm, ms", (3,), (1,), within(0.003, MS)),
    Target("table, force error of at most 0.5 %, us", (3,), (1,), within(0.005, US, "table")),
    Target(
        "normal problem, 32 across, cold / warm, ms",
        (0.8, 0.3),
        (0.4, 0.15),
        lambda outcome: tuple(MS * t for t in outcome.normal),
    ),
    Target("growth with the elements, exponent cold / warm", (1.25,) * 2, (1.1,) * 2, exponent),
    Target("rig's wheel at 0.4 mm, warm, ms", (2.5,), (1,), lambda o: (MS * o.wheel.wheel,)),
    Target("rig's position balanced, warm, ms", (20,), (5,), lambda o: (MS * o.wheel.position,)),
)


def rows(outcome: Outcome) -> list[Row]:
    """The table of targets."""
    found = []
    for target in TARGETS:
        measured = target.measured(outcome)
        shown = measured if isinstance(measured, str) else joined(measured)
        found.append(
            Row(
                title=target.title,
                measured=shown,
                must=joined(target.must),
                aim=joined(target.aim),
                verdict=verdict(target, measured),
            )
        )
    return found


def verdict(target: Target, measured: tuple[float, ...] | str) -> str:
    """Which column all values reach."""
    if isinstance(measured, str) or not np.isfinite(measured).all():
        return "-"
    for name in ("aim", "must"):
        if np.all(np.array(measured) <= getattr(target, name)):
            return name
    return "missed"


def joined(values: tuple[float, ...]) -> str:
    """Values with three digits, a slash between."""
    return " / ".join(f"{value:.3g}" for value in values)
