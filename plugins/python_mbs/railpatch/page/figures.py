"""Figures of pages: their look, and as HTML."""

from __future__ import annotations

from html import escape

import plotly.graph_objects as go

from railpatch.page.document import data_of
from railpatch.page.panels import Entry, marked_up, packed, parts_of

# each at least 3:1 against the ground of a light and of a dark page
COLORS = {"left": "#3b7dc4", "right": "#cf6f17"}
GREY = "#7f8791"
LINES = ("#3b7dc4", "#cf6f17", "#4f9163", "#c2528b", "#9467bd", "#17879c", "#b5651d", GREY)
BAD = "#d62839"
OTHER = "#c2528b"  # what is laid over a run
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
    """A figure as HTML; the name is unique on its page. Its panels stand one below the other where
    there is no room for more."""
    parts = parts_of(figure)
    legend = "".join(
        f'<button type=button aria-pressed=true data-group="{escape(entry.group)}">'
        f"{_sample(entry)}<span>{marked_up(entry.name)}</span></button>"
        for entry in parts.legend
    )
    panels = "".join(
        f"<div class=panel><p class=panel-title>{panel.title}</p><div class=plot "
        f'style="min-height:{panel.height}px"></div></div>'
        for panel in parts.panels
    )
    columns = {1: "", 2: " two"}.get(parts.columns, " many")
    data = {
        "panels": [
            {
                "traces": packed(panel.traces),
                "layout": packed(panel.layout),
                "height": panel.height,
                "link": panel.link,
            }
            for panel in parts.panels
        ]
    }
    return (
        f'<figure id="{escape(name)}">'
        + (f'<div class=legend role=group aria-label="curves">{legend}</div>' if legend else "")
        + f'<div class="panels{columns}">{panels}</div></figure>{data_of(name, data)}'
    )


def _sample(entry: Entry) -> str:
    """What a curve of the legend looks like."""
    color = escape(entry.color)
    dashes = {"dash": "6 3", "dot": "2 3", "dashdot": "6 2 2 2", "line": ""}
    if entry.symbol in dashes:
        stroke = f' stroke-dasharray="{dashes[entry.symbol]}"' if dashes[entry.symbol] else ""
        inner = f'<path d="M1 6H21" stroke="{color}" stroke-width="2.5"{stroke}/>'
    else:
        style = f'fill="none" stroke="{color}" stroke-width="2"'
        if not entry.symbol.endswith("open"):
            style = f'fill="{color}"'
        kind = entry.symbol.split("-")[0]
        shapes = {
            "square": f'<rect x="6" y="1" width="10" height="10" {style}/>',
            "diamond": f'<path d="M11 1L16 6L11 11L6 6Z" {style}/>',
            "line": f'<path d="M5 6H17" {style}/>',
            "x": f'<path d="M7 2L15 10M15 2L7 10" stroke="{color}" stroke-width="2"/>',
            "cross": f'<path d="M11 1V11M6 6H16" stroke="{color}" stroke-width="2"/>',
            "triangle": f'<path d="M11 1L16 10H6Z" {style}/>',
        }
        inner = shapes.get(kind, f'<circle cx="11" cy="6" r="4.5" {style}/>')
    return f'<svg width="22" height="12" aria-hidden="true">{inner}</svg>'
