"""The equations of motion: vehicle, suspension, track and contacts.

    y = (q [n], v [n], forces of dampers with springs in series [m]),    y' = f(y, u),

with the coordinates of the track below the rails, where there are any, at the end of q and v
(wheelset_demo.vehicle.support), and

u [3 wheels] the rails' lateral and vertical deviations at the wheels and their vertical rates. They
follow from where the wheelsets are: they are known ahead, and the time steppers use that.
"""

from __future__ import annotations

import math
import time as clock
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray
from railpatch import CaseError, _core
from railpatch.case.types import SIDES
from railpatch.pinocchio import ForceElement, StateChain, acceleration_derivatives
from railpatch.pinocchio.derivative import WrenchDerivatives

from wheelset_demo.system import BAD, ContactFailure, no_forces
from wheelset_demo.vehicle.alignment import Alignment
from wheelset_demo.vehicle.deviations import deviations_of
from wheelset_demo.vehicle.drives import Drives
from wheelset_demo.vehicle.irregularity import ARM
from wheelset_demo.vehicle.model import vehicle_model
from wheelset_demo.vehicle.scene import VehicleScene
from wheelset_demo.vehicle.slope import slope_wrenches
from wheelset_demo.vehicle.support import Support
from wheelset_demo.vehicle.suspension import Suspension
from wheelset_demo.vehicle.wet_track import WetTrack

Vector = NDArray[np.float64]
# columns of a wheelset's state that a rail's lateral and vertical deviations and its vertical rate
# move against
LATERAL, VERTICAL, RATE = 1, 2, 8
# of a wrench, what rails that are not level add: along the track, about y and z
FORCE_AND_TURNS = [0, 4, 5]


@dataclass(frozen=True)
class VehicleState:
    """time: s. values: [2 n + m], coordinates, velocities, forces of dampers with springs in series
    (N). work: [4 + wheels], J, since the start: by WORKS, then of friction at each wheel, left and
    right of the first wheelset first. count: n, of the coordinates."""

    time: float
    values: Vector
    work: Vector
    count: int

    @property
    def q(self) -> Vector:
        """[n], m, rad: see wheelset_demo.vehicle.model."""
        return self.values[: self.count]

    @property
    def v(self) -> Vector:
        """[n], m/s, rad/s."""
        return self.values[self.count : 2 * self.count]

    @property
    def series(self) -> Vector:
        """[m], N."""
        return self.values[2 * self.count :]


@dataclass(frozen=True)
class Rates:
    """values: [2 n + m], of a state's. powers: [4 + wheels], W, as of a state's work. inputs: [3
    wheels], m, m/s, the rails' deviations at the wheels and their vertical rates. status: of the
    contacts."""

    values: Vector
    powers: Vector
    inputs: Vector
    status: str


class HeldDerivatives:
    """Of the contacts' wrenches, some of an earlier state. by_side: [wheelsets, 2, 6, 12]."""

    def __init__(self, element: ForceElement) -> None:
        self._element = element
        self.by_side = np.zeros((len(element.joints), 2, 6, 12))

    def renew(self, wheelsets: Iterable[int]) -> None:
        """Those of the last step. Raises CaseError."""
        for k in wheelsets:
            self.by_side[k] = self._element.derivatives_by_side(k)

    def wrench_derivatives(self, chain: StateChain) -> list[WrenchDerivatives]:
        """As railpatch.pinocchio.acceleration_derivatives() wants them."""
        wrenches = self._element.contact_wrench
        return [
            chain.of(self._element, k).wrench(wrenches[k], self.by_side[k].sum(axis=0))
            for k in range(len(wrenches))
        ]


class VehicleSystem:
    """Vehicle, suspension, track and contacts of a scene. Keeps the contacts' last solutions.

    wheelsets: their number; radii: m, nominal, of their wheels; hold_arm: m, below the reference
    body's centre, where its speed is held. slope_wrenches: [wheelsets, 2, 3], of left and right
    wheel at the last rates(), Fx (N), My, Mz (N m) in track axes: of rails that are not level,
    beside the element's wrenches. evaluations, renewals: number of rates() and of derivatives().
    contact_seconds, derivative_seconds: s, CPU time of the calling thread in the force element and
    in derivatives(); further threads: element.helper_seconds.
    """

    def __init__(self, scene: VehicleScene) -> None:
        """Raises CaseError, ProfileError."""
        self.scene = scene
        self.vehicle = vehicle_model(scene)
        self.model = self.vehicle.model
        self.data = self.model.createData()
        self.alignment = Alignment(scene.alignment, scene.length)
        self.irregularity = deviations_of(
            scene.irregularity, scene.dip, scene.length, scene.vehicle.length, scene.recorded
        )
        names = [axle.name for axle in scene.vehicle.axles]
        self.wheelsets = len(names)
        cases = scene.cases(derivatives=True)
        self.element = ForceElement(self.model, names, cases, threads=scene.run.threads)
        self.radii = np.array([one.case.wheelset.nominal_radius for one in cases])
        self.suspension = Suspension(scene, self.vehicle)
        self.support = None if scene.support is None else Support(scene.support, self.wheelsets)
        self.wet = WetTrack.of(scene.wet, scene.case.fluid, scene.length, self.wheelsets)
        self.count = self.model.nv + (0 if self.support is None else self.support.count)
        self.size = 2 * self.count + self.suspension.series_count
        self.course = self._course()
        self.positions = self.course.positions
        self.evaluations = self.renewals = 0
        self.contact_seconds = self.derivative_seconds = 0.0
        self._fext = no_forces(self.model)
        self._joints = [self.vehicle.joints[name] for name in names]
        self._car = self.vehicle.columns[0]
        self.drives = Drives(scene.vehicle.drive, self.vehicle, self.radii)
        height = scene.vehicle.bodies[0].position[2]
        held = scene.vehicle.hold_height
        # m, below the centre: where the force acts that holds the speed
        self.hold_arm = 0.0 if held is None else height - held
        self._control = np.zeros(self.model.nv)
        self.slope_wrenches = np.zeros((self.wheelsets, 2, 3))
        self._slopes = self.course.slopes.reshape(-1, 2, 2)
        self._sloped = np.zeros((self.wheelsets, 6))
        rails = self.element.rails.reshape(self.wheelsets, -1)
        self._known = self.course.inputs, self.course.ahead, self.course.bend
        self._placed = self.element.tracks, rails
        self._held = HeldDerivatives(self.element)

    def rates(self, time: float, values: Vector) -> Rates:
        """At a time (s) and values [2 n + m]. Raises ContactFailure."""
        n, nv = self.count, self.model.nv
        q, v, series = values[:nv], values[n : n + nv], values[2 * n :]
        pin.forwardKinematics(self.model, self.data, q, v)
        inputs = self.place_track(q, v)
        if self.support is not None:
            self.support.put_rails(values[nv:n], values[n + nv : 2 * n], self.element.rails)
        for joint in self._joints:
            self._fext[joint].setZero()
        self.evaluations += 1
        begin = clock.thread_time()
        try:
            status = self.element.step(self.data, self._fext)
        except CaseError as error:
            # far off the rails, or not a number
            raise ContactFailure(time, float(self.positions[0]), str(error)) from None
        self.contact_seconds += clock.thread_time() - begin
        if status in BAD:
            raise ContactFailure(time, float(self.positions[0]), self.statuses())
        contact = self.element.contact_power + self._add_slope_wrenches()
        tau = self.suspension.step(q, v, series)
        drive = self._drive(q, v, tau)
        if self.drives:
            drive += self.drives.add(q, v, tau)
        acceleration = pin.aba(self.model, self.data, q, v, tau, self._fext)
        damping = self.suspension.damping_power
        if self.support is not None:
            below, on_rails = self.support.step(self.element.wheels)
            acceleration = np.concatenate([acceleration, below])
            contact += on_rails
            damping += self.support.damping_power
        found = np.concatenate([values[n : 2 * n], acceleration, self.suspension.series_rates])
        friction = self.element.wheels[:, :, 6].ravel()
        powers = np.array([contact, friction.sum(), damping, drive, *friction])
        return Rates(found, powers, inputs, status)

    def _course(self) -> _core.Course:
        """The track and its rails, ready to be asked for at every step."""
        straight = np.zeros(0), np.zeros((4, 0, 8))
        rails = straight if self.irregularity is None else self.irregularity.pieces
        columns = self.vehicle.carriers[:, :2].astype(np.int64)
        return _core.Course(*self.alignment.pieces, *rails, columns, ARM, self.model.nv)

    def place_track(self, q: Vector, v: Vector) -> Vector:
        """Puts track frames under the wheelsets, rails into them; [3 wheels], the inputs."""
        self.course.place(q, v, *self._placed)
        self.element.positions[:] = self.positions
        if self.wet is not None:
            self.wet.put(self.positions, self.element.water)
        return self._known[0].copy()

    def _add_slope_wrenches(self) -> float:
        """Of rails that are not level, on the wheelsets, see slope; their power (W)."""
        if self.course.level:
            self.slope_wrenches = np.zeros((self.wheelsets, 2, 3))
            return 0.0
        element = self.element
        self.slope_wrenches = slope_wrenches(
            element.wheels, element.lateral_normals, self._slopes, self.radii, ARM
        )
        self._sloped[:, FORCE_AND_TURNS] = self.slope_wrenches.sum(axis=1)
        return element.place_all(self._sloped, self._fext)

    def look_ahead(self, values: Vector, step: float) -> tuple[Vector, Vector]:
        """[3 wheels] each, of what is known ahead: the inputs where the wheelsets will be in
        ``step`` s, and second differences of the rails' places under them over as long.

        These are by the track's own way in the world: the curve's turning off, the change of cant.
        In track axes, as the inputs; that of rates is none. values: whose rates were the last ones.
        """
        self.course.look_ahead(values[self.count : self.count + self.model.nv], step)
        return self._known[1].copy(), self._known[2]

    def derivatives(self, values: Vector, wheelsets: Iterable[int]) -> tuple[Vector, Vector]:
        """Of the rates at values whose rates were the last ones asked for, nearly.

        [size, size] by the values and [size, 3 wheels] by the inputs. wheelsets: whose contacts'
        derivatives are found anew, exact or by differences, as Contact.jacobian() says; those of
        the others are held. How the track frame turns on along the track is left out, and so are
        the forces of slopes, some thousandth of the contacts'. Raises CaseError.
        """
        begin = clock.thread_time()
        self.renewals += 1
        n, nv, suspension = self.count, self.model.nv, self.suspension
        q, v, bodies = values[:nv], values[n : n + nv], slice(n, n + nv)
        tau = self.suspension.matrix.T @ self.suspension.force
        self._drive(q, v, tau)
        if self.drives:
            self.drives.add(q, v, tau)
        self._held.renew(wheelsets)
        found = acceleration_derivatives(self.model, self.data, q, v, tau, self._fext, [self._held])
        upper = np.triu(self.data.Minv)
        inverse = upper + np.triu(upper, 1).T
        by_q, by_v, by_series = suspension.jacobian()
        control = self._ahead(q)
        by_v = by_v - self.scene.run.speed_control * np.outer(control, control)
        matrix = np.zeros((self.size, self.size))
        matrix[:n, n : 2 * n] = np.eye(n)
        matrix[bodies, :nv] = found.by_q + inverse @ by_q
        matrix[bodies, bodies] = found.by_v + inverse @ by_v
        matrix[bodies, 2 * n :] = inverse @ by_series
        series_by_v, series_by_series = suspension.series_jacobian()
        matrix[2 * n :, bodies] = series_by_v
        matrix[2 * n :, 2 * n :] = np.diag(series_by_series)
        inputs = np.zeros((self.size, 6 * self.wheelsets))
        inputs[bodies] = inverse @ self._force_by_rails(found.chain)
        if self.support is not None:
            self.support.fill(
                matrix, inputs, inverse, self.element, self._held.by_side, found.chain
            )
        self.derivative_seconds += clock.thread_time() - begin
        return matrix, inputs

    def _force_by_rails(self, chain: StateChain) -> Vector:
        """[nv, 3 wheels], of the generalised force by the inputs."""
        deviations, rates = [], []
        for k in range(self.wheelsets):
            state = chain.of(self.element, k)
            jacobian = chain.jacobian(self.element.joints[k])
            for by_wheel in self._held.by_side[k]:
                # a rail that moves is a wheel that moves the other way
                lateral, vertical, rate = (
                    -jacobian.T @ state.turned(by_wheel[:, column])
                    for column in (LATERAL, VERTICAL, RATE)
                )
                deviations += [lateral, vertical]
                rates.append(rate)
        return np.array(deviations + rates).T

    def _ahead(self, q: Vector) -> Vector:
        """[nv], of the speed that is held: ahead, by the body of reference, in the velocities;
        overwritten by the next."""
        yaw = float(q[self._car[3]])
        self._control[self._car[:2]] = math.cos(yaw), math.sin(yaw)
        self._control[self._car[5]] = self.hold_arm
        return self._control

    def _drive(self, q: Vector, v: Vector, tau: Vector) -> float:
        """Adds the force that holds the speed to the generalised force; its power (W)."""
        ahead = self._ahead(q)
        speed = float(ahead @ v)
        force = self.scene.run.speed_control * (self.scene.speed - speed)
        tau += force * ahead
        return force * speed

    def statuses(self) -> str:
        """How the last contacts of each wheelset ended."""
        found = []
        for k in range(self.wheelsets):
            result = self.element.result(k)
            for side in SIDES:
                if result[side]["status"] in BAD:
                    found.append(
                        f"wheelset {k + 1}, {side} wheel {result[side]['status']}: "
                        f"{result[side]['reason']}"
                    )
        return ", ".join(found)

    def stored(self, state: VehicleState) -> Vector:
        """J, [4]: kinetic, gravity, suspension, elastic energy of pressure in the contacts, of a
        state whose rates were the last ones asked for. The track's below the rails are part of the
        first and the third."""
        nv = self.model.nv
        moving, springs = (0.0, 0.0) if self.support is None else self.support.energies()
        q, v = state.q[:nv], state.v[:nv]
        return np.array(
            [
                pin.computeKineticEnergy(self.model, self.data, q, v) + moving,
                pin.computePotentialEnergy(self.model, self.data, q),
                self.suspension.potential(state.series) + springs,
                self.element.pressure_energy,
            ]
        )

    def body_poses(self) -> dict[str, tuple[Vector, Vector]]:
        """Rotation [3, 3] and place [3] (m) of each body in the world, at the last rates()."""
        placed = self.data.oMi
        return {
            name: (placed[joint].rotation.copy(), placed[joint].translation.copy())
            for name, joint in self.vehicle.joints.items()
        }

    @property
    def reference(self) -> str:
        """Name of the body that is held at speed and whose accelerations are told."""
        return self.vehicle.bodies[0]
