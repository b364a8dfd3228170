"""The steady position of a wheelset in a curve.

Unknown are y, z (m), roll, yaw (rad) and pitch rate (rad/s); the track frame follows the curve, so
a yaw angle of 0 is the radial position. The wheelset stands still in the track frame when

    f1 = F_y + lateral force                          N, what the curve leaves of speed and cant
    f2 = F_z + vertical load                          N
    f3 = M_x + I_y pitch rate V/R cos(yaw)            N m, the load stands over the axle's middle
    f4 = M_z - yaw stiffness * yaw                    N m
    f5 = M_y cos(yaw) - M_x sin(yaw)                  N m, about the axle, which turns freely

with the forces on both wheels and their moments about the wheelset's centre, in track axes. The
axle turns with the track frame by V/R about z, and so does its spin momentum I_y times pitch rate:
of the moments, f3 leaves what that takes, V/R z x I_y pitch rate (axle), which has no part about
the axle. It loads the outer wheel.

The search begins where a wheelset without friction would run: sideways where the rolling radii are
in the ratio of the rails' lengths, or as near to it as the flange lets it come; each wheel alone
under half the load then gives z and roll angle. From there the balance with FASTSIM's creep forces
is found where FASTSIM serves, with cheap evaluations, and that is where the scene's theory starts.
"""

from __future__ import annotations

import math
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, ClassVar, Literal

import numpy as np
import scipy
from pydantic import Field
from railpatch import Contact, Result
from railpatch.case import WheelsetCase
from railpatch.case.asked import refuse_asked
from railpatch.case.common import without_friction
from railpatch.case.load import Scene, check_case, plain, read_toml, refuse_others
from railpatch.case.rolling import place_problems
from railpatch.case.types import SIDES, NotNegative, Number, Table
from railpatch.errors import CaseError
from railpatch.result import CARRIES

from rig_model.broyden import Broyden
from rig_model.newton import Newton
from rig_model.scene import checked_parts, steady_problems
from rig_model.search import Evaluation, Settings, Vector
from rig_model.start import deepest, reference

UNKNOWNS = ("y", "z", "roll", "yaw", "pitch_rate")
# their columns among pose (x, y, z, roll, yaw, pitch) and its rates
COLUMNS = (1, 2, 3, 4, 11)
DEFAULT = Path(__file__).parent / "scenes" / "curve_s1002.toml"
METHODS = ("newton", "broyden")

# of each wheel, as results name them: what a curve is looked at for
ANSWERS = {
    "guiding_force": "N",
    "wheel_load": "N",
    "derailment_quotient": "-",
    "wear_number": "N",
    "rolling_radius": "m",
}

# m, lateral positions among which the one without creepage is looked for
MOST_LATERAL = 0.012
LATERAL_STEP = 5e-4
# longest step of the search: m, rad, and in parts of the approach and the pitch rate
STEP_LIMIT = {"y": 2e-3, "yaw": 3e-3, "approach": 1.0, "pitch_rate": 0.02}
# steps of differences for Broyden's first Jacobian, in parts of those
DIFFERENCE = 0.02
# of the start: roll angle and heights of the wheels agree by then
ROLL_ROUNDS = 3

Radius = Annotated[float, Field(ge=10.0, le=1e6)] | Annotated[float, Field(ge=-1e6, le=-10.0)]


class Curve(Table):
    """The curves, and what guides the wheelset beside its contacts."""

    radius: Annotated[list[Radius], Field(min_length=1)] = Field(
        description="m, of each curve; right-hand curves above 0"
    )
    yaw_stiffness: NotNegative = Field(
        default=0.0, description="N m/rad, of the suspension, towards the radial position"
    )
    pitch_inertia: NotNegative = Field(
        default=0.0,
        description="kg m^2, of the wheelset about its axle, whose spin turns with the curve; left "
        "out: no gyroscopic moment",
    )
    lateral_force: Number = Field(
        default=0.0, description="N, on the wheelset, to the right: cant deficiency"
    )
    method: Literal["newton", "broyden"] = Field(
        default="newton", description="(no unit): how the balance is searched"
    )
    tolerance: Annotated[float, Field(ge=1e-8, le=1e-2)] = Field(
        default=5e-5,
        description="-, largest residual over the vertical load (moments: N m over N times 1 m)",
    )
    max_evaluations: Annotated[int, Field(ge=2, le=1000)] = Field(
        default=40, description="-, most evaluations of both wheels in one curve"
    )


@dataclass(frozen=True)
class CurveScene:
    """A checked scene: the wheelset on its track, and the curves."""

    name: str
    case: WheelsetCase
    curve: Curve
    folder: Path

    @property
    def vertical_force(self) -> float:
        """N, on both wheels together."""
        assert self.case.wheelset.vertical_force is not None
        return self.case.wheelset.vertical_force

    def spin_turned(self, radius: float) -> float:
        """N m s, moment over pitch rate that turns the wheelset's spin with a curve (m)."""
        return self.curve.pitch_inertia * self.case.wheelset.speed / radius

    def at_height(self, radius: float, **method: Any) -> Scene:
        """The case in a curve with z prescribed in place of the vertical force. method: keys of
        [method] that replace the case's."""
        content = self.case.model_dump()
        content["wheelset"] |= {"vertical_force": None, "z": 0.0}
        content["track"]["curvature"] = 1.0 / radius
        content["method"] |= method
        return Scene(check_case(content), self.folder)

    def frictionless(self, side: str) -> Scene:
        """One wheel without friction, with half the load."""
        content = without_friction(self.case.model_dump())
        content |= {"kind": "wheel_rail", "wheel": {"side": side}}
        content["wheelset"]["vertical_force"] = 0.5 * self.vertical_force
        return Scene(check_case(content), self.folder)


@dataclass(frozen=True)
class SteadyCurve:
    """What was found in one curve.

    status: "converged" only if the residuals are small and both wheels' contact was solved,
    "accuracy_not_met" where that is not as accurate as the scene asks for; else
    "not_converged", or "out_of_range" where no state with both wheels in contact was found.
    unknowns: [5], y, z (m), roll, yaw (rad), pitch rate (rad/s). residuals: [5], N, N, N m, N m,
    N m; None without contact. evaluations: of both wheels; start_evaluations: of both wheels with
    FASTSIM, before. wall_time: s, of the search; start_time: s, of finding its start. result: of
    the contact.
    """

    radius: float
    status: str
    unknowns: Vector
    residuals: Vector | None
    evaluations: int
    start_evaluations: int
    wall_time: float
    start_time: float
    result: Result

    UNITS: ClassVar[dict[str, str]] = {
        "status": "",
        "y": "m",
        "z": "m",
        "roll": "rad",
        "yaw": "rad",
        "pitch_rate": "rad/s",
        **{f"{side}_{key}": unit for key, unit in ANSWERS.items() for side in SIDES},
        **{f"{side}_max_pressure": "Pa" for side in SIDES},
        "residuals": "N, N m",
        "evaluations": "",
        "start_evaluations": "",
        "wall_time": "s",
        "start_time": "s",
        "left_force": "N",
        "right_force": "N",
        "left_contact_angle": "rad",
        "right_contact_angle": "rad",
    }

    @property
    def converged(self) -> bool:
        """Whether the wheelset is in balance."""
        return self.status in CARRIES

    def to_dict(self) -> dict[str, Any]:
        """radius (m) and the keys of UNITS; guiding_force, wheel_load: Y, Q on the rail, see
        docs/units.md; max_pressure: of a wheel's patches, None without; force: on the wheel, track
        axes; contact_angle: of each patch."""
        data: dict[str, Any] = {"radius": self.radius, "status": self.status}
        data |= dict(zip(UNKNOWNS, map(float, self.unknowns), strict=True))
        data["residuals"] = None if self.residuals is None else self.residuals.tolist()
        for key in ("evaluations", "start_evaluations", "wall_time", "start_time"):
            data[key] = getattr(self, key)
        for side in SIDES:
            wheel = self.result[side]
            patches = wheel["patches"]
            for key in ANSWERS:
                data[f"{side}_{key}"] = wheel[key] if math.isfinite(wheel[key]) else None
            pressures = [patch["max_pressure"] for patch in patches]
            data[f"{side}_max_pressure"] = max(pressures, default=None)
            data[f"{side}_force"] = list(wheel["force"])
            data[f"{side}_contact_angle"] = [patch["contact_angle"] for patch in patches]
        return data


def load_curve_scene(path: str | Path | None = None, **changes: Any) -> CurveScene:
    """Checks a scene; without ``path`` that of the package. changes: keys of [curve] that replace
    the file's, None: as in the file. Raises CaseError with every problem."""
    path = DEFAULT if path is None else Path(path)
    content = plain(read_toml(path))
    refuse_others(content, "curve")
    curve = content.pop("curve", None)
    if not isinstance(curve, dict):
        raise CaseError("curve: value is missing, allowed a table with the curves")
    curve |= {key: value for key, value in changes.items() if value is not None}
    case, table = checked_parts(content, Curve, curve, "curve")
    check_wheelset(case)
    return CurveScene(path.name, case, table, path.parent)


def check_wheelset(case: Any) -> None:
    """Refuses cases that are no wheelset that rolls on rails with a load and friction."""
    if case.kind != "wheelset":
        raise CaseError(f"kind: value is {case.kind!r}, allowed 'wheelset' in a curve")
    problems = []
    if case.track.kind != "rail":
        problems.append(f"track.kind: value is {case.track.kind!r}, allowed 'rail' in a curve")
    if case.track.curvature != 0:
        shown = case.track.curvature
        problems.append(f"track.curvature: value is {shown}, allowed in [curve] as radius")
    if case.wheelset.vertical_force is None:
        problems.append("wheelset.z: value is given, allowed 'vertical_force' in its place")
    problems += [
        f"wheelset.{name}: value is {getattr(case.wheelset, name)!r}, allowed to be left out: the "
        "curve's position is found"
        for name in case.wheelset.found
    ]
    if not case.wheelset.speed > 0:
        problems.append(f"wheelset.speed: value is {case.wheelset.speed}, allowed > 0 m/s")
    if not case.has_tangential:
        problems.append("method.tangential: value is 'none', allowed one with creep forces")
    problems += steady_problems(case, "a curve is")
    problems += place_problems(case, "a steady curve")
    if case.temperature is not None and case.temperature.bulk is not None:
        problems.append(
            "temperature.bulk: value is given, allowed to be left out: a steady curve has no time"
        )
    if case.fluid is not None and case.fluid.recovery is not None:
        problems.append(
            "fluid.recovery: value is given, allowed to be left out: a steady curve has no time"
        )
    if case.fluid is not None and case.fluid.dries:
        problems.append(
            "fluid.oxide.drying: value is given, allowed to be left out: a steady curve has no time"
        )
    if problems:
        raise CaseError(problems)
    refuse_asked(case, "in a steady curve: solve its positions as cases")


def steady_curves(scene: CurveScene, method: str | None = None) -> list[SteadyCurve]:
    """The balances in all curves of the scene, each from its own start.

    method: "newton" or "broyden"; left out: the scene's. Raises CaseError, ProfileError.
    """
    start = Frictionless(scene)
    chosen = method or scene.curve.method
    return [steady_curve(scene, radius, start, chosen) for radius in scene.curve.radius]


def steady_curve(
    scene: CurveScene, radius: float, frictionless: Frictionless, method: str
) -> SteadyCurve:
    """The balance in one curve."""
    exact = method == "newton"
    contact = Contact(scene.at_height(radius, derivatives=exact))
    fast = fast_contact(scene, radius)
    begin = time.perf_counter()
    start, approach, width = frictionless.start(radius)
    settings = settings_of(scene, start, approach, width)
    tried = 0
    if fast is not None:
        before = Broyden(settings).solve(lambda x: evaluate(scene, radius, fast, x), start)
        start, tried = before.x, before.evaluations
    between = time.perf_counter()
    solver = Newton(settings) if exact else Broyden(settings)
    root = solver.solve(lambda unknowns: evaluate(scene, radius, contact, unknowns), start)
    end = time.perf_counter()
    missed = "out_of_range" if root.residual is None else "not_converged"
    return SteadyCurve(
        radius,
        str(root.payload.status) if root.converged else missed,
        root.x,
        root.residual,
        root.evaluations,
        tried,
        end - between,
        between - begin,
        root.payload,
    )


def fast_contact(scene: CurveScene, radius: float) -> Contact | None:
    """The contact with FASTSIM; None where the scene has what FASTSIM has not (a layer, ...)."""
    try:
        return Contact(scene.at_height(radius, tangential="fastsim"))
    except CaseError:
        return None


def settings_of(scene: CurveScene, start: Vector, approach: float, width: float) -> Settings:
    """How the balance is searched; moments count as force times 1 m."""
    limit = {
        "y": STEP_LIMIT["y"],
        "z": STEP_LIMIT["approach"] * approach,
        "roll": STEP_LIMIT["approach"] * 2.0 * approach / width,
        "yaw": STEP_LIMIT["yaw"],
        "pitch_rate": STEP_LIMIT["pitch_rate"] * abs(start[4]),
    }
    limits = np.array([limit[name] for name in UNKNOWNS])
    return Settings(
        residual_scale=np.full(len(UNKNOWNS), scene.vertical_force),
        difference=DIFFERENCE * limits,
        step_limit=limits,
        tolerance=scene.curve.tolerance,
        max_evaluations=scene.curve.max_evaluations,
    )


def evaluate(scene: CurveScene, radius: float, contact: Contact, unknowns: Vector) -> Evaluation:
    """Both wheels' contact at one state; no residual unless both wheels touch their rail."""
    state = dict(zip(UNKNOWNS, map(float, unknowns), strict=True))
    result = contact.step(**state)
    if not all(result[side]["patches"] for side in SIDES) or result.status == "out_of_range":
        return Evaluation(None, False, result)
    solved = all(result[side]["status"] in CARRIES for side in SIDES)
    wrench = np.array([*result["force"], *result["moment"]])

    def slope() -> Vector:
        jacobian = contact.jacobian()
        rates = (jacobian["left"] + jacobian["right"])[:, COLUMNS]
        return residual_rates(scene, radius, wrench, state, rates)

    return Evaluation(residuals(scene, radius, wrench, state), solved, result, slope)


def residuals(scene: CurveScene, radius: float, wrench: Vector, state: dict[str, float]) -> Vector:
    """f1 to f5, [5]; wrench: [6], force (N) and moment (N m). See the head of this file."""
    _, fy, fz, mx, my, mz = wrench
    curve, yaw = scene.curve, state["yaw"]
    return np.array(
        [
            fy + curve.lateral_force,
            fz + scene.vertical_force,
            mx + scene.spin_turned(radius) * state["pitch_rate"] * math.cos(yaw),
            mz - curve.yaw_stiffness * yaw,
            my * math.cos(yaw) - mx * math.sin(yaw),
        ]
    )


def residual_rates(
    scene: CurveScene, radius: float, wrench: Vector, state: dict[str, float], rates: Vector
) -> Vector:
    """[5, 5], of f1 to f5 with respect to the unknowns, from those of the wrench, [6, 5]."""
    c, s = math.cos(state["yaw"]), math.sin(state["yaw"])
    _, fy, fz, mx, my, mz = rates
    slope = np.array([fy, fz, mx, mz, c * my - s * mx])
    at, turned = UNKNOWNS.index("yaw"), scene.spin_turned(radius)
    slope[2, UNKNOWNS.index("pitch_rate")] += turned * c
    slope[2, at] -= turned * state["pitch_rate"] * s
    slope[3, at] -= scene.curve.yaw_stiffness
    slope[4, at] -= s * wrench[4] + c * wrench[3]
    return slope


class Frictionless:
    """Both wheels, each put alone on its rail with half the load."""

    def __init__(self, scene: CurveScene) -> None:
        """Raises CaseError, ProfileError."""
        self._scene = scene
        self._wheels = {side: Contact(scene.frictionless(side)) for side in SIDES}

    def start(self, radius: float) -> tuple[Vector, float, float]:
        """Unknowns, [5], mean approach (m) and lateral distance of the contacts (m).

        Raises CaseError where no lateral position puts both wheels on their rails.
        """
        # in a right-hand curve the wheelset moves to the left, onto the greater radius of that side
        outwards = -math.copysign(1.0, radius)
        count = round(MOST_LATERAL / LATERAL_STEP)
        before: tuple[float, float] | None = None
        best: tuple[float, float] | None = None
        for k in range(count + 1):
            y = outwards * k * LATERAL_STEP
            excess = self._excess(y, radius)
            if excess is None:
                break
            if best is None or abs(excess) < best[1]:
                best = (y, abs(excess))
            if before is not None and before[1] * excess <= 0:
                y = scipy.optimize.brentq(
                    lambda at: self._excess(at, radius), before[0], y, xtol=1e-6
                )
                return self._at(y)
            before = (y, excess)
        if best is None:
            raise CaseError(
                "wheelset: value is a wheelset off its rails, allowed one with both wheels on them"
            )
        return self._at(best[0])

    def _excess(self, y: float, radius: float) -> float | None:
        """How far the ratio of the rolling radii is from that of the rails' lengths."""
        wheels = self._stand(y, 0.0)
        if wheels is None:
            return None
        radii = {side: wheels[side]["rolling_radius"] for side in SIDES}
        rails = {side: 1.0 - reference(wheels[side])[1] / radius for side in SIDES}
        return radii["left"] / radii["right"] - rails["left"] / rails["right"]

    def _at(self, y: float) -> tuple[Vector, float, float]:
        roll = 0.0
        for _ in range(ROLL_ROUNDS):
            wheels = self._stand(y, roll)
            assert wheels is not None
            left, right = (reference(wheels[side]) for side in SIDES)
            width = right[1] - left[1]
            # the wheels' heights at this roll angle tell how much of it is missing
            more = (wheels["right"]["z"] - wheels["left"]["z"]) / width
            z = wheels["left"]["z"] - more * (left[1] - y)
            roll += more
        speed = self._scene.case.wheelset.speed
        rate = -speed / np.mean([wheels[side]["rolling_radius"] for side in SIDES])
        approach = float(np.mean([deepest(wheels[side]) for side in SIDES]))
        return np.array([y, z, roll, 0.0, rate]), approach, float(width)

    def _stand(self, y: float, roll: float) -> dict[str, Result] | None:
        """Both wheels at a lateral position (m) and roll angle (rad); None off the rails."""
        wheels = {side: wheel.step(y=y, roll=roll) for side, wheel in self._wheels.items()}
        good = all(wheel.solved and wheel["patches"] for wheel in wheels.values())
        return wheels if good else None
