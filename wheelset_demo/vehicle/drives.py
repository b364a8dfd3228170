"""Driven and braked wheelsets: torques against a body that carries the motors, and slip control.

A torque T acts on a wheelset about its axle a and on the body of its motors the other way, so that
they neither give nor take moment of momentum; its power is T a.(w_body - w_wheelset). T > 0 pulls.
What is wanted is a number or a table over time. A slip control is a sampled PI controller: with the
slip speed s = r |w| - V of the wheel over its nominal radius (V - r |w| while braking) and e the
target less s,

    I = I + integral e period within 0 ... |wanted|,
    |T| = proportional e + I within 0 ... |wanted|,   changed by rate at most,

at every period, and held in between. Speeds are those of wheel and body as they are: sensors
without noise or delay.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
from railpatch import _core

from wheelset_demo.vehicle.model import VehicleModel
from wheelset_demo.vehicle.traction import DriveTable

Vector = NDArray[np.float64]


def drive_of(table: DriveTable, radii: Vector) -> _core.Drive:
    """Torques of one table's wheelsets. radii: m, nominal, of their wheels."""
    times, values = np.array(table.torque, dtype=float).T.copy()
    c = table.slip_control
    control = [] if c is None else [c.target, c.least, c.proportional, c.integral, c.period, c.rate]
    return _core.Drive(radii, times, values, np.array(control, dtype=float))


class Drives:
    """All of a vehicle. torque: N m, [wheelsets], on each now; compiled: the same in C++."""

    def __init__(self, tables: list[DriveTable], model: VehicleModel, radii: Vector) -> None:
        self._spins, self._radii = model.spins, radii
        spins = model.spins.astype(np.int64)
        self.compiled = _core.Drives(model.carriers.astype(np.int64), spins, model.model.nv)
        self._parts = []
        for table in tables:
            index = np.array(table.wheelsets, dtype=np.int64) - 1
            body = model.columns[model.bodies.index(table.reaction)].astype(np.int64)
            self.compiled.append(drive_of(table, radii[index]), index, body)
            self._parts.append((index, body))
        self.torque: Vector = self.compiled.torque

    def __bool__(self) -> bool:
        return bool(self._parts)

    @property
    def driven(self) -> NDArray[np.int64]:
        """Indices of the wheelsets that a drive acts on."""
        return np.unique([k for index, _ in self._parts for k in index])

    def slip_speeds(self, q: Vector, v: Vector) -> Vector:
        """m/s, [wheelsets]: rolling at the nominal radius less the speed of the motors' body;
        NaN without a drive."""
        found = np.full(len(self.torque), np.nan)
        for index, body in self._parts:
            rolling = self._radii[index] * np.abs(v[self._spins[index]])
            found[index] = rolling - abs(speed_of(body, q, v))
        return found

    def update(self, time: float, q: Vector, v: Vector) -> None:
        """Before a step from a time (s): torques until the next one."""
        self.compiled.update(time, q, v)

    def add(self, q: Vector, v: Vector, tau: Vector) -> float:
        """Adds to the generalised force; the torques' power (W)."""
        return self.compiled.add(q, v, tau)


def speed_of(body: NDArray[np.int64], q: Vector, v: Vector) -> float:
    """m/s, of a body ahead. body: columns of its coordinates."""
    yaw = q[body[3]]
    return float(math.cos(yaw) * v[body[0]] + math.sin(yaw) * v[body[1]])
