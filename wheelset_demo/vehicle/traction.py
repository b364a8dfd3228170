"""Tables of driven wheelsets and of the control of their slip; see drives."""

from __future__ import annotations

from itertools import pairwise
from typing import Annotated, Any

from pydantic import Field, model_validator
from railpatch.case.types import NotNegative, Number, Positive, Table, exactly, refuse, relation

Courses = Annotated[list[Annotated[list[Number], exactly(2)]], Field(min_length=1)]


class SlipControlTable(Table):
    """A sampled PI controller of a driven wheelset's slip."""

    target: Annotated[float, Field(gt=0, le=1)] = Field(
        description="-, slip speed that is sought, over the speed"
    )
    least: NotNegative = Field(default=0.05, description="m/s, slip speed that is sought at least")
    proportional: NotNegative = Field(description="N m per m/s of slip speed")
    integral: NotNegative = Field(description="N m per m/s and s")
    period: Annotated[float, Field(ge=1e-4, le=1)] = Field(
        default=0.01, description="s, between its samples; torques are held"
    )
    rate: Positive = Field(default=1e6, description="N m/s, by which torques change at most")

    @model_validator(mode="after")
    def _acts(self) -> SlipControlTable:
        if self.proportional == 0 and self.integral == 0:
            raise relation("integral", self.integral, "> 0 where proportional is 0")
        return self


class DriveTable(Table):
    """Motors, or brakes, of some wheelsets on one body."""

    wheelsets: Annotated[list[int], Field(min_length=1)] = Field(
        description="-, numbers of the wheelsets, from 1 in front"
    )
    reaction: str = Field(description="(no unit): name of the body that carries the motors")
    torque: Courses = Field(
        description="[[s, N m], ...], on each wheelset over time, > 0 pulls; straight lines "
        "between the points, held before and after"
    )
    slip_control: SlipControlTable | None = Field(
        default=None, description="takes torque away where wheels slip too much (no unit)"
    )

    @model_validator(mode="after")
    def _possible(self) -> DriveTable:
        refuse(self._problems())
        return self

    def _problems(self) -> Any:
        times = [row[0] for row in self.torque]
        if any(b <= a for a, b in pairwise(times)):
            yield relation("torque", times, "times that increase")
        wanted = [row[1] for row in self.torque]
        if min(wanted) < 0 < max(wanted) and self.slip_control is not None:
            yield relation("torque", self.torque, "torques of one sign with a slip control")
        if len(set(self.wheelsets)) < len(self.wheelsets):
            yield relation("wheelsets", self.wheelsets, "each once")
