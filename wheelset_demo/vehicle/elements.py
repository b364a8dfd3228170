"""Elements between two bodies: their tables, bump stops, where they are."""

from __future__ import annotations

from itertools import pairwise
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray
from pydantic import AfterValidator, Field, model_validator
from railpatch import _core
from railpatch.case.types import NotNegative, Number, Table, exactly, refuse, relation
from railpatch.case.wheel import Text

Vector = NDArray[np.float64]
Triple = Annotated[list[NotNegative], exactly(3)]
Curve = Annotated[list[Annotated[list[Number], exactly(2)]], Field(min_length=2)]
NONE = [0.0, 0.0, 0.0]
AXES = ("x", "y", "z")
# m, by size: ahead, to the right of the vehicle's middle, above the rails' tops
FARTHEST = (1e3, 10.0, 20.0)


def near(place: list[float]) -> list[float]:
    """Refuses places that are on no vehicle, of which most are in mm."""
    if any(abs(x) > far for x, far in zip(place, FARTHEST, strict=True)):
        allowed = ", ".join(f"{far:g}" for far in FARTHEST)
        raise relation("", place, f"up to {allowed} m by size: places are in m")
    return place


Place = Annotated[list[Number], exactly(3), AfterValidator(near)]


class PlaceTable(Table):
    """Where an element is and what it joins."""

    between: Annotated[list[Text], exactly(2)] = Field(
        description="(no unit): names of bodies A and B; axes are those of A"
    )
    at: Place = Field(
        description="m, of both its ends at rest: ahead, to the right of the vehicle's middle, "
        "above the rails' tops"
    )

    @model_validator(mode="after")
    def _two(self) -> PlaceTable:
        if self.between[0] == self.between[1]:
            raise relation("between", self.between, "two bodies")
        return self


class StopTable(Table):
    """Bump stops: force over displacement, as points joined by straight lines that go on."""

    x: Curve | None = Field(default=None, description="[m, N], along A's x")
    y: Curve | None = Field(default=None, description="[m, N], along A's y")
    z: Curve | None = Field(default=None, description="[m, N], along A's z, down")

    @model_validator(mode="after")
    def _possible(self) -> StopTable:
        for axis in AXES:
            curve = getattr(self, axis)
            if curve is not None:
                refuse(problems_of_curve(axis, curve))
        return self


def problems_of_curve(axis: str, curve: list[list[float]]) -> Any:
    """Of a bump stop's points. From displacements >= 0 it is point symmetric."""
    places, forces = ([row[k] for row in curve] for k in (0, 1))
    whole = places[0] < 0
    if any(b <= a for a, b in pairwise(places)):
        yield relation(axis, places, "displacements that increase")
    falls = any(b < a for a, b in pairwise(forces)) or not forces[-1] > forces[0]
    if falls or not (whole or forces[0] == 0):
        allowed = "forces that do not fall" if whole else "forces from 0 on that do not fall"
        yield relation(axis, forces, f"{allowed}, at last > {'the first' if whole else 0}")


class ElementTable(Table):
    """Springs, dampers, stops and sliders that are alike; axes are those of body A."""

    name: Text = Field(description="(no unit): for messages")
    places: Annotated[list[PlaceTable], Field(min_length=1)] = Field(
        description="(no unit): one element at each"
    )
    stiffness: Triple = Field(default=NONE, description="N/m, along x, y, z")
    damping: Triple = Field(default=NONE, description="N s/m, along x, y, z")
    series_stiffness: Triple = Field(
        default=NONE, description="N/m, in series with each damper; 0: none"
    )
    turning_stiffness: Triple = Field(default=NONE, description="N m/rad, about x, y, z")
    turning_damping: Triple = Field(default=NONE, description="N m s/rad, about x, y, z")
    bump_stop: StopTable | None = Field(
        default=None,
        description="over displacements (m, N); points from 0 on are those of one side, of two "
        "that are alike",
    )
    friction_stiffness: Triple = Field(
        default=NONE,
        description="N/m, along x, y, z, of the spring in series with a slider (Jenkins element)",
    )
    friction_force: Triple = Field(
        default=NONE, description="N, along x, y, z, at which the slider moves"
    )
    friction_coefficient: Triple = Field(
        default=NONE,
        description="-, along x, y, z, times the load on this element's vertical spring, added to "
        "friction_force",
    )
    turning_friction_stiffness: Triple = Field(
        default=NONE, description="N m/rad, about x, y, z, of the spring in series with a slider"
    )
    turning_friction_moment: Triple = Field(
        default=NONE, description="N m, about x, y, z, at which the slider turns"
    )

    @model_validator(mode="after")
    def _possible(self) -> ElementTable:
        refuse(self._problems())
        return self

    def _problems(self) -> Any:
        if any(s > 0 and c == 0 for s, c in zip(self.series_stiffness, self.damping, strict=True)):
            yield relation("series_stiffness", self.series_stiffness, "0 where damping is 0")
        limits = [
            f + c for f, c in zip(self.friction_force, self.friction_coefficient, strict=True)
        ]
        for key, name, given in (
            ("friction_stiffness", "friction_force or friction_coefficient", limits),
            ("turning_friction_stiffness", "turning_friction_moment", self.turning_friction_moment),
        ):
            stiffness = getattr(self, key)
            if any((k > 0) != (f > 0) for k, f in zip(stiffness, given, strict=True)):
                yield relation(key, stiffness, f"> 0 where {name} is > 0, and only there")
        if any(self.friction_coefficient) and not self.stiffness[2] > 0:
            value = self.friction_coefficient
            yield relation("friction_coefficient", value, "0 without a vertical stiffness")
        if self.bump_stop is None and not any(any(getattr(self, key)) for key in COEFFICIENTS):
            yield relation("stiffness", self.stiffness, "a coefficient > 0 in some direction")

    def curve(self, axis: int) -> list[list[float]] | None:
        """Of a bump stop, or None."""
        if self.bump_stop is None:
            return None
        found: list[list[float]] | None = getattr(self.bump_stop, AXES[axis])
        return found


# of which an element has one at least
COEFFICIENTS = (
    "stiffness",
    "damping",
    "turning_stiffness",
    "turning_damping",
    "friction_stiffness",
    "turning_friction_stiffness",
)


class Stop:
    """A bump stop: straight lines between the points of its table, and on before the first and
    after the last. A table of displacements >= 0 is point symmetric."""

    def __init__(self, rows: list[list[float]]) -> None:
        points = np.array(rows, dtype=float)
        if points[0, 0] >= 0:
            other = -points[::-1] if points[0, 0] > 0 else -points[:0:-1]
            points = np.vstack([other, points])
        self._d, self._f = points.T.copy()
        self._slopes = np.diff(self._f) / np.diff(self._d)
        areas = 0.5 * (self._f[1:] + self._f[:-1]) * np.diff(self._d)
        self._areas = np.concatenate([[0.0], np.cumsum(areas)])
        self._rest = 0.0
        self._rest = self.energy(0.0)

    def _part(self, d: float) -> int:
        last = len(self._slopes) - 1
        return max(0, min(int(np.searchsorted(self._d, d, side="right")) - 1, last))

    @property
    def points(self) -> tuple[Vector, Vector]:
        """Displacements (m), increasing, and forces (N) there."""
        return self._d, self._f

    def force(self, d: float) -> float:
        """N, against the displacement (m)."""
        return _core.stop_force(self._d, self._f, d)

    def slope(self, d: float) -> float:
        """N/m."""
        return float(self._slopes[self._part(d)])

    def energy(self, d: float) -> float:
        """J, beyond that at 0."""
        k = self._part(d)
        away = d - self._d[k]
        area = self._areas[k] + (self._f[k] + 0.5 * self._slopes[k] * away) * away
        return float(area) - self._rest
