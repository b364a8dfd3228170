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

from wheelset_demo.vehicle.model import VehicleModel
from wheelset_demo.vehicle.traction import DriveTable

Vector = NDArray[np.float64]


class Drive:
    """Of one table: torques of its wheelsets. torque: N m, [wheelsets], now. radii: m, nominal."""

    def __init__(self, table: DriveTable, radii: Vector) -> None:
        """radii: m, of its wheels."""
        self._table, self.radii = table, radii
        times, values = np.array(table.torque, dtype=float).T
        self._times, self._values = times, values
        self._braking = bool(values.min() < 0)
        # a run begins with what is wanted then
        self.torque = np.full(len(radii), self.wanted(0.0))
        self._integral = np.abs(self.torque)
        self._samples = 0

    def wanted(self, time: float) -> float:
        """N m, at a time (s)."""
        return float(np.interp(time, self._times, self._values))

    def update(self, time: float, speed: float, spins: Vector) -> None:
        """Before a step. speed: m/s, of the body; spins: rad/s, of the wheelsets."""
        control, wanted = self._table.slip_control, self.wanted(time)
        if control is None:
            self.torque[:] = wanted
            return
        if time < self._samples * control.period - 1e-9:
            return
        self._samples = math.floor(time / control.period + 1e-6) + 1
        slip = self.radii * np.abs(spins) - abs(speed)
        if self._braking:
            slip = -slip
        error = max(control.target * abs(speed), control.least) - slip
        most = abs(wanted)
        gained = self._integral + control.integral * control.period * error
        self._integral = np.clip(gained, 0.0, most)
        asked = np.clip(control.proportional * error + self._integral, 0.0, most)
        before, change = np.abs(self.torque), control.rate * control.period
        found = np.clip(asked, before - change, before + change)
        self.torque[:] = math.copysign(1.0, wanted) * found


class Drives:
    """All of a vehicle. torque: N m, [wheelsets], on each now."""

    def __init__(self, tables: list[DriveTable], model: VehicleModel, radii: Vector) -> None:
        self._model = model
        self._parts = [
            (
                Drive(table, radii[np.array(table.wheelsets) - 1]),
                np.array(table.wheelsets) - 1,
                model.columns[model.bodies.index(table.reaction)],
            )
            for table in tables
        ]
        self.torque = np.zeros(len(radii))
        self._collect()

    def __bool__(self) -> bool:
        return bool(self._parts)

    @property
    def driven(self) -> NDArray[np.int64]:
        """Indices of the wheelsets that a drive acts on."""
        return np.unique([k for _, index, _ in self._parts for k in index])

    def slip_speeds(self, q: Vector, v: Vector) -> Vector:
        """m/s, [wheelsets]: rolling at the nominal radius less the speed of the motors' body;
        NaN without a drive."""
        found = np.full(len(self.torque), np.nan)
        for drive, index, body in self._parts:
            rolling = drive.radii * np.abs(v[self._model.spins[index]])
            found[index] = rolling - abs(speed_of(body, q, v))
        return found

    def _collect(self) -> None:
        self.torque[:] = 0.0
        for drive, index, _ in self._parts:
            self.torque[index] += drive.torque

    def update(self, time: float, q: Vector, v: Vector) -> None:
        """Before a step from a time (s): torques until the next one."""
        for drive, index, body in self._parts:
            drive.update(time, speed_of(body, q, v), v[self._model.spins[index]])
        self._collect()

    def add(self, q: Vector, v: Vector, tau: Vector) -> float:
        """Adds to the generalised force; the torques' power (W)."""
        power = 0.0
        for drive, index, body in self._parts:
            for torque, k in zip(drive.torque.tolist(), index.tolist(), strict=True):
                carrier = self._model.carriers[k]
                axle = lateral_axis(q[carrier[3]], q[carrier[4]])
                # forward is a negative turn about y
                columns, parts = turning_parts(axle, q, carrier, body, int(self._model.spins[k]))
                tau[columns] -= torque * parts
                power -= torque * float(parts @ v[columns])
        return power


def speed_of(body: NDArray[np.int64], q: Vector, v: Vector) -> float:
    """m/s, of a body ahead. body: columns of its coordinates."""
    yaw = q[body[3]]
    return float(math.cos(yaw) * v[body[0]] + math.sin(yaw) * v[body[1]])


def lateral_axis(yaw: float, roll: float) -> Vector:
    """[3], of a body's y in the world."""
    c, s = math.cos(yaw), math.sin(yaw)
    return np.array([-s * math.cos(roll), c * math.cos(roll), math.sin(roll)])


def turning_parts(
    axle: Vector, q: Vector, carrier: NDArray[np.int64], body: NDArray[np.int64], spin: int
) -> tuple[NDArray[np.int64], Vector]:
    """Columns and parts of axle.(w_wheelset - w_body) in the velocities."""

    def about(columns: NDArray[np.int64]) -> list[float]:
        yaw = q[columns[3]]
        ahead = np.array([math.cos(yaw), math.sin(yaw), 0.0])
        return [float(axle[2]), float(axle @ ahead)]

    body_yaw, body_roll = about(body)
    pitch = float(axle @ lateral_axis(q[body[3]], q[body[4]]))
    parts = [*about(carrier), 1.0, -body_yaw, -body_roll, -pitch]
    return np.array([*carrier[3:5], spin, *body[3:6]]), np.array(parts)
