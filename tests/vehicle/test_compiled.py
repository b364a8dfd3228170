"""The compiled equations of motion and steps, against those in Python by Pinocchio."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import vehicle_parts as parts
import vehicle_scenes as scenes
from railpatch.case.fluid import Fluid
from railpatch.case.friction import Friction

from wheelset_demo.scene import scene_file
from wheelset_demo.vehicle import Simulation, VehicleScene, load_vehicle_scene
from wheelset_demo.vehicle.compiled import core_of
from wheelset_demo.vehicle.support import SupportTable
from wheelset_demo.vehicle.wet_track import WetTable

CURVE = {"straight": 25.0, "transition": 60.0, "arc": 1e3, "radius": 800.0, "cant": 0.1}

# rails, pads, a sleeper, ballast
SUPPORT = SupportTable(
    rail_mass=60.0,
    pad_stiffness=[30e6, 120e6],
    pad_damping=[20e3, 30e3],
    sleeper_mass=300.0,
    sleeper_inertia=180.0,
    ballast_stiffness=[25e6, 50e6],
    ballast_damping=[40e3, 60e3],
)


def bogie(folder: Path) -> VehicleScene:
    """One frame on two wheelsets without axle boxes, springs with sliders, dampers in series."""
    vehicle = parts.bogie()
    slider = {"friction_stiffness": [0.0, 4e6, 0.0], "friction_force": [0.0, 3e3, 0.0]}
    slider["series_stiffness"] = [0.0, 0.0, 1e6]
    vehicle["element"] = [{**element, **slider} for element in vehicle["element"]]
    return parts.load(folder, vehicle, head="hold_height = 1.1")


def braked() -> VehicleScene:
    """A locomotive whose slip is controlled, on wet rails that its wheels clean, on a support."""
    scene = load_vehicle_scene(scene_file("locomotive.toml")).with_method(**scenes.QUICK)
    fluid = Fluid(model="regimes", water_rate=0.0, recovery={"coefficient": 2e-4})
    changes = {"fluid": fluid, "friction": Friction(coefficient=0.5)}
    case = scene.case.model_copy(update=changes)
    brake = {"torque": [[0.0, -1e4], [0.1, -5e4]]}
    drives = [one.model_copy(update=brake) for one in scene.vehicle.drive]
    vehicle = scene.vehicle.model_copy(update={"drive": drives})
    wet = (WetTable(position=0.0, length=16.0, water_rate=25e-9),)
    return replace(scene, case=case, vehicle=vehicle, wet=wet, support=SUPPORT)


@pytest.fixture(scope="module", params=["coach", "bogie", "sprung", "braked"])
def given(request, tmp_path_factory) -> VehicleScene:
    """Into a transition, on irregular rails: no two bodies move alike."""
    given = scenes.scene(duration=0.4, irregular=True, speed=60.0, alignment=CURVE)
    if request.param == "sprung":
        return replace(given, support=SUPPORT)
    if request.param != "coach":
        other = bogie(tmp_path_factory.mktemp("bogie")) if request.param == "bogie" else braked()
        given = replace(other, alignment=given.alignment, irregularity=given.irregularity)
        given = given.with_run(duration=0.4).with_method(**scenes.QUICK)
    return given


@pytest.fixture(scope="module")
def moved(given) -> Simulation:
    """At its end; in Python, too, the last rates are those of the state."""
    simulation = scenes.finished(given)
    simulation.solve_again()
    return simulation


def test_accelerations_are_those_of_pinocchio(moved):
    system, state = moved.system, moved.state
    core, wanted = core_of(system), moved.rates
    n = system.count
    assert np.abs(wanted.values[n : 2 * n]).max() > 0.5
    core.evaluate(state.values)
    # the contacts, solved again from their own solution, move by their tolerance
    scale = np.abs(wanted.values[n : 2 * n]).max()
    np.testing.assert_allclose(core.rates, wanted.values, atol=1e-7 * scale)
    np.testing.assert_allclose(core.powers, wanted.powers, rtol=1e-6, atol=1e-3)
    np.testing.assert_allclose(core.slope_wrenches, system.slope_wrenches, rtol=1e-6, atol=1e-3)


def test_derivatives_are_those_of_pinocchio(moved):
    """By positions, velocities, forces in series and what the rails do."""
    system, state = moved.system, moved.state
    n, every = system.count, range(system.wheelsets)
    matrix, inputs = system.derivatives(state.values, every)
    core = core_of(system)
    core.evaluate(state.values)
    core.differentiate(state.values, np.array(every, dtype=np.int64))
    # by differences of the motion, and contacts' derivatives are by differences, too; slopes'
    # wrenches are held in the world, not in the joint: a few newtons that turn
    for got, wanted, slack in (
        (core.by_state[:, :n], matrix[n : 2 * n, :n], 1e-4),
        (core.by_state[:, n : 2 * n], matrix[n : 2 * n, n : 2 * n], 1e-5),
        (core.by_state[:, 2 * n :], matrix[n : 2 * n, 2 * n :], 1e-9),
        (core.by_inputs, inputs[n : 2 * n], 1e-5),
        (core.series_by_v, matrix[2 * n :, n : 2 * n], 1e-9),
        (core.series_by_series, np.diagonal(matrix)[2 * n :], 1e-12),
    ):
        scale = np.abs(wanted).max(axis=-1, keepdims=True)
        assert scale.max() > 0
        assert (np.abs(got - wanted) <= slack * np.maximum(scale, 1.0)).all()


def test_derivatives_column_by_column(moved):
    """Found in steps before they are due they are the same."""
    core, values = core_of(moved.system), moved.state.values
    core.evaluate(values)
    every = np.arange(moved.system.wheelsets)
    core.differentiate(values, every)
    wanted = core.by_state.copy(), core.by_inputs.copy()
    # another state's are held, until the last column is there
    shaken = values.copy()
    shaken[moved.system.vehicle.carriers[:, 1]] += 1e-3
    core.evaluate(shaken)
    core.differentiate(shaken, every)
    core.evaluate(values)
    for k in every:
        for column in range(12):
            core.find_column(k, column)
    core.differentiate(values, every[:0])
    for found, those in zip((core.by_state, core.by_inputs), wanted, strict=True):
        scale = np.abs(those).max(axis=-1, keepdims=True)
        assert (np.abs(found - those) <= 1e-5 * np.maximum(scale, 1.0)).all()


def test_steps_are_those_in_python(given):
    """With derivatives at every step, when none are old."""
    runs = []
    for compiled in (True, False):
        simulation = Simulation(given.with_run(duration=0.1, derivatives_every=1))
        assert simulation._compiled is not None
        if not compiled:
            simulation._compiled = None
        for _ in simulation.steps():
            pass
        runs.append(simulation)
    one, other = runs
    n = one.system.count
    for part in (slice(0, n), slice(n, 2 * n), slice(2 * n, None)):
        wanted = other.state.values[part]
        moved = np.abs(wanted).max()
        np.testing.assert_allclose(one.state.values[part], wanted, atol=1e-7 * moved)
    works = np.abs(other.state.work).max()
    np.testing.assert_allclose(one.state.work, other.state.work, atol=1e-5 * works)
    np.testing.assert_allclose(one.means.loads, other.means.loads, rtol=1e-5)
    np.testing.assert_allclose(one.means.guiding, other.means.guiding, atol=1.0)
    assert one.system.evaluations == other.system.evaluations + 1
    if one.system.support is not None:
        below, wanted = one.system.support, other.system.support
        np.testing.assert_allclose(below.greatest, wanted.greatest, rtol=1e-5)
        np.testing.assert_allclose(below.forces, wanted.forces, rtol=1e-5, atol=1.0)
    if one.system.drives:
        assert np.abs(other.system.drives.torque).min() > 0
        np.testing.assert_allclose(one.system.drives.torque, other.system.drives.torque, rtol=1e-6)
    if one.system.wet is not None:
        assert one.system.wet.spent == pytest.approx(other.system.wet.spent, rel=1e-5)
        assert one.system.wet.spent > 0


def test_several_steps_at_once_are_single_ones(given):
    """To the bit: a log or a histogram changes nothing."""
    short = given.with_run(duration=0.1, log_every=7)
    one, other = Simulation(short), Simulation(short, step_times=True)
    for simulation in (one, other):
        for _ in simulation.steps():
            pass
    np.testing.assert_array_equal(one.state.values, other.state.values)
    np.testing.assert_array_equal(one.state.work, other.state.work)
    np.testing.assert_array_equal(one.rates.values, other.rates.values)
