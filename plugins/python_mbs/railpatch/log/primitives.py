"""Parts of Foxglove's 3D messages as dicts that their classes take.

Quaternions are (x, y, z, w).
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from foxglove_schemas_protobuf.FrameTransforms_pb2 import FrameTransforms
from foxglove_schemas_protobuf.LinePrimitive_pb2 import LinePrimitive

Vector3 = tuple[float, ...]
Quaternion = tuple[float, ...]
HALF_TURN_X: Quaternion = (1.0, 0.0, 0.0, 0.0)


def rgb(r: float, g: float, b: float, a: float = 1.0) -> dict[str, float]:
    """A colour, each part 0 to 1."""
    return {"r": r, "g": g, "b": b, "a": a}


def stamp_of(time_ns: int) -> dict[str, int]:
    """A time."""
    return {"seconds": time_ns // 10**9, "nanos": time_ns % 10**9}


def entity(
    name: str, place: str, stamp: dict[str, int] | None = None, **primitives: Any
) -> dict[str, Any]:
    """Primitives that move along with a frame, until they are replaced."""
    return {
        "id": name,
        "frame_id": place,
        "frame_locked": True,
        "timestamp": stamp or {},
        "lifetime": {},
        **primitives,
    }


def triangles(vertices: np.ndarray, corners: np.ndarray, color: dict[str, float]) -> dict[str, Any]:
    """A mesh: vertices (n, 3), triangles of their indices (m, 3)."""
    # both faces: viewers may hide a triangle that is seen from behind
    both = np.vstack([corners, corners[:, ::-1]])
    return {
        "pose": pose(),
        "color": color,
        "points": points(vertices.tolist()),
        "indices": both.ravel().tolist(),
    }


def line(
    along: Iterable[Sequence[float]],
    color: dict[str, float],
    thickness: float,
    kind: Any = LinePrimitive.LINE_STRIP,
    pixels: bool = False,
) -> dict[str, Any]:
    """Through points. thickness: m, or on the screen."""
    return {
        "type": kind,
        "thickness": thickness,
        "scale_invariant": pixels,
        "pose": pose(),
        "color": color,
        "points": points(along),
    }


def points(values: Iterable[Sequence[float]]) -> list[dict[str, float]]:
    """As the messages want them."""
    return [{"x": x, "y": y, "z": z} for x, y, z in values]


def box(centre: Sequence[float], size: Sequence[float], color: dict[str, float]) -> dict[str, Any]:
    """A cuboid along its frame's axes."""
    return {"pose": pose(centre), "size": dict(zip("xyz", size, strict=True)), "color": color}


def stamped(frames: Sequence[dict[str, Any]], time_ns: int) -> FrameTransforms:
    """All frames of one moment."""
    stamp = {"seconds": time_ns // 10**9, "nanos": time_ns % 10**9}
    return FrameTransforms(transforms=[{**item, "timestamp": stamp} for item in frames])


def frame(parent: str, child: str, position: Sequence[float], turn: Quaternion) -> dict[str, Any]:
    """A transform without its time."""
    return {
        "parent_frame_id": parent,
        "child_frame_id": child,
        "translation": dict(zip("xyz", map(float, position), strict=True)),
        "rotation": dict(zip("xyzw", turn, strict=True)),
    }


def pose(
    position: Sequence[float] = (0.0, 0.0, 0.0), turn: Quaternion = (0.0, 0.0, 0.0, 1.0)
) -> dict[str, Any]:
    """Of a primitive in its frame."""
    return {
        "position": dict(zip("xyz", position, strict=True)),
        "orientation": dict(zip("xyzw", turn, strict=True)),
    }


def about(axis: str, angle: float) -> Quaternion:
    """Quaternion (x, y, z, w) of a turn about one axis."""
    turn = [0.0, 0.0, 0.0, math.cos(angle / 2)]
    turn["xyz".index(axis)] = math.sin(angle / 2)
    return tuple(turn)


def product(first: Quaternion, second: Quaternion) -> Quaternion:
    """Of turning the axes by ``first``, then by ``second`` about the turned axes."""
    ax, ay, az, aw = first
    bx, by, bz, bw = second
    return (
        aw * bx + bw * ax + ay * bz - az * by,
        aw * by + bw * ay + az * bx - ax * bz,
        aw * bz + bw * az + ax * by - ay * bx,
        aw * bw - ax * bx - ay * by - az * bz,
    )


def towards(unit: Sequence[float]) -> Quaternion:
    """Turns the x axis into a direction of length 1."""
    x, y, z = unit
    turn = (0.0, -z, y, 1.0 + x)
    length = math.hypot(*turn)
    if length <= 1e-9:
        # straight back along x: any axis across will do
        return (0.0, 0.0, 1.0, 0.0)
    return tuple(value / length for value in turn)
