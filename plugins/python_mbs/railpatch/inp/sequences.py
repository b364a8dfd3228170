"""Steps of one contact: as one case, or step by step."""

from __future__ import annotations

import copy
from typing import Any

from railpatch.errors import CaseError
from railpatch.inp.files import Converted

# of [motion] and [load], what Contact.step changes
MOVING = ("creepage", "spin_creepage", "tangential_force", "rolling_speed", "direction", "distance")
MOVING += ("slip_field",)
# of these, what a shift has not
OF_ROLLING = ("rolling_speed", "direction", "distance")
# of [wheelset], what Contact.step does not change
FIXED = ("nominal_radius", "flange_back_distance", "flange_back_position")


def changes_regime(steps: list[Converted]) -> bool:
    """Whether a sequence has steps of more than one regime."""
    return len({regime_of(step) for step in steps}) > 1


def regime_of(step: Converted) -> str:
    """Of a case that was converted."""
    assert step.tables is not None
    return str(step.tables.get("motion", {}).get("regime", "steady_rolling"))


def begun(steps: list[Converted]) -> dict[str, Any]:
    """The first step's tables, for a contact that goes on as the others say."""
    first = steps[0].tables
    assert first is not None
    if not changes_regime(steps):
        return first
    tables = copy.deepcopy(first)
    tables["method"]["spin_offset"] = "contact"
    if tables["kind"] == "patch":
        tables["motion"]["regimes"] = [tables["motion"]["regime"]]
        return tables
    tables["motion"] = {"regime": regime_of(steps[0]), "regime_changes": True}
    times = [one.tables["wheelset"].get("time_step", 0.0) for one in steps if one.tables]
    # steady rolling does not read it
    tables["wheelset"].setdefault("time_step", max(times))
    return tables


def joined(steps: list[Converted], name: str) -> dict[str, Any]:
    """One case of all steps. Raises CaseError where more changes than creepage and regime."""
    first = steps[0].tables
    assert first is not None
    if len(steps) == 1:
        return first
    if first["kind"] != "patch":
        raise several(steps[1], name, "position")
    tables = copy.deepcopy(begun(steps))
    motion = tables["motion"]
    for key in MOVING:
        if key not in ("creepage", "distance"):
            motion |= common(steps, key, name)
    for step in steps:
        assert step.tables is not None
        if step.tables["load"] != first["load"]:
            raise several(step, name, "load")
    pairs = [step.tables["motion"]["creepage"] for step in steps if step.tables]
    motion |= {"creepage": pairs, "steps": len(steps)}
    if way := common(steps, "distance", name):
        rolled = [step for step in steps if regime_of(step) == "transient_rolling"]
        motion["distance"] = way["distance"] * len(rolled)
    if changes_regime(steps):
        motion["regimes"] = [regime_of(step) for step in steps]
        del motion["regime"], motion["steps"]
    return tables


def common(steps: list[Converted], key: str, name: str) -> dict[str, Any]:
    """A key of [motion] that all steps which read it have alike. Raises CaseError."""
    found: dict[str, Any] = {}
    for step in steps:
        assert step.tables is not None
        motion = step.tables["motion"]
        if key not in motion or (key in OF_ROLLING and motion["regime"] == "shift"):
            continue
        if key == "slip_field" and any(key not in s.tables["motion"] for s in steps if s.tables):
            raise several(step, name, key)
        if found.setdefault(key, motion[key]) != motion[key]:
            raise several(step, name, key)
    return found


def several(step: Converted, name: str, key: str) -> CaseError:
    """A sequence that no file here holds."""
    return CaseError(
        f"{name}, line {step.case.line}, case {step.case.number}: a sequence whose {key} changes "
        "has no counterpart in a file: `railpatch solve` takes its steps one by one"
    )


def moving_of(tables: dict[str, Any]) -> dict[str, Any]:
    """What may change from step to step."""
    return {key: tables["motion"][key] for key in MOVING if key in tables["motion"]}


def changes_of(step: Converted, steps: list[Converted], name: str) -> dict[str, Any]:
    """Of Contact.step. Raises CaseError where something else changes than it takes."""
    first = steps[0]
    assert step.tables is not None
    assert first.tables is not None
    moving = ("motion", "load", "wheelset", "track")
    for key in first.tables.keys() | step.tables.keys():
        if key in moving or same(first.tables.get(key), step.tables.get(key)):
            continue
        raise CaseError(
            f"{name}, line {step.case.line}, case {step.case.number}: [{key}] changes within a "
            "sequence (P = 0), which has no counterpart"
        )
    regime = {"regime": regime_of(step)} if changes_regime(steps) else {}
    if step.tables["kind"] == "patch":
        own, of_first = (one["motion"].keys() for one in (step.tables, first.tables))
        if ("slip_field" in own) != ("slip_field" in of_first):
            raise CaseError(
                f"{name}, line {step.case.line}, case {step.case.number}: extra rigid slip that "
                "comes or goes within a sequence (P = 0) has no counterpart: give zeros"
            )
        return regime | moving_of(step.tables) | step.tables["load"]
    return regime | changes_of_wheel(step, first, name)


def same(one: Any, other: Any) -> bool:
    """Of tables, but for the place of the spin term, which goes with the regime."""
    if isinstance(one, dict) and isinstance(other, dict):
        one, other = ({k: v for k, v in t.items() if k != "spin_offset"} for t in (one, other))
    return bool(one == other)


def changes_of_wheel(step: Converted, first: Converted, name: str) -> dict[str, Any]:
    """Position, velocity and deviations of a wheel and its rail."""
    assert step.tables is not None
    assert first.tables is not None
    now, before = step.tables, first.tables
    side = now["wheel"]["side"]
    fixed = {
        "wheelset": [key for key in FIXED if now["wheelset"][key] != before["wheelset"][key]],
        "track": [
            key
            for key in now["track"].keys() | before["track"].keys()
            if key not in (side, "roller_pitch_rate")
            and now["track"].get(key) != before["track"].get(key)
        ],
    }
    for table, keys in fixed.items():
        for key in keys:
            raise CaseError(
                f"{name}, line {step.case.line}, case {step.case.number}: {table}.{key} changes "
                "within a sequence (P = 0), which has no counterpart"
            )
    changes = {key: value for key, value in now["wheelset"].items() if key not in FIXED}
    if "roller_pitch_rate" in now["track"]:
        changes["roller_pitch_rate"] = now["track"]["roller_pitch_rate"]
    if side in now["track"]:
        changes["track"] = {side: now["track"][side]}
    return changes
