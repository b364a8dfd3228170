"""The frame that yields: closed forms of springs and sliders, and its balance in the rig."""

from __future__ import annotations

import numpy as np
import pytest

from rig_model.balance import Balancer
from rig_model.frame import Frame
from rig_model.scene import load_rig_scene
from rig_model.tables import FrameTable

TOLERANCE = 5e-5 * 133.95e3


def solved(path, positions=5, **overrides):
    scene = load_rig_scene(path, {"positions": positions} | overrides)
    balancer = Balancer(scene)
    return [balancer.solve(position) for position in scene.positions()]


def test_loop_of_one_slider():
    """Between -a and a it takes 4 h (a - h/k) a cycle, the area of its parallelogram."""
    stiffness, limit, most = 2e6, 3e3, 5e-3
    frame = Frame(FrameTable(stiffness=1e6, friction=[[stiffness, limit]]))
    frame.moved(0.0, most, 0.0)
    states = [frame.moved(0.0, y, 0.0) for y in (most, -most, most)]
    lost = 4 * limit * (most - limit / stiffness)
    assert states[2].heat - states[0].heat == pytest.approx(lost, rel=1e-12)
    assert states[2].energy == pytest.approx(states[0].energy, rel=1e-12)
    assert states[1].force == pytest.approx(1e6 * most + limit, rel=1e-12)


def test_table_of_a_spring():
    frame = Frame(FrameTable(stiffness_table=[[-1e-3, -1e3], [0, 0], [2e-3, 4e3]]))
    forces = [frame.resistance(d).force for d in (-2e-3, 1e-3, 3e-3)]
    assert forces == pytest.approx([-2e3, 2e3, 6e3])
    assert frame.energy(3e-3) == pytest.approx(0.5 * 2e6 * 3e-3**2)
    assert frame.energy(-2e-3) == pytest.approx(0.5 * 1e6 * 2e-3**2)


@pytest.mark.parametrize("method", ["broyden", "newton"])
def test_spring_against_hand_balance(scene_with, method):
    path = scene_with(end="\n[rig.frame]\nstiffness = 20e6\n")
    for balance in solved(path, **{"balance.method": method}):
        assert balance.converged
        lateral = sum(float(balance.result[side]["force"][1]) for side in ("left", "right"))
        assert 20e6 * (balance.y - balance.position.y) == pytest.approx(lateral, abs=TOLERANCE)


def test_rigid_limit(scene_with):
    rigid = solved(scene_with())
    stiff = solved(scene_with(end="\n[rig.frame]\nstiffness = 1e13\n"))
    for a, b in zip(rigid, stiff, strict=True):
        assert b.converged
        np.testing.assert_allclose([b.y, b.z, b.roll], [a.y, a.z, a.roll], atol=1e-7)


def test_energy_of_a_linear_spring(scene_with):
    """Trapezoids are exact for it, but for the residuals."""
    states = [b.frame for b in solved(scene_with(end="\n[rig.frame]\nstiffness = 20e6\n"))]
    stored = states[-2].energy - states[0].energy
    put_in = states[-2].actuator_work + states[-2].contact_work
    assert abs(stored) > 0
    assert stored == pytest.approx(put_in, rel=1e-9, abs=1e-9)
