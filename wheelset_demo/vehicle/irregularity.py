"""Rails that are not straight, from a published spectrum.

One-sided spectra over the wave number W (rad/m), of ORE B176 (ORE B176 RP 1, 1989; as in Claus and
Schiehlen, Vehicle System Dynamics 29 Suppl. (1998) 390-404):

    S(W) = A Wc^2 / ((W^2 + Wr^2) (W^2 + Wc^2))             lateral, vertical       m^2/(rad/m)
    S(W) = A Wc^2 W^2 / ((W^2 + Wr^2) (W^2 + Wc^2) (W^2 + Ws^2)) / b^2  cross level, rad^2/(rad/m)

with the vertical A and b = 0.75 m in the last. A deviation is a sum of waves of equal shares of the
logarithm of W with phases (and their place within each share) from a generator with the scene's
seed; its variance is the integral of S over the range of waves, but for how the shares are taken.
"""

from __future__ import annotations

import math
from typing import Annotated, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, model_validator
from railpatch.case.track import Irregularity
from railpatch.case.types import NotNegative, Table, relation

Vector = NDArray[np.float64]
# rad/m
CUT, RISE, TWIST = 0.8246, 0.0206, 0.4380
# m rad, lateral and vertical
LEVELS = {"low": (2.119e-7, 4.032e-7), "high": (6.125e-7, 1.080e-6)}
ARM = 0.75  # m, b: half the distance of the contacts
WAVES = 400
# of a record: points in the shortest wave
POINTS = 12
# points at which waves are summed at once: 13 MB
BLOCK = 4096


class IrregularityTable(Table):
    """Rails that are not straight, after ORE B176."""

    level: Literal["low", "high"] = Field(
        default="low", description="(no unit): of the spectra, good or bad track"
    )
    seed: Annotated[int, Field(ge=0, le=2**32)] = Field(
        default=1, description="-, of the waves' phases"
    )
    shortest: Annotated[float, Field(ge=1, le=100)] = Field(
        default=3.0, description="m, shortest wave"
    )
    longest: Annotated[float, Field(ge=1, le=1000)] = Field(
        default=120.0, description="m, longest wave"
    )
    factor: NotNegative = Field(default=1.0, description="-, of all deviations")
    begins: Annotated[float, Field(ge=1, le=1e5)] = Field(
        default=30.0, description="m, from straight rails to the full deviations"
    )

    @model_validator(mode="after")
    def _range(self) -> IrregularityTable:
        if not self.longest > self.shortest:
            raise relation("longest", self.longest, f"> 'shortest' ({self.shortest})")
        return self


def spectrum(kind: str, level: str, wave_number: Vector) -> Vector:
    """One-sided, m^2/(rad/m), of "lateral" and "vertical" deviations, rad^2/(rad/m) of "cross"."""
    lateral, vertical = LEVELS[level]
    amplitude = lateral if kind == "lateral" else vertical
    squared = np.asarray(wave_number, dtype=float) ** 2
    found = amplitude * CUT**2 / ((squared + RISE**2) * (squared + CUT**2))
    return found * squared / (squared + TWIST**2) / ARM**2 if kind == "cross" else found


class Waves:
    """A sum of waves with a spectrum. amplitudes: m or rad. numbers: rad/m. phases: rad."""

    def __init__(self, kind: str, table: IrregularityTable, generator: np.random.Generator) -> None:
        low, high = 2 * math.pi / table.longest, 2 * math.pi / table.shortest
        edges = np.geomspace(low, high, WAVES + 1)
        self.numbers = edges[:-1] + generator.random(WAVES) * np.diff(edges)
        density = spectrum(kind, table.level, self.numbers)
        self.amplitudes = table.factor * np.sqrt(2 * density * np.diff(edges))
        self.phases = 2 * math.pi * generator.random(WAVES)

    def at(self, s: Vector) -> Vector:
        """[n], at arc lengths (m)."""
        found = np.empty(len(s))
        for begin in range(0, len(s), BLOCK):
            part = slice(begin, begin + BLOCK)
            angles = np.multiply.outer(s[part], self.numbers) + self.phases
            found[part] = np.cos(angles) @ self.amplitudes
        return found


def record(table: IrregularityTable, length: float, start: float) -> tuple[Vector, Vector]:
    """Positions [n] and deviations [n, 4] of left and right rail, lateral and vertical, m.

    length, start: m, of the track, and from where rails are not straight.
    """
    spacing = table.shortest / POINTS
    s = spacing * np.arange(math.ceil(length / spacing) + 1)
    generator = np.random.default_rng(table.seed)
    lateral, vertical, cross = (
        Waves(kind, table, generator).at(s) for kind in ("lateral", "vertical", "cross")
    )
    # a smooth begin: 3 u^2 - 2 u^3
    u = np.clip((s - start) / table.begins, 0.0, 1.0)
    share = u * u * (3 - 2 * u)
    left, right = vertical - ARM * cross, vertical + ARM * cross
    return s, share[:, None] * np.stack([lateral, left, lateral, right], axis=1)


def irregularity_of(table: IrregularityTable, length: float, start: float) -> Irregularity:
    """Of a scene's table, along a track of some length, from a place on (m)."""
    return Irregularity(*record(table, length, start))
