"""Scenes of small vehicles, written from a few numbers: for tests of topologies."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from wheelset_demo.scene import scene_file
from wheelset_demo.vehicle import VehicleScene, load_vehicle_scene

RADIUS = 0.46
BODY = {"mass": 2600.0, "inertia": [1700.0, 1500.0, 3000.0]}
WHEELSET = {"mass": 1500.0, "inertia": [800.0, 110.0, 800.0]}


def toml(value: Any) -> str:
    """A value in one line."""
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{key} = {toml(item)}" for key, item in value.items()) + " }"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(toml(item) for item in value) + "]"
    return repr(value) if isinstance(value, float | int) else f'"{value}"'


def tables(name: str, rows: list[dict[str, Any]]) -> str:
    """[[vehicle.NAME]] of each."""
    return "\n".join(
        f"[[vehicle.{name}]]\n" + "\n".join(f"{key} = {toml(v)}" for key, v in row.items())
        for row in rows
    )


def place(a: str, b: str, *at: float) -> dict[str, Any]:
    """Of an element."""
    return {"between": [a, b], "at": list(at)}


def springs(**more: Any) -> dict[str, Any]:
    """Primary springs in all directions."""
    return {
        "name": "springs",
        "stiffness": [1e7, 5e6, 1e6],
        "damping": [1e4, 1e4, 2e4],
        **more,
    }


def bogie(places: tuple[float, ...] = (1.25, -1.25), x: float = 0.0, **more: Any) -> dict[str, Any]:
    """One frame on wheelsets without axle boxes, springs 1 m off the middle."""
    found = {
        "body": [{"name": "frame", **BODY, "position": [x, 0.0, 0.6]}],
        "wheelset": [{"positions": list(places), **WHEELSET}],
        "element": [
            springs(
                places=[
                    place("frame", f"wheelset_{k}", at, side, RADIUS)
                    for k, at in enumerate(sorted(places, reverse=True), start=1)
                    for side in (-1.0, 1.0)
                ]
            )
        ],
    }
    return found | more


def text_of(vehicle: dict[str, Any], head: str = "", **run: Any) -> str:
    """A scene's: contact, profiles and track of the packaged one, straight and level. head: more
    keys of [vehicle]."""
    packaged = scene_file("vehicle_straight.toml").read_text(encoding="utf-8")
    before = packaged[: packaged.index("[vehicle]")].replace("half_space", "hertz")
    before = before.replace('"full"', '"polach"')
    run = {"duration": 0.1, "log_every": 1, **run}
    parts = [tables(name, rows) for name, rows in vehicle.items()]
    keys = "\n".join(f"{key} = {toml(value)}" for key, value in run.items())
    return "\n".join([before, "[vehicle]", head, *parts, "[run]", keys, ""])


def load(
    folder: Path, vehicle: dict[str, Any], head: str = "", more: str = "", **run: Any
) -> VehicleScene:
    """Through a file. more: further tables. Raises CaseError."""
    file = folder / "vehicle.toml"
    file.write_text(text_of(vehicle, head, **run) + more, encoding="utf-8")
    return load_vehicle_scene(file)
