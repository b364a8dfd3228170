"""The force element: wheel-rail contact of a Pinocchio model's wheelsets."""

from __future__ import annotations

import math
import struct
from collections.abc import Sequence
from numbers import Real
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from railpatch import _core
from railpatch.case.fluid import changes_with_time
from railpatch.case.load import Scene
from railpatch.case.to_core import POSE_AND_VELOCITY, input_of
from railpatch.case.types import SIDES, show
from railpatch.case.wheel import WheelsetCase
from railpatch.contact import CaseSource, Contact
from railpatch.errors import CaseError
from railpatch.pinocchio.derivative import (
    Matrix,
    StateChain,
    WrenchDerivatives,
    angular_velocity,
)
from railpatch.pressure_error import run_doubts
from railpatch.result import SOLVED, Result

# names of the rows of `states`, in order
STATE = POSE_AND_VELOCITY
# of the core, by code; a test compares them
STATUSES = (
    "converged",
    "no_contact",
    "not_converged",
    "out_of_range",
    "accuracy_not_met",
    "work_spent",
)
PATCHES = ("patches", "alternatives")
LENGTH = struct.Struct("<I")


class ForceElement:
    """Contact forces on the wheelsets of a model, all wheels in one call of the library.

        pin.forwardKinematics(model, data, q, v)
        fext = pin.StdVec_Force([pin.Force.Zero()] * model.njoints)
        status = element.step(data, fext)
        a = pin.aba(model, data, q, v, tau, fext)

    model: pinocchio.Model. joint: name or index of the joint whose body is the spinning wheelset,
    or a list of them. case: of kind "wheelset" with ``z`` given (its value is not used), as for
    Contact; or a list, one a joint. Position and velocity of the case are replaced at each step;
    deviations of wheels and rails and the roller's speed stay.

    wheelset: pinocchio.SE3, of the wheelset (origin at its centre, y along the axle to the right)
    in the joint frame. track: pinocchio.SE3, of the track frame (x forward, y right, z down) in the
    world. frame_speed: m/s, of an inertial world frame that moves forward along the track.
    folder: where relative paths of a case start. timing: measure the stages, see Contact. threads:
    that solve the wheelsets of a step side by side; results do not depend on their number.

    A track that bends, or rails that are not straight, are told before a step, for each wheelset:
    see `tracks`, `positions` and `rails`.

    Only position, velocity and axle direction of the wheelset are used, so any carrier will do. Let
    a revolute joint about the axle do the spinning and a carrier that does not spin (a composite as
    in wheelset_model(), a free-flyer, an axle box) hold it: a wheelset that is one body on a bare
    free-flyer integrates badly, because its steps are then taken along axes that turn with the
    wheel, at some hundred radians a second in a fast train.

    Raises CaseError for a case that does not fit, ValueError for a joint that the model lacks.
    """

    def __init__(
        self,
        model: pin.Model,
        joint: str | int | Sequence[str | int],
        case: CaseSource | Sequence[CaseSource],
        *,
        wheelset: pin.SE3 | None = None,
        track: pin.SE3 | None = None,
        frame_speed: float = 0.0,
        folder: str | Path | None = None,
        timing: bool = False,
        threads: int = 1,
    ) -> None:
        if isinstance(threads, bool) or not isinstance(threads, int) or not 1 <= threads <= 256:
            raise CaseError(f"threads: value is {show(threads)}, allowed 1 to 256")
        joints = joint if isinstance(joint, (list, tuple)) else [joint]
        cases = case if isinstance(case, (list, tuple)) else [case] * len(joints)
        if len(cases) != len(joints):
            raise CaseError(f"case: value is a list of {len(cases)}, allowed {len(joints)}")
        self.joints = [joint_index(model, name) for name in joints]
        for at, (name, index) in enumerate(zip(joints, self.joints, strict=True)):
            if index in self.joints[:at]:
                raise ValueError(f"joint: value is {name!r} twice, allowed once: one wheelset each")
        if not math.isfinite(frame_speed):
            raise CaseError(f"frame_speed: value is {show(frame_speed)}, allowed a finite number")
        self.contacts = [Contact(one, folder=folder, timing=timing) for one in cases]
        for contact in self.contacts:
            check_case(contact.case)
            if contact.case.track.irregularity is not None:
                raise CaseError("track.irregularity: given, allowed in a multibody model none")
        self._stores = [changes_with_time(contact.case) for contact in self.contacts]
        self.frame_speed = float(frame_speed)
        self.wheelset = pin.SE3.Identity() if wheelset is None else wheelset
        self._core = _core.ForceElement(
            [contact._core for contact in self.contacts],
            [input_of(contact.case) for contact in self.contacts],
            np.array([contact.case.wheelset.nominal_radius for contact in self.contacts]),
            placements([self.wheelset] * len(joints)),
            placements([track] * len(joints)),
            self.frame_speed,
            threads,
            [contact.case.method.reference_surface == "curved" for contact in self.contacts],
        )
        self._tracks, self._rails = self._core.tracks, self._core.rails
        # of each wheelset, and the number of solves at which they were found
        self._derivatives = [(-1, np.zeros((2, 6, len(STATE)))) for _ in self.joints]
        self._joint_count = model.njoints
        self._states, self._power = self._core.state, self._core.power
        self._wheels = self._core.wheels.reshape(-1, 2, 9)
        self._contact_wrench, self._lateral = self._core.contact, self._core.lateral
        self._placed = self._core.placed
        motion, wrench = self._core.motion, self._core.wrench
        self._rows = [
            (
                index,
                motion[row, :9].reshape(3, 3),
                motion[row, 9:12],
                motion[row, 12:],
                wrench[row],
            )
            for row, index in enumerate(self.joints)
        ]

    def step(self, data: pin.Data, fext: pin.StdVec_Force) -> str:
        """Adds the contact forces to ``fext`` and returns the worst status of all wheelsets.

        data: with oMi and v of forwardKinematics(model, data, q, v) or anything that calls it.
        fext: pinocchio.StdVec_Force with one entry for each joint of the model, in the local joint
        frame, linear part first (N, N m). "no_contact" (all wheels of a wheelset in the air) is a
        valid state, and so are "accuracy_not_met" and "work_spent", less accurate than the case
        asks for; after "not_converged" and "out_of_range" the forces are not to be trusted.
        Raises TypeError and ValueError for an fext of another type or length, which would crash
        Pinocchio, CaseError for a state outside the library's range (a roll of 90 degrees).
        """
        if type(fext) is not pin.StdVec_Force or len(fext) != self._joint_count:
            raise self._wrong(fext)
        placed, velocities = data.oMi, data.v
        if len(placed) != self._joint_count:
            raise ValueError(
                f"data: belongs to a model of {len(placed)} joints, allowed {self._joint_count}"
            )
        for joint, rotation, origin, velocity, _ in self._rows:
            placement = placed[joint]
            rotation[:] = placement.rotation
            origin[:] = placement.translation
            velocity[:] = velocities[joint].vector
        status = self._core.step()
        for joint, _, _, _, wrench in self._rows:
            vector = fext[joint].vector
            vector += wrench
        return STATUSES[status]

    def pass_time(self, seconds: float) -> None:
        """Lets time (s) go by before the next step, for the wheels' bulk temperatures and what
        cleans them.

        To be called once a time step of the run: forces may be asked for several times a step, and
        those after the first find the same temperatures. Wheels are warmed by the heat of the last
        step that was solved, as the case's [temperature.bulk] says; results have
        wheel_temperature. Cases without that table do not change with time. Raises CaseError for a
        negative time.
        """
        number = isinstance(seconds, Real) and not isinstance(seconds, bool)
        if not number or not 0 <= seconds < math.inf:
            raise CaseError(f"seconds: value is {show(seconds)}, allowed >= 0 and finite")
        if any(self._stores):
            self._core.pass_time(float(seconds))

    @property
    def compiled(self) -> _core.ForceElement:
        """The same in C++, for what is compiled beside it."""
        return self._core

    @property
    def changes_with_time(self) -> bool:
        """Whether pass_time() has something to do."""
        return any(self._stores)

    def place(self, index: int, force: Sequence[float], moment: Sequence[float]) -> NDArray:
        """[6], another wrench on a wheelset, as fext wants it, at the last step's position.

        force: [3], N; moment: [3], N m, about the wheelset's centre, both in track axes.
        """
        self._core.place(index, *force, *moment)
        return self._placed[index]

    def place_all(self, wrenches: NDArray[np.float64], fext: pin.StdVec_Force) -> float:
        """Adds another wrench on each wheelset to ``fext``, at the last step's positions; their
        power (W) at its velocities.

        wrenches: [wheelsets, 6], force (N) and moment (N m) about the wheelset's centre, track
        axes. fext: as for step().
        """
        power = self._core.place_all(wrenches)
        for joint, wrench in zip(self.joints, self._placed, strict=True):
            vector = fext[joint].vector
            vector += wrench
        return power

    def derivatives(self, index: int = 0) -> Matrix:
        """[6, 12], of a wheelset's contact_wrench at the last step by its state.

        Rows in N and N m, columns STATE. Exact, or by differences of further contact solves, as
        Contact.jacobian() says. Needs method.derivatives = true and a step; changes nothing. Raises
        CaseError, also where they did not converge.
        """
        left, right = self.derivatives_by_side(index)
        return left + right

    def derivatives_by_side(self, index: int = 0) -> Matrix:
        """[2, 6, 12], the same of left and right wheel."""
        self._check(index)
        solves, found = self._derivatives[index]
        if solves != self.solves:
            jacobian = self.contacts[index].jacobian()
            if jacobian["status"] not in SOLVED:
                raise CaseError(
                    f"method.tolerance: the contact's derivatives are {jacobian['status']}, "
                    "allowed a tolerance at which they converge"
                )
            found = np.array([jacobian[side] for side in SIDES])
            found.flags.writeable = False
            self._derivatives[index] = (self.solves, found)
        return found

    def wrench_derivatives(self, chain: StateChain) -> list[WrenchDerivatives]:
        """Of the wrenches on all wheelsets at the last step; see acceleration_derivatives()."""
        return [
            chain.of(self, index).wrench(self.contact_wrench[index], self.derivatives(index))
            for index in range(len(self.joints))
        ]

    def contact_power_derivatives(self, index: int = 0) -> NDArray[np.float64]:
        """[12], W over units of STATE: of a wheelset's F.v + M.omega at the last step."""
        state, wrench = self._states[index], self.contact_wrench[index]
        spin, spin_by_state = angular_velocity(state)
        motion = np.concatenate([state[6:9], spin])
        found = motion @ self.derivatives(index)
        found[6:9] += wrench[:3]
        return found + wrench[3:] @ spin_by_state

    def creep_power_derivatives(self, index: int = 0) -> NDArray[np.float64]:
        """[12], W over units of STATE: of a wheelset's creep_power at the last step, nearly.

        Creepages take what the contact forces give but for the power of the normal forces, which
        the contacts store. Of that only the change with the velocities is counted: at a wheelset
        that hardly moves along the normals it is the greatest by far. What the contacts leave open
        for being an approach apart, see railpatch.pinocchio.energy, is in it, by the spin mostly.
        Columns of position may be off by a factor of two: a matrix for Rosenbrock's W-methods,
        whose order holds with any, not a derivative to rely on.
        """
        found = -self.contact_power_derivatives(index)
        centre = self._states[index, 2] - self.contacts[index].case.wheelset.nominal_radius
        result = self._core.result(index)
        for patch in (p for side in SIDES for kind in PATCHES for p in result[side][kind]):
            angle, load = patch["contact_angle"], patch["share"] * patch["normal_force"]
            across, down = load * math.sin(angle), -load * math.cos(angle)
            _, y, z = patch["position"]
            lever = (y - self._states[index, 1]) * down - (z - centre) * across
            found[7:10] += [across, down, lever]
        return found

    def state(self, index: int = 0) -> dict[str, float]:
        """Position and velocity of a wheelset at the last step, track axes: see STATE.

        x, y, z in m, roll, yaw, pitch in rad, speed, vy, vz in m/s, roll_rate, yaw_rate, pitch_rate
        in rad/s, as in the case's [wheelset]; pitch is within half a turn.
        """
        self._check(index)
        return dict(zip(STATE, self._states[index].tolist(), strict=True))

    @property
    def tracks(self) -> NDArray[np.float64]:
        """[wheelsets, 12], of the track frame in the world: rotation by rows, origin (m).

        To be written before a step where the track bends or is canted: the frame at each
        wheelset's foot, at rest in the world. Curving then is in the wheelset's own velocity; a
        case has no curvature.
        """
        return self._tracks

    @property
    def positions(self) -> NDArray[np.float64]:
        """[wheelsets], m, along the track, of the track frames' origins; may be written.

        It adds to x, at which the core looks up what varies along the track.
        """
        return self._core.positions[:, 0]

    @property
    def rails(self) -> NDArray[np.float64]:
        """[wheelsets, 2, 2, 3], of offset (m) and velocity (m/s), of left and right rail.

        Track axes, beside those of the case; may be written before a step. Under a wheelset on
        rails that are not level their vertical velocity is speed times slope, the lateral one 0,
        see railpatch.case.track.
        """
        return self._rails.reshape(-1, 2, 2, 3)

    @property
    def water(self) -> NDArray[np.float64]:
        """[wheelsets, 3], of the liquid where each wheelset is; may be written before a step.

        m^3/s, its supply, NaN: as the case has it; J/m, friction work that wheels before have spent
        on left and right rail, beside the case's. Cases without [fluid] and such keys refuse them.
        """
        return self._core.water

    @property
    def wheels(self) -> NDArray[np.float64]:
        """[wheelsets, 2, 9], of left and right wheel at the last step.

        Force (N) and moment (N m) about the wheelset's centre, track axes, creep power (W), number
        of patches, power of friction (W).
        """
        return self._wheels

    @property
    def lateral_normals(self) -> NDArray[np.float64]:
        """N, [wheelsets, 2], of left and right wheel: the parts to the right of pressures in
        `wheels`, at the last step; the rest of the lateral force is of creep."""
        return self._lateral

    def track_rotation(self, index: int) -> NDArray[np.float64]:
        """[3, 3], from a wheelset's track axes to the world's."""
        return self._tracks[index, :9].reshape(3, 3)

    @property
    def states(self) -> NDArray[np.float64]:
        """[wheelsets, 12], the same as an array; its values change with the next step."""
        return self._states

    @property
    def contact_wrench(self) -> NDArray[np.float64]:
        """[wheelsets, 6], N, N m: force and moment at the centre, track axes, of the last step."""
        return self._contact_wrench

    @property
    def contact_power(self) -> float:
        """W, of the contact forces on the wheelsets: F.v + M.omega. Below 0: energy is taken."""
        return float(self._power[:, 0].sum())

    @property
    def elastic_energy(self) -> float:
        """J, stored in the contacts."""
        return float(self._power[:, 1].sum())

    @property
    def pressure_energy(self) -> float:
        """J, of that what the pressure stores: it and creep_power balance the contacts' power."""
        return float(self._power[:, 4].sum())

    @property
    def creep_power(self) -> float:
        """W, that the creepages and the spin supply, of all patches by their shares.

        It is -(F.creepage + M spin_creepage) V, what creep forces and spin moments take.
        """
        return float(self._power[:, 2].sum())

    @property
    def friction_power(self) -> float:
        """W, that friction turns into heat, as in results, of all patches by their shares."""
        return float(self._power[:, 3].sum())

    @property
    def solve_seconds(self) -> float:
        """s, wall-clock time inside the contact solves since the start, of all threads."""
        return self._core.seconds

    @property
    def helper_seconds(self) -> float:
        """s, CPU time of the threads beside the caller's since the start; 0 with one thread."""
        return self._core.helper_seconds

    @property
    def solves(self) -> int:
        """Number of wheelset contacts solved since the start."""
        return self._core.solves

    def result(self, index: int = 0, *, fields: bool = False) -> Result:
        """The last step's result of a wheelset, as Contact.step() returns it; wall_time is NaN.

        fields: with the fields of each patch. A case with [damage] has it, see wear_rows() too.
        """
        return Result(self._whole(index, fields))

    def wear_rows(self, index: int = 0) -> dict[str, list[tuple[float, dict[str, Any]]]]:
        """Of the last step of a wheelset whose case has [damage], as Contact.wear_rows().

        Raises CaseError where it has none.
        """
        self._whole(index, False)
        return self.contacts[index].wear_rows()

    def _check(self, index: int) -> None:
        """Raises CaseError for the number of a wheelset that is none."""
        if isinstance(index, bool) or index not in range(len(self.joints)):
            most = len(self.joints) - 1
            raise CaseError(f"index: value is {show(index)}, allowed 0 to {most}")

    def _whole(self, index: int, fields: bool) -> dict[str, Any]:
        """A result's content, with what the case asks for."""
        self._check(index)
        contact, raw = self.contacts[index], self._core.result(index)
        if contact._asked is None:
            return contact._data(raw, np.nan, fields)
        data = contact._data(raw, np.nan, fields or contact._asked.needs_fields)
        return contact._asked.add(data, raw, fields)

    @property
    def warnings(self) -> list[str]:
        """What can hardly be meant of the last step, of all wheelsets: see Result.warnings."""
        return self._core.warnings()

    def profile_doubts(self) -> list[str]:
        """Warnings where the noise of profile files leaves the greatest pressure open by more than
        5 %, of wheels within 6 mm of the track's middle; solved when asked for, some 0.1 s for
        each pair of noisy profiles. Raises CaseError."""
        lines = [run_doubts(one.case, one.folder) for one in self.contacts]
        return list(dict.fromkeys(line for found in lines for line in found))

    def reset(self) -> None:
        """Forgets the last solutions: the next step starts as the first one did."""
        for contact in self.contacts:
            contact.reset()

    def save(self) -> bytes:
        """The state that later steps depend on."""
        states = [contact.save() for contact in self.contacts]
        return b"".join(LENGTH.pack(len(state)) + state for state in states)

    def restore(self, state: bytes) -> None:
        """Brings back a saved state of the same element; the next step gives the same bits.

        Raises CaseError for other bytes.
        """
        parts = split(state)
        if len(parts) != len(self.contacts):
            raise CaseError("state: value is no state of this element, allowed: save()")
        before = self.save()
        try:
            for contact, part in zip(self.contacts, parts, strict=True):
                contact.restore(part)
        except CaseError:
            for contact, part in zip(self.contacts, split(before), strict=True):
                contact.restore(part)
            raise

    def _wrong(self, fext: Any) -> Exception:
        """What is wrong with an fext."""
        if type(fext) is not pin.StdVec_Force:
            name = type(fext).__name__
            return TypeError(f"fext: value is of type {name}, allowed pinocchio.StdVec_Force")
        return ValueError(
            f"fext: length is {len(fext)}, allowed {self._joint_count}, one for each joint of the "
            "model (model.njoints)"
        )


def joint_index(model: pin.Model, joint: str | int) -> int:
    """Index of a joint by name or index. Raises ValueError."""
    if isinstance(joint, str):
        if not model.existJointName(joint):
            names = ", ".join(list(model.names)[1:])
            raise ValueError(f"joint: value is {joint!r}, allowed {names}")
        return int(model.getJointId(joint))
    if isinstance(joint, bool) or not isinstance(joint, int) or not 1 <= joint < model.njoints:
        raise ValueError(f"joint: value is {joint!r}, allowed 1 to {model.njoints - 1}, or a name")
    return joint


def check_case(case: Any) -> None:
    """Refuses what a force element cannot do. Raises CaseError."""
    if not isinstance(case, WheelsetCase):
        raise CaseError(f"kind: value is {case.kind!r}, allowed 'wheelset' for a force element")
    problems = []
    if case.wheelset.z is None:
        problems.append(
            f"wheelset.vertical_force: value is {show(case.wheelset.vertical_force)}, allowed 'z' "
            "in its place: the model gives the position"
        )
    if case.track.curvature != 0:
        problems.append(
            f"track.curvature: value is {case.track.curvature}, allowed 0: `tracks` say where the "
            "track is"
        )
    problems += [
        f"wheelset.{name}: value is {show(getattr(case.wheelset, name))}, allowed a number: the "
        "model gives position and velocity"
        for name in case.wheelset.found
    ]
    several = "forces are asked for several times a step"
    if case.motion.regime_changes:
        problems.append(f"motion.regime_changes: value is True, allowed False: {several}")
    if case.motion.regime != "steady_rolling":
        problems.append(
            f"motion.regime: value is {case.motion.regime!r}, allowed 'steady_rolling': {several}"
        )
    if case.wheelset.time_step > 0:
        problems.append(
            f"wheelset.time_step: value is {case.wheelset.time_step}, allowed 0: {several}"
        )
    problems += problems_of_bulk(case)
    if case.subsurface is not None:
        problems.append(
            "subsurface: given, allowed none in a force element: take it from a sweep or a rig"
        )
    if problems:
        raise CaseError(problems)


def problems_of_bulk(case: WheelsetCase) -> list[str]:
    """Of bodies that store heat under a wheelset that moves."""
    if case.temperature is None or case.temperature.bulk is None:
        return []
    problems = []
    if case.temperature.stores[1] and case.track.kind == "rail":
        problems.append(
            f"temperature.bulk.mass: value is {show(list(case.temperature.bulk.mass))}, allowed "
            "[wheel, 0]: the rail under a wheelset that moves is always new"
        )
    if case.track.rail_support is not None:
        problems.append("temperature.bulk: value is given, allowed without track.rail_support")
    return problems


def at_height(case: WheelsetCase, folder: Path) -> Scene:
    """The case with z in place of a vertical force, ready for a force element."""
    wheelset = case.wheelset.model_copy(update={"vertical_force": None, "z": 0.0})
    return Scene(case.model_copy(update={"wheelset": wheelset}), folder)


def placements(frames: Sequence[pin.SE3 | None]) -> NDArray[np.float64]:
    """[frames, 12], rotation by rows and origin; None is the identity."""
    rows = [pin.SE3.Identity() if frame is None else frame for frame in frames]
    return np.array([[*frame.rotation.ravel(), *frame.translation] for frame in rows])


def split(state: bytes) -> list[bytes]:
    """The parts of a saved state; fewer where it is damaged."""
    parts, at = [], 0
    while at + LENGTH.size <= len(state):
        (size,) = LENGTH.unpack_from(state, at)
        at += LENGTH.size
        parts.append(state[at : at + size])
        at += size
    return parts
