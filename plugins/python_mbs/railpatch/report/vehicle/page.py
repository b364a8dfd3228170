"""The report page of a vehicle's run."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape
from typing import Any

import numpy as np

from railpatch.case.types import SIDES
from railpatch.page import tables
from railpatch.page.figures import plot
from railpatch.page.patch_figure import patch_figure
from railpatch.report import balance_figures
from railpatch.report.data import has_bulk
from railpatch.report.tables import identity
from railpatch.report.vehicle import figures as vehicle_figures
from railpatch.report.vehicle.data import VehicleRun, snapshot
from railpatch.report.warnings import warnings


def body(data: VehicleRun, at: float | None) -> str:
    """Head and sections. at: m, the distance whose patches are shown."""
    scene = escape(data.run.metadata["railpatch"].get("scene", ""))
    bad = int((~data.solved).sum())
    head = [
        f"<h1>Run of the vehicle</h1><p class=sub>{scene}</p>",
        *warnings(data.run, f"{data.count} steps", bad, data.count, "steps"),
        tables.table((), summary(data), "summary"),
        unsolved(data),
        f"<h2>Wheels</h2><p>Y and Q on the rail, Y outward, {data.averaging}.</p>",
        tables.table(*wheels(data)),
    ]
    return "".join([*head, *_sections(data), *_patches(data, at)])


def summary(data: VehicleRun) -> list[tuple[str, str]]:
    """What the run was, and how it went."""
    n, state = tables.number, data.state
    rows = [(str(a), str(b)) for a, b in identity(data.run)]
    good = int(data.solved.sum())
    rows += [
        ("steps", f"{data.count} logged, of which {good} converged"),
        ("time", f"{n(data.times[0])} to {n(data.times[-1])} s"),
        ("distance", f"{n(data.along[0])} to {n(data.along[-1])} m"),
    ]
    speed = state["speed"][np.isfinite(state["speed"])]
    if speed.size:
        low, high = speed.min(), speed.max()
        rows.append(("speed", f"{n(low)} to {n(high)} m/s ({n(3.6 * high)} km/h)"))
    curved = np.abs(state["curvature"])
    if np.isfinite(curved).any() and np.nanmax(curved) > 0:
        rows.append(("least radius", f"{n(1 / np.nanmax(curved))} m"))
    rows += _comfort(data)
    if len(data.run["/solver/stats"]) and data.times[-1] > data.times[0]:
        total = float(np.nansum(data.stats["wall_time"]))
        share = total / (data.times[-1] - data.times[0])
        rows.append(("wall time", f"{n(total)} s, {n(share)} s a second simulated"))
    return rows


def _comfort(data: VehicleRun) -> list[tuple[str, str]]:
    """Of the first body."""
    values = data.bodies["bodies[0].acceleration"] if data.body_names() else np.empty(0)
    if values.ndim != 2:
        return []
    name = data.body_names()[0].replace("_", " ")
    lateral, vertical = (float(np.nanstd(values[:, axis])) for axis in (1, 2))
    text = f"{tables.number(lateral)} lateral, {tables.number(vertical)} vertical"
    return [(f"{name}, m/s² (standard deviation)", text)]


def wheels(data: VehicleRun) -> tuple[Sequence[str], list[list[object]]]:
    """Head and rows of the table of all wheels."""
    head = ["wheelset", "wheel", "Q least [kN]", "Q most [kN]", "Y/Q most", "y most [mm]"]
    head += ["lost in friction [kJ]", "patches", "without contact", "not converged"]
    rows = []
    for number in data.wheelsets:
        lateral = 1e3 * float(np.nanmax(np.abs(data.wheelsets[number]["y"])))
        for side in SIDES:
            wheel = number, side
            load = 1e-3 * data.mean_loads[wheel]
            status = data.statuses[wheel]
            bad = ~np.isin(status, ("converged", "no_contact"))
            patches = max(len(m["patches"]) for m in data.contact[wheel].messages)
            row: list[object] = [number, side, *map(tables.number, (load.min(), load.max()))]
            row += [tables.number(_greatest(data.ratio(wheel))), tables.number(lateral)]
            row.append(tables.number(1e-3 * data.friction_work(wheel)[-1]))
            rows.append([*row, patches, int((status == "no_contact").sum()), int(bad.sum())])
    return head, rows


def unsolved(data: VehicleRun) -> str:
    """Steps that did not converge; empty where there is none."""
    bad = np.flatnonzero(~data.solved)
    if not bad.size:
        return ""
    rows = [
        [int(index), tables.number(data.times[index]), tables.number(data.along[index])]
        + [data.statuses[wheel][index] for wheel in data.contact]
        for index in bad[:50]
    ]
    head = ["step", "time [s]", "distance [m]"]
    return tables.table([*head, *(f"{number} {side}" for number, side in data.contact)], rows)


def _greatest(values: np.ndarray) -> float:
    known = values[np.isfinite(values)]
    return float(known.max()) if known.size else float("nan")


def _sections(data: VehicleRun) -> list[str]:
    figures = vehicle_figures
    parts = ["<h2>Track</h2>", plot(figures.track(data), "track")]
    parts += [
        f"<h2>Wheel loads</h2><p>On the rail, {data.averaging}.</p>",
        plot(figures.loads(data), "loads"),
    ]
    parts += [
        f"<h2>Y/Q</h2><p>On the rail, outward &gt; 0, {data.averaging}.</p>",
        plot(figures.ratios(data), "ratios"),
        "<h2>Wheelsets on the track</h2>",
        plot(figures.positions(data), "positions"),
    ]
    if any("acceleration" in b and b["acceleration"] for b in _first_bodies(data)):
        parts += [
            "<h2>Accelerations</h2><p>Of the bodies' centres, in the bodies' axes.</p>",
            plot(figures.accelerations(data), "accelerations"),
        ]
    if any(np.isfinite(data.friction_work(wheel)).any() for wheel in data.contact):
        parts += ["<h2>Friction</h2>", plot(figures.friction(data), "friction")]
    if any(has_bulk(contact) for contact in data.contact.values()):
        parts += [
            "<h2>Bulk temperatures of the wheels</h2>",
            plot(figures.bulk_temperatures(data), "bulk-temperatures"),
        ]
    if len(data.run["/vehicle/energy"]):
        parts += ["<h2>Energies</h2>", plot(balance_figures.energy(data), "energy")]
    if len(data.run["/solver/stats"]) and data.count > 1:
        parts += ["<h2>Time</h2>", plot(figures.work(data), "work")]
    return parts


def _first_bodies(data: VehicleRun) -> list[dict[str, Any]]:
    return next((m["bodies"] for m in data.bodies.messages if m), [])


def _patches(data: VehicleRun, at: float | None) -> list[str]:
    """One patch of each wheel of the wheelsets whose fields were logged."""
    parts = []
    for number in data.wheelsets:
        chosen = snapshot(data, number, at)
        if chosen is None:
            continue
        where = tables.number(data.along[chosen["index"]])
        parts.append(
            f"<details{' open' if not parts else ''}><summary>wheelset {number}, patches at "
            f"{where} m</summary>{plot(patch_figure(chosen), f'patch-{number}')}</details>"
        )
    return ["<h2>Patches</h2>", *parts] if parts else []
