"""What a vehicle is made of: tables of its bodies and wheelsets.

Places are those of the vehicle at rest: x ahead, y to the right of its middle, both from any origin
that the scene chooses, and the height above the rails' tops. Wheelsets are numbered from the front:
wheelset N is called "wheelset_N", its axle boxes "axle_box_N_left" and "axle_box_N_right".
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Annotated, Any

from pydantic import Field, model_validator
from railpatch.case.types import (
    BODIES,
    SIDES,
    NotNegative,
    Number,
    Positive,
    Table,
    exactly,
    refuse,
    relation,
)
from railpatch.case.wheel import PROFILE_KEYS, Text, WheelsetCase

from wheelset_demo.vehicle.elements import ElementTable, Place
from wheelset_demo.vehicle.traction import DriveTable

Name = Annotated[str, Field(pattern="^[A-Za-z][A-Za-z0-9_]*$", max_length=60)]
# names that the run's log gives
TAKEN = ("world", "start", "view")
TAKEN_BEGINS = ("wheelset_", "wheels_", "axle_box_", "track_")
MOST_WHEELSETS = 64
# m, of a vehicle between its first and its last wheelset
LONGEST = 500.0
SIGNS = dict(zip(SIDES, (-1.0, 1.0), strict=True))


class BodyTable(Table):
    """A rigid body."""

    mass: Positive = Field(description="kg")
    inertia: Annotated[list[Positive], exactly(3)] = Field(
        description="kg m^2, about x, y, z through its centre; none above the sum of the others"
    )

    @model_validator(mode="after")
    def _possible(self) -> BodyTable:
        if 2 * max(self.inertia) > sum(self.inertia) * (1 + 1e-9):
            raise relation(
                "inertia", self.inertia, "kg m^2 of which none is above the sum of the two others"
            )
        return self


class FreeBodyTable(BodyTable):
    """A rigid body with six degrees of freedom: car body, bogie frame, bolster, motor."""

    name: Name = Field(description="(no unit): by which elements and logs call it")
    position: Place = Field(
        description="m, of its centre at rest: ahead, to the right of the vehicle's middle, above "
        "the rails' tops"
    )
    size: Annotated[list[Positive], exactly(3)] | None = Field(
        default=None, description="m, along x, y, z, of the box that is drawn; left out: guessed"
    )

    @model_validator(mode="after")
    def _own_name(self) -> FreeBodyTable:
        if self.name in TAKEN or self.name.startswith(TAKEN_BEGINS):
            raise relation(
                "name", repr(self.name), "one that is no wheelset's, axle box's, track's"
            )
        return self


class AxleBoxTable(BodyTable):
    """A body that pitches about the end of an axle; one at each side."""

    lateral: Annotated[float, Field(gt=0, le=10)] = Field(
        description="m, of its centre from the vehicle's middle"
    )


class OwnProfiles(Table):
    """Profiles of some wheelsets in place of the scene's."""

    wheel: Text | None = Field(default=None, description="both wheels' profile (file, no unit)")
    rail: Text | None = Field(default=None, description="both rails' profile (file, no unit)")
    wheel_left: Text | None = Field(default=None, description="left wheel (file, no unit)")
    wheel_right: Text | None = Field(default=None, description="right wheel (file, no unit)")
    rail_left: Text | None = Field(default=None, description="left rail (file, no unit)")
    rail_right: Text | None = Field(default=None, description="right rail (file, no unit)")

    @model_validator(mode="after")
    def _no_doubles(self) -> OwnProfiles:
        for body in BODIES:
            sided = [f"{body}_{side}" for side in SIDES if getattr(self, f"{body}_{side}")]
            if getattr(self, body) is not None and sided:
                raise relation(body, repr(getattr(self, body)), f"only without '{sided[0]}'")
        return self

    def over(self, profiles: dict[str, Any]) -> dict[str, Any]:
        """A case's [profiles] with these in their place."""
        found = dict(profiles)
        for key in PROFILE_KEYS:
            value = getattr(self, key)
            if value is None:
                continue
            body, _, side = key.partition("_")
            if side:
                both, found[body] = found[body], None
                for one in SIGNS:
                    found[f"{body}_{one}"] = found[f"{body}_{one}"] or both
            else:
                found |= {f"{body}_{one}": None for one in SIGNS}
            found[key] = value
        return found


class WheelsetTable(BodyTable):
    """Wheelsets that are alike; they spin about y."""

    positions: Annotated[list[Number], Field(min_length=1, max_length=MOST_WHEELSETS)] = Field(
        description="m, along the vehicle: one wheelset at each"
    )
    axle_box: AxleBoxTable | None = Field(
        default=None,
        description="each of two axle boxes of a wheelset; left out: none, and elements act on "
        "the wheelset through bearings without friction",
    )
    nominal_radius: Positive | None = Field(
        default=None, description="m, of these wheels; left out: as wheelset.nominal_radius"
    )
    flange_back_distance: Positive | None = Field(
        default=None, description="m, of these wheels; left out: as in [wheelset]"
    )
    profiles: OwnProfiles | None = Field(
        default=None, description="of these wheelsets in place of those of [profiles] (no unit)"
    )

    @model_validator(mode="after")
    def _round(self) -> WheelsetTable:
        roll, _, yaw = self.inertia
        if roll != yaw:
            raise relation("inertia", self.inertia, "equal ones about x and z")
        return self

    @property
    def mass_on_rails(self) -> float:
        """kg, of one with its axle boxes."""
        return self.mass + (0.0 if self.axle_box is None else 2 * self.axle_box.mass)

    def case_of(self, case: WheelsetCase) -> WheelsetCase:
        """The scene's case for these wheelsets; the same object where they have nothing of their
        own. Profiles are taken as they are."""
        keys = ("nominal_radius", "flange_back_distance")
        own = {key: getattr(self, key) for key in keys if getattr(self, key) is not None}
        update: dict[str, Any] = {}
        if own:
            update["wheelset"] = case.wheelset.model_copy(update=own)
        if self.profiles is not None:
            named = {key: getattr(case.profiles, key) for key in PROFILE_KEYS}
            update["profiles"] = case.profiles.model_copy(update=self.profiles.over(named))
        return case.model_copy(update=update) if update else case


@dataclass(frozen=True)
class Axle:
    """One wheelset. number: from 1, from the front. x: m, along the vehicle. table: its own."""

    number: int
    x: float
    table: WheelsetTable

    @property
    def name(self) -> str:
        """By which elements and logs call it."""
        return f"wheelset_{self.number}"

    @property
    def boxes(self) -> dict[str, float]:
        """Names of its axle boxes -> m, where they are to the right of the middle."""
        box = self.table.axle_box
        if box is None:
            return {}
        return {f"axle_box_{self.number}_{side}": s * box.lateral for side, s in SIGNS.items()}


class VehicleTable(Table):
    """Bodies, wheelsets and the elements between them."""

    reference: Name | None = Field(
        default=None,
        description="(no unit): the body that is held at speed and whose accelerations are told; "
        "left out: the heaviest",
    )
    body: Annotated[list[FreeBodyTable], Field(min_length=1)] = Field(
        description="(no unit): bodies, one [[vehicle.body]] each"
    )
    hold_height: NotNegative | None = Field(
        default=None,
        description="m, above the rails' tops, at which the force acts that holds the speed: a "
        "coupler's; left out: at the centre of the body of reference",
    )
    wheelset: Annotated[list[WheelsetTable], Field(min_length=1)] = Field(
        description="(no unit): wheelsets, one [[vehicle.wheelset]] for those that are alike"
    )
    element: Annotated[list[ElementTable], Field(min_length=1)] = Field(
        description="(no unit): springs, dampers, stops and sliders, one [[vehicle.element]] for "
        "those that are alike"
    )
    drive: list[DriveTable] = Field(
        default=[], description="(no unit): driven or braked wheelsets, one [[vehicle.drive]] each"
    )

    @model_validator(mode="after")
    def _joined(self) -> VehicleTable:
        refuse(self._problems())
        return self

    def _problems(self) -> Any:
        """Of names, places and what elements join."""
        names = [body.name for body in self.body]
        for k, name in enumerate(names):
            if name in names[:k]:
                yield relation(f"body[{k}].name", repr(name), "one that no other body has")
        if self.reference is not None and self.reference not in names:
            yield relation("reference", repr(self.reference), ", ".join(names))
        count = len(self.axles)
        if count > MOST_WHEELSETS:
            yield relation("wheelset", f"{count} wheelsets", f"at most {MOST_WHEELSETS}")
        for before, axle in pairwise(self.axles):
            if not before.x > axle.x:
                yield relation("wheelset.positions", axle.x, "each place for one wheelset only")
        if self.length > LONGEST:
            at = [axle.x for axle in self.axles]
            yield relation("wheelset.positions", at, f"within {LONGEST:g} m: they are in m")
        known, met = self.names, set()
        for k, element in enumerate(self.element):
            for i, place in enumerate(element.places):
                for name in place.between:
                    met.add(name)
                    if name not in known:
                        key = f"element[{k}].places[{i}].between"
                        yield relation(key, repr(name), ", ".join(known))
        for k, drive in enumerate(self.drive):
            if drive.reaction not in names:
                yield relation(f"drive[{k}].reaction", repr(drive.reaction), ", ".join(names))
            if not 1 <= min(drive.wheelsets) <= max(drive.wheelsets) <= count:
                yield relation(f"drive[{k}].wheelsets", drive.wheelsets, f"1 to {count}")
        for body in self.body:
            if body.name not in met:
                yield relation(f"body {body.name!r}", "free", "an element that holds it")
        for axle in self.axles:
            if not met & {axle.name, *axle.boxes}:
                yield relation(axle.name, "free", "an element that holds it or its axle boxes")

    @property
    def axles(self) -> tuple[Axle, ...]:
        """All wheelsets, from the front."""
        places = [(x, table) for table in self.wheelset for x in table.positions]
        ordered = sorted(places, key=lambda place: -place[0])
        return tuple(Axle(number, *place) for number, place in enumerate(ordered, start=1))

    @property
    def bodies(self) -> tuple[FreeBodyTable, ...]:
        """The free ones: that of reference first, the others as the scene has them."""
        heaviest = max(self.body, key=lambda body: body.mass).name
        first = self.reference or heaviest
        return tuple(sorted(self.body, key=lambda body: body.name != first))

    @property
    def names(self) -> list[str]:
        """Of all that elements may act on."""
        axles = [name for axle in self.axles for name in (axle.name, *axle.boxes)]
        return [body.name for body in self.bodies] + axles

    @property
    def length(self) -> float:
        """m, between the first and the last wheelset."""
        return self.axles[0].x - self.axles[-1].x

    @property
    def mass(self) -> float:
        """kg, of all."""
        bodies = sum(body.mass for body in self.bodies)
        return bodies + sum(axle.table.mass_on_rails for axle in self.axles)

    def place(self, x: float, y: float, height: float) -> list[float]:
        """m, of a place of the vehicle at rest in the track's frame of which x = 0 is at the last
        wheelset."""
        return [x - self.axles[-1].x, y, -height]
