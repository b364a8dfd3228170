"""The 3D scene in Foxglove's well-known messages: frames, bodies, contact patches, forces.

Frames: world (z up, for viewers) holds track (z down), track holds wheelset, wheelset holds
wheel_left and wheel_right, which turn about the axle; track holds roller_left and roller_right.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from foxglove_schemas_protobuf.FrameTransforms_pb2 import FrameTransforms
from foxglove_schemas_protobuf.LinePrimitive_pb2 import LinePrimitive
from foxglove_schemas_protobuf.SceneUpdate_pb2 import SceneUpdate

from railpatch.case.types import SIDES
from railpatch.log.geometry import SceneGeometry, drawn_out, revolved
from railpatch.log.primitives import (
    HALF_TURN_X,
    Vector3,
    about,
    entity,
    frame,
    line,
    pose,
    product,
    rgb,
    stamp_of,
    stamped,
    towards,
    triangles,
)

_RAIL_LENGTH = 4.0  # m
_SHAFT = 0.08  # m, radius of axles
_SPOKE = 0.006  # m, thickness of the marks on a disc
_ARROW_SCALE = 5e-6  # m/N: 100 kN are half a metre
_CIRCLE_POINTS = 20
_CIRCLE = [
    (math.cos(math.tau * k / _CIRCLE_POINTS), math.sin(math.tau * k / _CIRCLE_POINTS))
    for k in range(_CIRCLE_POINTS)
]

STEEL = rgb(0.62, 0.65, 0.70)
RAIL = rgb(0.48, 0.46, 0.44)
_MARK = rgb(0.15, 0.15, 0.15)
_PATCH = rgb(0.95, 0.65, 0.10)
_NORMAL = rgb(0.20, 0.45, 0.85)
_CREEP = rgb(0.85, 0.20, 0.20)


def transforms(
    state: Mapping[str, Any], geometry: SceneGeometry | None, time_ns: int
) -> FrameTransforms:
    """The frames of one moment; angles that the state lacks count as zero."""
    radius = geometry.nominal_radius if geometry else 0.0
    centre = (0.0, state["y"], state["z"] - radius)
    attitude = product(about("x", state["roll"]), about("z", state["yaw"]))
    frames = [
        frame("world", "track", (0.0, 0.0, 0.0), HALF_TURN_X),
        frame("track", "wheelset", centre, attitude),
    ]
    spin = about("y", state.get("pitch") or 0.0)
    frames += [frame("wheelset", f"wheel_{side}", (0.0, 0.0, 0.0), spin) for side in SIDES]
    if geometry and geometry.kind == "roller":
        spin = about("y", state.get("roller_pitch") or 0.0)
        axle = (0.0, 0.0, geometry.roller_radius)
        frames += [frame("track", f"roller_{side}", axle, spin) for side in SIDES]
    return stamped(frames, time_ns)


def bodies(geometry: SceneGeometry) -> SceneUpdate:
    """Wheels and rollers or rails as triangle meshes, each in its own frame."""
    entities = []
    for side in SIDES:
        entities.append(wheel(f"wheel_{side}", f"wheel_{side}", geometry.wheels[side]))
        rail = geometry.rails[side]
        if geometry.kind == "roller":
            # the roller's axle lies below its top: z of its profile becomes a radius
            curve = np.column_stack([rail[:, 0], geometry.roller_radius - rail[:, 1]])
            entities.append(turning(f"roller_{side}", f"roller_{side}", curve, RAIL))
        else:
            mesh = triangles(*drawn_out(rail, _RAIL_LENGTH), RAIL)
            entities.append(entity(f"rail_{side}", "track", triangles=[mesh]))
    return SceneUpdate(entities=entities)


def wheel(name: str, place: str, curve: np.ndarray) -> dict[str, Any]:
    """With its half of the axle."""
    return turning(name, place, curve, STEEL, axle=True)


def turning(
    name: str, place: str, curve: np.ndarray, color: dict[str, float], axle: bool = False
) -> dict[str, Any]:
    """A wheel or roller about its frame's y axis: rim by its profile, disc, marks by which its
    turning is seen, and half an axle if asked."""
    # on the inner face, so that forces at the tread are seen
    inside, radius = map(float, curve[np.argmin(np.abs(curve[:, 0]))])
    disc = [[inside, 0.0], [inside, radius]]
    shapes = [revolved(curve), revolved(np.array(disc), 2)]
    if axle:
        shapes.append(revolved(np.array([[0.0, _SHAFT], [inside, _SHAFT]]), 2))
    meshes = [triangles(*shape, color) for shape in shapes]
    return entity(name, place, triangles=meshes, lines=[_spokes(inside, radius)])


def _spokes(inside: float, radius: float) -> dict[str, Any]:
    """Lines on both faces of the disc; within a line's thickness they would vanish in it."""
    points = []
    for y in (inside - _SPOKE, inside + _SPOKE):
        for angle in np.arange(3) * np.pi / 3:
            for end in (-radius, radius):
                points.append((end * np.sin(angle), y, end * np.cos(angle)))
    return line(points, _MARK, _SPOKE, kind=LinePrimitive.LINE_LIST)


def contact(sides: Mapping[str, Mapping[str, Any]], time_ns: int) -> SceneUpdate:
    """Patches as discs of their area, with arrows of the normal and the creep force on the wheel.

    ``sides``: the contact dicts by side. Patches without position are not shown.
    """
    return contacts({(side, "track"): values for side, values in sides.items()}, time_ns)


def contacts(
    wheels: Mapping[tuple[str, str], Mapping[str, Any]], time_ns: int, scale: float = _ARROW_SCALE
) -> SceneUpdate:
    """The same of any wheels, by name and frame. scale: m/N, of the arrows."""
    stamp = stamp_of(time_ns)
    entities = [
        entity(
            f"{name}_patch_{index}",
            place,
            stamp,
            metadata=[{"key": "status", "value": patch["status"]}],
            **_patch(patch, scale),
        )
        for (name, place), values in wheels.items()
        for index, patch in enumerate(values.get("patches") or ())
        if _is_known(patch.get("position"))
    ]
    # a patch of the moment before may be gone
    return SceneUpdate(deletions=[{"type": 1, "timestamp": stamp}], entities=entities)


def _is_known(position: Sequence[float | None] | None) -> bool:
    """A patch that was not solved has no position, or one of unknown numbers."""
    return position is not None and all(v is not None and math.isfinite(v) for v in position)


def _patch(patch: Mapping[str, Any], scale: float) -> dict[str, Any]:
    """Line and arrows of a patch."""
    at = tuple(map(float, patch["position"]))
    angle = patch.get("contact_angle") or 0.0
    c, s = math.cos(angle), math.sin(angle)
    radius = math.sqrt((patch.get("contact_area") or 0.0) / math.pi)
    # the normal points into the rail, the force on the wheel the other way
    up = -(patch.get("normal_force") or 0.0)
    forces = [((0.0, -up * s, up * c), _NORMAL)]
    creep = patch.get("creep_force")
    if creep is not None:
        forces.append(((creep[0], creep[1] * c, creep[1] * s), _CREEP))
    arrows = [_arrow(at, force, color, scale) for force, color in forces]
    return {
        "lines": [_disc(at, (c, s), radius)] if radius > 0 else [],
        "arrows": [arrow for arrow in arrows if arrow],
    }


def _disc(at: Vector3, lateral: tuple[float, float], radius: float) -> dict[str, Any]:
    x, y, z = at
    c, s = lateral
    points = [(x + radius * u, y + radius * c * v, z + radius * s * v) for u, v in _CIRCLE]
    return line(points, _PATCH, 2.0, kind=LinePrimitive.LINE_LOOP, pixels=True)


def _arrow(
    at: Vector3, force: tuple[float, float, float], color: dict[str, float], scale: float
) -> dict[str, Any] | None:
    newtons = math.hypot(*force)
    length = newtons * scale
    if length <= 0:
        return None
    head = min(0.04, 0.4 * length)
    return {
        "shaft_length": length - head,
        "shaft_diameter": 0.012,
        "head_length": head,
        "head_diameter": 0.03,
        "pose": pose(at, towards([value / newtons for value in force])),
        "color": color,
    }
