"""One run: the vehicle on its wheels at speed, time steps."""

from __future__ import annotations

import time as clock
from collections.abc import Iterator

import numpy as np
from railpatch import CaseError, Contact
from railpatch.case.common import without_friction
from railpatch.case.scene_profiles import sections_of
from railpatch.case.types import SIDES
from railpatch.case.wheel import WheelsetCase
from railpatch.damage.run import RunWear

from wheelset_demo.system import BAD, WORKS
from wheelset_demo.vehicle.comfort import Comfort
from wheelset_demo.vehicle.compiled import CompiledSteps
from wheelset_demo.vehicle.means import SlidingMeans
from wheelset_demo.vehicle.scene import VehicleScene
from wheelset_demo.vehicle.step_times import StepTimes
from wheelset_demo.vehicle.steppers import Bdf2
from wheelset_demo.vehicle.support import SupportTable
from wheelset_demo.vehicle.system import Rates, Vector, VehicleState, VehicleSystem


class Simulation:
    """A scene, ready to run: the vehicle stands on its wheels and rolls at the scene's speed.

    scene: VehicleScene. system: the equations of motion; element: its force element. state, rates:
    the present ones. means: Y and Q over the last 2 m, of every time step. comfort: of the scene's
    points, where it asks. wear: over the profiles, where its case has [damage]. wall_seconds,
    cpu_seconds: s, spent in steps() so far, by the clock and of all threads, without what its
    caller does in between. step_times: of each step, where they were asked for.
    """

    def __init__(self, scene: VehicleScene, *, step_times: bool = False) -> None:
        """Raises CaseError, also where the wheels cannot carry the load, and ProfileError."""
        self.scene = scene
        self.system = VehicleSystem(scene)
        self.element = self.system.element
        self.state = at_start(scene, self.system)
        self.wall_seconds = self.cpu_seconds = 0.0
        self.rates: Rates = self.system.rates(self.state.time, self.state.values)
        self.system.suspension.release()
        if self.system.wet is not None:
            self.system.wet.begin(self.system.positions)
        self._stepper = Bdf2(self.system, scene.run.step, scene.run.derivatives_every)
        # None: steps in Python, the first ones and what tests compare with
        self._compiled: CompiledSteps | None = CompiledSteps(
            self.system, scene.run.step, scene.run.derivatives_every
        )
        self.means = SlidingMeans(self.element.wheels)
        self.comfort = comfort_of(scene, self.system)
        self.wear = wear_of(scene)
        self._steps_done, self._worn_at = 0, self.system.positions.copy()
        self._solved_before = self._contact_cpu()
        self.step_times = (
            StepTimes(scene.steps, scene.run.step, scene.run.threads) if step_times else None
        )

    def steps(self) -> Iterator[VehicleState]:
        """The state at the start and after each n-th step, n = run.log_every.

        At a yield the force element's arrays and body_poses() are those of the state. Raises
        ContactFailure where a contact is not solved.
        """
        yield self.state
        every, count = self.scene.run.log_every, self.scene.steps
        for done in range(0, count, every):
            begin = clock.perf_counter(), self._cpu()
            self._several(min(every, count - done))
            self.wall_seconds += clock.perf_counter() - begin[0]
            self.cpu_seconds += self._cpu() - begin[1]
            yield self.state

    @property
    def _unasked(self) -> bool:
        return self.step_times is None and self.comfort is None and self.wear is None

    def _several(self, count: int) -> None:
        """Steps; at once where nothing is asked for in between."""
        compiled = self._compiled
        if compiled is not None and compiled.begun and self._unasked:
            self._step(count)
            return
        for _ in range(count):
            if self.step_times is None:
                self._step(1)
            else:
                self._timed_step(self.step_times)

    def _step(self, count: int) -> None:
        """count: more than one where steps are compiled."""
        if self._compiled is not None and self._compiled.begun:
            found = self._compiled.advance(count, self.means)
            self.state, self.rates, failure = found
            if failure is not None:
                raise failure
        else:
            self._next_step()
        if self.comfort is not None:
            self.comfort.add(
                self.state.time, self.state.values, self.rates.values, self.state.count
            )
        if self.wear is not None:
            self._wear_off(self.wear)

    def _next_step(self) -> None:
        """By the system, as it stands in Python."""
        before, state, rates = self.system.course.middle, self.state, self.rates
        self.element.pass_time(self.scene.run.step)
        self.system.drives.update(self.state.time, self.state.q, self.state.v)
        self.state, self.rates = self._stepper.step(self.state, self.rates)
        self.system.suspension.settle()
        self.means.add(self.system.course.middle - before, self.element.wheels)
        if self.system.wet is not None:
            spent = (self.state.work - state.work)[len(WORKS) :].reshape(-1, 2)
            self.system.wet.leave(self.system.positions, spent)
        if self.system.support is not None:
            self.system.support.meet()
        if self._compiled is not None:
            self._compiled.begin(self.state, self.state.values - state.values, rates)

    def _wear_off(self, wear: RunWear) -> None:
        """The way since the last sample, every n-th step and at the run's end."""
        self._steps_done += 1
        every = self.scene.run.damage_every
        if self._steps_done % every and self._steps_done != self.scene.steps:
            return
        ways = self.system.positions - self._worn_at
        self._worn_at = self.system.positions.copy()
        for index, way in enumerate(ways.tolist()):
            wear.add(index + 1, self.element.wear_rows(index), way)

    def _timed_step(self, times: StepTimes) -> None:
        wall, cpu = clock.perf_counter(), self._cpu()
        self._step(1)
        times.add(clock.perf_counter() - wall, self._cpu() - cpu)

    def solve_again(self) -> None:
        """Brings the force element's arrays and body_poses() back to the present state, after a
        step that failed. Raises ContactFailure."""
        self.rates = self.system.rates(self.state.time, self.state.values)

    def body_poses(self) -> dict[str, tuple[Vector, Vector]]:
        """Name -> rotation [3, 3] and place [3] (m) of each body in the world; see the package."""
        return self.system.body_poses()

    @property
    def contact_seconds(self) -> float:
        """s, of cpu_seconds: in the force element."""
        return self._contact_cpu() - self._solved_before

    def _contact_cpu(self) -> float:
        return self.system.contact_seconds + self.element.helper_seconds

    def _cpu(self) -> float:
        # of the process would be simpler, but takes milliseconds where many threads run
        return clock.thread_time() + self.element.helper_seconds

    @property
    def energies(self) -> Vector:
        """J, [4]: kinetic, gravity, suspension, elastic energy of the contacts."""
        return self.system.stored(self.state)


def comfort_of(scene: VehicleScene, system: VehicleSystem) -> Comfort | None:
    """What measures it; None where the scene does not ask."""
    if scene.comfort is None:
        return None
    columns = dict(zip(system.vehicle.bodies, system.vehicle.columns, strict=True))
    return Comfort(scene.comfort, scene.run.step, scene.vehicle.bodies, columns)


def wear_of(scene: VehicleScene) -> RunWear | None:
    """What lays it over the profiles; None where the scene does not ask."""
    law = scene.case.damage
    if law is None:
        return None
    cases = [scene.case_of(axle) for axle in scene.vehicle.axles]
    return RunWear(law, [case.wheelset.nominal_radius for case in cases])


def at_start(scene: VehicleScene, system: VehicleSystem) -> VehicleState:
    """All bodies in the middle at their height, wheels pressed down by their loads, rolling."""
    vehicle, n = system.vehicle, system.count
    values = np.zeros(system.size)
    q, v = values[:n], values[n : 2 * n]
    loads = system.suspension.statics.loads
    places = vehicle.rest[vehicle.carriers[:, 0]]
    varies = any(True for side in SIDES for _ in sections_of(scene.case, side))
    found: dict[tuple[int, float, float], tuple[float, float, Vector]] = {}
    deflections = []
    for axle, load, x in zip(scene.vehicle.axles, loads.tolist(), places.tolist(), strict=True):
        alike = id(axle.table), round(load, 3), x if varies else 0.0
        if alike not in found:
            case = scene.case_of(axle)
            found[alike] = wheels_under_load(case, load, scene.support, place=alike[2])
        q[vehicle.carriers[axle.number - 1, 2]], radius, below = found[alike]
        v[vehicle.spins[axle.number - 1]] = -scene.speed / radius
        deflections.append(below)
    nv = system.model.nv
    q[:nv] = vehicle.rest + system.suspension.statics.sunk(q[vehicle.carriers[:, 2]])
    if system.support is not None:
        q[nv:] = system.support.at_rest(np.array(deflections))
    v[vehicle.ahead] = scene.speed
    system.positions[:] = q[vehicle.carriers[:, 0]]
    return VehicleState(0.0, values, np.zeros(len(WORKS) + 2 * system.wheelsets), n)


def wheels_under_load(
    case: WheelsetCase, load: float, support: SupportTable | None = None, *, place: float = 0.0
) -> tuple[float, float, Vector]:
    """m: how far a wheelset in the middle is pressed down by a load (N), its rolling radius, and
    deflections [2, 2] of left and right rail on the track below, lateral and vertical. place: m,
    along the track. Raises CaseError where it cannot stand there."""
    content = without_friction(case.model_dump())
    content["wheelset"] |= {"vertical_force": load, "z": None}
    if support is not None:
        content["track"]["rail_support"] = {"stiffness": list(support.static_stiffness)}
    content["method"]["derivatives"] = False
    result = Contact(content).step(x=place)
    if result.status in BAD or result.status == "no_contact":
        raise CaseError(
            f"vehicle: an axle load is {load:.6g} N, allowed one that the wheels can "
            f"carry: {result.status}: {result.reason}"
        )
    radii = [result[side]["rolling_radius"] for side in SIDES]
    for side, other, radius in zip(SIDES, reversed(SIDES), radii, strict=True):
        if np.isnan(radius):
            raise CaseError(
                f"vehicle: at {place:.6g} m the {side} wheel of a level wheelset hangs above its "
                f"rail while the {other} one carries {load:.6g} N, allowed rails as high as each "
                f"other where the vehicle starts: 'origin' of track.{SIDES[0]} and "
                f"track.{SIDES[1]}, 'position' of their sections"
            )
    found = np.zeros((2, 2))
    if support is not None:
        found[:] = [result[side]["rail_deflection"] for side in SIDES]
    return float(result["z"]), float(np.mean(radii)), found
