"""The track below the rails, of a vehicle's run that has one."""

from __future__ import annotations

import numpy as np
import plotly.graph_objects as go
from plotly.subplots import make_subplots

from railpatch.case.types import SIDES
from railpatch.page import tables
from railpatch.page.figures import LINES, plot, styled
from railpatch.report.data import at_times
from railpatch.report.figures import Adder
from railpatch.report.vehicle.data import VehicleRun


def section(data: VehicleRun) -> list[str]:
    """HTML; nothing where the run is on rigid ground."""
    forces = {number: _forces(data, number) for number in data.wheelsets}
    if not any(len(found) for found in forces.values()):
        return []
    text = (
        "Deflection of the rails under each wheelset, outward of both sides and down, and the "
        "rails' forces on their pads, of springs and dampers: of logged steps, whose peaks may lie "
        "between them."
    )
    return [
        f"<h2>Track below the rails</h2><p>{text}</p>",
        plot(figure(data, forces), "below-rails"),
        tables.table(HEAD, rows(data, forces)),
    ]


HEAD = (
    *("wheel", "rail down most [mm]", "rail outward most [mm]"),
    *("pad vertical most [kN]", "pad outward most [kN]", "ballast vertical most [kN]"),
)


def _forces(data: VehicleRun, number: int) -> dict[tuple[str, str], np.ndarray]:
    """N, [n, 2], by side and place ("pad", "ballast"), outward and down."""
    series = data.run[f"/wheelset/{number}/support"]
    if not len(series):
        return {}
    found, at = {}, at_times(series, data.times)
    for side in SIDES:
        for place in ("pad", "ballast"):
            values = at[f"{side}_{place}_force"]
            if values.ndim == 2:
                found[side, place] = values * _outward(side)
    return found


def _outward(side: str) -> np.ndarray:
    return np.array([-1.0 if side == "left" else 1.0, 1.0])


def _deflection(data: VehicleRun, number: int, side: str) -> np.ndarray:
    """m, [n, 2], outward and down."""
    return data.contact[number, side]["rail_deflection"] * _outward(side)


def figure(data: VehicleRun, forces: dict[int, dict[tuple[str, str], np.ndarray]]) -> go.Figure:
    """Rails' vertical deflection and pads' vertical force, left beside right."""
    shown = make_subplots(
        2,
        2,
        shared_xaxes=True,
        shared_yaxes=True,
        horizontal_spacing=0.05,
        vertical_spacing=0.06,
        subplot_titles=("left rail", "right rail", "", ""),
    )
    for column, side in enumerate(SIDES, start=1):
        for number in data.wheelsets:
            color, name = LINES[(number - 1) % len(LINES)], f"wheelset {number}"
            down = 1e3 * _deflection(data, number, side)[:, 1]
            Adder(shown, data, 1, column).line(data.along, down, name, color)
            pad = 1e-3 * forces[number][side, "pad"][:, 1]
            Adder(shown, data, 2, column).line(data.along, pad, name, color)
    shown.update_yaxes(title_text="rail down [mm]", row=1, col=1)
    shown.update_yaxes(title_text="force on the pad [kN]", row=2, col=1)
    shown.update_xaxes(title_text=data.along_label, row=2)
    return styled(shown, 560)


def rows(
    data: VehicleRun, forces: dict[int, dict[tuple[str, str], np.ndarray]]
) -> list[list[object]]:
    """Of every wheel, the greatest."""
    found = []
    for number in data.wheelsets:
        for side in SIDES:
            moved, pad = _deflection(data, number, side), forces[number][side, "pad"]
            ballast = forces[number].get((side, "ballast"))
            below = "-" if ballast is None else _most(1e-3 * ballast[:, 1])
            found.append(
                [
                    f"{number} {side}",
                    *(_most(1e3 * moved[:, axis]) for axis in (1, 0)),
                    *(_most(1e-3 * pad[:, axis]) for axis in (1, 0)),
                    below,
                ]
            )
    return found


def _most(values: np.ndarray) -> str:
    return tables.number(np.nanmax(values))
