"""Hunting of a whole vehicle: eigenvalues of its equations of motion, straight on.

The vehicle rolls straight and level at a speed, at rest but for that: with the coordinates at which
no body is accelerated, found by Newton's method. Its equations are linearised there with the
contacts' derivatives, those of the suspension by central differences of its forces (preloads that
turn with the bodies are in them) and Pinocchio's of the bodies. Sliders stick, for motions are
small, or slip, then with their stiffness left out. Drives are left out. Rolling on and the wheels'
angles, on which nothing depends, are taken out; lateral waves are those in which some wheelset
moves more across the track than any goes up and down.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property, partial

import numpy as np
from numpy.typing import NDArray
from railpatch.errors import CaseError

from wheelset_demo.hunting import Mode, Search, mode_of, search
from wheelset_demo.scene import refuse_bulk, refuse_changes
from wheelset_demo.vehicle.alignment import AlignmentTable
from wheelset_demo.vehicle.scene import RunTable, VehicleScene
from wheelset_demo.vehicle.simulation import at_start
from wheelset_demo.vehicle.system import VehicleSystem

Vector = NDArray[np.float64]
# of Newton's method for the state without accelerations: m/s^2 and rad/s^2; most steps
TOLERANCE = 1e-5
# (sliders that let go after each step make them halve what is left every eight)
MOST_STEPS = 300
# what the contacts' tolerance may leave: 1e-6 of a wheel's 100 kN is 1e-4 m/s^2 of 1,000 kg
ACCEPTED = 1e-4
# of contacts, for their derivatives
CLOSE = 1e-6
# m, rad, of central differences of the suspension's forces
SHIFT = 1e-6


def straight(scene: VehicleScene, speed: float) -> VehicleScene:
    """The scene straight, level and without drives, at a speed (m/s). Raises CaseError."""
    run = "the search for a hunting speed"
    refuse_bulk(scene.case, run)
    refuse_changes(scene.case, run)
    if scene.wet:
        raise CaseError(
            f"wet: given, allowed to be left out: {run} has one place along the track, with "
            "fluid.water_rate"
        )
    wheelset = scene.case.wheelset.model_copy(update={"speed": speed})
    method = scene.case.method
    method = method.model_copy(update={"tolerance": min(method.tolerance, CLOSE)})
    # something has to hold the speed
    hold = scene.run.speed_control or RunTable.model_fields["speed_control"].default
    return replace(
        scene,
        case=scene.case.model_copy(update={"wheelset": wheelset, "method": method}),
        run=scene.run.model_copy(update={"speed_control": hold}),
        vehicle=scene.vehicle.model_copy(update={"drive": []}),
        alignment=AlignmentTable(),
        irregularity=None,
        dip=(),
        measured_track=None,
        measured=None,
    )


def left_out(scene: VehicleScene) -> list[str]:
    """The scene's tables of which straight() takes nothing."""
    given = {
        "alignment": scene.alignment.radius is not None or scene.alignment.section is not None,
        "irregularity": scene.irregularity is not None,
        "measured_track": scene.measured_track is not None,
        "dip": bool(scene.dip),
        "vehicle.drive": bool(scene.vehicle.drive),
    }
    return [name for name, there in given.items() if there]


@dataclass
class Linearised:
    """A vehicle that runs straight on. scene: as straight() gives it. slip: sliders slip."""

    scene: VehicleScene
    slip: bool = False

    @cached_property
    def system(self) -> VehicleSystem:
        """Its rates were last asked for at values."""
        return VehicleSystem(self.scene)

    @cached_property
    def values(self) -> Vector:
        """The state at which nothing is accelerated. Raises CaseError, ContactFailure."""
        system = self.system
        values = at_start(self.scene, system).values
        nv, n = system.model.nv, system.count
        rates = system.rates(0.0, values).values
        system.suspension.release()
        # what may change: all places but the wheels' angles and the way, spins, the common speed
        ahead, spins = system.vehicle.ahead, system.vehicle.spins
        free = np.setdiff1d(np.arange(n), [*spins, ahead[0]])
        unknown = np.concatenate([free, n + spins])
        together = np.unique(n + ahead)
        least, best = np.inf, values.copy()
        for _ in range(MOST_STEPS):
            residual = rates[n : 2 * n]
            left = float(np.abs(residual).max())
            if left < TOLERANCE:
                return values
            if left < least:
                least, best = left, values.copy()
            matrix, _ = system.derivatives(values, range(system.wheelsets))
            common = matrix[n : 2 * n, together].sum(axis=1)
            slope = np.column_stack([matrix[n : 2 * n, unknown], common])
            scale = np.abs(slope).max(axis=1)
            change, *_ = np.linalg.lstsq(slope / scale[:, None], -residual / scale, rcond=1e-12)
            values[unknown] += change[:-1]
            values[together] += change[-1]
            rates = system.rates(0.0, values).values
            system.suspension.release()
        if least < ACCEPTED:
            system.rates(0.0, best)
            system.suspension.release()
            return best
        worst = int(np.argmax(np.abs(rates[n : n + nv])))
        raise CaseError(
            f"vehicle: {system.vehicle.spell(worst)} is accelerated by {rates[n + worst]:.3g} "
            f"(m/s^2 or rad/s^2) straight on, allowed {ACCEPTED:g}: a vehicle that stands straight"
        )

    @cached_property
    def _kept(self) -> Vector:
        """Indices of the state that waves depend on."""
        system = self.system
        gone = [*system.vehicle.spins, system.vehicle.ahead[0]]
        return np.setdiff1d(np.arange(system.size), gone)

    @cached_property
    def matrix(self) -> Vector:
        """[m, m], of the rates."""
        values, system = self.values, self.system
        n, nv, suspension = system.count, system.model.nv, system.suspension
        q, v, series = values[:nv], values[n : n + nv], values[2 * n :]
        matrix, _ = system.derivatives(values, range(system.wheelsets))
        upper = np.triu(system.data.Minv)
        inverse = upper + np.triu(upper, 1).T
        nearly = suspension.jacobian()[0]
        force, rates = np.zeros((nv, nv)), np.zeros((len(series), nv))
        for k in range(nv):
            for sign in (1.0, -1.0):
                moved = q.copy()
                moved[k] += sign * SHIFT
                force[:, k] += sign * suspension.step(moved, v, series)
                rates[:, k] += sign * suspension.series_rates
        suspension.step(q, v, series)
        exact = force / (2 * SHIFT)
        if self.slip:
            exact += suspension.stuck()
        matrix[n : n + nv, :nv] += inverse @ (exact - nearly)
        matrix[2 * n :, :nv] += rates / (2 * SHIFT)
        # along the track only differences count: places from that of the body of reference
        ahead = system.vehicle.ahead
        ahead = np.setdiff1d(ahead, ahead[:1])
        matrix[ahead] -= matrix[system.vehicle.ahead[0]]
        found: Vector = matrix[np.ix_(self._kept, self._kept)]
        return found

    def lateral(self, shape: Vector) -> bool:
        """Whether a wave of this shape is one across the track."""
        full = np.zeros(self.system.size)
        full[self._kept] = shape
        columns = self.system.vehicle.carriers
        return bool(full[columns[:, 1]].max() > full[columns[:, 2]].max())

    def moves(self, mode: Mode) -> dict[str, float]:
        """Of a mode: how far bodies and wheelsets move across the track, the greatest 1."""
        full = np.zeros(self.system.size)
        full[self._kept] = mode.share
        vehicle = self.system.vehicle
        found = {
            name: float(full[columns[1]])
            for name, columns in zip(vehicle.bodies, vehicle.columns, strict=True)
            if not name.startswith("axle_box_")
        }
        most = max(found.values())
        return {name: size / most for name, size in found.items()} if most > 0 else found


def vehicle_mode(scene: VehicleScene, speed: float, slip: bool = False) -> Mode:
    """The lateral wave that grows fastest, or dies most slowly, at a speed (m/s).

    slip: sliders slip. Raises CaseError, ContactFailure.
    """
    found = Linearised(straight(scene, speed), slip)
    return mode_of(found.matrix, speed, found.lateral)


def search_vehicle(
    scene: VehicleScene, lowest: float, highest: float, slip: bool = False
) -> Search:
    """Between two speeds (m/s), up to the critical one. Raises CaseError, ContactFailure."""
    return search(partial(vehicle_mode, scene, slip=slip), lowest, highest)


def moves_at(scene: VehicleScene, speed: float, slip: bool = False) -> dict[str, float]:
    """Linearised.moves() of vehicle_mode()."""
    found = Linearised(straight(scene, speed), slip)
    return found.moves(mode_of(found.matrix, speed, found.lateral))
