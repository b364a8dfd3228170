"""Means of the wheels' forces over 2 m of way."""

from __future__ import annotations

import numpy as np
import pytest
import vehicle_scenes as scenes
from scipy.integrate import quad

from wheelset_demo.vehicle import Simulation
from wheelset_demo.vehicle.means import SlidingMeans, rail_forces


def wheels(lateral: float, vertical: float) -> np.ndarray:
    """As ForceElement.wheels: one force (N) on all."""
    found = np.zeros((4, 2, 8))
    found[:, :, 1], found[:, :, 2] = lateral, vertical
    return found


def test_signs():
    """A wheel pushed to the right pushes its rail to the left: outward on the left."""
    guiding, loads = rail_forces(wheels(1e3, -5e4))
    assert guiding.tolist() == [1e3, -1e3] * 4
    assert loads.tolist() == [5e4] * 8


def test_means_are_integrals_over_the_last_metres():
    """Of waves along the track, at steps of any length; before 2 m, of what there is."""

    def load(s: float) -> float:
        return 5e4 + 2e4 * np.sin(3.0 * s)

    rng = np.random.default_rng(0)
    s, means = 0.0, SlidingMeans(wheels(0.1 * load(0.0), -load(0.0)))
    assert means.loads == pytest.approx(np.full(8, load(0.0)))
    checked = 0
    for way in rng.uniform(1e-3, 0.05, 400):
        s += way
        means.add(way, wheels(0.1 * load(s), -load(s)))
        begin = max(0.0, s - 2.0)
        wanted = quad(load, begin, s)[0] / (s - begin)
        # of the trapezoidal rule 1/12 h^2 f'', and its share between two steps
        assert means.loads == pytest.approx(np.full(8, wanted), abs=2 * 0.05**2 / 12 * 9 * 2e4)
        checked += s > 2
    assert checked > 200
    # left wheels push outward, right ones inward: the greatest ratio is that of the left
    assert means.ratio == pytest.approx(0.1)
    most = means.extremes
    assert most.ratios == pytest.approx([0.1, -0.1] * 4)
    assert most.least_loads == (means.load_range[0],) * 8
    assert most.most_loads == (means.load_range[1],) * 8
    assert most.guiding == pytest.approx([0.1 * means.load_range[1]] * 8)
    # outward alone: what is least inward on the right
    low, high = means.load_range
    assert most.outward_guiding == pytest.approx([0.1 * high, -0.1 * low] * 4)
    assert most.sums == (means.sum,) * 4
    # a wheelset's, of both wheels
    assert means.sum == pytest.approx(0.2 * means.load_range[1])


def test_extremes_are_of_whole_means():
    """What the start shows before 2 m are run is forgotten."""
    means = SlidingMeans(wheels(0.0, -9e4))
    means.add(0.01, wheels(0.0, -5e4))
    assert means.load_range == (7e4, 9e4)
    for _ in range(300):
        means.add(0.01, wheels(0.0, -5e4))
    # 0.01 m of the mean of 9e4 and 5e4 were in the first whole one
    assert means.load_range == pytest.approx((5e4, 5e4 + 100.0))


def test_standing_still_and_wheels_in_the_air():
    means = SlidingMeans(wheels(0.0, 0.0))
    means.add(0.0, wheels(1e3, -1e3))
    assert means.load_range == (0.0, 0.0)
    assert means.ratio == -np.inf


def test_extremes_do_not_hang_on_what_is_kept():
    """Every step counts, however few are kept or logged."""
    found = []
    for every in (1, 7):
        given = scenes.scene(duration=0.1, irregular=True, log_every=every)
        found.append(scenes.finished(given).means)
    one, other = found
    assert (one.ratio, one.sum, one.load_range) == (other.ratio, other.sum, other.load_range)
    assert np.array_equal(one.guiding, other.guiding)


def test_means_of_a_run():
    """Against the steps' own forces by the trapezoidal rule over the last 2 m."""
    simulation = Simulation(scenes.scene(duration=0.1, irregular=True, log_every=1))
    ways, forces = [], []
    for _ in simulation.steps():
        ways.append(simulation.system.positions.mean())
        forces.append(np.concatenate(rail_forces(simulation.element.wheels)))
    s, f = np.array(ways), np.array(forces)
    at = np.linspace(s[-1] - 2.0, s[-1], 4001)
    values = np.array([np.interp(at, s, column) for column in f.T])
    wanted = np.trapezoid(values, at, axis=1) / 2.0
    found = np.concatenate([simulation.means.guiding, simulation.means.loads])
    # the share of one step at the begin is taken by its integral
    np.testing.assert_allclose(found, wanted, atol=0.01 * np.abs(f[:, 8:]).max())
