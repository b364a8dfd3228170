"""Figures of a run: traction curves, forces, position, patches, work of the solver."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np
import plotly.graph_objects as go
from plotly.subplots import make_subplots

from railpatch.case.types import SIDES
from railpatch.page.figures import BAD, COLORS, GREY, OTHER, styled
from railpatch.report.beside import Beside
from railpatch.report.data import Positions, scaled
from railpatch.report.reference import Match

if TYPE_CHECKING:
    from railpatch.report.vehicle.data import VehicleRun

_REFERENCE = {"left": "triangle-left-open", "right": "triangle-right-open"}
_MANY = 2000  # points of a line; longer runs are thinned for the page


def traction_curves(
    data: Positions, matches: list[Match], measured: Beside | None = None
) -> go.Figure:
    """Lateral over vertical force against yaw, one panel for each wheel. measured: points beside
    them."""
    figure = make_subplots(
        1,
        2,
        shared_yaxes=True,
        horizontal_spacing=0.05,
        subplot_titles=("left wheel", "right wheel"),
    )
    factor, label = scaled("/wheelset/state", "yaw", "yaw")
    yaw = factor * data.state["yaw"]
    for column, side in enumerate(SIDES, start=1):
        add = Adder(figure, data, 1, column)
        if measured is not None:
            add.measured(side, measured, factor)
        add.line(yaw, data.ratio[side], side, COLORS[side])
        add.reference(
            side, matches, lambda m: factor * m.row.yaw, lambda m: m.row.force[1] / m.row.force[2]
        )
        figure.update_xaxes(title_text=label, row=1, col=column)
    figure.update_yaxes(title_text="L/V = F<sub>y</sub>/F<sub>z</sub>", row=1, col=1)
    return styled(figure, 490)


def forces(data: Positions, matches: list[Match]) -> go.Figure:
    """Forces on the roller or rail, over the run and over yaw; one row for each component."""
    figure = make_subplots(
        3, 2, shared_yaxes=True, shared_xaxes=True, horizontal_spacing=0.04, vertical_spacing=0.05
    )
    yaw_factor, yaw_label = scaled("/wheelset/state", "yaw", "yaw")
    factor, unit_label = scaled("/left/contact", "force", "")
    yaw = yaw_factor * data.state["yaw"]
    for axis, name in enumerate("xyz"):
        for side in SIDES:
            values = -factor * data.force[side][:, axis]
            for column, abscissa in ((1, data.along), (2, yaw)):
                add = Adder(figure, data, axis + 1, column)
                add.line(abscissa, values, side, COLORS[side])
                add.reference(
                    side,
                    matches,
                    lambda m, c=column: data.along[m.index] if c == 1 else yaw[m.index],
                    lambda m, a=axis: factor * m.row.force[a],
                )
        figure.update_yaxes(title_text=f"F<sub>{name}</sub>{unit_label}", row=axis + 1, col=1)
    figure.update_xaxes(title_text=data.along_label, row=3, col=1)
    figure.update_xaxes(title_text=yaw_label, row=3, col=2)
    return styled(figure, 760)


def wheelset_position(data: Positions, matches: list[Match]) -> go.Figure:
    """Load transfer, lateral and vertical position, yaw, roll and pitch rate over the run."""
    figure = make_subplots(3, 2, shared_xaxes=True, horizontal_spacing=0.12, vertical_spacing=0.06)
    load = {side: -data.force[side][:, 2] for side in SIDES}
    with np.errstate(divide="ignore", invalid="ignore"):
        share = 100 * load["left"] / (load["left"] + load["right"])
    Adder(figure, data, 1, 1).line(data.along, share, "left wheel's load", GREY, legend=False)
    figure.update_yaxes(title_text="left wheel's load [%]", row=1, col=1)
    names = {"yaw": "yaw", "y": "y", "z": "z", "roll": "roll", "pitch_rate": "pitch rate"}
    places = [(1, 2), (2, 1), (2, 2), (3, 1), (3, 2)]
    for (name, text), (row, column) in zip(names.items(), places, strict=True):
        factor, label = scaled("/wheelset/state", name, text)
        add = Adder(figure, data, row, column)
        add.line(data.along, factor * data.state[name], text, GREY, legend=False)
        if name in ("z", "roll", "pitch_rate"):
            add.reference(
                "left",
                matches,
                lambda m: data.along[m.index],
                lambda m, n=name, f=factor: f * getattr(m.row, n),
                GREY,
            )
        figure.update_yaxes(title_text=label, row=row, col=column)
    figure.update_xaxes(title_text=data.along_label, row=3)
    return styled(figure, 720)


def patches(data: Positions) -> go.Figure:
    """Number, lateral position, contact angle and normal force of every patch over the run."""
    figure = make_subplots(2, 2, shared_xaxes=True, horizontal_spacing=0.12, vertical_spacing=0.07)
    panels = {"position": (1, 1), "contact_angle": (1, 2), "normal_force": (2, 1)}
    labels = {
        "position": "lateral distance",
        "contact_angle": "contact angle",
        "normal_force": "normal force",
    }
    for name, (row, column) in panels.items():
        factor, label = scaled("/left/contact", f"patches[].{name}", labels[name])
        for side in SIDES:
            index, values = _of_patches(data, side, name)
            if name == "position":
                # both wheels on one scale
                values = values * (1 if side == "right" else -1)
            Adder(figure, data, row, column).dots(
                data.along[index], factor * values, side, COLORS[side]
            )
        figure.update_yaxes(title_text=label, row=row, col=column)
    for side in SIDES:
        Adder(figure, data, 2, 2).line(
            data.along, data.patch_count(side), side, COLORS[side], shape="hv"
        )
    figure.update_yaxes(title_text="patches", dtick=1, rangemode="tozero", row=2, col=2)
    figure.update_xaxes(title_text=data.along_label, row=2)
    return styled(figure, 560)


def contact_work(data: Positions) -> go.Figure:
    """Wall time of the contact problems over the run, and iterations where the log has them."""
    counts = {
        (side, kind): data.stats[f"{side}_{kind}_iterations"]
        for side in SIDES
        for kind in ("normal", "tangential")
    }
    counted = any(np.isfinite(count).any() for count in counts.values())
    figure = make_subplots(1, 2 if counted else 1, horizontal_spacing=0.12)
    for name, side in (("in all", None), *((f"{side} wheel", side) for side in SIDES)):
        values = data.stats[f"{side}_wall_time" if side else "wall_time"]
        color = COLORS[side] if side else GREY
        Adder(figure, data, 1, 1).line(data.along, values, name, color)
    for (side, kind), count in counts.items():
        if counted:
            dash = "dot" if kind == "normal" else "dash"
            name = f"{side}, {kind}"
            Adder(figure, data, 1, 2).line(data.along, count, name, COLORS[side], dash=dash)
    figure.update_yaxes(rangemode="tozero")
    figure.update_yaxes(title_text="wall time [s]", col=1)
    if counted:
        figure.update_yaxes(title_text="iterations", col=2)
    figure.update_xaxes(title_text=data.along_label)
    return styled(figure, 360)


def balance_work(data: Positions) -> go.Figure:
    """Evaluations, iterations and residuals of the force balance over the run."""
    figure = make_subplots(1, 2, horizontal_spacing=0.12)
    for name, color in (("evaluations", "#4f9163"), ("iterations", "#9467bd")):
        Adder(figure, data, 1, 1).line(data.along, data.balance[name], name, color)
    residuals = data.balance["residuals"]
    if residuals.ndim == 2:
        colors = {
            "axle moment [N m]": "#b5651d",
            "vertical force [N]": "#17879c",
            "roll moment [N m]": "#c2528b",
        }
        for column, (name, color) in enumerate(colors.items()):
            Adder(figure, data, 1, 2).line(data.along, abs(residuals[:, column]), name, color)
    figure.update_yaxes(title_text="Broyden's method", rangemode="tozero", col=1)
    figure.update_yaxes(
        title_text="|residual|", type="log", exponentformat="power", dtick=_ticks(residuals), col=2
    )
    figure.update_xaxes(title_text=data.along_label)
    return styled(figure, 360)


def _ticks(values: np.ndarray) -> str | int:
    """Of a logarithmic axis: 1, 2 and 5, or powers of ten as far apart as they need."""
    sizes = np.abs(values[np.isfinite(values) & (values != 0)])
    decades = float(np.ptp(np.log10(sizes))) if sizes.size else 0.0
    return "D2" if decades < 2 else int(np.ceil(decades / 6))


def bulk_temperatures(data: Positions) -> go.Figure:
    """Of wheels and rails or rollers over the run."""
    figure = make_subplots(1, 1)
    add = Adder(figure, data, 1, 1)
    for side in SIDES:
        for body, name, dash in (("wheel", "wheel", "solid"), ("rail", data.counterpart, "dash")):
            values = data.contact[side][f"{body}_temperature"]
            add.line(data.along, values, f"{side} {name}", COLORS[side], dash=dash)
    figure.update_yaxes(title_text="bulk temperature [°C]")
    figure.update_xaxes(title_text=data.along_label)
    return styled(figure, 360)


def _of_patches(data: Positions, side: str, name: str) -> tuple[np.ndarray, np.ndarray]:
    """Position index and value of every patch; of ``position`` the lateral part."""
    index, values = [], []
    for number, message in enumerate(data.contact[side].messages):
        for patch in message["patches"]:
            value = patch[name]
            if name == "position":
                value = value[1] if value else None
            if value is not None:
                index.append(number)
                values.append(value)
    return np.array(index, dtype=int), np.array(values, dtype=float)


class Adder:
    """Adds traces to one panel; each name enters the legend once."""

    def __init__(
        self, figure: go.Figure, data: Positions | VehicleRun, row: int, column: int
    ) -> None:
        self.figure, self.data = figure, data
        self.place = {"row": row, "col": column}

    def line(
        self,
        x: np.ndarray,
        y: np.ndarray,
        name: str,
        color: str,
        *,
        legend: bool = True,
        dash: str = "solid",
        shape: str = "linear",
        mark: bool = True,
    ) -> None:
        """A curve through the positions, with those marked that did not converge."""
        if not np.isfinite(y).any():
            return
        step = -(-len(x) // _MANY)
        few = len(x) <= 100
        self._trace(
            x[::step],
            y[::step],
            name,
            name,
            legend,
            mode="lines+markers" if few else "lines",
            marker={"color": color, "size": 5},
            line={"color": color, "width": 1.6, "dash": dash, "shape": shape},
            text=[f"position {i}" for i in range(0, len(x), step)],
        )
        bad = ~self.data.solved
        if mark and bad.any():
            self._trace(
                x[bad],
                y[bad],
                "not converged",
                "bad",
                True,
                mode="markers",
                marker={"color": BAD, "size": 11, "symbol": "x"},
                text=[f"position {i}" for i in np.flatnonzero(bad)],
            )

    def measured(self, side: str, beside: Beside, factor: float) -> None:
        """L/V as it was measured, over the run's yaw angle."""
        pair = beside.ratios().get(side)
        if pair is None or beside.at is None or beside.yaw is None:
            return
        known = np.isfinite(beside.at) & np.isfinite(beside.yaw)
        yaw = factor * np.interp(pair.other_at, beside.at[known], beside.yaw[known])
        step = -(-len(yaw) // _MANY)
        self._trace(
            yaw[::step],
            pair.other[::step],
            beside.what,
            beside.what,
            True,
            mode="markers",
            marker={"color": OTHER, "size": 5, "symbol": "circle-open"},
            text=None,
        )

    def dots(self, x: np.ndarray, y: np.ndarray, name: str, color: str) -> None:
        """Single values."""
        step = -(-len(x) // _MANY) or 1
        self._trace(
            x[::step],
            y[::step],
            name,
            name,
            True,
            mode="markers",
            marker={"color": color, "size": 6},
            text=None,
        )

    def reference(
        self,
        side: str,
        matches: Iterable[Match],
        x: object,
        y: object,
        color: str = "",
    ) -> None:
        """The reference's values of one side."""
        own = [m for m in matches if m.row.side == side]
        if own:
            self._trace(
                [x(m) for m in own],
                [y(m) for m in own],  # type: ignore[operator]
                f"reference {side}" if not color else "reference",
                f"reference {side}",
                True,
                mode="markers",
                text=[f"position {m.index}" for m in own],
                marker={
                    "color": color or COLORS[side],
                    "size": 11,
                    "symbol": _REFERENCE[side] if not color else "circle-open",
                    "line": {"width": 2},
                },
            )

    def _trace(
        self, x: object, y: object, name: str, group: str, legend: bool, **more: object
    ) -> None:
        shown = {t.legendgroup for t in self.figure.data if t.showlegend}
        self.figure.add_trace(
            go.Scatter(
                x=x,
                y=y,
                name=name,
                legendgroup=group,
                hovertemplate=(f"%{{text}}<br>%{{x:.4g}}, %{{y:.5g}}<extra>{name}</extra>"),
                showlegend=legend and group not in shown,
                **more,
            ),
            **self.place,
        )
