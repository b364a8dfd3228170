"""Tables of [track]: profiles along the track, rails on springs and dampers."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field, model_validator

from railpatch.case.types import Number, Table, between, exactly, relation

# a stiffness of 0 stands for a rigid direction
Stiffness = Annotated[float, between(0, 1e15)]
StiffnessPair = Annotated[list[Stiffness], exactly(2)]


class Section(Table):
    """A rail's profile at a position along the track."""

    position: Number = Field(description="m, along the track, as wheelset.x")
    profile: Annotated[str, Field(min_length=1)] = Field(
        description="path or built-in name (file, no unit)"
    )


Sections = Annotated[list[Section], Field(min_length=1, max_length=10_000)]


def check_sections(sections: list[Section] | None) -> None:
    """Raises unless the positions increase."""
    for before, after in zip(sections or [], (sections or [])[1:], strict=False):
        if not after.position > before.position:
            allowed = f"positions that increase, more than {before.position:g} m"
            raise relation("sections", f"position {after.position:g}", allowed)


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
