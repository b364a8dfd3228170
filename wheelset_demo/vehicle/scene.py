"""The scene of a vehicle run: a case file of kind "wheelset" with vehicle and track."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Annotated, Any

from pydantic import Field
from railpatch.case.load import Scene, check_case, check_table
from railpatch.case.track import Irregularity
from railpatch.case.types import NotNegative, Table, show
from railpatch.case.wheel import WheelsetCase
from railpatch.errors import CaseError
from railpatch.log.stream import SCENE_RATE

from wheelset_demo.scene import (
    GRAVITY,
    SNAPSHOTS,
    RunScene,
    check_kind,
    check_present,
    file_of,
    found_profiles,
    load_checked,
    scene_file,
    start_problems,
    track_problems,
    wear_problems,
)
from wheelset_demo.vehicle.alignment import AlignmentTable
from wheelset_demo.vehicle.bodies import Axle, VehicleTable
from wheelset_demo.vehicle.comfort import LONGEST_STEP, ComfortTable
from wheelset_demo.vehicle.deviations import DipTable
from wheelset_demo.vehicle.irregularity import IrregularityTable
from wheelset_demo.vehicle.measured_track import (
    MeasuredTrack,
    MeasuredTrackTable,
    read_measured,
)
from wheelset_demo.vehicle.support import SupportTable
from wheelset_demo.vehicle.wet_track import WetTable, wet_problems

DEFAULT = "vehicle_curve.toml"
# found at the start, or no part of a scene that runs on its own track
FOUND = ("y", "yaw", "roll", "vy", "vz", "roll_rate", "yaw_rate", "pitch_rate")
# m, of track: its record takes some 0.2 GB
LONGEST = 1e5


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
    damage_every: Annotated[int, Field(ge=1, le=100_000)] = Field(
        default=10, description="-, every n-th step's wear counts, for the way since; of [damage]"
    )
    speed_control: NotNegative = Field(
        default=1e4, description="N s/m, of the force that holds the body of reference at the speed"
    )


TABLES: dict[str, type[Table]] = {
    "vehicle": VehicleTable,
    "alignment": AlignmentTable,
    "irregularity": IrregularityTable,
    "support": SupportTable,
    "measured_track": MeasuredTrackTable,
    "comfort": ComfortTable,
    "run": RunTable,
}
# lists of tables, none of which is needed
LISTS: dict[str, type[Table]] = {"dip": DipTable, "wet": WetTable}
# all of them, as a file has them
OWN: dict[str, Any] = {**TABLES, **{name: list[table] for name, table in LISTS.items()}}  # type: ignore[valid-type]
OPTIONAL = ("alignment", "irregularity", "support", "measured_track", "comfort")


@dataclass(frozen=True, kw_only=True)
class VehicleScene(RunScene):
    """A vehicle's scene. irregularity: None for straight rails. dip: dipped joints. support: None
    for rails on rigid ground. measured_track: the record that measured is read from.
    comfort: None where it is not asked for. wet: stretches with another supply of liquid."""

    vehicle: VehicleTable
    alignment: AlignmentTable
    irregularity: IrregularityTable | None
    run: RunTable
    dip: tuple[DipTable, ...] = ()
    support: SupportTable | None = None
    measured_track: MeasuredTrackTable | None = None
    measured: MeasuredTrack | None = None
    comfort: ComfortTable | None = None
    wet: tuple[WetTable, ...] = ()

    @property
    def recorded(self) -> Irregularity | None:
        """The rails of the record, from where the vehicle stands at the start on. Raises
        RecordError where it is too short for the run."""
        if self.measured is None or self.measured_track is None:
            return None
        begins = self.measured_track.begins
        return self.measured.rails(self.vehicle.length, begins, self.way)

    @property
    def way(self) -> float:
        """m, from the last wheelset at the start to the first at the end, at the start's speed."""
        return self.speed * self.run.duration + self.vehicle.length

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
        """N, of a wheelset at rest, the mean of all."""
        return self.vehicle.mass * GRAVITY / len(self.vehicle.axles)

    def case_of(self, axle: Axle) -> WheelsetCase:
        """The contact of a wheelset."""
        return axle.table.case_of(self.case)

    def cases(self, derivatives: bool = False) -> list[Scene]:
        """Of all wheelsets, from the front, with z prescribed; those that are alike share one."""
        made: dict[int, Scene] = {}
        for axle in self.vehicle.axles:
            if id(axle.table) not in made:
                one = replace(self, case=self.case_of(axle))
                made[id(axle.table)] = one.at_height(derivatives)
        return [made[id(axle.table)] for axle in self.vehicle.axles]

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
    checks |= {name: partial(checked_list, name) for name in LISTS}
    scene = load_checked(path, "vehicle", checks, check_run, VehicleScene, overrides, OWN)
    scene = with_own_profiles(scene, path.parent)
    table = scene.measured_track
    if table is None:
        return scene
    return replace(scene, measured=read_measured(table, path.parent, scene.way))


def with_own_profiles(scene: VehicleScene, folder: Path) -> VehicleScene:
    """With the files of wheelsets' own profiles found. Raises CaseError."""
    tables, profiles, problems = [], dict(scene.profiles), []
    for k, table in enumerate(scene.vehicle.wheelset):
        if table.profiles is None:
            tables.append(table)
            continue
        found = found_profiles(table.case_of(scene.case), folder)
        own = {key: found[key] for key in table.profiles.model_dump(exclude_none=True)}
        profiles |= {f"wheelset_{k}.{key}": name for key, name in own.items()}
        named = table.profiles.model_copy(update=own)
        tables.append(table.model_copy(update={"profiles": named}))
        try:
            check_case(tables[-1].case_of(scene.case).model_dump())
        except CaseError as error:
            problems += [f"vehicle.wheelset[{k}]: {text}" for text in error.problems]
    if problems:
        raise CaseError(problems)
    vehicle = scene.vehicle.model_copy(update={"wheelset": tables})
    return replace(scene, vehicle=vehicle, profiles=profiles)


def checked_table(name: str, table: Any) -> Any:
    """One table of the scene, by name. Raises CaseError."""
    if table is None and name in OPTIONAL:
        return AlignmentTable() if name == "alignment" else None
    return check_present(name, TABLES[name], table, OWN)


def comfort_problems(comfort: ComfortTable, run: RunTable, vehicle: VehicleTable) -> list[str]:
    """Of points on bodies that are not there, and of steps too long for the filters."""
    names = [body.name for body in vehicle.bodies]
    found = [
        f"comfort.point[{index}].body: value is {point.body!r}, allowed {', '.join(names)}"
        for index, point in enumerate(comfort.point)
        if point.body is not None and point.body not in names
    ]
    if run.step > LONGEST_STEP:
        found.append(
            f"run.step: value is {run.step}, allowed <= {LONGEST_STEP:g} s with [comfort], whose "
            "filters reach to 100 Hz"
        )
    if not comfort.start < run.duration:
        found.append(
            f"comfort.start: value is {comfort.start}, allowed < run.duration ({run.duration} s)"
        )
    return found


def checked_list(name: str, tables: Any) -> tuple[Any, ...]:
    """A list of tables, [[dip]] or [[wet]]; none where it is left out. Raises CaseError."""
    if tables is None:
        return ()
    kind = LISTS[name]
    if not isinstance(tables, list):
        keys = ", ".join(kind.model_fields)
        raise CaseError(
            f"{name}: value is {show(tables)}, allowed a list of [[{name}]] tables, with the keys "
            f"{keys}"
        )
    return tuple(
        check_table(kind, one, f"{name}[{index}]", among=file_of(OWN))
        for index, one in enumerate(tables)
    )


def check_run(
    case: Any,
    run: RunTable,
    alignment: AlignmentTable,
    vehicle: VehicleTable,
    dip: tuple[DipTable, ...] = (),
    support: SupportTable | None = None,
    irregularity: IrregularityTable | None = None,
    measured_track: MeasuredTrackTable | None = None,
    comfort: ComfortTable | None = None,
    wet: tuple[WetTable, ...] = (),
    **_: Any,
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
    problems += wear_problems(case, run)
    if comfort is not None:
        problems += comfort_problems(comfort, run, vehicle)
    if irregularity is not None and measured_track is not None:
        problems.append("measured_track: given with [irregularity], allowed one of them")
    if support is not None and case.track.rail_support is not None:
        problems.append("track.rail_support: given, allowed to be left out beside [support]")
    for index, one in enumerate(dip):
        first = one.position - 0.5 * one.length
        if not first >= vehicle.length:
            problems.append(
                f"dip[{index}].position: value is {one.position}, allowed >= "
                f"{vehicle.length + 0.5 * one.length:.6g} m: the vehicle starts on level rails"
            )
    problems += wet_problems(wet, case.fluid)
    key, straight = alignment.start
    if straight < vehicle.length:
        problems.append(
            f"alignment.{key}: value is {straight}, allowed >= {vehicle.length:.6g} "
            "m, the vehicle's length: it starts on straight track"
        )
    problems += start_problems(case, FOUND, "the vehicle starts in the middle")
    if problems:
        raise CaseError(problems)
