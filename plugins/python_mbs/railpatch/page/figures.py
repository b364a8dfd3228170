"""Figures of pages: their look, and as HTML."""

from __future__ import annotations

import plotly.graph_objects as go

COLORS = {"left": "#3b7dc4", "right": "#e0812b"}
GREY = "#8a919c"
GRID = "rgba(128,128,128,0.22)"


def styled(figure: go.Figure, height: int) -> go.Figure:
    """Neutral on a light and on a dark page."""
    figure.update_layout(
        height=height,
        margin={"l": 70, "r": 48, "t": 75, "b": 55},
        paper_bgcolor="rgba(0,0,0,0)",
        plot_bgcolor="rgba(0,0,0,0)",
        font={"color": GREY, "family": "system-ui, sans-serif", "size": 13},
        legend={
            "orientation": "h",
            "yref": "container",
            "yanchor": "top",
            "y": 0.995,
            "x": 0,
        },
        modebar={"bgcolor": "rgba(0,0,0,0)", "color": GREY, "orientation": "v"},
        hoverlabel={"bgcolor": "#2b2f36", "font": {"color": "#f1f3f5"}},
    )
    lines = {
        "gridcolor": GRID,
        "zerolinecolor": "rgba(128,128,128,0.5)",
        "linecolor": GRID,
        "showline": True,
        "mirror": True,
        "ticks": "outside",
        "tickcolor": GRID,
    }
    figure.update_xaxes(**lines)
    figure.update_yaxes(**lines, automargin=True)
    _titles_above(figure)
    return figure


def _titles_above(figure: go.Figure) -> None:
    """Titles of y axes above their panels, where a panel stands to the left: they need no width."""
    titled = [axis for axis in figure.select_yaxes() if axis.title.text]
    inner = [axis for axis in titled if _left(figure, axis) > 0]
    if not inner:
        return
    for axis in titled:
        figure.add_annotation(
            text=axis.title.text,
            x=_left(figure, axis),
            y=axis.domain[1],
            xref="paper",
            yref="paper",
            xanchor="left",
            yanchor="bottom",
            showarrow=False,
        )
        axis.title.text = None


def _left(figure: go.Figure, axis) -> float:
    """Where the panel of a y axis begins, from 0 to 1."""
    domain = figure.layout[f"xaxis{(axis.anchor or 'x')[1:]}"].domain
    return domain[0] if domain else 0.0


def plot(figure: go.Figure, name: str) -> str:
    """A figure as HTML; the name is unique on its page."""
    inner = figure.to_html(
        full_html=False,
        include_plotlyjs=False,
        div_id=name,
        config={
            "displaylogo": False,
            # newer versions have a button that uploads the data
            "showSendToCloud": False,
            "displayModeBar": "hover",
            "responsive": True,
            "modeBarButtonsToRemove": ["select2d", "lasso2d"],
        },
    )
    return f"<figure>{inner}</figure>"
