"""The time steppers: order, stiffness, old derivatives; and that both find the same motion."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import wheelset_scenes as scenes

from wheelset_demo.simulation import Simulation
from wheelset_demo.steppers import Rk4, Ros2, by_differences, exactly
from wheelset_demo.system import COUNT, WORKS, Rates, State


class Pendulums:
    """Oscillators, two of them stiff and damped, and a free sixth; a force changes with time."""

    frequency = np.array([1.0, 2.0, 40.0, 200.0, 3.0, 0.0])
    damping = np.array([0.0, 0.1, 80.0, 400.0, 0.0, 0.0])

    def rates(self, time: float, motion: np.ndarray) -> Rates:
        q, v = motion[:COUNT], motion[COUNT:]
        force = np.sin(time)
        # softening, so that the derivatives change
        acceleration = force - self.damping * v - self.frequency**2 * np.sin(q)
        work = np.zeros(len(WORKS))
        work[0] = force * v.sum()
        work[2] = self.damping @ v**2
        return Rates(np.concatenate([v, acceleration]), work, "converged")


def run(make, step: float, end: float = 1.0) -> State:
    system = Pendulums()
    stepper = make(system, step)
    # the stiff ones start where the force holds them
    motion = np.concatenate([[0.5, -0.3, 0.0, 0.0, 0.4, 0.0], np.zeros(COUNT)])
    state = State(0.0, motion, np.zeros(len(WORKS)))
    for _ in range(round(end / step)):
        state = stepper.step(state, system.rates(state.time, state.motion))
    return state


def order(make, step: float, soft: list[int]) -> float:
    exact = run(Rk4, 1e-4)
    errors = [np.abs((run(make, h).motion - exact.motion)[soft]).max() for h in (step, step / 2)]
    return float(np.log2(errors[0] / errors[1]))


def test_order_of_rk4():
    assert order(Rk4, 4e-3, [0, 1, 4]) == pytest.approx(4, abs=0.3)


@pytest.mark.parametrize("every", [1, 50])
def test_order_of_ros2(every: int):
    # any matrix will do for the order: old derivatives cost accuracy, not order
    assert order(lambda s, h: Ros2(s, h, every), 1e-2, [0, 1, 4]) == pytest.approx(2, abs=0.3)


def test_ros2_takes_steps_that_rk4_cannot():
    step = 0.05
    implicit, exact = run(lambda s, h: Ros2(s, h, 1), step), run(Rk4, 1e-4)
    assert np.abs(implicit.motion - exact.motion).max() < 0.02
    with np.errstate(all="ignore"):
        assert not np.abs(run(Rk4, step).motion).max() < 1


def test_work_keeps_the_balance_of_energies():
    def energy(state: State) -> float:
        potential = Pendulums.frequency**2 @ (1 - np.cos(state.q))
        return 0.5 * float(state.v @ state.v) + float(potential)

    start = State(
        0.0, np.array([0.5, -0.3, 0.0, 0.0, 0.4, 0.0, *np.zeros(6)]), np.zeros(len(WORKS))
    )
    for make, bound in ((Rk4, 1e-7), (lambda s, h: Ros2(s, h, 5), 1e-4)):
        state = run(make, 2e-3)
        residual = energy(state) - energy(start) - state.work[0] + state.work[2]
        assert abs(residual) < bound


def test_exact_derivatives_are_those_by_differences(tmp_path: Path):
    values = {"y": 1e-3, "speed": 20.0, "tolerance": 1e-10}
    simulation = Simulation(scenes.scene(tmp_path, "hunting.toml", **values))
    system, state = simulation.system, simulation.state
    rates = system.rates(state.time, state.motion)
    exact = exactly(system, state, rates, 1e-3)
    differences_found = by_differences(system, state, rates, 1e-3)
    # by what changes a force by a good part: lengths and angles, then rates; pitch changes nothing
    usual = np.array([1e-3, 1e-3, 1e-4, 1e-4, 1e-3, 1e-3, *[0.02] * 6])
    error = np.abs(exact - differences_found)[:, : 2 * COUNT] * usual
    scale = np.abs(differences_found[:, : 2 * COUNT] * usual).max(axis=1) + 1e-9
    friction, damping = (2 * COUNT + WORKS.index(name) for name in ("friction", "damping"))
    relative = error.max(axis=1) / scale
    # forward differences: half of 1e-5 of creepage over some 1e-3 where friction is used up; they
    # say nothing of the dampers at rest, whose power is a square. Friction's row is no exact one
    assert np.delete(relative, [friction, damping]).max() < 5e-3
    # but has what makes it stiff: z, yaw and the rates of y, z and roll
    stiff = [2, 4, COUNT + 1, COUNT + 2, COUNT + 3]
    assert (error[friction, stiff] / scale[friction]).max() < 0.05
    # as time goes on nothing but the reference moves
    by_time = differences_found[:, -1]
    np.testing.assert_allclose(exact[:, -1], by_time, rtol=1e-6, atol=1e-9 * by_time.max())


def test_explicit_and_implicit_find_the_same_motion(tmp_path: Path):
    found = {}
    for stepper, step in (("rk4", 2.5e-4), ("ros2", 5e-4)):
        values = {"stepper": stepper, "step": step, "distance": 2.0, "log_every": 1000}
        simulation = Simulation(scenes.scene(tmp_path, "s1002.toml", **values))
        simulation.run()
        found[stepper] = simulation.state
    explicit, implicit = found["rk4"], found["ros2"]
    assert explicit.time == pytest.approx(implicit.time, abs=1e-12)
    scale = np.array([1, 4e-3, 1e-4, 3e-4, 2e-3, 4, 20, 0.05, 1e-2, 4e-3, 0.04, 43])
    difference = np.abs(explicit.motion - implicit.motion) / scale
    assert difference[:COUNT].max() < 1e-3
    assert difference[COUNT:].max() < 2e-2


def test_mirrored_start_gives_the_mirrored_run(tmp_path: Path):
    mirror = np.array([1, -1, 1, -1, -1, 1] * 2)
    values = {"stepper": "rk4", "step": 5e-4, "distance": 1.0, "log_every": 1000}
    found = []
    for sign in (np.ones(2 * COUNT), mirror):
        simulation = Simulation(scenes.scene(tmp_path, "s1002.toml", **values))
        start = simulation.state
        simulation.state = State(0.0, sign * start.motion, start.work)
        # without what the search for the released state has left
        simulation.system.element.reset()
        simulation.run()
        found.append(sign * simulation.state.motion)
    difference = np.abs(found[0] - found[1]) / (np.abs(found[0]) + 1e-6)
    assert difference.max() < 1e-9
    # released on the other side: differences forward are not mirrored, so only nearly so
    other = Simulation(scenes.scene(tmp_path, "s1002.toml", y=-0.004)).state
    np.testing.assert_allclose(mirror * other.motion, start.motion, rtol=1e-5, atol=1e-9)


def test_released_at_rest_in_its_fast_motions(tmp_path: Path):
    simulation = Simulation(scenes.scene(tmp_path, "s1002.toml"))
    scene, state = simulation.scene, simulation.state
    assert state.q[1] == scene.case.wheelset.y
    assert state.v[0] == scene.speed
    rates = simulation.system.rates(0.0, state.motion)
    assert np.abs(rates.motion[COUNT + 1 :]).max() < 1e-3
    force = simulation.system.element.contact_wrench[0, 2]
    assert -force == pytest.approx(scene.case.wheelset.vertical_force, rel=1e-3)


def test_a_restored_contact_goes_on_with_the_same_bits(tmp_path: Path):
    values = {"step": 1e-3, "distance": 0.4, "log_every": 1000}
    simulation = Simulation(scenes.scene(tmp_path, "s1002.toml", **values))
    saved, start = simulation.system.element.save(), simulation.state
    simulation.run()
    first = simulation.state
    simulation.system.element.restore(saved)
    simulation.state = start
    simulation.run()
    np.testing.assert_array_equal(first.motion, simulation.state.motion)
    np.testing.assert_array_equal(first.work, simulation.state.work)
