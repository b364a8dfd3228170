"""Runs: at rest, straight on, through a curve; balances; threads."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pinocchio as pin
import pytest
import vehicle_scenes as scenes
from railpatch import CaseError
from railpatch.case.common import Bulk, Temperature
from railpatch.case.types import SIDES

from wheelset_demo.scene import GRAVITY
from wheelset_demo.vehicle import Simulation
from wheelset_demo.vehicle.steppers import Bdf2, Ros2
from wheelset_demo.vehicle.trace import run_vehicle

FULL = {"normal": "half_space", "tangential": "full"}


def test_wheels_carry_the_weight_equally():
    """mg/8 each; at the start the lateral force of spin, on a contact that leans, is not yet in
    balance: a thousandth. What wheels bounce with from it has died down after 0.6 s."""
    simulation = Simulation(scenes.scene(method=FULL, duration=0.6))
    weight = simulation.scene.vehicle.mass * GRAVITY
    np.testing.assert_allclose(-simulation.element.wheels[:, :, 2], weight / 8, rtol=2e-3)
    for _ in simulation.steps():
        pass
    loads = -simulation.element.wheels[:, :, 2]
    assert loads.sum() == pytest.approx(weight, rel=1e-5)
    np.testing.assert_allclose(loads, weight / 8, rtol=1e-4)
    # and it stays in the middle
    states = simulation.element.states
    assert np.abs(states[:, [1, 4]]).max() < 1e-6
    np.testing.assert_allclose(states[:, 6], simulation.scene.speed, rtol=1e-4)


def test_energy_closes_on_irregular_rails():
    """Change of kinetic, gravity's and springs' energy = work of contacts and drive less dampers'.

    The rest is the time steps' error: it falls with them.
    """
    missing = []
    for step in (1e-3, 2.5e-4):
        given = scenes.scene(duration=0.3, irregular=True, step=step)
        trace = run_vehicle(Simulation(given))
        assert trace.failure is None
        missing.append(trace.open_balance() / trace.lost())
    assert missing[0] < 0.02
    assert missing[1] < 0.3 * missing[0]


def test_momentum_follows_from_the_forces():
    """m dv/dt of all bodies = contact forces + weight + drive, at any moment of a run."""
    simulation = scenes.finished(scenes.scene(duration=0.2, irregular=True))
    system, state = simulation.system, simulation.state
    values = simulation.rates.values
    pin.forwardKinematics(
        system.model, system.data, state.q, state.v, values[system.count : 2 * system.count]
    )
    data = system.data
    total = np.zeros(3)
    for joint in system.vehicle.joints.values():
        mass = system.model.inertias[joint].mass
        total += mass * data.oMi[joint].rotation @ data.a[joint].linear
        spin, speed = data.v[joint].angular, data.v[joint].linear
        total += mass * data.oMi[joint].rotation @ np.cross(spin, speed)
    forces = simulation.element.contact_wrench[:, :3].sum(axis=0)
    forces[0] += system.slope_wrenches[:, :, 0].sum()
    forces[2] += simulation.scene.vehicle.mass * GRAVITY
    ahead = system._ahead(state.q)
    speed = float(ahead @ state.v)
    forces[0] += simulation.scene.run.speed_control * (simulation.scene.speed - speed)
    np.testing.assert_allclose(total, forces, atol=1e-3)


@pytest.fixture(scope="module")
def curving() -> tuple[Simulation, np.ndarray]:
    """In the arc of a right-hand curve with too little cant; means over a sway of the car body."""
    alignment = {
        "straight": 30.0,
        "transition": 80.0,
        "arc": 1000.0,
        "radius": 700.0,
        "cant": 0.10,
    }
    given = scenes.scene(speed=40.0, alignment=alignment, duration=5.0, step=2e-3, log_every=25)
    simulation = Simulation(given)
    rows = [
        [*forces(simulation), *moments(simulation)]
        for state in simulation.steps()
        if state.time > 3.5
    ]
    return simulation, np.mean(rows, axis=0)


def forces(simulation: Simulation) -> list[float]:
    """N, of all wheels: outward and down as they are, as V^2/R and gravity ask for."""
    system, mass = simulation.system, simulation.scene.vehicle.mass
    angle = float(system.alignment.cant_angle(system.positions[0]))
    bend = float(np.hypot(*simulation.state.v[:2])) ** 2 / simulation.scene.alignment.radius
    wheels = simulation.element.wheels
    return [
        wheels[:, :, 1].sum(),
        -wheels[:, :, 2].sum(),
        mass * (bend * np.cos(angle) - GRAVITY * np.sin(angle)),
        mass * (GRAVITY * np.cos(angle) + bend * np.sin(angle)),
    ]


def moments(simulation: Simulation) -> list[float]:
    """N m, about the track's centre line at the middle of the vehicle: of the contact forces, of
    weights and V^2/R outward of all bodies, gyroscopic of the wheelsets."""
    system, alignment = simulation.system, simulation.system.alignment
    middle = np.array([system.positions.mean()])
    rotations, origins = alignment.frames(middle)
    axis = rotations[0][:, 0]
    radius = simulation.scene.alignment.radius
    speed = float(np.hypot(*simulation.state.v[:2]))
    carried = bodies = 0.0
    for joint in system.vehicle.joints.values():
        place = system.data.oMi[joint].translation
        heading = float(alignment.heading(alignment.foot(place[None], middle))[0])
        bend = speed**2 / radius
        field = np.array([bend * np.sin(heading), -bend * np.cos(heading), GRAVITY])
        force = system.model.inertias[joint].mass * field
        bodies += axis @ np.cross(place - origins[0], force)
    element = simulation.element
    for k, joint in enumerate(element.joints):
        force, moment = element.contact_wrench[k].reshape(2, 3) @ element.track_rotation(k).T
        centre = system.data.oMi[joint].translation
        carried += axis @ (moment + np.cross(centre - origins[0], force))
    spin = np.abs(simulation.state.v[system.vehicle.spins]).sum()
    inertia = simulation.scene.vehicle.wheelset[0].inertia[1]
    return [carried, bodies, inertia * spin * speed / radius]


def test_forces_in_a_curve(curving):
    """Of the whole vehicle: across the track m (V^2/R cos a - g sin a), down m (g cos a + V^2/R
    sin a)."""
    _, (across, down, wanted_across, wanted_down, *_) = curving
    # the track's steps are of order 2: contacts that bounce would show here
    assert down == pytest.approx(wanted_down, rel=2e-4)
    assert across == pytest.approx(wanted_across, rel=0.01)


def test_load_transfer_in_a_curve(curving):
    """The contact forces carry weights and V^2/R outward of all bodies, and turn the wheelsets'
    spin with the curve."""
    _, (*_, carried, bodies, gyroscopic) = curving
    assert abs(bodies) > 1e5
    assert gyroscopic > 0.02 * abs(bodies)
    assert carried == pytest.approx(-bodies + gyroscopic, rel=0.01)


def test_outer_wheels_carry_more(curving):
    simulation, _ = curving
    loads = -simulation.element.wheels[:, :, 2]
    assert (loads[:, 0] > loads[:, 1]).all()
    # outward of the middle by the difference of rolling radii that the curve asks for
    assert (simulation.element.states[:, 1] < -1e-4).all()


@pytest.mark.parametrize("method", [FULL, {"normal": "hertz", "tangential": "fastsim"}])
def test_threads_give_the_same_bits(method):
    found = []
    for threads in (1, 2, 3):
        given = scenes.scene(duration=0.06, irregular=True, threads=threads, method=method)
        found.append(scenes.finished(given).state.values.tobytes())
    assert found[0] == found[1] == found[2]


def test_steppers_agree():
    """Two methods of order 2, of one and of two evaluations a step: bodies of the one are where
    the other has them."""
    places = []
    for stepper in (Bdf2, Ros2):
        simulation = Simulation(scenes.scene(duration=0.3, irregular=True))
        start = simulation.state.q[1].copy()
        simulation._stepper = stepper(simulation.system, 1e-3, 10)
        simulation._compiled = None
        for _ in simulation.steps():
            pass
        places.append(simulation.state.q)
    lateral = simulation.system.vehicle.carriers[:, 1]
    assert np.abs(places[0][lateral] - start).max() > 1e-3
    away = np.abs(places[0] - places[1])
    away[simulation.system.vehicle.spins] = 0.0
    assert away.max() < 5e-5


def test_states_of_a_run():
    """What a log hooks into."""
    simulation = Simulation(scenes.scene(duration=0.02, irregular=True, log_every=5))
    times = []
    for state in simulation.steps():
        times.append(state.time)
        poses = simulation.body_poses()
        assert len(poses) == 15
        rotation, place = poses["wheelset_1"]
        np.testing.assert_allclose(place, state.q[18:21], atol=1e-12)
        assert rotation.shape == (3, 3)
    np.testing.assert_allclose(times, [0.0, 0.005, 0.01, 0.015, 0.02], atol=1e-12)
    works = simulation.state.work
    assert works[1] == pytest.approx(works[4:].sum())


def test_wheels_warm() -> None:
    """Each wheel of a vehicle its own, on rails that are always new; one step of time a step."""
    given = scenes.scene(method=FULL, duration=0.01, log_every=1)
    heat = Temperature(wheel=40.0, rail=20.0, bulk=Bulk(mass=[0.05, 0.0]))
    warm = replace(given, case=given.case.model_copy(update={"temperature": heat}))
    simulation = Simulation(warm)

    def now(name: str) -> np.ndarray:
        results = [simulation.element.result(k) for k in range(4)]
        return np.array([[result[side][name] for side in SIDES] for result in results])

    steps, before, lost = simulation.steps(), None, np.zeros((4, 2))
    for _ in steps:
        flow = now("wheel_heat")
        if before is not None:
            lost += 0.5 * given.run.step * (before + flow)
        before = flow
    assert (now("rail_temperature") == 20.0).all()
    cooled = 0.05 * heat.heat_capacity[0] * (now("wheel_temperature") - 40.0)
    assert (cooled < 0).all()
    # heat is held over a step, what flows hardly changes
    np.testing.assert_allclose(cooled, lost, rtol=1e-2)
    rails = heat.model_copy(update={"bulk": Bulk(mass=1.0)})
    case = given.case.model_copy(update={"temperature": rails})
    with pytest.raises(CaseError, match=r"temperature\.bulk\.mass.*always new"):
        Simulation(replace(given, case=case))
