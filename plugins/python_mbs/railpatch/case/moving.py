"""Moving inputs: the keys of a case that may change from step to step."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from railpatch.case.load import Case, check_table, plain
from railpatch.case.messages import show
from railpatch.case.patch import PatchCase
from railpatch.case.rolling import SHAPE_KEYS
from railpatch.case.to_core import WHEELSET_STATE
from railpatch.case.types import SIDES
from railpatch.errors import CaseError

MOTION_KEYS = ("creepage", "spin_creepage", "rolling_speed", "direction")
BODY_KEYS = ("wheel", "rail")  # of [temperature]
FIXED = (*SHAPE_KEYS, "sections")  # of a deviation


def moving_keys(case: Case) -> dict[str, str]:
    """Moving key -> table of the case that holds it. 'track' and 'temperature' take a table of
    keys of theirs."""
    heat = {} if case.temperature is None else {"temperature": "temperature"}
    if isinstance(case, PatchCase):
        load = "normal_force" if case.load.normal_force is not None else "approach"
        prescribed = case.motion.prescribed
        keys = {load: "load", **dict.fromkeys(MOTION_KEYS, "motion")}
        if all(prescribed):
            del keys["creepage"]
        if any(prescribed):
            keys["tangential_force"] = "motion"
        if case.motion.regime == "transient_rolling":
            keys.update(distance="motion", steps="motion")
        return {**keys, **heat}
    height = "z" if case.wheelset.z is not None else "vertical_force"
    keys = dict.fromkeys((*WHEELSET_STATE, height, *SIDES), "wheelset")
    if case.track.kind == "roller":
        keys["roller_pitch_rate"] = "track"
    return {**keys, "track": "track", **heat}


def changed_case(case: Case, changes: Mapping[str, Any]) -> Case:
    """The case with moving inputs changed; the given one stays as it is. Raises CaseError.

    left, right and track may be given in part: {"offset": [0, 0, 1e-4]} leaves the rotation.
    """
    if not changes:
        return case
    keys = moving_keys(case)
    refuse_unknown(changes, keys, "")
    tables: dict[str, dict[str, Any]] = {}
    for key, value in plain(changes).items():
        values = tables.setdefault(keys[key], {})
        if key not in ("track", "temperature"):
            values[key] = value
            continue
        if not isinstance(value, dict):
            raise CaseError(f"{key}: value is {show(value)}, allowed a table")
        allowed = [name for name in ("roller_pitch_rate",) if name in keys]
        movable = BODY_KEYS if key == "temperature" else (*SIDES, *allowed)
        refuse_unknown(value, dict.fromkeys(movable), f"{key}.")
        values.update(value)
    changed = case.model_copy(
        update={name: changed_table(case, name, values) for name, values in tables.items()}
    )
    if isinstance(case, PatchCase) and changed.motion.prescribed != case.motion.prescribed:
        given = show(changed.motion.tangential_force)
        raise CaseError(
            f"motion.tangential_force: value is {given}, allowed the components of the case's own, "
            f"{case.motion.tangential_force}: which are prescribed does not change"
        )
    return changed


def changed_table(case: Case, name: str, values: dict[str, Any]) -> Any:
    """One table of the case, checked again with new values."""
    table = getattr(case, name)
    content = table.model_dump()
    for key, value in values.items():
        if key in SIDES and isinstance(value, dict):
            fixed = {k: v for k, v in value.items() if k in FIXED and v != content[key].get(k)}
            refuse_unknown(fixed, movable_of(content[key]), f"{name}.{key}.")
            value = {**content[key], **value}
        content[key] = value
    return check_table(type(table), content, name)


def movable_of(deviation: Mapping[str, Any]) -> dict[str, Any]:
    """The keys of a deviation that move: not its shape."""
    return {key: value for key, value in deviation.items() if key not in FIXED}


def refuse_unknown(changes: Mapping[str, Any], keys: Mapping[str, Any], prefix: str) -> None:
    """Raises CaseError for keys that do not move."""
    wrong = [key for key in changes if key not in keys]
    if wrong:
        allowed = ", ".join(keys)
        raise CaseError(
            f"{prefix}{key}: value is {show(changes[key])}, but this is no moving input of the "
            f"case, allowed {allowed}"
            for key in wrong
        )
