"""The result of a step, of which only what is asked for is read."""

from __future__ import annotations

import math
from typing import Any

from railpatch import _core
from railpatch.case.load import Case
from railpatch.case.patch import PatchCase
from railpatch.case.types import SIDES
from railpatch.result import (
    PATCH_UNITS,
    TOTAL_UNITS,
    TURNING,
    WHEEL_UNITS,
    WHEELSET_UNITS,
    patch_data,
    wheel_data,
)

# quantities that the JSON result has in another form than the core's field of their name
FORMED = {
    *("elements", "iterations", "error_estimate"),
    *("rail_deflection", "rail_deflection_rate"),
}


def sources(case: Case) -> dict[str, str]:
    """Quantity of a result -> struct of the core whose field it is: "result", "side", "patch"."""
    if isinstance(case, PatchCase):
        names = [*PATCH_UNITS, *(["creepage"] if any(case.motion.prescribed) else [])]
        found = dict.fromkeys(names, "patch") | {"warnings": "result"}
    elif case.kind == "wheel_rail":
        found = dict.fromkeys(WHEEL_UNITS, "side") | {"z": "result", "status": "result"}
        found |= dict.fromkeys(TURNING if case.wheelset.found else (), "result")
    else:
        found = dict.fromkeys((*TOTAL_UNITS, *WHEELSET_UNITS), "result")
    return {name: struct for name, struct in found.items() if name not in FORMED}


class Reader:
    """From the core's result of a kind of case to the JSON result's content, whole or one quantity.

    stages: names of those present.
    """

    def __init__(self, case: Case, stages: list[str]) -> None:
        self._stages = stages
        self._kind, self._sources = case.kind, sources(case)
        self._sides = SIDES[1:] if isinstance(case, PatchCase) else case.sides
        self._side = SIDES.index(self._sides[0])
        self._found = isinstance(case, PatchCase) and any(case.motion.prescribed)

    def whole(self, raw: dict[str, Any], wall_time: float) -> dict[str, Any]:
        """All; raw: as _core.Outcome.whole() gives it."""
        common = {"wall_time": wall_time, "stages": list(self._stages)}
        if self._kind == "patch":
            patch = raw["right"]["patches"][0]
            data = patch_data(patch, of_wheel=False, creepage_found=self._found)
            data["warnings"] = raw["warnings"]
            return {**data, **common}
        wheels = {side: wheel_data(raw[side], raw["z"]) for side in self._sides}
        if self._kind == "wheel_rail":
            turning = {key: raw[key] for key in TURNING if key in self._sources}
            return {**wheels[self._sides[0]], "status": raw["status"], **turning, **common}
        total = {key: raw[key] for key in (*TOTAL_UNITS, *WHEELSET_UNITS)}
        return {**total, **wheels, **common}

    def quantity(self, outcome: _core.Outcome, key: str) -> Any:
        """One of them; KeyError where it takes all."""
        struct = self._sources[key]
        if struct == "result":
            return outcome.quantity(key)
        if struct == "side":
            return outcome.of_side(self._side, key)
        value = outcome.of_patch(self._side, 0, key)
        # without a tangential problem there is none
        return None if key == "creep_force" and math.isnan(value[0]) else value


class OnDemand:
    """The source of a Result."""

    __slots__ = ("outcome", "reader", "wall_time")

    def __init__(self, reader: Reader, outcome: _core.Outcome, wall_time: float) -> None:
        self.reader, self.outcome, self.wall_time = reader, outcome, wall_time

    def whole(self) -> dict[str, Any]:
        """The JSON result's content."""
        return self.reader.whole(self.outcome.whole(), self.wall_time)

    def quantity(self, key: str) -> Any:
        """One quantity; KeyError where it takes all."""
        return self.reader.quantity(self.outcome, key)
