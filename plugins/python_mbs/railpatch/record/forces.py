"""Measured forces by component, `left.force[1]`, as results and models have them: on the wheel.

Lists count from 0, those of an FMU's variables from 1. [0] or [3] say which is meant. Of [1] and
[2] alone the numbers say it: a wheel's vertical force keeps its sign and varies little over a run.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

SIDES = ("left", "right")
# in the order of the axes x, y, z
PARTS = ("longitudinal", "lateral", "vertical")
FORCE = re.compile(r"(left|right)\.force\[([0-3])\]")
# a vertical force: least over most of its size but for a tenth at either end
EVEN = 0.5

COUNTED = {
    f"{side}.force[{k}]": f"force on the {side} wheel, track axes x, y, z, which are [0], [1], "
    "[2], or [1], [2], [3] as in FMUs: opposite to that on the roller"
    for side in SIDES
    for k in range(4)
}


def on_rollers(
    columns: Mapping[str, Any], numbers: Callable[[Any], NDArray[np.float64]], warnings: list[str]
) -> dict[str, Any]:
    """The columns with forces by component as forces on rollers, 'left_lateral', of the other sign.

    numbers: of a column. Raises ValueError with key and problem.
    """
    counted = {key: found for key in columns if (found := FORCE.fullmatch(key))}
    if not counted:
        return dict(columns)
    first = counts_from(columns, counted, numbers, warnings)
    made: dict[str, Any] = {}
    for key, column in columns.items():
        if key not in counted:
            made[key] = column
            continue
        place = int(counted[key][2]) - first
        if not 0 <= place < len(PARTS):
            raise ValueError(f"{key}: value is given, allowed [0] to [2], or [1] to [3]")
        name = f"{counted[key][1]}_{PARTS[place]}"
        if name in columns:
            raise ValueError(f"{key}: value is given with {name}, allowed one of them")
        made[name] = column.model_copy(update={"sign": -column.sign})
    return made


def counts_from(
    columns: Mapping[str, Any],
    counted: Mapping[str, re.Match[str]],
    numbers: Callable[[Any], NDArray[np.float64]],
    warnings: list[str],
) -> int:
    """The number of the first component."""
    places = {found[2] for found in counted.values()}
    if "0" in places or places == {"1"}:
        return 0
    if "3" in places:
        return 1
    second = [key for key, found in counted.items() if found[2] == "2"]
    if all(is_vertical(numbers(columns[key])) for key in second):
        return 0
    warnings.append(
        f"{second[0]}: is taken as the lateral force, counted from 1 as in FMUs, as its numbers "
        "are hardly a vertical force; 'left_lateral' and 'right_lateral' leave no doubt"
    )
    return 1


def is_vertical(values: NDArray[np.float64]) -> bool:
    """Whether a wheel's load could run so."""
    there = values[np.isfinite(values)]
    if not len(there) or there.min() * there.max() <= 0:
        return False
    low, high = np.quantile(np.abs(there), [0.1, 0.9])
    return bool(low >= EVEN * high)
