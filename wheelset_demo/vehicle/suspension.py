"""All springs, dampers, rods and bump stops of a vehicle, in arrays.

An element joins a point of body A (a bogie frame) to a point of body B (axle box or car body), one
and the same place in the vehicle at rest. Its displacement is that of B's point seen from A, in A's
axes,

    d = R_A^T (P_B - P_A),    d' = R_A^T (v_B - v_A(P_B)),

v_A(P_B) of A's material that is at P_B; turns are half the skew part of R_A^T R_B (small angles),
their rates those of the relative angular velocity. Each component of an element that has a
coefficient is a row:

    force on B = -(k d + c d' + preload + f + table(d)),
    f' = s (d' - f/c)           damper c in series with a spring s,

and acts on A with the opposite force at the same point P_B, so that elements neither give nor take
momentum or moment of momentum. With B [rows, nv] from velocities to rates of the rows, the
generalised force is B^T force. Preloads carry the weight: vertical springs of a level share
it by their stiffness.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from wheelset_demo.scene import GRAVITY
from wheelset_demo.vehicle.model import CAR_BODY, VehicleModel, bogie_name, places_along
from wheelset_demo.vehicle.scene import (
    BOXES,
    WHEELSETS,
    ElementTable,
    VehicleScene,
    VehicleTable,
)

Vector = NDArray[np.float64]
SIDES = (("left", -1.0), ("right", 1.0))
Z = 2
Y = 1
DOWN = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True)
class Place:
    """Of one element. element: its table. ends: names of bodies A and B. point: m, [3], at rest, in
    the track's frame of which x = 0 is at the last wheelset."""

    element: ElementTable
    ends: tuple[str, str]
    point: Vector


@dataclass
class Poses:
    """Of the bodies that elements act on. origins, centres: m, [n, 3], of the first five
    coordinates and of the body. axes: [n, 3, 3], rows are the body's axes in the world's.
    roll_axis: [n, 3]."""

    origins: Vector
    centres: Vector
    axes: Vector
    roll_axis: Vector


class Suspension:
    """The elements of a scene. step() finds their forces, jacobian() how they change."""

    def __init__(self, scene: VehicleScene, model: VehicleModel) -> None:
        self._columns, self._arms = model.columns, model.arms
        places = [place for element in scene.suspension for place in places_of(element, scene)]
        index = {name: k for k, name in enumerate(model.bodies)}
        centres = centres_at_rest(scene)
        self._a, self._b = (
            np.array([index[place.ends[end]] for place in places]) for end in (0, 1)
        )
        points = np.array([place.point for place in places])
        self._at_a, self._at_b = (
            points - np.array([centres[place.ends[end]] for place in places]) for end in (0, 1)
        )
        self._size = len(places)
        self._rows(places, scene.vehicle)
        self._places_of_rows(model.model.nv)
        self.displacement, self.rate, self.force = (np.zeros(self._count) for _ in range(3))
        self.matrix = np.zeros((self._count, model.model.nv))
        self.series_rates = np.zeros(self.series_count)

    def _rows(self, places: list[Place], vehicle: VehicleTable) -> None:
        """Picks the components with a coefficient."""
        tables = [place.element for place in places]
        count = self._size
        stiffness = table_of(tables, "stiffness", "turning_stiffness")
        damping = table_of(tables, "damping", "turning_damping")
        series = np.zeros((2, count, 3))
        series[0] = [table.series_stiffness for table in tables]
        stopped = np.zeros((2, count, 3), dtype=bool)
        stopped[0, :, Y] = [table.bump_stop is not None for table in tables]
        used = (stiffness > 0) | (damping > 0) | stopped
        kind, self._element, self._axis = np.nonzero(used)
        self._along = np.flatnonzero(kind == 0)
        self._about = np.flatnonzero(kind == 1)
        self._count = len(kind)
        self._stiffness = stiffness[used]
        in_series = series[used] > 0
        self._series = np.flatnonzero(in_series)
        self._series_stiffness, self._series_damping = (
            series[used][in_series],
            damping[used][in_series],
        )
        self._damping = np.where(in_series, 0.0, damping[used])
        preload = np.zeros((2, count, 3))
        preload[0, :, Z] = preloads(places, vehicle)
        self._preload = preload[used]
        numbers = np.flatnonzero(stopped[used])
        owners = np.nonzero(stopped)[1]
        self._stops = [
            (int(row), Stop(tables[owner].bump_stop))
            for row, owner in zip(numbers, owners, strict=True)
        ]

    def _places_of_rows(self, width: int) -> None:
        """Where in the matrix the six numbers of each row's two bodies stand."""
        start = width * np.arange(self._count)[:, None]
        self._body_a, self._body_b = self._a[self._element], self._b[self._element]
        about = self._about
        # of all rows for body A, then for body B
        self._body_both = np.concatenate([self._body_a, self._body_b])
        self._element_both = np.tile(self._element, 2)
        self._about_both = np.concatenate([about, about + self._count])
        self._flat_both = np.tile(start, (2, 1)) + self._columns[self._body_both]
        self._turned = (self._body_a[about], self._body_b[about])
        self._next = (self._axis[about] + 1) % 3, (self._axis[about] + 2) % 3

    @property
    def series_count(self) -> int:
        """Number of dampers with a spring in series, each of which has a force as its state."""
        return len(self._series)

    def poses(self, q: Vector) -> Poses:
        """Of the bodies, from the coordinates."""
        place = q[self._columns]
        (cy, cr, cp), (sy, sr, sp) = np.cos(place[:, 3:].T), np.sin(place[:, 3:].T)
        axes = np.empty((len(cy), 3, 3))
        ahead = np.zeros((len(cy), 3))
        ahead[:, 0], ahead[:, 1] = cy, sy
        across = axes[:, 1]
        across[:, 0], across[:, 1], across[:, 2] = -sy * cr, cy * cr, sr
        down = np.empty_like(ahead)
        down[:, 0], down[:, 1], down[:, 2] = sy * sr, -cy * sr, cr
        axes[:, 0] = cp[:, None] * ahead - sp[:, None] * down
        axes[:, 2] = sp[:, None] * ahead + cp[:, None] * down
        origins = place[:, :3]
        return Poses(origins, origins + self._arms[:, None] * across, axes, ahead)

    def step(self, q: Vector, v: Vector, series: Vector) -> Vector:
        """[nv], generalised forces. series: N, forces of dampers with springs in series."""
        found = self.poses(q)
        axes = found.axes
        point_a, point_b = (
            found.centres[body] + (at[:, None, :] @ axes[body])[:, 0]
            for body, at in ((self._a, self._at_a), (self._b, self._at_b))
        )
        direction = axes[self._body_a, self._axis]
        self._fill(found, point_b, direction)
        d = np.einsum("ij,ij->i", direction, (point_b - point_a)[self._element])
        (a, b), (j, k) = self._turned, self._next
        d[self._about] = 0.5 * (axes[a, k] * axes[b, j] - axes[a, j] * axes[b, k]).sum(axis=1)
        rate = self.matrix @ v
        force = -(self._stiffness * d + self._damping * rate + self._preload)
        force[self._series] -= series
        for row, stop in self._stops:
            force[row] -= stop.force(float(d[row]))
        self.series_rates = self._series_stiffness * (
            rate[self._series] - series / self._series_damping
        )
        self.displacement, self.rate, self.force = d, rate, force
        return force @ self.matrix

    def _fill(self, found: Poses, points: Vector, direction: Vector) -> None:
        """Rates of displacements and turns by the velocities, a row each.

        With u the row's direction, a body that moves with v at its origin and turns with w adds
        v.u + w.((P_B - origin) x u) to a displacement, w.u to a turn.
        """
        body = self._body_both
        u = np.concatenate([-direction, direction])
        lever = cross(points[self._element_both] - found.origins[body], u)
        lever[self._about_both] = u[self._about_both]
        part = np.empty((len(u), 6))
        part[:, :3] = u
        part[self._about_both, :3] = 0.0
        part[:, 3] = lever[:, 2]
        part[:, 4] = np.einsum("ij,ij->i", found.roll_axis[body], lever)
        part[:, 5] = np.einsum("ij,ij->i", found.axes[body, 1], lever)
        self.matrix.reshape(-1)[self._flat_both] = part

    def jacobian(self) -> tuple[Vector, Vector, Vector]:
        """Of the generalised force of the last step by q, v and series forces, nearly.

        How the elements' directions turn with the bodies is left out: [nv, nv], [nv, nv], [nv, n].
        """
        stiffness = self._stiffness.copy()
        for row, stop in self._stops:
            stiffness[row] += stop.slope(float(self.displacement[row]))
        by_q = -self.matrix.T @ (stiffness[:, None] * self.matrix)
        by_v = -self.matrix.T @ (self._damping[:, None] * self.matrix)
        return by_q, by_v, -self.matrix[self._series].T

    def series_jacobian(self) -> tuple[Vector, Vector]:
        """Of series_rates by v [n, nv] and by the series forces [n], a diagonal."""
        by_v = self._series_stiffness[:, None] * self.matrix[self._series]
        return by_v, -self._series_stiffness / self._series_damping

    def potential(self, series: Vector) -> float:
        """J, of springs, preloads and stops at the last step."""
        d = self.displacement
        springs = 0.5 * float(self._stiffness @ d**2) + float(self._preload @ d)
        stops = sum(stop.energy(float(d[row])) for row, stop in self._stops)
        return springs + stops + 0.5 * float(np.sum(series**2 / self._series_stiffness))

    def damping_power(self, series: Vector) -> float:
        """W, turned into heat by the dampers, >= 0, at the last step."""
        return float(self._damping @ self.rate**2) + float(np.sum(series**2 / self._series_damping))


class Stop:
    """A bump stop: point symmetric, a straight line between the points of its table and on after
    the last."""

    def __init__(self, rows: list[list[float]] | None) -> None:
        assert rows is not None
        points = np.array(rows, dtype=float)
        if points[0, 0] > 0:
            points = np.vstack([[0.0, 0.0], points])
        self._d, self._f = points.T
        self._slopes = np.diff(self._f) / np.diff(self._d)
        areas = 0.5 * (self._f[1:] + self._f[:-1]) * np.diff(self._d)
        self._areas = np.concatenate([[0.0], np.cumsum(areas)])

    def _part(self, size: float) -> int:
        last = len(self._slopes) - 1
        return min(int(np.searchsorted(self._d, size, side="right")) - 1, last)

    def force(self, d: float) -> float:
        """N, against the displacement (m)."""
        size = abs(d)
        if size <= self._d[0]:
            return 0.0
        k = self._part(size)
        return float(np.sign(d) * (self._f[k] + self._slopes[k] * (size - self._d[k])))

    def slope(self, d: float) -> float:
        """N/m."""
        return float(self._slopes[self._part(abs(d))])

    def energy(self, d: float) -> float:
        """J."""
        size = abs(d)
        k = self._part(size)
        away = size - self._d[k]
        return float(self._areas[k] + (self._f[k] + 0.5 * self._slopes[k] * away) * away)


def cross(a: Vector, b: Vector) -> Vector:
    """Of rows; numpy's is slow for few."""
    return a[:, [1, 2, 0]] * b[:, [2, 0, 1]] - a[:, [2, 0, 1]] * b[:, [1, 2, 0]]


def table_of(tables: list[ElementTable], along: str, about: str) -> Vector:
    """[2, elements, 3], of coefficients along and about the axes."""
    return np.array([[getattr(table, name) for table in tables] for name in (along, about)])


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
        for side, sign in SIDES:
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
        for side, sign in SIDES:
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
