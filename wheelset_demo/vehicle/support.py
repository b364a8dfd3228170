"""Track below the rails, under each wheelset and moving along with it: rails, pads, sleeper,
ballast.

Each rail has a mass that takes part and moves lateral and vertical, on a pad. The pads stand on the
sleeper under both rails, which moves lateral and vertical and rolls, on ballast below each rail
seat; without a sleeper they stand on the ground. Coordinates w of each wheelset, in its track axes,
from where the track lies without the wheelset:

    left rail y, z, right rail y, z (m), sleeper y, z (m), roll (rad)

    M w'' + B^T (k B w + c B w') = forces of the wheels on the rails

B [rows, coordinates] the springs' lengths: of each pad lateral, vertical, of the ballast below each
rail seat likewise. What moves along has mass but no length: waves along the rails, what one
wheelset's track does to the next, sleepers at their distance and the rails' rolling are left out.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, model_validator
from railpatch import _core
from railpatch.case.types import NotNegative, Positive, Table, exactly, relation

if TYPE_CHECKING:
    # what reads a scene does without Pinocchio
    from railpatch.pinocchio import ForceElement, StateChain

Vector = NDArray[np.float64]
# columns of a wheelset's state that a rail's places and rates move against: y, z, vy, vz
PLACES, RATES = [1, 2], [7, 8]
RAILS, WITH_SLEEPER = 4, 7
WAYS = ("lateral", "vertical")
PositivePair = Annotated[list[Positive], exactly(2)]
Pair = Annotated[list[NotNegative], exactly(2)]
ON_SLEEPER = ("sleeper_inertia", "ballast_stiffness", "ballast_damping", "seat_distance")


class SupportTable(Table):
    """Track below the rails, under each wheelset; pairs are lateral, vertical."""

    rail_mass: Positive = Field(description="kg, of each rail that takes part")
    pad_stiffness: PositivePair = Field(description="N/m, of each rail: lateral, vertical")
    pad_damping: Pair = Field(default=[0.0, 0.0], description="N s/m, of each rail")
    sleeper_mass: Positive | None = Field(
        default=None, description="kg, under both rails; left out: pads stand on the ground"
    )
    sleeper_inertia: Positive | None = Field(
        default=None, description="kg m^2, of the sleeper about x; with sleeper_mass"
    )
    ballast_stiffness: PositivePair | None = Field(
        default=None, description="N/m, below each rail seat; with sleeper_mass"
    )
    ballast_damping: Pair = Field(default=[0.0, 0.0], description="N s/m, below each rail seat")
    seat_distance: Positive = Field(default=1.5, description="m, between the rail seats")

    @model_validator(mode="after")
    def _whole(self) -> SupportTable:
        if self.sleeper_mass is None:
            for name in ON_SLEEPER:
                if name in self.model_fields_set:
                    raise relation(name, getattr(self, name), "to be left out without sleeper_mass")
        else:
            for name in ("sleeper_inertia", "ballast_stiffness"):
                if getattr(self, name) is None:
                    raise relation(name, "missing", "a value with sleeper_mass")
        return self

    @property
    def static_stiffness(self) -> tuple[float, float]:
        """N/m, of each rail under wheels that press both alike: outward, where the sleeper stays,
        and down."""
        lateral, vertical = self.pad_stiffness
        if self.ballast_stiffness is not None:
            vertical = 1.0 / (1.0 / vertical + 1.0 / self.ballast_stiffness[1])
        return lateral, vertical


class Support:
    """The track below some wheelsets. count: of its coordinates, ``width`` a wheelset.

    Of the last step(): place, rate: m, m/s (rad, rad/s), [wheelsets, width]. forces: N, [wheelsets,
    rows], of the springs and dampers on what is below them: pads left lateral, vertical, right
    likewise, ballast likewise. greatest: by meet(), see summary(). compiled: the same in C++, whose
    memory these are.
    """

    def __init__(self, table: SupportTable, wheelsets: int) -> None:
        self.width = RAILS if table.sleeper_mass is None else WITH_SLEEPER
        self.count = wheelsets * self.width
        rows = spring_rows(table)
        pads, ballast = table.pad_stiffness, table.ballast_stiffness
        self._rows = rows
        self._stiffness = np.ravel([*pads, *pads, *(() if ballast is None else 2 * [*ballast])])
        beside = [] if ballast is None else 2 * [*table.ballast_damping]
        self._damping = np.ravel([*table.pad_damping, *table.pad_damping, *beside])
        masses = RAILS * [table.rail_mass]
        if table.sleeper_mass is not None:
            assert table.sleeper_inertia is not None
            masses += [table.sleeper_mass, table.sleeper_mass, table.sleeper_inertia]
        self._masses = np.array(masses)
        self._k = rows.T @ (self._stiffness[:, None] * rows)
        self._c = rows.T @ (self._damping[:, None] * rows)
        core = _core.Support(wheelsets, rows, self._stiffness, self._damping, self._masses)
        self.compiled = core
        self.place: Vector = core.place
        self.rate: Vector = core.rate
        self.forces: Vector = core.forces
        self.greatest: Vector = core.greatest
        self._found = np.zeros(self.count)

    def put_rails(self, place: Vector, rate: Vector, rails: Vector) -> None:
        """Adds deflections and their rates to a force element's rails, which are placed. place,
        rate: [count]."""
        self.compiled.put_rails(place, rate, rails)

    def step(self, wheels: Vector) -> tuple[Vector, float]:
        """[count], second derivatives of the coordinates; W, power of the wheels on the rails.

        wheels: as ForceElement.wheels.
        """
        power = self.compiled.step(wheels, self._found)
        return self._found.copy(), power

    @property
    def damping_power(self) -> float:
        """W, >= 0, at the last step()."""
        return self.compiled.damping_power

    def meet(self) -> None:
        """Takes the last step() into what was greatest: m, N, by size, [3, 2], of rails' places, of
        forces in pads and in ballast, lateral and vertical."""
        self.compiled.meet()

    def summary(self) -> dict[str, dict[str, float] | None]:
        """Greatest so far by direction: rail_deflection (m), pad_force, ballast_force (N, None
        without a sleeper)."""
        place, pad, ballast = (dict(zip(WAYS, row, strict=True)) for row in self.greatest.tolist())
        below = ballast if self.width > RAILS else None
        return {"rail_deflection": place, "pad_force": pad, "ballast_force": below}

    def logged(self, index: int) -> dict[str, list[float]]:
        """Of a wheelset's channel in the log, at the last step."""
        forces, found = self.forces[index].tolist(), {}
        for first, name in enumerate(("pad_force", "ballast_force")):
            part = forces[first * RAILS : (first + 1) * RAILS]
            if part:
                found |= {f"left_{name}": part[:2], f"right_{name}": part[2:]}
        if self.width > RAILS:
            found["sleeper"] = self.place[index, RAILS:].tolist()
        return found

    def energies(self) -> tuple[float, float]:
        """J, kinetic and of the springs, at the last step."""
        kinetic = 0.5 * float((self._masses * self.rate**2).sum())
        lengths = self.place @ self._rows.T
        return kinetic, 0.5 * float((self._stiffness * lengths**2).sum())

    def at_rest(self, deflections: Vector) -> Vector:
        """[count], coordinates under wheels that press both rails alike. deflections: m,
        [wheelsets, 2, 2], of left and right rail, lateral and vertical."""
        found = np.zeros(self.place.shape)
        found[:, :RAILS] = deflections.reshape(-1, RAILS)
        if self.width > RAILS:
            pad, ballast = self._stiffness[1], self._stiffness[5]
            found[:, 5] = pad / (pad + ballast) * found[:, [1, 3]].mean(axis=1)
        return found.ravel()

    def fill(
        self,
        matrix: Vector,
        inputs: Vector,
        inverse: Vector,
        element: ForceElement,
        by_side: Vector,
        chain: StateChain,
    ) -> None:
        """Puts the track's rows and columns into derivatives of rates.

        matrix: [size, size], inputs: [size, 6 wheelsets], as VehicleSystem.derivatives() gives
        them; inverse: [nv, nv], of the bodies' mass matrix. by_side: [wheelsets, 2, 6, 12], of the
        contacts' wrenches.
        """
        nv, wheelsets = len(inverse), len(self.place)
        n = nv + self.count
        bodies, own = slice(n, n + nv), slice(n + nv, 2 * n)
        k, c = (
            np.kron(np.eye(wheelsets), part / self._masses[:, None]) for part in (self._k, self._c)
        )
        matrix[own, nv:n] = -k
        matrix[own, own] = -c
        for index in range(wheelsets):
            state = chain.of(element, index)
            jacobian = chain.jacobian(element.joints[index])
            for side in range(2):
                by, first = by_side[index, side], index * self.width + 2 * side
                places = slice(nv + first, nv + first + 2)
                rates = slice(n + places.start, n + places.stop)
                # a rail that moves is a wheel that moves the other way
                moved = np.stack([state.turned(by[:, at]) for at in PLACES + RATES], axis=1)
                force = -inverse @ (jacobian.T @ moved)
                matrix[bodies, places], matrix[bodies, rates] = force[:, :2], force[:, 2:]
                # and what the wheel feels, the rail feels the other way
                felt = by[1:3] / self._masses[0]
                matrix[rates, :nv] = -felt @ state.by_q
                matrix[rates, bodies] = -felt @ state.by_v
                matrix[rates, places] += felt[:, PLACES]
                matrix[rates, rates] += felt[:, RATES]
                wheel = 2 * index + side
                inputs[rates, 2 * wheel : 2 * wheel + 2] = felt[:, PLACES]
                inputs[rates, 4 * wheelsets + wheel] = felt[:, RATES[1]]


def spring_rows(table: SupportTable) -> Vector:
    """[rows, width], of the springs' lengths by the coordinates of one wheelset."""
    rows = np.eye(RAILS)
    if table.sleeper_mass is None:
        return rows
    arm = 0.5 * table.seat_distance
    # of the rail seats, left and right, lateral and vertical, by the sleeper's y, z, roll
    seats = np.array([[1, 0, 0], [0, 1, -arm], [1, 0, 0], [0, 1, arm]], dtype=float)
    return np.block([[rows, -seats], [np.zeros((RAILS, RAILS)), seats]])
