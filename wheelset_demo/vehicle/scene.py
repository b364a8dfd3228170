"""The scene of a vehicle run: a case file of kind "wheelset" with vehicle, suspension and track."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import Field, model_validator
from railpatch.case.load import check_table
from railpatch.case.types import NotNegative, Number, Positive, Table, exactly, relation
from railpatch.errors import CaseError
from railpatch.log.stream import SCENE_RATE

from wheelset_demo.scene import (
    GRAVITY,
    SNAPSHOTS,
    RunScene,
    check_kind,
    check_present,
    load_checked,
    scene_file,
    start_problems,
    track_problems,
)
from wheelset_demo.vehicle.alignment import AlignmentTable
from wheelset_demo.vehicle.irregularity import IrregularityTable

DEFAULT = "vehicle_curve.toml"
# found at the start, or no part of a scene that runs on its own track
FOUND = ("y", "yaw", "roll", "vy", "vz", "roll_rate", "yaw_rate", "pitch_rate")
WHEELSETS = 4
BOXES = 2 * WHEELSETS
# m, of track: its record takes some 0.2 GB
LONGEST = 1e5
Triple = Annotated[list[NotNegative], exactly(3)]
NONE = [0.0, 0.0, 0.0]
# kg: railway vehicles from a narrow-gauge tram to a loaded freight wagon
PLAUSIBLE = {
    "car_body": (3e3, 1.2e5),
    "bogie_frame": (300.0, 2e4),
    "wheelset": (300.0, 5e3),
    "axle_box": (10.0, 1e3),
}


class BodyTable(Table):
    """A rigid body."""

    mass: Positive = Field(description="kg")
    inertia: Annotated[list[Positive], exactly(3)] = Field(
        description="kg m^2, about x, y, z through its centre"
    )


class HighBodyTable(BodyTable):
    """A rigid body above the rails."""

    height: Positive = Field(description="m, of its centre above the rails' tops")


class AxleBoxTable(BodyTable):
    """A body that pitches about the end of an axle."""

    lateral: Positive = Field(description="m, of its centre from the vehicle's middle")


def doubtful_bodies(scene: VehicleScene) -> list[str]:
    """Warnings of bodies whose mass no railway vehicle has."""
    found = []
    for name, (low, high) in PLAUSIBLE.items():
        mass = getattr(scene.vehicle, name).mass
        if not low <= mass <= high:
            found.append(f"vehicle.{name}.mass is {mass:g} kg, outside {low:g} to {high:g} kg")
    return found


class VehicleTable(Table):
    """Bodies of a vehicle with two bogies of two wheelsets; it is symmetric."""

    bogie_distance: Positive = Field(description="m, between the bogies' centres")
    wheelbase: Positive = Field(description="m, between the wheelsets of a bogie")
    car_body: HighBodyTable = Field(description="the car body")
    bogie_frame: HighBodyTable = Field(description="each bogie frame")
    wheelset: BodyTable = Field(description="each wheelset, spinning about y")
    axle_box: AxleBoxTable = Field(description="each of two axle boxes of a wheelset")

    @model_validator(mode="after")
    def _round(self) -> VehicleTable:
        roll, _, yaw = self.wheelset.inertia
        if roll != yaw:
            raise relation("wheelset.inertia", self.wheelset.inertia, "equal ones about x and z")
        return self

    @property
    def length(self) -> float:
        """m, between the first and the last wheelset."""
        return self.bogie_distance + self.wheelbase

    @property
    def mass(self) -> float:
        """kg, of all."""
        boxes = BOXES * self.axle_box.mass
        return (
            self.car_body.mass + 2 * self.bogie_frame.mass + WHEELSETS * self.wheelset.mass + boxes
        )


class ElementTable(Table):
    """Springs and dampers at one kind of place; axes are those of the bogie frame."""

    name: str = Field(description="(no unit): for messages")
    level: Literal["primary", "secondary", "centre"] = Field(
        description="(no unit): at each axle box to the bogie frame, at each side of a bogie to "
        "the car body, in the middle of a bogie to the car body"
    )
    height: Positive = Field(description="m, above the rails' tops")
    lateral: NotNegative = Field(default=0.0, description="m, from the vehicle's middle")
    longitudinal: Number = Field(
        default=0.0,
        description="m, of primary elements from the wheelset away from the bogie's middle; of "
        "secondary ones from the bogie's middle, > 0 ahead on the right side and behind on the "
        "left one; of those in the centre ahead",
    )
    stiffness: Triple = Field(default=NONE, description="N/m, along x, y, z")
    damping: Triple = Field(default=NONE, description="N s/m, along x, y, z")
    series_stiffness: Triple = Field(
        default=NONE, description="N/m, in series with each damper; 0: none"
    )
    turning_stiffness: Triple = Field(default=NONE, description="N m/rad, about x, y, z")
    turning_damping: Triple = Field(default=NONE, description="N m s/rad, about x, y, z")
    bump_stop: Annotated[list[Annotated[list[Number], exactly(2)]], Field(min_length=2)] | None = (
        Field(default=None, description="[m, N], lateral force over displacement, point symmetric")
    )

    @model_validator(mode="after")
    def _possible(self) -> ElementTable:
        if self.level == "centre" and self.lateral != 0:
            raise relation("lateral", self.lateral, "0 in the middle of a bogie")
        if self.level != "centre" and self.lateral == 0:
            wanted = f"> 0 for a {self.level} element: there is one at each side"
            raise relation("lateral", self.lateral, wanted)
        if any(s > 0 and c == 0 for s, c in zip(self.series_stiffness, self.damping, strict=True)):
            raise relation("series_stiffness", self.series_stiffness, "0 where damping is 0")
        if self.bump_stop is not None:
            places = [row[0] for row in self.bump_stop]
            if places[0] < 0 or any(b <= a for a, b in pairwise(places)):
                raise relation("bump_stop", places, "displacements >= 0 that increase")
            forces = [row[1] for row in self.bump_stop]
            if forces[0] != 0 or any(b < a for a, b in pairwise(forces)) or not forces[-1] > 0:
                raise relation(
                    "bump_stop", forces, "forces from 0 on that do not fall, at last > 0"
                )
        return self


class RunTable(Table):
    """How long, with which steps, and what is kept."""

    duration: Annotated[float, Field(gt=0, le=1e5)] = Field(description="s, to run")
    step: Annotated[float, Field(ge=1e-6, le=0.1)] = Field(default=1e-3, description="s")
    derivatives_every: Annotated[int, Field(ge=1, le=100_000)] = Field(
        default=100, description="-, steps between new derivatives, at most"
    )
    log_every: Annotated[int, Field(ge=1)] = Field(
        default=5, description="-, every n-th step is kept"
    )
    write_rate: Annotated[float, Field(gt=0, le=1e9)] | None = Field(
        default=None,
        description="Hz, kept steps written to a log a second of simulation time, at most; left "
        "out: all",
    )
    scene_rate: Annotated[float, Field(ge=0, le=1e9)] = Field(
        default=SCENE_RATE, description="Hz, 3D scenes of these, at most; 0: none"
    )
    snapshot_rate: Annotated[float, Field(ge=0, le=1e9)] | None = Field(
        default=None,
        description=f"Hz, fields of these, at most; 0: none; left out: {SNAPSHOTS} a run",
    )
    threads: Annotated[int, Field(ge=1, le=64)] = Field(
        default=1, description="-, that solve the wheelsets' contacts side by side"
    )
    shift_factor: Annotated[float, Field(gt=0, le=2)] = Field(
        default=1.0,
        description="-, k of the limit k (10 kN + P0/3) of a wheelset's sum of Y, which the "
        "summary states; EN 14363 has 0.85 for freight wagons (from memory)",
    )
    speed_control: NotNegative = Field(
        default=1e4, description="N s/m, of the force that holds the car body at the speed"
    )


TABLES: dict[str, type[Table]] = {
    "vehicle": VehicleTable,
    "alignment": AlignmentTable,
    "irregularity": IrregularityTable,
    "run": RunTable,
}
OPTIONAL = ("alignment", "irregularity")


@dataclass(frozen=True, kw_only=True)
class VehicleScene(RunScene):
    """A vehicle's scene. irregularity: None for straight rails."""

    vehicle: VehicleTable
    suspension: tuple[ElementTable, ...]
    alignment: AlignmentTable
    irregularity: IrregularityTable | None
    run: RunTable

    @property
    def steps(self) -> int:
        """Number of time steps."""
        return max(1, round(self.run.duration / self.run.step))

    @property
    def length(self) -> float:
        """m, of the track that is run on, with some to spare."""
        return track_length(self.speed, self.run, self.vehicle)

    @property
    def axle_load(self) -> float:
        """N, of each wheelset at rest."""
        return self.vehicle.mass * GRAVITY / WHEELSETS

    def with_method(self, **method: Any) -> VehicleScene:
        """With some keys of [method] changed; None takes [grid] away for grid."""
        grid = method.pop("grid", ...)
        update: dict[str, Any] = {"method": self.case.method.model_copy(update=method)}
        if grid is not ...:
            update["grid"] = grid
        return replace(self, case=self.case.model_copy(update=update))

    def with_run(self, **keys: Any) -> VehicleScene:
        """With some keys of [run] changed. Raises CaseError."""
        given = {key: value for key, value in keys.items() if value is not None}
        return replace(self, run=check_table(RunTable, {**self.run.model_dump(), **given}, "run"))


def track_length(speed: float, run: RunTable, vehicle: VehicleTable) -> float:
    """m, that a run asks for, with some to spare. speed: m/s."""
    return 1.2 * speed * run.duration + vehicle.length + 100.0


def load_vehicle_scene(
    path: str | Path | None = None, overrides: Mapping[str, Any] | None = None
) -> VehicleScene:
    """Checks a scene; without ``path`` that of the package.

    overrides: keys of [run] that replace the file's. Relative paths of profiles start beside the
    file. Raises CaseError with every problem.
    """
    path = scene_file(DEFAULT) if path is None else Path(path)
    checks = {name: partial(checked_table, name) for name in TABLES}
    checks["suspension"] = checked_elements
    return load_checked(path, "vehicle", checks, check_run, VehicleScene, overrides)


def checked_table(name: str, table: Any) -> Any:
    """One table of the scene, by name. Raises CaseError."""
    if table is None and name in OPTIONAL:
        return AlignmentTable() if name == "alignment" else None
    return check_present(name, TABLES[name], table)


def checked_elements(elements: Any) -> tuple[ElementTable, ...]:
    """The list [[suspension]]. Raises CaseError."""
    if not isinstance(elements, list) or not elements:
        raise CaseError("suspension: value is missing, allowed a list of [[suspension]] tables")
    found = tuple(
        check_table(ElementTable, element, f"suspension[{index}]")
        for index, element in enumerate(elements)
    )
    for level in ("primary", "secondary"):
        if not any(e.level == level and e.stiffness[2] > 0 for e in found):
            raise CaseError(
                f"suspension: no element of level {level!r} has a vertical stiffness, allowed one "
                "or more: they carry the weight"
            )
    return found


def check_run(
    case: Any, run: RunTable, alignment: AlignmentTable, vehicle: VehicleTable, **_: Any
) -> None:
    """Refuses cases that are no wheelset with friction, a start in a curve. Raises CaseError."""
    check_kind(case, "vehicle")
    wheelset, problems = case.wheelset, track_problems(case, ": see [alignment]")
    if case.track.irregularity is not None:
        problems.append("track.irregularity: given, allowed in a vehicle run [irregularity]")
    if not wheelset.speed > 0:
        problems.append(f"wheelset.speed: value is {wheelset.speed}, allowed > 0 m/s")
    if run.duration < run.step or run.duration / run.step > 1e7:
        problems.append(f"run.step: value is {run.step}, allowed 1 to 1e7 steps in the duration")
    length = track_length(wheelset.speed, run, vehicle)
    if length > LONGEST:
        problems.append(
            f"run.duration: value is {run.duration}, which is {length:.6g} m of track, allowed <= "
            f"{LONGEST:.6g} m"
        )
    if wheelset.z is None:
        problems.append("wheelset.vertical_force: given, allowed 'z' = 0: the vehicle is its load")
    key, straight = alignment.start
    if straight < vehicle.length:
        problems.append(
            f"alignment.{key}: value is {straight}, allowed >= {vehicle.length:.6g} "
            "m, the vehicle's length: it starts on straight track"
        )
    problems += start_problems(case, FOUND, "the vehicle starts in the middle")
    if problems:
        raise CaseError(problems)
