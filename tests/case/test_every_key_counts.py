"""A key that does nothing is a defect.

Every key of the schema is changed on every kind, method, regime and law. The change shows in the
numbers of the results, or the case is refused by a text that names the key, or the key stands in
IDLE with the reason why it does nothing there. One key at a time on base cases, and on pairs of
features: some here, all in `make test-long`.
"""

from __future__ import annotations

import functools
import typing
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import railpatch
from bits.combinations import COMMON, HEAT, OF_PATCHES, OF_WHEELS, PATCH_BASE, WHEEL_BASE
from bits.combinations import WHEELSET_BASE as ON_RAILS
from case_samples import with_values
from railpatch.case import to_core
from railpatch.case.load import KINDS
from railpatch.case.types import Table

Case = dict[str, Any]

# --- base cases ----------------------------------------------------------------------------------

SMALL = {"patch": {"elements": [8, 8]}, "wheels": {"element_size": [1.6e-3, 1.6e-3]}}
# tangential methods and regimes differ by what they read; these are not worth a base of their own
LEFT_OUT = {"derivatives", "element size", "elements", "standstill", "no motion"}
WARM_CONTACT = {**HEAT, "temperature": {"wheel": 22.0, "rail": 20.0, "exchange": True}}


def features(kind: str) -> dict[str, dict[str, Any]]:
    """By name; those whose base case is refused fall out of themselves."""
    own = OF_PATCHES if kind == "patch" else OF_WHEELS
    found = {name: f for name, f in {**COMMON, **own}.items() if name not in LEFT_OUT}
    return {**found, "temperature": WARM_CONTACT}


def base_of(kind: str) -> Case:
    base = {"patch": PATCH_BASE, "wheelset": ON_RAILS, "wheel_rail": WHEEL_BASE}[kind]
    return {**base, "grid": SMALL["patch" if kind == "patch" else "wheels"]}


def with_features(kind: str, *names: str) -> Case:
    case = base_of(kind)
    for name in names:
        case = with_values(case, **features(kind)[name])
    return case


ONE_WHEEL = ("other side", "roller", "transient", "vertical force")
SINGLE = [
    (kind, *names)
    for kind in KINDS
    for names in ((), *((name,) for name in features(kind)))
    if kind != "wheel_rail" or not names or names[0] in ONE_WHEEL
]

# --- keys and other values -----------------------------------------------------------------------

LEVEL = [[-1.0, 0.0], [0.0, 2e-5], [1.0, 0.0], [2.0, 1e-5]]
# whole tables, and numbers that are left out or 0 in a base case: one value that should count
VALUES: dict[str, Any] = {
    "friction": {"coefficient": 0.2},
    "layer": {"thickness": 5e-5, "shear_modulus": 8e9},
    "temperature": {"wheel": 20.0, "rail": 20.0},
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
    "track.rail_support": {"stiffness": [3e7, 9e7]},
    "profiles.smoothing": 1e-3,
    "profiles.wheel": "cone",
    "profiles.rail": "UIC60",
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
}
# what needs a value of its own to be another case, beside all other words of a choice
WORDS: dict[str, tuple[str, ...]] = {"profiles.wheel": ("S1002",), "profiles.rail": ("UIC60",)}


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
    table, _, rest = path.partition(".")
    side, _, name = rest.partition(".")
    return OF_SIDES.get(name) if side in ("left", "right") else None


def others(path: str, field: Any, value: Any) -> list[Any]:
    """Other values for a key."""
    words = words_in(field.annotation)
    if words and not isinstance(value, list):
        return [word for word in words if word != value]
    if isinstance(value, bool):
        return [not value]
    listed = listed_value(path)
    if listed is not None and listed != value:
        return [listed]
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


def run(case: Case) -> dict[str, Any]:
    """Numbers of two steps, the second elsewhere, and of a derivative where there are some."""
    contact = railpatch.Contact(case)
    found: list[Any] = [contact.step().to_dict()]
    if case["kind"] == "patch":
        change: dict[str, Any] = {"spin_creepage": 0.1} if "spin" in str(case["motion"]) else {}
    else:
        change = {"y": case["wheelset"]["y"] + 2e-4, "x": 2e-3, "pitch": -4e-3}
    found.append(contact.step(**change).to_dict())
    return dict(numbers(found))


@pytest.fixture(scope="module", autouse=True)
def profiles_read_once() -> Iterator[None]:
    """Splines of built-in profiles are the same in every case."""
    first = to_core.load_profile

    @functools.cache
    def read(name: str, body: Any, folder: Path, smoothing: float | None) -> Any:
        return first(name, body, folder=folder, smoothing=smoothing)

    to_core.load_profile = lambda name, body, *, folder, smoothing: read(
        name, body, folder, smoothing
    )
    yield
    to_core.load_profile = first


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
    text = str(case.get("track"))
    return any(word in text for word in ("running_surface", "joint", "sections", "irregularity"))


# key, or what it begins with; where it does nothing; why
Where = Callable[[Case, str], bool]
IDLE: list[tuple[str, Where, str]] = [
    ("method.max_iterations", lambda c, k: True, "a limit that these cases do not reach"),
    ("grid.max_elements", lambda c, k: True, "room for more than these cases need"),
    ("wheelset.max_patches", lambda c, k: True, "room for more than these cases need"),
]


def idle(path: str, case: Case) -> str | None:
    """Why a key may do nothing."""
    for start, where, why in IDLE:
        if (path == start or path.startswith(f"{start}.")) and where(case, path):
            return why
    return None


# --- the test ------------------------------------------------------------------------------------


def put(case: Case, path: str, value: Any) -> Case:
    return with_values(case, **{path.replace(".", "__"): value})


def differs(a: dict[str, Any], b: dict[str, Any]) -> bool:
    if a.keys() != b.keys():
        return True
    same = lambda x, y: x == y or (x != x and y != y)  # noqa: E731
    return not all(same(a[key], b[key]) for key in a)


def without_effort(found: dict[str, Any]) -> dict[str, Any]:
    """What the solver spent is not what it found."""
    spent = ("iterations", "residual", "evaluations", "ambiguous")
    return {key: v for key, v in found.items() if not any(word in key for word in spent)}


def dead_keys(case: Case, seen: set[tuple[str, ...]] | None = None) -> list[str]:
    """Keys that change nothing, and refusals that do not name the key."""
    try:
        plain = without_effort(run(case))
    except railpatch.CaseError:
        return []
    dead = []
    for path, field, value in keys_of(KINDS[case["kind"]], case):
        if path == "kind" or (value is None and listed_value(path) is None
                              and not words_in(field.annotation)):
            continue
        for other in others(path, field, value):
            if seen is not None:
                seen.add((path, *traits(case)))
            try:
                changed = without_effort(run(put(case, path, other)))
            except (railpatch.CaseError, railpatch.ProfileError) as error:
                if path.rpartition(".")[2] not in str(error):
                    dead.append(f"{path} = {other!r}: refused by {str(error)[:200]!r}")
                continue
            if not differs(plain, changed) and idle(path, case) is None:
                dead.append(f"{path} = {other!r}: changes nothing")
    return dead


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


@pytest.mark.parametrize("names", SINGLE, ids=" ".join)
def test_one_key_at_a_time(names: tuple[str, ...]) -> None:
    dead = dead_keys(with_features(*names))
    assert not dead, "\n".join(dead)
