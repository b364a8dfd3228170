"""Friction that conditions: it changes with the work done on the running band.

Films and debris are rubbed off or built up where a wheel runs. The profile of each wheel, or of its
roller, is divided into strips; each has a conditioning c from 0, as found, to 1. A strip on which
friction does the work w for each metre of the profile's width goes on by

    dc = (1 - c) dw / w0,   c = 1 - (1 - c0) exp(-w / w0)

and one without contact loses what it has by its recovery constants, c = c0 exp(-t / t0 - W / W0), W
the friction work of the wheel in that time. The work of a contact lies over its width as its normal
force does; so does its friction coefficient, which is the scene's times

    1 + (plateau - 1) mean of c

As friction turns the work of a contact into its power and back, position and strips are found
together, in rounds: half of the time between two positions the contact is that of the first one,
half of it that of the second.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from railpatch.case.types import SIDES

from rig_model.search import Vector
from rig_model.tables import ConditioningTable
from rig_model.wheels import axle_of


@dataclass(frozen=True)
class Load:
    """The normal force of one wheel over the strips.

    first: number of the first strip; shares: [n], of the force on each strip, their sum is 1.
    power: W, of its friction, that of a layer which yields too.
    """

    first: int
    shares: Vector
    power: float


@dataclass(frozen=True)
class Pose:
    """Where the wheelset is.

    centre: m, [3], track axes; roll, yaw: rad. roller: m, lateral place of the wheel's roller.
    """

    centre: tuple[float, float, float]
    roll: float
    yaw: float
    roller: float


@dataclass(frozen=True)
class Band:
    """The strips of one wheel: first: number of the first one. conditioned: [n], c of each, 0 of
    all others. work: J, of friction, since the start."""

    first: int = 0
    conditioned: Vector = field(default_factory=lambda: np.zeros(0))
    work: float = 0.0

    def over(self, first: int, count: int) -> Vector:
        """[count], c of strips."""
        found = np.zeros(count)
        low = max(first, self.first)
        high = min(first + count, self.first + len(self.conditioned))
        if low < high:
            found[low - first : high - first] = self.conditioned[
                low - self.first : high - self.first
            ]
        return found

    def mean(self, load: Load) -> float:
        """c of a contact."""
        return float((self.over(load.first, len(load.shares)) * load.shares).sum())


@dataclass(frozen=True)
class ConditioningState:
    """Of one wheel after one position.

    factor: -, of the friction law. conditioning: -, c of the contact. power: W, and work: J since
    the start, of friction. position: m, [n], middles of the strips, from the wheelset's middle
    along its axle, or of rollers from the track's middle; conditioned: [n], c of each.
    """

    factor: float
    conditioning: float
    power: float
    work: float
    position: list[float]
    conditioned: list[float]


class Conditioning:
    """The bands of both wheels, from one balanced position to the next."""

    def __init__(self, table: ConditioningTable) -> None:
        self._table = table
        self._bands = dict.fromkeys(SIDES, Band())
        self._loads: dict[str, Load] | None = None
        self._time = 0.0

    @property
    def most(self) -> float:
        """-, greatest factor of the friction law."""
        return max(1.0, self._table.plateau)

    def factor(self, conditioning: float) -> float:
        """-, of the friction law."""
        return 1.0 + (self._table.plateau - 1.0) * conditioning

    def factors(self, loads: Mapping[str, Load], time: float) -> dict[str, float]:
        """Of both wheels, if they come to these loads at a time (s); changes nothing."""
        bands = self._reached(loads, time)
        return {side: self.factor(bands[side].mean(loads[side])) for side in SIDES}

    def started(self) -> dict[str, float]:
        """A first guess of the next factors: where the last position was."""
        if self._loads is None:
            return dict.fromkeys(SIDES, 1.0)
        return self.factors(self._loads, self._time)

    def moved(self, loads: Mapping[str, Load], time: float) -> dict[str, ConditioningState]:
        """To a balanced position, of both wheels."""
        self._bands = self._reached(loads, time)
        self._loads, self._time = dict(loads), time
        return {side: self._state(self._bands[side], loads[side]) for side in SIDES}

    def load(self, wheel: Mapping[str, Any], pose: Pose) -> Load:
        """Of a wheel's result with fields."""
        return load_over(wheel, pose, self._table.bin, self._table.body)

    def _state(self, band: Band, load: Load) -> ConditioningState:
        middles = (band.first + np.arange(len(band.conditioned)) + 0.5) * self._table.bin
        found = band.mean(load)
        return ConditioningState(
            self.factor(found),
            found,
            load.power,
            band.work,
            middles.tolist(),
            band.conditioned.tolist(),
        )

    def _reached(self, loads: Mapping[str, Load], time: float) -> dict[str, Band]:
        """The bands at a time, with the last loads until the middle and these from there."""
        if self._loads is None:
            return self._bands
        half = 0.5 * (time - self._time)
        return {
            side: self.worn(
                self.worn(self._bands[side], self._loads[side], half), loads[side], half
            )
            for side in SIDES
        }

    def worn(self, band: Band, load: Load, seconds: float) -> Band:
        """A band after a load has run on it."""
        table = self._table
        low, end = load.first, load.first + len(load.shares)
        if len(band.conditioned):
            low, end = min(low, band.first), max(end, band.first + len(band.conditioned))
        shares = np.zeros(end - low)
        shares[load.first - low :][: len(load.shares)] = load.shares
        work = load.power * seconds
        lost = 0.0
        if table.recovery_time is not None:
            lost += seconds / table.recovery_time
        if table.recovery_work is not None:
            lost += work / table.recovery_work
        before = band.over(low, end - low)
        left = 1.0 - (1.0 - before) * np.exp(-shares * work / (table.bin * table.work))
        left = np.where(shares > 0, left, before * math.exp(-lost))
        return replace(band, first=low, conditioned=left, work=band.work + work)


def load_over(wheel: Mapping[str, Any], pose: Pose, width: float, body: str) -> Load:
    """The normal force of a wheel's patches over strips of a width (m)."""
    parts = [rows_of(p, pose, body) for p in [*wheel["patches"], *wheel["alternatives"]]]
    low = math.floor(min(edges[0] for edges, _ in parts) / width)
    high = math.ceil(max(edges[-1] for edges, _ in parts) / width)
    borders = np.arange(low, high + 1) * width
    shares = np.zeros(high - low)
    for edges, force in parts:
        shares += np.diff(np.interp(borders, edges, np.concatenate([[0.0], np.cumsum(force)])))
    power = wheel["friction_power"]
    if math.isfinite(wheel["plastic_power"]):
        power += wheel["plastic_power"]
    return Load(low, shares / shares.sum(), power)


def rows_of(patch: Mapping[str, Any], pose: Pose, body: str) -> tuple[Vector, Vector]:
    """Edges of a patch's rows on a body's profile, m, [n+1], rising, and the normal force of each
    row, N, [n]."""
    x, y = np.asarray(patch["x"]), np.asarray(patch["y"])
    pressure = np.asarray(patch["pressure"])
    force = np.abs(np.gradient(x, axis=-1)) * pressure
    force = force.sum(axis=1) * np.abs(np.gradient(y))
    place = patch["position"]
    if patch.get("row_position") is not None:
        across, down = np.asarray(patch["row_position"])
    else:
        angle = patch["contact_angle"]
        across, down = place[1] + y * math.cos(angle), place[2] + y * math.sin(angle)
    if body == "wheel":
        axle = axle_of(pose.roll, pose.yaw)
        at = axle[0] * (place[0] - pose.centre[0]) + axle[1] * (across - pose.centre[1])
        at = at + axle[2] * (down - pose.centre[2])
    else:
        at = across - pose.roller
    between = 0.5 * (at[1:] + at[:-1])
    edges = np.concatenate([[2 * at[0] - between[0]], between, [2 * at[-1] - between[-1]]])
    scaled = force * (patch["share"] * patch["normal_force"] / force.sum())
    return (edges, scaled) if edges[-1] > edges[0] else (edges[::-1], scaled[::-1])
