"""Sections of the page on what is laid over a run."""

from __future__ import annotations

from html import escape

import numpy as np
import plotly.graph_objects as go
from plotly.subplots import make_subplots

from railpatch.page.figures import COLORS, GREY, OTHER, plot, styled
from railpatch.page.tables import number, table
from railpatch.report.beside import Beside, Pair

_OWN, _OTHER = COLORS["left"], OTHER
_MANY = 2000  # points of a curve; longer ones are thinned for the page
_KEYS = 30  # of scenes that differ
_FEW = 300  # points that are shown one by one


def section(beside: Beside, name: str, remark: str = "") -> list[str]:
    """Title, table of differences, curves. name: of the figure, unique on the page."""
    if not beside.pairs:
        return [f"<h2>{escape(beside.title)}</h2><p>Nothing to compare: {escape(remark)}</p>"]
    return [
        f"<h2>{escape(beside.title)}</h2><p>Differences: run minus {escape(beside.what)}, at the "
        "run's positions. Forces act on roller or rail, in track axes: x forward, y right, z "
        "down.</p>",
        *scenes(beside),
        differences(beside),
        plot(curves(beside), name),
        *_over_yaw(beside, name),
    ]


def _over_yaw(beside: Beside, name: str) -> list[str]:
    """Traction curves, where the run has a yaw angle that varies."""
    known = beside.yaw is not None and np.ptp(beside.yaw[np.isfinite(beside.yaw)]) > 0
    return [plot(traction(beside), f"{name}-traction")] if known and beside.ratios() else []


def traction(beside: Beside) -> go.Figure:
    """Lateral over vertical force against the run's yaw angle, one panel for each wheel."""
    assert beside.at is not None
    assert beside.yaw is not None
    ratios = beside.ratios()
    titles = [f"{side} wheel" for side in ratios]
    figure = make_subplots(
        1, len(ratios), shared_yaxes=True, horizontal_spacing=0.05, subplot_titles=titles
    )
    known = np.isfinite(beside.at) & np.isfinite(beside.yaw)
    for column, pair in enumerate(ratios.values(), start=1):
        own, other = (
            1e3 * np.interp(at, beside.at[known], beside.yaw[known])
            for at in (pair.at, pair.other_at)
        )
        first = column == 1
        _add(figure, 1, column, other, pair.other, beside.what, _OTHER, first, dots=True)
        _add(figure, 1, column, own, pair.own, "run", _OWN, first)
        figure.update_xaxes(title_text="yaw [mrad]", row=1, col=column)
    figure.update_yaxes(title_text="L/V = F<sub>y</sub>/F<sub>z</sub>", row=1, col=1)
    return styled(figure, 430)


def scenes(beside: Beside) -> list[str]:
    """What another log's scene has otherwise."""
    if beside.scenes is None:
        return []
    if not beside.scenes:
        return ["<p>The scenes of both runs are the same, where both logs hold one.</p>"]
    rows, more = beside.scenes[:_KEYS], len(beside.scenes) - _KEYS
    end = [f"<p>And {more} keys more.</p>"] if more > 0 else []
    return [table(["the scenes differ in", "run", beside.what], rows), *end]


def differences(beside: Beside) -> str:
    """Mean, root mean square and largest of each pair."""
    head = ["quantity", "points", "mean difference", "root mean square", "largest"]
    share = f"root mean square over largest |{beside.what}| [%]"
    return table([*head, share], map(_row, beside.pairs))


def _row(pair: Pair) -> list[object]:
    values = pair.difference[np.isfinite(pair.difference)]
    if not values.size:
        return [pair.label, 0, "-", "-", "-", "-"]
    size = float(np.nanmax(np.abs(pair.other)))
    rms = float(np.sqrt((values**2).mean()))
    share = number(100 * rms / size) if size > 0 else "-"
    largest = float(np.abs(values).max())
    return [pair.label, values.size, number(values.mean()), number(rms), number(largest), share]


def curves(beside: Beside) -> go.Figure:
    """Both curves of each pair, and their difference."""
    rows = len(beside.pairs)
    figure = make_subplots(
        rows, 2, shared_xaxes=True, horizontal_spacing=0.1, vertical_spacing=0.3 / (rows + 4)
    )
    for row, pair in enumerate(beside.pairs, start=1):
        first = row == 1
        _add(figure, row, 1, pair.other_at, pair.other, beside.what, _OTHER, first, dots=True)
        _add(figure, row, 1, pair.at, pair.own, "run", _OWN, first)
        _add(figure, row, 2, pair.at, pair.difference, f"run minus {beside.what}", GREY, first)
        figure.update_yaxes(title_text=pair.label, row=row, col=1)
        figure.update_yaxes(title_text=f"difference, {pair.label}", row=row, col=2)
    figure.update_xaxes(title_text=beside.label, row=rows)
    return styled(figure, 160 + 190 * rows)


def _add(
    figure: go.Figure,
    row: int,
    column: int,
    x: np.ndarray,
    y: np.ndarray,
    name: str,
    color: str,
    legend: bool,
    *,
    dots: bool = False,
) -> None:
    if not np.isfinite(y).any():
        return
    step = -(-len(x) // _MANY)
    few = len(x) <= _FEW
    figure.add_trace(
        go.Scatter(
            x=x[::step],
            y=y[::step],
            name=name,
            legendgroup=name,
            showlegend=legend or not any(trace.legendgroup == name for trace in figure.data),
            mode="markers" if dots and few else "lines",
            marker={"color": color, "size": 6, "symbol": "circle-open"},
            line={"color": color, "width": 1.6},
            hovertemplate=f"%{{x:.4g}}, %{{y:.5g}}<extra>{escape(name)}</extra>",
        ),
        row=row,
        col=column,
    )
