"""Both wheels as contacts of their own, whose friction a step scales wheel by wheel.

A wheelset's contact has one friction law for both wheels. Here each wheel is a contact of kind
"wheel_rail", whose law has a factor over the position x along the track: with the factor x from 0
to ``most`` the place that a step is given is the factor. So every friction law and theory takes it,
and derivatives stay exact. A rig stands still, and nothing else may vary along x.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from railpatch import Contact, Result
from railpatch.case.types import SIDES
from railpatch.result import GOOD, SOLVED, TOTAL_UNITS

from rig_model.scene import RigScene

# of a wheelset's result, what is no sum of the wheels'
GREATEST, ALIKE = ("max_temperature",), ("z",)
# m, below which the core gives no conicity
LEAST_LATERAL = 1e-5
# of a wheel's result given by itself, what a wheelset's has once
COMMON = ("wall_time", "stages")


class WheelPair:
    """Steps both wheels as a wheelset's Contact does. factors: of the friction law, by side."""

    def __init__(self, scene: RigScene, most: float, *, derivatives: bool) -> None:
        """most: the greatest factor. Raises CaseError, ProfileError."""
        self.factors = dict.fromkeys(SIDES, 1.0)
        self._whole = scene.is_whole
        self._wheels = {
            side: Contact(scene.one_wheel(side, most, derivatives=derivatives)) for side in SIDES
        }
        self._roll = self._yaw = self._y = 0.0

    def step(self, *, fields: bool = False, **changes: Any) -> Result:
        """As of Contact. Bodies that store heat go on where both wheels are solved only."""
        passing = changes.get("time_step", 0.0) > 0
        before = {side: wheel.save() for side, wheel in self._wheels.items()} if passing else {}
        found = {
            side: wheel.step(fields=fields, x=self.factors[side], **changes)
            for side, wheel in self._wheels.items()
        }
        self._roll, self._yaw, self._y = changes["roll"], changes["yaw"], changes["y"]
        result = self._result(found)
        if result.status not in ("converged", "no_contact"):
            for side, state in before.items():
                self._wheels[side].restore(state)
        return result

    def last(self, *, fields: bool = False) -> Result:
        """As of Contact."""
        return self._result({side: w.last(fields=fields) for side, w in self._wheels.items()})

    def differentiate(self, **direction: Any) -> Result:
        """Rates by pose and velocity, or by the rollers' places."""
        rates = {side: wheel.differentiate(**direction) for side, wheel in self._wheels.items()}
        wheels = {side: wheel.last() for side, wheel in self._wheels.items()}
        force, moment = total(rates, "force"), total(rates, "moment")
        torque = math.fsum(
            self._torque(wheels[side], rates[side], direction.get("roll", 0.0)) for side in SIDES
        )
        sums = {"force": force, "moment": moment, "axle_torque": torque}
        return Result({side: rates[side].data for side in SIDES} | sums)

    def _result(self, found: dict[str, Result]) -> Result:
        """A wheelset's, from those of its wheels."""
        data: dict[str, Any] = {
            side: {key: value for key, value in wheel.data.items() if key not in COMMON}
            for side, wheel in found.items()
        }
        for key, unit in TOTAL_UNITS.items():
            values = [wheel[key] for wheel in found.values()]
            if key in ("force", "moment"):
                data[key] = total(found, key)
            elif key in ALIKE:
                data[key] = values[0]
            elif unit:
                data[key] = max(values) if key in GREATEST else math.fsum(values)
        data["residual"] = max(wheel["residual"] for wheel in found.values())
        worse = max(found.values(), key=lambda wheel: rank(wheel.status))
        data |= {"status": worse.status, "reason": worse.reason}
        data["warnings"] = list(
            dict.fromkeys(w for wheel in found.values() for w in wheel.warnings)
        )
        data["axle_torque"] = math.fsum(self._torque(w) for w in found.values())
        left, right = (found[side]["rolling_radius"] for side in SIDES)
        data["rolling_radius_difference"] = right - left
        near = abs(self._y) < LEAST_LATERAL
        data["conicity"] = math.nan if near else 0.5 * (right - left) / self._y
        data["wall_time"] = math.fsum(wheel["wall_time"] for wheel in found.values())
        data["stages"] = found[SIDES[0]]["stages"]
        return Result(data)

    def _torque(self, wheel: Result, rate: Result | None = None, roll_rate: float = 0.0) -> float:
        """N m, about the axle, as the core has it, or its rate at rates of the wheel and of roll.

        The moment of all contact forces about the axle; by the rule of the program CONTACT the
        forces along the wheelset's x axis at the rolling radius.
        """
        if not wheel["patches"]:
            return 0.0
        c, s = math.cos(self._yaw), math.sin(self._yaw)
        if not self._whole:
            along = c * wheel["force"][0] + s * wheel["force"][1]
            if rate is None:
                return along * wheel["rolling_radius"]
            change = c * rate["force"][0] + s * rate["force"][1]
            return change * wheel["rolling_radius"] + along * rate["rolling_radius"]
        axle = axle_of(self._roll, self._yaw)
        if rate is None:
            return float(axle @ np.array(wheel["moment"]))
        turned = np.array([0.0, -axle[2], axle[1]]) * roll_rate
        return float(axle @ np.array(rate["moment"]) + turned @ np.array(wheel["moment"]))


def axle_of(roll: float, yaw: float) -> np.ndarray:
    """-, [3], direction of the axle in track axes, of a wheelset rotated roll-yaw-pitch."""
    c = math.cos(yaw)
    return np.array([-math.sin(yaw), c * math.cos(roll), c * math.sin(roll)])


def total(found: dict[str, Result], key: str) -> list[float]:
    """[3], sum of the wheels' vectors."""
    return [math.fsum(parts) for parts in zip(*(found[side][key] for side in SIDES), strict=True)]


def rank(status: str) -> int:
    """How bad a status is: the worse one of both wheels is the wheelset's."""
    return 0 if status == "converged" else 1 + (status not in GOOD) + (status not in SOLVED)
