"""The scene inside an FMU: what its variables depend on, their start values, scene.txt."""

from __future__ import annotations

import re
import zlib
from collections.abc import Iterator
from typing import Any
from urllib.parse import quote

import numpy as np

from railpatch import _core
from railpatch.case.asked import refuse_asked
from railpatch.case.fluid import MOVED
from railpatch.case.load import Case, Scene
from railpatch.case.patch import PatchCase
from railpatch.case.to_core import config_of, input_of
from railpatch.case.types import SIDES
from railpatch.case.wheel import WheelRailCase, WheelsetCase
from railpatch.errors import CaseError
from railpatch.fmu.profiles import Choices
from railpatch.fmu.table import Kind, Table, Variable, items_of, with_start

# of options; what is not here is 0 where nothing is said
OPTION_DEFAULTS = {"friction_left": 1, "friction_right": 1}
PROFILE_ARRAYS = ("arc_length", "y", "z", "dy", "dz")
# word of a line, body, fields of the places and of kinks
SECTIONS = (
    ("section", "rail", "section_position", "section_kink"),
    ("wheel_section", "wheel", "wheel_section_angle", "wheel_section_kink"),
)


def kind_of(case: Case, config: dict[str, list[float]], *, averages: bool = False) -> Kind:
    """What the variables depend on. config: numbers of the core; averages: means over a step."""
    conditions = {"tangential"} if case.has_tangential else set()
    if has_history(case):
        conditions.add("history")
    if averages and not isinstance(case, PatchCase):
        conditions.add("averaged")
    if conditions & {"history", "averaged"}:
        conditions.add("substeps")
    conditions |= physics_conditions(case)
    if isinstance(case, PatchCase):
        conditions.add("force" if case.load.normal_force is not None else "position")
        for component, prescribed in enumerate(case.motion.prescribed, 1):
            conditions.add(f"force[{component}]" if prescribed else f"creepage[{component}]")
        return Kind("patch", (1,), 1, frozenset(conditions))
    conditions.add("force" if case.wheelset.vertical_force is not None else "position")
    if case.track.kind == "roller":
        conditions.add("roller")
    conditions |= along_conditions(case)
    most = int(config["max_patches"][0])
    if most > 1 and case.method.patch_rule != "contact":
        conditions.add("shares")
    sides = tuple(SIDES.index(side) for side in case.sides)
    return Kind(case.kind, sides, most, frozenset(conditions))


def physics_conditions(case: Case) -> set[str]:
    """Theory, law of friction, layer and temperature."""
    if not case.has_tangential:
        return set()
    friction, heat = case.friction, case.temperature
    law = None if friction is None else friction.law
    # with a liquid there may be no coefficient of dry surfaces
    coulomb = friction is not None and law == "coulomb" and friction.coefficient is not None
    found = {"coulomb"} if coulomb else set()
    if case.method.tangential != "full":
        found.add("fast")
    if case.layer is not None and case.layer.is_plastic:
        found.add("yields")
    if case.fluid is not None:
        found.add("fluid")
        found |= {name for name, key in MOVED.items() if getattr(case.fluid, key) is not None}
        if case.fluid.liquid is not None or case.fluid.viscosity_table is not None:
            found.add("fluid temperature")
    if heat is not None:
        found.add("temperature")
        if heat.exchange or heat.wheel != heat.rail:
            found.add("exchange")
        if law == "temperature":
            found.add("warm friction")
    return found


def has_history(case: Case) -> bool:
    """Whether a step depends on earlier ones, not only through the solver's start.

    Laws of friction that fall, and layers that yield, may have several solutions: the one next to
    the last step's is taken. In fast theories friction follows the rigid slip, and has one. With an
    accuracy a step begins on the grid where the last one ended.
    """
    if case.has_tangential:
        if case.motion.regime == "transient_rolling" or case.method.accuracy is not None:
            return True
        full = case.method.tangential == "full"
        if full and case.friction is not None and case.friction.law != "coulomb":
            return True
        if case.layer is not None and case.layer.is_plastic:
            return True
    # the rail's velocity counts as creepage, with dampers or without
    return not isinstance(case, PatchCase) and case.track.rail_support is not None


def along_conditions(case: WheelRailCase | WheelsetCase) -> set[str]:
    """What varies along the track or around the wheels, and rails that give way."""
    found = set()
    along = case.has_tangential and case.friction is not None and case.friction.along_track
    for side in case.sides:
        rail, wheel = getattr(case.track, side), getattr(case.wheelset, side)
        if rail.sections or rail.running_surface is not None or rail.joint:
            found |= {"shape along x", f"x {side}"}
        if along:
            found.add(f"x {side}")
        if wheel.runout is not None or wheel.flat or wheel.sections:
            found |= {"runout", f"pitch {side}"}
    if along and "shape along x" not in found:
        found.add("friction along x")
    if case.track.rail_support is not None:
        found.add("supported")
    return found


def variables_of(table: Table, kind: Kind, case: Case) -> list[Variable]:
    """The scene's variables; inputs and parameters with the case's values as start."""
    found = [
        with_start(v, start_of(v, case)) if v.causality in ("input", "parameter") else v
        for v in table.variables(kind)
    ]
    wrong = [v for v in found if isinstance(v.start, (int, float)) and not within(v)]
    if wrong:
        raise CaseError(
            f"{v.name}: value is {v.start}, allowed in an FMU {v.range[0]:g} ... {v.range[1]:g}"
            for v in wrong
        )
    return found


def within(variable: Variable) -> bool:
    """Whether the start lies in the variable's own range."""
    low, high = variable.range
    assert isinstance(variable.start, (int, float))
    return low <= variable.start <= high


def start_of(variable: Variable, case: Case) -> float | int | str:
    """The case's value of an input or parameter."""
    if variable.start is not None:
        return variable.start
    if variable.field.startswith("friction_scale"):
        return friction_start(variable, case)
    name, index = split_name(variable.name)
    path = name.split(".")
    if name in MOVED:
        path = ["fluid", MOVED[name]]
    elif isinstance(case, PatchCase) and len(path) == 1:
        path.insert(0, "load" if name in ("normal_force", "approach") else "motion")
    value: Any = case
    for part in path:
        value = getattr(value, part)
    if index is not None:
        value = value[index]
    if value is None:  # a roller's speed that the case leaves out
        value = 0.0
    return float(value) if variable.base == "Real" else int(value)


def friction_start(variable: Variable, case: Case) -> float:
    """Of one wheel: its coefficient, or the factor of the law."""
    assert variable.side is not None
    scale = 1.0 if case.friction is None else case.friction.scale[variable.side]
    if not variable.name.endswith("coefficient"):
        return scale
    assert case.friction is not None
    assert case.friction.coefficient is not None
    return case.friction.coefficient * scale


def split_name(name: str) -> tuple[str, int | None]:
    """'a.b[2]' -> 'a.b', 1."""
    match = re.fullmatch(r"(.*)\[(\d+)\]", name)
    return (match[1], int(match[2]) - 1) if match else (name, None)


def scene_text(
    scene: Scene,
    variables: list[Variable],
    guid: str,
    kind: Kind,
    derivatives: bool,
    choices: Choices,
) -> str:
    """resources/scene.txt; plugins/fmu/src/scene.hpp tells its form."""
    if getattr(getattr(scene.case, "track", None), "irregularity", None) is not None:
        raise CaseError("track.irregularity: given, allowed in an FMU none")
    refuse_asked(scene.case, "in an FMU: take them from a sweep or a rig")
    heat = scene.case.temperature
    if heat is not None and heat.bulk is not None:
        raise CaseError("temperature.bulk: given, allowed in an FMU none: temperatures are inputs")
    if scene.case.fluid is not None and scene.case.fluid.recovery is not None:
        raise CaseError("fluid.recovery: given, allowed in an FMU none: wheels are not cleaned")
    if scene.case.fluid is not None and scene.case.fluid.dries:
        raise CaseError("fluid.oxide.drying: given, allowed in an FMU none: wheels do not dry")
    config = {**config_of(scene), "derivatives": int(derivatives)}
    options = options_of(scene.case, kind)
    version = 3 if "version 3" in kind.conditions else 2
    body = "\n".join([*lines_of(config, options, variables, guid, choices, version), ""])
    return f"{body}end {zlib.crc32(body.encode('ascii')):08x}\n"


def options_of(case: Case, kind: Kind) -> dict[str, float]:
    """What the core does not know: numbers of a step that a solve at the start has not got."""
    start = input_of(case)
    return {
        "history": int("history" in kind.conditions),
        "averaged": int("averaged" in kind.conditions),
        "friction_input": int("friction input" in kind.conditions),
        "friction_sides": int("friction sides" in kind.conditions),
        **{f"friction_{side}": value for side, value in scales_of(case).items()},
        "profile_files": int("wheel files" in kind.conditions),
        "time_step": start.get("time_step", 0.0),
        "distance": start.get("distance", 0.0),
    }


def scales_of(case: Case) -> dict[str, float]:
    """Factors of the friction law by side."""
    friction = case.friction if case.has_tangential else None
    return dict(zip(SIDES, friction.scale if friction is not None else (1.0, 1.0), strict=True))


def lines_of(
    config: dict[str, Any],
    options: dict[str, float],
    variables: list[Variable],
    guid: str,
    choices: Choices,
    version: int,
) -> Iterator[str]:
    """All lines but the last."""
    yield "railpatch-fmu-scene 1"
    yield f"guid {guid}"
    for name, numbers in _core.config_numbers(config).items():
        # NaN stands for what is left out, which the core does by itself
        if not np.isnan(np.asarray(numbers, float)).all():
            yield f"set {name} {spell(numbers)}"
    for body in ("wheel", "rail"):
        for side, profile in enumerate(config.get(body, ())):
            for array in PROFILE_ARRAYS if profile is not None else ():
                yield f"profile {body} {side} {array} {spell_array(profile[array])}"
    for body, number, arrays in choices.arrays():
        for array in PROFILE_ARRAYS:
            yield f"choice {body} {number} {array} {spell_array(arrays[array])}"
    for word, body, place, kinks in SECTIONS:
        for side, sections in enumerate(config.get(f"{body}_sections", ())):
            for index, profile in enumerate(sections):
                position = config[place][side][index]
                yield f"{word} {side} {index} position 1 {spell([position])}"
                if config.get(kinks) and config[kinks][side][index]:
                    yield f"{word} {side} {index} kink 1 1"
                for array in PROFILE_ARRAYS:
                    yield f"{word} {side} {index} {array} {spell_array(profile[array])}"
    for name in ("runout", "rail_height"):
        for side, values in enumerate(config.get(name, ())):
            if values is not None:
                yield f"{name} {side} {spell_array(values)}"
    if config.get("undeformed_distance") is not None:
        yield f"distance {spell_array(np.asarray(config['undeformed_distance']).ravel())}"
    for name, value in options.items():
        if value != OPTION_DEFAULTS.get(name, 0):
            yield f"option {name} {spell([value])}"
    for v in variables:
        if v.causality == "local":
            yield constant_line(v)
            continue
        yield f"variable {v.reference} {v.name} {spell([v.start or 0])}"
        if v.held:
            yield f"held {v.reference}"
    for item in items_of(variables, version):
        if item.is_array:
            yield f"array {item.first.reference} {len(item.variables)}"


def constant_line(variable: Variable) -> str:
    """A constant of the scene; words of a text are joined by their code."""
    start = variable.start
    if variable.base == "String":
        word = quote(str(start), safe="") or "%00"
        return f"constant {variable.reference} text {variable.name} {word}"
    kind = {"Real": "real", "Integer": "integer", "Boolean": "boolean"}[variable.base]
    number = float(start) if kind == "real" else int(start or 0)
    return f"constant {variable.reference} {kind} {variable.name} {number!r}"


def spell_array(values: Any) -> str:
    """How many, and each."""
    return f"{len(values)} {spell(values)}"


def spell(numbers: Any) -> str:
    """The shortest text that gives the same bits again; "-" for NaN."""
    return " ".join("-" if n != n else repr(n) for n in np.asarray(numbers).tolist())
