"""What varies along the rolling direction of wheels, and rolling step by step."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Annotated, Any, Literal

from pydantic import Field, model_validator

from railpatch.case.common import couples, yields_by
from railpatch.case.types import (
    LEFT_OUT,
    SIDES,
    Number,
    Problems,
    Table,
    between,
    exactly,
    relation,
)

HIGHEST = 0.1  # m, either way; the core's check has the same
Height = Annotated[float, between(-HIGHEST, HIGHEST)]
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
        default=5e-3,
        description="m, length over which each end is rounded, at most a third of the flat's "
        "length; left out: 0.005, or that third where it is less",
    )

    def length(self, radius: float) -> float:
        """m, of the chord."""
        return 2 * math.sqrt(self.depth * (2 * radius - self.depth))


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
    regime_changes: bool = Field(
        default=False,
        description="-, whether a step of a Contact may have another regime than the last one, "
        "from whose tractions it goes on: regime is then a moving key",
    )

    @property
    def moving(self) -> tuple[str, ...]:
        """The regime, where it changes."""
        return ("regime",) if self.regime_changes else ()


def shape_keys(case: Any) -> list[str]:
    """The keys of shapes along x that a case with wheels has."""
    return [
        f"{table}.{side}.{key}"
        for table in ("wheelset", "track")
        for side in SIDES
        for key in SHAPE_KEYS
        if getattr(getattr(getattr(case, table), side), key, None) is not None
    ]


def check_flat(case: Any, side: str) -> Problems:
    """Rounded ends that would overlap."""
    flat = getattr(case.wheelset, side).flat
    if flat is None or flat.rounding == Flat.model_fields["rounding"].default:
        return
    most = flat.length(case.wheelset.nominal_radius) / 3
    if flat.rounding > most * (1 + 1e-9):
        allowed = f"<= {most:.4g}, a third of the flat's length"
        yield relation(f"wheelset.{side}.flat.rounding", flat.rounding, allowed)


def check_rolling(case: Any) -> Problems:
    """What transient rolling and shapes along x are not combined with."""
    shaped = shape_keys(case)
    for side in case.sides:
        yield from check_flat(case, side)
    if shaped and case.method.normal != "half_space":
        yield relation(shaped[0], "given", "only with method.normal = 'half_space'")
    curved = case.method.reference_surface != "plane"
    if shaped and curved:
        yield relation(shaped[0], "given", "only with method.reference_surface = 'plane'")
    heights = [key for key in shaped if key.startswith("track")]
    if heights and case.track.kind == "roller":
        yield relation(heights[0], "given", "only with track.kind = 'rail'")
    if case.motion.regime_changes and not case.has_tangential:
        yield relation("motion.regime_changes", True, "False with method.tangential = 'none'")
    if case.motion.regime == "steady_rolling" and not case.motion.regime_changes:
        heated = case.temperature is not None and case.temperature.bulk is not None
        cleans = case.fluid is not None and case.fluid.recovery is not None
        dries = case.fluid is not None and case.fluid.dries
        timed = heated or cleans or dries or case.track.rail_support is not None
        if case.wheelset.time_step > 0 and not timed:
            allowed = (
                "0 but with motion.regime = 'transient_rolling', track.rail_support, "
                "temperature.bulk, fluid.recovery or fluid.oxide.drying"
            )
            yield relation("wheelset.time_step", case.wheelset.time_step, allowed)
        return
    changes = case.motion.regime_changes
    regime = "motion.regime_changes" if changes else "motion.regime = 'transient_rolling'"
    where = f"with {regime}"
    if changes and case.fluid is not None:
        yield relation("fluid", "given", f"{LEFT_OUT} {where}")
    if changes and case.method.accuracy is not None:
        yield relation("method.accuracy", case.method.accuracy, f"{LEFT_OUT} {where}: give 'grid'")
    if not case.wheelset.time_step > 0:
        yield relation("wheelset.time_step", case.wheelset.time_step, f"> 0 {where}")
    if case.method.tangential != "full":
        yield relation("method.tangential", repr(case.method.tangential), f"'full' {where}")
    if case.grid is not None and case.grid.fitted is not None:
        yield relation("grid.fitted", str(case.grid.fitted), f"{LEFT_OUT} {where}")
    if case.grid is None or case.grid.element_size is None:
        yield relation("grid.element_size", "missing", f"[dx, dy] in m {where}")
    if case.friction is not None and case.friction.law == "temperature":
        shown = repr(case.friction.law)
        yield relation("friction.law", shown, f"'coulomb' or 'slip_velocity' {where}")
    if case.layer is not None and case.layer.is_plastic:
        yield relation(yields_by(case.layer), "given", f"an elastic layer {where}")
    if case.temperature is not None:
        yield relation("temperature", "given", f"{LEFT_OUT} {where}")
    if couples(case.material):
        yield relation("material", "unlike bodies", f"equal (1 - 2 nu)/G {where}")


def place_problems(case: Any, run: str) -> list[str]:
    """Of a case of wheels with what changes along the track or round a wheel, for runs that have
    one place of both. run: which one."""
    friction = None if case.friction is None else case.friction.along_track
    given = {"friction.along_track": friction, "track.irregularity": case.track.irregularity}
    for side in SIDES:
        wheel, rail = getattr(case.wheelset, side), getattr(case.track, side)
        given |= {f"wheelset.{side}.{key}": getattr(wheel, key) for key in ("flat", "runout")}
        given |= {f"track.{side}.{key}": getattr(rail, key) for key in ("joint", "running_surface")}
        for path, sections in (("wheelset", wheel.sections), ("track", rail.sections)):
            # one alone is the same everywhere
            given[f"{path}.{side}.sections"] = sections if len(sections or ()) > 1 else None
    return [
        f"{key}: given, allowed to be left out: {run} has one place along the track and round the "
        "wheels"
        for key, value in given.items()
        if value is not None
    ]
