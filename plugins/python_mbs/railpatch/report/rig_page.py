"""The report's part on a roller rig whose frame yields or whose friction conditions."""

from __future__ import annotations

import numpy as np
import plotly.graph_objects as go
from plotly.subplots import make_subplots

from railpatch.case.types import SIDES
from railpatch.log.reader import Series
from railpatch.page.figures import COLORS, GREY, plot, styled
from railpatch.page.tables import number, table
from railpatch.report.data import Positions, scaled
from railpatch.report.figures import Adder

FRAME = "/rig/frame"
_WORKS = {
    "work of the actuators": ("actuator_work", "#3b7dc4"),
    "work of the contacts": ("contact_work", "#5f9e6e"),
    "stored in springs": ("energy", "#e0812b"),
    "heat of dry friction": ("heat", "#c2528b"),
}


def sections(data: Positions) -> list[str]:
    """Of what the log has of both."""
    parts = []
    frame = of_positions(data, FRAME)
    if len(frame):
        parts += [
            "<h2>Frame</h2><p>Between the lateral actuators and the wheelset, and between the "
            "rollers. A loop of force and deflection is dry friction; works count from the first "
            "position.</p>",
            frame_table(frame),
            plot(frame_figure(data, frame), "frame"),
        ]
    bands = {side: of_positions(data, f"/{side}/conditioning") for side in SIDES}
    if all(map(len, bands.values())):
        parts += [
            "<h2>Friction that conditions</h2><p>Factor of the scene's friction law, and how far "
            "the strips of the running bands were conditioned when their fields were last "
            "logged.</p>",
            conditioning_table(bands),
            plot(conditioning_figure(data, bands), "conditioning"),
        ]
    return parts


def of_positions(data: Positions, topic: str) -> Series:
    """The messages of whole positions: those that are not balanced have none."""
    series = data.run[topic]
    own = np.isin(series.time, data.state.time)
    return Series(
        series.time[own], [m for m, kept in zip(series.messages, own, strict=True) if kept]
    )


def along(data: Positions, series: Series) -> np.ndarray:
    """The abscissa of plots over the run."""
    return data.along[np.searchsorted(data.state.time, series.time)]


def frame_table(frame: Series) -> str:
    """Deflections, forces and the frame's energies."""
    deflection, opening = 1e3 * frame["deflection"], 1e3 * frame["gauge_opening"]
    rows = [
        ("deflection", f"{_least(deflection)} to {_most(deflection)} mm"),
        ("lateral force on the wheelset", f"{_spread(frame['force'])} kN"),
        ("gauge opens by", f"{_least(opening)} to {_most(opening)} mm"),
        ("force that spreads the rollers", f"{_spread(frame['gauge_force'])} kN"),
    ]
    rows += [
        (f"{name}, at the end", f"{number(frame[field][-1])} J")
        for name, (field, _) in _WORKS.items()
    ]
    open_part = open_energy(frame)
    rows.append(("open in the balance of energies, most", f"{number(open_part)} J"))
    return table((), rows, "summary")


def open_energy(frame: Series) -> float:
    """J, most that works since the first position, energy and heat leave open."""
    left = frame["actuator_work"] + frame["contact_work"] - frame["heat"] - frame["energy"]
    return float(np.abs(left - left[0]).max())


def frame_figure(data: Positions, frame: Series) -> go.Figure:
    """Deflections over their forces and over the run, works over the run."""
    figure = make_subplots(1, 3, horizontal_spacing=0.09)
    place = along(data, frame)
    millimetres, _ = scaled(FRAME, "deflection", "")
    deflection, opening = millimetres * frame["deflection"], millimetres * frame["gauge_opening"]
    pairs = (("wheelset", deflection, -frame["force"]), ("gauge", opening, frame["gauge_force"]))
    for (name, moved, force), color in zip(pairs, (GREY, "#17879c"), strict=True):
        if np.max(np.abs(moved)) > 0:
            Adder(figure, data, 1, 1).line(moved, 1e-3 * force, name, color, mark=False)
            Adder(figure, data, 1, 2).line(place, moved, name, color, mark=False)
    for name, (field, color) in _WORKS.items():
        Adder(figure, data, 1, 3).line(place, frame[field], name, color, mark=False)
    figure.update_xaxes(title_text="deflection, opening [mm]", col=1)
    figure.update_yaxes(title_text="force [kN]", col=1)
    figure.update_yaxes(title_text="deflection, opening [mm]", col=2)
    figure.update_yaxes(title_text="energy, work [J]", col=3)
    for column in (2, 3):
        figure.update_xaxes(title_text=data.along_label, col=column)
    return styled(figure, 380)


def conditioning_table(bands: dict[str, Series]) -> str:
    """Factors, powers and works of both wheels."""
    head = ("wheel", "factor at the end", "least", "greatest", "most power [W]", "work [J]")
    rows = []
    for side, band in bands.items():
        factor = band["factor"]
        row = (factor[-1], factor.min(), factor.max(), band["power"].max(), band["work"][-1])
        rows.append([side, *map(number, row)])
    return table(head, rows)


def conditioning_figure(data: Positions, bands: dict[str, Series]) -> go.Figure:
    """The factor over the run, and the strips when they were last logged."""
    figure = make_subplots(1, 2, horizontal_spacing=0.12)
    for side, band in bands.items():
        factors = Adder(figure, data, 1, 1)
        factors.line(along(data, band), band["factor"], side, COLORS[side], mark=False)
        logged = [message for message in band.messages if message.get("position")]
        if logged:
            outwards = 1e3 * np.abs(np.array(logged[-1]["position"]))
            strips = np.array(logged[-1]["conditioned"])
            add = Adder(figure, data, 1, 2)
            add.line(outwards, strips, side, COLORS[side], shape="hvh", mark=False)
    figure.update_yaxes(title_text="factor of friction", col=1)
    figure.update_yaxes(title_text="conditioned", range=[0, 1.02], col=2)
    figure.update_xaxes(title_text=data.along_label, col=1)
    figure.update_xaxes(title_text="distance from the middle [mm]", col=2)
    return styled(figure, 360)


def _least(values: np.ndarray) -> str:
    return number(float(np.min(values)))


def _most(values: np.ndarray) -> str:
    return number(float(np.max(values)))


def _spread(newtons: np.ndarray) -> str:
    return f"{_least(1e-3 * newtons)} to {_most(1e-3 * newtons)}"
