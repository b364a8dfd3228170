"""The table [rig] of a scene: what the rig does with the wheelset."""

from __future__ import annotations

from itertools import pairwise
from typing import Annotated, Literal

from pydantic import Field, model_validator
from railpatch.case.types import Number, Pair, Positive, Problems, Table, refuse, relation
from railpatch.record.columns import Columns

# snapshots of the fields in a run whose scene does not say
SNAPSHOTS = 12
MOST_POSITIONS = 10_000_000
# rad, either way
MOST_YAW = 0.1

Rows = Annotated[list[Pair], Field(min_length=2)]


class Start(Table):
    """Where the search for the first balance starts, in place of the frictionless estimate."""

    z: Number = Field(description="m, vertical position of the wheelset's centre, down")
    roll: Number = Field(description="rad, about x")
    pitch_rate: Number = Field(description="rad/s, about the axle; below 0 for rolling forward")


class BalanceTable(Table):
    """How the balance is searched."""

    method: Literal["broyden", "newton"] = Field(
        default="broyden",
        description="(no unit): broyden, as in the set-up of NRC's machine; newton, with exact "
        "derivatives of the contact forces",
    )
    axle_torque: Literal["track", "wheelset"] = Field(
        default="wheelset",
        description="what balances about the axle (no unit): the moment of all contact forces (a "
        "free axle, the report's Eq. 51; with patch_rule = contact the longitudinal forces in "
        "wheelset axes), or the longitudinal forces in track axes with the part of the normal "
        "force along x, as in the published positions of the NRC run",
    )
    tolerance: Annotated[float, Field(ge=1e-8, le=1e-2)] = Field(
        default=5e-5,
        description="-, largest residual over the vertical load (moments: N m over N times 1 m); "
        "at least twice method.tolerance",
    )
    max_evaluations: Annotated[int, Field(ge=4, le=1000)] = Field(
        default=40, description="-, most evaluations of both wheels at one position"
    )


class FrameTable(Table):
    """What yields between the lateral actuators and the wheelset, and between the rollers."""

    stiffness: Positive | None = Field(
        default=None, description="N/m, of actuators and arms; or stiffness_table"
    )
    stiffness_table: Rows | None = Field(
        default=None,
        description="m, N: rows of deflection and resisting force, both rising, straight lines "
        "between, the first and the last go on beyond",
    )
    friction: list[Pair] | None = Field(
        default=None,
        description="N/m, N: rows of stiffness and limit, of springs with a dry slider each "
        "(Jenkins elements), parallel to the spring",
    )
    gauge_stiffness: Positive | None = Field(
        default=None,
        description="N/m, of a spring between the rollers, which the wheels spread: each gives way "
        "by half of what the gauge opens; left out: rigid",
    )

    @property
    def is_lateral(self) -> bool:
        """Whether the wheelset moves against its actuators."""
        return self.stiffness is not None or self.stiffness_table is not None

    @model_validator(mode="after")
    def _relations(self) -> FrameTable:
        if self.stiffness is not None and self.stiffness_table is not None:
            shown = "given with 'stiffness_table'"
            raise relation("stiffness", shown, "exactly one of 'stiffness', 'stiffness_table'")
        if not self.is_lateral and (self.gauge_stiffness is None or self.friction):
            allowed = "exactly one of 'stiffness', 'stiffness_table', or 'gauge_stiffness' alone"
            raise relation("stiffness", "missing", allowed)
        for first, second in pairwise(self.stiffness_table or ()):
            if first[0] >= second[0] or first[1] >= second[1]:
                raise relation("stiffness_table", [first, second], "deflections and forces rising")
        for row in self.friction or ():
            if min(row) <= 0:
                raise relation("friction", row, "a stiffness and a limit above 0")
        return self


class ConditioningTable(Table):
    """Friction that the work done on a running band changes."""

    plateau: Annotated[float, Field(ge=0, le=10)] = Field(
        description="-, friction of a band on which much work was done, over that of the scene, "
        "which a band has as it is found"
    )
    work: Positive = Field(
        description="J/m, friction work over the band's width after which 1 - 1/e of the change is "
        "done",
    )
    recovery_time: Positive | None = Field(
        default=None,
        description="s, after which a band without contact has lost 1 - 1/e of its change; left "
        "out: time takes none",
    )
    recovery_work: Positive | None = Field(
        default=None,
        description="J, friction work of the wheel beside a band after which that has lost 1 - 1/e "
        "of its change; left out: none",
    )
    body: Literal["wheel", "roller"] = Field(
        default="wheel", description="(no unit): whose profile the bands lie on"
    )
    bin: Annotated[float, Field(ge=1e-5, le=0.05)] = Field(
        default=5e-4, description="m, width of the strips that a profile is divided into"
    )


# of a drift, at knots
Values = Annotated[list[Number], Field(min_length=1, max_length=20)]
MOST_DRIFT = 0.1  # m, rad, either way


class DriftTable(Table):
    """Offsets of what drives the rig that change slowly over the run."""

    yaw: Values | None = Field(
        default=None,
        description="rad, added to the yaw angle: at evenly spaced moments of the progress, from "
        "begin to end, a natural cubic spline between; one: all the time; left out: none",
    )
    lateral_position: Values | None = Field(
        default=None, description="m, added to the lateral position: likewise"
    )

    @model_validator(mode="after")
    def _sizes(self) -> DriftTable:
        if self.yaw is None and self.lateral_position is None:
            raise relation("yaw", "missing", "'yaw', 'lateral_position' or both")
        for key in ("yaw", "lateral_position"):
            for value in getattr(self, key) or ():
                if abs(value) > MOST_DRIFT:
                    raise relation(key, value, f"-{MOST_DRIFT} to {MOST_DRIFT}")
        return self


class OffsetTable(Table):
    """What is added to what drives the rig, all the time."""

    y: Annotated[float, Field(ge=-MOST_DRIFT, le=MOST_DRIFT)] = Field(
        default=0.0, description="m, added to the lateral position"
    )
    yaw: Annotated[float, Field(ge=-MOST_DRIFT, le=MOST_DRIFT)] = Field(
        default=0.0, description="rad, added to the yaw angle"
    )


class Rig(Table):
    """What the rig does with the wheelset."""

    yaw: Rows | None = Field(
        default=None,
        description="-, rad: rows of progress (0 to 1) and yaw angle, straight lines between; "
        "needed where no record has it",
    )
    lateral_position: Rows | None = Field(
        default=None,
        description="-, m: rows of progress (0 to 1) and lateral position, monotone between; "
        "needed where no record has it",
    )
    duration: Positive | None = Field(
        default=None, description="s, of the run; needed where no record has a time"
    )
    positions: Annotated[int, Field(ge=2, le=MOST_POSITIONS)] | None = Field(
        default=None,
        description="-, number of positions, evenly spaced in time; or rate; with a "
        "record left out: its rows",
    )
    rate: Positive | None = Field(default=None, description="Hz, positions per second")
    snapshot_every: Annotated[int, Field(ge=0)] | None = Field(
        default=None,
        description="-, the fields of every n-th position are logged, 0: none; left out: of some "
        f"{SNAPSHOTS} positions",
    )
    start: Start | None = Field(
        default=None, description="first estimate (m, rad, rad/s); left out: without friction"
    )
    balance: BalanceTable = Field(default=BalanceTable(), description="search for the balance (-)")
    frame: FrameTable | None = Field(
        default=None,
        description="springs and dry friction between the lateral actuators and the wheelset, "
        "between the rollers (N/m, N): lateral_position is that of the actuators then; left out: "
        "rigid",
    )
    conditioning: ConditioningTable | None = Field(
        default=None,
        description="friction of each wheel that changes with the work done where it runs (-, J/m, "
        "J, s, m); left out: none",
    )
    offset: OffsetTable | None = Field(
        default=None,
        description="added to lateral position and yaw angle, recorded or not (m, rad); left out: "
        "nothing",
    )
    drift: DriftTable | None = Field(
        default=None,
        description="offsets of yaw angle and lateral position over the run (rad, m); left out: "
        "none",
    )
    record: str | None = Field(
        default=None,
        description="(no unit), file of a measured run, which drives the replay and is kept beside "
        "it: columns with commas, semicolons, tabs or blanks between",
    )
    columns: Columns | None = Field(  # type: ignore[valid-type]
        default=None, description="which column of the record is what, with its unit"
    )
    low_pass: Positive | None = Field(
        default=None,
        description="Hz, cut-off of a filter without delay for all of the record; left out: none",
    )
    actuator_distance: Positive | None = Field(
        default=None, description="m, between the ends of actuator_left and actuator_right"
    )

    @property
    def count(self) -> int:
        """Number of positions, of a run without a record."""
        if self.positions is not None:
            return self.positions
        assert self.rate is not None
        assert self.duration is not None
        return max(2, round(self.duration * self.rate) + 1)

    @model_validator(mode="after")
    def _relations(self) -> Rig:
        for key in ("yaw", "lateral_position"):
            if getattr(self, key) is not None:
                check_progress(key, [row[0] for row in getattr(self, key)])
        both = self.positions is not None and self.rate is not None
        if both or (self.record is None and self.positions is None and self.rate is None):
            shown = "given with 'rate'" if both else "missing"
            raise relation("positions", shown, "exactly one of 'positions', 'rate'")
        if self.rate is not None and not 1 <= (self.duration or 1 / self.rate) * self.rate <= 1e7:
            raise relation("rate", self.rate, "1 to 1e7 positions in the duration")
        for progress, angle in self.yaw or ():
            if abs(angle) > MOST_YAW:
                raise relation("yaw", f"{angle} at {progress}", f"-{MOST_YAW} to {MOST_YAW} rad")
        if self.record is None:
            refuse(self._without_record())
        return self

    def _without_record(self) -> Problems:
        for key in ("yaw", "lateral_position", "duration"):
            if getattr(self, key) is None:
                text = str(type(self).model_fields[key].description)
                yield relation(key, "missing", text.partition(";")[0])
        for key in ("columns", "low_pass", "actuator_distance"):
            if getattr(self, key) is not None:
                yield relation(key, "given", "none without 'record'")


def check_progress(key: str, progress: list[float]) -> None:
    """Refuses a table whose first column does not rise from 0 to 1."""
    rises = all(a < b for a, b in pairwise(progress))
    if not rises or progress[0] != 0 or progress[-1] != 1:
        raise relation(key, f"a first column of {progress}", "progress rising from 0 to 1")
