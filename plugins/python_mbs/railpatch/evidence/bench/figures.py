"""Figures of the page."""

from __future__ import annotations

import numpy as np
import plotly.graph_objects as go

from railpatch.evidence.bench.curves import (
    FRONTIER_COLOR,
    PEER_COLOR,
    PEER_NAME,
    CostCurve,
    Curve,
    frontier_curve,
)
from railpatch.evidence.bench.targets import PEER, PEER_COST
from railpatch.page.figures import GRID
from railpatch.page.figures import styled as look

HOVER = "%{text}<br>%{x:.4g} ms, %{y:.3g} %<extra></extra>"
COST_HOVER = "%{x:.0f} elements, %{y:.4g} ms<extra></extra>"


def error_over_time(found: list[Curve]) -> go.Figure:
    """95th percentile of the force error against the warm run time, logarithmic."""
    figure = go.Figure()
    best = frontier_curve(found)
    figure.add_scatter(
        x=1e3 * best.time,
        y=100 * best.error,
        mode="lines",
        name="frontier",
        line={"color": FRONTIER_COLOR, "width": 9},
        opacity=0.3,
        hoverinfo="skip",
    )
    for curve in found:
        figure.add_scatter(
            x=1e3 * curve.time,
            y=100 * curve.error,
            text=curve.labels,
            mode="lines+markers",
            name=curve.name,
            line={"color": curve.color, "width": 1.5},
            marker={"size": 9, "symbol": curve.marker[1]},
            hovertemplate=HOVER,
        )
    figure.add_scatter(
        x=[1e3 * p.time for p in PEER],
        y=[100 * p.error for p in PEER],
        text=[f"CONTACT, {p.across} across" for p in PEER],
        mode="lines+markers",
        name=PEER_NAME,
        line={"color": PEER_COLOR, "dash": "dot"},
        marker={"symbol": "diamond-open", "size": 9},
        hovertemplate=HOVER,
    )
    title = "error of the creep force over \u03bcF<sub>n</sub>, 95th percentile [%]"
    return styled(figure, "warm run time of a patch, median [ms]", title)


def cost_over_elements(found: list[CostCurve]) -> go.Figure:
    """Run time against the number of elements in contact, with the fitted powers."""
    figure = go.Figure()
    for curve in found:
        cold, warm = curve.exponents
        for name, time, exponent, dash in (
            ("cold", curve.cold, cold, "solid"),
            ("warm", curve.warm, warm, "dash"),
        ):
            figure.add_scatter(
                x=curve.elements,
                y=1e3 * time,
                mode="lines+markers",
                name=f"{curve.name}, {name}: N<sup>{exponent:.2f}</sup>",
                line={"color": curve.color, "dash": dash},
                hovertemplate=COST_HOVER,
            )
    elements, time = np.array(PEER_COST).T
    figure.add_scatter(
        x=elements,
        y=1e3 * time,
        mode="lines+markers",
        name=PEER_NAME,
        line={"color": PEER_COLOR, "dash": "dot"},
        marker={"symbol": "diamond-open", "size": 9},
        hovertemplate=COST_HOVER,
    )
    return styled(figure, "elements in contact N", "run time of a patch, median [ms]")


def styled(figure: go.Figure, x: str, y: str) -> go.Figure:
    """Logarithmic axes and the page's look."""
    look(figure, 600)
    for update, title in ((figure.update_xaxes, x), (figure.update_yaxes, y)):
        update(type="log", title_text=title, gridcolor=GRID, zeroline=False, dtick=1,
               minor={"showgrid": True, "gridcolor": "rgba(128,128,128,0.1)"})  # fmt: skip
    return figure
