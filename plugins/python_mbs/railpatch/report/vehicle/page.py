"""The report page of a vehicle's run."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from html import escape
from typing import Any

import numpy as np

from railpatch.case.types import SIDES
from railpatch.page import tables
from railpatch.page.figures import plot
from railpatch.page.parts import BAD, folded, opening
from railpatch.report import balance_figures, quantities, worn
from railpatch.report.data import has_bulk
from railpatch.report.patch_views import over_distance
from railpatch.report.scene import friction_of, scene_of
from railpatch.report.tables import identity
from railpatch.report.vehicle import assessed, below_rails, limits
from railpatch.report.vehicle import figures as vehicle_figures
from railpatch.report.vehicle.data import VehicleRun, snapshot
from railpatch.report.warnings import warnings


def body(
    data: VehicleRun, at: float | None, laid: str = "", other: VehicleRun | None = None
) -> str:
    """All sections. at: m, the distance whose patches are shown first; laid: HTML of what is laid
    over the run; other: the run whose patches are laid over its own."""
    bad = int((~data.solved).sum())
    keys = limits.key_numbers(data)
    verdict, state = limits.verdict(data, keys)
    if bad:
        verdict, state = f"{bad} of {data.count} steps did not converge. {verdict}", BAD
    head = [
        opening("Vehicle on track", about(data), verdict, keys, state),
        *warnings(data.run, f"{data.count} steps", bad, data.count, "steps"),
        unsolved(data),
        f"<h2>Forces and accelerations beside their limits</h2><p>On the rail, {data.averaging}. "
        f"{signs(data)} {escape(nadal_line(data))}</p>",
        plot(vehicle_figures.beside_limits(data), "limits"),
        tables.table(limits.head(data), limits.rows(data)),
        folded("What is held against the standard", f"<p>{escape(STANDARD)}</p>", on_paper=True),
        *assessed.section(data),
        "<h2>Wheels</h2><p class=sub>Greatest and least values on the way; y is the wheelset's "
        "place across the track.</p>",
        tables.table(*wheels(data)),
    ]
    return "".join(
        [*head, laid, *_sections(data), *_patches(data, at, other), *_administration(data)]
    )


STANDARD = (
    "Limits are those of EN 14363:2016: Y/Q 0.8; sum of Y by Prud'homme, 10 kN and a third of the "
    "static axle load, times the scene's run.shift_factor; Q 90 kN above the static wheel load and "
    "at most 160 to 200 kN by speed; "
    "unloading 60 % of the static load; root mean squares of passenger vehicles' accelerations, "
    "0.5 m/s² lateral and 0.75 m/s² vertical. Static loads are those "
    "at rest on level rails, the mean of the run in logs that have none. The standard "
    "takes percentiles of 99.85 % in many sections of track and estimates from these; here the "
    "whole run is one section, and a run without percentiles, whose greatest values stand beside "
    "the limits, is not assessed. It measures accelerations on the floor and filters them; here "
    "they are those of a body's centre, about their mean, as logged."
)


def about(data: VehicleRun) -> str:
    """Scene, speed, curve, theory."""
    parts = [str(data.run.metadata["railpatch"].get("scene", ""))]
    parts += [text if name == "speed" else f"{name} {text}" for name, text in course(data)]
    friction, _ = friction_of(data.run)
    if np.isfinite(friction):
        parts.append(f"friction coefficient {tables.short(friction)}")
    parts.append(str(data.run.metadata["railpatch"].get("theory", "")))
    return ", ".join(filter(None, parts))


def signs(data: VehicleRun) -> str:
    """What the columns are of, the same in all of them."""
    shown = "Percentiles and greatest values" if limits.counted(data) else "Greatest values"
    return (
        f"{shown} of each quantity by itself, not of one moment: of Y and of Y/Q outward, below 0 "
        "where the wheel never pressed outward; of a wheelset's sum of Y by size, either way."
    )


def nadal_line(data: VehicleRun) -> str:
    """Nadal's limit beside that of the standard."""
    limit, angle, friction = limits.nadal(data)
    if not np.isfinite(limit):
        return ""
    return (
        f"Nadal's limit of Y/Q is {tables.short(limit)} with the steepest flank of this wheel, "
        f"{np.degrees(angle):.0f} degrees, and friction {tables.short(friction)}."
    )


def summary(data: VehicleRun) -> list[tuple[str, str]]:
    """What the run was, and how it went."""
    n = tables.number
    rows = [(str(a), str(b)) for a, b in identity(data.run)]
    good = int(data.solved.sum())
    rows += [
        ("steps", f"{data.count} logged, of which {good} converged"),
        ("time", f"{n(data.times[0])} to {n(data.times[-1])} s"),
        ("distance", f"{n(data.along[0])} to {n(data.along[-1])} m"),
    ]
    rows += [*course(data), *_comfort(data)]
    if len(data.run["/solver/stats"]) and data.times[-1] > data.times[0]:
        total = float(np.nansum(data.stats["wall_time"]))
        share = total / (data.times[-1] - data.times[0])
        rows.append(("wall time", f"{n(total)} s, {n(share)} s a second simulated"))
    return rows


def course(data: VehicleRun) -> list[tuple[str, str]]:
    """Speed and the sharpest curve that its wheelsets came into."""
    n, state, rows = tables.number, data.state, []
    speed = state["speed"][np.isfinite(state["speed"])]
    if speed.size:
        low, high = n(speed.min()), n(speed.max())
        both = high if low == high else f"{low} to {high}"
        rows.append(("speed", f"{both} m/s ({n(3.6 * speed.max())} km/h)"))
    curves = [np.abs(series["curvature"]) for series in (*data.wheelsets.values(), state)]
    known = np.concatenate([curve[np.isfinite(curve)] for curve in curves])
    if known.size and known.max() > 0:
        rows.append(("least radius run on", radius_text(1 / float(known.max()), data)))
    return rows


def radius_text(run_on: float, data: VehicleRun) -> str:
    """run_on: m. With the scene's least radius where the run did not come to it."""
    text, least = f"{tables.short(run_on)} m", least_radius(data)
    if least > 0.999 * run_on:
        return text
    return f"{text} (the scene's arc of {tables.short(least)} m was not reached)"


def least_radius(data: VehicleRun) -> float:
    """m, of the arcs in the scene's alignment; infinite where there is none."""
    table = scene_of(data.run).get("alignment") or {}
    arcs = [one.get("radius") for one in (table, *(table.get("section") or ()))]
    return min((abs(float(radius)) for radius in arcs if radius), default=np.inf)


def _comfort(data: VehicleRun) -> list[tuple[str, str]]:
    """Of the first body."""
    name, (lateral, vertical) = limits.ride(data)
    if not name:
        return []
    text = f"{tables.number(lateral)} lateral, {tables.number(vertical)} vertical"
    return [(f"{name}, m/s² (standard deviation)", text)]


def wheels(data: VehicleRun) -> tuple[Sequence[str], list[list[object]]]:
    """Head and rows of the table of all wheels."""
    head = ["wheelset", "wheel", "Q least [kN]", "Q most [kN]", "Y/Q outward most", "|y| most [mm]"]
    head += [
        *quantities.HEAD,
        "lost in friction [kJ]",
        "patches",
        "without contact",
        "not converged",
    ]
    rows = []
    for number in data.wheelsets:
        lateral = 1e3 * float(np.nanmax(np.abs(data.wheelsets[number]["y"])))
        for side in SIDES:
            wheel = number, side
            load = (
                1e-3 * limits.least_load(data, wheel),
                1e-3 * limits.load_spread(data, wheel).most,
            )
            status = data.statuses[wheel]
            bad = ~np.isin(status, ("converged", "no_contact"))
            patches = max(len(m["patches"]) for m in data.contact[wheel].messages)
            row: list[object] = [number, side, *map(tables.number, load)]
            row += [tables.number(limits.ratio_spread(data, wheel).most), tables.number(lateral)]
            row += quantities.greatest(data.contact[wheel])
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
        *quantities.vehicle_section(data),
        "<h2>Wheelsets on the track</h2>",
        plot(figures.positions(data), "positions"),
    ]
    if figures.driven(data):
        parts += [
            "<h2>Traction</h2><p>Torque of motors or brakes, &gt; 0 pulls, and slip speed: rolling "
            "at the nominal radius less the vehicle's speed.</p>",
            plot(figures.drives(data), "traction"),
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
    parts += worn.sections(data.run)
    parts += below_rails.section(data)
    if len(data.run["/vehicle/energy"]):
        parts += ["<h2>Energies</h2>", plot(balance_figures.energy(data), "energy")]
    return parts


def _administration(data: VehicleRun) -> list[str]:
    """Of files and solver, folded."""
    parts = [
        folded(
            "The run: scene, theory, profiles, files", tables.table((), summary(data), "summary")
        )
    ]
    if len(data.run["/solver/stats"]) and data.count > 1:
        parts.append(folded("Work of the solver", plot(vehicle_figures.work(data), "work")))
    return parts


def _first_bodies(data: VehicleRun) -> list[dict[str, Any]]:
    return next((m["bodies"] for m in data.bodies.messages if m), [])


def _patches(data: VehicleRun, at: float | None, other: VehicleRun | None) -> list[str]:
    """Of the wheels of the wheelsets whose fields were logged."""
    parts: list[str] = []
    for number in data.wheelsets:
        chosen = snapshot(data, number, at)
        if chosen is None:
            continue
        index = chosen["index"]
        viewer = over_distance(data, number, index, partial(where, data), other)
        title = f"Wheelset {number}, patches, first at {tables.number(data.along[index])} m"
        parts.append(folded(title, viewer, open_=not parts))
    return ["<h2>Contact patches, element by element</h2>", *parts] if parts else []


def where(data: VehicleRun, index: int) -> str:
    """A step, in words."""
    return f"Distance {tables.number(data.along[index])} m, {tables.number(data.times[index])} s"
