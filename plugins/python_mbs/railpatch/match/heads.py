"""Columns of a creep curve by their names, where a match does not say which are what."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from railpatch.errors import RecordError
from railpatch.record.table import RawTable, read_table
from railpatch.record.units import dimension_of, spelt

# names of columns, in small letters with "_" for blanks, by the key that they are
INPUTS = {
    "creepage[0]": ("creepage", "creepage[0]", "creepage_x", "longitudinal_creepage"),
    "creepage[1]": ("creepage[1]", "creepage_y", "lateral_creepage"),
    "spin_creepage": ("spin_creepage", "spin"),
    "rolling_speed": ("rolling_speed", "speed"),
    "normal_force": ("normal_force", "load"),
}
FORCES = {
    "creep_force[0]": ("creep_force", "creep_force[0]", "creep_force_x", "force", "force_x"),
    "creep_force[1]": ("creep_force[1]", "creep_force_y", "force_y"),
}
# over the load
RATIOS = {
    "creep_force[0]": ("traction", "traction_coefficient", "adhesion", "fx/fn"),
    "creep_force[1]": ("lateral_traction", "fy/fn"),
}
SI = {"spin_creepage": "rad/m", "rolling_speed": "m/s", "normal_force": "N"}


@dataclass
class Heads:
    """Fields of columns by input and by number of the result; what is told of them."""

    inputs: dict[str, dict[str, Any]] = field(default_factory=dict)
    observed: dict[str, dict[str, Any]] = field(default_factory=dict)
    warnings: list[str] = field(default_factory=list)

    @staticmethod
    def allowed(name: str) -> str:
        """Names of columns that are known."""
        tables = (INPUTS,) if name == "inputs" else (FORCES, RATIOS)
        return ", ".join(word for table in tables for words in table.values() for word in words)


def heads_of(file: Path) -> Heads:
    """Of a record. Raises RecordError."""
    raw, found = read_table(file), Heads()
    for place, head in enumerate(raw.names):
        name = head.strip().lower().replace(" ", "_")
        unit = spelt(raw.units[place]) if raw.units[place] else None
        if (key := key_of(INPUTS, name)) and key not in found.inputs:
            found.inputs[key] = {"name": head, "unit": unit or SI.get(key)}
        elif key := key_of(FORCES, name):
            found.observed.setdefault(key, {"name": head, "unit": unit or "N"})
        elif key := key_of(RATIOS, name):
            column = {"name": head, "unit": unit, "over": "normal_force"}
            found.observed.setdefault(key, column)
    for key, column in found.observed.items():
        check(raw, key, column)
        turn(raw, found, key, column)
    return found


def key_of(table: dict[str, tuple[str, ...]], name: str) -> str | None:
    """That a column's name stands for."""
    return next((key for key, names in table.items() if name in names), None)


def check(raw: RawTable, key: str, column: dict[str, Any]) -> None:
    """Raises RecordError for a force in what is no unit of forces."""
    if "over" not in column and dimension_of(column["unit"]) != "force":
        raise RecordError(
            raw.path,
            f"column {column['name']!r}: unit is {column['unit']!r}, allowed one of a force for "
            f"{key}; columns of forces over the load are called {', '.join(RATIOS[key])}",
        )


def turn(raw: RawTable, found: Heads, key: str, column: dict[str, Any]) -> None:
    """Friction on the wheel is against the creepage; what is along it was measured on the rail."""
    driving = found.inputs.get(key.replace("creep_force", "creepage"))
    if driving is None:
        return
    values = [raw.numbers(raw.find(own["name"], "match")) for own in (driving, column)]
    if np.nansum(values[0] * values[1]) > 0:
        column["sign"] = -1
        found.warnings.append(
            f"column {column['name']!r}: is along {driving['name']!r}, so it is taken as the force "
            f"on the rail: {key}, on the wheel, with sign = -1"
        )
