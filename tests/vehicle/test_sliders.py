"""Dry friction: a spring before a slider, in closed form and in energies."""

from __future__ import annotations

import numpy as np
import pytest
import vehicle_parts as parts

from wheelset_demo.scene import GRAVITY
from wheelset_demo.vehicle import Simulation
from wheelset_demo.vehicle.trace import run_vehicle

SPRING, LIMIT, SHARE = 4e6, 3e3, 0.2  # N/m, N, -


def rubbing(**friction):
    """A frame whose springs to one wheelset have sliders across, the others none."""
    vehicle = parts.bogie()
    places = vehicle["element"][0]["places"]
    spring = dict(vehicle["element"][0])
    given = {"friction_stiffness": [0.0, SPRING, 0.0], **friction}
    vehicle["element"] = [
        {**spring, "name": "with sliders", "places": places[:2], **given},
        {**spring, "places": places[2:]},
    ]
    return vehicle


def moved(simulation, y):
    """Force of the elements on the frame, N, as it stands y (m) across from rest."""
    system = simulation.system
    q = system.vehicle.rest.copy()
    frame = system.vehicle.columns[0]
    q[frame[1]] += y
    tau = system.suspension.step(q, np.zeros(len(q)), np.zeros(system.suspension.series_count))
    return tau[frame[1]]


@pytest.mark.parametrize(("force", "share"), [(LIMIT, 0.0), (0.0, SHARE), (LIMIT, SHARE)])
def test_a_slow_cycle(tmp_path, force, share):
    """Up and down across: springs alone give -k y; the two sliders stick, then slip at their limit,
    and the loop's area is 4 F (a - F/t) each."""
    limits = {"friction_force": [0.0, force, 0.0], "friction_coefficient": [0.0, share, 0.0]}
    with_sliders = Simulation(parts.load(tmp_path, rubbing(**limits)))
    suspension = with_sliders.system.suspension
    moved(with_sliders, 0.0)
    suspension.release()
    plain = -4 * 5e6
    # the load on each of four springs
    limit = force + share * parts.BODY["mass"] * GRAVITY / 4
    reach = 4e-3
    way = np.concatenate(
        [
            np.linspace(0, reach, 401),
            np.linspace(reach, -reach, 801),
            np.linspace(-reach, reach, 801),
        ]
    )
    forces = []
    for y in way:
        forces.append(moved(with_sliders, y) - plain * y)
        suspension.settle()
    forces = np.array(forces)
    # first loading in closed form
    wanted = -2 * np.minimum(SPRING * way[:401], limit)
    np.testing.assert_allclose(forces[:401], wanted, rtol=1e-6, atol=1e-6 * limit)
    # unloading: from -2 F with the springs' slope to +2 F
    wanted = np.minimum(-2 * limit + 2 * SPRING * (reach - way[401:1202]), 2 * limit)
    np.testing.assert_allclose(forces[401:1202], wanted, rtol=1e-6, atol=1e-6 * limit)
    loop = slice(401, None)
    area = -np.trapezoid(forces[loop], way[loop])
    assert area == pytest.approx(2 * 4 * limit * (reach - limit / SPRING), rel=2e-3)


def test_a_slider_below_its_limit_is_a_spring(tmp_path):
    """And gives all its energy back: nothing is turned into heat."""
    simulation = Simulation(parts.load(tmp_path, rubbing(friction_force=[0.0, 1e9, 0.0])))
    suspension = simulation.system.suspension
    moved(simulation, 0.0)
    suspension.release()
    rest = suspension.potential(np.zeros(0))
    assert moved(simulation, 1e-3) == pytest.approx(-(4 * 5e6 + 2 * SPRING) * 1e-3, rel=1e-9)
    assert suspension.damping_power == 0.0
    stored = suspension.potential(np.zeros(0)) - rest
    assert stored == pytest.approx(0.5 * (4 * 5e6 + 2 * SPRING) * 1e-6, rel=1e-9)


def test_energy_closes_with_sliders(tmp_path):
    """On irregular rails, where sliders stick and slip: bodies and springs change by the work of
    contacts and drive, less what dampers and sliders took; better with shorter steps."""
    missing, works = [], []
    more = '[irregularity]\nlevel = "high"\nbegins = 2.0\n'
    for step in (1e-3, 2.5e-4):
        vehicle = rubbing(
            friction_force=[0.0, 300.0, 0.0],
            friction_coefficient=[0.0, 0.02, 0.0],
        )
        # sliders are looked at, not old derivatives of contacts
        scene = parts.load(
            tmp_path, vehicle, more=more, duration=0.4, step=step, derivatives_every=10
        )
        simulation = Simulation(scene)
        slipped = []
        trace = run_vehicle(
            simulation,
            lambda _, s=simulation, found=slipped: found.append(
                s.system.suspension.friction_force.copy()
            ),
        )
        assert trace.failure is None
        missing.append(trace.open_balance() / trace.lost())
        works.append(trace.lost())
        rubbed = np.abs(np.array(slipped))
        assert rubbed.max() > 350.0
        assert (rubbed[-100:] < 0.9 * rubbed.max()).any()
    assert missing[0] < 0.05
    assert missing[1] < 0.5 * missing[0]
    assert works[0] == pytest.approx(works[1], rel=0.02)


def test_turning_slider(tmp_path):
    """About z: a moment up to its limit."""
    vehicle = parts.bogie()
    vehicle["element"][0] |= {
        "turning_friction_stiffness": [0.0, 0.0, 1e7],
        "turning_friction_moment": [0.0, 0.0, 500.0],
    }
    simulation = Simulation(parts.load(tmp_path, vehicle))
    system = simulation.system
    moved(simulation, 0.0)
    system.suspension.release()
    found = []
    for yaw in (1e-5, 2e-4):
        q = system.vehicle.rest.copy()
        q[system.vehicle.columns[0][3]] += yaw
        system.suspension.step(q, np.zeros(len(q)), np.zeros(0))
        found.append(np.abs(system.suspension.friction_force))
    np.testing.assert_allclose(found[0], 100.0, rtol=1e-6)
    np.testing.assert_allclose(found[1], 500.0, rtol=1e-6)
