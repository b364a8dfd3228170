"""One run: release, time steps, log."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from pathlib import Path

from railpatch.case.types import SIDES
from railpatch.damage.run import RunWear
from railpatch.log import RunLog, scene_geometry
from railpatch.log.stream import Pace

from wheelset_demo.record import Recorder, attachments, ran_with
from wheelset_demo.scene import WheelsetScene
from wheelset_demo.start import released
from wheelset_demo.steppers import make_stepper
from wheelset_demo.summary import Summary, summarise
from wheelset_demo.system import ContactFailure, State, System
from wheelset_demo.trace import Trace

Advance = Callable[[State], None]


class Simulation:
    """A scene, ready to run: the wheelset is released and at rest in its fast motions."""

    def __init__(self, scene: WheelsetScene) -> None:
        """Raises CaseError, also where it cannot be released, and ProfileError."""
        self.scene = scene
        self.system = System(scene)
        self.state = released(scene, self.system)

    def run(self, log: RunLog | None = None, advance: Advance | None = None) -> Trace:
        """All steps. log: where those of every n-th are written that [run] wants. advance: called
        after each.

        A contact that is not solved ends the run: the failure is in the trace, and its state the
        last one in the log.
        """
        run, steps = self.scene.run, self.scene.steps
        stepper = make_stepper(
            run.stepper, self.system, run.step, run.derivatives_every, run.derivatives
        )
        trace = Trace(self.scene)
        recorder = Recorder(self.scene, self.system)
        pace = None if run.write_rate is None else Pace(run.write_rate)
        law, worn_at = self.scene.case.damage, float(self.state.q[0])
        if law is not None:
            trace.wear = RunWear(law, [self.scene.case.wheelset.nominal_radius])
        try:
            for index in range(steps + 1):
                rates = self.system.rates(self.state.time, self.state.motion)
                if trace.wear is not None and (index % run.damage_every == 0 or index == steps):
                    at = float(self.state.q[0])
                    trace.wear.add(1, self.system.element.wear_rows(), at - worn_at)
                    worn_at = at
                if index % run.log_every == 0 or index == steps:
                    # steps with fields, and the last one, are written in any case
                    wanted = trace.snapshot_due() or index == steps
                    trace.add(self.system, self.state)
                    if log is not None and (pace is None or pace.due(self.state.time) or wanted):
                        with log.stream.counted():
                            log.write(self.state.time, **recorder.messages(trace, self.state))
                if index < steps:
                    self.state = stepper.step(self.state, rates)
                    self.system.element.pass_time(run.step)
                    if advance is not None:
                        advance(self.state)
        except ContactFailure as failure:
            trace.failure = failure
            if log is not None:
                # a stage may be the logged step itself: times must rise
                late = max(failure.time, trace.times[-1] + 1e-9)
                log.write(late, **recorder.failed())
        if log is not None and trace.wear is not None:
            wear = trace.wear
            log.write_wear(self.state.time, {side: wear.message((1, side)) for side in SIDES})
        trace.finish(self.system)
        return trace


def simulate(scene: WheelsetScene) -> Trace:
    """A run without log. Raises as Simulation."""
    return Simulation(scene).run()


def run_scene(
    scene: WheelsetScene,
    output: Path,
    advance: Advance | None = None,
    attached: Mapping[str, bytes] | None = None,
) -> Summary:
    """Runs a scene and writes the log. attached: further files in it, by name.

    Raises as Simulation, before a file is made, and OSError where the log cannot be written.
    """
    begin = time.perf_counter()
    simulation = Simulation(scene)
    with RunLog(
        output,
        case_text=scene.text,
        case_name=scene.name,
        profiles={**attachments(scene), **(attached or {})},
        geometry=scene_geometry(scene.case),
        scene_rate=scene.run.scene_rate,
        ran_with=ran_with(scene),
    ) as log:
        trace = simulation.run(log, advance)
        log.close(str(trace.failure or ""))
        share = log.share
    return summarise(trace, time.perf_counter() - begin, share)
