"""Shapes for the 3D scene: wheel, roller and rail profiles revolved or drawn out.

Nothing here enters a computation; the solver has its own geometry. Curves are arrays of shape
(n, 2) with lateral and vertical coordinates in metres, z down.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from railpatch.case.scene_profiles import named_profile
from railpatch.case.types import SIDES
from railpatch.case.wheel import Deviation, WheelsetCase
from railpatch.profiles.raw import Role

KINDS = ("rail", "roller")
# enough for a smooth picture; more only makes the log larger
_CURVE_POINTS = 24
_TURN_STEPS = 40


@dataclass(frozen=True)
class SceneGeometry:
    """What the 3D scene shows.

    ``kind``: "rail" or "roller". ``wheels``: by side, the wheel profile in wheelset axes (y from
    the wheelset's centre, z from its axle). ``rails``: by side, the rail or roller profile in track
    axes. ``nominal_radius``, ``roller_radius``: m; the latter only with rollers.
    Raises ValueError where a value is missing or has the wrong shape.
    """

    kind: str
    nominal_radius: float
    wheels: Mapping[str, np.ndarray]
    rails: Mapping[str, np.ndarray]
    roller_radius: float | None = None

    def __post_init__(self) -> None:
        if self.kind not in KINDS:
            raise ValueError(f"geometry: kind is {self.kind!r}; it must be one of {KINDS}")
        radii = {"nominal_radius": self.nominal_radius}
        if self.kind == "roller":
            radii["roller_radius"] = self.roller_radius  # type: ignore[assignment]
        for name, radius in radii.items():
            if not isinstance(radius, (int, float)) or not np.isfinite(radius) or radius <= 0:
                raise ValueError(f"geometry: {name} is {radius!r}; it must be > 0 (m)")
        for name in ("wheels", "rails"):
            curves = getattr(self, name)
            if set(curves) != set(SIDES):
                raise ValueError(f"geometry: {name} has {sorted(curves)}; it must have {SIDES}")
            for side in SIDES:
                _check_curve(curves[side], f"geometry: {name}[{side!r}]")

    @classmethod
    def from_profiles(
        cls,
        kind: str,
        wheels: Mapping[str, np.ndarray],
        rails: Mapping[str, np.ndarray],
        *,
        nominal_radius: float,
        flange_back_distance: float,
        gauge: float,
        gauge_height: float,
        flange_back_position: float = 0.0,
        roller_radius: float | None = None,
        rail_offsets: Mapping[str, Sequence[float]] | None = None,
    ) -> SceneGeometry:
        """Places profiles as read from file (right-hand ones, y outwards, z down, m).

        Left profiles are mirrored. ``rail_offsets``: by side, (y, z) of the deviation from the
        design position in track axes, m. Small rotations of markers and rails are not shown.
        """
        place = np.array([flange_back_distance / 2 - flange_back_position, nominal_radius])
        offsets = rail_offsets or {}
        placed_wheels, placed_rails = {}, {}
        for side in SIDES:
            mirror = np.array([1.0 if side == "right" else -1.0, 1.0])
            wheel = _check_curve(wheels[side], f"wheel profile {side}")
            placed_wheels[side] = (wheel + place) * mirror
            rail = _check_curve(rails[side], f"rail profile {side}")
            shift = [gauge / 2 - _gauge_point(rail, gauge_height), _drop(kind, rail)]
            placed_rails[side] = (rail + shift) * mirror + np.asarray(offsets.get(side, (0.0, 0.0)))
        return cls(kind, nominal_radius, placed_wheels, placed_rails, roller_radius)


def _check_curve(curve: np.ndarray, name: str) -> np.ndarray:
    array = np.asarray(curve, dtype=float)
    if array.ndim != 2 or array.shape[0] < 2 or array.shape[1] != 2:
        raise ValueError(f"{name} has shape {array.shape}; it must be (n, 2) with n >= 2")
    if not np.isfinite(array).all():
        raise ValueError(f"{name} holds values that are not finite")
    return array


def _gauge_point(rail: np.ndarray, gauge_height: float) -> float:
    """y of the innermost point within ``gauge_height`` below the top."""
    near_top = rail[:, 1] <= rail[:, 1].min() + gauge_height
    return float(rail[near_top, 0].min())


def _drop(kind: str, rail: np.ndarray) -> float:
    """A rail's highest point lies at z = 0; a roller's profile keeps its own z."""
    return -float(rail[:, 1].min()) if kind == "rail" else 0.0


def thin(curve: np.ndarray, count: int = _CURVE_POINTS) -> np.ndarray:
    """``count`` points of a curve, evenly spaced along it; shape (count, 2)."""
    curve = np.asarray(curve, dtype=float)
    steps = np.hypot(*np.diff(curve, axis=0).T)
    length = np.concatenate([[0.0], np.cumsum(steps)])
    wanted = np.linspace(0.0, length[-1], count)
    return np.column_stack([np.interp(wanted, length, curve[:, axis]) for axis in (0, 1)])


def revolved(curve: np.ndarray, count: int = _CURVE_POINTS) -> tuple[np.ndarray, np.ndarray]:
    """A curve (y, z) turned about the y axis: vertices (n, 3) and triangles (m, 3)."""
    points = thin(curve, count)
    angles = np.linspace(0.0, 2 * np.pi, _TURN_STEPS + 1)
    rows = [
        np.column_stack([np.sin(a) * points[:, 1], points[:, 0], np.cos(a) * points[:, 1]])
        for a in angles
    ]
    return np.vstack(rows), _strip(len(angles), len(points))


def drawn_out(curve: np.ndarray, length: float) -> tuple[np.ndarray, np.ndarray]:
    """A curve (y, z) drawn out along x over ``length``: vertices (n, 3) and triangles (m, 3)."""
    points = thin(curve)
    rows = [np.column_stack([np.full(len(points), x), points]) for x in (-length / 2, length / 2)]
    return np.vstack(rows), _strip(2, len(points))


def _strip(rows: int, columns: int) -> np.ndarray:
    """Two triangles for each cell of a grid of vertices, row after row."""
    corner = (np.arange(rows - 1)[:, None] * columns + np.arange(columns - 1)).ravel()
    lower = np.column_stack([corner, corner + 1, corner + columns])
    upper = np.column_stack([corner + 1, corner + columns + 1, corner + columns])
    return np.vstack([lower, upper])


def scene_geometry(case: WheelsetCase) -> SceneGeometry:
    """The bodies of a case's 3D scene; its profiles are names or absolute paths.

    Raises ProfileError.
    """
    wheelset, track = case.wheelset, case.track
    return SceneGeometry.from_profiles(
        "roller" if track.kind == "roller" else "rail",
        {side: curve(case, "wheel", side, getattr(wheelset, side)) for side in SIDES},
        {side: curve(case, "rail", side, Deviation()) for side in SIDES},
        nominal_radius=wheelset.nominal_radius,
        flange_back_distance=wheelset.flange_back_distance,
        flange_back_position=wheelset.flange_back_position,
        gauge=track.gauge,
        gauge_height=track.gauge_height,
        roller_radius=track.roller_radius,
        rail_offsets={side: getattr(track, side).offset[1:] for side in SIDES},
    )


def curve(case: WheelsetCase, role: Role, side: str, deviation: Deviation) -> np.ndarray:
    """m, [n, 2], y and z of a profile, a right-hand one for both sides, with its deviation."""
    _, name = case.profiles.of(role, side)
    sections = getattr(case.track, side).sections if role == "rail" else None
    if sections is not None:  # drawn as it begins
        name = sections[0].profile
    assert name is not None
    mirror = -1.0 if side == "left" else 1.0
    _, y, z = deviation.offset
    profile = named_profile(case, role, name, Path())
    moved = profile.moved(mirror * y, z, mirror * deviation.rotation[0])
    return np.column_stack([moved.y, moved.z])
