"""Figures of stresses below the surface."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import plotly.graph_objects as go
from plotly.subplots import make_subplots

from railpatch.page.figures import styled

COLORS = ("#3b7dc4", "#e0812b", "#8a919c")


def sections(found: Mapping[str, Any]) -> go.Figure:
    """Von Mises stress in the two planes through the point where it is greatest."""
    values = 1e-6 * found["von_mises"]
    _, row, column = np.unravel_index(values.argmax(), values.shape)
    x, y, depth = 1e3 * found["x"], 1e3 * found["y"], 1e3 * found["depth"]
    planes = [(x, values[:, row, :], f"along rolling, y = {y[row]:.2f} mm", "x")]
    if len(y) > 1:
        planes.append((y, values[:, :, column], f"across, x = {x[column]:.2f} mm", "y"))
    figure = make_subplots(
        1, len(planes), subplot_titles=[title for _, _, title, _ in planes], shared_yaxes=True
    )
    for k, (along, plane, _, name) in enumerate(planes, start=1):
        figure.add_trace(
            go.Heatmap(
                x=along, y=depth, z=plane, zmin=0.0, zmax=values.max(), colorscale="Viridis",
                zsmooth="best",
                showscale=k == len(planes), colorbar={"title": "MPa"},
                hovertemplate=f"{name} %{{x:.2f}} mm, depth %{{y:.2f}} mm<br>von Mises stress "
                "%{z:.1f} MPa<extra></extra>",
            ),
            row=1, col=k,
        )  # fmt: skip
        figure.update_xaxes(title_text=f"{name} [mm]", row=1, col=k)
        figure.update_yaxes(autorange="reversed", row=1, col=k)
    styled(figure, 420)
    figure.update_layout(modebar={"orientation": "h"})
    figure.update_yaxes(title_text="depth [mm]", row=1, col=1)
    return figure


def over_depth(table: Mapping[str, Any], measures: Mapping[str, str]) -> go.Figure:
    """The greatest of each measure over the depth."""
    figure = go.Figure()
    for color, (name, words) in zip(COLORS, measures.items(), strict=True):
        figure.add_trace(
            go.Scatter(
                x=1e-6 * table[name], y=1e3 * table["depth"], name=words, mode="lines+markers",
                line={"color": color}, marker={"size": 5},
                hovertemplate=f"{words} %{{x:.1f}} MPa at %{{y:.2f}} mm<extra></extra>",
            )
        )  # fmt: skip
    styled(figure, 420)
    figure.update_xaxes(title_text="greatest at the depth [MPa]", rangemode="tozero")
    figure.update_yaxes(title_text="depth [mm]", autorange="reversed")
    return figure
