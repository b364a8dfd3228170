"""Wet stretches of the track, and rails that wheels clean for those that follow.

With ``[fluid] recovery`` the work that friction spends on a metre of rail cleans it
(docs/fluids.md): it is kept in cells along each rail, and every wheel meets the sum of what those
ahead of it have left there. A wheel's work comes into a cell when it leaves it, so that it does not
meet its own.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated

import numpy as np
from numpy.typing import NDArray
from pydantic import Field
from railpatch import _core
from railpatch.case.fluid import Fluid
from railpatch.case.types import NotNegative, Table, within

Vector = NDArray[np.float64]
CELL = 0.1  # m, of a rail
MOST_CELLS = 2_000_000
# models of [fluid] that read a rate
WITH_RATE = ("film", "regimes")


class WetTable(Table):
    """A stretch of both rails with another supply of liquid."""

    position: NotNegative = Field(description="m, along the track, where it begins")
    length: Annotated[float, Field(gt=0, le=1e5)] = Field(description="m")
    water_rate: Annotated[float, within("fluid_water_rate")] = Field(
        description="m^3/s, of liquid for each contact there; elsewhere fluid.water_rate"
    )


def wet_problems(wet: tuple[WetTable, ...], fluid: Fluid | None) -> Iterator[str]:
    """Of stretches without a liquid whose supply counts, and of two at a place."""
    if wet and (fluid is None or fluid.water_rate is None):
        allowed = "allowed only with fluid.water_rate, that of the rest of the track"
        if fluid is None:
            yield f"wet: given without [fluid], {allowed}"
        elif fluid.model not in WITH_RATE:
            models = " or ".join(repr(model) for model in WITH_RATE)
            yield f"wet: given with fluid.model = {fluid.model!r}, allowed only with {models}"
        elif fluid.oil_film is not None:
            yield f"wet: given with fluid.oil_film, {allowed}"
        else:
            yield f"wet: given without fluid.water_rate, {allowed}"
    ordered = sorted(range(len(wet)), key=lambda k: wet[k].position)
    end = 0.0
    for k in ordered:
        if wet[k].position < end:
            value = wet[k].position
            yield f"wet[{k}].position: value is {value}, allowed >= {end:.6g} m, where another ends"
        end = max(end, wet[k].position + wet[k].length)


class WetTrack:
    """Supply and work along the rails. work: J/m, [2, cells], on left and right rail; compiled: the
    same in C++, whose memory it is."""

    def __init__(self, wet: tuple[WetTable, ...], fluid: Fluid, length: float, count: int) -> None:
        """length: m, of the track; count: of wheelsets."""
        ordered = sorted(wet, key=lambda one: one.position)
        borders = np.array([x for w in ordered for x in (w.position, w.position + w.length)])
        rates = np.array([np.nan, *(x for w in ordered for x in (w.water_rate, np.nan))])
        self.cell = max(CELL, length / MOST_CELLS)
        cells = int(length / self.cell) + 2 if fluid.recovery is not None else 0
        self.compiled = _core.WetRails(count, borders, rates, self.cell, cells)
        self.work: Vector = self.compiled.work

    @classmethod
    def of(
        cls, wet: tuple[WetTable, ...], fluid: Fluid | None, length: float, count: int
    ) -> WetTrack | None:
        """None where nothing of it changes along the track."""
        changes = fluid is not None and (bool(wet) or fluid.recovery is not None)
        return cls(wet, fluid, length, count) if fluid is not None and changes else None

    def begin(self, positions: Vector) -> None:
        """The wheelsets stand at positions (m)."""
        self.compiled.begin(positions)

    def put(self, positions: Vector, water: Vector) -> None:
        """Into the force element's array what is at the positions (m) of the wheelsets."""
        self.compiled.put(positions, water)

    def leave(self, positions: Vector, work: Vector) -> None:
        """After a step to the positions (m): friction's work in it, [wheelsets, 2] (J), is spread
        over the way."""
        self.compiled.leave(positions, work)

    @property
    def spent(self) -> float:
        """J, on both rails so far, with what is in the cells that wheels are in."""
        return float(self.work.sum() * self.cell + self.compiled.own.sum())
