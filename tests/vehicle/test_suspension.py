"""Springs, dampers and stops: forces without resultant, energies, derivatives."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
import pytest
import vehicle_scenes as scenes

from wheelset_demo.vehicle import Simulation
from wheelset_demo.vehicle.elements import Stop


@pytest.fixture(scope="module")
def simulation() -> Simulation:
    return Simulation(scenes.scene())


def parts(simulation: Simulation, values: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """q, v and forces in series."""
    n = simulation.system.count
    return values[:n], values[n : 2 * n], values[2 * n :]


def test_vehicle_has_fifty_degrees_of_freedom(simulation):
    model = simulation.system.model
    assert model.nq == model.nv == 50
    assert pin.computeTotalMass(model) == pytest.approx(simulation.scene.vehicle.mass)


@pytest.mark.parametrize("seed", range(3))
def test_elements_give_no_momentum(simulation, seed):
    """The whole vehicle moved or turned as one does no work against its elements: their resultant
    force and moment vanish, however the bodies stand."""
    system = simulation.system
    q, v, series = parts(simulation, scenes.shaken(simulation, seed))
    tau = system.suspension.step(q, v, series)
    data = system.model.createData()
    pin.computeJointJacobians(system.model, data, q)
    pin.forwardKinematics(system.model, data, q)
    # velocities of all coordinates in a common motion, from the bodies' own
    rng = np.random.default_rng(seed)
    along, turning = rng.standard_normal(3), rng.standard_normal(3)
    rows, wanted = [], []
    for joint in system.vehicle.joints.values():
        world = pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
        rows.append(pin.getJointJacobian(system.model, data, joint, world))
        there = data.oMi[joint].translation
        wanted.append(np.concatenate([along + np.cross(turning, there), turning]))
    common, *_ = np.linalg.lstsq(np.vstack(rows), np.concatenate(wanted), rcond=None)
    np.testing.assert_allclose(np.vstack(rows) @ common, np.concatenate(wanted), atol=1e-9)
    scale = np.abs(tau).max() * np.abs(common).max()
    # turns of elements are taken for small ones: their moments are true to the second order
    assert abs(tau @ common) < 1e-10 * scale


def test_power_is_that_of_energy_and_dampers(simulation):
    """-tau.v = d(potential)/dt + power of the dampers, with the forces in series moving on."""
    system = simulation.system
    suspension = system.suspension
    q, v, series = parts(simulation, scenes.shaken(simulation, 7))
    v = 0.1 * v
    tau = suspension.step(q, v, series)
    rates, power = suspension.series_rates.copy(), suspension.damping_power
    assert power > 0
    length = 1e-5
    energies = []
    for sign in (1.0, -1.0):
        moved = sign * length
        suspension.step(q + moved * v, v, series + moved * rates)
        energies.append(suspension.potential(series + moved * rates))
    change = (energies[0] - energies[1]) / (2 * length)
    # of turning springs to the second order of their turns, some 0.03
    assert -tau @ v == pytest.approx(change + power, rel=2e-3)


def test_derivatives_are_those_of_the_forces(simulation):
    """By velocities and forces in series exactly, by coordinates but for how elements turn."""
    system = simulation.system
    suspension = system.suspension
    q, v, series = parts(simulation, simulation.state.values.copy())
    tau = suspension.step(q, v, series).copy()
    by_q, by_v, by_series = suspension.jacobian()
    rng = np.random.default_rng(1)
    for _ in range(4):
        way = rng.standard_normal(len(v))
        moved = suspension.step(q, v + way, series) - tau
        np.testing.assert_allclose(by_v @ way, moved, atol=1e-9 * np.abs(moved).max())
        way = 1e-6 * rng.standard_normal(len(q))
        moved = suspension.step(q + way, v, series) - tau
        # preloads that turn with the bodies: some hundredths of the springs' stiffness
        assert np.linalg.norm(by_q @ way - moved) < 0.05 * np.linalg.norm(moved)
        way = rng.standard_normal(len(series))
        moved = suspension.step(q, v, series + way) - tau
        np.testing.assert_allclose(by_series @ way, moved, atol=1e-9 * np.abs(moved).max())


def test_bounce_of_car_body_and_bogies(simulation):
    """On wheelsets held still, in closed form: bounce, pitch with the bogies at half the distance
    of their centres and springs and rods along the track below, and a bogie that yaws."""
    system = simulation.system
    q, v, series = parts(simulation, simulation.state.values)
    system.suspension.step(q, v, series)
    stiffness = -system.suspension.jacobian()[0]
    k1, k2 = 8 * 1.22e6, 4 * 430e3
    half, base = 0.5 * 19.0, 0.5 * 2.56
    car, bogies = system.vehicle.columns[0], system.vehicle.columns[1:3]
    bounce, pitch = np.zeros((2, len(q)))
    bounce[bogies[:, 2]] = 1.0
    pitch[bogies[:, 2]] = -half, half
    below = 4 * 160e3 * (1.8 - 0.8275) ** 2 + 2 * 5e6 * (1.8 - 0.6) ** 2
    for way, coordinate, arm, more in ((bounce, car[2], 1.0, 0.0), (pitch, car[5], half, below)):
        both = np.array([np.eye(len(q))[coordinate], way])
        wanted = arm**2 * np.array([[k2, -k2], [-k2, k1 + k2]])
        wanted[0, 0] += more
        np.testing.assert_allclose(both @ stiffness @ both.T, wanted, rtol=1e-9)
    # a bogie that yaws alone: primary springs at the axle boxes, secondary ones at the sides
    yaw = bogies[0, 3]
    primary = 4 * (31.391e6 * 1.0**2 + 3.884e6 * base**2)
    secondary = 2 * 160e3 * 1.0**2
    assert stiffness[yaw, yaw] == pytest.approx(primary + secondary, rel=1e-9)


def test_stop():
    """Slack, then the table's straight lines; its energy is the area."""
    stop = Stop([[0.02, 0.0], [0.03, 100.0], [0.04, 1000.0]])
    assert [stop.force(d) for d in (0.0, 0.019, -0.02)] == [0.0, 0.0, 0.0]
    assert stop.force(0.025) == pytest.approx(50.0)
    assert stop.force(-0.035) == pytest.approx(-550.0)
    assert stop.force(0.05) == pytest.approx(1900.0)
    d = np.linspace(0.0, 0.05, 20001)
    area = np.trapezoid([stop.force(x) for x in d], d)
    assert stop.energy(-0.05) == pytest.approx(area, rel=1e-6)
    assert stop.slope(0.035) == pytest.approx(9e4)


def test_stop_of_one_side():
    """A table from displacements below 0 on is the whole curve, and goes on at both ends."""
    stop = Stop([[-0.01, -50.0], [0.0, 0.0], [0.02, 0.0], [0.03, 1000.0]])
    assert [stop.force(d) for d in (-0.02, -0.005, 0.01, 0.04)] == pytest.approx(
        [-100.0, -25.0, 0.0, 2000.0]
    )
    assert stop.energy(0.0) == 0.0
    assert stop.energy(-0.02) == pytest.approx(0.5 * 0.02 * 100.0)
    assert stop.energy(0.03) == pytest.approx(0.5 * 0.01 * 1000.0)
    assert stop.slope(-0.5) == pytest.approx(5e3)
