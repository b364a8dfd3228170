"""The frontier as a picture for documents: frontier.svg and frontier.png."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from railpatch.bench.curves import (
    FRONTIER_COLOR,
    PEER_COLOR,
    PEER_NAME,
    Curve,
    curves,
    frontier_curve,
)
from railpatch.bench.targets import PEER

if TYPE_CHECKING:
    from railpatch.bench.run import Report

SIZE = (8.0, 5.6)  # inches
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
    axes.plot(1e3 * best.time, 100 * best.error, color=FRONTIER_COLOR, lw=8, alpha=0.3,
              label="frontier")  # fmt: skip
    for curve in found:
        axes.plot(1e3 * curve.time, 100 * curve.error, "o-", ms=4.5, lw=1.3, color=curve.color,
                  label=curve.name)  # fmt: skip
    axes.plot([1e3 * p.time for p in PEER], [100 * p.error for p in PEER], "D:", ms=5,
              mfc="none", color=PEER_COLOR, label=PEER_NAME)  # fmt: skip
    axes.set(
        xscale="log",
        yscale="log",
        xlabel="warm run time of a patch, median [ms]",
        ylabel=r"error of the creep force over $\mu F_n$, 95th percentile [%]",
    )
    axes.set_title(f"one core, {processor}", fontsize=9, color=INK)
    style(axes)
    return figure


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
    axes.legend(fontsize=8, labelcolor=INK, framealpha=0)
