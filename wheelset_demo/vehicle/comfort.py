"""Ride comfort at points of a body, as EN 12299 counts it.

Accelerations at each point, in the body's axes and with gravity's part as an accelerometer feels
it, are weighted: Wd along and across, Wb vertical. Root mean squares of 5 s are the continuous
comfort; with their 95 % percentiles

    N_MV = 6 sqrt(ax^2 + ay^2 + az^2).

Weightings, blocks, percentile and scale are those of EN 12299:2009 from memory, its text was not at
hand; Wd is that of ISO 2631-1:1997, Wb that of BS 6841:1987 with the standard's own quality
factors. Filters, in the frequency s = j 2 pi f, w = 2 pi f:

    band    s^2 w2^2 / ((s^2 + w1 s/Q1 + w1^2) (s^2 + w2 s/Q1 + w2^2))
    turn    (1 + s/w3) w4^2 / (s^2 + w4 s/Q2 + w4^2)
    step    K (s^2/w5^2 + s/(Q3 w5) + 1) / (s^2/w6^2 + s/(Q4 w6) + 1)      Wb only
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Annotated, Any

import numpy as np
import scipy
from numpy.typing import NDArray
from pydantic import Field, model_validator
from railpatch.case.types import NotNegative, Table, relation

from wheelset_demo.scene import GRAVITY
from wheelset_demo.vehicle.elements import Place

Vector = NDArray[np.float64]
BAND, Q_BAND = (0.4, 100.0), 1 / math.sqrt(2)  # Hz, -
TURN = {"Wd": (2.0, 2.0, 0.63), "Wb": (16.0, 16.0, 0.63)}  # Hz, Hz, -
STEP = (2.5, 4.0, 0.8, 0.8, 0.4)  # Hz, Hz, -, -, -
AXES = ("Wd", "Wd", "Wb")
NAMES = ("longitudinal", "lateral", "vertical")
BLOCK = 5.0  # s
WANTED = 60  # blocks: five minutes
SHARE, FACTOR = 95.0, 6.0  # %, -
LONGEST_STEP = 2e-3  # s: filters reach to 100 Hz
# steps that are weighted at once
BUFFER = 1000
# upper ends of N_MV and what they are called
SCALE = (
    (1.5, "very comfortable"),
    (2.5, "comfortable"),
    (3.5, "medium"),
    (4.5, "uncomfortable"),
    (math.inf, "very uncomfortable"),
)


class PointTable(Table):
    """A place on the floor, or any other."""

    name: Annotated[str, Field(pattern="^[A-Za-z][A-Za-z0-9_]*$", max_length=60)] = Field(
        description="(no unit): for results"
    )
    at: Place = Field(
        description="m, at rest: ahead, to the right of the vehicle's middle, above the rails' tops"
    )
    body: str | None = Field(
        default=None, description="(no unit): that has it; left out: the body of reference"
    )


class ComfortTable(Table):
    """Ride comfort as EN 12299 counts it."""

    point: Annotated[list[PointTable], Field(min_length=1, max_length=100)] = Field(
        description="(no unit): where, one [[comfort.point]] each"
    )
    start: NotNegative = Field(
        default=0.0, description="s, of the run, from which accelerations count"
    )

    @model_validator(mode="after")
    def _own_names(self) -> ComfortTable:
        names = [point.name for point in self.point]
        if len(set(names)) < len(names):
            raise relation("point", names, "a name of its own for each")
        return self


def sections_of(kind: str, step: float) -> Vector:
    """[n, 6], second-order sections of a weighting at time steps (s), by the bilinear transform."""
    rate = 1 / step

    def roots(frequency: float, quality: float) -> Vector:
        w = math.tau * frequency
        return np.roots([1.0, w / quality, w * w])

    (low, high), (third, fourth, quality) = BAND, TURN[kind]
    zeros = [0.0, 0.0, -math.tau * third]
    poles = [roots(low, Q_BAND), roots(high, Q_BAND), roots(fourth, quality)]
    gain = (math.tau * high) ** 2 * (math.tau * fourth) ** 2 / (math.tau * third)
    if kind == "Wb":
        fifth, sixth, q_fifth, q_sixth, k = STEP
        zeros += roots(fifth, q_fifth).tolist()
        poles.append(roots(sixth, q_sixth))
        gain *= k * (sixth / fifth) ** 2
    return np.asarray(
        scipy.signal.zpk2sos(*scipy.signal.bilinear_zpk(zeros, np.concatenate(poles), gain, rate))
    )


class Comfort:
    """Of one run's points. names: of the points. blocks: [n, points, 3], m/s^2, continuous comfort
    so far, of each whole block; ends: s, [n]."""

    def __init__(
        self, table: ComfortTable, step: float, bodies: Sequence[Any], places: Any
    ) -> None:
        """step: s. bodies: tables of the free bodies, the first that of reference. places: body ->
        columns [6] of its coordinates."""
        self._start, self._step = table.start, step
        own = {body.name: body for body in bodies}
        named = [point.body or bodies[0].name for point in table.point]
        self.names = [point.name for point in table.point]
        self._columns = np.array([places[name] for name in named])
        # from the bodies' centres, z down
        self._arms = np.array(
            [
                (np.array(point.at) - own[name].position) * (1.0, 1.0, -1.0)
                for point, name in zip(table.point, named, strict=True)
            ]
        )
        self._sections = [sections_of(kind, step) for kind in AXES]
        self._states: list[Vector] | None = None
        self._per_block = max(1, round(BLOCK / step))
        self._kept = np.zeros((BUFFER, 3, *self._columns.shape))
        self._filled = self._counted = 0
        self._sum = np.zeros((len(self.names), 3))
        self.blocks: list[Vector] = []
        self.ends: list[float] = []
        self._begun: float | None = None

    def add(self, time: float, values: Vector, rates: Vector, count: int) -> None:
        """The state after a time step (s), its values and their rates; count: n."""
        if time < self._start + 0.5 * self._step:
            return
        if self._begun is None:
            self._begun = time - self._step
        row = self._kept[self._filled]
        row[0] = values[self._columns]
        row[1] = values[count + self._columns]
        row[2] = rates[count + self._columns]
        self._filled += 1
        if self._filled == BUFFER:
            self.flush()

    def flush(self) -> None:
        """Takes what was added into the blocks."""
        if not self._filled:
            return
        kept = self._kept[: self._filled].transpose(1, 0, 2, 3)
        felt = felt_at(*kept, self._arms)
        self._filled = 0
        if self._states is None:
            # as if the first values had always been there
            self._states = [
                scipy.signal.sosfilt_zi(sections)[:, :, None] * felt[0, :, axis]
                for axis, sections in enumerate(self._sections)
            ]
        weighted = np.empty_like(felt)
        for axis, sections in enumerate(self._sections):
            weighted[:, :, axis], self._states[axis] = scipy.signal.sosfilt(
                sections, felt[:, :, axis], axis=0, zi=self._states[axis]
            )
        squared = weighted**2
        while len(squared):
            room = self._per_block - self._counted
            part = squared[:room]
            self._sum += part.sum(axis=0)
            self._counted += len(part)
            squared = squared[room:]
            if self._counted == self._per_block:
                self.blocks.append(np.sqrt(self._sum / self._per_block))
                assert self._begun is not None
                self.ends.append(self._begun + len(self.blocks) * BLOCK)
                self._sum, self._counted = np.zeros_like(self._sum), 0

    def summary(self) -> dict[str, Any]:
        """Plain numbers: blocks, their number; points: name -> mean_comfort (N_MV, -) and
        longitudinal, lateral, vertical (m/s^2, 95 % of continuous comfort), None before the first
        block."""
        self.flush()
        found: dict[str, Any] = {}
        for index, name in enumerate(self.names):
            if not self.blocks:
                found[name] = dict.fromkeys(("mean_comfort", *NAMES))
                continue
            most = np.percentile(np.array(self.blocks)[:, index], SHARE, axis=0)
            mean = FACTOR * float(np.linalg.norm(most))
            found[name] = {"mean_comfort": mean, **dict(zip(NAMES, most.tolist(), strict=True))}
        return {"blocks": len(self.blocks), "points": found}


def felt_at(places: Vector, velocities: Vector, accelerations: Vector, arms: Vector) -> Vector:
    """m/s^2, [n, points, 3], accelerations less gravity's at points of bodies, in their axes.

    places, velocities, accelerations: [n, points, 6] of x, y, z, yaw, roll, pitch, one after the
    other about axes that move with those before. arms: m, [points, 3], in the bodies.
    """
    c, s = np.cos(places[..., 3:]), np.sin(places[..., 3:])
    zero, one = np.zeros_like(c[..., 0]), np.ones_like(c[..., 0])
    down = np.stack([zero, zero, one], axis=-1)
    ahead = np.stack([c[..., 0], s[..., 0], zero], axis=-1)
    right = np.stack([-s[..., 0] * c[..., 1], c[..., 0] * c[..., 1], s[..., 1]], axis=-1)
    below = np.cross(ahead, right)
    axes = np.stack(
        [
            c[..., 2, None] * ahead - s[..., 2, None] * below,
            right,
            s[..., 2, None] * ahead + c[..., 2, None] * below,
        ],
        axis=-1,
    )
    yaw, roll, pitch = (velocities[..., k, None] for k in (3, 4, 5))
    before = yaw * down + roll * ahead
    spin = before + pitch * right
    turning = (
        accelerations[..., 3, None] * down
        + accelerations[..., 4, None] * ahead
        + accelerations[..., 5, None] * right
        + yaw * roll * np.cross(down, ahead)
        + pitch * np.cross(before, right)
    )
    arm = np.einsum("...ij,...j->...i", axes, np.broadcast_to(arms, (*places.shape[:-1], 3)))
    found = accelerations[..., :3] + np.cross(turning, arm) + np.cross(spin, np.cross(spin, arm))
    found[..., 2] -= GRAVITY
    return np.einsum("...ji,...j->...i", axes, found)


def scale_of(mean_comfort: float) -> str:
    """What N_MV is called."""
    return next(name for most, name in SCALE if mean_comfort < most)


def text_of(summary: dict[str, Any]) -> str:
    """For the terminal."""
    blocks = summary["blocks"]
    if not blocks:
        return f"none: a block takes {BLOCK:g} s"
    parts = [
        f"{name} {found['mean_comfort']:.2f} ({scale_of(found['mean_comfort'])})"
        for name, found in summary["points"].items()
    ]
    few = "" if blocks >= WANTED else f" of the {WANTED} that EN 12299 takes"
    return f"N_MV {', '.join(parts)}; {blocks} blocks of 5 s{few}"
