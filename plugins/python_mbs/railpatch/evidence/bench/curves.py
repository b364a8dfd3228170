"""What both the page's and the printed figures show: points of methods, frontier, peer."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from railpatch.evidence.bench.cost import SizeCost, growth_points
from railpatch.evidence.bench.shapes import Floats
from railpatch.evidence.bench.statistics import Summary, frontier, growth

COLORS = ("#3b7dc4", "#e0812b", "#3f9b5b", "#b4527e", "#7a62c9", "#1f9e9e", "#a68a1d", "#d1495b")
COLORS_MORE = ("#4d6a8f", "#8d5a2b", "#5f8f3f", "#7d3c5c")
# of matplotlib and of plotly; the peer has the open diamond
MARKERS = (
    ("o", "circle"), ("s", "square"), ("^", "triangle-up"), ("v", "triangle-down"),
    ("P", "cross"), ("X", "x"), ("*", "star"), ("p", "pentagon"), ("h", "hexagon"),
    ("<", "triangle-left"), (">", "triangle-right"), ("d", "diamond-tall"),
)  # fmt: skip
PEER_COLOR, FRONTIER_COLOR = "#8a919c", "#8a919c"
PEER_NAME = "CONTACT 25.2, cold, measured elsewhere"


@dataclass(frozen=True)
class Curve:
    """One method over its grids. time: s, warm median. error: -, 95th percentile of the force.

    marker: of matplotlib and of plotly. short: the grids alone. whole: where every case converged.
    """

    name: str
    color: str
    marker: tuple[str, str]
    labels: list[str]
    short: list[str]
    whole: NDArray[np.bool_]
    time: Floats
    error: Floats


def curves(summaries: list[Summary]) -> list[Curve]:
    """One curve for each method, in the order of the summaries."""
    palette = COLORS + COLORS_MORE
    names = list(dict.fromkeys(summary.method for summary in summaries))
    found = []
    for place, name in enumerate(names):
        own = [s for s in summaries if s.method == name]
        found.append(
            Curve(
                name=own[0].title + lost_part(own),
                color=palette[place % len(palette)],
                marker=MARKERS[place % len(MARKERS)],
                labels=[s.label for s in own],
                short=[str(s.elements) if s.elements else "" for s in own],
                whole=np.array([s.not_converged == 0 for s in own]),
                time=np.array([s.values["warm_median"] for s in own]),
                error=np.array([s.values["force_error_p95"] for s in own]),
            )
        )
    return found


def lost_part(own: list[Summary]) -> str:
    """What share of the cases has no result, as text."""
    lost = max(s.not_converged / s.cases for s in own)
    return f" ({100 * lost:.2g} % without a result)" if lost else ""


@dataclass(frozen=True)
class Frontier:
    """Points that none beats; as of ``Curve``."""

    labels: list[str]
    time: Floats
    error: Floats


def frontier_curve(found: list[Curve]) -> Frontier:
    """The points of all curves, with every case solved, that none beats in both time and error."""
    whole = np.concatenate([c.whole for c in found])
    time = np.where(whole, np.concatenate([c.time for c in found]), np.nan)
    error = np.concatenate([c.error for c in found])
    labels = [label for c in found for label in c.labels]
    best = frontier(time, error)
    return Frontier([labels[i] for i in best], time[best], error[best])


@dataclass(frozen=True)
class CostCurve:
    """Cost of a method over its elements in contact, s, with the exponents of growth."""

    name: str
    color: str
    elements: Floats
    cold: Floats
    warm: Floats

    @property
    def exponents(self) -> tuple[float, float]:
        """Of the cold and of the warm times."""
        return growth(self.elements, self.cold), growth(self.elements, self.warm)


def cost_curves(costs: list[SizeCost]) -> list[CostCurve]:
    """One curve for each method."""
    names = list(dict.fromkeys(c.method.name for c in costs))
    found = []
    for place, name in enumerate(names):
        own = [c for c in costs if c.method.name == name]
        elements, cold, warm = growth_points(own)
        found.append(CostCurve(own[0].method.label, COLORS[place], elements, cold, warm))
    return found
