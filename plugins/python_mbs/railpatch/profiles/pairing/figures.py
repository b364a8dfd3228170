"""Figures of a profile and of a pair of profiles."""

from __future__ import annotations

import numpy as np
import plotly.graph_objects as go
from plotly.subplots import make_subplots

from railpatch.page.figures import COLORS, styled
from railpatch.profiles.pairing.contact_points import ContactPoints
from railpatch.profiles.shape import Array, Shape

_LINE = COLORS["left"]
_MARK = COLORS["right"]


def shape_figure(shape: Shape) -> go.Figure:
    """Depth, slope and curvature over y, with the kinks marked."""
    figure = make_subplots(3, 1, shared_xaxes=True, vertical_spacing=0.05)
    rows = {
        "z, down [mm]": 1e3 * shape.z,
        "slope [deg]": np.degrees(shape.slope),
        "curvature [1/m]": shape.curvature,
    }
    y = 1e3 * shape.y
    for row, (title, values) in enumerate(rows.items(), start=1):
        figure.add_scatter(
            x=y, y=values, mode="lines", line={"color": _LINE}, name="profile",
            showlegend=False, row=row, col=1,
        )  # fmt: skip
        for name, at, symbol in (
            ("step of the curvature", shape.steps, "circle-open"),
            ("corner", shape.corners, "x"),
        ):
            if at.size:
                figure.add_scatter(
                    x=y[at], y=values[at], mode="markers", name=name, showlegend=row == 1,
                    marker={"color": _MARK, "symbol": symbol, "size": 8}, row=row, col=1,
                )  # fmt: skip
        figure.update_yaxes(title_text=title, row=row, col=1)
    figure.update_yaxes(autorange="reversed", row=1, col=1)
    figure.update_xaxes(title_text="y on the profile [mm]", row=3, col=1)
    return styled(figure, 900)


def contact_figure(points: ContactPoints) -> go.Figure:
    """Where the right wheel touches its rail, over the wheelset's lateral position."""
    figure = make_subplots(3, 1, shared_xaxes=True, vertical_spacing=0.05)
    y = 1e3 * points.y
    rows = {
        "y on the wheel [mm]": 1e3 * points.on_wheel,
        "y from the gauge [mm]": 1e3 * (points.position - 0.5 * points.dimensions.gauge),
        "contact angle [deg]": np.degrees(points.contact_angle),
    }
    for row, (title, values) in enumerate(rows.items(), start=1):
        # dots: a line would bridge the jumps from one place of contact to another
        figure.add_scatter(
            x=y, y=values, mode="markers", marker={"color": _LINE, "size": 3}, showlegend=False,
            row=row, col=1,
        )  # fmt: skip
        figure.update_yaxes(title_text=title, row=row, col=1)
    figure.update_xaxes(title_text="wheelset's lateral position [mm]", row=3, col=1)
    return styled(figure, 760)


def difference_figure(points: ContactPoints) -> go.Figure:
    """Rolling radius of the right wheel minus that of the left one."""
    return single(
        1e3 * points.y,
        1e3 * points.rolling_radius_difference,
        "wheelset's lateral position [mm]",
        "rolling radius difference [mm]",
    )


def conicity_figure(amplitude: Array, conicity: Array) -> go.Figure:
    """Equivalent conicity over amplitude."""
    return single(1e3 * amplitude, conicity, "amplitude [mm]", "equivalent conicity [-]")


def single(x: Array, y: Array, x_title: str, y_title: str) -> go.Figure:
    """One line in one panel."""
    figure = go.Figure(go.Scatter(x=x, y=y, mode="lines", line={"color": _LINE}))
    figure.update_xaxes(title_text=x_title)
    figure.update_yaxes(title_text=y_title)
    return styled(figure, 430)
