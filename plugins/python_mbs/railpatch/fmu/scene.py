"""The scene inside an FMU: what its variables depend on, their start values, scene.txt."""

from __future__ import annotations

import re
import zlib
from collections.abc import Iterator
from typing import Any

import numpy as np

from railpatch import _core
from railpatch.case.load import Case, Scene
from railpatch.case.patch import PatchCase
from railpatch.config import config_of
from railpatch.errors import CaseError
from railpatch.fmu.table import Kind, Table, Variable, with_start

SIDE_INDEX = {"left": 0, "right": 1}
PROFILE_ARRAYS = ("arc_length", "y", "z", "dy", "dz")


def kind_of(case: Case, config: dict[str, list[float]]) -> Kind:
    """What the variables depend on. config: numbers of the core."""
    conditions = {"tangential"} if case.has_tangential else set()
    if case.has_tangential and case.method.tangential != "full":
        conditions.add("fast")
    if isinstance(case, PatchCase):
        conditions.add("force" if case.load.normal_force is not None else "position")
        for component, prescribed in enumerate(case.motion.prescribed, 1):
            conditions.add(f"force[{component}]" if prescribed else f"creepage[{component}]")
        return Kind("patch", (1,), 1, frozenset(conditions))
    conditions.add("force" if case.wheelset.vertical_force is not None else "position")
    if case.track.kind == "roller":
        conditions.add("roller")
    sides = tuple(SIDE_INDEX[side] for side in case.sides)
    return Kind(case.kind, sides, int(config["max_patches"][0]), frozenset(conditions))


def variables_of(table: Table, kind: Kind, case: Case) -> list[Variable]:
    """The scene's variables; inputs and parameters with the case's values as start."""
    found = [
        v if v.causality == "output" else with_start(v, start_of(v, case))
        for v in table.variables(kind)
    ]
    wrong = [v for v in found if v.start is not None and not within(v)]
    if wrong:
        raise CaseError(
            f"{v.name}: value is {v.start}, allowed in an FMU {v.range[0]:g} ... {v.range[1]:g}"
            for v in wrong
        )
    return found


def within(variable: Variable) -> bool:
    """Whether the start lies in the variable's own range."""
    low, high = variable.range
    assert variable.start is not None
    return low <= variable.start <= high


def start_of(variable: Variable, case: Case) -> float | int:
    """The case's value of an input or parameter."""
    name, index = split_name(variable.name)
    path = name.split(".")
    if isinstance(case, PatchCase) and len(path) == 1:
        path.insert(0, "load" if name in ("normal_force", "approach") else "motion")
    value: Any = case
    for part in path:
        value = getattr(value, part)
    if index is not None:
        value = value[index]
    if value is None:  # a roller's speed that the case leaves out
        value = 0.0
    return float(value) if variable.base == "Real" else int(value)


def split_name(name: str) -> tuple[str, int | None]:
    """'a.b[2]' -> 'a.b', 1."""
    match = re.fullmatch(r"(.*)\[(\d+)\]", name)
    return (match[1], int(match[2]) - 1) if match else (name, None)


def scene_text(scene: Scene, variables: list[Variable], guid: str) -> str:
    """resources/scene.txt; plugins/fmu/src/scene.hpp tells its form."""
    if getattr(getattr(scene.case, "track", None), "irregularity", None) is not None:
        raise CaseError("track.irregularity: given, allowed in an FMU none")
    config = config_of(scene)
    body = "\n".join([*lines_of(config, variables, guid), ""])
    return f"{body}end {zlib.crc32(body.encode('ascii')):08x}\n"


def lines_of(config: dict[str, Any], variables: list[Variable], guid: str) -> Iterator[str]:
    """All lines but the last."""
    refuse_track(config)
    yield "railpatch-fmu-scene 1"
    yield f"guid {guid}"
    for name, numbers in _core.config_numbers(config).items():
        yield f"set {name} {spell(numbers)}"
    for body in ("wheel", "rail"):
        for side, profile in enumerate(config.get(body, ())):
            for array in PROFILE_ARRAYS if profile is not None else ():
                values = profile[array]
                yield f"profile {body} {side} {array} {len(values)} {spell(values)}"
    if config.get("undeformed_distance") is not None:
        values = np.asarray(config["undeformed_distance"]).ravel()
        yield f"distance {values.size} {spell(values)}"
    for v in variables:
        yield f"variable {v.reference} {v.name} {spell([v.start or 0])}"


def refuse_track(config: dict[str, Any]) -> None:
    """Raises CaseError for what needs inputs that an FMU does not have: x and time_step."""
    for field, key in (
        ("rail_sections", "track.left.sections, track.right.sections"),
        ("friction_along_points", "friction.along_track"),
        ("rail_stiffness", "track.rail_support"),
    ):
        if field in config:
            raise CaseError(f"{key}: given, allowed in an FMU none")


def spell(numbers: Any) -> str:
    """The shortest text that gives the same bits again."""
    return " ".join(repr(n) for n in np.asarray(numbers).tolist())
