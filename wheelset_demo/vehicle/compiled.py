"""The time steps of Bdf2, compiled: equations of motion, derivatives and steps in C++.

system.py holds the same equations, by Pinocchio; tests compare the two. Track below the rails,
drives and rails that wheels clean are one and the same object for both. Wheelsets take turns in
renewing their contacts' derivatives, so that no step makes all; none are older than ``every``
steps. Those that contacts find by differences are found column by column in the twelve steps before
they are due, where ``every`` leaves room for all wheelsets.
"""

from __future__ import annotations

import numpy as np
import pinocchio as pin
from railpatch import CaseError, _core
from railpatch.pinocchio.element import STATUSES

from wheelset_demo.system import BAD, ContactFailure
from wheelset_demo.vehicle.irregularity import ARM
from wheelset_demo.vehicle.means import SlidingMeans
from wheelset_demo.vehicle.steppers import SURPRISE
from wheelset_demo.vehicle.system import Rates, Vector, VehicleState, VehicleSystem

# Pinocchio's names of joints, in the order in which the compiled bodies count them
JOINTS = tuple(f"JointModel{name}" for name in ("PX", "PY", "PZ", "RX", "RY", "RZ"))
# one bit a status of contacts that ends a run
REFUSED = sum(1 << STATUSES.index(status) for status in BAD)


class CompiledSteps:
    """Of a system. core: the same in C++."""

    def __init__(self, system: VehicleSystem, step: float, every: int) -> None:
        self._system, self._step, self._every = system, step, every
        self.core = core_of(system)
        self.begun = False

    def begin(self, state: VehicleState, change: Vector, before: Rates) -> None:
        """state: after a first step by change, with the rates before it. Raises CaseError."""
        system = self._system
        self._known = np.array([system.evaluations, system.renewals], dtype=float)
        self._spent = np.array([system.contact_seconds, system.derivative_seconds])
        self.core.evaluate(state.values)
        self.core.begin(
            state.values,
            state.work,
            change,
            before.values,
            before.inputs,
            state.time,
            self._step,
            self._every,
            SURPRISE,
        )
        self.begun = True

    def advance(
        self, count: int, means: SlidingMeans
    ) -> tuple[VehicleState, Rates, ContactFailure | None]:
        """The state up to ``count`` steps later with its rates, and why there are not as many.

        Bodies that store heat, sliders and means go along. Raises CaseError for derivatives that
        are not found.
        """
        core, system, failure = self.core, self._system, None
        try:
            made = core.advance(count, REFUSED, system.element.changes_with_time, means.compiled)
        except CaseError as error:
            if core.differentiating:
                raise
            failure = self._failure(str(error))
        else:
            if made < count:
                failure = self._failure(system.statuses())
        state = VehicleState(core.time, core.values.copy(), core.work.copy(), system.count)
        kept = (core.kept_rates.copy(), core.kept_powers.copy(), core.kept_inputs.copy())
        rates = Rates(*kept, STATUSES[core.status])
        self._tell(state)
        return state, rates, failure

    def _failure(self, text: str) -> ContactFailure:
        system = self._system
        return ContactFailure(self.core.time + self._step, float(system.positions[0]), text)

    def _tell(self, state: VehicleState) -> None:
        """The system what it would know of the last step had it made it."""
        core, system = self.core, self._system
        nv = system.model.nv
        pin.forwardKinematics(system.model, system.data, state.q[:nv], state.v[:nv])
        system.slope_wrenches = core.slope_wrenches.copy()
        system.evaluations = int(self._known[0]) + core.evaluations
        system.renewals = int(self._known[1]) + core.renewals
        system.contact_seconds = float(self._spent[0]) + core.contact_seconds
        system.derivative_seconds = float(self._spent[1]) + core.derivative_seconds


def core_of(system: VehicleSystem) -> _core.VehicleSteps:
    """The compiled equations of motion."""
    model, run = system.model, system.scene.run
    joints = range(1, model.njoints)
    kinds = [(model.parents[k] - 1, JOINTS.index(model.joints[k].shortname())) for k in joints]
    frames = [model.jointPlacements[k] for k in joints]
    masses = [model.inertias[k] for k in joints]
    x, y, _, yaw, _, pitch = system.vehicle.columns[0].tolist()
    return _core.VehicleSteps(
        system.element.compiled,
        system.course,
        system.suspension.compiled,
        np.array(kinds, dtype=np.int64),
        np.array([[*frame.rotation.ravel(), *frame.translation] for frame in frames]),
        np.array([[mass.mass, *mass.lever, *mass.inertia.ravel()] for mass in masses]),
        model.gravity.linear.copy(),
        np.array(system.element.joints, dtype=np.int64) - 1,
        system.radii,
        np.array([ARM, system.hold_arm, run.speed_control, system.scene.speed]),
        np.array([x, y, pitch, yaw], dtype=np.int64),
        system.vehicle.carriers[:, 1:3].astype(np.int64),
        None if system.support is None else system.support.compiled,
        system.drives.compiled if system.drives else None,
        None if system.wet is None else system.wet.compiled,
    )
