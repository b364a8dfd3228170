"""Directions of differentiation: rates of moving inputs, as the core's input struct has them."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from railpatch.case.load import Case, plain
from railpatch.case.messages import show
from railpatch.case.moving import BODY_KEYS, moving_keys, refuse_unknown
from railpatch.case.patch import PatchCase
from railpatch.case.types import SIDES
from railpatch.errors import CaseError

# moving inputs that are no continuous numbers
STEPWISE = ("direction", "steps")
# numbers of each input; the others are single ones
DEVIATION = ("offset", "rotation", "velocity", "angular_velocity")
LENGTHS = {"creepage": 2, "tangential_force": 2, **dict.fromkeys(DEVIATION, 3)}
BODY_OF_TABLE = {"wheelset": "wheel", "track": "rail"}
# columns and rows of rp_jacobian
POSE_AND_VELOCITY = (
    *("x", "y", "z", "roll", "yaw", "pitch"),
    *("speed", "vy", "vz", "roll_rate", "yaw_rate", "pitch_rate"),
)
FORCE_AND_MOMENT = ("fx", "fy", "fz", "mx", "my", "mz")


def rates_of(case: Case, direction: Mapping[str, Any]) -> dict[str, Any]:
    """Rates of the fields of rp_input. Raises CaseError."""
    if not case.method.derivatives:
        raise CaseError("method.derivatives: value is False, allowed True for differentiate()")
    keys = {key: table for key, table in moving_keys(case).items() if key not in STEPWISE}
    if case.friction is not None and case.friction.law == "coulomb":
        keys["friction_coefficient"] = "friction"
    refuse_unknown(direction, keys, "")
    rates: dict[str, Any] = {}
    for key, value in plain(direction).items():
        if key == "temperature":
            table = part_of(value, BODY_KEYS, key)
            rates["bulk_temperature"] = [number(table.get(body, 0.0), key) for body in BODY_KEYS]
        elif key == "track":
            allowed = (*SIDES, *(name for name in ("roller_pitch_rate",) if name in keys))
            for name, item in part_of(value, allowed, key).items():
                add_rate(rates, name, item, "track")
        else:
            add_rate(rates, key, value, keys[key])
    if isinstance(case, PatchCase) and "distance" in rates:
        rates["distance"] /= case.motion.steps or 1
    return rates


def add_rate(rates: dict[str, Any], key: str, value: Any, table: str) -> None:
    """One rate, or those of a wheel's or rail's deviation."""
    if key not in SIDES:
        rates[key] = numbers(value, key)
        return
    for name, item in part_of(value, DEVIATION, key).items():
        sides = rates.setdefault(f"{BODY_OF_TABLE[table]}_{name}", [[0.0] * 3, [0.0] * 3])
        sides[SIDES.index(key)] = numbers(item, name)


def part_of(value: Any, allowed: tuple[str, ...], key: str) -> dict[str, Any]:
    """A table with some of the allowed keys."""
    if not isinstance(value, dict):
        raise CaseError(f"{key}: value is {show(value)}, allowed a table")
    refuse_unknown(value, dict.fromkeys(allowed), f"{key}.")
    return value


def numbers(value: Any, key: str) -> Any:
    """A finite number, or a list of as many as the input has."""
    length = LENGTHS.get(key)
    if length is None:
        return number(value, key)
    if not isinstance(value, list) or len(value) != length:
        raise CaseError(f"{key}: value is {show(value)}, allowed {length} numbers")
    return [number(item, key) for item in value]


def number(value: Any, key: str) -> float:
    """A finite number."""
    real = isinstance(value, int | float) and not isinstance(value, bool)
    if not real or not math.isfinite(value):
        raise CaseError(f"{key}: value is {show(value)}, allowed a finite number")
    return float(value)
