"""Times of a run's steps, and that steps leave nothing behind in memory."""

from __future__ import annotations

import gc
import json
import sys

import numpy as np
import pytest
from click.testing import CliRunner

from wheelset_demo.vehicle import Simulation, load_vehicle_scene
from wheelset_demo.vehicle.command import vehicle
from wheelset_demo.vehicle.compare import with_theory
from wheelset_demo.vehicle.step_times import StepTimes, text_of


def filled(seconds, threads=1) -> StepTimes:
    times = StepTimes(len(seconds), 1e-3, threads)
    for one in seconds:
        times.add(2 * one, one)
    return times


def test_known_times():
    """9,998 steps of 0.3 ms, one of 1 ms, which is none too long, one of 40 ms."""
    seconds = np.full(10_000, 3e-4)
    seconds[70], seconds[4] = 1e-3, 4e-2
    found = filled(seconds).to_dict()
    cpu, wall = found["cpu"], found["wall"]
    assert cpu["median"] == cpu["99 %"] == 3e-4
    assert cpu["99.99 %"] == 1e-3
    assert (cpu["worst"], cpu["worst_step"], cpu["misses"]) == (4e-2, 4, 1)
    assert wall["misses"] == 2
    assert cpu["mean"] == pytest.approx((9998 * 3e-4 + 1e-3 + 4e-2) / 10_000, rel=1e-12)
    edges = np.array(found["edges"])
    assert edges[0] == 1e-3 / 16
    assert edges[-1] == pytest.approx(32e-3, rel=1e-12)
    assert np.any(np.abs(edges / 1e-3 - 1) < 1e-12)
    assert sum(cpu["counts"]) == sum(wall["counts"]) == 10_000
    assert cpu["counts"][-1] == 1  # beyond the last edge
    at = int(np.searchsorted(edges, 3e-4, side="right"))
    assert cpu["counts"][at] == 9998


def test_shares_want_steps():
    """99.99 % of 9,999 steps is not told by them; of none nothing is."""
    assert filled(np.full(9_999, 1e-4)).to_dict()["cpu"]["99.99 %"] is None
    assert filled(np.full(100, 1e-4)).to_dict()["cpu"]["99 %"] == 1e-4
    empty = StepTimes(5, 1e-3, 1).to_dict()
    assert empty["cpu"]["worst"] is None
    assert empty["steps"] == 0
    assert "worst -" in text_of(empty)


def test_sum_of_threads_is_no_miss():
    found = filled(np.full(10, 2e-3), threads=2).to_dict()
    assert found["cpu"]["misses"] is None
    assert found["wall"]["misses"] == 10


def test_command():
    arguments = ["--method", "polach", "--duration", "0.02", "--step-times"]
    found = json.loads(CliRunner().invoke(vehicle, [*arguments, "--json"]).output)
    run = found["runs"]["polach"]
    times = run["step_times"]
    assert times["steps"] == run["steps"] == 20
    assert sum(times["cpu"]["counts"]) == 20
    assert 20 * times["cpu"]["mean"] == pytest.approx(run["seconds"]["cpu"], rel=0.1)
    assert times["wall"]["misses"] <= 20
    text = CliRunner().invoke(vehicle, arguments).output
    assert "steps of 1 ms: 20" in text
    assert "longer than the step:" in text


def test_without_it_nothing_is_told():
    result = CliRunner().invoke(vehicle, ["--method", "polach", "--duration", "0.002", "--json"])
    assert json.loads(result.output)["runs"]["polach"]["step_times"] is None


def test_times_change_no_bit():
    scene = with_theory(load_vehicle_scene().with_run(duration=0.03), "polach")
    ends = []
    for asked in (False, True):
        simulation = Simulation(scene, step_times=asked)
        for _ in simulation.steps():
            pass
        ends.append(simulation.state.values.tobytes())
    assert ends[0] == ends[1]


@pytest.mark.parametrize("name", ["fastsim", "full"])
def test_steps_leave_no_blocks(name):
    """Once the run has begun, memory that Python holds does not grow by a block in ten steps."""
    scene = with_theory(load_vehicle_scene().with_run(duration=0.1), name)
    simulation = Simulation(scene, step_times=True)
    states = simulation.steps()
    for _ in range(5):
        next(states)
    held = []
    for _ in range(8):
        next(states)
        gc.collect()
        held.append(sys.getallocatedblocks())
    # the list's own numbers are among them
    assert held[-1] - held[2] <= 10, held
