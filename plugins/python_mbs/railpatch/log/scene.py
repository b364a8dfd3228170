"""The 3D scene in Foxglove's well-known messages: frames, bodies, contact patches, forces.

Frames: world (z up, for viewers) holds track (z down), track holds wheelset, wheelset holds
wheel_left and wheel_right, which turn about the axle; track holds roller_left and roller_right.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from foxglove_schemas_protobuf.FrameTransforms_pb2 import FrameTransforms
from foxglove_schemas_protobuf.LinePrimitive_pb2 import LinePrimitive
from foxglove_schemas_protobuf.SceneEntity_pb2 import SceneEntity
from foxglove_schemas_protobuf.SceneUpdate_pb2 import SceneUpdate

from .channels import SIDES
from .geometry import SceneGeometry, drawn_out, revolved

_RAIL_LENGTH = 4.0  # m
_ARROW_SCALE = 5e-6  # m/N: 100 kN are half a metre
_CIRCLE_POINTS = 32

_STEEL = (0.62, 0.65, 0.70, 1.0)
_RAIL = (0.48, 0.46, 0.44, 1.0)
_MARK = (0.15, 0.15, 0.15, 1.0)
_PATCH = (0.95, 0.65, 0.10, 1.0)
_NORMAL = (0.20, 0.45, 0.85, 1.0)
_CREEP = (0.85, 0.20, 0.20, 1.0)

_HALF_TURN_X = np.array([1.0, 0.0, 0.0, 0.0])  # quaternion x, y, z, w


def transforms(
    state: Mapping[str, Any], geometry: SceneGeometry | None, time_ns: int
) -> FrameTransforms:
    """The frames of one moment; angles that the state lacks count as zero."""
    radius = geometry.nominal_radius if geometry else 0.0
    message = FrameTransforms()
    _add_transform(message, time_ns, "world", "track", (0, 0, 0), _HALF_TURN_X)
    centre = (0.0, state["y"], state["z"] - radius)
    attitude = _product(_about("x", state["roll"]), _about("z", state["yaw"]))
    _add_transform(message, time_ns, "track", "wheelset", centre, attitude)
    for side in SIDES:
        spin = _about("y", state.get("pitch") or 0.0)
        _add_transform(message, time_ns, "wheelset", f"wheel_{side}", (0, 0, 0), spin)
    if geometry and geometry.kind == "roller":
        spin = _about("y", state.get("roller_pitch") or 0.0)
        for side in SIDES:
            axle = (0.0, 0.0, geometry.roller_radius)
            _add_transform(message, time_ns, "track", f"roller_{side}", axle, spin)
    return message


def bodies(geometry: SceneGeometry) -> SceneUpdate:
    """Wheels and rollers or rails as triangle meshes, each in its own frame."""
    update = SceneUpdate()
    for side in SIDES:
        wheel = _entity(update, f"wheel_{side}", f"wheel_{side}", 0)
        _mesh(wheel, *revolved(geometry.wheels[side]), _STEEL)
        _spokes(wheel, geometry.wheels[side])
        rail = geometry.rails[side]
        if geometry.kind == "roller":
            # the roller's axle lies below its top: z of its profile becomes a radius
            curve = np.column_stack([rail[:, 0], geometry.roller_radius - rail[:, 1]])
            roller = _entity(update, f"roller_{side}", f"roller_{side}", 0)
            _mesh(roller, *revolved(curve), _RAIL)
            _spokes(roller, curve)
        else:
            _mesh(
                _entity(update, f"rail_{side}", "track", 0), *drawn_out(rail, _RAIL_LENGTH), _RAIL
            )
    return update


def contact(sides: Mapping[str, Mapping[str, Any]], time_ns: int) -> SceneUpdate:
    """Patches as discs of their area, with arrows of the normal and the creep force on the wheel.

    ``sides``: the contact dicts by side. Patches without position are not shown.
    """
    update = SceneUpdate()
    # a patch of the moment before may be gone
    update.deletions.add(type=1).timestamp.FromNanoseconds(time_ns)
    for side in SIDES:
        for index, patch in enumerate(sides[side].get("patches") or ()):
            if patch.get("position") is None:
                continue
            entity = _entity(update, f"{side}_patch_{index}", "track", time_ns)
            entity.metadata.add(key="status", value=patch["status"])
            _patch(entity, patch)
    return update


def _patch(entity: SceneEntity, patch: Mapping[str, Any]) -> None:
    position = np.asarray(patch["position"], dtype=float)
    angle = patch.get("contact_angle") or 0.0
    lateral = np.array([0.0, np.cos(angle), np.sin(angle)])
    normal = np.array([0.0, -np.sin(angle), np.cos(angle)])
    _disc(entity, position, lateral, np.sqrt((patch.get("contact_area") or 0.0) / np.pi))
    # the normal points into the rail, the force on the wheel the other way
    _arrow(entity, position, -(patch.get("normal_force") or 0.0) * normal, _NORMAL)
    creep = patch.get("creep_force")
    if creep is not None:
        force = creep[0] * np.array([1.0, 0.0, 0.0]) + creep[1] * lateral
        _arrow(entity, position, force, _CREEP)


def _entity(update: SceneUpdate, name: str, frame: str, time_ns: int) -> SceneEntity:
    entity = update.entities.add(id=name, frame_id=frame, frame_locked=True)
    entity.timestamp.FromNanoseconds(time_ns)
    entity.lifetime.FromNanoseconds(0)
    return entity


def _mesh(
    entity: SceneEntity, vertices: np.ndarray, triangles: np.ndarray, color: tuple[float, ...]
) -> None:
    mesh = entity.triangles.add()
    _pose(mesh.pose)
    _color(mesh.color, color)
    for x, y, z in vertices.tolist():
        mesh.points.add(x=x, y=y, z=z)
    # both faces: viewers may hide a triangle that is seen from behind
    both = np.vstack([triangles, triangles[:, ::-1]])
    mesh.indices.extend(both.ravel().tolist())


def _spokes(entity: SceneEntity, curve: np.ndarray) -> None:
    """Lines on both faces of a body of revolution, so that its turning can be seen."""
    line = entity.lines.add(type=LinePrimitive.LINE_LIST, thickness=0.006)
    _pose(line.pose)
    _color(line.color, _MARK)
    for y in (curve[:, 0].min(), curve[:, 0].max()):
        radius = float(curve[np.argmin(abs(curve[:, 0] - y)), 1])
        for angle in np.arange(3) * np.pi / 3:
            for end in (-radius, radius):
                line.points.add(x=end * np.sin(angle), y=float(y), z=end * np.cos(angle))


def _disc(entity: SceneEntity, position: np.ndarray, lateral: np.ndarray, radius: float) -> None:
    if radius <= 0:
        return
    line = entity.lines.add(type=LinePrimitive.LINE_LOOP, thickness=2.0, scale_invariant=True)
    _pose(line.pose)
    _color(line.color, _PATCH)
    angles = np.linspace(0.0, 2 * np.pi, _CIRCLE_POINTS, endpoint=False)
    rim = position + radius * (
        np.cos(angles)[:, None] * [1.0, 0.0, 0.0] + np.sin(angles)[:, None] * lateral
    )
    for x, y, z in rim.tolist():
        line.points.add(x=x, y=y, z=z)


def _arrow(
    entity: SceneEntity, position: np.ndarray, force: np.ndarray, color: tuple[float, ...]
) -> None:
    length = float(np.linalg.norm(force)) * _ARROW_SCALE
    if length <= 0:
        return
    head = min(0.04, 0.4 * length)
    arrow = entity.arrows.add(
        shaft_length=length - head, shaft_diameter=0.012, head_length=head, head_diameter=0.03
    )
    _pose(arrow.pose, position, _towards(force))
    _color(arrow.color, color)


def _add_transform(
    message: FrameTransforms,
    time_ns: int,
    parent: str,
    child: str,
    position: tuple[float, ...],
    turn: np.ndarray,
) -> None:
    frame = message.transforms.add(parent_frame_id=parent, child_frame_id=child)
    frame.timestamp.FromNanoseconds(time_ns)
    frame.translation.x, frame.translation.y, frame.translation.z = map(float, position)
    _quaternion(frame.rotation, turn)


def _pose(pose: Any, position: Any = (0.0, 0.0, 0.0), turn: Any = (0.0, 0.0, 0.0, 1.0)) -> None:
    pose.position.x, pose.position.y, pose.position.z = map(float, position)
    _quaternion(pose.orientation, turn)


def _quaternion(target: Any, turn: Any) -> None:
    target.x, target.y, target.z, target.w = map(float, turn)


def _color(target: Any, color: tuple[float, ...]) -> None:
    target.r, target.g, target.b, target.a = color


def _about(axis: str, angle: float) -> np.ndarray:
    """Quaternion (x, y, z, w) of a turn about one axis."""
    turn = np.zeros(4)
    turn["xyz".index(axis)] = np.sin(angle / 2)
    turn[3] = np.cos(angle / 2)
    return turn


def _product(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """Quaternion of turning the axes by ``first``, then by ``second`` about the turned axes."""
    a, b = first[:3], second[:3]
    vector = first[3] * b + second[3] * a + np.cross(a, b)
    return np.append(vector, first[3] * second[3] - a @ b)


def _towards(direction: np.ndarray) -> np.ndarray:
    """Quaternion that turns the x axis into ``direction``."""
    unit = direction / np.linalg.norm(direction)
    turn = np.append(np.cross([1.0, 0.0, 0.0], unit), 1.0 + unit[0])
    length = np.linalg.norm(turn)
    # straight back along x: any axis across will do
    return turn / length if length > 1e-9 else np.array([0.0, 0.0, 1.0, 0.0])
