"""A track of any number of straights, transitions and arcs one after the other.

On a transition curvature and cant go from those of the section before to those of the section
after it by Bloss's 3 u^2 - 2 u^3. With w a change of curvature over the length L of a transition
that begins at a, and u = (s - a)/L from 0 to 1, it adds w (L (u^3 - u^4/2) + max(s - a - L, 0)) to
the heading. The last section goes on for ever.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Annotated, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, model_validator
from railpatch.case.types import Number, Table, relation

Vector = NDArray[np.float64]
# distance of the contacts, by which cant in m becomes an angle
CANT_BASE = 1.5
LEAST_RADIUS = 100.0  # m


class SectionTable(Table):
    """A piece of the track."""

    kind: Literal["straight", "transition", "arc"] = Field(
        description="(no unit): a transition (Bloss) joins what lies before and after it"
    )
    length: Annotated[float, Field(gt=0, le=1e6)] = Field(
        description="m; the last section goes on beyond it"
    )
    radius: Number | None = Field(
        default=None, description="m, of an arc, a right-hand curve > 0; left out elsewhere"
    )
    cant: Annotated[float, Field(ge=0, le=0.3)] = Field(
        default=0.0, description="m, in an arc, of the outer rail above the inner one"
    )

    @model_validator(mode="after")
    def _possible(self) -> SectionTable:
        if self.kind == "arc" and (self.radius is None or abs(self.radius) < LEAST_RADIUS):
            raise relation("radius", self.radius, "at least 100 m to either side in an arc")
        if self.kind != "arc" and self.radius is not None:
            raise relation("radius", self.radius, f"to be left out of a {self.kind}")
        if self.kind != "arc" and self.cant != 0:
            raise relation("cant", self.cant, f"0 in a {self.kind}")
        return self

    @property
    def curvature(self) -> float:
        """1/m, of a straight or an arc."""
        return 0.0 if self.radius is None else 1.0 / self.radius

    @property
    def cant_angle(self) -> float:
        """rad, of a straight or an arc; > 0 in a right-hand curve."""
        return math.copysign(math.asin(self.cant / CANT_BASE), self.curvature)


def check_sections(sections: list[SectionTable]) -> None:
    """Refuses a track whose curvature or cant would jump. Raises a relation's error."""
    kinds = [section.kind for section in sections]
    for k in (0, len(kinds) - 1):
        if kinds[k] == "transition":
            raise relation(f"section[{k}].kind", kinds[k], "a straight or an arc at either end")
    if kinds[0] != "straight":
        raise relation("section[0].kind", kinds[0], "'straight': runs start on straight track")
    for k, (before, after) in enumerate(pairwise(sections), start=1):
        joined = (before.kind == "transition") + (after.kind == "transition")
        if joined == 2:
            raise relation(f"section[{k}].kind", "transition", "one transition at a time")
        same = (before.curvature, before.cant) == (after.curvature, after.cant)
        if joined == 0 and not same:
            raise relation(
                f"section[{k}].kind", after.kind, "a transition where curvature or cant change"
            )


class Sequence:
    """Curvature, cant and heading of sections, by arc length (m) from the start."""

    def __init__(self, sections: list[SectionTable]) -> None:
        ends = np.cumsum([section.length for section in sections])
        steps = [
            (
                ends[k - 1],
                sections[k].length,
                sections[k + 1].curvature - sections[k - 1].curvature,
                sections[k + 1].cant_angle - sections[k - 1].cant_angle,
            )
            for k in range(1, len(sections) - 1)
            if sections[k].kind == "transition"
        ]
        self._steps = [tuple(float(number) for number in step) for step in steps]

    def curvature(self, s: Vector) -> Vector:
        """1/m."""
        return self._sum(s, [bend * bloss((s - a) / way) for a, way, bend, _ in self._steps])

    def cant_angle(self, s: Vector) -> Vector:
        """rad."""
        return self._sum(s, [turn * bloss((s - a) / way) for a, way, _, turn in self._steps])

    def heading(self, s: Vector) -> Vector:
        """rad."""
        parts = []
        for a, way, bend, _ in self._steps:
            u = np.clip((s - a) / way, 0.0, 1.0)
            parts.append(bend * (way * (u**3 - 0.5 * u**4) + np.maximum(s - a - way, 0.0)))
        return self._sum(s, parts)

    def cant_rates(self, s: Vector) -> tuple[Vector, Vector]:
        """1/m, 1/m^2, first and second derivative of the cant angle."""
        slopes, bends = [], []
        for a, way, _, turn in self._steps:
            u = (s - a) / way
            inside = turn * ((u > 0) & (u < 1))
            slopes.append(inside * 6.0 * u * (1.0 - u) / way)
            bends.append(inside * (6.0 - 12.0 * u) / way**2)
        return self._sum(s, slopes), self._sum(s, bends)

    @staticmethod
    def _sum(s: Vector, parts: list[Vector]) -> Vector:
        found = np.zeros_like(s)
        for part in parts:
            found += part
        return found


def bloss(u: Vector) -> Vector:
    """-, from 0 to 1 for u from 0 to 1."""
    u = np.clip(u, 0.0, 1.0)
    return u * u * (3.0 - 2.0 * u)
