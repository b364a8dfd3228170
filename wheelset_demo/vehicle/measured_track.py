"""Rails that are not straight, from a measured record: its columns, units, waves.

The file is any that railpatch.record reads: separators, decimal commas, a head with units. Which
column is what stands in [measured_track.columns]; without it columns are called as the keys are.
Track axes: lateral to the right, vertical down. Both rails are given, or what they share and how
they differ:

    lateral of left, right = lateral -+ gauge/2
    vertical of left, right = vertical -+ cross_level/2
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, create_model, model_validator
from railpatch.case.track import Irregularity
from railpatch.case.types import Number, Positive, Table, relation
from railpatch.errors import RecordError
from railpatch.record.columns import MeasuredColumn, described
from railpatch.record.quantities import ABSCISSA, OUTPUT, Quantity
from railpatch.record.read import check_range, in_si, unit_of
from railpatch.record.resample import low_passed
from railpatch.record.table import RawTable, read_table

Vector = NDArray[np.float64]
PREFIX = "measured_track.columns"
# m: rails of a track on which trains run lie within this of their place
MOST = 0.3
# m: after the filter; more is the design's cant, or a curve in a chord's measure
MOST_MOVED = 0.1
# rows in the shortest wave that they show
LEAST_ROWS = 2.0
# of the largest step between rows over the usual one, for filters
MOST_UNEVEN = 20.0
DIMENSION = "length"


def _column(name: str, text: str) -> Quantity:
    return Quantity(name, DIMENSION, text, OUTPUT, -MOST, MOST, 1e-5)


DISTANCE = Quantity("distance", "way", "distance along the track, rising", ABSCISSA, -1e9, 1e9)
QUANTITIES = (
    DISTANCE,
    _column("left_lateral", "of the left rail, to the right > 0"),
    _column("right_lateral", "of the right rail, to the right > 0"),
    _column("lateral", "of both rails, to the right > 0"),
    _column("gauge", "deviation of the gauge, wider > 0"),
    _column("left_vertical", "of the left rail, down > 0"),
    _column("right_vertical", "of the right rail, down > 0"),
    _column("vertical", "of both rails, down > 0"),
    _column("cross_level", "right rail less left rail, down > 0, without the design's cant"),
)
BY_NAME = {quantity.name: quantity for quantity in QUANTITIES}
# by axis: what both rails share, how they differ, the rails themselves
AXES = {
    "lateral": ("lateral", "gauge", ("left_lateral", "right_lateral")),
    "vertical": ("vertical", "cross_level", ("left_vertical", "right_vertical")),
}

TrackColumns: Any = create_model(
    "TrackColumns",
    __base__=Table,
    __doc__="Which column of the record is what; left out: columns with the names of these keys.",
    **{
        quantity.name: (
            MeasuredColumn | None,
            Field(default=None, description=described(quantity.text, quantity.dimension)),
        )
        for quantity in QUANTITIES
    },
)


class MeasuredTrackTable(Table):
    """Measured deviations of the rails, in place of a spectrum."""

    file: Annotated[str, Field(min_length=1)] = Field(
        description="path of the record (file, no unit)"
    )
    columns: TrackColumns | None = Field(
        default=None, description="which column is what; left out: by their names"
    )
    origin: Number | None = Field(
        default=None,
        description="m, distance in the record (after its column's unit, sign and offset) at the "
        "track's position 0, under the last wheelset at the start; left out: its first row",
    )
    shortest: Positive | None = Field(
        default=None, description="m, shorter waves are taken away; left out: all are kept"
    )
    longest: Positive | None = Field(
        default=None, description="m, longer waves are taken away; left out: all are kept"
    )
    factor: Number = Field(default=1.0, description="-, of all deviations")
    begins: Annotated[float, Field(ge=1, le=1e5)] = Field(
        default=30.0, description="m, from straight rails to the full deviations"
    )

    @model_validator(mode="after")
    def _range(self) -> MeasuredTrackTable:
        if self.shortest and self.longest and not self.longest > self.shortest:
            raise relation("longest", self.longest, f"> 'shortest' ({self.shortest})")
        return self


# columns of deviations
DEVIATIONS = ("left_lateral", "left_vertical", "right_lateral", "right_vertical")


@dataclass(frozen=True)
class MeasuredTrack:
    """A record as the rails of a track.

    path: of the file. s: m, [n], along the track. deviations: m, [n, 4], of left and right rail,
    lateral and vertical. spacing: m, [2], usual and largest step between rows. waves: m, [2],
    shortest and longest that it holds. warnings: of what is hardly meant.
    """

    path: Path
    s: Vector
    deviations: Vector
    spacing: tuple[float, float]
    waves: tuple[float, float]
    warnings: tuple[str, ...]

    def rails(self, start: float, begins: float, needed: float) -> Irregularity:
        """From straight rails at ``start`` (m) to the full deviations over ``begins`` (m). needed:
        m, of track that a run asks for. Raises RecordError for a record that is shorter."""
        check_length(self.path, self.s, 0.0, needed)
        u = np.clip((self.s - start) / begins, 0.0, 1.0)
        share = u * u * (3 - 2 * u)
        return Irregularity(self.s, share[:, None] * self.deviations)

    def summary(self) -> dict[str, Any]:
        """Plain numbers, m: file, rows, spacing (usual, largest), waves (shortest, longest), rms by
        rail and direction."""
        return {
            "file": self.path.name,
            "rows": len(self.s),
            "spacing": list(self.spacing),
            "waves": list(self.waves),
            "rms": dict(zip(DEVIATIONS, self.deviations.std(axis=0).tolist(), strict=True)),
        }


def read_measured(table: MeasuredTrackTable, folder: Path, needed: float) -> MeasuredTrack:
    """A scene's record. folder: where its path starts. needed: m, of track that a run asks for.

    Raises RecordError, also for a unit that is missing, columns that say the same twice, rows that
    do not rise, cells without a number, a record that is too short or too coarse for its waves.
    """
    path = Path(folder) / table.file
    raw = read_table(path)
    columns = columns_of(raw, table)
    warnings: list[str] = []
    signals = {key: signal_of(raw, key, column, warnings) for key, column in columns.items()}
    at = signals.pop(DISTANCE.name)
    steps = np.diff(at)
    if (steps <= 0).any():
        row = int(np.argmax(steps <= 0)) + 1
        problem = (
            f"distance is {at[row]:.6g} m after {at[row - 1]:.6g} m, allowed rising from row to "
            f"row; of a falling chainage: {PREFIX}.distance.sign = -1"
        )
        raise RecordError(path, problem, raw.lines[row])
    origin = float(at[0]) if table.origin is None else table.origin
    s = at - origin
    check_length(path, at, origin, needed)
    usual, largest = float(np.median(steps)), float(steps.max())
    waves = (
        table.shortest or LEAST_ROWS * largest,
        table.longest or float(at[-1] - at[0]),
    )
    check_waves(path, table, usual, largest, float(at[-1] - at[0]))
    found = np.stack([*rails_of(path, signals)], axis=1)
    found = filtered(s, found, table)
    check_moved(path, found)
    return MeasuredTrack(path, s, table.factor * found, (usual, largest), waves, tuple(warnings))


def check_length(path: Path, at: Vector, origin: float, needed: float) -> None:
    """Refuses a record that begins too late or ends too soon. at: m, distances with their
    column's sign. Raises RecordError."""
    first, last = at[0] - origin, at[-1] - origin
    if first <= 0 and last >= needed:
        return
    asked = ""
    if origin != 0 and at[0] <= -origin <= at[-1]:
        asked = f"; distances go from {at[0]:.6g} to {at[-1]:.6g} m: is origin {-origin:.6g}?"
    raise RecordError(
        path,
        f"goes from {first:.6g} to {last:.6g} m of the track, allowed 0 to {needed:.6g} m at "
        f"least, which the run takes: see measured_track.origin, run.duration{asked}",
    )


def columns_of(raw: RawTable, table: MeasuredTrackTable) -> Mapping[str, MeasuredColumn]:
    """By quantity. Raises RecordError."""
    if table.columns is not None:
        given = {name: getattr(table.columns, name) for name in BY_NAME}
        found = {name: column for name, column in given.items() if column is not None}
    else:
        plain = [name.strip().lower().replace(" ", "_").replace("-", "_") for name in raw.names]
        found = {
            known: MeasuredColumn(name=name)
            for known, name in zip(plain, raw.names, strict=True)
            if known in BY_NAME
        }
    if DISTANCE.name not in found:
        there = ", ".join(map(repr, raw.names))
        raise RecordError(
            raw.path, f"{PREFIX}.distance: value is missing, allowed one of the columns {there}"
        )
    for key, column in found.items():
        if column.low_pass is not None:
            raise RecordError(
                raw.path,
                f"{PREFIX}.{key}.low_pass: given, allowed measured_track.shortest and longest, in "
                "m of wave",
            )
    return found


def signal_of(raw: RawTable, key: str, column: MeasuredColumn, warnings: list[str]) -> Vector:
    """m, [n]. Raises RecordError for a unit that is missing, and cells without a number."""
    quantity, shown = BY_NAME[key], f"{PREFIX}.{key}"
    place = raw.find(column.name, shown)
    unit = unit_of(raw, place, column, quantity, shown, warnings)
    values = in_si(raw, place, column, unit, quantity)
    empty = ~np.isfinite(values)
    if empty.any() and not empty.all():
        row = int(np.argmax(empty))
        problem = f"{shown}: {empty.sum()} cells without a number, allowed one in each row"
        raise RecordError(raw.path, problem, raw.lines[row])
    check_range(raw, place, values, unit, quantity, shown, warnings)
    return values


def rails_of(path: Path, signals: Mapping[str, Vector]) -> tuple[Vector, Vector, Vector, Vector]:
    """m, of left and right rail, lateral and vertical. Raises RecordError where columns say the
    same twice, or say half."""
    sides = {}
    if not signals:
        raise RecordError(path, f"{PREFIX}: value is distance alone, allowed deviations beside it")
    level = np.zeros(len(next(iter(signals.values()))))
    for axis, (shared, difference, rails) in AXES.items():
        own = [name for name in rails if name in signals]
        mixed = [name for name in (shared, difference) if name in signals]
        if own and mixed:
            raise RecordError(
                path,
                f"{PREFIX}.{mixed[0]}: given with {own[0]}, allowed {' and '.join(rails)}, or "
                f"{shared} and {difference}",
            )
        if len(own) == 1:
            missing = next(name for name in rails if name not in own)
            raise RecordError(
                path, f"{PREFIX}.{missing}: value is missing beside {own[0]}, allowed both rails"
            )
        if own:
            sides[axis] = [signals[name] for name in rails]
        else:
            middle, half = signals.get(shared, level), 0.5 * signals.get(difference, level)
            sides[axis] = [middle - half, middle + half]
    (left_y, right_y), (left_z, right_z) = sides["lateral"], sides["vertical"]
    return left_y, left_z, right_y, right_z


def check_waves(
    path: Path, table: MeasuredTrackTable, usual: float, largest: float, length: float
) -> None:
    """Refuses waves that the rows do not show. Raises RecordError."""
    if table.shortest is not None and table.shortest < LEAST_ROWS * largest:
        raise RecordError(
            path,
            f"measured_track.shortest: value is {table.shortest:g}, allowed >= "
            f"{LEAST_ROWS * largest:.6g} m: rows lie up to {largest:.6g} m apart",
        )
    if table.longest is not None and table.longest > length:
        raise RecordError(
            path,
            f"measured_track.longest: value is {table.longest:g}, allowed <= {length:.6g} m, the "
            "record's length",
        )
    asked = table.shortest or table.longest
    if asked is not None and largest > MOST_UNEVEN * usual:
        raise RecordError(
            path,
            f"measured_track.{'shortest' if table.shortest else 'longest'}: rows lie {usual:.4g} m "
            f"apart and up to {largest:.4g} m, allowed more even ones for a filter, or none",
        )


def filtered(s: Vector, values: Vector, table: MeasuredTrackTable) -> Vector:
    """[n, 4], without waves that are shorter or longer than the table says: Butterworth filters of
    order 2, forward and back over the distance, which shift nothing."""
    found = values.copy()
    for column in found.T:
        if table.longest is not None:
            column -= low_passed(s, column, 1 / table.longest)
        if table.shortest is not None:
            column[:] = low_passed(s, column, 1 / table.shortest)
    return found


def check_moved(path: Path, values: Vector) -> None:
    """Refuses what no track's irregularity is. Raises RecordError."""
    most = np.abs(values).max(axis=0)
    if most.max() > MOST_MOVED:
        axis = ("left lateral", "left vertical", "right lateral", "right vertical")[most.argmax()]
        raise RecordError(
            path,
            f"{axis} is up to {most.max():.4g} m, allowed {MOST_MOVED:g} m: the design's cant and "
            "curves belong to [alignment]; measured_track.longest takes long waves away",
        )
