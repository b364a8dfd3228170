"""A made-up run of a vehicle on two bogies into a right-hand curve; no solver is involved.

Bodies follow the track at a constant speed; wheels carry a quarter axle load, more on the outside.
"""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import synthetic
from railpatch.log import VehicleGeometry, VehicleLog

WHEELSETS = 4
AHEAD = (10.75, 8.25, -8.25, -10.75)  # m, of the wheelsets before the middle
SPEED = 40.0  # m/s
CURVE_AT, RADIUS = 30.0, 900.0  # m: straight, then a circle
LOAD = 60e3  # N, of a wheel standing still


def place(s: float) -> tuple[float, float, float]:
    """x, y and heading of the track at a distance; right is positive y."""
    if s <= CURVE_AT:
        return s, 0.0, 0.0
    angle = (s - CURVE_AT) / RADIUS
    return CURVE_AT + RADIUS * math.sin(angle), RADIUS * (1 - math.cos(angle)), angle


def curvature(s: float) -> float:
    return 1 / RADIUS if s > CURVE_AT else 0.0


def quaternion(heading: float) -> list[float]:
    return [0.0, 0.0, math.sin(heading / 2), math.cos(heading / 2)]


def body(name: str, s: float, z: float, lateral: float = 0.0) -> dict:
    x, y, heading = place(s)
    return {
        "name": name,
        "position": [x - lateral * math.sin(heading), y + lateral * math.cos(heading), z],
        "orientation": quaternion(heading),
        "velocity": [SPEED * math.cos(heading), SPEED * math.sin(heading), 0.0],
        "acceleration": [0.0, SPEED**2 * curvature(s), -9.81],
        "lateral": lateral,
        "roll": 0.01 * lateral,
        "yaw": 0.0,
    }


def lateral(s: float, number: int) -> float:
    """m, of wheelset N from the centre line."""
    return 1e-3 * math.sin(0.4 * s) * number


def wheel(side: str, s: float, fields: bool = False, time_s: float = 0.0) -> dict:
    sign = 1.0 if side == "right" else -1.0
    vertical = LOAD - sign * 8e3 * (curvature(s) > 0)
    values = synthetic.side(side, 0, fields)
    patch = values["patches"][0] | {
        "normal_force": vertical,
        "creep_force": [sign * 500.0, 0.1 * vertical],
        "friction_power": 20.0 if side == "left" else 10.0,
    }
    return values | {
        "force": [sign * 500.0, 0.1 * vertical, -vertical],
        "patches": [patch],
        "friction_work": patch["friction_power"] * time_s,
    }


def step(index: int, spacing: float = 0.01) -> dict:
    """Arguments of VehicleLog.write; every tenth with a snapshot of the first wheelset."""
    middle = SPEED * spacing * index
    wheelsets, tracks = [], []
    for number, ahead in enumerate(AHEAD, start=1):
        s = middle + ahead
        x, y, heading = place(s)
        tracks.append(([x, y, 0.0], quaternion(heading)))
        state = {
            "x": s,
            "y": lateral(s, number),
            "z": 1e-4,
            "roll": 0.0,
            "yaw": 1e-3,
            "pitch": math.remainder(-s / 0.3556, math.tau),
            "curvature": curvature(s),
            "left_rail": [1e-3, 0.0],
            "right_rail": [-1e-3, 0.0],
        }
        snapshot = index % 10 == 0 and number == 1
        sides = {side: wheel(side, s, snapshot, spacing * index) for side in ("left", "right")}
        entry = {"state": state} | sides
        if snapshot:
            entry["fields"] = {side: sides[side]["patches"] for side in sides}
        wheelsets.append(entry)
    bodies = [
        body("car_body", middle, -1.8),
        body("bogie_1", middle + 9.5, -0.6),
        body("bogie_2", middle - 9.5, -0.6),
    ]
    bodies += [
        body(f"wheelset_{number}", middle + ahead, -0.3556, lateral(middle + ahead, number))
        for number, ahead in enumerate(AHEAD, start=1)
    ]
    return {
        "state": {"x": middle, "speed": SPEED, "curvature": curvature(middle), "cant": 0.0},
        "wheelsets": wheelsets,
        "bodies": bodies,
        "tracks": tracks,
        "energy": {"kinetic": 3.2e7, "friction_work": 1.2 * index},
        "stats": {"wall_time": 0.02, "contact_evaluations": 16},
    }


def geometry() -> VehicleGeometry:
    line = np.array([[*place(s)[:2], 0.0] for s in np.linspace(-12, 100, 80)])
    frame = [([0, sign, 0], [3.2, 0.25, 0.25]) for sign in (-1.0, 1.0)]
    boxes = {"car_body": [([0, 0, 0], [24.0, 2.8, 2.6])], "bogie_1": frame, "bogie_2": frame}
    return VehicleGeometry(synthetic.geometry("rail"), boxes, line)


def open_log(path: Path, **more: object) -> VehicleLog:
    arguments = {
        "wheelsets": WHEELSETS,
        "case_text": "# vehicle\n",
        "case_name": "vehicle.toml",
        "profiles": synthetic.PROFILES,
        "geometry": geometry(),
    } | more
    return VehicleLog(path, **arguments)


def write_run(path: Path, steps: int = 101, **more: object) -> Path:
    """The whole run, 100 steps a second."""
    with open_log(path, **more) as log:
        for index in range(steps):
            log.write(0.01 * index, **step(index))
    return path
