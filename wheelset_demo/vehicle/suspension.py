"""All elements of a vehicle, in arrays: springs, dampers, rods, bump stops, sliders.

An element joins a point of body A to a point of body B, one and the same place in the vehicle at
rest. Its displacement is that of B's point seen from A, in A's axes,

    d = R_A^T (P_B - P_A),    d' = R_A^T (v_B - v_A(P_B)),

v_A(P_B) of A's material that is at P_B; turns are half the skew part of R_A^T R_B (small angles),
their rates those of the relative angular velocity. Each component of an element that has a
coefficient is a row:

    force on B = -(k d + c d' + preload + f + table(d) + j),
    f' = s (d' - f/c)                          damper c in series with a spring s,
    j = t (d - a) within -F ... F              slider with a spring t before it (Jenkins 1962),

and acts on A with the opposite force at the same point P_B, so that elements neither give nor take
momentum or moment of momentum. A slider moves on, a = d - j/t, once a time step, to where its force
left it; its limit F is a force and a share of what the element's vertical spring carries. With B
[rows, nv] from velocities to rates of the rows, the generalised force is B^T force. Preloads carry
the weight: see statics.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from railpatch import _core

from wheelset_demo.vehicle.elements import ElementTable, Stop
from wheelset_demo.vehicle.model import VehicleModel
from wheelset_demo.vehicle.scene import VehicleScene
from wheelset_demo.vehicle.statics import Statics

Vector = NDArray[np.float64]
Z = 2


class Suspension:
    """The elements of a scene. step() finds their forces, jacobian() how they change.

    Of the last step(), overwritten by the next: displacement, rate (m, m/s or rad, rad/s), force (N
    or N m), of the rows; matrix: [rows, nv]; series_rates: N/s; friction_force: N or N m, of the
    sliders. owners: [rows], index of a row's table in vehicle.element. statics: what the elements
    carry at rest.
    """

    def __init__(self, scene: VehicleScene, model: VehicleModel) -> None:
        """Raises CaseError where the elements do not hold or carry the bodies."""
        vehicle = scene.vehicle
        places = [
            (owner, place)
            for owner, element in enumerate(vehicle.element)
            for place in element.places
        ]
        index = {name: k for k, name in enumerate(model.bodies)}
        self._ends = np.array([[index[name] for name in place.between] for _, place in places])
        points = np.array([vehicle.place(*place.at) for _, place in places])
        self._at = [points - model.centres[self._ends[:, end]] for end in (0, 1)]
        self._model, self._width = model, model.model.nv
        self._rows(vehicle.element, np.array([owner for owner, _ in places]))
        self.statics = self._at_rest()
        self._preload = self.statics.preload
        self._core = self._compiled(self._preload)
        self.matrix, self.series_rates = self._core.matrix, self._core.series_rates
        self.displacement, self.rate = self._core.displacement, self._core.rate
        self.force, self._generalised = self._core.force, self._core.generalised
        self.friction_force, self._anchor = self._core.friction_force, self._core.anchor

    def _compiled(self, preload: Vector) -> _core.Suspension:
        """The elements' forces, ready to be asked for at every step."""
        rows = np.stack([self._element, self._axis, self._about], axis=1)
        return _core.Suspension(
            self._width,
            self._model.columns.astype(np.int64),
            self._model.arms,
            self._ends.astype(np.int64),
            *self._at,
            rows.astype(np.int64),
            np.stack([self._stiffness, self._damping, preload], axis=1),
            self._series.astype(np.int64),
            np.stack([self._series_stiffness, self._series_damping], axis=1),
            [(row, *stop.points) for row, stop in self._stops],
            self._friction_rows.astype(np.int64),
            self._friction,
        )

    def _at_rest(self) -> Statics:
        """Preloads and what wheelsets carry."""
        core = self._compiled(np.zeros(len(self._stiffness)))
        core.step(self._model.rest, np.zeros(self._width), np.zeros(len(self._series)))
        return Statics(self._model, core.matrix.copy(), self._stiffness, self._with_sliders())

    def _with_sliders(self) -> Vector:
        """N/m, N m/rad, [rows], of springs and of sliders that stick."""
        found = self._stiffness.copy()
        np.add.at(found, self._friction_rows[:, 0], self._friction[:, 0])
        return found

    def _rows(self, elements: list[ElementTable], owners: NDArray[np.int64]) -> None:
        """Picks the components with a coefficient. owners: [elements], of each its table."""
        tables = [elements[owner] for owner in owners]

        def both(along: str, about: str) -> Vector:
            return np.array([[getattr(t, name) for t in tables] for name in (along, about)])

        stiffness = both("stiffness", "turning_stiffness")
        damping = both("damping", "turning_damping")
        sliders = both("friction_stiffness", "turning_friction_stiffness")
        limits = both("friction_force", "turning_friction_moment")
        series, shares = np.zeros_like(stiffness), np.zeros_like(stiffness)
        series[0] = [table.series_stiffness for table in tables]
        shares[0] = [table.friction_coefficient for table in tables]
        stopped = np.zeros(stiffness.shape, dtype=bool)
        for axis in range(3):
            stopped[0, :, axis] = [table.curve(axis) is not None for table in tables]
        used = (stiffness > 0) | (damping > 0) | (sliders > 0) | stopped
        self._about, self._element, self._axis = np.nonzero(used)
        self.owners = owners[self._element]
        self._stiffness = stiffness[used]
        in_series = series[used] > 0
        self._series = np.flatnonzero(in_series)
        self._series_stiffness = series[used][in_series]
        self._series_damping = damping[used][in_series]
        self._damping = np.where(in_series, 0.0, damping[used])
        self._stops = []
        for row in np.flatnonzero(stopped[used]).tolist():
            curve = tables[self._element[row]].curve(int(self._axis[row]))
            assert curve is not None
            self._stops.append((row, Stop(curve)))
        rows = np.flatnonzero(sliders[used] > 0)
        numbers = np.full(used.shape, -1)
        numbers[used] = np.arange(len(self._element))
        # that of the vertical spring of the same element; of a slider without a share its own
        carrying = numbers[0, self._element[rows], Z]
        carrying = np.where(shares[used][rows] > 0, carrying, rows)
        self._friction_rows = np.stack([rows, carrying], axis=1)
        self._friction = np.stack([each[used][rows] for each in (sliders, limits, shares)], axis=1)

    @property
    def compiled(self) -> _core.Suspension:
        """The same in C++, for what is compiled beside it."""
        return self._core

    @property
    def damping_power(self) -> float:
        """W, >= 0, turned into heat by dampers and sliders at the last step()."""
        return self._core.damping_power

    @property
    def series_count(self) -> int:
        """Number of dampers with a spring in series, each of which has a force as its state."""
        return len(self._series)

    def step(self, q: Vector, v: Vector, series: Vector) -> Vector:
        """[nv], generalised forces. series: N, forces of dampers with springs in series."""
        self._core.step(q, v, series)
        return self._generalised.copy()

    def settle(self) -> None:
        """Sliders stay where the last step() moved them to: once a time step."""
        self._core.settle()

    def release(self) -> None:
        """Sliders' springs are without force at the displacements of the last step()."""
        self._anchor[:] = self.displacement[self._friction_rows[:, 0]]

    def jacobian(self) -> tuple[Vector, Vector, Vector]:
        """Of the generalised force of the last step by q, v and series forces, nearly.

        How the elements' directions turn with the bodies is left out, and sliders stick: [nv, nv],
        [nv, nv], [nv, n].
        """
        stiffness = self._with_sliders()
        for row, stop in self._stops:
            stiffness[row] += stop.slope(float(self.displacement[row]))
        by_q = -self.matrix.T @ (stiffness[:, None] * self.matrix)
        by_v = -self.matrix.T @ (self._damping[:, None] * self.matrix)
        return by_q, by_v, -self.matrix[self._series].T

    def stuck(self) -> Vector:
        """[nv, nv], N/m and the like: stiffness of sliders that stick, at the last step()."""
        rows = self.matrix[self._friction_rows[:, 0]]
        found: Vector = rows.T @ (self._friction[:, :1] * rows)
        return found

    def series_jacobian(self) -> tuple[Vector, Vector]:
        """Of series_rates by v [n, nv] and by the series forces [n], a diagonal."""
        by_v = self._series_stiffness[:, None] * self.matrix[self._series]
        return by_v, -self._series_stiffness / self._series_damping

    def potential(self, series: Vector) -> float:
        """J, of springs, preloads, stops and the sliders' springs at the last step."""
        d = self.displacement
        springs = 0.5 * float(self._stiffness @ d**2) + float(self._preload @ d)
        stops = sum(stop.energy(float(d[row])) for row, stop in self._stops)
        sliders = 0.5 * float(np.sum(self.friction_force**2 / self._friction[:, 0]))
        dampers = 0.5 * float(np.sum(series**2 / self._series_stiffness))
        return springs + stops + sliders + dampers
