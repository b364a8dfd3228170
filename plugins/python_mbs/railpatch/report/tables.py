"""Tables of the report, as HTML; every text that comes from a file is escaped here."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape

import numpy as np

from railpatch.case.types import SIDES
from railpatch.log.channels import CHANNELS, CONVENTIONS, WELL_KNOWN, flat_fields, vehicle_channels
from railpatch.log.reader import Run
from railpatch.page.tables import number, table, whole
from railpatch.report.data import Positions
from railpatch.report.reference import Match, differences


def summary(data: Positions) -> str:
    """What the run was, and how it went."""
    return table(
        (), [row for row in [*identity(data.run), *_course(data), *_cost(data)] if row], "summary"
    )


def unsolved(data: Positions) -> str:
    """Positions that did not converge, with every status; empty where there is none."""
    bad = np.flatnonzero(~data.solved)
    if not bad.size:
        return ""
    head = ["position", data.along_label, "yaw [mrad]", "left", "right"]
    head += ["balance"] if data.has_balance else []
    rows = []
    for index in bad:
        row = [int(index), number(data.along[index]), number(1e3 * data.state["yaw"][index])]
        row += [data.contact[side].messages[index]["status"] for side in SIDES]
        if data.has_balance:
            row.append(data.balance.messages[index].get("status", "-"))
        rows.append(row)
    return table(head, rows)


def reference_summary(matches: list[Match], data: Positions) -> str:
    """Mean and largest difference from the reference by side and quantity."""
    found = differences(matches, data)
    sides = np.array([m.row.side for m in matches])
    names = {"x": "Fx [N]", "y": "Fy [N]", "z": "Fz [N]", "ratio": "L/V", "patches": "patches"}
    rows = [
        [side, text, *_spread(found[name][sides == side])]
        for side in SIDES
        for name, text in names.items()
    ]
    # the wheelset's position stands in the rows of both sides
    names = {"z_ws": "z [mm]", "roll": "roll [mrad]", "pitch_rate": "pitch rate [rad/s]"}
    factor = {"z_ws": 1e3, "roll": 1e3, "pitch_rate": 1.0}
    rows += [
        ["wheelset", text, *_spread(factor[name] * found[name][sides == "left"])]
        for name, text in names.items()
    ]
    return table(
        ("body", "quantity", "points", "mean difference", "root mean square", "largest"), rows
    )


def reference_rows(matches: list[Match], data: Positions) -> str:
    """Every matched pair: the run's force on the roller and its difference from the reference."""
    found = differences(matches, data)
    head = ["position", "yaw [mrad]", "y [mm]", "wheel"]
    for axis in "xyz":
        head += [f"F{axis} [N]", f"reference F{axis}", "difference"]
    head += ["patches", "reference"]
    rows = []
    for place, pair in enumerate(matches):
        row = [pair.index, number(1e3 * pair.row.yaw), number(1e3 * pair.row.y), pair.row.side]
        for axis, name in enumerate("xyz"):
            row += [
                whole(-data.force[pair.row.side][pair.index, axis]),
                whole(pair.row.force[axis]),
                whole(found[name][place]),
            ]
        row += [int(data.patch_count(pair.row.side)[pair.index]), pair.row.patches]
        rows.append(row)
    return table(head, rows)


def channels(run: Run) -> str:
    """The channel table with the messages that this file holds, and the conventions."""
    counts = run.counts
    number = int(run.metadata["railpatch"].get("wheelsets", 0))
    table_of_run = vehicle_channels(number) if number else CHANNELS
    rows = [
        (c.topic, f"railpatch.{c.message.name}", counts.get(c.topic, 0), c.text)
        for c in table_of_run
    ]
    rows += [
        (topic, name, counts.get(topic, 0), text) for topic, (name, text) in WELL_KNOWN.items()
    ]
    parts = [
        table((), ((k.replace("_", " "), v) for k, v in CONVENTIONS.items()), "summary"),
        table(("channel", "message", "messages", "content"), rows),
    ]
    for message in dict.fromkeys(c.message for c in table_of_run):
        fields = [(path, f.unit, f.frame, f.text) for path, f in flat_fields(message)]
        parts.append(
            f"<h3>railpatch.{message.name}</h3><p>{escape(message.text)}</p>"
            + table(("field", "unit", "axes", "meaning"), fields)
        )
    return "".join(parts)


def _spread(values: np.ndarray) -> list[object]:
    """Number of values, their mean, root mean square and largest size."""
    values = values[np.isfinite(values)]
    if not values.size:
        return [0, "-", "-", "-"]
    return [
        values.size,
        number(values.mean()),
        number(np.sqrt((values**2).mean())),
        number(abs(values).max()),
    ]


def identity(run: Run) -> list[Sequence[object]]:
    """Scene, file, and what the log itself took."""
    about, end = run.metadata["railpatch"], run.metadata.get("railpatch.end", {})
    files = ", ".join(f"{name} ({len(a.data):,} bytes)" for name, a in run.attachments.items())
    rows: list[Sequence[object]] = [
        ("scene", about.get("scene", "-")),
        ("log", run.path.name),
        ("railpatch", about.get("version", "-")),
        ("attached files", files or "none"),
        *made_with(about),
    ]
    if "logging_time" in end:
        share = 100 * float(end["logging_time"]) / float(end["wall_time"])
        rows.append(("logging", f"{number(share)} % of the wall time"))
    return rows


def made_with(about: dict[str, str]) -> list[Sequence[object]]:
    """Theory, steps, and what options have replaced; older logs do not say."""
    rows: list[Sequence[object]] = []
    if about.get("theory"):
        rows.append(("theory", ", ".join(filter(None, (about["theory"], about.get("grid"))))))
    if about.get("step"):
        rows.append(("time step", f"{about['step']} s, for {about['duration']} s"))
    rows += [("profile", line) for line in about.get("profiles", "").split(" | ") if line]
    if "overrides" in about:
        rows.append(("not as in the case file", about["overrides"] or "nothing"))
    return rows


def _course(data: Positions) -> list[Sequence[object]]:
    state, good = data.state, int(data.solved.sum())
    yaw = 1e3 * state["yaw"]
    rows = [
        (
            "positions",
            f"{data.count}, of which {good} converged"
            + ("" if good == data.count else f" and {data.count - good} did not"),
        ),
        (data.along_label, f"{number(data.along[0])} to {number(data.along[-1])}"),
        ("yaw", f"{number(yaw.min())} to {number(yaw.max())} mrad"),
    ]
    for name, text, unit in (
        ("vertical_force", "vertical load", "N"),
        ("speed", "speed", "m/s"),
        ("roller_pitch_rate", "roller speed", "rad/s"),
    ):
        values = state[name][np.isfinite(state[name])]
        # a wheelset on rollers stands still
        if values.size and not (name == "speed" and np.isfinite(state["roller_pitch_rate"]).any()):
            low, high = number(values.min()), number(values.max())
            rows.append((text, f"{low} {unit}" if low == high else f"{low} to {high} {unit}"))
    for side in SIDES:
        count = data.patch_count(side)
        low, high = count.min(), count.max()
        rows.append((f"{side} patches", f"{low}" if low == high else f"{low} to {high}"))
    return rows


def _cost(data: Positions) -> list[Sequence[object]]:
    rows: list[Sequence[object]] = []
    wall = data.stats["wall_time"] if data.has_stats else np.array([np.nan])
    if np.isfinite(wall).any():
        rows.append(
            (
                "wall time",
                f"{number(np.nansum(wall))} s in all, {number(np.nanmean(wall))} "
                f"s a position, at most {number(np.nanmax(wall))} s",
            )
        )
    if data.has_balance:
        evaluations = data.balance["evaluations"]
        if np.isfinite(evaluations).any():
            rows.append(
                (
                    "evaluations of the balance",
                    f"{np.nansum(evaluations):.0f} in all, at "
                    f"most {np.nanmax(evaluations):.0f} a position",
                )
            )
    return rows
