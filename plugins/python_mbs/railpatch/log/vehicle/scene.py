"""The 3D scene of a vehicle.

Frames: world (z up, for viewers) holds start (z down), fixed to the ground; start holds the bodies
and, for each wheelset N, its track axes track_N; wheelset_N holds wheels_N, which turn. The first
body holds view (z up), for cameras that follow it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from foxglove_schemas_protobuf.FrameTransforms_pb2 import FrameTransforms
from foxglove_schemas_protobuf.SceneUpdate_pb2 import SceneUpdate

from railpatch.case.types import SIDES
from railpatch.log.geometry import SceneGeometry, drawn_out
from railpatch.log.primitives import (
    HALF_TURN_X,
    about,
    box,
    entity,
    frame,
    line,
    rgb,
    stamped,
    triangles,
)
from railpatch.log.scene import RAIL, contacts, wheel
from railpatch.log.vehicle.geometry import VehicleGeometry

_ARROW_SCALE = 2e-5  # m/N: 100 kN are two metres, to be seen from afar
_RAIL_LENGTH = 2.4  # m, around each wheelset
_BODY = rgb(0.35, 0.52, 0.68, 0.3)  # one sees through it
_LINE = rgb(0.55, 0.55, 0.55)
_MOST_POINTS = 2000


def transforms(
    wheelsets: Sequence[Mapping[str, Any]],
    bodies: Sequence[Mapping[str, Any]],
    tracks: Sequence[tuple[Sequence[float], Sequence[float]]] | None,
    time_ns: int,
) -> FrameTransforms:
    """The frames of one moment."""
    frames = [frame("world", "start", (0.0, 0.0, 0.0), HALF_TURN_X)]
    for body in bodies:
        frames.append(frame("start", body["name"], body["position"], body["orientation"]))
    if bodies:
        frames.append(frame(bodies[0]["name"], "view", (0.0, 0.0, 0.0), HALF_TURN_X))
    for number, (wheelset, place) in enumerate(
        zip(wheelsets, tracks or [None] * len(wheelsets), strict=True), start=1
    ):
        spin = about("y", wheelset["state"].get("pitch") or 0.0)
        frames.append(frame(f"wheelset_{number}", f"wheels_{number}", (0.0, 0.0, 0.0), spin))
        if place is not None:
            frames.append(frame("start", f"track_{number}", *place))
    return stamped(frames, time_ns)


def contact(wheelsets: Sequence[Mapping[str, Any]], time_ns: int) -> SceneUpdate:
    """Patches and forces of all wheels."""
    wheels = {
        (f"{number}_{side}", f"track_{number}"): wheelset[side]
        for number, wheelset in enumerate(wheelsets, start=1)
        for side in SIDES
    }
    return contacts(wheels, time_ns, _ARROW_SCALE)


def bodies(geometry: VehicleGeometry, wheelsets: int) -> SceneUpdate:
    """Boxes, wheels, the rails around each wheelset, the track's centre line."""
    entities = [
        entity(name, name, cubes=[box(*each, _BODY) for each in boxes])
        for name, boxes in geometry.boxes.items()
    ]
    for number in range(1, wheelsets + 1):
        entities += _axle(geometry.own.get(number, geometry.wheelset), number)
    if geometry.centre_line is not None:
        points = np.asarray(geometry.centre_line, dtype=float)
        points = points[:: -(-len(points) // _MOST_POINTS)]
        path = line(points.tolist(), _LINE, 2.0, pixels=True)
        entities.append(entity("centre_line", "start", lines=[path]))
    return SceneUpdate(entities=entities)


def _axle(geometry: SceneGeometry, number: int) -> list[dict[str, Any]]:
    """Wheels and axle in wheels_N, pieces of rail in track_N."""
    entities = []
    for side in SIDES:
        name = f"{number}_{side}"
        entities.append(wheel(f"wheel_{name}", f"wheels_{number}", geometry.wheels[side]))
        mesh = triangles(*drawn_out(geometry.rails[side], _RAIL_LENGTH), RAIL)
        entities.append(entity(f"rail_{name}", f"track_{number}", triangles=[mesh]))
    return entities
