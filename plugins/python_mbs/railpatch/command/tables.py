"""Results and stages as tables on the terminal."""

from __future__ import annotations

from typing import Any

from rich.console import Console
from rich.table import Table

from railpatch.case.scene_profiles import note_lines
from railpatch.case.types import SIDES
from railpatch.result import (
    PATCH_UNITS,
    PLACE_UNITS,
    WHEEL_UNITS,
    WHEELSET_UNITS,
    Result,
    noise_of,
    six_digits,
)

# told in lines of their own, not in columns
IN_WORDS = ("reason", "warnings")


def print_result(result: Result, console: Console | None = None) -> None:
    """The quantities of a result, one column for each patch."""
    console = console or Console()
    data = result.data
    sides = [side for side in SIDES if side in data]
    if "patches" not in data and not sides:
        found = {"creepage": PLACE_UNITS["creepage"]} if "creepage" in data else {}
        console.print(patch_table([("", data)], {**PATCH_UNITS, **found}))
    else:
        wheels = {side: data[side] for side in sides} or {"wheel": data}
        console.print(wheel_table(data, wheels))
        columns = [
            (f"{side} {index + 1}", patch)
            for side, wheel in wheels.items()
            for index, patch in enumerate(wheel["patches"])
        ]
        columns += [
            (f"{side} alternative {index + 1}", patch)
            for side, wheel in wheels.items()
            for index, patch in enumerate(wheel["alternatives"])
        ]
        if columns:
            console.print(patch_table(columns, {**PATCH_UNITS, **PLACE_UNITS}))
    for line in note_lines(data.get("profiles", {})):
        console.print(line, highlight=False)
    for line in data.get("notes", []):
        console.print(line, highlight=False)
    console.print(f"solved in {1e3 * data['wall_time']:.3g} ms: {', '.join(data['stages'])}")


def patch_table(columns: list[tuple[str, dict[str, Any]]], units: dict[str, str]) -> Table:
    """One row for each quantity that the scene has."""
    table = new_table([name for name, _ in columns], "patch")
    for key, unit in units.items():
        if key in IN_WORDS:
            continue
        cells = [
            spell(patch[key], noise_of(unit, patch.get("normal_force"))) for _, patch in columns
        ]
        if any(cells):
            table.add_row(key, unit, *cells)
    add_asked(table, [patch for _, patch in columns])
    return table


def add_asked(table: Table, columns: list[dict[str, Any]]) -> None:
    """What the case's tables [subsurface] and [damage] ask for."""
    asked = [name for name in ("subsurface", "damage") if any(c.get(name) for c in columns)]
    if not asked:
        return
    from railpatch.log import channels

    fields = {"subsurface": channels.SUBSURFACE.fields, "damage": channels.DAMAGE.fields}
    for name in asked:
        for field in fields[name]:
            cells = [spell((values.get(name) or {}).get(field.name)) for values in columns]
            if any(cells):
                table.add_row(f"{name}.{field.name}", field.unit, *cells)


def wheel_table(data: dict[str, Any], wheels: dict[str, dict[str, Any]]) -> Table:
    """Forces of each wheel, and of the wheelset."""
    columns = dict(wheels)
    if len(wheels) > 1:
        columns["wheelset"] = data
    table = new_table(list(columns), "wheel")
    for key, unit in {**WHEEL_UNITS, **WHEELSET_UNITS}.items():
        if key in IN_WORDS:
            continue
        # the wheelset has no rolling radius, and most rails do not deflect
        cells = [spell(values.get(key)) for values in columns.values()]
        if any(cells):
            table.add_row(key, unit, *cells)
    add_asked(table, list(columns.values()))
    return table


def new_table(names: list[str], title: str) -> Table:
    """An empty table with columns for name, unit and values."""
    table = Table(box=None, pad_edge=False)
    table.add_column(title, no_wrap=True)
    table.add_column("unit", no_wrap=True)
    for name in names:
        table.add_column(name, justify="right")
    return table


def spell(value: Any, least: float = 0.0) -> str:
    """Six digits; empty for what is left out. least: by size, of a number that is not noise."""
    if value is None:
        return ""
    if isinstance(value, float):
        return six_digits([value], least)[0]
    if isinstance(value, list):
        if value and all(isinstance(item, float) for item in value):
            return " ".join(six_digits(value, least))
        return " ".join(spell(item, least) for item in value)
    if isinstance(value, dict):
        shown = {name: spell(item) for name, item in value.items() if item}
        return ", ".join(f"{text} {name}" for name, text in shown.items() if text)
    return str(value)


def print_stages(
    stages: list[dict[str, Any]], result: Result, console: Console | None = None
) -> None:
    """Stages with reason, memory and share of the measured time."""
    console = console or Console()
    total = sum(stage["seconds"] for stage in stages)
    table = Table(box=None, pad_edge=False)
    for name in ("stage", "needed", "memory", "time"):
        table.add_column(name, justify="left" if name in ("stage", "needed") else "right")
    table.add_column("why", overflow="fold")
    for stage in stages:
        # what is part of another stage has no time of its own
        timed = stage["seconds"] > 0
        share = f"{100 * stage['seconds'] / total:.1f} %" if timed else "-"
        held = "" if stage["bytes"] is None else memory(stage["bytes"])
        used = (held, share) if stage["present"] else ("", "")
        needed = "yes" if stage["present"] else "no"
        table.add_row(stage["name"], needed, *used, stage["reason"])
    console.print(table)
    console.print(
        f"{memory(sum(stage['bytes'] or 0 for stage in stages))}, "
        f"{1e3 * result['wall_time']:.3g} ms from a cold start, {result.status}"
    )


def memory(size: int) -> str:
    """Bytes in a readable unit."""
    for unit in ("B", "kB", "MB"):
        if size < 1000:
            return f"{size:.3g} {unit}"
        size /= 1000
    return f"{size:.3g} GB"
