"""Base cases of test_every_key_counts, their keys with other values, numbers of results."""

from __future__ import annotations

import tempfile
import typing
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import railpatch
from bits.combinations import COMMON, HEAT, OF_PATCHES, OF_WHEELS, PATCH_BASE, WHEEL_BASE
from bits.combinations import WHEELSET_BASE as ON_RAILS
from case_samples import with_values
from railpatch.case.load import KINDS
from railpatch.case.types import Table

Case = dict[str, Any]
Numbers = dict[str, Any]

# --- base cases ----------------------------------------------------------------------------------

SMALL = {"patch": {"elements": [8, 8]}, "wheels": {"element_size": [1.6e-3, 1.6e-3]}}
OWN = tempfile.TemporaryDirectory()


def mattress(name: str, softness: float) -> str:
    """A file of a mattress of springs for the grid of "distance"."""
    springs = np.zeros((39, 41))
    springs[19, 20] = softness
    path = Path(OWN.name) / name
    np.savez(path, zz=springs, xx=springs, yy=springs)
    return str(path)


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
    if kind == "patch":
        found["viscoelastic"] = {
            "geometry": {"curvatures": [1.0, 1.2]},
            "material__viscoelastic_ratio": 2.0,
            "material__relaxation_time": 1e-3,
            "method__normal": "half_space",
        }
        found["own influence"] = {
            **OF_PATCHES["distance"],
            "material": {"influence_file": mattress("one.npz", 2e-14)},
            "method__normal": "half_space",
        }
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
    "material.viscoelastic_ratio": 1.5,
    "material.relaxation_time": 2e-3,
    "material.influence_file": mattress("other.npz", 3e-14),
    "motion.creepage": [1.3e-3, -5e-4],
    "motion.tangential_force": [-1e4, 1e3],
    "motion.distance": 2e-3,
    "motion.slip_field": [[[1e-4] * 2] * 2, [[0.0] * 2] * 2],
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
