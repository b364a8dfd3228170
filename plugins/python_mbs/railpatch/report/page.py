"""The report page: one HTML file that needs no network."""

from __future__ import annotations

import json
from html import escape
from os import PathLike
from pathlib import Path
from typing import Any

from railpatch.case.types import SIDES
from railpatch.errors import CaseError
from railpatch.log.channels import ELEMENT_STATES, HUNTING
from railpatch.log.reader import Run, read_run
from railpatch.page.document import document
from railpatch.page.figures import plot
from railpatch.page.parts import folded
from railpatch.page.patch_figure import most_loaded, states_of
from railpatch.page.printing import write_page
from railpatch.page.tables import number, table, whole
from railpatch.report import (
    answers,
    balance_figures,
    figures,
    quantities,
    reference,
    rig_page,
    tables,
    worn,
)
from railpatch.report.beside import Beside, beside_log, beside_measured, beside_record
from railpatch.report.beside_page import section
from railpatch.report.data import Positions, positions, snapshot
from railpatch.report.patch_views import viewer_of
from railpatch.report.vehicle import page as vehicle_page
from railpatch.report.vehicle.data import vehicle_run
from railpatch.report.warnings import warnings


def write_report(
    run_path: str | PathLike[str],
    output: str | PathLike[str],
    reference_dir: str | PathLike[str] | None = None,
    at: float | None = None,
    *,
    columns: str | PathLike[str] | None = None,
    beside: str | PathLike[str] | None = None,
) -> Path:
    """Writes the report of a run log, also of one that was cut off; returns ``output``.

    ``reference_dir``: folder of another reference of the roller rig, see ``reference.find``; or any
    file of measurements, laid over the run. ``columns``: TOML file with a table [columns] that says
    what this file's columns are. ``beside``: another log, laid over the run. ``at``: the
    progress (without progress: the time in s; of a vehicle: the distance in m) whose patches are
    shown; by default those at the largest yaw angle, or guiding force.

    A name that ends in .pdf makes a PDF, by a browser.

    Raises RunFileError where ``run_path`` is not a run log, ReportError where it holds no position,
    ValueError where the reference cannot be read, OSError where a file cannot be read or written.
    BrowserError where a PDF cannot be made.
    Nothing is written then.
    """
    run = read_run(run_path)
    file = Path(reference_dir) if reference_dir is not None else None
    if file is not None and not file.is_dir():
        reference_dir = None
    else:
        file = None
    if columns is not None and file is None:
        raise CaseError("--columns: value is given, allowed with a file as --reference")
    besides = _besides(run, file, Path(columns) if columns is not None else None, beside)
    laid = _laid_over(besides)
    if "wheelsets" in run.metadata["railpatch"]:
        near = vehicle_run(read_run(beside)) if beside is not None else None
        body = vehicle_page.body(vehicle_run(run), at, "".join(laid), near)
    else:
        data = positions(run)
        matched = _reference(data, reference_dir) if reference_dir or not laid else ([], "")
        other = positions(read_run(beside)) if beside is not None else None
        # what L/V is compared with first
        measured = next((found for found in besides.values() if found.ratios()), None)
        body = "".join(
            [
                _opening(data, matched[0], measured),
                *_first_figure(data, *matched, measured),
                *laid,
                *_sections(data, matched, at, other, measured),
                *_administration(data),
            ]
        )
    page = document(run.metadata["railpatch"].get("scene", "run"), body + _ending(run))
    return write_page(output, page)


def _besides(
    run: Run, file: Path | None, columns: Path | None, beside: str | PathLike[str] | None
) -> dict[str, Beside]:
    """What the run's record has, another file, another log; by the name of its figure."""
    found = {}
    measured = beside_measured(run)
    if measured is not None:
        found["measured"] = measured
    if file is not None:
        found["beside-file"] = beside_record(run, file, columns)
    if beside is not None:
        found["beside-log"] = beside_log(run, beside)
    return found


def _laid_over(besides: dict[str, Beside]) -> list[str]:
    """The sections of these."""
    remark = "the record holds what drives the run alone."
    return [part for name, found in besides.items() for part in section(found, name, remark)]


def _opening(data: Positions, matches: list[reference.Match], measured: Beside | None) -> str:
    """Verdict and key numbers, what went wrong, and the figure that the run is about."""
    hunted = _hunted(data)
    if data.has_balance:
        parts = [answers.rig(data, matches, measured)]
    elif hunted is not None:
        parts = [answers.hunting(data, hunted)]
    else:
        parts = [answers.wheelset(data)]
    bad = int((~data.solved).sum())
    parts += warnings(data.run, f"{data.count} positions", bad, data.count, "positions")
    parts.append(tables.unsolved(data))
    return "".join(parts)


def _first_figure(
    data: Positions, matches: list[reference.Match], remark: str, measured: Beside | None
) -> list[str]:
    """What this kind of run is about."""
    hunted = _hunted(data)
    parts = []
    if hunted is not None:
        parts += hunting_section(hunted)
    if data.has_distance:
        parts += ["<h2>Along the track</h2>", plot(balance_figures.waves(data), "waves")]
    return [*parts, *([] if parts else _traction(data, matches, remark, measured))]


def _traction(
    data: Positions, matches: list[reference.Match], remark: str, measured: Beside | None
) -> list[str]:
    return [
        f"<h2>Traction curves</h2><p>Lateral over vertical force, in track axes: the same ratio "
        f"for wheel and {data.counterpart}. Negative where the {data.counterpart} pushes the wheel "
        "to the right. Yaw is the angle of attack.</p>",
        plot(figures.traction_curves(data, matches, measured), "traction"),
        remark,
    ]


def _hunted(data: Positions) -> dict[str, Any] | None:
    """What a search for the critical speed has found."""
    attached = data.run.attachments.get(HUNTING)
    return None if attached is None else json.loads(attached.data)


def _sections(
    data: Positions,
    matched: tuple[list[reference.Match], str],
    at: float | None,
    other: Positions | None,
    measured: Beside | None,
) -> list[str]:
    matches, remark = matched
    body = data.counterpart
    parts = _patch_section(data, at, other)
    if data.has_distance:
        parts += _traction(data, matches, remark, measured)
    parts += [
        f"<h2>Forces on the {body}</h2><p>In track axes: x forward, y right, z down. The log holds "
        f"forces on the wheel; these are their opposites.</p>",
        plot(figures.forces(data, matches), "forces"),
        *quantities.section(data),
        "<h2>Load transfer and position of the wheelset</h2>",
        plot(figures.wheelset_position(data, matches), "position"),
        *rig_page.sections(data),
        "<h2>Contact patches</h2><p>Each point is one patch. Distances count outwards from the "
        "track's centre line; a contact angle is positive at a left wheel's flange.</p>",
        plot(figures.patches(data), "patches"),
        *worn.sections(data.run),
    ]
    if data.has_bulk:
        parts += [
            f"<h2>Bulk temperatures</h2><p>Of wheels and {body}s, that their surfaces have before "
            "the contact warms them.</p>",
            plot(figures.bulk_temperatures(data), "bulk-temperatures"),
        ]
    if data.has_energy:
        parts += [
            "<h2>Energies</h2><p>Work since the start. Friction's is that of the creep forces on "
            "the creepages; the drive holds the suspension's reference at its speed.</p>",
            plot(balance_figures.energy(data), "energy"),
        ]
    if data.has_momentum:
        parts.append(_momentum(data))
    if matches:
        parts += [
            "<h2>Differences from the reference</h2><p>Run minus reference, forces on the "
            "roller, at the positions with the same yaw and lateral position.</p>",
            tables.reference_summary(matches, data),
            folded("Every matched position", tables.reference_rows(matches, data)),
        ]
    return parts


def _administration(data: Positions) -> list[str]:
    """Of files and solver, folded."""
    work = []
    if data.has_stats:
        work += ["<h2>Work of the contact solver</h2>"]
        work += [plot(figures.contact_work(data), "contact-work")]
    if data.has_balance:
        work += ["<h2>Work of the force balance</h2>"]
        work += [plot(figures.balance_work(data), "balance-work")]
    return [
        folded("The run: scene, theory, profiles, files", tables.summary(data), on_paper=True),
        folded("Work of the solver" if work else "", "".join(work)),
    ]


def hunting_section(found: dict[str, Any]) -> list[str]:
    """The search for the critical speed that the log carries."""
    speed = found["critical_speed"]
    below, away = found.get("critical_speed_below"), found.get("divergence")
    first = _speed(speed) if below is None else f"below {_speed(below)}: waves grow there"
    rows = [("critical speed, from eigenvalues", first)]
    if away is not None:
        growth = number(away["growth"])
        rows.append(("divergence, without waves", f"{growth} 1/s at {_speed(away['speed'])}"))
    if "critical_speed_in_time" in found:
        rows.append(("critical speed, from runs in time", _speed(found["critical_speed_in_time"])))
    if speed is not None:
        rows += [
            ("frequency there", f"{number(found['frequency'])} Hz"),
            ("wave length there", f"{number(found['wave_length'])} m"),
        ]
    rows.append(("this run", _speed(found["logged_speed"])))
    return [
        "<h2>Root locus</h2><p>The slowest wave of the equations of motion, linearised straight "
        "on: where its growth is above zero, the wheelset hunts.</p>",
        plot(balance_figures.root_locus(found), "locus"),
        plot(balance_figures.hunting(found), "hunting"),
        table((), rows, "summary"),
    ]


def _speed(value: float | None) -> str:
    return "none found" if value is None else f"{value:.2f} m/s ({3.6 * value:.1f} km/h)"


def _momentum(data: Positions) -> str:
    linear, turning = balance_figures.momentum_errors(data.momentum)
    return (
        "<h2>Momenta</h2><p>Open in the balances with the impulses of all forces: "
        f"{number(linear)} of the momentum at the start, {number(turning)} of its "
        f"moment about the centre.</p>{plot(balance_figures.momentum(data), 'momentum')}"
    )


def _patch_section(data: Positions, at: float | None, other: Positions | None) -> list[str]:
    chosen = snapshot(data, at)
    if chosen is None:
        return ["<h2>Contact patches, element by element</h2>"
                "<p>This log holds no fields of patches.</p>"]  # fmt: skip
    index = chosen["index"]
    yaw = number(1e3 * data.state["yaw"][index])
    where = f"position {index}, {data.along_text(number(data.along[index]))}, yaw {yaw} mrad"
    lines = [_patch_line(data, side, chosen) for side in SIDES]
    shown = [grid for side in SIDES if (grid := most_loaded(chosen[side]))]
    states = ", ".join(ELEMENT_STATES[number] for number in states_of(shown)[1:])
    over = f" Red outlines: {other.run.path.name}, nearest position." if other is not None else ""
    return [
        f"<h2>Contact patches, element by element</h2><p>Shown first: {escape(where)}. "
        f"{escape(' '.join(lines))} Arrows: traction on the wheel. Elements in contact are in one "
        f"of the states {states}. Rolling is towards +x.{escape(over)}</p>",
        viewer_of(data, index, other),
    ]


def _patch_line(data: Positions, side: str, chosen: dict) -> str:
    grid = most_loaded(chosen[side])
    if grid is None:
        return f"No fields of the {side} wheel here."
    patches = data.contact[side].messages[chosen["index"]]["patches"]
    force = patches[grid["patch"]]["normal_force"] if grid["patch"] < len(patches) else None
    newtons = "" if force is None else f", normal force {whole(force)} N"
    return f"{side.capitalize()}: patch {grid['patch'] + 1} of {len(patches)}{newtons}."


def _reference(
    data: Positions, directory: str | PathLike[str] | None
) -> tuple[list[reference.Match], str]:
    """The matched reference, and a sentence on it."""
    if not data.has_balance:
        return [], ""
    path = reference.find(directory)
    if path is None:
        return [], (f"<p>The reference ({reference.FILE}) is not in the folder that was named.</p>")
    matches = reference.match(reference.load(path), data)
    if not matches:
        return [], (
            f"<p>No position of this run is in the reference ({reference.FILE}): none has "
            "the same yaw and lateral position.</p>"
        )
    places = len({m.index for m in matches})
    return matches, (
        f"<p>Open triangles: the reference ({reference.FILE}), found for {places} of "
        f"{data.count} positions. {reference.ABOUT}</p>"
    )


def _ending(run: Run) -> str:
    """What the log holds."""
    scene = run.metadata["railpatch"].get("scene", "")
    case = run.attachments.get(scene)
    text = case.data.decode("utf-8", errors="replace") if case else ""
    parts = [folded("Case file", f"<pre>{escape(text)}</pre>")] if text else []
    parts.append(folded("The log: channels, fields, units, signs", tables.channels(run)))
    return "".join(parts)
