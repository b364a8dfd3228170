"""The messages of the run log: from a scene and its steps."""

from __future__ import annotations

import math
import time
from collections.abc import Iterable
from dataclasses import fields, replace
from pathlib import Path
from typing import Any

from railpatch.case.types import SIDES
from railpatch.log.effective import Effective, effective
from railpatch.result import logged, wheel_json

from wheelset_demo.scene import WheelsetScene
from wheelset_demo.system import WORKS, State, System
from wheelset_demo.trace import STORES, Trace

COORDINATES = ("x", "y", "z", "roll", "yaw", "pitch")
RATES = ("speed", "vy", "vz", "roll_rate", "yaw_rate", "pitch_rate")


class Recorder:
    """Makes the messages of one logged step after the other."""

    def __init__(self, scene: WheelsetScene, system: System) -> None:
        self._scene, self._system = scene, system
        self._clock = time.perf_counter()
        self._evaluations = 0

    def messages(self, trace: Trace, state: State) -> dict[str, Any]:
        """Arguments of RunLog.write for the trace's last step."""
        assert trace.result is not None
        data = trace.result.data
        result = {key: wheel_json(data[key]) for key in SIDES}
        result |= {key: data[key] for key in ("force", "moment")} | logged(data)
        snapshot = any("pressure" in patch for patch in data["left"]["patches"])
        fields = {side: data[side]["patches"] for side in SIDES} if snapshot else None
        return {
            "state": self._state(state, result),
            "left": result["left"],
            "right": result["right"],
            "energy": energy(trace),
            "momentum": momentum(trace),
            "stats": self._stats(),
            "fields": fields,
        }

    def failed(self) -> dict[str, Any]:
        """The same for the last contact that was asked for, which was not solved."""
        result = self._system.element.result().to_dict()
        values = self._system.element.state()
        state = {name: values[name] for name in COORDINATES + RATES}
        return {
            "state": state | {"force": result["force"], "moment": result["moment"]},
            "left": result["left"],
            "right": result["right"],
            "stats": self._stats(),
        }

    def _state(self, state: State, result: dict[str, Any]) -> dict[str, Any]:
        values = dict(zip(COORDINATES + RATES, state.motion.tolist(), strict=True))
        values["pitch"] = math.remainder(values["pitch"], math.tau)
        return values | {
            "vertical_force": self._scene.case.wheelset.vertical_force,
            "force": result["force"],
            "moment": result["moment"],
            **logged(result),
        }

    def _stats(self) -> dict[str, Any]:
        """Work since the step that was logged before."""
        now, evaluations = time.perf_counter(), self._system.evaluations
        stats = {
            "wall_time": now - self._clock,
            "contact_evaluations": len(SIDES) * (evaluations - self._evaluations),
        }
        self._clock, self._evaluations = now, evaluations
        return stats


def energy(trace: Trace) -> dict[str, float]:
    """The balance of energies at the trace's last step."""
    stored = dict(zip(STORES, trace.energies[-1], strict=True))
    first = dict(zip(STORES, trace.energies[0], strict=True))
    work = dict(zip(WORKS, trace.works[-1].tolist(), strict=True))
    change = {name: stored[name] - first[name] for name in STORES}
    mechanical = change["kinetic"] + change["gravity"] + change["suspension"]
    return {
        **stored,
        **{f"{name}_work": value for name, value in work.items()},
        "mechanical_residual": mechanical - work["contact"] - work["drive"] + work["damping"],
        "contact_residual": work["contact"] + work["friction"] + change["elastic"],
    }


def momentum(trace: Trace) -> dict[str, list[float]]:
    """The balance of momenta at the trace's last step."""
    now, impulse = trace.momenta[-1], trace.impulses[-1]
    parts = {"": now, "impulse": impulse, "residual": now - trace.momenta[0] - impulse}
    values = {}
    for name, value in parts.items():
        linear, turning = value[:3].tolist(), value[3:].tolist()
        values[name or "momentum"] = linear
        values[f"turning_{name}" if name else "turning"] = turning
    return values


def ran_with(scene: Any, doubts: Iterable[str] = ()) -> Effective:
    """The tables of a scene of this package as they run. doubts: warnings of what it says."""
    known = ("name", "text", "case", "profiles", "measured")
    own = [f.name for f in fields(scene) if f.name not in known]
    # a list without tables is one that the file does not have
    tables = {name: getattr(scene, name) or None for name in own}
    step = scene.run.step
    names = {name: Path(name).name for name in scene.profiles.values()}
    made = effective(
        scene.text, scene.case, tables, step=step, duration=scene.steps * step, names=names
    )
    told = " | ".join(filter(None, [made.about["doubts"], *doubts]))
    return replace(made, about=made.about | {"doubts": told})


def attachments(scene: WheelsetScene) -> dict[str, bytes]:
    """The profile files' content by their name."""
    files = [Path(name) for name in scene.profiles.values()]
    return {file.name: file.read_bytes() for file in files if file.is_file()}
