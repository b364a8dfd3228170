"""The scene of a wheelset run: a case file of kind "wheelset" with body, suspension and run."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial
from importlib import resources
from pathlib import Path
from typing import Annotated, Any, Literal, TypeVar

from pydantic import Field, model_validator
from railpatch.case import WheelsetCase
from railpatch.case.common import without_friction
from railpatch.case.load import Scene, check_case, check_table, plain, read_toml, refuse_others
from railpatch.case.rolling import place_problems
from railpatch.case.scene_profiles import find_sections
from railpatch.case.types import NotNegative, Positive, Table, relation
from railpatch.case.wheel import PROFILE_KEYS
from railpatch.errors import CaseError
from railpatch.log.stream import SCENE_RATE

DEFAULT = "s1002.toml"
Loaded = TypeVar("Loaded")
# snapshots of the fields in a run whose scene does not say
SNAPSHOTS = 10
GRAVITY = 9.81  # m/s^2
# found at the start, so not to be given
FOUND = ("roll", "vy", "vz", "roll_rate", "yaw_rate", "pitch_rate")


class BodyTable(Table):
    """The rigid wheelset, and what its axle boxes carry along without spinning."""

    mass: Positive = Field(description="kg, of the spinning wheelset")
    roll_inertia: Positive = Field(description="kg m^2, about any diameter (x, z)")
    pitch_inertia: Positive = Field(description="kg m^2, about the axle")
    carrier_mass: Positive | None = Field(
        default=None, description="kg, of the axle boxes; left out: none"
    )
    carrier_inertia: Positive | None = Field(
        default=None, description="kg m^2, of the axle boxes about x and z"
    )

    @model_validator(mode="after")
    def _carrier(self) -> BodyTable:
        if (self.carrier_mass is None) != (self.carrier_inertia is None):
            raise relation("carrier_mass", self.carrier_mass, "only with 'carrier_inertia'")
        return self

    @property
    def total_mass(self) -> float:
        """kg."""
        return self.mass + (self.carrier_mass or 0.0)


class Coefficients(Table):
    """Of springs or dampers."""

    x: NotNegative = Field(default=0.0, description="N/m or N s/m, along the track")
    y: NotNegative = Field(default=0.0, description="N/m or N s/m, lateral")
    z: NotNegative = Field(default=0.0, description="N/m or N s/m, vertical")
    roll: NotNegative = Field(default=0.0, description="N m/rad or N m s/rad, about x")
    yaw: NotNegative = Field(default=0.0, description="N m/rad or N m s/rad, about z")


class SuspensionTable(Table):
    """Primary suspension to a frame that moves on at the speed of the start."""

    stiffness: Coefficients = Field(
        default=Coefficients(), description="of the springs (N/m, N m/rad)"
    )
    damping: Coefficients = Field(
        default=Coefficients(), description="of the dampers (N s/m, N m s/rad)"
    )

    @model_validator(mode="after")
    def _drawn(self) -> SuspensionTable:
        if not self.stiffness.x > 0:
            raise relation("stiffness.x", self.stiffness.x, "> 0: it draws the wheelset along")
        return self


class Run(Table):
    """How far, with which steps, and what is logged."""

    distance: Annotated[float, Field(gt=0, le=1e6)] = Field(description="m, to run")
    step: Annotated[float, Field(ge=1e-6, le=0.1)] = Field(description="s, time step")
    stepper: Literal["rk4", "ros2"] = Field(
        default="ros2",
        description="(no unit): rk4, explicit, Runge-Kutta of order 4; ros2, linearly implicit, "
        "Rosenbrock of order 2",
    )
    derivatives: Literal["exact", "differences"] = Field(
        default="exact",
        description="(no unit): derivatives of the accelerations (ros2), from those of the contact "
        "or by differences of a dozen evaluations",
    )
    derivatives_every: Annotated[int, Field(ge=1, le=100_000)] = Field(
        default=25, description="-, steps between new derivatives (ros2)"
    )
    log_every: Annotated[int, Field(ge=1)] = Field(
        default=10, description="-, every n-th step is logged"
    )
    snapshot_every: Annotated[int, Field(ge=0)] | None = Field(
        default=None,
        description="-, the fields of every n-th logged step are written, 0: none; left out: of "
        f"some {SNAPSHOTS} steps",
    )
    write_rate: Annotated[float, Field(gt=0, le=1e9)] | None = Field(
        default=None,
        description="Hz, logged steps written to the file a second of simulation time, at most; "
        "left out: all",
    )
    scene_rate: Annotated[float, Field(ge=0, le=1e9)] = Field(
        default=SCENE_RATE,
        description="Hz, 3D scenes logged a second of simulation time, at most those of the logged "
        "steps; 0: none",
    )

    damage_every: Annotated[int, Field(ge=1, le=100_000)] = Field(
        default=10, description="-, every n-th step's wear counts, for the way since; of [damage]"
    )

    @property
    def exact(self) -> bool:
        """Whether the contact's derivatives are asked for."""
        return self.stepper == "ros2" and self.derivatives == "exact"


MODELS: dict[str, type[Table]] = {"body": BodyTable, "suspension": SuspensionTable, "run": Run}


@dataclass(frozen=True, kw_only=True)
class RunScene:
    """What the checked scenes of all runs have.

    name: of the file. text: as it was read. case: the contact of each wheelset. profiles: key of
    [profiles] -> the file found, or the built-in name; key of a section -> its file.
    """

    name: str
    text: bytes
    case: WheelsetCase
    profiles: dict[str, str]

    @property
    def speed(self) -> float:
        """m/s, of the start and of what draws along."""
        return self.case.wheelset.speed

    def at_height(self, derivatives: bool = False) -> Scene:
        """The case with z prescribed in place of the vertical force, with derivatives if asked."""
        wheelset = self.case.wheelset.model_copy(update={"vertical_force": None, "z": 0.0})
        method = self.case.method
        method = method.model_copy(update={"derivatives": derivatives or method.derivatives})
        update = {"wheelset": wheelset, "method": method}
        return Scene(self.case.model_copy(update=update), Path())


@dataclass(frozen=True, kw_only=True)
class WheelsetScene(RunScene):
    """A wheelset's scene."""

    body: BodyTable
    suspension: SuspensionTable
    run: Run

    @property
    def steps(self) -> int:
        """Number of time steps."""
        return max(1, round(self.run.distance / (self.speed * self.run.step)))

    @property
    def preload(self) -> float:
        """N, what the suspension carries, down."""
        force = self.case.wheelset.vertical_force
        assert force is not None
        return force - self.body.total_mass * GRAVITY

    @property
    def snapshot_every(self) -> int:
        """The fields of every n-th logged step are logged; 0: none."""
        if self.run.snapshot_every is not None:
            return self.run.snapshot_every
        return -(-self.steps // (SNAPSHOTS * self.run.log_every))

    def at_speed(self, speed: float, y: float) -> WheelsetScene:
        """The scene at another speed (m/s), released straight at y (m)."""
        update = {"speed": speed, "y": y, "yaw": 0.0}
        wheelset = self.case.wheelset.model_copy(update=update)
        return replace(self, case=self.case.model_copy(update={"wheelset": wheelset}))

    def at_rest(self) -> Scene:
        """The case with the load prescribed and without friction, for a first estimate."""
        return Scene(check_case(without_friction(self.case.model_dump())), Path())


def load_wheelset_scene(
    path: str | Path | None = None, overrides: Mapping[str, Any] | None = None
) -> WheelsetScene:
    """Checks a scene; without ``path`` that of the package.

    overrides: keys of [run] that replace the file's. Relative paths of profiles start beside the
    file. Raises CaseError with every problem.
    """
    path = scene_file(DEFAULT) if path is None else Path(path)
    checks = {
        name: partial(check_present, name, model, tables=MODELS) for name, model in MODELS.items()
    }
    return load_checked(path, "wheelset", checks, check_run, WheelsetScene, overrides, MODELS)


def contact_scene(path: Path) -> tuple[str, Scene]:
    """Name and case of one contact, for commands that take one. Raises CaseError."""
    return path.stem, Scene(load_wheelset_scene(path).case, path.parent)


def check_present(
    name: str, model: type[Table], table: Any, tables: Mapping[str, Any] | None = None
) -> Any:
    """A table that may not be left out. tables: of the scene's own, by name. Raises CaseError."""
    if table is None:
        keys = ", ".join(model.model_fields)
        said = (model.__doc__ or "").rstrip(".")
        raise CaseError(f"{name}: value is missing, allowed {said}: a table [{name}] of {keys}")
    return check_table(model, table, name, among=file_of(tables or {}))


def file_of(tables: Mapping[str, Any]) -> tuple[dict[str, Any], ...]:
    """A scene's file by its tables, those of the contact among them, for messages."""
    return ({**tables, **WheelsetCase.model_fields},)


def load_checked(
    path: Path,
    command: str,
    checks: Mapping[str, Callable[[Any], Any]],
    check_all: Callable[..., None],
    scene: Callable[..., Loaded],
    overrides: Mapping[str, Any] | None,
    models: Mapping[str, Any],
) -> Loaded:
    """A scene of a command: tables of its own, each with its check, beside those of a case.

    models: of those tables, for messages. check_all: of tables and case together. scene: makes the
    scene of all of them. Raises CaseError with every problem.
    """
    content = plain(read_toml(path))
    refuse_others(content, command)
    tables = {name: content.pop(name, None) for name in checks}
    if isinstance(tables["run"], dict):
        given = {key: value for key, value in (overrides or {}).items() if value is not None}
        tables["run"] = {**tables["run"], **given}
    problems: list[str] = []
    checked: dict[str, Any] = {}
    for name, check in (*checks.items(), ("case", partial(check_case, beside=models))):
        try:
            checked[name] = check(content if name == "case" else tables[name])
        except CaseError as error:
            problems += error.problems
    if problems:
        raise CaseError(problems)
    check_all(**checked)
    profiles = found_profiles(checked["case"], path.parent)
    found = checked["case"].profiles.model_copy(update=profiles)
    case = checked["case"].model_copy(update={"profiles": found})
    checked["case"], sections = find_sections(case, partial(file_beside, path.parent))
    profiles |= {key: str(file) for key, file in sections.items()}
    return scene(name=path.name, text=path.read_bytes(), profiles=profiles, **checked)


def check_kind(case: Any, run: str) -> None:
    """Refuses other kinds. run: what needs it."""
    if case.kind != "wheelset":
        raise CaseError(f"kind: value is {case.kind!r}, allowed 'wheelset' for a {run} run")


def track_problems(case: Any, instead: str = "") -> list[str]:
    """Of what no run takes: rollers, a track that bends. instead: what says where it does."""
    track, problems = case.track, []
    if track.kind != "rail":
        problems.append(f"track.kind: value is {track.kind!r}, allowed 'rail'")
    if track.curvature != 0:
        problems.append(f"track.curvature: value is {track.curvature}, allowed 0{instead}")
    return problems


def refuse_bulk(case: Any, run: str) -> None:
    """Refuses bodies that store heat, the work that cleans them and wear, where no time passes for
    them. run: what has none."""
    if case.damage is not None:
        raise CaseError(
            f"damage: given, allowed to be left out: {run} has no way over which profiles wear"
        )
    if case.fluid is not None and case.fluid.recovery is not None:
        raise CaseError(
            f"fluid.recovery: value is given, allowed to be left out: {run} has no time in which "
            "wheels become clean"
        )
    if case.fluid is not None and case.fluid.dries:
        raise CaseError(
            f"fluid.oxide.drying: value is given, allowed to be left out: {run} has no time in "
            "which wheels dry"
        )
    if case.temperature is not None and case.temperature.bulk is not None:
        raise CaseError(
            f"temperature.bulk: value is given, allowed to be left out: {run} has no time in which "
            "wheels warm"
        )


def refuse_changes(case: Any, run: str) -> None:
    """Refuses what changes along the track or round a wheel. run: what has one place of both."""
    problems = place_problems(case, run)
    if problems:
        raise CaseError(problems)


def start_problems(case: Any, found: tuple[str, ...], why: str) -> list[str]:
    """Of a case without creep forces, or with keys of [wheelset] that are not to be given."""
    problems = []
    if not case.has_tangential:
        problems.append("method.tangential: value is 'none', allowed a method: creep forces guide")
    given = {key: getattr(case.wheelset, key) for key in found}
    return problems + [
        f"wheelset.{key}: value is {value!r}, allowed: leave it out, {why}"
        for key, value in given.items()
        if value != 0
    ]


def wear_problems(case: Any, run: Any) -> list[str]:
    """Of a key of [run] that has nothing to say."""
    if case.damage is None and "damage_every" in run.model_fields_set:
        return [f"run.damage_every: value is {run.damage_every}, allowed with [damage] alone"]
    return []


def check_run(case: Any, body: BodyTable, run: Run, **_: Any) -> None:
    """Refuses cases that are no wheelset on straight track with a load and friction."""
    check_kind(case, "wheelset")
    wheelset, problems = case.wheelset, track_problems(case) + wear_problems(case, run)
    if not wheelset.speed > 0:
        problems.append(f"wheelset.speed: value is {wheelset.speed}, allowed > 0 m/s")
    elif not 1 <= run.distance / (wheelset.speed * run.step) <= 1e7:
        problems.append(f"run.step: value is {run.step}, allowed 1 to 1e7 steps over the distance")
    weight = body.total_mass * GRAVITY
    if wheelset.vertical_force is None:
        problems.append("wheelset.z: value is given, allowed 'vertical_force' in its place")
    elif wheelset.vertical_force < weight:
        problems.append(
            f"wheelset.vertical_force: value is {wheelset.vertical_force}, allowed >= "
            f"{weight:.6g}, the weight of [body]"
        )
    problems += start_problems(case, FOUND, "it is found at the start")
    if problems:
        raise CaseError(problems)


def scene_file(name: str) -> Path:
    """Path of a scene of the package."""
    return Path(str(resources.files("wheelset_demo"))) / "scenes" / name


def found_profiles(case: WheelsetCase, folder: Path) -> dict[str, str]:
    """Key of [profiles] -> path of the file, or the name as it is where there is none."""
    found = {}
    for key in PROFILE_KEYS:
        name = getattr(case.profiles, key)
        if name is not None:
            found[key] = str(file_beside(folder, name) or name)
    return found


def file_beside(folder: Path, name: str) -> Path | None:
    """A profile's file, looked for in the folder; None: the name is a built-in one, or wrong."""
    file = folder / name
    return file if file.is_file() else None
