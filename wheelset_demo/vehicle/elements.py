"""Where the elements of a suspension are, what they carry, bump stops."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from railpatch import _core

from wheelset_demo.scene import GRAVITY
from wheelset_demo.vehicle.model import CAR_BODY, bogie_name, places_along
from wheelset_demo.vehicle.scene import (
    BOXES,
    WHEELSETS,
    ElementTable,
    VehicleScene,
    VehicleTable,
)

Vector = NDArray[np.float64]
OUTWARD = {"left": -1.0, "right": 1.0}
Z = 2


@dataclass(frozen=True)
class Place:
    """Of one element. element: its table. ends: names of bodies A and B. point: m, [3], at rest, in
    the track's frame of which x = 0 is at the last wheelset."""

    element: ElementTable
    ends: tuple[str, str]
    point: Vector


class Stop:
    """A bump stop: point symmetric, a straight line between the points of its table and on after
    the last."""

    def __init__(self, rows: list[list[float]] | None) -> None:
        assert rows is not None
        points = np.array(rows, dtype=float)
        if points[0, 0] > 0:
            points = np.vstack([[0.0, 0.0], points])
        self._d, self._f = points.T.copy()
        self._slopes = np.diff(self._f) / np.diff(self._d)
        areas = 0.5 * (self._f[1:] + self._f[:-1]) * np.diff(self._d)
        self._areas = np.concatenate([[0.0], np.cumsum(areas)])

    def _part(self, size: float) -> int:
        last = len(self._slopes) - 1
        return min(int(np.searchsorted(self._d, size, side="right")) - 1, last)

    @property
    def points(self) -> tuple[Vector, Vector]:
        """Displacements (m), >= 0 and increasing, and forces (N) there."""
        return self._d, self._f

    def force(self, d: float) -> float:
        """N, against the displacement (m)."""
        return _core.stop_force(self._d, self._f, d)

    def slope(self, d: float) -> float:
        """N/m."""
        return float(self._slopes[self._part(abs(d))])

    def energy(self, d: float) -> float:
        """J."""
        size = abs(d)
        k = self._part(size)
        away = size - self._d[k]
        return float(self._areas[k] + (self._f[k] + 0.5 * self._slopes[k] * away) * away)


def preloads(places: list[Place], vehicle: VehicleTable) -> Vector:
    """N, [elements], at rest: shares of the weight above by vertical stiffness.

    Primary springs push axle boxes down, which are body B; secondary ones carry the car body, body
    B, up. Down is > 0 and the force on B is -preload.
    """
    car = vehicle.car_body.mass * GRAVITY
    sprung = car + 2 * vehicle.bogie_frame.mass * GRAVITY
    found = np.zeros(len(places))
    for level, weight, count in (("primary", -sprung, BOXES), ("secondary", car, 4)):
        rows = [k for k, place in enumerate(places) if place.element.level == level]
        stiffness = np.array([places[k].element.stiffness[Z] for k in rows])
        found[rows] = weight * stiffness / stiffness.sum()
        assert len(rows) % count == 0
    return found


def centres_at_rest(scene: VehicleScene) -> dict[str, Vector]:
    """m, [3], of the bodies that elements act on, in the frame of Place."""
    vehicle, radius = scene.vehicle, scene.case.wheelset.nominal_radius
    along = places_along(vehicle)
    found = {CAR_BODY: np.array([along[CAR_BODY], 0.0, -vehicle.car_body.height])}
    for bogie in range(2):
        name = bogie_name(bogie)
        found[name] = np.array([along[name], 0.0, -vehicle.bogie_frame.height])
    for k in range(WHEELSETS):
        for side, sign in OUTWARD.items():
            name = f"axle_box_{k + 1}_{side}"
            found[name] = np.array([along[name], sign * vehicle.axle_box.lateral, -radius])
    return found


def places_of(element: ElementTable, scene: VehicleScene) -> list[Place]:
    """Of one table's elements, all over the vehicle."""
    along, found = places_along(scene.vehicle), []

    def add(ends: tuple[str, str], x: float, y: float) -> None:
        found.append(Place(element, ends, np.array([x, y, -element.height])))

    for bogie in range(2):
        frame = bogie_name(bogie)
        for side, sign in OUTWARD.items():
            y = sign * element.lateral
            if element.level == "primary":
                for k in (2 * bogie, 2 * bogie + 1):
                    box = f"axle_box_{k + 1}_{side}"
                    # outward: away from the bogie's centre
                    outward = 1.0 if k % 2 == 0 else -1.0
                    add((frame, box), along[box] + outward * element.longitudinal, y)
            elif element.level == "secondary":
                add((frame, CAR_BODY), along[frame] + sign * element.longitudinal, y)
        if element.level == "centre":
            add((frame, CAR_BODY), along[frame] + element.longitudinal, 0.0)
    return found
