"""What [subsurface] and [damage] of a case ask for, put to the result of each step."""

from __future__ import annotations

import time
from typing import Any

import numpy as np
from numpy.typing import NDArray

from railpatch.case.asked import Damage, asked_doubts
from railpatch.case.asked import Subsurface as Below
from railpatch.case.load import Case
from railpatch.case.theories import FAST
from railpatch.damage.distribution import summed
from railpatch.damage.patch import damage_of
from railpatch.result import FIELDS, SOLVED
from railpatch.subsurface import Stepped, Subsurface

# of the stresses' fields: name in the lists by depth
GREATEST = {"greatest_shear": "max_shear", "von_mises": "von_mises", "dang_van": "dang_van"}


class Asked:
    """Of one contact; takes its memory at the first step that has contact."""

    def __init__(self, contact: Stepped, case: Case) -> None:
        self._contact, self._case = contact, case
        self._below: Subsurface | None = None
        self._displaced = False  # it has displacements, where there are some
        # rows of the last step's patches by side, with their shares, for distributions of runs
        self.rows: dict[str, list[tuple[float, dict[str, NDArray[np.float64]]]]] = {}
        self._seconds = {"subsurface": 0.0, "damage": 0.0}

    @property
    def needs_fields(self) -> bool:
        """Whether the patches' fields are read."""
        return self._case.damage is not None and self._case.damage.basis == "elements"

    def add(self, data: dict[str, Any], raw: dict[str, Any], fields: bool) -> dict[str, Any]:
        """A result's content with what was asked for; without fields where none are wanted."""
        self.rows = {side: [] for side in getattr(self._case, "sides", ("right",))}
        if self._case.kind == "patch":
            sides, patches = {"right": data}, {"right": [data]}
        elif self._case.kind == "wheel_rail":
            sides = {self._case.sides[0]: data}
        else:
            sides = {side: data[side] for side in self._case.sides}
        if self._case.kind != "patch":
            patches = {
                side: wheel["patches"] + wheel["alternatives"] for side, wheel in sides.items()
            }
        for side, found in patches.items():
            solved = raw[side]["patches"] + raw[side]["alternatives"]
            for index, patch in enumerate(found):
                self._add_to_patch(patch, side, index, solved[index], sides[side], fields)
        for side, wheel in sides.items():
            if self._case.kind != "patch":
                self._add_to_wheel(wheel, patches[side])
        if self._case.kind == "wheelset":
            self._add_to_wheel(data, [sides[side] for side in self._case.sides])
        if self.needs_fields and not fields:
            for found in patches.values():
                for patch in found:
                    for name in FIELDS:
                        patch.pop(name, None)
        if doubts := asked_doubts(self._case):
            data["warnings"] = [*data["warnings"], *doubts]
        return data

    def _add_to_patch(
        self,
        patch: dict[str, Any],
        side: str,
        index: int,
        raw: dict[str, Any],
        wheel: dict[str, Any],
        fields: bool,
    ) -> None:
        loaded = patch["status"] in SOLVED and patch["normal_force"] > 0
        begin = time.perf_counter()
        if (below := self._case.subsurface) is not None:
            patch["subsurface"] = self._stresses(below, side, index, fields) if loaded else None
        middle = time.perf_counter()
        self._seconds["subsurface"] += middle - begin
        if (law := self._case.damage) is None:
            return
        patch["damage"] = None
        if loaded:
            patch["damage"] = self._damage(law, {**raw, **patch}, side, wheel, fields)
        self._seconds["damage"] += time.perf_counter() - middle

    def _stresses(self, below: Below, side: str, index: int, fields: bool) -> dict[str, Any]:
        """Below one patch."""
        if self._below is None or (fields and not self._displaced):
            line = (
                self._case.kind == "patch" and self._case.geometry.line_contact_radius is not None
            )
            self._below = Subsurface(
                self._contact, below.depths, displacements=fields and not line,
                dang_van=below.dang_van,
            )  # fmt: skip
            self._displaced = fields
        found = self._below.solve(side=side, patch=index, body=below.body)
        depths = len(below.depths)
        told: dict[str, Any] = {"body": below.body, "depth": list(below.depths)}
        for name, key in GREATEST.items():
            told[key] = found[name].reshape(depths, -1).max(axis=1).tolist()
        if below.points:
            stress, displacement = self._below.at(
                below.points, side=side, patch=index, body=below.body
            )
            told["points"] = {"stress": stress.tolist(), "displacement": displacement.tolist()}
        if fields:
            told["fields"] = found
        return told

    def _damage(
        self, law: Damage, patch: dict[str, Any], side: str, wheel: dict[str, Any], fields: bool
    ) -> dict[str, Any]:
        radius = wheel.get("rolling_radius", float("nan"))
        # the mean speed of both surfaces, as creepages have it
        speed = patch["rolling_speed"]
        numbers, rows = damage_of(
            patch,
            law,
            radius,
            left=side == "left",
            direction=patch["direction"],
            speed=speed,
            fast=self._case.method.tangential in FAST,
        )
        if getattr(self._case.motion, "slip_field", None) is not None:
            # the wear number has the creepages alone
            numbers["whole_life_damage"] = None
        arrays = numbers.pop("fields", {})
        if fields:
            numbers["fields"] = {**arrays, **{f"row_{name}": v for name, v in rows.items()}}
        self.rows[side].append((patch.get("share", 1.0), rows))
        return numbers

    def described(self) -> list[dict[str, Any]]:
        """As Contact.stages(), of steps so far; their memory is not known."""
        reasons = {}
        if (below := self._case.subsurface) is not None:
            count = len(below.depths)
            depths = "1 depth" if count == 1 else f"{count} depths"
            reasons["subsurface"] = f"asked for: stresses at {depths} below the {below.body}"
        if (law := self._case.damage) is not None:
            reasons["damage"] = f"asked for: wear = {law.wear}, basis = {law.basis}"
        return [
            {"name": name, "present": name in reasons, "bytes": None, "seconds": seconds,
             "reason": reasons.get(name, f"no table {name} in the case")}
            for name, seconds in self._seconds.items()
        ]  # fmt: skip

    def _add_to_wheel(self, wheel: dict[str, Any], parts: list[dict[str, Any]]) -> None:
        """What is greatest of its patches, or of a wheelset's wheels, and sums of wear."""
        for name in ("subsurface", "damage"):
            if getattr(self._case, name) is None:
                continue
            known = [part for part in parts if part.get(name) is not None]
            if not known:
                wheel[name] = None
            elif name == "damage":
                wheel[name] = summed([(part.get("share", 1.0), part[name]) for part in known])
            else:
                told = {key: known[0][name][key] for key in ("body", "depth")}
                for key in GREATEST.values():
                    lists = [part[name][key] for part in known]
                    told[key] = [max(values) for values in zip(*lists, strict=True)]
                wheel[name] = told
