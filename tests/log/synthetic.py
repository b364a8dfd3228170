"""A made-up run of the roller rig, realistic in shape and size; no solver is involved.

37 positions follow yaw 0, +18, 0, -18, 0 mrad. The lateral positions at multiples of the yaw steps
that CONTACT's model of the NRC rig lists (run dry, 10 mph, 13,750 lb) are the values of that list.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from railpatch.log import RunLog, SceneGeometry

CASE = '# roller rig\nkind = "wheelset"\n'
PROFILES = {"wheel.whl": b"\x00\r\nwheel\n", "roller.ban": b"roller\xff\n"}
LOAD = 133.95e3
POSITIONS = 37

# m; by index of the position
_LATERAL = {
    0: 0.3,
    1: 0.6472964,
    3: 1.3,
    5: 1.832089,
    7: 2.179385,
    9: 2.3,
    11: 2.179385,
    13: 1.832089,
    15: 1.3,
    17: 0.6472964,
    18: 0.3,
    19: -0.04729636,
    21: -6.3,
    23: -6.459627,
    25: -6.563816,
    27: -6.6,
    29: -6.563816,
    31: -6.459627,
    33: -6.24,
    35: -2.084189,
    36: 0.3,
}


def yaw_at(index: int) -> float:
    """rad; up to +18 mrad, back, down to -18 mrad, back, in steps of 2 mrad."""
    return 1e-3 * round(float(np.interp(index, [0, 9, 27, 36], [0, 18, -18, 0])), 9)


def lateral_at(index: int) -> float:
    """m."""
    return 1e-3 * float(np.interp(index, list(_LATERAL), list(_LATERAL.values())))


def state(index: int) -> dict:
    return {
        "progress": index / (POSITIONS - 1),
        "y": lateral_at(index),
        "z": 2.566e-4 + 2.4e-7 * (1e3 * yaw_at(index)) ** 2,
        "roll": 1.2e-4 - 0.01 * yaw_at(index),
        "yaw": yaw_at(index),
        "speed": 0.0,
        "pitch_rate": -12.5622,
        "roller_pitch_rate": 5.587302,
        "vertical_force": LOAD,
    }


def side(name: str, index: int, fields: bool = False) -> dict:
    """What ``to_dict()[name]`` of a wheelset result holds."""
    sign = 1.0 if name == "right" else -1.0
    yaw = yaw_at(index)
    # the wheel that the lateral force pushes against takes more of the load
    vertical = LOAD / 2 - sign * 20e3 * np.tanh(yaw / 0.006)
    lateral = vertical * 0.5 * np.tanh(yaw / 0.004) - sign * 1.2e3
    longitudinal = -sign * 9e3 * max(0.0, -yaw / 0.018)
    shares = [0.7, 0.3] if name == "left" and yaw < -0.005 else [1.0]
    patches = [
        _patch(sign, share, number, (longitudinal, lateral, vertical), fields)
        for number, share in enumerate(shares)
    ]
    force = [float(longitudinal), float(lateral), float(-vertical)]
    return {
        "status": "converged",
        "force": force,
        "moment": [sign * 50e3, 3.0, 2.0],
        "z": None,
        "rolling_radius": 0.3557,
        "wall_time": 0.02,
        "patches": patches,
    }


def _patch(sign: float, share: float, number: int, force: tuple, fields: bool) -> dict:
    longitudinal, lateral, vertical = force
    patch = {
        "status": "converged",
        "position": [0.0, sign * (0.75 - 0.03 * number), 1e-4],
        "contact_angle": -sign * (0.033 + 0.3 * number),
        "creepage": [1e-4 * sign, -1e-3],
        "spin_creepage": 0.1 * sign,
        "rolling_speed": 4.47,
        "normal_force": share * vertical,
        "approach": 8e-5,
        "creep_force": [share * longitudinal, share * lateral],
        "spin_moment": 2.0,
        "max_pressure": 1.1e9,
        "contact_area": 9e-5 * share,
        "elements": {"exterior": 120, "stick": 200, "slip": 250, "plastic": 0},
        "max_temperature": None,
        "friction_power": 30.0,
        "elastic_energy": 2.5,
        "iterations": 4,
        "residual": 3e-6,
        "wall_time": 0.01,
        "error_estimate": {"creep_force": 120.0, "spin_moment": 0.4, "max_pressure": None},
        "stages": ["normal"],
    }
    return patch | (_fields(lateral / vertical) if fields else {})


def _fields(ratio: float, rows: int = 20, columns: int = 24) -> dict:
    x = np.linspace(-7e-3, 7e-3, columns)
    y = np.linspace(-5e-3, 5e-3, rows)
    hertz = 1 - (x / 6e-3) ** 2 - (y[:, None] / 4e-3) ** 2
    pressure = 1.1e9 * np.sqrt(np.clip(hertz, 0, None))
    build_up = np.clip((6e-3 - x) / 8e-3, 0, 1) * np.ones_like(pressure)
    traction = np.stack([0.1 * pressure, 0.9 * np.sign(ratio) * pressure])
    division = np.where(pressure > 0, np.where(build_up < 0.5, 1, 2), 0)
    return {
        "x": x.tolist(),
        "y": y.tolist(),
        "pressure": pressure.tolist(),
        "traction": (0.5 * build_up * traction).tolist(),
        "element_division": division.tolist(),
    }


def balance(index: int, status: str = "converged") -> dict:
    state_now = state(index)
    return {
        "status": status,
        "evaluations": 5 + index % 4,
        "iterations": 3 + index % 4,
        "residuals": [0.02, -0.4, 0.1],
        "z": state_now["z"],
        "roll": state_now["roll"],
        "pitch_rate": state_now["pitch_rate"],
    }


def stats(index: int) -> dict:
    return {
        "wall_time": 0.2 + 0.01 * (index % 5),
        "left_wall_time": 0.11,
        "right_wall_time": 0.09,
        "contact_evaluations": 12 + index % 4,
        "left_normal_iterations": 40,
        "left_tangential_iterations": 60,
        "right_normal_iterations": 38,
        "right_tangential_iterations": 55,
    }


def geometry(kind: str = "roller") -> SceneGeometry:
    y = np.linspace(-0.04, 0.04, 60)
    tread = np.column_stack([y + 0.07, -y / 20])
    rail = np.column_stack([y[20:40], 8 * y[20:40] ** 2])
    return SceneGeometry.from_profiles(
        kind,
        {"left": tread, "right": tread},
        {"left": rail, "right": rail},
        nominal_radius=0.3556,
        flange_back_distance=1.347,
        gauge=1.435,
        gauge_height=0.014,
        roller_radius=0.8001 if kind == "roller" else None,
    )


def open_log(path: Path, **more: object) -> RunLog:
    arguments = {
        "case_text": CASE,
        "case_name": "rig.toml",
        "profiles": PROFILES,
        "geometry": geometry(),
    } | more
    return RunLog(path, **arguments)


def write_position(log: RunLog, index: int, status: str = "converged") -> None:
    """One position; every ninth with a snapshot of the fields."""
    snapshot = index % 9 == 0
    left, right = (side(name, index, snapshot) for name in ("left", "right"))
    fields = {"left": left["patches"], "right": right["patches"]} if snapshot else None
    log.write(
        float(index),
        state=state(index),
        left=left,
        right=right,
        balance=balance(index, status),
        stats=stats(index),
        fields=fields,
    )


def write_rig_run(path: Path, bad: int | None = None) -> Path:
    """The whole run; the position ``bad`` did not converge."""
    with open_log(path) as log:
        for index in range(POSITIONS):
            write_position(log, index, "not_converged" if index == bad else "converged")
    return path


def write_wheelset_run(path: Path, steps: int = 30, **more: object) -> Path:
    """A run on track: no balance, no statistics, no progress."""
    with open_log(path, geometry=geometry("rail"), case_name="hunting.toml", **more) as log:
        for index in range(steps):
            position = {
                "y": 0.002 * np.sin(0.5 * index),
                "z": 2e-4,
                "roll": 0.0,
                "yaw": 0.001 * np.cos(0.5 * index),
                "speed": 20.0,
                "pitch_rate": -43.0,
            }
            log.write(0.01 * index, state=position, left=side("left", 0), right=side("right", 0))
    return path
