"""The frontier as a picture for documents: frontier.svg and frontier.png."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from railpatch.evidence.bench.curves import (
    FRONTIER_COLOR,
    PEER_COLOR,
    PEER_NAME,
    Curve,
    curves,
    frontier_curve,
)
from railpatch.evidence.bench.run import Report
from railpatch.evidence.bench.targets import PEER

SIZE = (9.5, 6.0)  # inches
LABEL_STEP = 0.034  # least distance of two names, of the axes' height
INK = "#6b7380"  # readable on light and on dark pages


def require_matplotlib() -> None:
    """Raises ImportError that says what to install."""
    try:
        import matplotlib  # noqa: F401
    except ImportError:
        raise ImportError(
            "bench: matplotlib is missing, allowed after pip install 'railpatch[bench]'"
        ) from None


def write_pictures(report: Report, folder: Path) -> list[Path]:
    """frontier.svg and frontier.png of set A, or of the first set that was measured."""
    import matplotlib

    matplotlib.use("Agg")
    # the same picture is the same file
    matplotlib.rcParams["svg.hashsalt"] = "railpatch"
    name = report.plan.sets[0]
    figure = picture(curves(report.outcome.of_set(name)), report.machine.processor)
    written = []
    for suffix, options in (("svg", {"metadata": {"Date": None}}), ("png", {"dpi": 150})):
        path = folder / f"frontier.{suffix}"
        figure.savefig(path, transparent=suffix == "svg", **options)
        written.append(path)
    return written


def picture(found: list[Curve], processor: str) -> Any:
    """A matplotlib figure of error against run time."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=SIZE, layout="constrained")
    axes = figure.add_subplot()
    best = frontier_curve(found)
    axes.plot(1e3 * best.time, 100 * best.error, color=FRONTIER_COLOR, lw=8, alpha=0.3)
    for curve in found:
        axes.plot(1e3 * curve.time, 100 * curve.error, ls="-", marker=curve.marker[0], ms=5,
                  lw=1.3, color=curve.color)  # fmt: skip
        for grid, time, error in zip(curve.short, curve.time, curve.error, strict=True):
            axes.annotate(grid, (1e3 * time, 100 * error), (0, -4), textcoords="offset points",
                          ha="center", va="top", fontsize=5.5, color=curve.color)  # fmt: skip
    axes.plot([1e3 * p.time for p in PEER], [100 * p.error for p in PEER], "D:", ms=5,
              mfc="none", color=PEER_COLOR)  # fmt: skip
    for p in PEER:
        axes.annotate(str(p.across), (1e3 * p.time, 100 * p.error), (0, 5), fontsize=5.5,
                      textcoords="offset points", ha="center", color=PEER_COLOR)  # fmt: skip
    axes.set(
        xscale="log",
        yscale="log",
        xlabel="warm run time of a patch, median [ms]",
        ylabel=r"error of the creep force over $\mu F_n$, 95th percentile [%]",
    )
    axes.set_title(
        f"one core, {processor}; small numbers: elements across, or scale of fitted rows",
        fontsize=8,
        color=INK,
    )
    style(axes)
    last = [(c.name, c.color, 1e3 * c.time[-1], 100 * c.error[-1]) for c in found]
    label(axes, [*last, (PEER_NAME, PEER_COLOR, 1e3 * PEER[-1].time, 100 * PEER[-1].error)])
    return figure


def label(axes: Any, ends: list[tuple[str, str, float, float]]) -> None:
    """Names beside the axes at the heights of their curves' last points, moved apart.

    ends: name, colour, and the point in the units of the axes.
    """
    low, high = np.log(axes.get_ylim())
    ends = sorted(ends, key=lambda end: end[3])
    heights = spread([(np.log(end[3]) - low) / (high - low) for end in ends], LABEL_STEP)
    for (name, color, x, y), height in zip(ends, heights, strict=True):
        axes.annotate(
            name,
            (x, y),
            (1.02, height),
            textcoords="axes fraction",
            va="center",
            fontsize=7.5,
            color=color,
            arrowprops={"arrowstyle": "-", "color": color, "lw": 0.5, "alpha": 0.5},
        )


def spread(wanted: list[float], step: float) -> list[float]:
    """Ascending heights with at least a step between them, as near the wanted ones as may be.

    Least squares: pools of adjacent heights that would come too near move together.
    """
    pools: list[list[float]] = []
    for index, height in enumerate(wanted):
        pools.append([height - index * step])
        while len(pools) > 1 and np.mean(pools[-2]) > np.mean(pools[-1]):
            last = pools.pop()
            pools[-1] += last
    level = [float(np.mean(pool)) for pool in pools for _ in pool]
    return [base + index * step for index, base in enumerate(level)]


def style(axes: Any) -> None:
    """Colours that suit light and dark pages."""
    axes.grid(True, which="major", color=INK, alpha=0.25, lw=0.6)
    axes.grid(True, which="minor", color=INK, alpha=0.1, lw=0.4)
    axes.tick_params(which="both", colors=INK)
    for text in (axes.xaxis.label, axes.yaxis.label):
        text.set_color(INK)
    for spine in axes.spines.values():
        spine.set_color(INK)
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_formatter("{x:g}")
