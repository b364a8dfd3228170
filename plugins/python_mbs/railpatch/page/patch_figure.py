"""Figure of patches: pressure, traction and element division."""

from __future__ import annotations

from typing import Any

import numpy as np
import plotly.graph_objects as go
from plotly.subplots import make_subplots

from railpatch import _core
from railpatch.case.types import SIDES
from railpatch.page.figures import styled

ELEMENT_STATES: tuple[str, ...] = _core.CHOICES["element"]
STATE_COLORS = ("rgba(128,128,128,0.12)", "#3b7dc4", "#cf6f17", "#b23a48")
_ROWS = ("pressure", "traction", "division")
_ARROWS = 16  # at most, along each direction


def patch_figure(chosen: dict[str, Any]) -> go.Figure:
    """The most loaded patch of each wheel; left and right side by side."""
    return patches_figure({side: most_loaded(chosen[side]) for side in SIDES})


def patches_figure(grids: dict[str, dict[str, Any] | None]) -> go.Figure:
    """Patches side by side, by their titles; None leaves a place empty."""
    count = len(grids)
    titles = [f"{name}: {row}" if name else row for row in _ROWS for name in grids]
    figure = make_subplots(
        3, count, subplot_titles=titles, horizontal_spacing=0.2 / count, vertical_spacing=0.09
    )
    shown = [grid for grid in grids.values() if grid]
    top = max((grid["pressure"].max() for grid in shown), default=0.0)
    for column, plain in enumerate(grids.values(), start=1):
        if plain is None:
            continue
        grid = regular(plain)
        _pressure(figure, grid, column, 1e-6 * top, scale=column == count)
        _traction(figure, grid, column)
        _division(figure, grid, column)
    for number in states_of(shown)[1:]:
        figure.add_trace(
            go.Scatter(
                x=[None],
                y=[None],
                mode="markers",
                name=ELEMENT_STATES[number],
                marker={"color": STATE_COLORS[number], "symbol": "square", "size": 12},
            ),
            row=3,
            col=1,
        )
    styled(figure, 800)
    figure.update_layout(
        legend={"y": 0.005, "yanchor": "bottom", "x": 0.5, "xanchor": "center"},
        margin={"b": 90, "r": 60},
        modebar={"orientation": "h"},
    )
    for row in range(1, 4):
        for column in range(1, count + 1):
            number = count * (row - 1) + column
            figure.update_yaxes(
                scaleanchor=f"x{number if number > 1 else ''}",
                row=row,
                col=column,
                title_text="lateral [mm]" if column == 1 else None,
            )
    figure.update_xaxes(title_text="along rolling [mm]", row=3)
    return figure


def states_of(shown: list[dict[str, Any]]) -> list[int]:
    """Numbers of the elements' states that a figure of these patches tells apart.

    The third is that of a layer that yields, which few scenes have.
    """
    yields = any(g["element_division"] is not None and 3 in g["element_division"] for g in shown)
    return [0, 1, 2, 3] if yields else [0, 1, 2]


def most_loaded(patches: list[dict[str, Any]]) -> dict[str, Any] | None:
    """The patch with the largest sum of pressure times element area, or None."""
    return max(patches, key=load_of, default=None)


def load_of(grid: dict[str, Any]) -> float:
    """N, sum of pressure times element area."""
    x, y = grid["x"], grid["y"]
    area = (np.ptp(x) / max(1, x.shape[1] - 1)) * (np.ptp(y) / max(1, x.shape[0] - 1))
    return float(grid["pressure"].sum() * area)


def regular(grid: dict[str, Any]) -> dict[str, Any]:
    """The fields on one axis for x and one for y, in mm and MPa.

    Rows that have their own x positions are interpolated onto common ones.
    """
    x, y = 1e3 * grid["x"], 1e3 * grid["y"]
    pressure, division = 1e-6 * grid["pressure"], grid["element_division"]
    traction = None if grid["traction"] is None else 1e-6 * grid["traction"]
    temperature = grid.get("temperature")
    axis = x[0]
    if not np.allclose(x, axis):
        axis = np.linspace(x.min(), x.max(), 2 * x.shape[1])
        pressure = _onto(axis, x, pressure)
        if traction is not None:
            traction = np.stack([_onto(axis, x, traction[..., k]) for k in (0, 1)], axis=-1)
        if division is not None:
            nearest = [abs(axis[:, None] - row).argmin(axis=1) for row in x]
            division = np.stack([row[n] for row, n in zip(division, nearest, strict=True)])
            division[pressure <= 0] = 0
        if temperature is not None:
            temperature = _onto(axis, x, temperature)
    return {
        "x": axis,
        "y": y.mean(axis=1),
        "pressure": pressure,
        "traction": traction,
        "division": division,
        "temperature": temperature,
    }


def _onto(axis: np.ndarray, x: np.ndarray, values: np.ndarray) -> np.ndarray:
    rows = [np.interp(axis, *row, left=0.0, right=0.0) for row in zip(x, values, strict=True)]
    return np.stack(rows)


def _pressure(
    figure: go.Figure, grid: dict[str, Any], column: int, top: float, *, scale: bool
) -> None:
    shown = np.where(grid["pressure"] > 0, grid["pressure"], np.nan)
    figure.add_trace(
        go.Heatmap(
            x=grid["x"],
            y=grid["y"],
            z=shown,
            colorscale="Viridis",
            zmin=0,
            zmax=top,
            showscale=scale,
            colorbar=_bar("MPa", 0),
            hoverongaps=False,
            hovertemplate="x %{x:.2f}, y %{y:.2f} mm<br>pressure %{z:.0f} MPa<extra></extra>",
        ),
        row=1,
        col=column,
    )
    figure.add_trace(
        go.Contour(
            x=grid["x"],
            y=grid["y"],
            z=grid["pressure"],
            showscale=False,
            ncontours=8,
            contours={"coloring": "none"},
            line={"color": "rgba(255,255,255,0.6)"},
            hoverinfo="skip",
            showlegend=False,
        ),
        row=1,
        col=column,
    )


def _traction(figure: go.Figure, grid: dict[str, Any], column: int) -> None:
    if grid["traction"] is None:
        return
    size = np.hypot(grid["traction"][..., 0], grid["traction"][..., 1])
    figure.add_trace(
        go.Heatmap(
            x=grid["x"],
            y=grid["y"],
            z=np.where(size > 0, size, np.nan),
            colorscale="Cividis",
            coloraxis="coloraxis",
            hoverongaps=False,
            hovertemplate="x %{x:.2f}, y %{y:.2f} mm<br>traction %{z:.0f} MPa<extra></extra>",
        ),
        row=2,
        col=column,
    )
    figure.update_layout(coloraxis={"colorscale": "Cividis", "colorbar": _bar("MPa", 1)})
    if size.max() <= 0:
        return
    rows = slice(None, None, -(-size.shape[0] // _ARROWS))
    columns = slice(None, None, -(-size.shape[1] // _ARROWS))
    reach = 1.6 * max(_step(grid["x"][columns]), _step(grid["y"][rows])) / size.max()
    x, y = np.meshgrid(grid["x"][columns], grid["y"][rows])
    arrows = reach * grid["traction"][rows, columns]
    shown = size[rows, columns] > 0
    _arrows(figure, x[shown], y[shown], arrows[shown], column)


def _arrows(
    figure: go.Figure, x: np.ndarray, y: np.ndarray, arrows: np.ndarray, column: int
) -> None:
    ends_x, ends_y = x + arrows[:, 0], y + arrows[:, 1]
    gap = np.full(len(x), np.nan)
    figure.add_trace(
        go.Scatter(
            x=np.column_stack([x, ends_x, gap]).ravel(),
            y=np.column_stack([y, ends_y, gap]).ravel(),
            mode="lines",
            line={"color": "#f4f4f4", "width": 1.2},
            hoverinfo="skip",
            showlegend=False,
        ),
        row=2,
        col=column,
    )
    # plotly's marker angle turns clockwise from up
    angle = np.degrees(np.arctan2(arrows[:, 0], arrows[:, 1]))
    figure.add_trace(
        go.Scatter(
            x=ends_x,
            y=ends_y,
            mode="markers",
            hoverinfo="skip",
            showlegend=False,
            marker={"symbol": "triangle-up", "size": 5, "angle": angle, "color": "#f4f4f4"},
        ),
        row=2,
        col=column,
    )


def _division(figure: go.Figure, grid: dict[str, Any], column: int) -> None:
    if grid["division"] is None:
        return
    count = len(ELEMENT_STATES)
    steps = [
        [edge, color]
        for code, color in enumerate(STATE_COLORS)
        for edge in (code / count, (code + 1) / count)
    ]
    names = np.array(ELEMENT_STATES)[grid["division"]]
    figure.add_trace(
        go.Heatmap(
            x=grid["x"],
            y=grid["y"],
            z=grid["division"],
            zmin=-0.5,
            zmax=count - 0.5,
            colorscale=steps,
            showscale=False,
            text=names,
            xgap=0.5,
            ygap=0.5,
            hovertemplate="x %{x:.2f}, y %{y:.2f} mm<br>%{text}<extra></extra>",
        ),
        row=3,
        col=column,
    )


def _step(axis: np.ndarray) -> float:
    return float(np.ptp(axis) / max(1, len(axis) - 1))


def _bar(title: str, row: int) -> dict[str, Any]:
    return {"title": {"text": title}, "len": 0.27, "y": 0.86 - 0.36 * row, "thickness": 14}
