"""What was measured, or another run, laid over a run: pairs of curves and what lies between."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from os import PathLike
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from railpatch.case.types import SIDES
from railpatch.errors import CaseError, RecordError
from railpatch.log.channels import LEAST_LOAD
from railpatch.log.reader import Run, read_run
from railpatch.log.table import Column, LogTable
from railpatch.record import MeasuredColumn, Record, read_record, resampled
from railpatch.record.columns import load_columns
from railpatch.record.quantities import BY_NAME, OUTPUT, QUANTITIES, Quantity, ratio_side
from railpatch.record.units import UNITS, dimension_of
from railpatch.report.data import SHOWN
from railpatch.report.scene import differences_of

Array = NDArray[np.float64]

# by kind of abscissa: columns of a log that may have it, and the label of an axis
ABSCISSAS = {
    "time": (("time",), "time [s]"),
    "progress": (("/wheelset/state.progress", "/vehicle/state.progress"), "progress of the run"),
    "distance": (("/wheelset/state.x", "/vehicle/state.x"), "distance [m]"),
}
MEASURED = "/rig/measured"


@dataclass(frozen=True)
class Pair:
    """One quantity of a run and of what is beside it, in the unit that is shown.

    at, own: [n], of the run. other_at, other: [m].
    """

    name: str
    unit: str
    at: Array
    own: Array
    other_at: Array
    other: Array

    @cached_property
    def difference(self) -> Array:
        """[n], run minus other, NaN where one of them is absent."""
        rising = np.r_[True, np.diff(self.other_at) > 0]
        return self.own - resampled(self.other_at[rising], self.other[rising], self.at)

    @property
    def label(self) -> str:
        """Name and unit."""
        return f"{self.name} [{self.unit}]" if self.unit not in ("", "-") else self.name


@dataclass(frozen=True)
class Beside:
    """What is laid over a run. title: of the section; what: of the other curves, "measured".

    label: of the abscissa. at, yaw: [n], of the run, yaw in rad; None without. scenes: of another
    log, key, value here and there of what the scenes differ in; None of what is no log."""

    title: str
    what: str
    label: str
    pairs: list[Pair]
    at: Array | None = None
    yaw: Array | None = None
    scenes: list[tuple[str, str, str]] | None = None

    def ratios(self) -> dict[str, Pair]:
        """L/V by side, where both are known."""
        named = {pair.name: pair for pair in self.pairs}
        return {side: named[f"{side} ratio"] for side in SIDES if f"{side} ratio" in named}


class Computed:
    """Columns of a run by quantity."""

    def __init__(self, run: Run) -> None:
        self.run = run
        self.table: LogTable = run.table()
        self.columns: dict[str, Column] = {c.name: c for c in self.table.columns if not c.is_text}

    def abscissa(self, kind: str) -> Array | None:
        """[n], None where the log has none."""
        for name in ABSCISSAS[kind][0]:
            column = self.columns.get(name)
            if column is not None and np.isfinite(column.values).any():
                varies = np.ptp(column.values[np.isfinite(column.values)]) > 0
                return np.asarray(column.values, dtype=float) if varies else None
        return None

    def values(self, quantity: Quantity) -> Array | None:
        """SI units, [n]; None where the log has none."""
        if side := ratio_side(quantity.name):
            y, z = (self.columns.get(f"/{side}/contact.force.{axis}") for axis in "yz")
            if y is None or z is None:
                return None
            with np.errstate(divide="ignore", invalid="ignore"):
                ratio = y.values / z.values
            return np.where(np.isfinite(ratio), ratio, np.nan)
        column = self.columns.get(quantity.column)
        return None if column is None else quantity.sign * column.values

    @property
    def wheelsets(self) -> int:
        """Of a vehicle; 0 of other runs."""
        return int(self.run.metadata["railpatch"].get("wheelsets", 0))

    def units(self) -> dict[str, str]:
        """Of the log's columns of numbers."""
        return {name: column.unit for name, column in self.columns.items()}

    def quantities(self) -> Iterator[Quantity]:
        """What two runs are compared by."""
        if not self.wheelsets:
            yield from QUANTITIES
        for number in range(1, self.wheelsets + 1):
            above = f"/wheelset/{number}"
            yield _logged(f"wheelset {number} lateral position", "length", f"{above}/state.y")
            for side in SIDES:
                force, name = f"{above}/{side}/contact.force", f"wheelset {number} {side}"
                yield _logged(f"{name} lateral", "force", f"{force}.y", -1.0)
                yield _logged(f"{name} vertical", "force", f"{force}.z", -1.0)


def beside_record(run: Run, file: Path, columns_file: Path | None) -> Beside:
    """A file of measurements or other numbers over a run. Raises CaseError, RecordError."""
    computed = Computed(run)
    columns: Mapping[str, MeasuredColumn] | None = None
    if columns_file is not None:
        columns = load_columns(columns_file)
    record = read_record(file, columns, logged=computed.units())
    if not record.kind:
        raise RecordError(
            file, f"columns: {', '.join(ABSCISSAS)} are missing, allowed one of them beside a run"
        )
    at = computed.abscissa(record.kind)
    if at is None:
        raise RecordError(
            file, f"columns.{record.kind}: the log has none, allowed {known(computed)}"
        )
    check_overlap(record, at)
    pairs = []
    for name, values in with_ratios(signals_of(record)).items():
        quantity = BY_NAME.get(name) or _logged(name, dimension_of(computed.units()[name]), name)
        pairs.append(_pair(quantity, computed, at, record.at, values))
    label = ABSCISSAS[record.kind][1]
    return Beside(f"Beside {file.name}", file.name, label, pairs, at, yaw_of(computed))


def signals_of(record: Record) -> dict[str, Array]:
    """Filtered by time. Raises RecordError for a cut-off of others."""
    if record.kind != "time" and record.cutoffs:
        name = next(iter(record.cutoffs))
        raise RecordError(
            record.path, f"columns.{name}.low_pass: value is given, allowed with a column of time"
        )
    return record.filtered(record.at) if record.cutoffs else record.signals


def check_overlap(record: Record, at: Array) -> None:
    """Refuses a record beside which the run is not. Raises RecordError."""
    low, high = float(np.nanmin(at)), float(np.nanmax(at))
    if record.at[0] > high or record.at[-1] < low:
        raise RecordError(
            record.path,
            f"columns.{record.kind}: goes from {record.at[0]:.6g} to {record.at[-1]:.6g}, the run "
            f"from {low:.6g} to {high:.6g}, allowed those that overlap: an offset moves the column",
        )


def known(computed: Computed) -> str:
    """Kinds of abscissa that a log has."""
    return ", ".join(kind for kind in ABSCISSAS if computed.abscissa(kind) is not None)


def beside_log(run: Run, other_path: str | PathLike[str]) -> Beside:
    """Another log over a run, over the same abscissa. Raises CaseError, RunFileError."""
    other_run = read_run(other_path)
    own, other = Computed(run), Computed(other_run)
    kinds = ("distance", "time") if own.wheelsets else ("progress", "time")
    name = Path(other_path).name
    for kind in kinds:
        at, other_at = own.abscissa(kind), other.abscissa(kind)
        if at is not None and other_at is not None:
            break
    else:
        raise CaseError(f"--beside: {name} and {run.path.name} have no {' or '.join(kinds)} both")
    pairs = []
    for quantity in own.quantities():
        values = other.values(quantity)
        if values is not None and own.values(quantity) is not None:
            pairs.append(_pair(quantity, own, at, other_at, values))
    if not pairs:
        raise CaseError(f"--beside: value is {name!r}, allowed a log of the same kind of run")
    scenes = differences_of(run, other_run)
    return Beside(f"Beside {name}", name, ABSCISSAS[kind][1], pairs, at, yaw_of(own), scenes)


def beside_measured(run: Run) -> Beside | None:
    """What a replay's own record has; None of a run without one."""
    series = run[MEASURED]
    if not len(series):
        return None
    computed = Computed(run)
    kind = "progress" if computed.abscissa("progress") is not None else "time"
    at = computed.abscissa(kind)
    if at is None:
        return None
    rows = np.searchsorted(computed.table.time, series.time)
    found = {
        quantity.name: series[quantity.name]
        for quantity in QUANTITIES
        if quantity.role == OUTPUT and f"{MEASURED}.{quantity.name}" in computed.columns
    }
    pairs = [
        _pair(BY_NAME[name], computed, at, at[rows], values)
        for name, values in with_ratios(found).items()
    ]
    label = ABSCISSAS[kind][1]
    return Beside("Measured and computed", "measured", label, pairs, at, yaw_of(computed))


def yaw_of(computed: Computed) -> Array | None:
    """rad, [n]."""
    return computed.values(BY_NAME["yaw"])


def with_ratios(signals: Mapping[str, Array]) -> dict[str, Array]:
    """With L/V of the sides whose forces were both measured, beside those that are there."""
    found = dict(signals)
    for side in SIDES:
        lateral, vertical = (signals.get(f"{side}_{name}") for name in ("lateral", "vertical"))
        if f"{side}_ratio" not in found and lateral is not None and vertical is not None:
            loaded = np.where(np.abs(vertical) >= LEAST_LOAD, vertical, np.nan)
            found[f"{side}_ratio"] = lateral / loaded
    return found


def _logged(name: str, dimension: str, column: str, sign: float = 1.0) -> Quantity:
    return Quantity(name, dimension, name, OUTPUT, -np.inf, np.inf, 0.0, column, sign)


def _pair(quantity: Quantity, computed: Computed, at: Array, other_at: Array, other: Array) -> Pair:
    unit = next(iter(UNITS.get(quantity.dimension, ())), "")
    if quantity.column in computed.columns:
        unit = computed.columns[quantity.column].unit
    factor, shown = SHOWN.get(unit, (1.0, unit))
    own = computed.values(quantity)
    values = np.full(len(at), np.nan) if own is None else factor * own
    known = np.isfinite(at)
    name = quantity.name if quantity.name.startswith("/") else re.sub("_", " ", quantity.name)
    return Pair(name, shown, at[known], values[known], other_at, factor * other)
