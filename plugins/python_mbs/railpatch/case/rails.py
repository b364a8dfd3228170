"""Tables of [track]: profiles along the track, springs under rails; profiles round wheels."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Annotated

from pydantic import Field, model_validator

from railpatch.case.types import (
    Number,
    Problems,
    Table,
    between,
    exactly,
    from_to_below,
    relation,
)

# a stiffness of 0 stands for a rigid direction
Stiffness = Annotated[float, between(0, 1e15)]
StiffnessPair = Annotated[list[Stiffness], exactly(2)]


# arc lengths along a profile, which is no longer than that
Feature = Annotated[float, between(0, 2)]


class SectionProfile(Table):
    """A profile of several, and where its features lie."""

    profile: Annotated[str, Field(min_length=1)] = Field(
        description="path or built-in name (file, no unit)"
    )
    features: Annotated[list[Feature], Field(min_length=1, max_length=100)] | None = Field(
        default=None,
        description="m, arc lengths along the profile from its first point on, that do not fall: "
        "places that belong together in all sections; where two are equal the part between them is "
        "missing; left out: equal shares of the length belong together",
    )
    kink: bool = Field(
        default=False,
        description="whether the slope over the place changes at once here, with "
        "section_blend = 'cubic'; so it does where a part begins or ends (no unit)",
    )


class Section(SectionProfile):
    """A rail's profile at a position along the track."""

    position: Number = Field(description="m, along the track, as wheelset.x")

    @property
    def place(self) -> float:
        """m."""
        return self.position


class WheelSection(SectionProfile):
    """A wheel's profile at an angle round it."""

    angle: Annotated[float, from_to_below(0, 2 * math.pi)] = Field(
        description="rad, the wheelset's pitch at which it is lowest"
    )

    @property
    def place(self) -> float:
        """rad."""
        return self.angle


Sections = Annotated[list[Section], Field(min_length=1, max_length=10_000)]
WheelSections = Annotated[list[WheelSection], Field(min_length=1, max_length=10_000)]


def check_sections(sections: Sequence[Section] | Sequence[WheelSection] | None) -> None:
    """Raises unless the places increase and all have as many features."""
    for before, after in zip(sections or [], (sections or [])[1:], strict=False):
        name, unit = ("position", "m") if isinstance(after, Section) else ("angle", "rad")
        if not after.place > before.place:
            allowed = f"{name}s that increase, more than {before.place:g} {unit}"
            raise relation("sections", f"{name} {after.place:g}", allowed)
        counts = [len(section.features or ()) for section in (before, after)]
        if counts[0] != counts[1]:
            allowed = f"as many in each section, {counts[0]} as in the one before"
            raise relation("sections", f"{counts[1]} features", allowed)


def check_blend(blend: str | None, lists: Mapping[str, Sequence[SectionProfile]]) -> Problems:
    """What is said of several sections is said of some. lists: by key."""
    if blend is not None and max(map(len, lists.values())) < 2:
        yield relation("track.section_blend", repr(blend), "with two or more 'sections'")
    for name, sections in lists.items():
        for index, section in enumerate(sections):
            if section.kink and blend != "cubic":
                allowed = "false but with track.section_blend = 'cubic'"
                yield relation(f"{name}[{index}].kink", "true", allowed)


class RailSupport(Table):
    """Springs and dampers without mass under each rail or roller: lateral, vertical."""

    stiffness: StiffnessPair = Field(
        description="N/m, of each rail, lateral and vertical; 0: rigid in this direction"
    )
    damping: StiffnessPair = Field(
        default=[0.0, 0.0], description="N s/m, lateral and vertical, with wheelset.time_step"
    )

    @model_validator(mode="after")
    def _springs(self) -> RailSupport:
        for stiffness, damping in zip(self.stiffness, self.damping, strict=True):
            if 0 < stiffness < 1:
                raise relation("stiffness", str(self.stiffness), "0 or at least 1 N/m")
            if damping > 0 and stiffness == 0:
                allowed = "0 in a direction whose stiffness is 0: there the rail is rigid"
                raise relation("damping", str(self.damping), allowed)
        if not any(self.stiffness):
            allowed = "one that is not 0, or no table 'rail_support'"
            raise relation("stiffness", str(self.stiffness), allowed)
        return self
