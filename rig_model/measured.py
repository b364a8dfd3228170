"""A measured run as the programme of a replay: what its record drives, and what is kept beside."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from railpatch.errors import CaseError
from railpatch.record.columns import given
from railpatch.record.doubts import force_doubts, sign_doubts, speed_doubts
from railpatch.record.quantities import BY_NAME, INPUT
from railpatch.record.read import Record, read_record
from railpatch.record.resample import resampled

from rig_model.programme import Position, monotone, polygon
from rig_model.tables import MOST_POSITIONS, MOST_YAW, Rig

Array = NDArray[np.float64]
PREFIX = "rig.columns"
# s, between positions: the log counts in ns
LEAST_STEP = 1e-8
ENDS = ("actuator_left", "actuator_right")


@dataclass(frozen=True)
class Measured:
    """A record that drives a run.

    positions: of the run. start, duration: s, of the record's time. signals: in SI units after
    their filters, at the positions, NaN in gaps. driven: names of what it drives. warnings: of what
    is hardly meant, and of gaps that were bridged.
    """

    record: Record
    positions: list[Position]
    start: float
    duration: float
    signals: dict[str, Array]
    driven: list[str]
    warnings: list[str]

    @cached_property
    def values(self) -> list[dict[str, float]]:
        """By position, what was measured there."""
        return [
            {name: float(v[i]) for name, v in self.signals.items() if math.isfinite(v[i])}
            for i in range(len(self.positions))
        ]

    def text(self) -> str:
        """What was read, in a few lines."""
        beside = [name for name in self.signals if name not in self.driven]
        return (
            f"record        {self.record.path.name}, {len(self.record.at)} rows, from "
            f"{self.start:.6g} s for {self.duration:.6g} s\n"
            f"drives        {', '.join(self.driven) or 'nothing'}\n"
            f"measured      {', '.join(beside) or 'nothing else'}"
        )


@dataclass(frozen=True)
class Rows:
    """The rows of a record: time: s, [n], from the first. progress: -, [n]. signals: filtered."""

    record: Record
    time: Array
    progress: Array
    signals: dict[str, Array]


def measured_run(rig: Rig, case: Any, path: Path) -> Measured:
    """The programme that a record gives, with what [rig] has for what it lacks.

    Raises CaseError.
    """
    columns = given(rig.columns) if rig.columns is not None else None
    record = read_record(path, columns, low_pass=rig.low_pass, prefix=PREFIX)
    rows = rows_of(rig, record)
    check_drives(rig, rows.signals)
    driven = [name for name in rows.signals if BY_NAME[name].role == INPUT]
    start, end = span_of(rows, driven)
    at = times_of(rig, rows, start, end)
    least = float(np.diff(at).min())
    if least < LEAST_STEP:
        raise CaseError(
            f"{path}: positions come {least:.3g} s apart, allowed {LEAST_STEP:g} s or more"
        )
    warnings = [*record.warnings, *force_doubts(record, case.wheelset.vertical_force)]
    warnings += speed_doubts(record, case.track.roller_pitch_rate, case.track.roller_radius)
    warnings += sign_doubts(record)
    warnings += gaps_in(rows, driven, start, end)
    signals = {name: resampled(rows.time, values, at) for name, values in rows.signals.items()}
    whole = replace(rows, signals={name: bridged(rows, name) for name in driven})
    made = positions_of(rig, case, whole, at, start, end)
    return Measured(record, made, start, end - start, signals, driven, warnings)


def rows_of(rig: Rig, record: Record) -> Rows:
    """With the time of each row. Raises CaseError."""
    if record.kind == "distance":
        raise CaseError(f"{PREFIX}.distance: value is given, allowed time or progress on a rig")
    if record.kind == "time":
        if rig.duration is not None:
            raise CaseError(
                f"rig.duration: value is {rig.duration:g}, allowed none: the record has a time"
            )
        time = record.at - record.at[0]
        progress = time / time[-1]
    else:
        if rig.duration is None:
            raise CaseError(
                "rig.duration: value is missing, allowed s, of the run: the record has no time"
            )
        progress, time = record.at, record.at * rig.duration
    return Rows(record, time, progress, record.filtered(time))


def check_drives(rig: Rig, signals: dict[str, Array]) -> None:
    """Each input comes from one place. Raises CaseError with all problems."""
    problems = []
    ends = [name for name in ENDS if name in signals]
    places = {
        "yaw": [*(["the record's yaw"] if "yaw" in signals else []), *(["actuators"] * bool(ends))],
        "lateral_position": ["the record's column"] * ("lateral_position" in signals),
    }
    for key, found in places.items():
        found = [*found, *(["[rig]"] * (getattr(rig, key) is not None))]
        if len(found) != 1:
            shown = " and ".join(found) or "missing"
            problems.append(
                f"rig.{key}: value is {shown}, allowed a column of the record, or rows of progress "
                "in [rig]"
            )
    if len(ends) == 1:
        problems.append(f"{PREFIX}.{ends[0]}: value is given alone, allowed {' and '.join(ENDS)}")
    if bool(ends) != (rig.actuator_distance is not None):
        shown = "given" if not ends else "missing"
        problems.append(
            f"rig.actuator_distance: value is {shown}, allowed with columns {' and '.join(ENDS)}"
        )
    if "speed" in signals and "roller_pitch_rate" in signals:
        problems.append(
            f"{PREFIX}.speed: value is given with roller_pitch_rate, allowed one of them"
        )
    if problems:
        raise CaseError(problems)


def span_of(rows: Rows, driven: list[str]) -> tuple[float, float]:
    """s, from where to where the record has all that it drives."""
    present = [rows.time[np.isfinite(rows.signals[name])] for name in driven] or [rows.time]
    start = max(float(times[0]) for times in present)
    end = min(float(times[-1]) for times in present)
    if not start < end:
        raise CaseError(
            f"{rows.record.path}: {', '.join(driven)} have no two rows in common, allowed a record "
            "in which they overlap"
        )
    return start, end


def times_of(rig: Rig, rows: Rows, start: float, end: float) -> Array:
    """s, of the positions: as many as [rig] says, else those of the record's rows."""
    count = rig.positions
    if rig.rate is not None:
        count = max(2, round((end - start) * rig.rate) + 1)
        if count > MOST_POSITIONS:
            allowed = f"at most {MOST_POSITIONS / (end - start):.4g} over {end - start:.4g} s"
            raise CaseError(f"rig.rate: value is {rig.rate:g}, allowed {allowed}")
    if count is None:
        return rows.time[(rows.time >= start) & (rows.time <= end)]
    return np.linspace(start, end, count)


def gaps_in(rows: Rows, driven: list[str], start: float, end: float) -> list[str]:
    """What is said of gaps in what is driven, and of rows before and after."""
    found = []
    inside = (rows.time >= start) & (rows.time <= end)
    for name in driven:
        present = np.isfinite(rows.signals[name])
        empty = int((inside & ~present).sum())
        if empty:
            longest = float(np.diff(rows.time[present & inside]).max())
            found.append(
                f"{PREFIX}.{name}: {empty} of {int(inside.sum())} rows have no value; straight "
                f"lines bridge them, over {longest:.4g} s at most"
            )
    outside = int((~inside).sum())
    if outside:
        found.append(
            f"{rows.record.path.name}: {outside} rows at its ends lack {' or '.join(driven)} and "
            "are left out"
        )
    return found


def bridged(rows: Rows, name: str) -> Array:
    """[n], with straight lines over gaps."""
    values = rows.signals[name]
    present = np.isfinite(values)
    return np.interp(rows.time, rows.time[present], values[present])


def positions_of(
    rig: Rig, case: Any, rows: Rows, at: Array, start: float, end: float
) -> list[Position]:
    """Of the times (s), which count from the first one in the run."""

    def driven(name: str) -> list[float] | None:
        return (
            np.interp(at, rows.time, rows.signals[name]).tolist() if name in rows.signals else None
        )

    progress = (at - start) / (end - start)
    if rows.record.kind != "time":
        progress = np.interp(at, rows.time, rows.progress)
    yaw = driven("yaw") or by_actuators(rig, rows, at)
    yaw = yaw or polygon(rig.yaw or [], progress)
    lateral = driven("lateral_position") or monotone(rig.lateral_position or [], progress)
    load, rate = driven("vertical_load"), driven("roller_pitch_rate")
    speed = driven("speed")
    if speed is not None:
        rate = [value / case.track.roller_radius for value in speed]
    return [
        Position(
            i,
            float(progress[i]),
            float(at[i] - start),
            lateral[i],
            yaw[i],
            load[i] if load else None,
            math.copysign(rate[i], case.track.roller_pitch_rate) if rate else None,
        )
        for i in range(len(at))
    ]


def by_actuators(rig: Rig, rows: Rows, at: Array) -> list[float] | None:
    """rad, by the axle's ends, ``actuator_distance`` apart: the left one is ahead for yaw > 0."""
    if ENDS[0] not in rows.signals:
        return None
    left, right = (np.interp(at, rows.time, rows.signals[name]) for name in ENDS)
    sine = (left - right) / rig.actuator_distance
    largest = float(np.abs(sine).max())
    if largest > MOST_YAW:
        raise CaseError(
            f"{PREFIX}.actuator_left: value is {largest:.4g} of actuator_distance ahead of the "
            f"right one at most, allowed -{MOST_YAW} to {MOST_YAW}"
        )
    return np.arcsin(sine).tolist()
