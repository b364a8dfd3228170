"""Figures of runs in time: waves along the track, energies, momenta, hunting."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import plotly.graph_objects as go
from plotly.subplots import make_subplots

from railpatch.log.reader import Series
from railpatch.page.figures import BAD, COLORS, GREY, styled
from railpatch.report.data import Positions, scaled
from railpatch.report.figures import Adder

if TYPE_CHECKING:
    from railpatch.report.vehicle.data import VehicleRun

_AXES = {"x": "#3b7dc4", "y": "#cf6f17", "z": "#4f9163"}
_WORKS = {
    "friction": ("friction_work", "#c2528b"),
    "dampers": ("damping_work", "#4f9163"),
    "drive": ("drive_work", "#17879c"),
}
_OPEN = {
    "bodies and springs": ("mechanical_residual", "#b5651d"),
    "contacts": ("contact_residual", "#9467bd"),
}


def waves(data: Positions) -> go.Figure:
    """Lateral position and yaw angle over the distance."""
    figure = make_subplots(2, 1, shared_xaxes=True, vertical_spacing=0.06)
    along = data.state["x"]
    for row, (name, text) in enumerate({"y": "y", "yaw": "yaw"}.items(), start=1):
        scale, title = scaled("/wheelset/state", name, text)
        Adder(figure, data, row, 1).line(along, scale * data.state[name], text, GREY, legend=False)
        figure.update_yaxes(title_text=title, row=row, col=1)
    figure.update_xaxes(title_text="distance [m]", row=2)
    return styled(figure, 460)


def energy(data: Positions | VehicleRun) -> go.Figure:
    """Work done since the start, and what is open in the balance of energies."""
    figure = make_subplots(1, 2, horizontal_spacing=0.12)
    for column, lines in enumerate((_WORKS, _OPEN), start=1):
        for name, (field, color) in lines.items():
            Adder(figure, data, 1, column).line(data.along, data.energy[field], name, color)
    figure.update_yaxes(title_text="work [J]", col=1)
    figure.update_yaxes(title_text="open in the balance [J]", exponentformat="power", col=2)
    figure.update_xaxes(title_text=data.along_label)
    return styled(figure, 360)


def momentum(data: Positions) -> go.Figure:
    """What is open in the balances of momentum and of its moment."""
    figure = make_subplots(1, 2, horizontal_spacing=0.12)
    titles = {"residual": "momentum open [N s]", "turning_residual": "its moment open [N m s]"}
    for column, (field, title) in enumerate(titles.items(), start=1):
        values = data.momentum[field]
        for axis, (name, color) in enumerate(_AXES.items()):
            if values.ndim == 2:
                Adder(figure, data, 1, column).line(data.along, values[:, axis], name, color)
        figure.update_yaxes(title_text=title, exponentformat="power", row=1, col=column)
    figure.update_xaxes(title_text=data.along_label)
    return styled(figure, 360)


def momentum_errors(series: Series) -> tuple[float, float]:
    """Greatest parts open of momentum and of its moment, by those at the start; NaN without."""
    found = []
    for open_part, whole in (("residual", "momentum"), ("turning_residual", "turning")):
        missing, size = series[open_part], series[whole]
        known = missing.ndim == size.ndim == 2
        found.append(float(np.abs(missing).max() / np.abs(size[0]).max()) if known else np.nan)
    return found[0], found[1]


def root_locus(found: dict[str, Any]) -> go.Figure:
    """Frequency over growth of the slowest wave, a point for each speed; right of zero it grows."""
    modes = sorted(found["modes"], key=lambda mode: mode["speed"])
    known = [mode for mode in modes if mode.get("frequency")]
    figure = go.Figure()
    figure.add_trace(
        go.Scatter(
            x=[mode["growth"] for mode in known],
            y=[mode["frequency"] for mode in known],
            text=[f"{mode['speed']:.4g} m/s" for mode in known],
            name="eigenvalue",
            mode="lines+markers",
            marker={
                "size": 9,
                "color": [COLORS["right" if m["growth"] > 0 else "left"] for m in known],
            },
            line={"color": GREY},
            showlegend=False,
        )
    )
    critical = found["critical_speed"]
    if critical is not None:
        figure.add_trace(
            go.Scatter(
                x=[0.0],
                y=[found["frequency"]],
                text=[f"{critical:.4g} m/s"],
                name="critical speed",
                mode="markers+text",
                textposition="top left",
                marker={"size": 14, "symbol": "diamond-open", "color": BAD, "line": {"width": 2}},
                showlegend=False,
            )
        )
    figure.update_xaxes(title_text="growth [1/s]")
    figure.update_yaxes(title_text="frequency [Hz]")
    return styled(figure, 440)


def hunting(found: dict[str, Any]) -> go.Figure:
    """Growth and frequency of the slowest wave over the speed, from eigenvalues and from runs."""
    figure = make_subplots(1, 2, horizontal_spacing=0.12)
    modes = sorted(found["modes"], key=lambda mode: mode["speed"])
    for column, (field, title) in enumerate(
        {"growth": "growth [1/s]", "frequency": "frequency [Hz]"}.items(), start=1
    ):
        for rows, name, mode in (
            (modes, "eigenvalues", "lines+markers"),
            (found.get("runs") or [], "runs in time", "markers"),
        ):
            known = [row for row in rows if row.get(field) is not None]
            if not known:
                continue
            marker = {"size": 6} if name == "eigenvalues" else {"size": 10, "symbol": "x-thin-open"}
            figure.add_trace(
                go.Scatter(
                    x=[row["speed"] for row in known],
                    y=[row[field] for row in known],
                    name=name,
                    legendgroup=name,
                    showlegend=column == 1,
                    mode=mode,
                    marker={**marker, "color": GREY if mode != "markers" else BAD},
                ),
                row=1,
                col=column,
            )
        figure.update_yaxes(title_text=title, row=1, col=column)
    figure.update_xaxes(title_text="speed [m/s]")
    return styled(figure, 380)
