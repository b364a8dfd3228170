"""solve() and Contact: one case through the core."""

from __future__ import annotations

import json
import struct
import time
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any
from zlib import crc32

import numpy as np

from railpatch import _core
from railpatch.asked import Asked
from railpatch.case.keys_of_step import signature
from railpatch.case.load import Case, Scene, check_table, load_scene
from railpatch.case.moving import changed_case, moving_keys, with_numbers
from railpatch.case.patch import Motion, PatchCase
from railpatch.case.patch_doubts import patch_doubts
from railpatch.case.scene_profiles import Shelf, beside_sections, placement_doubts, profile_notes
from railpatch.case.to_core import (
    FORCE_AND_MOMENT,
    POSE_AND_VELOCITY,
    config_of,
    input_of,
    plain_moves,
    rates_of,
)
from railpatch.case.track import add_irregularity, irregularity_of
from railpatch.case.types import SIDES, show
from railpatch.errors import CaseError
from railpatch.on_demand import OnDemand, Reader
from railpatch.pressure_error import Replica, doubts, lines, replica_of
from railpatch.result import (
    FIELDS,
    FLUID_FIELDS,
    GOOD,
    LAW_FIELDS,
    ROW_FIELDS,
    Result,
    shaped_field,
)

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from railpatch.case.keys_of_step import Moving

# saved state: mark, head of the moving tables as JSON, the JSON, the core's state
MARK = b"railpatch2"
# length and check sum of the tables
HEAD = struct.Struct("<II")
# quantities of each step of shift or transient rolling
STEP_KEYS = (
    "status",
    "reason",
    "normal_force",
    "creep_force",
    "spin_moment",
    "creepage",
    "elements",
    "creep_power",
    "friction_power",
    "plastic_power",
    "elastic_energy",
    "pressure_energy",
    "iterations",
    "residual",
)
CaseSource = Mapping[str, Any] | str | Path | Scene


class Contact:
    """A contact with its memory and last solution; the next step starts from it.

    case: dictionary, path of a TOML file, or Scene. folder: where relative paths start; default the
    file's folder, or the working directory. timing: measure the time of each stage.
    Raises CaseError, ProfileError.
    """

    def __init__(
        self, case: CaseSource, *, folder: str | Path | None = None, timing: bool = False
    ) -> None:
        scene = case if isinstance(case, Scene) else load_scene(case, folder)
        self._scene, self._timing = scene, timing
        self._checked, self._folder = scene.case, scene.folder
        self._moved: set[str] = set()  # keys that changed since, in the core alone
        self._irregularity = irregularity_of(scene)
        self._shelf = None if scene.case.kind == "patch" else Shelf(scene.case, scene.folder)
        self._core = _core.Contact(config_of(scene, self._shelf), timing)
        self._replica: Replica | None = None
        # of the last step, where it is not that of the case
        self._own_values: dict[str, Any] | None = None
        self._last: tuple[_core.Outcome, float] | None = None
        present = [stage["name"] for stage in self.stages() if stage["present"]]
        self._reader = Reader(scene.case, present)
        # whether the core's last input is that of the case, and steps may change its numbers there
        self._core.allow({} if self._irregularity is not None else plain_moves(scene.case))
        self._goes_on = False
        wanted = scene.case.subsurface is not None or scene.case.damage is not None
        self._asked = Asked(self, scene.case) if wanted else None

    @property
    def _case(self) -> Case:
        if self._moved:
            now = {key: self._core.moved(key) for key in self._moved}
            self._checked = changed_case(self._checked, now)
            self._moved = set()
        return self._checked

    @_case.setter
    def _case(self, case: Case) -> None:
        self._checked, self._moved = case, set()

    @property
    def _values(self) -> dict[str, Any]:
        """Fields of rp_input of the last step."""
        return input_of(self._case) if self._own_values is None else self._own_values

    @property
    def case(self) -> Case:
        """The checked case with the moving inputs of the last step."""
        return self._case

    @property
    def folder(self) -> Path:
        """Where the case's relative paths start."""
        return self._folder

    def profile_notes(self) -> dict[str, list[str]]:
        """What was assumed of each profile file and done to it: unit, axes, noise, smoothing."""
        return {} if self._shelf is None else profile_notes(self._case, self._shelf)

    def placement_doubts(self) -> list[str]:
        """Warnings of wheels whose flange is not where the case has it, or has a thickness that no
        flange has there (docs/profiles.md)."""
        return [] if self._shelf is None else placement_doubts(self._case, self._shelf)

    def doubts(self) -> list[str]:
        """Warnings of the case itself, which no step's result has: its wheels' flanges, slices
        along the track, widths and distances, own influence coefficients."""
        return [
            *self.placement_doubts(),
            *beside_sections(self._case),
            *patch_doubts(self._case, self._folder),
        ]

    def noisy_profiles(self) -> list[str]:
        """Names of the profile files in whose points noise was found."""
        noisy = {} if self._shelf is None else self._shelf.noisy()
        return list(dict.fromkeys(Path(name).name for _, name in noisy))

    def pressure_error(self) -> dict[str, float]:
        """By wheel ("left", "right"), what 95 % of the errors of the last step's max_pressure stay
        below, over it, for the noise found in profile files; empty without noise or contact.

        16 contacts with other noise of the same size are solved for it: of one wheel 23 to 47 ms of
        the first call, 10 to 15 ms of each further one (docs/profiles.md); NaN where half of them
        have no contact. What the step begins from has no part in it: no memory, no stored heat.
        Raises CaseError before the first step.
        """
        if self._last is None:
            raise CaseError("pressure_error: there is no step, allowed after step()")
        if self._shelf is None or not self._shelf.noisy():
            return {}
        if self._replica is None:
            self._replica = replica_of(Scene(self._case, self._folder), self._shelf)
        raw = self._last[0].whole()
        found = {name: raw[name] for name in self._shelf.case.wheelset.found}
        return self._replica.errors({**self._values, **found}, raw)

    def step(self, *, fields: bool = False, **changes: Unpack[Moving]) -> Result:
        """Solves with some moving inputs changed; the others keep their last value.

        patch: creepage or tangential_force, spin_creepage, rolling_speed, direction, normal_force
        or approach; in transient rolling distance and steps: one step rolls distance/steps. Where
        regimes may change (motion.regimes, of wheels motion.regime_changes) regime.
        wheel_rail, wheelset: the position and velocity keys of [wheelset] with left and right,
        roller_pitch_rate, track = {"left": ..., "right": ...}; left and right in part or whole.
        Not roll = "balanced" and pitch_rate = "free", which the step finds: the result has them.
        all, with temperatures: temperature = {"wheel": ..., "rail": ...}, in part or whole.
        Bodies of temperature.bulk go on by time_step, by default that of the case; before the first
        step, and by 0, no time passes.
        fields: add the fields of each patch. Other keys raise CaseError and nothing changes.
        Ctrl-C, or another signal whose handler raises, ends the step within 0.2 s: the moving
        inputs stay, and the next step starts as after reset().
        The result's quantities are read as they are asked for.
        """
        if self._goes_on:
            outcome, wall_time = self._timed(self._core.step_moved, changes)
            if outcome is not None:
                self._moved.update(changes)
                self._own_values = None
                return self._result(outcome, wall_time, fields)
        case = changed_case(self._case, changes)
        if isinstance(case, PatchCase) and len(case.motion.creepages) > 1:
            shown = show(case.motion.creepage)
            raise CaseError(f"motion.creepage: value is {shown}, allowed one pair for a step")
        return self._solve(case, None, fields=fields)

    def _solve(self, case: Case, creepage: list[float] | None, *, fields: bool) -> Result:
        """One step; creepage: of this step, where the case has one for each."""
        values = input_of(case)
        own = self._irregularity is not None or creepage is not None
        if self._irregularity is not None:
            add_irregularity(values, self._irregularity)
        if creepage is not None:
            values["creepage"] = creepage
        outcome, wall_time = self._timed(self._core.step_from, values)
        self._case = case
        self._own_values = values if own else None
        self._goes_on = not own
        return self._result(outcome, wall_time, fields)

    def _timed(self, step: Callable[[Any], Any], argument: Any) -> tuple[Any, float]:
        """What a step of the core gives, and its time in s."""
        begin = time.perf_counter()
        try:
            outcome = step(argument)
        except CaseError:
            raise
        except BaseException:
            # interrupted: the core has forgotten its last solution
            self._last = None
            raise
        return outcome, time.perf_counter() - begin

    def _result(self, outcome: _core.Outcome, wall_time: float, fields: bool) -> Result:
        """Of a step, which is the last one now."""
        self._last = outcome, wall_time
        if self._asked is not None:
            raw = outcome.whole()
            data = self._data(raw, wall_time, fields or self._asked.needs_fields)
            return Result(self._asked.add(data, raw, fields))
        if fields:
            return Result(self._data(outcome.whole(), wall_time, fields))
        return Result(OnDemand(self._reader, outcome, wall_time))

    def wear_rows(self) -> dict[str, list[tuple[float, dict[str, Any]]]]:
        """Of the last step of a case with [damage], by side: share and rows of each patch, as
        railpatch.damage.distribution.Distribution takes them. Empty without contact.

        A row has s, wheel, rail (m: lateral in the contact frame, y in the axes of both profiles;
        a patch given by itself has s alone), height (m, across it) and wear (kg/m^2, mass by metre
        rolled and by width).
        Raises CaseError.
        """
        if self._asked is None or self._checked.damage is None:
            raise CaseError("damage: left out, allowed a table for wear_rows()")
        return self._asked.rows

    def last(self, *, fields: bool = False) -> Result:
        """The last step's result once more, also with fields; nothing is solved.

        Raises CaseError before the first step, and after reset() and restore().
        """
        if self._last is None:
            raise CaseError("last: there is no step, allowed after step()")
        return self._result(*self._last, fields)

    def differentiate(self, **direction: Any) -> Result:
        """Rates of the last step's result, for rates of moving inputs: zero where left out.

        The keys are those of step(), without direction and steps, and of Coulomb's law
        friction_coefficient; those of left, right, track and temperature take tables in part or
        whole. The result has the keys of step()'s with rates,
        NaN where it has none, and ``kind``: "exact", from the solved conditions, or "differences"
        of further steps, for methods without exact ones. Where an element is about to change
        between stick, slip and no contact, exact rates are those of its present state. Needs
        method.derivatives = true and a step; changes nothing. Of a wheelset in balance roll and
        pitch rate follow. Raises CaseError.
        """
        rates = rates_of(self._case, direction)
        begin = time.perf_counter()
        raw, exact = self._core.differentiate(rates)
        data = self._data(raw, time.perf_counter() - begin, False)
        return Result({**data, "kind": "exact" if exact else "differences"})

    def jacobian(self) -> dict[str, Any]:
        """Derivatives of the last step's forces by pose and velocity, for wheel_rail and wheelset.

        ``left``, ``right``: arrays [6, 12] of force and moment of each wheel in use, rows
        ``railpatch.case.to_core.FORCE_AND_MOMENT`` (N, N m, track axes), columns
        ``railpatch.case.to_core.POSE_AND_VELOCITY`` (m, rad, m/s, rad/s). ``z``: [12], of the
        height. They are those of what step() gives: with vertical_force, z follows; column z then
        is that of a wheel whose vertical force does not stay, NaN by differences, and ``z_force``
        (m/N) the height's by the vertical force (else NaN). ``kind``: as of differentiate();
        ``status``: as of the step, or "not_converged". Needs method.derivatives = true and a step;
        changes nothing. Raises CaseError.
        """
        if self._case.kind == "patch":
            raise CaseError("kind: value is 'patch', allowed wheel_rail, wheelset for jacobian()")
        if not self._case.method.derivatives:
            raise CaseError("method.derivatives: value is False, allowed True for jacobian()")
        for name in self._case.wheelset.found:
            shown = show(getattr(self._case.wheelset, name))
            raise CaseError(f"wheelset.{name}: value is {shown}, allowed a number for jacobian()")
        raw = self._core.jacobian()
        shape = (len(FORCE_AND_MOMENT), len(POSE_AND_VELOCITY))
        arrays = {side: np.array(raw[side]).reshape(shape) for side in self._case.sides}
        rest = {name: raw[name] for name in ("z_force", "kind", "status")}
        return {**arrays, "z": np.array(raw["z"]), **rest}

    def reset(self) -> None:
        """Forgets the last solution: the next step starts as the first one did."""
        self._core.reset()
        self._last = None

    def save(self) -> bytes:
        """The state that later steps depend on: last solution and moving inputs."""
        tables = sorted(set(moving_keys(self._case).values()))
        content = {name: getattr(self._case, name).model_dump() for name in tables}
        text = json.dumps(content).encode()
        return MARK + HEAD.pack(len(text), crc32(text)) + text + self._core.save()

    def restore(self, state: bytes) -> None:
        """Brings back a saved state of a contact of the same case; the next step gives the same
        bits. Raises CaseError for other bytes, then nothing changes."""
        try:
            tables, core_state = split_state(state)
            changed = {
                name: check_table(type(getattr(self._case, name)), content, name)
                for name, content in tables.items()
            }
        except (ValueError, TypeError, AttributeError, struct.error):
            raise CaseError("state: value is no state of this case, allowed: save()") from None
        self._core.restore(core_state)
        self._last = None
        self._goes_on = False
        self._case = self._case.model_copy(update=changed)

    def __reduce__(self) -> tuple[Any, ...]:
        """Copies and pickles have the state: their next step gives the same bits. Profiles are read
        anew, by their absolute paths; last() begins with the next step."""
        scene = Scene(self._scene.case, self._folder.resolve())
        return _restored, (scene, self._timing, self.save())

    def stages(self) -> list[dict[str, Any]]:
        """name, present, reason, bytes (memory held) and seconds (0 without timing) per stage."""
        return self._core.describe()

    def asked(self) -> list[dict[str, Any]]:
        """As stages(), of [subsurface] and [damage]: seconds of all steps, bytes None."""
        return (self._asked or Asked(self, self._checked)).described()

    def _data(self, raw: dict[str, Any], wall_time: float, fields: bool) -> dict[str, Any]:
        """The JSON result's content for the case's kind; raw: rp_result."""
        data = self._reader.whole(raw, wall_time)
        if not fields:
            return data
        if self._checked.kind == "patch":
            return {**data, **self._fields("right", 0, raw["right"]["patches"][0]["grid"])}
        for side in self._checked.sides:
            wheel = data if self._checked.kind == "wheel_rail" else data[side]
            solved = raw[side]["patches"] + raw[side]["alternatives"]
            for index, patch in enumerate(wheel["patches"] + wheel["alternatives"]):
                patch.update(self._fields(side, index, solved[index]["grid"]))
        return data

    def _fields(self, side: str, patch: int, grid: list[int]) -> dict[str, Any]:
        """The fields of one patch of the last step."""
        found: dict[str, Any] = {}
        for name in FIELDS:
            values = self._core.field(SIDES.index(side), patch, name)
            if values is None and name in (*LAW_FIELDS, *ROW_FIELDS, *FLUID_FIELDS):
                continue
            found[name] = shaped_field(name, values, grid)
        return found


Contact.step.__signature__ = signature(Contact.step)  # for those who complete keys


def _restored(scene: Scene, timing: bool, state: bytes) -> Contact:
    """A contact of a scene with a saved state."""
    contact = Contact(scene, timing=timing)
    contact.restore(state)
    return contact


def split_state(state: bytes) -> tuple[dict[str, Any], bytes]:
    """Moving tables and the core's state. Raises ValueError, TypeError, struct.error."""
    start = len(MARK) + HEAD.size
    if state[: len(MARK)] != MARK:
        raise ValueError("no mark")
    size, check = HEAD.unpack(state[len(MARK) : start])
    text = state[start : start + size]
    if crc32(text) != check:
        raise ValueError("damaged")
    tables = json.loads(text)
    if not isinstance(tables, dict):
        raise ValueError("no tables")
    return tables, state[start + size :]


def solve(
    case: CaseSource,
    fields: bool = False,
    *,
    folder: str | Path | None = None,
    strict: bool = False,
) -> Result:
    """Solves one case.

    case: dictionary or path of a TOML file. fields: add pressure, traction, ... of each patch.
    folder: where relative paths start; default the file's folder, or the working directory.
    Shift and transient rolling: all steps of the case; the result is that of the last one, with the
    status of the first step that was not good if there is one, and ``steps`` holds some quantities
    of each. strict: a warning of the result raises CaseError.
    Raises CaseError, ProfileError. A solve that does not converge is no error: see
    Result.status.
    """
    contact = Contact(case, folder=folder)
    result = _solved(contact, fields)
    result.data["warnings"] = [*result.warnings, *contact.doubts()]
    notes = [*notes_of_solve(contact.case), *_add_pressure_error(contact, result)]
    if strict and result.warnings:
        raise CaseError(result.warnings)
    if assumed := contact.profile_notes():
        result.data["profiles"] = assumed
    if notes:
        result.data["notes"] = notes
    return result


def _add_pressure_error(contact: Contact, result: Result) -> list[str]:
    """Puts max_pressure_error to each wheel of a result, and a warning of great ones; returns
    lines on the others."""
    errors = contact.pressure_error() if result.solved else {}
    if not errors:
        return []
    files = contact.noisy_profiles()
    for side, error in errors.items():
        result.data.get(side, result.data)["max_pressure_error"] = error
    warnings = doubts(errors, files)
    result.data["warnings"] = [*result.warnings, *warnings]
    return [] if warnings else lines(errors, files)


def notes_of_solve(case: Case) -> list[str]:
    """What of a case a single solve leaves without effect."""
    heat = case.temperature
    if heat is None or heat.bulk is None or not case.has_tangential:
        return []
    return [
        "temperature.bulk: no time passes in a single solve: bulk temperatures are those given, "
        "wheel_heat and rail_heat what would warm the bodies"
    ]


def at_balance(scene: Scene, name: str) -> Scene:
    """The scene with the numbers of the balance in place of the words that ask for them.

    name: of the scene, for the error. Raises CaseError where the balance is not found.
    """
    found = () if isinstance(scene.case, PatchCase) else scene.case.wheelset.found
    if not found:
        return scene
    result = Contact(scene).step()
    if not result.solved:
        raise CaseError(f"{name}: the balance of the wheelset is not found: {result.reason}")
    numbers = {key: result[key] for key in found}
    return Scene(with_numbers(scene.case, numbers), scene.folder)


def _solved(contact: Contact, fields: bool) -> Result:
    """All steps of a contact's case."""
    motion = contact.case.motion if contact.case.kind == "patch" else None
    if motion is None or (motion.steps is None and not motion.changes):
        return contact.step(fields=fields)
    return solve_steps(contact, motion, fields)


def with_regime(case: Case, regime: str) -> Case:
    """The case with the regime of a step."""
    if case.motion.regime == regime:
        return case
    motion = case.motion.model_copy(update={"regime": regime})
    return case.model_copy(update={"motion": motion})


def solve_steps(contact: Contact, motion: Motion, fields: bool) -> Result:
    """All steps of shift or transient rolling."""
    regimes = motion.of_steps
    count = len(regimes)
    pairs = motion.creepages
    # the case's way is that of all steps
    of_regime = {regime: with_regime(contact.case, regime) for regime in regimes}
    rows: list[dict[str, Any]] = []
    warnings: dict[str, None] = {}
    wall_time = 0.0
    for index in range(count):
        pair = pairs[index] if len(pairs) > 1 else pairs[0]
        last = index == count - 1
        result = contact._solve(of_regime[regimes[index]], pair, fields=fields and last)
        row = {name: result[name] for name in STEP_KEYS if name in result.data}
        rows.append({"regime": regimes[index], **row} if motion.changes else row)
        wall_time += result["wall_time"]
        warnings |= dict.fromkeys(result.warnings)
    ended = next((row for row in rows if row["status"] not in GOOD), result)
    of_all = {"status": ended["status"], "reason": ended["reason"], "warnings": list(warnings)}
    return Result({**result.data, **of_all, "wall_time": wall_time, "steps": rows})
