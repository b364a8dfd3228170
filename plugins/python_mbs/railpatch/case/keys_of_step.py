"""Names and types of the keys that a step takes, for editors and notebooks."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Literal, TypedDict, get_type_hints

# what holds numbers of a pair or vector: lists, tuples, numpy's arrays
Numbers = Sequence[float]


class Moving(TypedDict, total=False):
    """The moving keys of all kinds of cases; a case takes those that move in it. SI units."""

    # patch
    normal_force: float
    approach: float
    creepage: Numbers
    tangential_force: Sequence[float | Literal["creepage"]]
    spin_creepage: float
    rolling_speed: float
    direction: Literal[1, -1]
    distance: float
    steps: int
    slip_field: Sequence[Sequence[Numbers]]
    regime: Literal["shift", "transient_rolling", "steady_rolling"]
    # wheel_rail, wheelset
    x: float
    y: float
    z: float
    vertical_force: float
    roll: float
    pitch: float
    yaw: float
    speed: float
    vy: float
    vz: float
    roll_rate: float
    pitch_rate: float
    yaw_rate: float
    axle_torque: float
    longitudinal_force: float
    time_step: float
    roller_pitch_rate: float
    left: Mapping[str, Numbers]
    right: Mapping[str, Numbers]
    track: Mapping[str, Any]
    # with a liquid
    water_rate: float
    water_temperature: float
    oil_film: float
    rail_work: Numbers
    # with friction
    friction_scale: Numbers
    # with temperatures
    temperature: Mapping[str, float]


def signature(step: Callable[..., Any]) -> inspect.Signature:
    """That of a step with its keys in place of **changes."""
    plain = inspect.signature(step)
    named = [p for p in plain.parameters.values() if p.kind is not p.VAR_KEYWORD]
    keys = [
        inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=..., annotation=kind)
        for name, kind in get_type_hints(Moving).items()
    ]
    return plain.replace(parameters=[*named, *keys])
