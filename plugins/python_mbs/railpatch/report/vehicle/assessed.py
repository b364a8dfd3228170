"""Percentiles as EN 14363 counts them and comfort as EN 12299 does, of a vehicle's run that has
them in its log."""

from __future__ import annotations

from typing import Any

import numpy as np
import plotly.graph_objects as go
from plotly.subplots import make_subplots

from railpatch.case.types import SIDES
from railpatch.page import tables
from railpatch.page.figures import LINES, plot, styled
from railpatch.report.vehicle.data import VehicleRun
from railpatch.report.vehicle.limits import LEAST_RATE, LEAST_WAY, counted, sum_limit, way_of

AXES = ("longitudinal", "lateral", "vertical")
# of EN 12299's five minutes in blocks of 5 s
WANTED = 60
PERCENTILES = (
    "Of the whole run as one section: forces as means over 2 m, these and accelerations behind a "
    "low pass of 20 Hz, at every 0.5 m ({places} places); percentiles of 99.85 %, Y outward, of a "
    "wheelset's sum of Y the greater of 0.15 and 99.85 %. Stated from memory of EN 14363:2016."
)
COMFORT = (
    "At points of the scene: accelerations weighted by Wd and Wb, root mean squares of 5 s, 95 % "
    "of {blocks} blocks{few}; N_MV is 6 times the length of the three. Up to 1.5 very comfortable, "
    "2.5 comfortable, 3.5 medium, 4.5 uncomfortable. Stated from memory of EN 12299:2009."
)


def section(data: VehicleRun) -> list[str]:
    """HTML; why there are none where the log has no percentiles."""
    found = data.assessment
    return [*(percentiles(data, found) or missing(data)), *comfort(data, found)]


def missing(data: VehicleRun) -> list[str]:
    """That the numbers above are no percentiles in the standard's sense, and what those ask for."""
    way = way_of(data)
    return [
        "<p><b>No percentiles as EN 14363 counts them.</b> They ask for "
        f"{LEAST_WAY:g} m of way and steps kept at {LEAST_RATE:g} Hz or more while the run is "
        f"computed (run.step, run.log_every); this log is of {tables.short(way)} m.</p>"
    ]


def percentiles(data: VehicleRun, found: dict[str, Any]) -> list[str]:
    """Of forces and accelerations."""
    if not counted(data):
        return []
    text = PERCENTILES.format(places=found["places"])
    lateral, vertical = (tables.short(value) for value in found["acceleration"])
    felt = (
        f"The body of reference: {lateral} m/s² lateral, {vertical} m/s² vertical, of its centre."
    )
    head = (
        *("wheel", "Y/Q outward 99.85 %", "limit", "Q 99.85 % [kN]", "Q 50 % [kN]"),
        *("|sum of Y| [kN]", "limit [kN]"),
    )
    return [
        f"<h2>Percentiles as EN 14363 counts them</h2><p>{text} {felt}</p>",
        tables.table(head, rows(data, found)),
    ]


def rows(data: VehicleRun, found: dict[str, Any]) -> list[list[object]]:
    """By wheel; the sum of Y is that of its wheelset."""
    told: list[list[object]] = []
    for place, number in enumerate(data.wheelsets):
        for k, side in enumerate(SIDES):
            wheel = 2 * place + k
            shift = tables.short(1e-3 * found["shift"][place])
            told.append(
                [
                    f"{number} {side}",
                    tables.short(found["derailment"][wheel]),
                    tables.short(found["derailment_limit"]),
                    tables.short(1e-3 * found["load"][wheel]),
                    tables.short(1e-3 * found["median_load"][wheel]),
                    shift,
                    tables.short(1e-3 * sum_limit(data, number)),
                ]
            )
    return told


def comfort(data: VehicleRun, found: dict[str, Any]) -> list[str]:
    """Table of the points and their continuous comfort."""
    points = found.get("comfort") or []
    if not points:
        return []
    blocks = found["comfort_blocks"]
    few = "" if blocks >= WANTED else f" of the {WANTED} that the standard takes"
    head = ("point", "N_MV", *(f"{axis} [m/s²]" for axis in AXES))
    told = [
        [point["name"], *(tables.short(point[key]) for key in ("mean_comfort", *AXES))]
        for point in points
    ]
    return [
        f"<h2>Ride comfort</h2><p>{COMFORT.format(blocks=blocks, few=few)}</p>",
        tables.table(head, told),
        plot(continuous(data), "comfort"),
    ]


def continuous(data: VehicleRun) -> go.Figure:
    """Root mean squares of 5 s over the time at which they end."""
    series = data.run["/vehicle/comfort"]
    shown = make_subplots(1, 3, horizontal_spacing=0.07, subplot_titles=AXES)
    names = [point["name"] for point in series.messages[0]["points"]]
    for index, name in enumerate(names):
        for column, axis in enumerate(AXES, start=1):
            values = np.array([m["points"][index][axis] for m in series.messages])
            shown.add_trace(
                go.Scatter(
                    x=series.time,
                    y=values,
                    name=name,
                    legendgroup=name,
                    showlegend=column == 1,
                    mode="lines+markers",
                    line={"color": LINES[index % len(LINES)], "width": 1.5},
                ),
                row=1,
                col=column,
            )
    shown.update_yaxes(title_text="continuous comfort [m/s²]", rangemode="tozero", row=1, col=1)
    shown.update_xaxes(title_text="time [s]")
    return styled(shown, 360)
