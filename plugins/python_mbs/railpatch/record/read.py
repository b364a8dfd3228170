"""A record of a measured run: its columns in SI units, checked by their ranges."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from railpatch.errors import RecordError
from railpatch.record.columns import MeasuredColumn
from railpatch.record.forces import on_rollers
from railpatch.record.quantities import ABSCISSA, BY_NAME, OUTPUT, Quantity
from railpatch.record.resample import HIGHEST, low_passed, step_of
from railpatch.record.table import RawTable, read_table
from railpatch.record.units import UNITS, dimension_of, spelt

Array = NDArray[np.float64]

# of rows that a filter would need at their usual rate, over those there are
MOST_UNEVEN = 20
# columns of an exported log that are taken without being asked for
MOST_EXPORTED = 40


@dataclass(frozen=True)
class Record:
    """n rows of a measured run.

    kind: of ``at``, "time" (s), "progress" (-), "distance" (m), or "" where the rows are numbered:
    0 to 1, evenly. at: [n], rising. signals: by quantity, or by the column of a log's table, SI
    units, [n], NaN in gaps. units: of the file, by the same. cutoffs: Hz, of low-pass filters.
    warnings: of what is hardly meant.
    """

    path: Path
    kind: str
    at: Array
    signals: dict[str, Array]
    units: dict[str, str]
    cutoffs: dict[str, float] = field(default_factory=dict)
    warnings: list[str] = field(default_factory=list)

    def filtered(self, time: Array) -> dict[str, Array]:
        """The signals without what is faster than their cut-off. time: s, [n], of the rows.

        Raises RecordError for a cut-off that the record is too slow for."""
        found = dict(self.signals)
        rate = 1 / step_of(time)
        if self.cutoffs and (time[-1] - time[0]) * rate > MOST_UNEVEN * len(time):
            raise RecordError(
                self.path,
                f"low_pass: rows come at {rate:.4g} Hz in their median and {len(time)} of them in "
                f"{time[-1] - time[0]:.4g} s, allowed rows that are more even, or no filter",
            )
        for name, cutoff in self.cutoffs.items():
            if cutoff > HIGHEST * rate:
                raise RecordError(
                    self.path,
                    f"{name}: low_pass is {cutoff:g} Hz, allowed at most {HIGHEST * rate:.4g} Hz: "
                    f"its rows come at {rate:.4g} Hz",
                )
            found[name] = low_passed(time, found[name], cutoff)
        return found


def read_record(
    path: str | Path,
    columns: Mapping[str, MeasuredColumn] | None = None,
    *,
    low_pass: float | None = None,
    logged: Mapping[str, str] | None = None,
    prefix: str = "columns",
) -> Record:
    """Reads a file by its table of columns; without one, columns that are called as quantities are.

    low_pass: Hz, of all but the abscissa. logged: unit of each column of a log's table that may be
    a key of ``columns`` too. prefix: of the keys in messages. Raises RecordError.
    """
    path = Path(path)
    raw = read_table(path)
    columns = dict(columns) if columns else own_columns(raw, logged or {})
    warnings: list[str] = []
    try:
        columns = on_rollers(columns, lambda c: raw.numbers(raw.find(c.name, prefix)), warnings)
    except RecordError:
        raise
    except ValueError as error:
        raise RecordError(path, f"{prefix}.{error}") from None
    signals: dict[str, Array] = {}
    units: dict[str, str] = {}
    for key, column in columns.items():
        quantity = quantity_of(path, key, logged or {}, prefix)
        shown = f"{prefix}.{key}"
        place = raw.find(column.name, shown)
        units[key] = unit_of(raw, place, column, quantity, shown, warnings)
        signals[key] = in_si(raw, place, column, units[key], quantity)
        check_range(raw, place, signals[key], units[key], quantity, shown, warnings)
    kind, at, kept = abscissa_of(raw, signals, warnings)
    signals = {key: values[kept] for key, values in signals.items() if not is_abscissa(key)}
    if not signals:
        raise RecordError(
            path, f"{prefix}: value is no signal, allowed one beside {kind or 'none'}"
        )
    cutoffs = {key: columns[key].low_pass or low_pass for key in signals}
    return Record(path, kind, at, signals, units, {k: v for k, v in cutoffs.items() if v}, warnings)


def own_columns(raw: RawTable, logged: Mapping[str, str]) -> dict[str, MeasuredColumn]:
    """Columns that are called as a quantity is, "yaw [mrad]", "left lateral [kN]", or as a column
    of the log that the record is laid over. Raises RecordError."""
    plain = [name.strip().lower().replace(" ", "_") for name in raw.names]
    found = {
        known: MeasuredColumn(name=name)
        for known, name in zip(plain, raw.names, strict=True)
        if known in BY_NAME
    }
    exported = {name: MeasuredColumn(name=name) for name in raw.names if name in logged}
    if len(exported) > MOST_EXPORTED:
        raise RecordError(
            raw.path,
            f"has {len(exported)} columns of the log, allowed at most {MOST_EXPORTED}: choose some "
            "by a table [columns], or where they are exported",
        )
    found |= {name: column for name, column in exported.items() if name not in found}
    if not found:
        raise RecordError(
            raw.path,
            f"has columns {', '.join(map(repr, raw.names))}, allowed a table [columns] that says "
            f"what they are, or columns called {', '.join(BY_NAME)}",
        )
    return found


def quantity_of(path: Path, key: str, logged: Mapping[str, str], prefix: str) -> Quantity:
    """Of a key; a column of a log is one without limits."""
    if key in BY_NAME:
        return BY_NAME[key]
    if key not in logged:
        raise RecordError(path, f"{prefix}.{key!r}: is no column of the log")
    dimension = dimension_of(logged[key]) or logged[key]
    return Quantity(key, dimension, key, OUTPUT, -np.inf, np.inf, 0.0, key)


def is_abscissa(key: str) -> bool:
    """Whether a quantity only says when."""
    return key in BY_NAME and BY_NAME[key].role == ABSCISSA


def unit_of(
    raw: RawTable,
    place: int,
    column: MeasuredColumn,
    quantity: Quantity,
    key: str,
    warnings: list[str],
) -> str:
    """As in UNITS. Raises RecordError for one that is missing or of another dimension."""
    headed = spelt(raw.units[place]) if raw.units[place] else ""
    unit = spelt(column.unit) if column.unit is not None else headed
    known = UNITS.get(quantity.dimension, {quantity.dimension: None})
    if not unit and quantity.dimension == "number":
        unit = "-"
    if unit not in known:
        shown = repr(column.unit or raw.units[place]) if unit else "missing"
        allowed = f"allowed {', '.join(known)}"
        raise RecordError(raw.path, f"{key}.unit: value is {shown}, {allowed}")
    if headed in known and headed != unit:
        warnings.append(
            f"{key}.unit: value is {unit!r}, and the head of column {raw.names[place]!r} says "
            f"{headed!r}"
        )
    return unit


def in_si(
    raw: RawTable, place: int, column: MeasuredColumn, unit: str, quantity: Quantity
) -> Array:
    """[n], sign * (factor * number + offset) in the unit, then in SI units."""
    numbers = raw.numbers(place, clock=quantity.dimension == "time")
    values = column.sign * (column.factor * numbers + column.offset)
    known = UNITS.get(quantity.dimension)
    return known[unit].factor * values + known[unit].offset if known else values


def check_range(
    raw: RawTable,
    place: int,
    values: Array,
    unit: str,
    quantity: Quantity,
    key: str,
    warnings: list[str],
) -> None:
    """Refuses what lies beyond the quantity's limits, doubts what is too small to be meant."""
    name = raw.names[place]
    if not np.isfinite(values).any():
        raise RecordError(raw.path, f"{key}: column {name!r} holds no number")
    low, high = float(np.nanmin(values)), float(np.nanmax(values))
    known = UNITS.get(quantity.dimension, {})
    used = known.get(unit)
    if used is None:
        return
    shown = f"{in_unit(low, used):.4g} to {in_unit(high, used):.4g} {unit}"
    if low < quantity.low or high > quantity.high:
        first = next(iter(known))
        allowed = f"allowed {quantity.low:g} to {quantity.high:g} {first}".removesuffix(" -")
        fitting = fitting_units(quantity, unit, low, high)
        raise RecordError(raw.path, f"{key}: column {name!r} goes from {shown}, {allowed}{fitting}")
    if max(-low, high) < quantity.least:
        fitting = fitting_units(quantity, unit, low, high)
        warnings.append(f"{key}: column {name!r} goes from {shown}, which is hardly meant{fitting}")


def in_unit(value: float, unit: object) -> float:
    """Of a value in SI units."""
    return (value - unit.offset) / unit.factor  # type: ignore[attr-defined]


def fitting_units(quantity: Quantity, unit: str, low: float, high: float) -> str:
    """Those in which the numbers of the file would be within the limits."""
    known = UNITS[quantity.dimension]
    fitting = []
    for name, other in known.items():
        ends = [other.factor * in_unit(end, known[unit]) + other.offset for end in (low, high)]
        within = quantity.low <= min(ends) and max(ends) <= quantity.high
        if name != unit and within and max(map(abs, ends)) >= quantity.least:
            fitting.append(repr(name))
    return f"; is its unit {' or '.join(fitting)}?" if fitting else ""


def abscissa_of(
    raw: RawTable, signals: Mapping[str, Array], warnings: list[str]
) -> tuple[str, Array, NDArray[np.bool_]]:
    """Kind, the values that rise, and the rows that are kept. Raises RecordError."""
    given = [key for key in signals if is_abscissa(key)]
    count = len(raw.rows)
    if not given:
        return "", np.linspace(0.0, 1.0, count), np.ones(count, dtype=bool)
    if len(given) > 1:
        raise RecordError(raw.path, f"has columns of {' and '.join(given)}, allowed one of them")
    at = signals[given[0]]
    kept = np.isfinite(at)
    rows = np.flatnonzero(kept)
    steps = np.diff(at[rows])
    if (steps < 0).any():
        place = int(rows[np.argmax(steps < 0) + 1])
        problem = f"{given[0]} falls to {at[place]:.6g}, allowed rising from row to row"
        raise RecordError(raw.path, problem, raw.lines[place])
    twice = rows[1:][steps == 0]
    kept[twice] = False
    if len(twice):
        warnings.append(
            f"{raw.path.name}: {len(twice)} rows have the {given[0]} of the row before and are "
            "left out"
        )
    if kept.sum() < 2:
        raise RecordError(raw.path, f"has {kept.sum()} rows with {given[0]}, allowed 2 or more")
    return given[0], at[kept], kept
