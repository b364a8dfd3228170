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

import numpy as np
from numpy.typing import NDArray
from railpatch import _core

from wheelset_demo.vehicle.elements import Place, Stop, centres_at_rest, places_of, preloads
from wheelset_demo.vehicle.model import VehicleModel
from wheelset_demo.vehicle.scene import ElementTable, VehicleScene, VehicleTable

Vector = NDArray[np.float64]
Y, Z = 1, 2


class Suspension:
    """The elements of a scene. step() finds their forces, jacobian() how they change.

    Of the last step(), overwritten by the next: displacement, rate (m, m/s or rad, rad/s), force (N
    or N m), of the rows; matrix: [rows, nv]; series_rates: N/s. damping_power: W, >= 0, turned into
    heat by the dampers.
    """

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
        self.damping_power = 0.0
        self._rows(places, scene.vehicle)
        self._core = self._compiled(model.model.nv)
        self.matrix, self.series_rates = self._core.matrix, self._core.series_rates
        self.displacement, self.rate = self._core.displacement, self._core.rate
        self.force, self._generalised = self._core.force, self._core.generalised

    def _compiled(self, width: int) -> _core.Suspension:
        """The elements' forces, ready to be asked for at every step."""
        columns = self._columns.astype(np.int64)
        rows = np.stack([self._element, self._axis, self._about], axis=1)
        return _core.Suspension(
            width,
            columns,
            self._arms,
            np.stack([self._a, self._b], axis=1).astype(np.int64),
            self._at_a,
            self._at_b,
            rows.astype(np.int64),
            np.stack([self._stiffness, self._damping, self._preload], axis=1),
            self._series.astype(np.int64),
            np.stack([self._series_stiffness, self._series_damping], axis=1),
            [(row, *stop.points) for row, stop in self._stops],
        )

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
        self._about = kind
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

    @property
    def series_count(self) -> int:
        """Number of dampers with a spring in series, each of which has a force as its state."""
        return len(self._series)

    def step(self, q: Vector, v: Vector, series: Vector) -> Vector:
        """[nv], generalised forces. series: N, forces of dampers with springs in series."""
        self.damping_power = self._core.step(q, v, series)
        return self._generalised.copy()

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


def table_of(tables: list[ElementTable], along: str, about: str) -> Vector:
    """[2, elements, 3], of coefficients along and about the axes."""
    return np.array([[getattr(table, name) for table in tables] for name in (along, about)])
