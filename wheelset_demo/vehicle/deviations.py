"""All deviations of a scene's rails along the track: of a spectrum or a record, and of dipped
joints.

A dipped joint: both ends of the rails hang down to it, by z = a (l - |s|)^2/(2 l) over l, half of
its length, to either side; its slopes there are a and -a, and the total angle 2 a of the joint is
what a wheel meets (Jenkins, Stephenson, Clayton, Morland and Lyon, Railway Engineering Journal 3
(1974) 2-16). The corner itself is rounded, by a parabola over a length about that of a contact.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, model_validator
from railpatch.case.track import Irregularity
from railpatch.case.types import Number, Table, relation

from wheelset_demo.vehicle.irregularity import IrregularityTable, irregularity_of

Vector = NDArray[np.float64]
# knots of a dip: at its corner, from there to its middle, on level rails beside it
CORNER_KNOTS, KNOTS, BEYOND = 8, 40, 20
VERTICAL = {"left": (1,), "right": (3,), "both": (1, 3)}


class DipTable(Table):
    """A dipped joint of the rails."""

    position: Number = Field(description="m, along the track")
    angle: Annotated[float, Field(gt=0, le=0.2)] = Field(
        description="rad, total angle between both rails' ends, 2 alpha"
    )
    length: Annotated[float, Field(gt=0, le=100)] = Field(
        default=2.0, description="m, of both hanging ends together; its depth is angle length/8"
    )
    corner: Annotated[float, Field(ge=1e-3, le=1)] = Field(
        default=0.02, description="m, over which the angle itself is rounded"
    )
    rails: Literal["left", "right", "both"] = Field(
        default="both", description="(no unit): that have the joint"
    )

    @model_validator(mode="after")
    def _sharp(self) -> DipTable:
        if not self.corner <= 0.25 * self.length:
            raise relation("corner", self.corner, f"a quarter of 'length' ({self.length}) at most")
        return self


def dip_at(table: DipTable, s: Vector) -> Vector:
    """m, down, at places (m) along the track."""
    half, slope = 0.5 * table.length, 0.5 * table.angle
    away = np.abs(s - table.position)
    hanging = 0.5 * slope * np.maximum(half - away, 0.0) ** 2 / half
    # the corner |s| over c either side becomes (s^2 + c^2)/(2 c)
    c = 0.5 * table.corner
    rounded = np.where(away < c, 0.5 * (away - c) ** 2 / c, 0.0)
    return hanging - slope * rounded


def knots_of(table: DipTable) -> Vector:
    """m, places that show a dip: close ones at its corner."""
    half, c = 0.5 * table.length, table.corner
    near = np.linspace(-c, c, 2 * CORNER_KNOTS + 1)
    # wider ones away from the corner, close ones again where the curvature ends at once
    way = np.geomspace(c, 0.5 * (half + c), KNOTS)
    far = np.concatenate([way, half + c - way[-2::-1]])
    beyond = half + 0.25 * c * np.arange(1, BEYOND + 1) ** 2
    out = np.concatenate([far[1:], beyond])
    return table.position + np.concatenate([-out[::-1], near, out])


def deviations_of(
    table: IrregularityTable | None,
    dips: Sequence[DipTable],
    length: float,
    start: float,
    recorded: Irregularity | None = None,
) -> Irregularity | None:
    """Of a scene's tables, along a track of some length, those of the spectrum from a place on (m);
    recorded: those of a record in its place. None for straight and level rails. Raises
    CaseError."""
    base = recorded if table is None else irregularity_of(table, length, start)
    if not dips:
        return base
    places = [knots_of(dip) for dip in dips]
    if base is not None:
        places.append(base.pieces[0])
    s = np.unique(np.concatenate([np.array([0.0, length]), *places]))
    # knots closer than this say the same twice
    s = s[np.append(True, np.diff(s) > 1e-5)]
    found = np.zeros((len(s), 4)) if base is None else base.at(s).reshape(len(s), 4)
    for dip in dips:
        for column in VERTICAL[dip.rails]:
            found[:, column] += dip_at(dip, s)
    return Irregularity(s, found)
