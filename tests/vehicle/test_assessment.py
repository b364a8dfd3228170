"""Percentiles of EN 14363 of signals whose percentiles are known."""

from __future__ import annotations

import math
from types import SimpleNamespace

import numpy as np
import pytest
import vehicle_scenes as scenes

from wheelset_demo.scene import GRAVITY
from wheelset_demo.vehicle import Simulation
from wheelset_demo.vehicle.assessment import assess, low_passed, shift_limit, unloading
from wheelset_demo.vehicle.trace import assessed_of, run_vehicle, summarise

STEP, SPEED = 5e-3, 40.0


def trace_of(guiding, loads, felt, speed=SPEED, step=STEP):
    """A run with these signals of time: [8], [8], [3] at each."""
    times = step * np.arange(4001)
    rows = {
        "times": times,
        "positions": np.outer(times, np.full(4, speed)) + np.array([21.6, 19.0, 2.6, 0.0]),
        "mean_guiding": guiding(times[:, None]) * np.ones(8),
        "mean_loads": loads(times[:, None]) * np.ones(8),
        "felt": felt(times[:, None]) * np.ones(3),
    }
    return SimpleNamespace(array=rows.__getitem__)


def test_percentiles_of_a_ramp():
    """A ramp stays one behind the filter, late by its delay at frequency 0: of Butterworth's order
    4 (2 sin(pi/8) + 2 sin(3 pi/8))/(2 pi f), shorter by nothing in the bilinear form but the
    corner's warping."""
    trace = trace_of(lambda t: 1e3 * t, lambda t: 5e4 + 0 * t, lambda t: 0.1 * t)
    found = assess(trace, STEP)
    assert found is not None
    warped = math.tan(math.pi * 20.0 * STEP) / (math.pi * STEP)
    late = (2 * math.sin(math.pi / 8) + 2 * math.sin(3 * math.pi / 8)) / (2 * math.pi * warped)
    # places at every 0.5 m from the first whole mean on; a rank between two of them
    times = np.arange(2.0, 20.0 * SPEED, 0.5) / SPEED
    rank = 0.9985 * (len(times) - 1)
    at = np.interp(rank, np.arange(len(times)), times) - late
    assert found.acceleration[0] == pytest.approx(0.1 * at, rel=1e-6)
    assert found.ratio == pytest.approx(1e3 * at / 5e4, rel=1e-6)
    assert found.load == pytest.approx(5e4) == found.median_load
    # left and right outward by as much: no force of the wheelset
    assert found.shift == pytest.approx(0.0, abs=1e-6)


def test_low_pass():
    """20 Hz by 3 dB; 60 Hz by the analog filter's slope or more; what is constant stays."""
    times = STEP * np.arange(4000)
    for frequency, low, high in ((1.0, 0.9999, 1.0001), (20.0, 0.7061, 0.7081), (60.0, 0, 0.0124)):
        wave = np.sin(2 * math.pi * frequency * times)[:, None]
        late = low_passed(wave, STEP)[1000:, 0]
        assert low <= math.sqrt(2 * np.mean(late**2)) <= high
    np.testing.assert_allclose(low_passed(np.full((50, 1), 7.0), STEP), 7.0, rtol=1e-12)


def test_sum_of_a_wheelset_and_its_limit():
    """One wheel pushes: the sum is its force, either way. 10 kN + P0/3 at 120 kN: 50 kN."""
    one = np.array([1.0, 0, 0, 0, 0, 0, 0, 0])
    rest = np.array([0.0, 0.0, -9.81])
    trace = trace_of(lambda t: (-2e4 + 0 * t) * one, lambda t: 6e4 + 0 * t, lambda t: 0 * t + rest)
    found = assess(trace, STEP)
    assert found is not None
    assert found.shift == pytest.approx(2e4)
    assert found.guiding[0] == pytest.approx(2e4)
    # it pushes inward: outward it never was, of the sign of Y/Q
    assert found.outward_guiding[0] == pytest.approx(-2e4)
    assert found.ratios[0] == pytest.approx(-2e4 / 6e4)
    # a car body at rest feels gravity, which is no acceleration of its own
    assert found.acceleration == pytest.approx((0.0, 0.0), abs=1e-9)
    assert found.ratio == pytest.approx(0.0, abs=1e-9)
    assert shift_limit(1.2e5, 1.0) == pytest.approx(5e4)
    assert shift_limit(1.2e5, 0.85) == pytest.approx(4.25e4)


def test_wheel_in_the_air_has_no_ratio():
    trace = trace_of(lambda t: 1e3 + 0 * t, lambda t: 0 * t, lambda t: 0 * t)
    found = assess(trace, STEP)
    assert found is not None
    assert found.ratio == 0.0


def test_unloading_is_of_the_load_at_rest():
    """A half of each wheelset's: 60 kN, of it 15 kN left, is 0.75; more than at rest is below 0."""
    found = unloading((15e3, 60e3, 88e3, 80e3), (120e3, 160e3))
    assert found == pytest.approx((0.75, 0.0, -0.1, 0.0))


def test_too_little():
    flat = (lambda t: 0 * t, lambda t: 5e4 + 0 * t, lambda t: 0 * t)
    assert assess(trace_of(*flat, speed=2.0), STEP) is None
    assert assess(trace_of(*flat, step=0.02), 0.02) is None


def test_summary_of_a_run():
    """Percentiles lie within the extremes of the 2 m means; limits follow the scene."""
    simulation = Simulation(
        scenes.scene(speed=80.0, irregular=True, duration=0.9, step=2e-3, shift_factor=0.85)
    )
    trace = run_vehicle(simulation)
    found = summarise(trace, simulation)
    load = simulation.scene.vehicle.mass * GRAVITY / 4
    assert found.shift_limit == pytest.approx(0.85 * (1e4 + load / 3))
    assert 0 < found.shift_percentile <= 1.01 * found.shift
    low, high = found.load_range
    assert low < found.load_median < found.load_percentile < 1.01 * high
    assert found.derailment_percentile < 1.01 * found.derailment
    assert "limit 0.8" in found.text()
    assert found.static_loads == pytest.approx([load] * 4)
    # the page's tiles are the summary's numbers
    told = assessed_of(trace, simulation)
    assert max(told["derailment"]) == found.derailment_percentile
    assert max(told["shift"]) == found.shift_percentile
    assert max(told["load"]) == found.load_percentile
    assert 0 < max(told["guiding_force"]) < 1.01 * max(told["most_guiding_force"])
    outward, most = told["outward_guiding_force"], told["most_outward_guiding_force"]
    for percentile, greatest, either in zip(outward, most, told["most_guiding_force"], strict=True):
        assert percentile < greatest + 0.01 * abs(greatest)
        assert greatest <= either
    assert "EN 14363" in found.text()
