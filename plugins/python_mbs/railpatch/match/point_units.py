"""Units of a creep curve's columns: of the keys that they drive, of the numbers that they are."""

from __future__ import annotations

import re
from collections.abc import Mapping

import numpy as np

from railpatch.case.key_units import unit_of_key
from railpatch.case.kinds import kind_of
from railpatch.many import unit_of_name
from railpatch.record import MeasuredColumn, Record
from railpatch.record.units import UNITS, dimension_of, spelt
from railpatch.sweep.plan import steps_of

# tables of a case that hold moving keys, which a match names without them
TABLES = ("motion", "load", "wheelset", "track", "fluid", "temperature", "friction")
# of a creepage: what half of the points hardly lie above, and what none does
MOST_OF_HALF, MOST = 0.1, 1.0


def unit_of_input(kind: str, key: str) -> str:
    """SI unit of a moving key of a case; "" where none is known."""
    steps, schema = steps_of(key, "match.inputs"), kind_of(kind).schema()
    found = (unit_of_key(schema, [*table, *steps]) for table in ([], *([name] for name in TABLES)))
    unit = next(filter(None, found), "")
    return spelt(unit) if unit else ""


def unit_of_observed(key: str, column: MeasuredColumn, over: str | None) -> str:
    """SI unit of a number of the result, or of its quotient by another one; where none is known,
    of the dimension that the column's unit has, a number's where it has none."""
    units = [unit_of_name(re.sub(r"\[\d*\]", "", name)) for name in (key, over) if name]
    if over and units[0] and units[0] == units[1]:
        return "-"
    if not over and dimension_of(units[0]):
        return units[0]
    return own_unit(column)


def own_unit(column: MeasuredColumn) -> str:
    """SI unit of the dimension that a column's unit has; a number's where it has none."""
    dimension = dimension_of(spelt(column.unit)) if column.unit else "number"
    return next(iter(UNITS[dimension])) if dimension else str(column.unit)


def creepage_doubts(record: Record, names: Mapping[str, MeasuredColumn]) -> list[str]:
    """Of creepages that can hardly be meant. names: signal of the record -> its column."""
    found = []
    for name, column in names.items():
        size = np.abs(record.signals[name])
        if np.nanmedian(size) <= MOST_OF_HALF and np.nanmax(size) <= MOST:
            continue
        used = record.units[name]
        known = UNITS["number"]
        fitting = [
            repr(other)
            for other, unit in known.items()
            if np.nanmax(size) * unit.factor / known[used].factor <= MOST_OF_HALF
        ]
        asked = f"; is its unit {' or '.join(fitting)}?" if fitting else ""
        found.append(
            f"match.{name}: column {column.name!r} goes up to {np.nanmax(size):.4g}, half of it "
            f"above {np.nanmedian(size):.3g}, which is hardly meant of a creepage{asked}"
        )
    return found
