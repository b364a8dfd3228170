"""What a run leaves in memory, and what it has shown."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray
from railpatch.log.channels import SLIDING
from railpatch.pressure_error import run_doubts
from railpatch.result import Warned

from wheelset_demo.scene import GRAVITY
from wheelset_demo.system import WORKS, ContactFailure
from wheelset_demo.vehicle.assessment import (
    LEAST_RATE,
    LEAST_WAY,
    RATIO_LIMIT,
    UNLOADING_LIMIT,
    assess,
    shift_limit,
    unloading,
)
from wheelset_demo.vehicle.comfort import text_of as text_of_comfort
from wheelset_demo.vehicle.means import rail_forces
from wheelset_demo.vehicle.plausible import doubts_of
from wheelset_demo.vehicle.scene import VehicleScene
from wheelset_demo.vehicle.simulation import Simulation
from wheelset_demo.vehicle.step_times import text_of
from wheelset_demo.vehicle.system import VehicleState

if TYPE_CHECKING:
    from wheelset_demo.vehicle.record import Recorder

Vector = NDArray[np.float64]
Advance = Callable[[VehicleState], None]


@dataclass
class VehicleTrace:
    """The n kept steps of a run.

    times: [n], s. positions: [n, wheelsets], m, along the track. lateral, yaw: the same, m, rad, of
    the wheelsets on their track. guiding, loads: [n, wheels], N, on the rails Y, outward > 0, and
    Q, down, of left and right wheel of each wheelset; mean_guiding, mean_loads: over the last 2 m.
    felt: [n, 3], m/s^2, acceleration of the centre of the body of reference less gravity's, in its
    axes. works: [n, 4 + wheels], J, as those of a state. energies: [n, 4], J, by STORES. failure:
    what ended the run before its end. logging_share: -, of the wall time, in the log; None without
    one.
    """

    scene: VehicleScene
    times: list[float] = field(default_factory=list)
    positions: list[Vector] = field(default_factory=list)
    lateral: list[Vector] = field(default_factory=list)
    yaw: list[Vector] = field(default_factory=list)
    guiding: list[Vector] = field(default_factory=list)
    loads: list[Vector] = field(default_factory=list)
    mean_guiding: list[Vector] = field(default_factory=list)
    mean_loads: list[Vector] = field(default_factory=list)
    felt: list[Vector] = field(default_factory=list)
    works: list[Vector] = field(default_factory=list)
    energies: list[Vector] = field(default_factory=list)
    warned: Warned = field(default_factory=Warned)
    failure: ContactFailure | None = None
    logging_share: float | None = None

    def add(self, simulation: Simulation) -> None:
        """The simulation's present state."""
        element, state = simulation.element, simulation.state
        self.times.append(state.time)
        self.positions.append(simulation.system.positions.copy())
        self.lateral.append(element.states[:, 1].copy())
        self.yaw.append(element.states[:, 4].copy())
        guiding, loads = rail_forces(element.wheels)
        self.guiding.append(guiding)
        self.loads.append(loads)
        self.mean_guiding.append(simulation.means.guiding)
        self.mean_loads.append(simulation.means.loads)
        self.felt.append(felt_by_car_body(simulation))
        self.works.append(state.work)
        self.energies.append(simulation.energies)
        self.warned.add(f"{state.time:.4g} s", element.warnings)

    def array(self, name: str) -> Vector:
        """[n, ...], by the names of the fields."""
        return np.array(getattr(self, name))

    def open_balance(self) -> float:
        """J, most that is missing in the energy of bodies and springs."""
        works, stores = self.array("works"), self.array("energies")
        stored = (stores - stores[0])[:, :3].sum(axis=1)
        contact, _, damping, drive = (works[:, k] for k in range(len(WORKS)))
        return float(np.abs(stored - contact - drive + damping).max())

    def lost(self) -> float:
        """J, in friction and dampers."""
        works = self.array("works")
        return float(works[-1, WORKS.index("friction")] + works[-1, WORKS.index("damping")])


def felt_by_car_body(simulation: Simulation) -> Vector:
    """m/s^2, [3]: acceleration of the centre of the body of reference less gravity's, in its
    axes."""
    count, columns = simulation.system.count, simulation.system.vehicle.columns[0]
    acceleration = simulation.rates.values[count + columns[:3]]
    acceleration[2] -= GRAVITY
    rotation, _ = simulation.body_poses()[simulation.system.reference]
    return rotation.T @ acceleration


def run_vehicle(
    simulation: Simulation, advance: Advance | None = None, output: Path | None = None
) -> VehicleTrace:
    """All steps. A contact that is not solved ends the run: the failure is in the trace.

    output: the log to write. Raises OSError where it cannot be written.
    """
    if output is None:
        return traced(simulation, advance)
    from wheelset_demo.vehicle.record import Recorder, open_log

    with open_log(output, simulation) as log:
        recorder = Recorder(log, simulation)
        log.write_assessment(simulation.state.time, at_rest(simulation))
        trace = traced(simulation, advance, recorder)
        recorder.ended(simulation, assessed_of(trace, simulation))
        log.close(str(trace.failure or ""))
    trace.logging_share = log.share
    return trace


def traced(
    simulation: Simulation, advance: Advance | None = None, recorder: Recorder | None = None
) -> VehicleTrace:
    """The same with a log that is open."""
    trace = VehicleTrace(simulation.scene)
    try:
        for state in simulation.steps():
            trace.add(simulation)
            if recorder is not None:
                recorder.write(simulation)
            if advance is not None:
                advance(state)
    except ContactFailure as failure:
        trace.failure = failure
        if recorder is not None:
            recorder.failed(simulation, failure)
    return trace


@dataclass(frozen=True)
class VehicleSummary:
    """A run in numbers, SI. Of Y and Q those averaged over 2 m (EN 14363), of every time step.

    derailment: greatest Y/Q of a wheel, Y outward. load_range: N, least and greatest Q. shift: N,
    greatest sum of Y of a wheelset, either way. offset: m, greatest of a wheelset from the track's
    middle. comfort: m/s^2, standard deviation, over the whole run, of lateral and vertical
    acceleration at the car body's centre in its axes. friction: J, [wheels], at each.
    open_balance: J, most that was missing in the energy of bodies and springs; lost: J, in friction
    and dampers. seconds: of the time steps: total, by the clock; cpu, of all
    threads, and of it contact (force element) and derivatives. real_time: -, total over the time
    simulated. warnings: of the scene's bodies and of all logged steps. step_times: as
    StepTimes.to_dict(), where they were asked for.
    *_percentile, load_median, shift_limit: as wheelset_demo.vehicle.assessment has them (EN 14363):
    -, N, N, N, N, m/s^2 (lateral, vertical); None where the run is too short for them. support:
    greatest of every time step, as Support.summary(); None on rigid ground. measured_track: what
    the record of the rails holds, as MeasuredTrack.summary(). ride_comfort: as Comfort.summary()
    (EN 12299); None where the scene does not ask. wear: as RunWear.summary(), of [damage].
    static_loads: N, [wheelsets], on level rails at rest. unloading: -, greatest of a wheel, as a
    share of its load at rest, of every time step.
    """

    good: bool
    message: str
    duration: float
    distance: float
    steps: int
    derailment: float
    load_range: tuple[float, float]
    shift: float
    offset: float
    comfort: tuple[float, float]
    friction: tuple[float, ...]
    open_balance: float
    lost: float
    seconds: dict[str, float]
    real_time: float
    warnings: list[str]
    static_loads: tuple[float, ...] = ()
    unloading: float | None = None
    derailment_percentile: float | None = None
    shift_percentile: float | None = None
    shift_limit: float | None = None
    load_percentile: float | None = None
    load_median: float | None = None
    acceleration_percentile: tuple[float, float] | None = None
    support: dict[str, list[float] | None] | None = None
    measured_track: dict[str, Any] | None = None
    ride_comfort: dict[str, Any] | None = None
    wear: dict[str, Any] | None = None
    wear_text: str = ""
    logging_share: float | None = None
    step_times: dict[str, Any] | None = None

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers."""
        return {
            key: list(value) if isinstance(value, tuple) else value
            for key, value in self.__dict__.items()
            if key != "wear_text"
        }

    def text(self) -> str:
        """A few lines for the terminal."""
        low, high = (force / 1e3 for force in self.load_range)
        lateral, vertical = self.comfort
        seconds = self.seconds
        lines = [
            ("distance", f"{self.distance:.1f} m in {self.duration:.3f} s, {self.steps} steps"),
            (
                "Y/Q",
                f"{self.derailment:.3f} at most, Y outward; a wheelset's sum of Y "
                f"{self.shift / 1e3:.2f} kN at most, either way",
            ),
            ("wheel loads", f"{fixed(low, 1)} ... {fixed(high, 1)} kN{self._at_rest()}"),
            ("offset", f"{1e3 * self.offset:.2f} mm at most"),
            (
                "car body",
                f"{lateral:.3f} m/s^2 lateral, {vertical:.3f} m/s^2 vertical, standard deviations "
                "over the run",
            ),
            ("friction", f"{works(self.friction)} a wheel"),
            (
                "balance",
                f"open by {self.open_balance:.3g} J at most; {self.lost:.4g} J were lost in "
                "friction and dampers",
            ),
            (
                "time",
                f"{seconds['total']:.2f} s, CPU {seconds['cpu']:.2f} s, of it contacts "
                f"{seconds['contact']:.2f} s, derivatives {seconds['derivatives']:.2f} s",
            ),
            ("real time", f"{self.real_time:.2f} s for a second simulated"),
        ]
        lines[5:5] = [*self._assessed(), *self._ride(), *self._below()]
        lines[1:1] = self._recorded()
        if self.wear_text:
            lines.append(("wear", self.wear_text))
        if self.logging_share is not None:
            lines.append(("logging", f"{100 * self.logging_share:.2g} % of the run's wall time"))
        found = "\n".join(f"{name:<16}{value}" for name, value in lines)
        return found if self.step_times is None else f"{found}\n{text_of(self.step_times)}"

    def _at_rest(self) -> str:
        """Wheels' loads at rest, and how far they fall below."""
        if self.unloading is None:
            return ""
        halves = dict.fromkeys(fixed(load / 2e3, 1) for load in self.static_loads)
        return (
            f"; at rest {', '.join(halves)} kN, unloading {100 * self.unloading:.1f} % at most "
            f"(limit {100 * UNLOADING_LIMIT:g} %)"
        )

    def _recorded(self) -> list[tuple[str, str]]:
        """A line of the rails' record."""
        if self.measured_track is None:
            return []
        found = self.measured_track
        (usual, largest), (low, high) = found["spacing"], found["waves"]
        rms = ", ".join(f"{1e3 * value:.2f}" for value in found["rms"].values())
        text = (
            f"{found['file']}, {found['rows']} rows, {usual:.3g} m apart ({largest:.3g} at most), "
            f"waves of {low:.3g} to {high:.4g} m; left and right, lateral and vertical {rms} mm rms"
        )
        return [("rails", text)]

    def _ride(self) -> list[tuple[str, str]]:
        """A line of comfort."""
        return (
            [] if self.ride_comfort is None else [("comfort", text_of_comfort(self.ride_comfort))]
        )

    def _below(self) -> list[tuple[str, str]]:
        """A line of the track below the rails."""
        if self.support is None:
            return []
        found = self.support
        place, pad, ballast = found["rail_deflection"], found["pad_force"], found["ballast_force"]
        # they are there together
        assert place is not None
        assert pad is not None
        text = (
            f"rail {1e3 * place['lateral']:.2f} mm lateral, {1e3 * place['vertical']:.2f} mm "
            f"vertical at most; pad {kilonewtons(pad)}"
        )
        if ballast is not None:
            text += f"; ballast below a seat {kilonewtons(ballast)}"
        return [("track", text)]

    def _assessed(self) -> list[tuple[str, str]]:
        """Lines of percentiles beside their limits."""
        if self.shift_percentile is None:
            text = (
                f"none: they need {LEAST_WAY + SLIDING:g} m and steps kept at {LEAST_RATE:g} Hz "
                "or more"
            )
            return [("percentiles", text)]
        ratio, load, median = self.derailment_percentile, self.load_percentile, self.load_median
        # they are there together
        assert ratio is not None
        assert load is not None
        assert median is not None
        assert self.shift_limit is not None
        assert self.acceleration_percentile is not None
        lateral, vertical = self.acceleration_percentile
        return [
            (
                "percentiles",
                f"Y/Q {ratio:.3f} (limit {RATIO_LIMIT:g}), a wheelset's sum of Y "
                f"{self.shift_percentile / 1e3:.2f} kN (limit {self.shift_limit / 1e3:.2f}), Q "
                f"{fixed(load / 1e3, 1)} kN, median {fixed(median / 1e3, 1)} kN; car body "
                f"{lateral:.3f}, {vertical:.3f} m/s^2; 99.85 %, 20 Hz, 2 m, EN 14363",
            )
        ]


def own_doubts(scene: VehicleScene) -> list[str]:
    """Of the noise of profile files, of all wheelsets."""
    cases = {id(axle.table): scene.case_of(axle) for axle in scene.vehicle.axles}
    return list(dict.fromkeys(text for one in cases.values() for text in run_doubts(one, Path())))


def kilonewtons(force: Mapping[str, float]) -> str:
    """Lateral and vertical."""
    return f"{force['lateral'] / 1e3:.1f}, {force['vertical'] / 1e3:.1f} kN"


def works(values: Sequence[float]) -> str:
    """J as text, in J or kJ, with three digits of the greatest."""
    greatest = max(map(abs, values), default=0.0)
    unit, scale = ("kJ", 1e3) if greatest >= 1e3 else ("J", 1.0)
    places = 2 - math.floor(math.log10(greatest / scale)) if greatest > 0 else 0
    return " ".join(fixed(value / scale, min(max(places, 0), 9)) for value in values) + f" {unit}"


def fixed(value: float, places: int) -> str:
    """With so many decimal places, and no -0."""
    return f"{round(value, places) + 0.0:.{places}f}"


def least_limit(simulation: Simulation) -> float:
    """N, of a wheelset's sum of Y, by the least load at rest."""
    factor = simulation.scene.run.shift_factor
    return shift_limit(float(simulation.system.suspension.statics.loads.min()), factor)


def at_rest(simulation: Simulation) -> dict[str, list[float]]:
    """Of the log's channel: what is known before the first step."""
    return {"static_load": simulation.system.suspension.statics.loads.tolist()}


def assessed_of(trace: VehicleTrace, simulation: Simulation) -> dict[str, Any]:
    """Of the log's channel: loads at rest, extremes; percentiles with their limits where the run is
    long enough for them."""
    run, most, felt = simulation.scene.run, simulation.means.extremes, trace.array("felt")
    told = at_rest(simulation) | {
        "most_derailment": list(most.ratios),
        "most_guiding_force": list(most.guiding),
        "most_outward_guiding_force": list(most.outward_guiding),
        "most_shift": list(most.sums),
        "least_load": list(most.least_loads),
        "most_load": list(most.most_loads),
        "acceleration_rms": felt[:, 1:].std(axis=0).tolist(),
    }
    found = assess(trace, run.step * run.log_every)
    if found is None:
        return told
    return told | {
        "places": found.places,
        "derailment": list(found.ratios),
        "guiding_force": list(found.guiding),
        "outward_guiding_force": list(found.outward_guiding),
        "shift": list(found.shifts),
        "load": list(found.loads),
        "median_load": list(found.median_loads),
        "acceleration": list(found.acceleration),
        "derailment_limit": RATIO_LIMIT,
        "shift_limit": least_limit(simulation),
    }


# of a balance that is told: J, and its share of what was lost
OPEN, OPEN_SHARE = 50.0, 0.1


def step_doubts(scene: VehicleScene, balance: float, lost: float) -> list[str]:
    """Warnings of time steps that are too long for the scene. balance, lost: J."""
    way = scene.speed * scene.run.step
    found = [
        f"dip[{k}].corner: {dip.corner:g} m is less than the {way:.3g} m of a time step: forces "
        f"of the joint ask for run.step <= {dip.corner / scene.speed:.2g} s"
        for k, dip in enumerate(scene.dip)
        if dip.corner < way
    ]
    if balance > max(OPEN, OPEN_SHARE * lost):
        found.append(
            f"energy: the balance is open by {balance:.3g} J where {lost:.3g} J were lost: a "
            f"shorter run.step than {scene.run.step:g} s is asked for"
        )
    return found


def summarise(trace: VehicleTrace, simulation: Simulation) -> VehicleSummary:
    """Of a run."""
    positions = trace.array("positions")
    distance = float(positions[-1, 0] - positions[0, 0])
    means, statics = simulation.means, simulation.system.suspension.statics.loads
    felt, time = trace.array("felt"), simulation.state.time
    system, wall = simulation.system, simulation.wall_seconds
    seconds = {
        "total": wall,
        "cpu": simulation.cpu_seconds,
        "contact": simulation.contact_seconds,
        "derivatives": system.derivative_seconds,
    }
    run, measured = simulation.scene.run, simulation.scene.measured
    found = assess(trace, run.step * run.log_every)
    assessed: dict[str, Any] = {}
    if found is not None:
        assessed = {
            "derailment_percentile": found.ratio,
            "shift_percentile": found.shift,
            "shift_limit": least_limit(simulation),
            "load_percentile": found.load,
            "load_median": found.median_load,
            "acceleration_percentile": found.acceleration,
        }
    return VehicleSummary(
        good=trace.failure is None,
        message=str(trace.failure or "converged"),
        duration=time,
        distance=distance,
        steps=round(time / simulation.scene.run.step),
        derailment=means.ratio if np.isfinite(means.ratio) else 0.0,
        load_range=means.load_range,
        shift=means.sum,
        offset=float(np.abs(trace.array("lateral")).max()),
        comfort=(float(felt[:, 1].std()), float(felt[:, 2].std())),
        friction=tuple(trace.works[-1][len(WORKS) :].tolist()),
        open_balance=trace.open_balance(),
        lost=trace.lost(),
        seconds=seconds,
        real_time=wall / time if time > 0 else 0.0,
        warnings=[
            *doubts_of(simulation.scene),
            *(() if measured is None else measured.warnings),
            *own_doubts(simulation.scene),
            *step_doubts(simulation.scene, trace.open_balance(), trace.lost()),
            *trace.warned.lines(),
        ],
        static_loads=tuple(statics.tolist()),
        unloading=max(unloading(means.extremes.least_loads, statics)),
        **assessed,
        support=None if system.support is None else system.support.summary(),
        measured_track=None if measured is None else measured.summary(),
        ride_comfort=None if simulation.comfort is None else simulation.comfort.summary(),
        wear=None if simulation.wear is None else simulation.wear.summary(),
        wear_text="" if simulation.wear is None else simulation.wear.text(),
        logging_share=trace.logging_share,
        step_times=None if simulation.step_times is None else simulation.step_times.to_dict(),
    )
