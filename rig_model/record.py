"""The messages of the run log: from a scene and its balances."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

from railpatch.case.types import SIDES
from railpatch.log.effective import Effective, effective
from railpatch.result import logged

from rig_model.balance import Balance
from rig_model.scene import RigScene

# moving inputs that a scene may set and the rig does not change
STEADY = ("speed", "vy", "vz", "roll_rate", "yaw_rate")


class Recorder:
    """Makes the messages of one position after the other; keeps the angles turned so far."""

    def __init__(self, scene: RigScene) -> None:
        self._scene = scene
        self._time = 0.0
        self._pitch = 0.0
        self._roller_pitch = 0.0

    def messages(
        self, balance: Balance, wall_time: float, *, snapshot: bool = False
    ) -> dict[str, Any]:
        """Arguments of RunLog.write. wall_time: s, of finding the balance. snapshot: with the
        strips of friction that conditions."""
        result = balance.result.to_dict()
        measured = self._scene.measured_at(balance.position)
        frame = {"frame": vars(balance.frame)} if balance.frame else {}
        return (
            ({"measured": measured} if measured else {})
            | frame
            | conditioning_of(balance, snapshot)
            | {
                "state": self._state(balance, result),
                "left": result["left"],
                "right": result["right"],
                "balance": {
                    "status": balance.status,
                    "evaluations": balance.evaluations,
                    "iterations": balance.iterations,
                    "residuals": None
                    if balance.residuals is None
                    else balance.residuals[:3].tolist(),
                    "z": balance.z,
                    "roll": balance.roll,
                    "pitch_rate": balance.pitch_rate,
                },
                "stats": {
                    "wall_time": wall_time,
                    "contact_evaluations": len(SIDES) * balance.evaluations,
                },
            }
        )

    def _state(self, balance: Balance, result: dict[str, Any]) -> dict[str, Any]:
        position, case = balance.position, self._scene.case
        roller_rate = self._scene.speed_at(position)
        step = position.time - self._time
        self._time = position.time
        self._pitch = math.remainder(self._pitch + step * balance.pitch_rate, math.tau)
        self._roller_pitch = math.remainder(self._roller_pitch + step * roller_rate, math.tau)
        return {
            "progress": position.progress,
            "y": balance.y,
            "z": balance.z,
            "roll": balance.roll,
            "yaw": position.yaw,
            "pitch": self._pitch,
            "pitch_rate": balance.pitch_rate,
            "roller_pitch": self._roller_pitch,
            "roller_pitch_rate": roller_rate,
            "vertical_force": self._scene.load_at(position),
            "force": result["force"],
            "moment": result["moment"],
            **logged(result),
        } | {key: getattr(case.wheelset, key) for key in STEADY}


def conditioning_of(balance: Balance, snapshot: bool) -> dict[str, Any]:
    """Of friction that conditions, by side."""
    if balance.conditioning is None:
        return {}
    dropped = () if snapshot else ("position", "conditioned")
    return {
        "conditioning": {
            side: {key: value for key, value in vars(state).items() if key not in dropped}
            for side, state in balance.conditioning.items()
        }
    }


def ran_with(scene: RigScene) -> Effective:
    """The tables of a scene as they run."""
    rig = scene.rig
    names = {str(file): name for name, file in scene.files.items()}
    step = scene.duration / (scene.count - 1) if scene.count > 1 else 0.0
    tables = {"rig": rig}
    made = effective(
        scene.text, scene.case, tables, step=step, duration=scene.duration, names=names
    )
    doubts = [made.about["doubts"], *scene.doubts]
    return replace(made, about=made.about | {"doubts": " | ".join(filter(None, doubts))})


def attachments(scene: RigScene) -> dict[str, bytes]:
    """The profile files' content by their name in the case file, and the record as measured."""
    found = {name: file.read_bytes() for name, file in scene.files.items()}
    if scene.measured is not None:
        file = scene.measured.record.path
        name = file.name if file.name not in {*found, scene.name} else f"record_{file.name}"
        found[name] = file.read_bytes()
    return found
