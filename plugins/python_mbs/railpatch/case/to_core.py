"""From a checked case to the structs of the core, as dictionaries by field name.

A key whose name is that of a field of the core passes as it is, or with the first word of its table
before it; NAMES lists the others. What has another form there is made by a function below. What is
left out keeps the core's default. The case is resolved (case/resolve.py) once, at the head of
config_of().
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from railpatch import _core
from railpatch.case.creep_table import default_table, table_from
from railpatch.case.fluid import LIQUID_WATER, MOVED, OF_KNOT
from railpatch.case.friction import MOVED_FRICTION
from railpatch.case.gap import read_gap
from railpatch.case.load import Case, Scene, plain
from railpatch.case.longitudinal import shape_config
from railpatch.case.moving import BY_TABLE, moving_keys, refuse_unknown
from railpatch.case.own_influence import read_own_influence
from railpatch.case.patch import SHAPES, STEPWISE, PatchCase
from railpatch.case.resolve import choose, resolved
from railpatch.case.scene_profiles import Placed, Shelf, scene_profiles, sections_of
from railpatch.case.types import BODIES, MOST_POINTS, SIDES, Table, listed, show
from railpatch.case.wheel import Deviation, WheelRailCase, WheelsetCase
from railpatch.errors import CaseError
from railpatch.profiles import Profile
from railpatch.profiles.sections import matching_features, matching_sections

WheelCase = WheelRailCase | WheelsetCase
# first word of a field that holds a key of the table
WORDS = {
    "friction": "friction_",
    "layer": "layer_",
    "rail_support": "rail_",
    "bulk": "bulk_",
    "fluid": "fluid_",
}
# keys whose field has another name
NAMES = {
    "temperature.depth": "temperature_depth",
    "temperature.exchange": "heat_exchange",
    "track.kind": "track",
    # of an input
    "fluid.temperature": "water_temperature",
}
# the wheels deviate from the wheelset's table, the rails from the track's
DEVIATION = tuple(Deviation.model_fields)
BODY_OF_TABLE = {"wheelset": "wheel", "track": "rail"}
# columns and rows of rp_jacobian
POSE_AND_VELOCITY = (
    *("x", "y", "z", "roll", "yaw", "pitch"),
    *("speed", "vy", "vz", "roll_rate", "yaw_rate", "pitch_rate"),
)
FORCE_AND_MOMENT = ("fx", "fy", "fz", "mx", "my", "mz")


def field_of(table: str, key: str, fields: Mapping[str, Any]) -> str | None:
    """The field of the core that holds a key of a table; None where none does as it is."""
    known = (NAMES.get(f"{table}.{key}"), f"{WORDS[table]}{key}" if table in WORDS else None, key)
    return next((name for name in known if name in fields), None)


def passed(name: str, table: Table | None, fields: Mapping[str, Any]) -> dict[str, Any]:
    """What of a table passes as it is. name: the table's."""
    found: dict[str, Any] = {}
    for key, value in table or ():
        field = field_of(name, key, fields)
        if field is not None and value is not None:
            found[field] = int(value) if isinstance(value, bool) else value
    return found


def config_of(scene: Scene, shelf: Shelf | None = None) -> dict[str, Any]:
    """Fields of rp_config. shelf: of its profiles, where others use them too. Raises CaseError,
    ProfileError."""
    case, choice = resolved(scene.case), choose(scene.case)
    config: dict[str, Any] = {"kind": case.kind, **grid_config(case)}
    if choice is not None and case.has_tangential:
        config |= {"accuracy": scene.case.method.accuracy, "finer_grids": choice.finer}
    for name in ("material", "method", "motion", "geometry", "wheelset", "track", "wheel"):
        config |= passed(name, getattr(case, name, None), _core.CONFIG_FIELDS)
    config |= friction_config(case) | layer_config(case) | temperature_config(case)
    config |= fluid_config(case) | {"regime_changes": int(regime_changes(case))}
    if case.has_tangential and case.method.tangential == "table":
        file = case.method.table_file
        own = scene.folder / file if file is not None else None
        config["creep_table"] = default_table() if own is None else table_from(own.resolve())
    if isinstance(case, PatchCase):
        return config | patch_config(case, scene.folder)
    return config | wheel_config(case, scene.folder, shelf or Shelf(case, scene.folder))


def regime_changes(case: Case) -> bool:
    """Whether steps may have different regimes."""
    motion = case.motion
    changes = motion.changes if isinstance(case, PatchCase) else motion.regime_changes
    return changes and case.has_tangential


def friction_config(case: Case) -> dict[str, Any]:
    """Friction law."""
    friction = case.friction
    if friction is None:
        return {}
    config = passed("friction", friction, _core.CONFIG_FIELDS)
    if friction.law == "slip_velocity":
        # another form, of which that of the case's law is one
        config.pop("friction_coefficient", None)
        amplitudes, speeds = friction.terms
        config["slip_law"] = "exponential" if friction.shape == "polach" else friction.shape
        config["friction_kinetic"] = friction.kinetic_coefficient
        config["friction_amplitude"] = [*amplitudes, 0.0][:2]
        config["friction_halving_speed"] = [*speeds, 1.0][:2]
    names = ("position", "factor")
    if friction.factor is not None:
        config |= points_config("friction", names, friction.factor)
    if friction.along_track is not None:
        config |= points_config("friction_along", names, friction.along_track)
    return config


def layer_config(case: Case) -> dict[str, Any]:
    """Third-body layer."""
    config = passed("layer", case.layer, _core.CONFIG_FIELDS)
    if case.layer is None or case.layer.hardening_table is None:
        return config
    table = case.layer.hardening_table
    names = ("displacement", "stress")
    return config | {"layer_yield_stress": table[0][1]} | points_config("hardening", names, table)


def temperature_config(case: Case) -> dict[str, Any]:
    """Surface temperature."""
    if not has_heat(case):
        return {}
    found = passed("temperature", case.temperature, _core.CONFIG_FIELDS)
    found |= passed("bulk", case.temperature.bulk, _core.CONFIG_FIELDS)
    return {"temperature": 1, **found, **bulk_of(case)}


def fluid_config(case: Case) -> dict[str, Any]:
    """Liquid between wheel and rail."""
    fluid = case.fluid
    if fluid is None or not case.has_tangential:
        return {}
    config = passed("fluid", fluid, _core.CONFIG_FIELDS)
    config |= {f"fluid_{name}": value for name, value in fluid.core.items()}
    given = case.friction is not None and case.friction.coefficient is not None
    if not given and "fluid_boundary_friction" in config:
        config["friction_coefficient"] = config["fluid_boundary_friction"]
    if fluid.knots is not None:
        width = _core.CONFIG_FIELDS["fluid_knot_rate"]["shape"][0]
        config["fluid_knots"] = len(fluid.knots)
        for name, column in zip(OF_KNOT, zip(*fluid.knots, strict=True), strict=True):
            config[f"fluid_knot_{name}"] = [*column, *[0.0] * (width - len(column))]
    if fluid.viscosity_table is not None:
        names = ("temperature", "value")
        config |= points_config("fluid_viscosity", names, fluid.viscosity_table)
    return config


def points_config(prefix: str, names: tuple[str, str], points: list[list[float]]) -> dict[str, Any]:
    """A table of pairs as the core's arrays of fixed length."""
    columns = zip(*points, strict=True)
    padded = {
        f"{prefix}_{name}": [*column, *[0.0] * (MOST_POINTS - len(points))]
        for name, column in zip(names, columns, strict=True)
    }
    return {f"{prefix}_points": len(points), **padded}


def grid_config(case: Case) -> dict[str, Any]:
    """Elements by number or by size; the other is zero."""
    line = isinstance(case, PatchCase) and case.geometry.line_contact_radius is not None
    usual = listed("elements")["start"]
    counted = [usual, 1 if line else usual]
    if case.grid is None:
        return {"elements": counted, "element_size": [0.0, 0.0]}
    standard = [0, 0] if case.grid.element_size else counted
    return {
        "elements": case.grid.elements or standard,
        "element_size": case.grid.element_size or [0.0, 0.0],
        "max_elements": case.grid.max_elements or [0, 0],
        "fitted": case.grid.fitted or [0, 0],
    }


def patch_config(case: PatchCase, folder: Path) -> dict[str, Any]:
    """Geometry and load of a patch."""
    shape = next(name for name in SHAPES if getattr(case.geometry, name) is not None)
    config: dict[str, Any] = {
        "geometry": shape,
        "load": "force" if case.load.normal_force is not None else "position",
        "force_prescribed": [int(prescribed) for prescribed in case.motion.prescribed],
        "slip_by_element": int(case.motion.slip_field is not None and case.has_tangential),
    }
    if shape == "undeformed_distance":
        config[shape] = gap = read_gap(case.geometry.undeformed_distance, folder)
        file = case.material.influence_file
        if file is not None:
            config["own_influence"] = 1
            config["influence_coefficients"] = read_own_influence(
                (folder / file).resolve(), gap.shape, tractions=case.has_tangential
            )
    return config


def wheel_config(case: WheelCase, folder: Path, shelf: Shelf) -> dict[str, Any]:
    """Load, regime, profiles, rails and shapes of wheels."""
    found = case.wheelset.found
    config: dict[str, Any] = {
        "load": "position" if case.wheelset.z is not None else "force",
        "roll_balanced": int("roll" in found),
        "axle_free": int("pitch_rate" in found and case.wheelset.longitudinal_force is None),
        "longitudinal_prescribed": int(case.wheelset.longitudinal_force is not None),
        "regime": case.motion.regime if case.has_tangential else "none",
        **passed("rail_support", case.track.rail_support, _core.CONFIG_FIELDS),
    }
    profiles = profiles_config(case, shelf, scene_profiles(case, shelf))
    return {**config, **profiles, **origin_config(case), **shape_config(case, folder)}


def origin_config(case: WheelCase) -> dict[str, Any]:
    """Rails that lie where they are said to."""
    origins = [getattr(case.track, side).origin if side in case.sides else None for side in SIDES]
    if not any(origins):
        return {}
    columns = [[math.nan if o is None else o[k] for o in origins] for k in range(2)]
    return {"rail_origin_y": columns[0], "rail_origin_z": columns[1]}


def profiles_config(case: WheelCase, shelf: Shelf, placed: list[Placed]) -> dict[str, Any]:
    """Profiles of wheels and rails."""
    return {**{body: profile_pair(placed, body) for body in BODIES}, **sections_config(case, shelf)}


def profile_pair(placed: list[Placed], body: str) -> list[Any]:
    """[left, right] of the wheels or the rails; None for a side that has none of its own."""
    found = {p.side: profile_arrays(p.profile) for p in placed if p.body == body}
    return [found.get(side) for side in SIDES]


def profile_arrays(profile: Profile) -> dict[str, Any]:
    """The arrays of rp_profile."""
    return {key: getattr(profile, key) for key in ("arc_length", "y", "z", "dy", "dz")}


def sections_config(case: WheelCase, shelf: Shelf) -> dict[str, Any]:
    """Profiles of the rails along the track and of the wheels round them; [left, right]."""
    parts = {side: list(sections_of(case, side)) for side in case.sides}
    by_knot = any(part.features for side in case.sides for _, part in parts[side])
    config: dict[str, Any] = {}
    for body in BODIES:
        places = "wheel_section_angle" if body == "wheel" else "section_position"
        found = [[part for of, part in parts.get(side, ()) if of == body] for side in SIDES]
        if not any(found):
            continue
        config[f"{body}_sections"] = [
            section_arrays([shelf.profile(body, s.profile) for s in own], own, by_knot)
            for own in found
        ]
        config[places] = [[section.place for section in own] for own in found]
        kinks = [kinks_of(own, turns=body == "wheel") for own in found]
        if case.track.section_blend == "cubic" and any(map(any, kinks)):
            config["section_kink" if body == "rail" else "wheel_section_kink"] = kinks
    return config | ({"section_match": "knot"} if by_knot else {})


def kinks_of(sections: list[Any], *, turns: bool) -> list[int]:
    """1 of each section where the slope over the place changes at once: as it says, or between it
    and a neighbour a part begins or ends. turns: whether the first follows the last."""
    kinks = [int(section.kink) for section in sections]
    missing = [parts_missing(section) for section in sections]
    for k in range(0 if turns else 1, len(sections)):
        if missing[k] != missing[k - 1]:
            kinks[k] = kinks[k - 1] = 1
    return kinks


def parts_missing(section: Any) -> tuple[bool, ...]:
    """Of a section by part, up to its last feature."""
    places = [0.0, *(section.features or ())]
    return tuple(b == a for a, b in pairwise(places))


def section_arrays(
    profiles: list[Profile], sections: list[Any], by_knot: bool
) -> list[dict[str, Any]]:
    """The arrays of a list of sections. Raises ProfileError."""
    if not profiles:
        return []
    if by_knot:
        matched = matching_features(profiles, [section.features or () for section in sections])
    else:
        matched = matching_sections(profiles)
    return [profile_arrays(profile) for profile in matched]


def input_of(case: Case) -> dict[str, Any]:
    """Fields of rp_input."""
    values: dict[str, Any] = {}
    for name in case.moving:
        if name == "friction":  # its law is the config's
            values |= {field: getattr(case.friction, key) for field, key in MOVED_FRICTION.items()}
            continue
        values |= passed(name, getattr(case, name), _core.INPUT_FIELDS)
    if regime_changes(case):
        values["step_regime"] = _core.CHOICES["regime"].index(case.motion.regime)
    if isinstance(case, PatchCase):
        motion = case.motion
        values["creepage"] = motion.creepages[0]
        values["tangential_force"] = motion.forces
        if motion.slip_field is not None:
            values["slip_field"] = slip_array(motion.slip_field)
        if motion.distance is not None:
            values["distance"] = motion.step_distance
    else:
        for name in case.wheelset.found:
            del values[name]
        for table, body in BODY_OF_TABLE.items():
            sides = [getattr(getattr(case, table), side) for side in SIDES]
            for key in DEVIATION:
                values[f"{body}_{key}"] = [getattr(side, key) for side in sides]
    if has_heat(case):
        given = zip(bulk_of(case)["bulk_temperature"], case.temperature.stores, strict=True)
        values["bulk_temperature"] = [math.nan if stores else value for value, stores in given]
    return values


def slip_array(slip: list[list[list[float]]]) -> NDArray[np.float64]:
    """-, [2, lateral, along rolling]. Raises CaseError where rows are not of one length."""
    lengths = {len(row) for part in slip for row in part}
    if len(lengths) > 1 or len(slip[0]) != len(slip[1]):
        raise CaseError("motion.slip_field: value is of another shape, allowed that of the grid")
    return np.array(slip, dtype=float)


# keys of a step that are plain numbers in the core's input and, given by themselves, need no other
# check than their range
PLAIN = ("normal_force", "approach", "creepage", "spin_creepage", "rolling_speed")
PLAIN += (*MOVED, *MOVED_FRICTION)


def plain_moves(case: Case) -> dict[str, tuple[int, int, str, float, float]]:
    """Moving key -> where its numbers lie in rp_input, how many (0: no array), bounds, low, high.

    Those that one number or list changes: no tables, words, or numbers that count with others.
    """
    keys = moving_keys(case)
    if isinstance(case, PatchCase):
        # which components of the force are prescribed, and steps, hang on each other
        several = any(case.motion.prescribed) or len(case.motion.creepages) > 1
        names = ("normal_force", "approach") if several else PLAIN
    else:
        names = tuple(keys)
    members = _core.LAYOUTS["input"]["members"]
    moves = {}
    # of two ways to say how much liquid arrives one counts
    several_supplies = {"water_rate", "oil_film"} <= keys.keys()
    for name in names:
        if several_supplies and name in ("water_rate", "oil_film"):
            continue
        field = _core.INPUT_FIELDS.get(name)
        if name not in keys or field is None or len(field["shape"]) > 1:
            continue
        bounds = (field["bounds"], field["low"], field["high"])
        if name == "water_temperature" and case.fluid is not None and case.fluid.liquid == "water":
            bounds = ("[]", *LIQUID_WATER)
        moves[name] = (members[name][0], *(field["shape"] or (0,)), *bounds)
    return moves


def bulk_of(case: Case) -> dict[str, Any]:
    """Bulk temperatures, in a scene that has them."""
    if not has_heat(case):
        return {}
    return {"bulk_temperature": [getattr(case.temperature, body) for body in BODIES]}


def has_heat(case: Case) -> bool:
    """Whether there are temperatures; wheels whose tangential problem is left out have none."""
    rolls = isinstance(case, PatchCase) or case.has_tangential
    return case.temperature is not None and rolls


def rates_of(case: Case, direction: Mapping[str, Any]) -> dict[str, Any]:
    """Rates of the fields of rp_input, for rates of moving keys. Raises CaseError."""
    if not case.method.derivatives:
        raise CaseError("method.derivatives: value is False, allowed True for differentiate()")
    keys = {key: table for key, table in moving_keys(case).items() if key not in STEPWISE}
    if case.friction is not None and case.friction.law == "coulomb":
        keys["friction_coefficient"] = "friction"
    refuse_unknown(direction, keys, "")
    rates: dict[str, Any] = {}
    for key, value in plain(direction).items():
        if key == "temperature":
            table = part_of(value, BODIES, key)
            rates["bulk_temperature"] = [number(table.get(body, 0.0), key) for body in BODIES]
        elif key in BY_TABLE:
            for name, item in part_of(value, getattr(case, key).moving, key).items():
                add_rate(rates, name, item, key)
        else:
            add_rate(rates, key, value, keys[key])
    if isinstance(case, PatchCase) and "distance" in rates:
        rates["distance"] /= max(case.motion.of_steps.count("transient_rolling"), 1)
    return rates


def add_rate(rates: dict[str, Any], key: str, value: Any, table: str) -> None:
    """One rate, or those of a wheel's or rail's deviation."""
    if key not in SIDES:
        rates[key] = numbers(value, key, key)
        return
    for name, item in part_of(value, DEVIATION, key).items():
        field = f"{BODY_OF_TABLE[table]}_{name}"
        sides = rates.setdefault(field, [[0.0] * 3, [0.0] * 3])
        sides[SIDES.index(key)] = numbers(item, name, field)


def part_of(value: Any, allowed: tuple[str, ...], key: str) -> dict[str, Any]:
    """A table with some of the allowed keys."""
    if not isinstance(value, dict):
        raise CaseError(f"{key}: value is {show(value)}, allowed a table")
    refuse_unknown(value, dict.fromkeys(allowed), f"{key}.")
    return value


def numbers(value: Any, key: str, field: str) -> Any:
    """A finite number, or a list of as many as the core's field has, on each side."""
    shape = _core.INPUT_FIELDS[field]["shape"]
    if not shape:
        return number(value, key)
    length = shape[-1]
    if not isinstance(value, list) or len(value) != length:
        raise CaseError(f"{key}: value is {show(value)}, allowed {length} numbers")
    return [number(item, key) for item in value]


def number(value: Any, key: str) -> float:
    """A finite number."""
    real = isinstance(value, int | float) and not isinstance(value, bool)
    if not real or not math.isfinite(value):
        raise CaseError(f"{key}: value is {show(value)}, allowed a finite number")
    return float(value)
