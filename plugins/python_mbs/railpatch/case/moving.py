"""Moving inputs: the keys of a case that may change from step to step."""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from railpatch.case.fluid import MOVED
from railpatch.case.friction import MOVED_FRICTION
from railpatch.case.load import Case, check_table, plain
from railpatch.case.patch import PatchCase
from railpatch.case.types import SIDES, show
from railpatch.case.wheel import OF_FREE, Deviation, Rail, WheelDeviation
from railpatch.errors import CaseError

# tables that are given whole or in part, by their name
BY_TABLE = ("track", "temperature")
# tables whose keys have other names in a step
OF_STEP = {"fluid": MOVED, "friction": MOVED_FRICTION}
# of a deviation: shapes, which do not move
FIXED = {*WheelDeviation.model_fields, *Rail.model_fields} - set(Deviation.model_fields)


def moving_keys(case: Case) -> dict[str, str]:
    """Moving key -> table of the case that holds it. 'track' and 'temperature' take a table of
    keys of theirs."""
    keys: dict[str, str] = {}
    for table in case.moving:
        for key in getattr(case, table).moving:
            keys.setdefault(key, table)
    tables = (table for table in BY_TABLE if getattr(case, table, None) is not None)
    return {**keys, **{table: table for table in tables}}


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
        if value is None:
            # the core would have the value of its start in place of none
            raise CaseError(f"{key}: value is None, allowed a value: a step leaves nothing out")
        values = tables.setdefault(keys[key], {})
        if key not in BY_TABLE:
            values[OF_STEP.get(keys[key], {}).get(key, key)] = value
            continue
        if not isinstance(value, dict):
            raise CaseError(f"{key}: value is {show(value)}, allowed a table")
        refuse_unknown(value, dict.fromkeys(getattr(case, key).moving), f"{key}.")
        values.update(value)
    changed = case.model_copy(
        update={name: changed_table(case, name, values) for name, values in tables.items()}
    )
    if not isinstance(case, PatchCase) and changed.wheelset.found != case.wheelset.found:
        name = next(name for name in changed.wheelset.found if name not in case.wheelset.found)
        shown = show(getattr(changed.wheelset, name))
        raise CaseError(
            f"wheelset.{name}: value is {shown}, allowed a number: whether it is found does not "
            "change"
        )
    if isinstance(case, PatchCase) and changed.motion.prescribed != case.motion.prescribed:
        given = show(changed.motion.tangential_force)
        raise CaseError(
            f"motion.tangential_force: value is {given}, allowed the components of the case's own, "
            f"{case.motion.tangential_force}: which are prescribed does not change"
        )
    return changed


def with_numbers(case: Case, numbers: Mapping[str, float]) -> Case:
    """The case of a wheelset with numbers in place of what it says to find."""
    values: dict[str, Any] = dict(numbers)
    if "pitch_rate" in numbers:
        values |= dict.fromkeys(OF_FREE)
    return case.model_copy(update={"wheelset": changed_table(case, "wheelset", values)})


def changed_table(case: Case, name: str, values: dict[str, Any]) -> Any:
    """One table of the case, checked again with new values. Raises CaseError, of keys that have
    another name in a step by both names."""
    table = getattr(case, name)
    content = table.model_dump()
    for key, value in values.items():
        if key in SIDES and isinstance(value, dict):
            fixed = {k: v for k, v in value.items() if k in FIXED and v != content[key].get(k)}
            refuse_unknown(fixed, dict.fromkeys(getattr(table, key).moving), f"{name}.{key}.")
            value = {**content[key], **value}
        content[key] = value
    try:
        return check_table(type(table), content, name)
    except CaseError as error:
        raise CaseError(by_step(name, line) for line in error.problems) from None


def by_step(name: str, line: str) -> str:
    """A line on a key of a table with the name that a step has for it, 'water_temperature
    (fluid.temperature): value is ...', where that is not the table's own."""
    key, said = line.split(":", 1)
    for moved, own in OF_STEP.get(name, {}).items():
        place = key.removeprefix(f"{name}.{own}")
        if own != moved and place != key and place[:1] in ("", "["):
            return f"{moved}{place} ({key}):{said}"
    return line


def refuse_unknown(changes: Mapping[str, Any], keys: Mapping[str, Any], prefix: str) -> None:
    """Raises CaseError for keys that do not move."""
    wrong = [key for key in changes if key not in keys]
    if wrong:
        allowed = ", ".join(keys)
        raise CaseError(
            f"{prefix}{key}: value is {shown(changes[key])}, but this is no moving input of the "
            f"case, allowed {allowed}{meant(key, keys)}"
            for key in wrong
        )


def shown(value: Any) -> str:
    """As of other values, of arrays their size."""
    return f"an array of shape {value.shape}" if isinstance(value, np.ndarray) else show(value)


def meant(key: str, keys: Iterable[str]) -> str:
    """A hint at the key that was perhaps meant: without its table, or spelt in another way."""
    own = key.rsplit(".", 1)[-1]
    if own == "regime":
        return "; a case whose regime changes says so by motion.regimes, wheels by regime_changes"
    known = {name.lower(): name for name in keys}
    close = difflib.get_close_matches(own.lower(), known, 1, 0.6)
    return f"; did you mean {known[close[0]]!r}?" if close else ""
