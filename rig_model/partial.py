"""Derivatives of a balanced position: of residuals and of what is measured, by unknowns and scene.

Of r(x, p) = 0 and o(x, p), x the unknowns of the balance, p a number of the scene,

    do/dp = o_p - o_x r_x^-1 r_p

(implicit function theorem). Partial derivatives are the contact's own where it has exact ones and p
is a moving input of it (positions, angles, speeds, offsets of bodies) or Coulomb's friction
coefficient. Where p is another number they are one difference at the balanced state, a contact
solve in place of a balance; where the contact has none, central differences at that state. The load
and the frame stand in r itself.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from railpatch import Contact, Result
from railpatch.case.moving import BY_TABLE, FIXED, moving_keys
from railpatch.case.types import SIDES
from railpatch.record.quantities import ratio_side

from rig_model.frame import Frame
from rig_model.programme import Position
from rig_model.residuals import residual_rates, residuals
from rig_model.scene import RigScene
from rig_model.search import Vector

# component of a force by what is measured of it, on the roller
COMPONENTS = {"longitudinal": 0, "lateral": 1, "vertical": 2}
FRAME_UNKNOWNS = ("z", "roll", "pitch_rate", "y")
UNKNOWN_OF = {"vertical_position": 0, "roll": 1, "pitch_rate": 2}
# of central differences by the yaw angle (rad) and the lateral position (m): forces on a grid that
# stays where it is are uneven over less
YAW_DIFFERENCE = 1e-5
LATERAL_DIFFERENCE = 1e-5


@dataclass
class Way:
    """From a scene to another one with one number changed by a step.

    rates: of moving inputs of the contact, for a change of one; None where something else changes,
    of which contact is. positions: of the other scene. frame: its own, on its own way.
    """

    scene: RigScene
    step: float
    positions: list[Position]
    rates: dict[str, Any] | None
    contact: Contact | None
    frame: Frame | None


def way_of(scene: RigScene, other: RigScene, step: float, *, exact: bool) -> Way:
    """Raises CaseError, ProfileError."""
    rates = contact_rates(scene, other, step) if exact else None
    contact = Contact(other.at_height()) if rates is None else None
    frame = Frame(other.rig.frame) if other.rig.frame else None
    return Way(other, step, other.positions(), rates, contact, frame)


class Partial:
    """Of a scene at one balanced position after the other."""

    def __init__(
        self, scene: RigScene, contact: Contact, differences: Vector, names: Sequence[str],
        *, exact: bool, held: str | None = None,
    ) -> None:  # fmt: skip
        """differences: [n], of the unknowns. names: of what is measured. held: the field of a
        position that each has for itself."""
        self._scene, self._contact, self._names = scene, contact, names
        self._differences, self._exact, self._held = differences, exact, held
        self.frame = Frame(scene.rig.frame) if scene.rig.frame else None
        self._unknowns = FRAME_UNKNOWNS[: len(differences)]

    def go_to(self, position: Position, unknowns: Vector) -> None:
        """Solves the contact at a position's balance, of which all else then is."""
        self._position, self._x = position, unknowns
        self._result = self._contact.step(**moved(position, unknowns))
        self._value = self._at(self._scene, self._result, position, unknowns, self.frame)
        self._by_unknowns = self._by_x()

    def total(self, partial: Vector) -> tuple[Vector, Vector]:
        """[o] of what is measured and [n] of the unknowns, of [n + o] at fixed unknowns."""
        n = len(self._x)
        try:
            dx = -np.linalg.solve(self._by_unknowns[:n], partial[:n])
        except np.linalg.LinAlgError:
            dx = np.full(n, np.nan)
        return partial[n:] + self._by_unknowns[n:] @ dx, dx

    def by_way(self, way: Way) -> Vector:
        """[n + o], at fixed unknowns."""
        position = way.positions[self._position.index]
        if self._held is not None:
            value = getattr(self._position, self._held)
            position = replace(position, **{self._held: value})
        if way.rates is None:
            assert way.contact is not None
            result = way.contact.step(**moved(position, self._x))
            value = self._at(way.scene, result, position, self._x, way.frame)
            return (value - self._value) / way.step
        rates = dict(way.rates)
        for name, field in (("y", "y"), ("yaw", "yaw"), ("roller_pitch_rate",) * 2):
            if name == "y" and self.frame:
                continue
            before, after = getattr(self._position, field), getattr(position, field)
            if after != before:
                rates[name] = rates.get(name, 0.0) + (after - before) / way.step
        value = self._along(rates) if rates else np.zeros(len(self._value))
        load = way.scene.load_at(position) - self._scene.load_at(self._position)
        value[1] -= load / way.step
        if self.frame:
            assert way.frame is not None
            there = way.frame.resistance(float(self._x[3]) - position.y).force
            here = self.frame.resistance(float(self._x[3]) - self._position.y).force
            value[3] -= (there - here) / way.step
        return value

    def by_row(self, field: str) -> Vector:
        """[n + o], by the position's own y or yaw, at fixed unknowns."""
        if field == "y" and self.frame:
            value = np.zeros(len(self._value))
            value[3] = self.frame.resistance(float(self._x[3]) - self._position.y).stiffness
        elif self._exact:
            value = self._along({field: 1.0})
        else:
            step = LATERAL_DIFFERENCE if field == "y" else YAW_DIFFERENCE
            value = self._central(field, step)
        return value

    def _by_x(self) -> Vector:
        """[n + o, n]."""
        columns = []
        for k, name in enumerate(self._unknowns):
            column = (
                self._along({name: 1.0})
                if self._exact
                else self._central(
                    name,
                    max(float(self._differences[k]), LATERAL_DIFFERENCE if name == "y" else 0.0),
                )
            )
            if self.frame and name == "y":
                resisted = self.frame.resistance(float(self._x[3]) - self._position.y)
                column[3] -= resisted.stiffness
            for place, measured in enumerate(self._names):
                if measured in UNKNOWN_OF:
                    column[len(self._x) + place] = float(UNKNOWN_OF[measured] == k)
            columns.append(column)
        return np.column_stack(columns)

    def _along(self, rates: dict[str, Any]) -> Vector:
        """Exact, of the contact's part; what is an unknown itself does not move."""
        changes = self._contact.differentiate(**rates)
        found = residual_rates(self._scene, self._result, changes)
        if self.frame:
            found = np.append(found, changes["force"][1])
        return np.append(found, [rate_of(self._result, changes, name) for name in self._names])

    def _central(self, name: str, step: float) -> Vector:
        """The same by steps of the contact to either side of one moving input."""
        inputs = moved(self._position, self._x)
        ends = []
        for sign in (1.0, -1.0):
            result = self._contact.step(**inputs | {name: inputs[name] + sign * step})
            ends.append(self._at(self._scene, result, self._position, self._x, self.frame))
        return (ends[0] - ends[1]) / (2 * step)

    def _at(
        self, scene: RigScene, result: Result, position: Position, x: Vector, frame: Frame | None
    ) -> Vector:
        """[n + o], residuals and what is measured."""
        found = residuals(scene, result, scene.load_at(position))
        if frame:
            resistance = frame.resistance(float(x[3]) - position.y)
            found = np.append(found, result["force"][1] - resistance.force)
        return np.append(found, [computed(result, x, name) for name in self._names])


def moved(position: Position, unknowns: Vector) -> dict[str, float]:
    """The moving inputs of the contact; unknowns: [3], or [4] with the lateral position."""
    found = {"y": position.y} | dict(zip(FRAME_UNKNOWNS, map(float, unknowns), strict=False))
    if position.roller_pitch_rate is not None:
        found["roller_pitch_rate"] = position.roller_pitch_rate
    return {"yaw": position.yaw, **found}


def computed(result: Result, unknowns: Vector, name: str) -> float:
    """A measured quantity as computed, SI units; NaN where there is none."""
    if name in UNKNOWN_OF:
        return float(unknowns[UNKNOWN_OF[name]])
    side, _, what = name.partition("_")
    if ratio_side(name):
        force = result[side]["force"]
        return float(force[1] / force[2]) if force[2] else np.nan
    if what in COMPONENTS:
        return -float(result[side]["force"][COMPONENTS[what]])
    value = result[side].get({"roller_temperature": "rail_temperature"}.get(what, what))
    return np.nan if value is None else float(value)


def rate_of(result: Result, rates: Result, name: str) -> float:
    """Of the same, where the unknowns stay."""
    if name in UNKNOWN_OF:
        return 0.0
    side, _, what = name.partition("_")
    if ratio_side(name):
        force, rate = result[side]["force"], rates[side]["force"]
        return float((rate[1] - force[1] / force[2] * rate[2]) / force[2])
    if what in COMPONENTS:
        return -float(rates[side]["force"][COMPONENTS[what]])
    return np.nan


def contact_rates(scene: RigScene, other: RigScene, step: float) -> dict[str, Any] | None:
    """Rates of moving inputs between two scenes as Contact.differentiate takes them; None where
    anything else differs. The load and the rollers' speed are those of the positions."""
    case = scene.at_height().case
    before, after = case.model_dump(), other.at_height().case.model_dump()
    keys, rates = moving_keys(case), dict[str, Any]()
    for path in differing(before, after):
        values = at(before, path), at(after, path)
        if path == ("friction", "coefficient") and case.friction.law == "coulomb":
            place, key = rates, "friction_coefficient"
        elif path == ("track", "roller_pitch_rate"):
            continue
        elif path[0] == "wheelset" and len(path) == 2 and keys.get(path[1]) == "wheelset":
            place, key = rates, path[1]
        elif len(path) == 3 and path[1] in SIDES and path[2] not in FIXED:
            table = rates.setdefault(path[0], {}) if path[0] in BY_TABLE else rates
            place, key = table.setdefault(path[1], {}), path[2]
        else:
            return None
        try:
            place[key] = ((np.array(values[1], float) - np.array(values[0], float)) / step).tolist()
        except (TypeError, ValueError):
            return None
    return rates


def differing(one: Any, other: Any, path: tuple[str, ...] = ()) -> list[tuple[str, ...]]:
    """Paths of what differs, down to tables of two names below a table of the case."""
    if isinstance(one, dict) and isinstance(other, dict) and one.keys() == other.keys():
        return [p for key in one for p in differing(one[key], other[key], (*path, key))]
    return [] if one == other else [path]


def at(content: Any, path: tuple[str, ...]) -> Any:
    """What stands at a path."""
    for key in path:
        content = content[key]
    return content
