"""Where keys do nothing, and why: the list of test_every_key_counts."""

from __future__ import annotations

import typing
from collections.abc import Callable
from typing import Any

import railpatch
from case.key_cases import Case, steps_of
from railpatch import _core
from railpatch.case.theories import READERS

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


def spin_by_layer(case: Case, path: str, value: Any) -> bool:
    transient = get(case, "motion.regime") == "transient_rolling"
    return value == "contact" and transient and spin_by_default(case, path, "none")


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
    Idle(
        "method.spin_offset",
        spin_by_layer,
        "in transient rolling the program CONTACT reads spin in the middle, as layers do anyway",
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
