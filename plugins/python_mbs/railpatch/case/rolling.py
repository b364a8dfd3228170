"""What varies along the rolling direction of wheels, and rolling step by step."""

from __future__ import annotations

from itertools import pairwise
from typing import Annotated, Any, Literal

from pydantic import Field, model_validator

from railpatch.case.common import couples
from railpatch.case.types import (
    SIDES,
    Number,
    Table,
    between,
    exactly,
    relation,
)

Height = Annotated[float, between(-0.1, 0.1)]
# keys of [wheelset.left], [track.left] and the right ones that do not move from step to step
SHAPE_KEYS = ("runout", "flat", "running_surface", "joint")


class Flat(Table):
    """A flat of a wheel: a chord of the circle with rounded ends."""

    depth: Annotated[float, between(1e-6, 0.01)] = Field(
        description="m, of its middle below the circle; its length is 2 sqrt(2 R depth - depth^2)"
    )
    angle: Number = Field(
        default=0.0, description="rad, the wheelset's pitch at which its middle is lowest"
    )
    rounding: Annotated[float, between(5e-4, 0.05)] = Field(
        default=5e-3, description="m, length over which each end is rounded"
    )


class Joint(Table):
    """A joint of two rails: a dip, a step and a gap."""

    position: Number = Field(description="m, along the track")
    depth: Annotated[float, between(0, 0.05)] = Field(
        default=0.0, description="m, by which both rails' ends hang: parabolas, level far away"
    )
    length: Annotated[float, between(0.01, 100)] = Field(
        default=0.5, description="m, of both parabolas together"
    )
    step: Annotated[float, between(-0.02, 0.02)] = Field(
        default=0.0, description="m, by which the rail behind the joint (greater x) lies higher"
    )
    gap: Annotated[float, between(0, 0.05)] = Field(
        default=0.0, description="m, between the rails' ends, where nothing carries"
    )
    rounding: Annotated[float, between(5e-4, 0.1)] = Field(
        default=5e-3, description="m, length over which the corners are rounded"
    )


class WheelShape(Table):
    """A wheel out of round."""

    runout: Annotated[str, Field(min_length=1)] | list[Height] | None = Field(
        default=None,
        description="m, radius minus that of the profile at equally spaced pitch angles of a full "
        "turn from 0 on: a text file, or 8 values or more; left out: round",
    )
    flat: Flat | None = Field(default=None, description="a flat, added to runout (m, rad)")

    @model_validator(mode="after")
    def _enough(self) -> Any:
        if isinstance(self.runout, list) and len(self.runout) < 8:
            raise relation("runout", f"{len(self.runout)} values", "8 values or more")
        return self


class RailShape(Table):
    """A rail whose running surface is not level."""

    running_surface: (
        Annotated[str, Field(min_length=1)] | list[Annotated[list[Number], exactly(2)]] | None
    ) = Field(
        default=None,
        description="m, [[position along the track, height], ...], above 0 higher, smooth between "
        "and constant beyond: a text file of two columns, or rows; left out: level",
    )
    joint: Joint | None = Field(default=None, description="a joint, added to it (m)")

    @model_validator(mode="after")
    def _in_order(self) -> Any:
        if isinstance(self.running_surface, list):
            places = [row[0] for row in self.running_surface]
            if len(places) < 4 or any(b <= a for a, b in pairwise(places)):
                shown = f"{len(places)} rows"
                raise relation("running_surface", shown, "4 rows or more of growing positions")
        return self


class WheelMotion(Table):
    """How wheels roll."""

    regime: Literal["steady_rolling", "transient_rolling"] = Field(
        default="steady_rolling",
        description="each step on its own, or rolling on from the last step's tractions by "
        "wheelset.time_step (no unit)",
    )


def shape_keys(case: Any) -> list[str]:
    """The keys of shapes along x that a case with wheels has."""
    return [
        f"{table}.{side}.{key}"
        for table in ("wheelset", "track")
        for side in SIDES
        for key in SHAPE_KEYS
        if getattr(getattr(getattr(case, table), side), key, None) is not None
    ]


def check_rolling(case: Any) -> None:
    """What transient rolling and shapes along x are not combined with."""
    shaped = shape_keys(case)
    if shaped and case.method.normal != "half_space":
        raise relation(shaped[0], "given", "only with method.normal = 'half_space'")
    curved = case.method.reference_surface != "plane"
    if shaped and curved:
        raise relation(shaped[0], "given", "only with method.reference_surface = 'plane'")
    heights = [key for key in shaped if key.startswith("track")]
    if heights and case.track.kind == "roller":
        raise relation(heights[0], "given", "only with track.kind = 'rail'")
    if case.motion.regime == "steady_rolling":
        return
    where = "with motion.regime = 'transient_rolling'"
    if not case.wheelset.time_step > 0:
        raise relation("wheelset.time_step", case.wheelset.time_step, f"> 0 {where}")
    if case.method.tangential != "full":
        raise relation("method.tangential", repr(case.method.tangential), f"'full' {where}")
    if curved:
        raise relation("method.reference_surface", "'curved'", f"'plane' {where}")
    if case.grid is None or case.grid.element_size is None or case.grid.fitted is not None:
        raise relation("grid.element_size", "missing", f"a size, and no fitted rows, {where}")
    if case.friction is not None and case.friction.law == "temperature":
        shown = repr(case.friction.law)
        raise relation("friction.law", shown, f"'coulomb' or 'slip_velocity' {where}")
    if case.layer is not None and case.layer.is_plastic:
        raise relation("layer", "one that yields", f"an elastic layer {where}")
    if case.temperature is not None:
        raise relation("temperature", "given", f"to be left out {where}")
    if couples(case.material):
        raise relation("material", "unlike bodies", f"equal (1 - 2 nu)/G {where}")
