"""Steps of one contact: as one case, or step by step."""

from __future__ import annotations

import copy
from typing import Any

from railpatch.errors import CaseError
from railpatch.inp.files import Converted

# of [motion] and [load], what Contact.step changes
MOVING = ("creepage", "spin_creepage", "tangential_force", "rolling_speed", "direction", "distance")


def joined(steps: list[Converted], name: str) -> dict[str, Any]:
    """One case of all steps. Raises CaseError where more changes than the creepage."""
    first = steps[0].tables
    assert first is not None
    if len(steps) == 1:
        return first
    tables = copy.deepcopy(first)
    pairs, distance = [], 0.0
    for step in steps:
        assert step.tables is not None
        motion = step.tables["motion"]
        for key in moving_of(step.tables):
            if (
                key not in ("creepage", "load")
                and moving_of(step.tables)[key] != moving_of(first)[key]
            ):
                raise several(step, name, key)
        if step.tables["load"] != first["load"]:
            raise several(step, name, "load")
        pairs.append(motion["creepage"])
        distance += motion.get("distance", 0.0)
    tables["motion"] |= {"creepage": pairs, "steps": len(steps)}
    if distance > 0:
        tables["motion"]["distance"] = distance
    return tables


def several(step: Converted, name: str, key: str) -> CaseError:
    """A sequence that no file here holds."""
    return CaseError(
        f"{name}, line {step.case.line}, case {step.case.number}: a sequence whose {key} changes "
        "has no counterpart in a file: `railpatch solve` takes its steps one by one"
    )


def moving_of(tables: dict[str, Any]) -> dict[str, Any]:
    """What may change from step to step."""
    return {key: tables["motion"][key] for key in MOVING if key in tables["motion"]}


def changes_of(step: Converted, first: Converted, name: str) -> dict[str, Any]:
    """Of Contact.step. Raises CaseError where something else changes than it takes."""
    assert step.tables is not None
    assert first.tables is not None
    for key in first.tables.keys() | step.tables.keys():
        if key in ("motion", "load"):
            continue
        if step.tables.get(key) != first.tables.get(key):
            raise CaseError(
                f"{name}, line {step.case.line}, case {step.case.number}: [{key}] changes within a "
                "sequence (P = 0), which has no counterpart"
            )
    if step.tables["kind"] != "patch":
        raise CaseError(
            f"{name}, line {step.case.line}, case {step.case.number}: a sequence of wheels in "
            "transient rolling has no counterpart in a file: see docs/transient_wheels.md"
        )
    if step.tables["motion"]["regime"] != first.tables["motion"]["regime"]:
        raise several(step, name, "regime")
    return moving_of(step.tables) | step.tables["load"]
