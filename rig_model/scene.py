"""The scene of a rig run: a case file of kind "wheelset" with a table [rig]."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from importlib import resources
from pathlib import Path
from typing import Any

from railpatch.case import WheelsetCase
from railpatch.case.common import without_friction
from railpatch.case.load import Scene, check_case, check_table, plain, read_toml, refuse_others
from railpatch.case.scene_profiles import find_sections, sections_of
from railpatch.case.types import SIDES, Table
from railpatch.case.wheel import PROFILE_KEYS
from railpatch.errors import CaseError

from rig_model.measured import Measured, measured_run
from rig_model.programme import Position, drifted, positions
from rig_model.tables import SNAPSHOTS, Rig

MEASURED = "nrc_dry_10mph_13750lb.toml"
NOMINAL = "nominal_dry_10mph_13750lb.toml"
# found at each position, so not to be given
FOUND = {"y": "lateral_position", "yaw": "yaw"} | dict.fromkeys(
    ("roll", "pitch_rate"), "start, or leave it out"
)
# theories that have no elements where Hertz's pressure has none
WITHOUT_FIELDS = ("linear", "polach", "table")


@dataclass(frozen=True)
class RigScene:
    """A checked scene.

    name: of the file. text: as it was read. case: with the profiles that were found. files: the
    profile files by their name in the text. measured: the run of a record, where it has one.
    """

    name: str
    text: bytes
    case: WheelsetCase
    rig: Rig
    files: dict[str, Path]
    measured: Measured | None = None

    @property
    def duration(self) -> float:
        """s, of the run."""
        return self.measured.duration if self.measured else float(self.rig.duration or 0.0)

    @property
    def count(self) -> int:
        """Number of positions."""
        return len(self.measured.positions) if self.measured else self.rig.count

    @property
    def doubts(self) -> list[str]:
        """What in the record is hardly meant."""
        return self.measured.warnings if self.measured else []

    @property
    def roller_rate(self) -> float:
        """rad/s, of the rollers, where no record says."""
        rate = self.case.track.roller_pitch_rate
        assert rate is not None
        return rate

    def load_at(self, position: Position) -> float:
        """N, on both wheels together."""
        load = position.vertical_force
        return self.vertical_force if load is None else load

    def speed_at(self, position: Position) -> float:
        """rad/s, of the rollers."""
        rate = position.roller_pitch_rate
        return self.roller_rate if rate is None else rate

    def measured_at(self, position: Position) -> dict[str, float]:
        """What the record has for a position."""
        return self.measured.values[position.index] if self.measured else {}

    def all_files(self) -> list[Path]:
        """Of profiles, and the record."""
        record = [self.measured.record.path] if self.measured else []
        return [*self.files.values(), *record]

    @property
    def vertical_force(self) -> float:
        """N, on both wheels together."""
        force = self.case.wheelset.vertical_force
        assert force is not None
        return force

    def positions(self) -> list[Position]:
        """The positions of the run."""
        driven = self._driven()
        offset, drift = self.rig.offset, self.rig.drift
        if offset is not None:
            driven = drifted(driven, [offset.yaw], [offset.y])
        return drifted(driven, drift.yaw, drift.lateral_position) if drift else driven

    def _driven(self) -> list[Position]:
        """Without drift."""
        rig = self.rig
        if self.measured is not None:
            return self.measured.positions
        assert rig.duration is not None
        assert rig.yaw is not None
        assert rig.lateral_position is not None
        return positions(rig.count, rig.duration, rig.yaw, rig.lateral_position)

    def snapshot_every(self) -> int:
        """The fields of every n-th position are logged; 0: none."""
        if self.rig.snapshot_every is not None:
            return self.rig.snapshot_every
        # the first, the last, and the greatest yaw of a programme that goes to and fro
        return max(1, (self.count - 1) // SNAPSHOTS)

    def at_height(self, *, derivatives: bool = False) -> Scene:
        """The case with z prescribed in place of the vertical force."""
        wheelset = self.case.wheelset.model_copy(update={"vertical_force": None, "z": 0.0})
        content = self.case.model_dump() | {"wheelset": wheelset.model_dump()}
        if derivatives:
            content["method"]["derivatives"] = True
        return self._scene(content)

    @property
    def is_whole(self) -> bool:
        """Whether the forces hold the pressures' part along x."""
        method = self.case.method
        return method.patch_rule != "contact" or method.contact_frame == "inclined"

    def one_wheel(self, side: str, most: float, *, derivatives: bool) -> Scene:
        """One wheel at its height, with a factor of its friction that is the place x up to
        ``most``: see rig_model/wheels.py."""
        content = self.at_height(derivatives=derivatives).case.model_dump()
        content |= {"kind": "wheel_rail", "wheel": {"side": side}}
        content["friction"]["along_track"] = [[0.0, 0.0], [most, most]]
        return self._scene(content)

    def frictionless(self, side: str) -> Scene:
        """One wheel without friction, with half the load."""
        content = without_friction(self.case.model_dump())
        content |= {"kind": "wheel_rail", "wheel": {"side": side}}
        content["wheelset"]["vertical_force"] = 0.5 * self.vertical_force
        return self._scene(content)

    @staticmethod
    def _scene(content: dict[str, Any]) -> Scene:
        return Scene(check_case(content), Path())


def load_rig_scene(
    path: str | Path | None = None, overrides: Mapping[str, Any] | None = None
) -> RigScene:
    """Checks a scene; without ``path`` that of the package, with NRC's measured profiles.

    overrides: keys of [rig] ("balance.method": of a table in it) that replace the file's. Profiles
    are looked for beside the file, then beside the package's scenes.
    Raises CaseError with every problem.
    """
    path = default_scene() if path is None else Path(path)
    given = {key: value for key, value in (overrides or {}).items() if value is not None}
    content = plain(read_toml(path))
    return rig_scene_of(content, path.parent, given, path.name, path.read_bytes())


def rig_scene_of(
    content: dict[str, Any],
    folder: Path,
    given: Mapping[str, Any] | None = None,
    name: str = "",
    text: bytes = b"",
) -> RigScene:
    """Checks the tables of a scene whose files are in a folder. Raises CaseError."""
    content = dict(content)
    refuse_others(content, "rig")
    rig = content.pop("rig", None)
    if rig is None:
        raise CaseError("rig: value is missing, allowed a table with the run's programme")
    if isinstance(rig, dict):
        rig = merged(rig, given or {})
    case, table = checked_parts(content, Rig, rig, "rig")
    check_machine(case, table)
    files = found_profiles(case, folder)
    found = {
        key: str(files[named])
        for key in PROFILE_KEYS
        if (named := getattr(case.profiles, key)) in files
    }
    case = case.model_copy(update={"profiles": case.profiles.model_copy(update=found)})
    case, _ = find_sections(case, files.get)
    measured = None
    if table.record is not None:
        measured = measured_run(table, case, folder / table.record)
    return RigScene(name, text, case, table, files, measured)


def checked_parts(content: Any, model: type[Table], table: Any, name: str) -> list[Any]:
    """The case, and the table ``name`` of its file. Raises CaseError with the problems of both."""
    problems: list[str] = []
    checked = []
    for check in (
        lambda: check_case(content, beside={name: model}),
        lambda: check_table(
            model, table, name, among=({name: model, **WheelsetCase.model_fields},)
        ),
    ):
        try:
            checked.append(check())
        except CaseError as error:
            problems += error.problems
    if problems:
        raise CaseError(problems)
    return checked


def merged(rig: dict[str, Any], given: Mapping[str, Any]) -> dict[str, Any]:
    """The table with some keys replaced; positions and rate replace each other. A key with a dot
    is one of a table in it."""
    rig = {**rig, **{key: value for key, value in given.items() if "." not in key}}
    for name in given:
        table, dot, key = name.partition(".")
        if dot:
            rig[table] = {**rig.get(table, {}), key: given[name]}
    for key, other in (("positions", "rate"), ("rate", "positions")):
        if key in given and other not in given:
            rig.pop(other, None)
    return rig


def check_machine(case: Any, rig: Rig) -> None:
    """Refuses cases that are no wheelset on rollers with a load and friction."""
    if case.kind != "wheelset":
        raise CaseError(f"kind: value is {case.kind!r}, allowed 'wheelset' for a rig")
    problems = []
    if case.track.kind != "roller":
        problems.append(f"track.kind: value is {case.track.kind!r}, allowed 'roller' for a rig")
    if not case.track.roller_pitch_rate:
        shown = case.track.roller_pitch_rate
        problems.append(f"track.roller_pitch_rate: value is {shown}, allowed one that is not 0")
    if case.wheelset.vertical_force is None:
        problems.append(
            "wheelset.z: value is given, allowed 'vertical_force' in its place: the rig finds z"
        )
    if not case.has_tangential:
        problems.append("method.tangential: value is 'none', allowed one with creep forces")
    problems += steady_problems(case, "a position is")
    if rig.balance.axle_torque == "track" and case.method.contact_frame == "inclined":
        problems.append(
            "rig.balance.axle_torque: value is 'track', allowed 'wheelset' with "
            "method.contact_frame = 'inclined': the normal force's part along x is in the force"
        )
    if rig.balance.tolerance < 2 * case.method.tolerance:
        problems.append(
            f"rig.balance.tolerance: value is {rig.balance.tolerance}, allowed >= "
            f"{2 * case.method.tolerance:g}, twice method.tolerance: forces are no more exact"
        )
    if rig.conditioning is not None:
        problems += conditioning_refused(case)
    for key, other in FOUND.items():
        value = getattr(case.wheelset, key)
        if value != 0.0:
            problems.append(f"wheelset.{key}: value is {value!r}, allowed in [rig] as {other}")
    if problems:
        raise CaseError(problems)


def steady_problems(case: Any, what: str) -> list[str]:
    """Of contacts with a history, where a search solves them. what: is solved."""
    motion, why = case.motion, f"{what} solved several times, each of which would be a step"
    problems = []
    if motion.regime != "steady_rolling":
        problems.append(
            f"motion.regime: value is {motion.regime!r}, allowed 'steady_rolling': {why}"
        )
    if motion.regime_changes:
        problems.append(f"motion.regime_changes: value is True, allowed False: {why}")
    return problems


def conditioning_refused(case: WheelsetCase) -> list[str]:
    """What friction that conditions cannot go with: rig_model/wheels.py, conditioning.py."""
    found = {"friction.along_track": case.friction.along_track if case.friction else None}
    found["track.irregularity"] = case.track.irregularity
    for side in SIDES:
        for key in ("sections", "running_surface", "joint"):
            found[f"track.{side}.{key}"] = getattr(getattr(case.track, side), key)
    refused = [
        f"{key}: value is given, allowed none with rig.conditioning: friction is set by the place "
        "along the track"
        for key, value in found.items()
        if value is not None
    ]
    method = case.method
    if method.normal == "hertz" and method.tangential in WITHOUT_FIELDS:
        refused.append(
            f"method.tangential: value is {method.tangential!r}, allowed with rig.conditioning a "
            "theory with fields, or method.normal = 'half_space': work lies over the bands as the "
            "pressure does"
        )
    return refused


def default_scene() -> Path:
    """The replay of NRC's run, with the measured profiles."""
    return scenes() / MEASURED


def scenes() -> Path:
    """The folder of the package's scenes and their profiles."""
    return Path(str(resources.files("rig_model"))) / "scenes"


def found_profiles(case: WheelsetCase, folder: Path) -> dict[str, Path]:
    """Name in [profiles] or of a section -> its file, looked for in the folder, then beside the
    package's scenes.

    A scene that was shown and changed elsewhere names the package's profiles.
    """
    names = {getattr(case.profiles, key) for key in PROFILE_KEYS} - {None}
    for side in SIDES:
        names |= {section.profile for _, section in sections_of(case, side)}
    found = {}
    for name in sorted(names):
        files = [place / name for place in (folder, scenes()) if (place / name).is_file()]
        if files:
            found[name] = files[0]
    return found
