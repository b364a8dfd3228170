"""Figures of a vehicle's run, over the distance."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import plotly.graph_objects as go
from plotly.subplots import make_subplots

from railpatch.case.types import SIDES
from railpatch.page.figures import BAD, COLORS, GREY, LINES, styled
from railpatch.report.data import scaled
from railpatch.report.figures import Adder
from railpatch.report.vehicle import limits
from railpatch.report.vehicle.data import VehicleRun, Wheel


def _color(number: int) -> str:
    return LINES[(number - 1) % len(LINES)]


def beside_limits(data: VehicleRun) -> go.Figure:
    """Percentiles, where the run found them, and greatest values of every wheel beside their
    limits, before any course."""
    figure = make_subplots(2, 2, horizontal_spacing=0.12, vertical_spacing=0.14)
    wheels, numbers = list(data.contact), list(data.wheelsets)
    # short: eight of them stand below a narrow panel
    names = [f"{number}{side[0].upper()}" for number, side in wheels]
    panels = (
        (
            "Y/Q outward",
            names,
            [limits.ratio_spread(data, w) for w in wheels],
            1.0,
            [limits.RATIO],
        ),
        (
            "|sum of Y| [kN]",
            [str(n) for n in numbers],
            [limits.sum_spread(data, n) for n in numbers],
            1e-3,
            [limits.sum_limit(data, n) for n in numbers],
        ),
        (
            "Q [kN]",
            names,
            [limits.load_spread(data, w) for w in wheels],
            1e-3,
            [limits.load_limit(data, w[0]) for w in wheels],
        ),
        ("Y outward [kN]", names, [limits.guiding_spread(data, w) for w in wheels], 1e-3, []),
    )
    for place, (title, at, found, factor, most) in enumerate(panels):
        row, column = divmod(place, 2)
        _percentiles(figure, at, found, factor, most, (row + 1, column + 1))
        figure.update_yaxes(title_text=title, rangemode="tozero", row=row + 1, col=column + 1)
        title = "wheelset" if found is panels[1][2] else "wheelset, left or right wheel"
        figure.update_xaxes(title_text=title, type="category", row=row + 1, col=column + 1)
    return styled(figure, 680)


def _percentiles(
    figure: go.Figure,
    at: list[str],
    found: list[limits.Spread],
    factor: float,
    most: list[float],
    place: tuple[int, int],
) -> None:
    """One panel: greatest values, percentiles and their limit where there are any."""
    first = place == (1, 1)
    for name, values, symbol, color in (
        ("greatest", [s.most for s in found], "line-ew-open", GREY),
        ("99.85 %", [s.percentile for s in found], "circle", COLORS["left"]),
    ):
        if not np.isfinite(values).any():
            continue
        figure.add_trace(
            go.Scatter(
                x=at,
                y=[factor * v for v in values],
                name=name,
                legendgroup=name,
                showlegend=first,
                mode="markers",
                marker={"symbol": symbol, "size": 11, "color": color}
                | ({"line": {"width": 2, "color": color}} if "line" in symbol else {}),
            ),
            row=place[0],
            col=place[1],
        )
    if most:
        line = most * len(at) if len(most) == 1 else most
        figure.add_trace(
            go.Scatter(
                x=at,
                y=[factor * v for v in line],
                name="limit of EN 14363",
                legendgroup="limit",
                showlegend=first,
                mode="lines",
                line={"color": BAD, "dash": "dash", "width": 2},
            ),
            row=place[0],
            col=place[1],
        )


def track(data: VehicleRun) -> go.Figure:
    """Curvature and cant under the vehicle."""
    figure = make_subplots(1, 2, horizontal_spacing=0.12)
    for column, (name, text) in enumerate({"curvature": "curvature", "cant": "cant"}.items(), 1):
        factor, label = scaled("/vehicle/state", name, text)
        add = Adder(figure, data, 1, column)
        add.line(data.along, factor * data.state[name], text, GREY, legend=False)
        figure.update_yaxes(title_text=label, row=1, col=column)
    figure.update_xaxes(title_text=data.along_label)
    return styled(figure, 300)


def loads(data: VehicleRun) -> go.Figure:
    """Wheel loads Q, averaged over 2 m."""
    return _sides(data, "Q [kN]", lambda wheel: 1e-3 * data.mean_loads[wheel])


def ratios(data: VehicleRun) -> go.Figure:
    """Y/Q, averaged over 2 m."""
    return _sides(data, "Y/Q", data.ratio)


def friction(data: VehicleRun) -> go.Figure:
    """Energy lost at each wheel."""
    return _sides(data, "lost in friction [kJ]", lambda wheel: 1e-3 * data.friction_work(wheel))


def driven(data: VehicleRun) -> list[int]:
    """Numbers of wheelsets with motors or brakes."""
    return [
        number
        for number, series in data.wheelsets.items()
        if any(message.get("drive_torque") is not None for message in series.messages)
    ]


def drives(data: VehicleRun) -> go.Figure:
    """Torque on each driven wheelset and its slip speed."""
    figure = make_subplots(2, 1, shared_xaxes=True, vertical_spacing=0.06)
    names = (("drive_torque", 1e-3, "torque [kN m]"), ("slip_speed", 1.0, "slip speed [m/s]"))
    for row, (name, factor, label) in enumerate(names, start=1):
        for number in driven(data):
            line = factor * data.wheelsets[number][name]
            Adder(figure, data, row, 1).line(data.along, line, f"wheelset {number}", _color(number))
        figure.update_yaxes(title_text=label, row=row, col=1)
    figure.update_xaxes(title_text=data.along_label, row=2)
    return styled(figure, 560)


def bulk_temperatures(data: VehicleRun) -> go.Figure:
    """Of the wheels; rails, which are always new, have the temperature that the case gives."""
    title = "bulk temperature [°C]"
    return _sides(data, title, lambda wheel: data.contact[wheel]["wheel_temperature"])


def _sides(data: VehicleRun, title: str, values: Callable[[Wheel], np.ndarray]) -> go.Figure:
    """Left wheels beside right ones, one line for each wheelset."""
    figure = make_subplots(
        1,
        2,
        shared_yaxes=True,
        horizontal_spacing=0.05,
        subplot_titles=("left wheels", "right wheels"),
    )
    for column, side in enumerate(SIDES, start=1):
        for number in data.wheelsets:
            line = values((number, side))
            name = f"wheelset {number}"
            Adder(figure, data, 1, column).line(data.along, line, name, _color(number))
    figure.update_yaxes(title_text=title, row=1, col=1)
    figure.update_xaxes(title_text=data.along_label)
    return styled(figure, 400)


def positions(data: VehicleRun) -> go.Figure:
    """Lateral position and yaw angle of each wheelset on its track."""
    figure = make_subplots(2, 1, shared_xaxes=True, vertical_spacing=0.06)
    for row, (name, text) in enumerate({"y": "y", "yaw": "yaw"}.items(), start=1):
        factor, label = scaled("/wheelset/1/state", name, text)
        for number, series in data.wheelsets.items():
            line = factor * series[name]
            Adder(figure, data, row, 1).line(data.along, line, f"wheelset {number}", _color(number))
        figure.update_yaxes(title_text=label, row=row, col=1)
    figure.update_xaxes(title_text=data.along_label, row=2)
    return styled(figure, 560)


def accelerations(data: VehicleRun) -> go.Figure:
    """Lateral and vertical accelerations of the bodies in their own axes, wheelsets left out."""
    figure = make_subplots(2, 1, shared_xaxes=True, vertical_spacing=0.06)
    for index, name in enumerate(data.body_names()):
        if name.startswith("wheelset_"):
            continue
        values = data.bodies[f"bodies[{index}].acceleration"]
        if values.ndim != 2:
            continue
        for row, axis in enumerate((1, 2), start=1):
            text = name.replace("_", " ")
            Adder(figure, data, row, 1).line(data.along, values[:, axis], text, _color(index + 1))
    for row, axis in enumerate(("lateral", "vertical"), start=1):
        figure.update_yaxes(title_text=f"{axis} [m/s²]", row=row, col=1)
    figure.update_xaxes(title_text=data.along_label, row=2)
    return styled(figure, 560)


def work(data: VehicleRun) -> go.Figure:
    """Wall time of a second simulated, and contacts solved."""
    figure = make_subplots(1, 2, horizontal_spacing=0.12)
    spent = data.stats["wall_time"][1:] / np.diff(data.times)
    solved = data.stats["contact_evaluations"]
    add = Adder(figure, data, 1, 1)
    add.line(data.along[1:], spent, "wall time", GREY, legend=False, mark=False)
    Adder(figure, data, 1, 2).line(data.along, solved, "contacts", GREY, legend=False)
    figure.update_yaxes(title_text="wall time of a second [s]", rangemode="tozero", row=1, col=1)
    figure.update_yaxes(title_text="contacts solved", rangemode="tozero", row=1, col=2)
    figure.update_xaxes(title_text=data.along_label)
    return styled(figure, 340)
