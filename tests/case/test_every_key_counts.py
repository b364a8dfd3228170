"""A key that does nothing is a defect.

Every key of the schema is changed on every kind, method, regime and law. The change shows in the
numbers of the results, or the case is refused by a text that names the key, or the key stands in
IDLE with the reason why it does nothing there. That a method, regime or law does not read a key is
no reason: such a key is refused. One key at a time on base cases, and on pairs of
features: some here, all in `make test-long`.
"""

from __future__ import annotations

import functools
import itertools
import random
import typing
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
import railpatch
from bits.combinations import COMMON, HEAT, OF_PATCHES, OF_WHEELS, PATCH_BASE, WHEEL_BASE
from bits.combinations import WHEELSET_BASE as ON_RAILS
from case_samples import with_values
from railpatch import _core
from railpatch.case import scene_profiles
from railpatch.case.load import KINDS
from railpatch.case.theories import READERS
from railpatch.case.types import Table

Case = dict[str, Any]
Numbers = dict[str, Any]

# --- base cases ----------------------------------------------------------------------------------

SMALL = {"patch": {"elements": [8, 8]}, "wheels": {"element_size": [1.6e-3, 1.6e-3]}}
# tangential methods and regimes differ by what they read; these are not worth a base of their own
LEFT_OUT = {"derivatives", "element size", "elements"}
# a wheel that is as warm as the rail or nearly so, in place of one that is warmer than the contact
ALONE = {"temperature": {"wheel": 22.0, "rail": 20.0, "exchange": True}}
STORED = {
    **{f"temperature__{key}": value for key, value in HEAT["temperature"].items()},
    "temperature__bulk": {
        "mass": [0.2, 0.3],
        "air_conductance": [12.0, 30.0],
        "air_temperature": 5.0,
    },
    "wheelset__time_step": 0.5,
}
LOADED = {"wheelset__z": None, "wheelset__vertical_force": 1.2e5}
# two areas of contact on the right rail
TWO_AREAS = {
    **LOADED,
    "profiles__rail": "UIC60@1:20",
    "wheelset__y": 5.8e-3,
}
# shapes as deep as the contact, which then goes on
SHALLOW = {
    "flat": {"wheelset__right": {"flat": {"depth": 2e-5, "angle": 0.0}}},
    "joint": {"track__right": {"joint": {"position": 1e-3, "depth": 2e-5, "step": 1e-5}}},
    "runout": {"wheelset__right": {"runout": [4e-6 * (k % 4 - 1.5) ** 2 for k in range(16)]}},
}


def features(kind: str) -> dict[str, dict[str, Any]]:
    """By name; pairs whose case is refused fall out of themselves."""
    own = OF_PATCHES if kind == "patch" else OF_WHEELS
    found = {name: f for name, f in {**COMMON, **own}.items() if name not in LEFT_OUT}
    if kind != "patch":
        found |= {name: {**LOADED, **shape} for name, shape in SHALLOW.items()}
        found["curve"] = {**LOADED, **found["curve"]}
        found["roller"] = {**found["roller"], "wheelset__yaw": 4e-3}
        found["inclined frame"] = {**found["roller"], **found["inclined frame"]}
        found["flange"] = TWO_AREAS
        found["stored heat"] = STORED
        found["patch rule"] = {**TWO_AREAS, "method__patch_rule": "contact"}
    if kind == "wheelset":
        del found["other side"]
    return {**found, "temperature": ALONE, "warm wheel": HEAT}


def base_of(kind: str) -> Case:
    base = {"patch": PATCH_BASE, "wheelset": ON_RAILS, "wheel_rail": WHEEL_BASE}[kind]
    if kind == "patch":
        return {**base, "grid": SMALL["patch"]}
    return with_values(base, grid=SMALL["wheels"], wheelset__y=5e-4)


def with_features(kind: str, *names: str) -> Case:
    case = base_of(kind)
    for name in names:
        case = with_values(case, **features(kind)[name])
    return case


KEYS_OF_SOME = 14
ONE_WHEEL = ("other side", "roller", "transient", "vertical force")
SINGLE = [
    (kind, *names)
    for kind in KINDS
    for names in ((), *((name,) for name in features(kind)))
    if kind != "wheel_rail" or not names or names[0] in ONE_WHEEL
]

# wheels of which all keys are changed each time
WHEELS = (
    "",
    "slip velocity",
    "temperature law",
    "warm wheel",
    "tangential fastsim",
    "plastic layer",
    "stored heat",
)
WHEELS += ("transient", "roller", "rail support", "flange", "joint")


def whole(names: tuple[str, ...]) -> bool:
    return names[0] == "patch" or (names[0] == "wheelset" and "".join(names[1:]) in WHEELS)


# --- keys and other values -----------------------------------------------------------------------

LEVEL = [[-1.0, 0.0], [0.0, 2e-5], [1.0, 0.0], [2.0, 1e-5]]
# whole tables, and numbers that are left out or 0 in a base case: one value that should count
VALUES: dict[str, Any] = {
    "friction": {"coefficient": 0.2},
    "layer": {"thickness": 5e-5, "shear_modulus": 8e9},
    "temperature": {"wheel": 20.0, "rail": 20.0},
    "temperature.bulk": {"mass": 0.1, "air_conductance": 20.0, "air_temperature": 9.0},
    "grid": {"elements": [9, 9]},
    "grid.elements": [9, 9],
    "grid.element_size": [1.1e-3, 1.1e-3],
    "grid.max_elements": [40, 40],
    "grid.fitted": [7, 7],
    "load.normal_force": 9e4,
    "load.approach": 9e-5,
    "geometry.semi_axes": [5e-3, 6e-3],
    "geometry.curvatures": [0.9, 1.1],
    "geometry.line_contact_radius": 0.4,
    "geometry.width": 0.1,
    "geometry.undeformed_distance": [[1e-5, 2e-5], [0.0, 1e-5]],
    "motion.creepage": [1.3e-3, -5e-4],
    "motion.tangential_force": [-1e4, 1e3],
    "motion.distance": 2e-3,
    "motion.steps": 3,
    "motion.rolling_speed": 12.0,
    "motion.spin_creepage": 0.3,
    "friction.coefficient": 0.25,
    "friction.kinetic": 0.15,
    "friction.amplitude": 0.2,
    "friction.halving_speed": 0.01,
    "friction.polach_a": 0.5,
    "friction.polach_b": 20.0,
    "friction.memory_distance": 1e-3,
    "friction.memory_speed": 0.1,
    "friction.reference": 0.45,
    "friction.change": -0.3,
    "friction.reference_temperature": 20.0,
    "friction.temperature_range": 100.0,
    "friction.factor": [[-0.05, 1.0], [0.05, 0.5]],
    "friction.along_track": [[-1.0, 0.5], [1.0, 1.0]],
    "layer.shear_modulus": 6e9,
    "layer.thickness": 4e-5,
    "layer.yield_stress": 5e7,
    "layer.hardening": 1e12,
    "layer.hardening_table": [[0.0, 5e7], [1e-5, 6e7]],
    "method.max_iterations": 50,
    "method.max_work": 1,
    "method.accuracy": 0.03,
    "method.traction_bound": "elliptic",
    "method.percent_kalker": 80.0,
    "method.standstill_speed": 0.5,
    "wheelset.x": 0.05,
    "wheelset.z": 2.2e-4,
    "wheelset.vertical_force": 9e4,
    "wheelset.roll": 2e-4,
    "wheelset.yaw": 2e-3,
    "wheelset.pitch": 0.03,
    "wheelset.speed": 2.004,
    "wheelset.vy": 2e-3,
    "wheelset.vz": 3e-3,
    "wheelset.roll_rate": 3e-3,
    "wheelset.yaw_rate": 1e-2,
    "wheelset.time_step": 3e-4,
    "wheelset.max_patches": 3,
    "wheelset.flange_back_position": -0.0702,
    "track.cant": 0.02,
    "track.curvature": 1e-3,
    "track.gauge_widening": 1e-3,
    "track.roller_radius": 0.7,
    "track.roller_pitch_rate": 12.48,
    "fluid": {"model": "film", "roughness": 1e-6, "viscosity": 1e-3},
    "fluid.boundary_friction": 0.12,
    "fluid.mean_pressure": 5e8,
    "fluid.viscosity": 0.12,
    "fluid.liquid": "water",
    "fluid.viscosity_table": [[0.0, 0.3], [50.0, 0.05]],
    "fluid.pressure_coefficient": 1.3e-8,
    "fluid.temperature": 35.0,
    "fluid.water_rate": 1e-8,
    "fluid.oil_film": 4e-6,
    "fluid.starvation": 0.8,
    "fluid.liquid_conductivity": 0.3,
    "fluid.eyring_stress": 4e6,
    "fluid.oxide": {"solid_content": 0.3},
    "fluid.roughness": 1.3e-6,
    "fluid.knots": [[0.0, 1.0, 0.4, 0.5, 0.4, 0.6], [1e-6, 0.3, 0.1, 0.2, 0.5, 0.2]],
    "fluid.reference_rate": 2e-9,
    "fluid.recovery": {"coefficient": 2e-3},
    "fluid.rail_work": [500.0, 700.0],
    "friction.scale": [0.8, 0.7],
    "track.rail_support": {"stiffness": [3e7, 9e7]},
    "profiles.smoothing": 1e-3,
    "profiles.wheel": "cone@1:20",
    "profiles.rail": "UIC60",
    **{
        f"wheelset.{side}.sections": [
            {"angle": 0.0, "profile": "S1002"},
            {"angle": 0.01, "profile": "cone@1:20"},
        ]
        for side in ("left", "right")
    },
}
OF_SIDES = {
    "offset": [1e-4, 2e-4, 1e-4],
    "rotation": [1e-3, 0.0, 0.0],
    "velocity": [1e-3, 2e-3, 1e-3],
    "angular_velocity": [1e-3, 2e-2, 1e-3],
    "runout": [1e-5 * (k % 3) for k in range(12)],
    "flat": {"depth": 3e-4, "angle": 0.0},
    "flat.angle": 0.004,
    "running_surface": LEVEL,
    "joint": {"position": 0.0, "depth": 1e-3},
    "joint.gap": 2e-3,
    "joint.position": 0.05,
    "sections": [{"position": 0.0, "profile": "UIC60"}],
    "origin": [0.75, 1e-5],
}


def keys_of(model: type[Table], content: Case, prefix: str = "") -> Iterator[tuple[str, Any, Any]]:
    """Path, type and value of all keys; into tables that are there or have a default."""
    for name, field in model.model_fields.items():
        path = f"{prefix}{name}"
        table = table_in(field.annotation)
        value = content.get(name)
        if table is None:
            yield path, field, value if name in content else field.default
            continue
        if value is None and field.default is None:
            yield path, field, None
        elif value is None and field.is_required():
            continue
        else:
            yield from keys_of(table, value or {}, f"{path}.")


def table_in(annotation: Any) -> type[Table] | None:
    """The table that a key holds."""
    for part in (annotation, *typing.get_args(annotation)):
        if isinstance(part, type) and issubclass(part, Table):
            return part
    return None


def words_in(annotation: Any) -> tuple[Any, ...]:
    """All words of a choice."""
    if typing.get_origin(annotation) is typing.Literal:
        return typing.get_args(annotation)
    found: tuple[Any, ...] = ()
    for part in typing.get_args(annotation):
        found += words_in(part)
    return found


def listed_value(path: str) -> Any:
    """From the tables above."""
    if path in VALUES:
        return VALUES[path]
    rest = path.partition(".")[2]
    side, _, name = rest.partition(".")
    return OF_SIDES.get(name) if side in ("left", "right") else None


def others(path: str, field: Any, value: Any) -> list[Any]:
    """Other values for a key."""
    if path == "kind":
        return []
    words = words_in(field.annotation)
    if words and not isinstance(value, list):
        return [word for word in words if word != value]
    if isinstance(value, bool):
        return [not value]
    listed = listed_value(path)
    if listed is not None and listed != value:
        return [listed]
    if path.startswith("material."):
        # alike, and unlike
        one, two = value if isinstance(value, list) else (value, value)
        return [[1.05 * one] * 2, [one, 1.05 * two]]
    if isinstance(value, float):
        return [value * 1.07] if value != 0 else [1e-3]
    if isinstance(value, int):
        return [value + 1]
    if isinstance(value, list):
        return [scaled(value, 1.07)]
    return []


def scaled(value: Any, factor: float) -> Any:
    """The same list with other numbers."""
    if isinstance(value, list):
        return [scaled(item, factor + 0.01 * k) for k, item in enumerate(value)]
    return value * factor if isinstance(value, float) else value


# --- results -------------------------------------------------------------------------------------

NO_NUMBERS = {"wall_time", "stages", "status", "kind"}


def numbers(value: Any, name: str = "") -> Iterator[tuple[str, Any]]:
    """Of a result, by name; iterations and residuals are none of its quantities."""
    if isinstance(value, dict):
        for key, item in value.items():
            if key not in NO_NUMBERS:
                yield from numbers(item, f"{name}.{key}")
    elif isinstance(value, list):
        for k, item in enumerate(value):
            yield from numbers(item, f"{name}[{k}]")
    else:
        yield name, value


def moved(case: Case) -> dict[str, float]:
    """Inputs of the second step."""
    if case["kind"] == "patch":
        return {"spin_creepage": 0.1} if "spin" in str(case["motion"]) else {}
    return {"y": case["wheelset"]["y"] + 2e-4, "x": 2e-3, "pitch": -4e-3}


def steps_of(contact: railpatch.Contact, case: Case, *, fields: bool = False) -> Iterator[Any]:
    yield contact.step(fields=fields)
    yield contact.step(**moved(case), fields=fields)


def run(case: Case, *, fields: bool = False) -> Iterator[Any]:
    """Results of two steps, the second elsewhere, and a derivative where there are some."""
    contact = railpatch.Contact(case)
    yield from steps_of(contact, case, fields=fields)
    if case.get("motion", {}).get("regime") in ("shift", "transient_rolling"):
        # steps are those of a solve
        yield railpatch.solve(case)
    if case.get("method", {}).get("derivatives"):
        yield contact.differentiate(**dict.fromkeys(moved(case), 1.0))


@pytest.fixture(scope="module", autouse=True)
def profiles_read_once() -> Iterator[None]:
    """Splines of built-in profiles are the same in every case."""
    first = scene_profiles.load_profile

    @functools.cache
    def read(name: str, body: Any, folder: Path, smoothing: float | None, reading: Any) -> Any:
        return first(name, body, folder=folder, smoothing=smoothing, reading=reading)

    scene_profiles.load_profile = lambda name, body, *, folder, smoothing, reading: read(
        name, body, folder, smoothing, reading
    )
    yield
    scene_profiles.load_profile = first


# --- what may do nothing -------------------------------------------------------------------------


def get(case: Case, path: str, default: Any = None) -> Any:
    table: Any = case
    for part in path.split("."):
        table = table.get(part) if isinstance(table, dict) else None
    return default if table is None else table


def has_tangential(case: Case) -> bool:
    regime = get(case, "motion.regime", "none" if "motion" not in case else "steady_rolling")
    if case["kind"] != "patch":
        regime = "rolls"
    return regime != "none" and get(case, "method.tangential", "full") != "none"


def varies_along(case: Case) -> bool:
    text = of_own_side(case, "track")
    return any(word in text for word in ("running_surface", "joint", "sections", "irregularity"))


class Idle(typing.NamedTuple):
    """key: or what it begins with. where: it does nothing. counts: features of a base case in which
    it does something; None: nowhere among these cases."""

    key: str
    where: Callable[[Case, str, Any], bool]
    why: str
    counts: tuple[str, ...] | None = None


def nowhere(case: Case, path: str, value: Any) -> bool:
    return True


def without_tangential(case: Case, path: str, value: Any) -> bool:
    return not has_tangential(case)


def is_default(case: Case, path: str, value: Any) -> bool:
    """Where a choice is left out: its first word."""
    name = path.rpartition(".")[2]
    return get(case, path) is None and _core.CONFIG_FIELDS[name]["start"] == value


def other_side(case: Case, path: str, value: Any) -> bool:
    if case["kind"] != "wheel_rail":
        return False
    return get(case, "wheel.side", "right") != path.split(".")[1]


def of_own_side(case: Case, table: str) -> str:
    """What a table says of the sides that have a wheel."""
    other = {"left": "right", "right": "left"}[get(case, "wheel.side", "right")]
    dropped = other if case["kind"] == "wheel_rail" else ""
    return str({key: value for key, value in case[table].items() if key != dropped})


def needs_no_length(case: Case, path: str, value: Any) -> bool:
    return not varies_along(case) and not get(case, "friction.along_track")


def runs_round(case: Case, path: str, value: Any) -> bool:
    own = of_own_side(case, "wheelset")
    shaped = any(word in own for word in ("runout", "sections"))
    return not shaped and "flat" not in own.replace("flange", "")


def bound_by_default(case: Case, path: str, value: Any) -> bool:
    normal = get(case, "method.normal", "half_space")
    quadratic = case["kind"] == "patch" and normal == "half_space"
    as_contact = get(case, "method.flexibility_blending") == "contact"
    ellipse = normal == "hertz" or quadratic
    return value == ("parabolic" if ellipse and as_contact else "elliptic")


def spin_by_default(case: Case, path: str, value: Any) -> bool:
    if get(case, "method.spin_offset") is not None:
        return False
    steps = get(case, "method.tangential", "full") == "full" and not get(case, "grid.fitted")
    rolls = get(case, "motion.regime") not in ("shift", "none")
    layer = get(case, "layer.thickness", 0.0) > 0
    return value == ("quarter" if steps and rolls and not layer else "none")


def untouched(case: Case, path: str, value: Any) -> bool:
    if case["kind"] != "wheelset":
        return False
    contact, side = railpatch.Contact(case), path.split(".")[1]
    return not any(step[side]["patches"] for step in steps_of(contact, case))


def sticks(case: Case, path: str, value: Any) -> bool:
    if case["kind"] == "patch":
        return False
    contact = railpatch.Contact(case)
    patches = [
        patch
        for step in steps_of(contact, case)
        for side in ("left", "right")
        for patch in step.data.get(side, {}).get("patches", ())
    ]
    return bool(patches) and not any(patch["elements"]["slip"] for patch in patches)


def yields(case: Case) -> bool:
    return any(get(case, f"layer.{key}") for key in ("yield_stress", "hardening_table"))


def closed(case: Case, path: str, value: Any) -> bool:
    if case["kind"] != "patch" or get(case, "method.normal") != "hertz":
        return False
    method = get(case, "method.tangential", "full")
    return get(case, "grid.fitted") is not None or method in ("linear", "polach", "table")


def still(case: Case, path: str, value: Any) -> bool:
    return get(case, "motion.rolling_speed") == 0


def without_spin(case: Case, path: str, value: Any) -> bool:
    turning = ("wheelset.speed", "wheelset.pitch_rate", "wheelset.yaw_rate")
    turning += ("track.roller_pitch_rate",)
    return case["kind"] != "patch" and not any(get(case, key) for key in turning)


# keys of [method] that only rolling reads
OF_ROLLING = [f"method.{name}" for name in ("tangential", "spin_offset", *READERS)]
IDLE = [
    Idle("grid", closed, "closed forms have no elements: the text of [grid] says so", ()),
    Idle("method.max_iterations", nowhere, "a limit that these cases do not reach"),
    Idle("method.tolerance", nowhere, "what is solved better than asked for stays as it is"),
    Idle("grid.max_elements", nowhere, "room for more than these cases need"),
    Idle("wheelset.max_patches", nowhere, "room for more than these cases need"),
    Idle("profiles.smoothing", nowhere, "of profile files; built-in profiles are formulas"),
    Idle("motion", without_tangential, "how bodies move, even where nothing sticks to them", ()),
    *(
        Idle(key, still, "where nothing rolls there is no micro-slip and no traction", ())
        for key in ("friction", "layer", "motion", "fluid", *OF_ROLLING)
    ),
    Idle(
        "wheelset.pitch_rate",
        lambda c, k, v: v == "free" and without_spin(c, k, v),
        "an axle at rest has no torque: that rate is found",
        (),
    ),
    Idle("method.spin_offset", without_spin, "wheels that do not turn have no spin", ()),
    Idle(
        "method.flexibility_blending",
        without_spin,
        "full sliding has no flexibility",
        ("tangential fastsim",),
    ),
    Idle("method.spin_offset", spin_by_default, "the one that is taken anyway", ()),
    Idle(
        "method.spin_offset",
        lambda c, k, v: v == "contact" and get(c, "method.spin_offset") == "sixth",
        "in steady rolling a sixth too",
        (),
    ),
    Idle("motion.regime_changes", nowhere, "lets steps have another regime; these have one"),
    Idle(
        "method.tangential",
        lambda c, k, v: get(c, "motion.regime") == "none",
        "without motion none is taken anyway",
        (),
    ),
    Idle(
        "friction",
        lambda c, k, v: get(c, "method.tangential") == "linear",
        "says where the linear theory ends, in the status alone",
        (),
    ),
    Idle(
        "method.fastsim_beta",
        lambda c, k, v: get(c, "method.fastsim_alpha", 1.0) == 1.0,
        "the part that falls has the factor 1 - fastsim_alpha",
        ("modified fastsim",),
    ),
    Idle("method.traction_bound", bound_by_default, "the one that is taken anyway", ()),
    *(
        Idle(f"method.{key}", is_default, "the one that is taken anyway")
        for key in ("contact_frame", "patch_rule")
    ),
    *(
        Idle(f"{table}.{side}", untouched, "that wheel does not touch", ())
        for table in ("wheelset", "track")
        for side in ("left", "right")
    ),
    Idle(
        "track.curvature",
        lambda c, k, v: c["wheelset"]["speed"] == 0,
        "who stands still goes through no curve",
        (),
    ),
    Idle(
        "method.patch_rule",
        lambda c, k, v: "y" not in c["wheelset"] or c["wheelset"]["y"] < 4e-3,
        "one area of contact on each rail",
        ("flange",),
    ),
    Idle(
        "method.standstill_speed",
        lambda c, k, v: abs(c["wheelset"]["speed"]) + abs(get(c, "track.roller_pitch_rate", 0)) > 1,
        "faster than that",
        ("standstill",),
    ),
    Idle(
        "motion.rolling_speed",
        lambda c, k, v: get(c, "motion.regime") == "shift",
        "a shift has no speed",
        (),
    ),
    Idle(
        "temperature.exchange",
        lambda c, k, v: c["temperature"]["wheel"] != c["temperature"]["rail"],
        "bodies that are unequally warm from the start exchange heat anyway",
    ),
    Idle(
        "temperature.bulk",
        lambda c, k, v: not get(c, "wheelset.time_step"),
        "no time passes between the steps",
        ("rail support", "warm wheel"),
    ),
    Idle(
        "layer.shear_modulus",
        lambda c, k, v: get(c, "layer.thickness") == 0,
        "a thickness of 0 leaves the elastic layer out",
        ("elastic layer",),
    ),
    *(
        Idle(f"{table}.{side}", other_side, "the other side has no wheel", ())
        for table in ("wheelset", "track")
        for side in ("left", "right")
    ),
    Idle(
        "friction",
        lambda c, k, v: yields(c),
        "the layer yields before friction is reached",
        (),
    ),
    Idle(
        "layer.plastic_rule",
        lambda c, k, v: get(c, "layer.hardening_table") is not None,
        "a path that does not turn is as long as its sum",
        ("plastic layer",),
    ),
    Idle("friction", sticks, "two short steps from rest slide nowhere", ()),
    Idle(
        "wheelset.x",
        lambda c, k, v: get(c, "method.tangential") == "linear" and not varies_along(c),
        "friction along the track, which says where the linear theory ends",
        ("joint",),
    ),
    Idle("wheelset.x", needs_no_length, "nothing varies along the track", ("joint",)),
    Idle(
        "friction.coefficient",
        lambda c, k, v: (
            (get(c, "fluid.boundary_friction") and not get(c, "fluid.water_rate"))
            or get(c, "fluid.model") == "regimes"
        ),
        "of dry surfaces, as soon as a step limits the supply of liquid",
    ),
    Idle("fluid.limiting_friction", nowhere, "a limit that the oil of these cases does not reach"),
    Idle(
        "fluid.oil_film",
        lambda c, k, v: get(c, "fluid.share") == "load_sharing",
        "less than the valleys of touching surfaces hold",
    ),
    Idle("wheelset.pitch", runs_round, "the wheels are round", ("runout",)),
]


def idle(path: str, case: Case, value: Any) -> str | None:
    """Why a key may do nothing."""
    for entry in IDLE:
        of_it = path == entry.key or path.startswith(f"{entry.key}.")
        if of_it and entry.where(case, path, value):
            return entry.why
    return None


# --- the test ------------------------------------------------------------------------------------


def put(case: Case, path: str, value: Any) -> Case:
    return with_values(case, **{path.replace(".", "__"): value})


def differ(plain: list[Numbers], changed: Iterator[Numbers]) -> bool:
    """Whether results do; no more of them are asked for than that takes."""
    same = lambda x, y: x == y or (x != x and y != y)  # noqa: E731
    return any(
        a is None or b is None or a.keys() != b.keys() or not all(same(a[k], b[k]) for k in a)
        for a, b in itertools.zip_longest(plain, changed)
    )


# what the solver spent is not what it found, nor what it thinks of its errors; fields would hide
# what no number of the result shows
SPENT = ("iterations", "residual", "evaluations", "ambiguous", "error_estimate")
OF_FIELDS = ("temperature.depth",)


def found(case: Case, path: str) -> Iterator[Numbers]:
    """What is looked at for a key."""
    for result in run(case, fields=path in OF_FIELDS):
        values = numbers(result.to_dict())
        yield {key: v for key, v in values if not any(word in key for word in SPENT)}


def dead_keys(case: Case, only: random.Random | None = None) -> list[str]:
    """Keys that change nothing, and refusals that do not name the key."""
    try:
        plain = {path: list(found(case, path)) for path in ("", *OF_FIELDS)}
    except railpatch.CaseError:
        return []
    dead = []
    keys = [key for key in keys_of(KINDS[case["kind"]], case) if others(*key)]
    for path, field, value in only.sample(keys, KEYS_OF_SOME) if only else keys:
        for other in others(path, field, value):
            try:
                counts = differ(plain.get(path, plain[""]), found(put(case, path, other), path))
            except (railpatch.CaseError, railpatch.ProfileError) as error:
                if not names_key(str(error), path, other):
                    dead.append(f"{path} = {other!r}: refused by {str(error)[:200]!r}")
                continue
            if not counts and idle(path, case, other) is None:
                dead.append(f"{path} = {other!r}: changes nothing")
    return dead


def names_key(text: str, path: str, value: Any) -> bool:
    """Whether a refusal says which key it is: by its name, a word it was given, or as one of the
    elastic constants, whose relation counts."""
    if path.startswith("material.") and "material" in text:
        return True
    return path.rpartition(".")[2] in text or (isinstance(value, str) and repr(value) in text)


def traits(case: Case) -> tuple[str, ...]:
    """Kind, methods, regime and law."""
    return (
        case["kind"],
        get(case, "method.normal", "half_space"),
        get(case, "method.tangential", "full"),
        get(case, "motion.regime", "steady_rolling"),
        get(case, "friction.law", "coulomb"),
        "fitted" if get(case, "grid.fitted") else "grid",
    )


@pytest.mark.parametrize("names", [n for n in SINGLE if whole(n)], ids=" ".join)
def test_one_key_at_a_time(names: tuple[str, ...]) -> None:
    dead = dead_keys(with_features(*names))
    assert not dead, "\n".join(dead)


@pytest.mark.parametrize("names", [n for n in SINGLE if not whole(n)], ids=" ".join)
def test_some_keys_of_wheels(names: tuple[str, ...]) -> None:
    """Of what takes wheels long, all with the pairs."""
    dead = dead_keys(with_features(*names), only=random.Random(SINGLE.index(names)))
    assert not dead, "\n".join(dead)


def test_idle_keys_count_elsewhere() -> None:
    """What may do nothing in some cases does something in the base case that its entry names."""
    for entry in IDLE:
        kinds = [
            k for k in ("patch", "wheelset") if entry.counts and entry.counts[0] in features(k)
        ]
        counted = [counts(with_features(kind, *entry.counts), entry.key) for kind in kinds]
        assert any(counted) or not entry.counts, entry.key


def counts(case: Case, wanted: str) -> bool:
    """Whether a key does something."""
    for path, field, value in keys_of(KINDS[case["kind"]], case):
        if path != wanted:
            continue
        plain = list(found(case, path))
        for other in others(path, field, value):
            try:
                if differ(plain, found(put(case, path, other), path)):
                    return True
            except railpatch.CaseError:
                continue
    return False


def pairs_of(kind: str) -> list[tuple[str, ...]]:
    """Two features at a time, and a left wheel on its own."""
    if kind == "wheel_rail":
        return [(kind, "other side", name) for name in features(kind) if name != "other side"]
    return [(kind, *names) for names in itertools.combinations(features(kind), 2)]


PAIRS = [pair for kind in KINDS for pair in pairs_of(kind)]
REST = [names for names in SINGLE if not whole(names)]
SOME = random.Random(20261122).sample(PAIRS, 60)


@pytest.mark.parametrize("part", range(4))
def test_keys_of_some_pairs(part: int) -> None:
    dead = []
    for k, names in enumerate(SOME[part::4]):
        some = random.Random(100 * part + k)
        dead += [(names, text) for text in dead_keys(with_features(*names), only=some)]
    assert not dead, dead


@pytest.mark.long
@pytest.mark.parametrize("names", [*REST, *PAIRS], ids=" ".join)
def test_keys_of_all_pairs(names: tuple[str, ...]) -> None:
    dead = dead_keys(with_features(*names))
    assert not dead, "\n".join(dead)


def test_how_much_is_looked_at(capsys: pytest.CaptureFixture[str]) -> None:
    """Values of keys by kind, methods, regime and law, without solving any: no base case is
    refused."""
    seen: set[tuple[str, ...]] = set()
    keys: set[tuple[str, str]] = set()
    for names in SINGLE:
        case = with_features(*names)
        for path, field, value in keys_of(KINDS[case["kind"]], case):
            if others(path, field, value):
                seen.add((path, *traits(case)))
                keys.add((case["kind"], path))
        railpatch.case.load_scene(case)
    bases = {traits(with_features(*names)) for names in SINGLE}
    with capsys.disabled():
        print(
            f"\n{len(keys)} keys of {len(KINDS)} kinds, {len(bases)} combinations of kind, methods,"
            f" regime and law: {len(seen)} in {len(SINGLE)} base cases, {len(PAIRS)} pairs"
        )
    assert len(keys) > 180
    assert len(seen) > 2500
    # each as often as the schema allows, with every theory and law
    theories = {"none", *railpatch._core.THEORIES, "full"}
    assert {base[2] for base in bases} == theories
    assert {base[4] for base in bases} == set(railpatch._core.CHOICES["friction_law"])
    assert {base[3] for base in bases} == {"none", "shift", "transient_rolling", "steady_rolling"}
