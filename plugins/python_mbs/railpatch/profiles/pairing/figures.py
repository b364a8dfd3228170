"""Figures of a profile and of a pair of profiles."""

from __future__ import annotations

import numpy as np
import plotly.graph_objects as go
from plotly.subplots import make_subplots

from railpatch.page.figures import COLORS, GREY, styled
from railpatch.profiles.curve import Profile
from railpatch.profiles.pairing.contact_points import ContactPoints
from railpatch.profiles.pairing.pressures import Pressures
from railpatch.profiles.shape import Array, Shape

_LINE = COLORS["left"]
_MARK = COLORS["right"]


def shape_figure(shape: Shape, points: tuple[Array, Array] | None = None) -> go.Figure:
    """Depth, slope and curvature over y, with the kinks marked. points: y, z of a file, m."""
    figure = make_subplots(3, 1, shared_xaxes=True, vertical_spacing=0.05)
    if points is not None:
        figure.add_scatter(
            x=1e3 * points[0], y=1e3 * points[1], mode="markers", name="points of the file",
            marker={"color": GREY, "size": 3}, row=1, col=1,
        )  # fmt: skip
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


def residual_figure(y: Array, residual: Array) -> go.Figure:
    """How far the points of the file lie below the curve, m, over y, m."""
    figure = go.Figure(
        go.Scatter(x=1e3 * y, y=1e6 * residual, mode="markers", marker={"color": _LINE, "size": 3})
    )
    figure.update_xaxes(title_text="y on the profile [mm]")
    figure.update_yaxes(title_text="point below the curve [um]")
    return styled(figure, 320)


def pair_figure(points: ContactPoints, wheel: Profile, rail: Profile) -> go.Figure:
    """The right wheel lifted off its rail, and where they touch as the wheelset moves: for each
    lateral position a line from the place on the wheel to that on the rail."""
    figure = go.Figure()
    top = float(np.min(rail.z))
    beside = (rail.y < rail.y[np.argmin(rail.z)]) & (rail.z - top <= points.dimensions.gauge_height)
    # from the track's centre line to the rail profile's y = 0
    rail_at = 0.5 * points.dimensions.gauge - float(rail.y[beside].min())
    lift = float(np.max(wheel.z)) + 5e-3
    curves = (
        ("wheel", wheel.y + points.dimensions.marker, wheel.z - lift, "left"),
        ("rail", rail.y + rail_at, rail.z - top, "right"),
    )
    for y in np.arange(-8e-3, 8.1e-3, 1e-3):
        i = int(np.argmin(np.abs(points.y - y)))
        if not np.isfinite(points.position[i]):
            continue
        on_wheel, on_rail = points.on_wheel[i], points.position[i] - rail_at
        figure.add_scatter(
            x=1e3 * np.array([on_wheel + points.dimensions.marker, points.position[i]]),
            y=1e3 * np.array([height(wheel, on_wheel) - lift, height(rail, on_rail) - top]),
            mode="lines", line={"color": GREY, "width": 1}, showlegend=False,
            name=f"wheelset at {1e3 * points.y[i]:+.0f} mm",
        )  # fmt: skip
    for name, y, z, colour in curves:
        figure.add_scatter(
            x=1e3 * y, y=1e3 * z, mode="lines", line={"color": COLORS[colour]}, name=name
        )
    figure.update_xaxes(title_text="from the track's centre line [mm]")
    figure.update_yaxes(title_text="down, the wheel lifted [mm]", autorange="reversed",
                        scaleanchor="x")  # fmt: skip
    return styled(figure, 520)


def height(profile: Profile, y: float) -> float:
    """m, z of the profile at y, the highest of a rail, the lowest of a wheel; linear."""
    order = np.argsort(profile.y)
    return float(np.interp(y, profile.y[order], profile.z[order]))


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


def pressure_figure(found: Pressures) -> go.Figure:
    """Greatest pressure over lateral position, between what 95 % of its errors stay below."""
    y, pressure, error = 1e3 * found.y, 1e-6 * found.pressure, np.nan_to_num(found.error)
    figure = go.Figure()
    if error.any():
        for factor, fill in ((1 + error, None), (1 - error, "tonexty")):
            figure.add_scatter(
                x=y, y=pressure * factor, mode="lines", line={"color": GREY, "width": 0.5},
                fill=fill, name="of 95 % of cases", showlegend=fill is not None,
            )  # fmt: skip
    figure.add_scatter(x=y, y=pressure, mode="lines", line={"color": _LINE}, name="pressure")
    figure.update_xaxes(title_text="wheelset's lateral position [mm]")
    figure.update_yaxes(title_text="greatest pressure [MPa]")
    return styled(figure, 430)


def single(x: Array, y: Array, x_title: str, y_title: str) -> go.Figure:
    """One line in one panel."""
    figure = go.Figure(go.Scatter(x=x, y=y, mode="lines", line={"color": _LINE}))
    figure.update_xaxes(title_text=x_title)
    figure.update_yaxes(title_text=y_title)
    return styled(figure, 430)
