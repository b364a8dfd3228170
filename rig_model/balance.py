"""The force balance of the rig's wheelset at one position.

Unknown are the height z (m), the roll angle (rad) and the pitch rate (rad/s) of the wheelset. The
residuals are those of the report (DOT/FRA/ORD-24/18, Eqs. 51-57) for forces on the wheels, with
lengths in metres so that their sizes compare:

    f1 = F_x,left r_left + F_x,right r_right          N m, the axle turns freely
    f2 = -(F_z,left + F_z,right) - vertical load      N, track axes
    f3 = roll moment about the wheelset's centre      N m, track axes

with r the rolling radii. With a frame that yields the lateral position y (m) is a fourth unknown:

    f4 = F_y,left + F_y,right - R(y - y_actuators)    N, track axes

with the frame's resistance R (rig_model/frame.py). With a gauge that opens so is its opening g (m):

    f5 = (F_y,left - F_y,right)/2 - k g               N, track axes

Which terms are used was decided by the published positions of the NRC
run; those with yaw angles from -2 to 18 mrad have one patch a wheel and were looked at.

f3: the lateral actuators act at the height of the axle, so the contact forces alone have no roll
moment about the wheelset's centre. Their exact moment is used, not Eq. 57's approximation of it
with L/2 and r; balancing that one moves the roll angle by 2e-7 rad, or 2e-6 rad with a second
patch. Our roll angles differ from the published ones by up to 3.4e-6 rad either way: with today's
forces these leave 3.8 kN m at 18 mrad.

f1: Eq. 55 asks for longitudinal forces in wheelset axes. The published positions do not satisfy it:
today's forces of the program that made them leave 300 N m at 18 mrad, and balancing ours so moves
the pitch rate by 2.6e-3 rad/s; balancing their exact moment about the axle moves it by 1.4e-3
rad/s. What the positions satisfy, within 1e-4 rad/s, is the sum of the whole longitudinal forces in
track axes: creep force plus the part of the normal force along x, which a yawed wheel has because
it touches its roller ahead of the roller's top, or behind. This is axle_torque = "track", which the
scene of the NRC run asks for, to be compared with those positions. The default, "wheelset", is the
torque on a free axle: the moment of all contact forces about it, as forces and moments are whole
where pressure acts along the surfaces' normals (patch_rule = "blended", contact_frame =
"inclined"). By the rule of the program CONTACT, which leaves the pressures' part along x out, it is
Eq. 55 to the letter: pressures on a body of revolution have no moment about its axis.
"""

from __future__ import annotations

from collections.abc import Sequence
from copy import copy
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from railpatch import Contact, Result
from railpatch.case.fluid import changes_with_time
from railpatch.case.types import SIDES
from railpatch.result import CARRIES

from rig_model.broyden import Broyden
from rig_model.conditioning import Conditioning, ConditioningState, Load, Pose
from rig_model.frame import Frame, FrameState
from rig_model.newton import Newton
from rig_model.predict import Prediction, Predictor
from rig_model.programme import Position
from rig_model.residuals import residual_rates, residuals
from rig_model.scene import RigScene
from rig_model.search import Evaluation, Root, Settings, Vector
from rig_model.start import Baseline, Estimate, Frictionless
from rig_model.wheels import WheelPair

UNKNOWNS = ("z", "roll", "pitch_rate")

# differences for a Jacobian, in parts of the approach and of the pitch rate
APPROACH_SHARE = 0.02
PITCH_SHARE = 5e-5
# longest step of the search likewise: it stays in contact, and within reach of the creepages
APPROACH_LIMIT = 1.0
PITCH_LIMIT = 2e-3
# m, of a lateral position or gauge that is unknown: a flange rises by as much
LATERAL_DIFFERENCE = 1e-6
LATERAL_LIMIT = 5e-4
# m, most that the estimates reach beyond the actuators' way, and most lateral force over the load
LATERAL_REACH = 0.01
LATERAL_SHARE = 0.5
# of the gauge's opening, by which the left and the right roller give way
APART = (-0.5, 0.5)
# of friction that conditions, most balances with friction by the one before
MOST_ROUNDS = 20


@dataclass(frozen=True)
class Balance:
    """What was found at one position.

    status: "converged" only if the residuals are small and both wheels' contact was solved,
    "accuracy_not_met" where that is not as accurate as the scene asks for; else
    "not_converged", or "out_of_range" where no state with both wheels in contact was found; the
    values are then those of the best try. residuals: [3], N m, N, N m, with a frame that yields
    up to [5], the last in N; None without contact. y: m, of the wheelset; gauge: m, by which it is
    open. frame: its frame's, where that
    yields and the position is balanced. conditioning: by side, of friction that conditions.
    evaluations: of both wheels; iterations: steps of the search; restarts: Jacobians by
    differences beyond the first one, of Broyden's method. result: of the contact.
    """

    position: Position
    status: str
    z: float
    roll: float
    pitch_rate: float
    residuals: Vector | None
    evaluations: int
    iterations: int
    restarts: int
    result: Result
    y: float
    gauge: float = 0.0
    frame: FrameState | None = None
    conditioning: dict[str, ConditioningState] | None = None

    @property
    def converged(self) -> bool:
        """Whether the position is balanced."""
        return self.status in CARRIES


class Balancer:
    """Finds the balances of a run, one position after the other."""

    def __init__(
        self, scene: RigScene, *, derivatives: bool = False, reach: Sequence[float] = ()
    ) -> None:
        """derivatives: the contact holds memory for its derivatives, whatever the method. reach: m,
        lateral positions that are asked for besides those of the run.

        Raises CaseError, ProfileError."""
        positions = scene.positions()
        self._scene = scene
        self._exact = scene.rig.balance.method == "newton"
        self._derivatives = self._exact or derivatives
        self._conditioning: Conditioning | None = None
        self._contact = self._contact_of(scene)
        self._frictionless = Frictionless(scene)
        self._frame = Frame(scene.rig.frame) if scene.rig.frame else None
        extra = self._frame.unknowns if self._frame else ()
        self._unknowns = (*UNKNOWNS, *extra)
        first = self._frictionless.estimate(positions[0].y, positions[0].yaw)
        settings = settings_of(scene, first, len(extra))
        self._latest: Result | None = None
        # of bodies that store heat: s, of the last position, and not yet gone by in the contact
        self._time = positions[0].time
        self._pending = 0.0
        self._broyden = None if self._exact else Broyden(settings)
        self._solver = self._broyden or Newton(settings)
        lateral = [*(position.y for position in positions), *reach]
        if self._frame and "y" in extra:
            far = LATERAL_SHARE * scene.vertical_force / self._frame.softest
            far = min(far, LATERAL_REACH)
            lateral = [min(lateral) - far, max(lateral) + far]
        baseline = Baseline(scene, self._frictionless, lateral)
        self._predictor = Predictor(baseline, settings.difference, extra)

    def changed(self, scene: RigScene) -> Balancer:
        """The same for another scene of the same machine, from its first position on: estimates
        and settings of the search stay. Raises CaseError, ProfileError."""
        other = copy(self)
        other._scene = scene
        other._contact = other._contact_of(scene)
        other._frame = Frame(scene.rig.frame) if scene.rig.frame else None
        other._latest = None
        other._predictor = self._predictor.anew()
        other._time, other._pending = scene.positions()[0].time, 0.0
        return other

    def beside(self, known: Prediction, before: Position, after: Position) -> Prediction:
        """What is known at one position, for another one near it."""
        return self._predictor.moved(known, before, after)

    @property
    def contact(self) -> Contact | WheelPair:
        """Of both wheels at the last state."""
        return self._contact

    @property
    def unknowns(self) -> tuple[str, ...]:
        """Names of what is searched."""
        return self._unknowns

    @property
    def settings(self) -> Settings:
        """Of the search."""
        return self._solver.settings

    @property
    def jacobian(self) -> Vector | None:
        """Of Broyden's method, after the last position; None of Newton's."""
        return self._broyden.jacobian if self._broyden else None

    def alone(self, position: Position, known: Prediction | None) -> Balance:
        """Searches a balance beside the run, of which nothing is remembered."""
        root = self._balanced(position, known or self._predictor.begin(position))
        return balance_of(position, root, self._unknowns)

    def solve(self, position: Position, known: Prediction | None = None) -> Balance:
        """Searches the balance at a position, starting from those before, or from what is known."""
        self._pending += max(position.time - self._time, 0.0)
        self._time = position.time
        root, loads = self._conditioned(position, known)
        if root.converged:
            jacobian = self._broyden.jacobian if self._broyden else None
            self._predictor.remember(position, root.x, jacobian)
        balance = balance_of(position, root, self._unknowns)
        if self._frame and balance.converged:
            forces = lateral_forces(balance.result)
            state = self._frame.moved(position.y, balance.y, balance.gauge, forces)
            balance = replace(balance, frame=state)
        if self._conditioning and loads:
            states = self._conditioning.moved(loads, position.time)
            balance = replace(balance, conditioning=states)
        return balance

    def _anew_unless_found(self, position: Position, root: Root) -> Root:
        """What was known may have misled the search: afresh then."""
        if not root.converged:
            root = best_of(root, self._search(position, self._estimate(position).unknowns))
        if root.payload is None:
            root = replace(root, payload=self._step(position, root.x))
        return root

    def fields(self, balance: Balance) -> Result:
        """The balance's contact with the fields of each patch; solved once more if need be."""
        unknowns = np.array([getattr(balance, name) for name in self._unknowns])
        return self._with_fields(balance.position, unknowns, balance.result)

    def __getstate__(self) -> dict[str, Any]:
        """Copies and pickles go on with the same bits; what has fields is solved once more."""
        return {**vars(self), "_latest": None}

    def _with_fields(self, position: Position, unknowns: Vector, result: Result) -> Result:
        if result is self._latest:
            return self._contact.last(fields=True)
        # no further time goes by
        return self._contact.step(**self._moved(position, unknowns), time_step=0.0, fields=True)

    def _contact_of(self, scene: RigScene) -> Contact | WheelPair:
        """Of both wheels; with friction that conditions anew."""
        table = scene.rig.conditioning
        self._conditioning = Conditioning(table) if table else None
        if self._conditioning:
            return WheelPair(scene, self._conditioning.most, derivatives=self._derivatives)
        return Contact(scene.at_height(derivatives=self._derivatives))

    def _balanced(self, position: Position, known: Prediction | None) -> Root:
        root = self._search(position, self._start(position, known))
        return self._anew_unless_found(position, root)

    def _conditioned(
        self, position: Position, known: Prediction | None
    ) -> tuple[Root, dict[str, Load] | None]:
        """The balance, and of friction that conditions the loads by side that go with it.

        Friction's error is below that of the balance: of the load, not of friction's own.
        """
        if self._conditioning is None:
            return self._balanced(position, known), None
        assert isinstance(self._contact, WheelPair)
        given = known.factors if known else None
        self._contact.factors = given or self._conditioning.started()
        root = self._balanced(position, known)
        for _ in range(MOST_ROUNDS):
            if not root.converged:
                return root, None
            loads = self._loads(position, root)
            found = self._conditioning.factors(loads, position.time)
            error = max(abs(found[side] - self._contact.factors[side]) for side in SIDES)
            if error <= self._scene.rig.balance.tolerance:
                return root, loads
            self._contact.factors = found
            root = with_work(self._search(position, root.x), root)
        return replace(root, converged=False), None

    def _loads(self, position: Position, root: Root) -> dict[str, Load]:
        """Of both wheels, over the bands."""
        assert self._conditioning is not None
        result = self._with_fields(position, root.x, root.payload)
        track, wheelset = self._scene.case.track, self._scene.case.wheelset
        at = self._place(position, root.x)
        centre = (0.0, at["y"], at["z"] - wheelset.nominal_radius)
        loads = {}
        for side, way in zip(SIDES, APART, strict=True):
            roller = getattr(track, side).offset[1] + way * at["gauge"]
            pose = Pose(centre, at["roll"], at["yaw"], roller)
            loads[side] = self._conditioning.load(result[side], pose)
        return loads

    def _place(self, position: Position, unknowns: Vector) -> dict[str, float]:
        """Of the wheelset, and the gauge's opening."""
        usual = {"y": position.y, "yaw": position.yaw, "gauge": 0.0}
        return usual | dict(zip(self._unknowns, map(float, unknowns), strict=True))

    def _moved(self, position: Position, unknowns: Vector) -> dict[str, Any]:
        """The moving inputs of the contact."""
        found: dict[str, Any] = self._place(position, unknowns)
        opening = found.pop("gauge")
        if "gauge" in self._unknowns:
            track = self._scene.case.track
            offsets = [getattr(track, side).offset for side in SIDES]
            found["track"] = apart(opening, offsets)
        if position.roller_pitch_rate is not None:
            found["roller_pitch_rate"] = position.roller_pitch_rate
        return found

    def _estimate(self, position: Position) -> Estimate:
        """Without friction, by the load of the scene, at the position's speed."""
        found = self._frictionless.estimate(position.y, position.yaw)
        speeds = np.array([1.0, 1.0, self._scene.speed_at(position) / self._scene.roller_rate])
        return replace(found, unknowns=self._with_extra(position, found.unknowns * speeds))

    def _with_extra(self, position: Position, unknowns: Vector) -> Vector:
        """With the further unknowns, of a frame at rest."""
        at_rest = {"y": position.y, "gauge": 0.0}
        return np.append(unknowns, [at_rest[name] for name in self._unknowns[len(unknowns) :]])

    def _start(self, position: Position, known: Prediction | None) -> Vector:
        """Where the search starts; sets Broyden's Jacobian where that is known."""
        given = self._scene.rig.start
        if given is not None and position.index == 0 and known is None:
            return self._with_extra(position, np.array([given.z, given.roll, given.pitch_rate]))
        prediction = known or self._predictor.predict(position)
        if self._broyden and prediction.jacobian is not None:
            self._broyden.jacobian = prediction.jacobian
        return prediction.unknowns

    def _search(self, position: Position, start: Vector) -> Root:
        return self._solver.solve(lambda unknowns: self._evaluate(position, unknowns), start)

    def _evaluate(self, position: Position, unknowns: Vector) -> Evaluation:
        """Both wheels' contact at one state; no residual unless both wheels touch their roller."""
        result = self._step(position, unknowns)
        if not all(result[side]["patches"] for side in SIDES) or result.status == "out_of_range":
            return Evaluation(None, False, result)
        solved = all(result[side]["status"] in CARRIES for side in SIDES)
        found = residuals(self._scene, result, self._scene.load_at(position))
        deflection = opening = 0.0
        if self._frame:
            place = self._place(position, unknowns)
            deflection, opening = place["y"] - position.y, place["gauge"]
            more = self._frame.residuals(deflection, opening, lateral_forces(result))
            found = np.append(found, more)
        return Evaluation(found, solved, result, lambda: self._slope(result, deflection))

    def _step(self, position: Position, unknowns: Vector) -> Result:
        if not changes_with_time(self._scene.case):
            self._latest = self._contact.step(**self._moved(position, unknowns))
            return self._latest
        # the time since the last position goes by once, before the first state that is solved
        changes = self._moved(position, unknowns)
        self._latest = self._contact.step(**changes, time_step=self._pending)
        if self._latest.status in ("converged", "no_contact"):
            self._pending = 0.0
        return self._latest

    def _slope(self, result: Result, deflection: float) -> Vector:
        """[n, n], of the residuals at the last state solved, with respect to the unknowns, where
        the frame is deflected (m)."""
        columns = []
        for name in self._unknowns:
            direction = {"track": apart(1.0)} if name == "gauge" else {name: 1.0}
            rates = self._contact.differentiate(**direction)
            column = residual_rates(self._scene, result, rates)
            if self._frame:
                more = self._frame.slopes(name, deflection, lateral_forces(rates))
                column = np.append(column, more)
            columns.append(column)
        return np.column_stack(columns)


def balance_of(position: Position, root: Root, names: tuple[str, ...]) -> Balance:
    """What the search at a position ended with. names: of the unknowns."""
    at = {"y": position.y} | dict(zip(names, map(float, root.x), strict=True))
    missed = "out_of_range" if root.residual is None else "not_converged"
    return Balance(
        position,
        str(root.payload.status) if root.converged else missed,
        at["z"],
        at["roll"],
        at["pitch_rate"],
        root.residual,
        root.evaluations,
        root.iterations,
        root.restarts,
        root.payload,
        at["y"],
        at.get("gauge", 0.0),
    )


def apart(opening: float, offsets: Sequence[Sequence[float]] = ((0.0,) * 3,) * 2) -> dict[str, Any]:
    """[track] of rollers that are apart by more than their offsets (m, [3], left and right)."""
    return {
        side: {"offset": [x, y + way * opening, z]}
        for side, way, (x, y, z) in zip(SIDES, APART, offsets, strict=True)
    }


def lateral_forces(result: Result) -> Vector:
    """N, [2], on the wheels; of rates theirs."""
    return np.array([result[side]["force"][1] for side in SIDES])


def settings_of(scene: RigScene, estimate: Estimate, extra: int) -> Settings:
    """How the balance is searched: lengths in parts of the approach, moments as force times 1 m.
    extra: number of the frame's unknowns."""
    lengths = np.array([1.0, 2.0 / estimate.width]) * estimate.approach
    rate = abs(estimate.unknowns[2])
    difference = np.append(APPROACH_SHARE * lengths, PITCH_SHARE * rate)
    step_limit = np.append(APPROACH_LIMIT * lengths, PITCH_LIMIT * rate)
    difference = np.append(difference, [LATERAL_DIFFERENCE] * extra)
    step_limit = np.append(step_limit, [LATERAL_LIMIT] * extra)
    return Settings(
        residual_scale=np.full(len(difference), scene.vertical_force),
        difference=difference,
        step_limit=step_limit,
        tolerance=scene.rig.balance.tolerance,
        max_evaluations=scene.rig.balance.max_evaluations,
    )


def best_of(first: Root, second: Root) -> Root:
    """The second root if it is one or the first had no residual; with the work of both."""
    chosen = second if second.converged or first.residual is None else first
    other = first if chosen is second else second
    return with_work(chosen, other)


def with_work(root: Root, other: Root) -> Root:
    """A root with the work of another search too."""
    return replace(
        root,
        evaluations=root.evaluations + other.evaluations,
        iterations=root.iterations + other.iterations,
        restarts=root.restarts + other.restarts,
    )
