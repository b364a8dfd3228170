"""The frame that yields: closed forms of springs and sliders, and its balance in the rig."""

from __future__ import annotations

import numpy as np
import pytest
from railpatch.errors import CaseError

from rig_model.balance import Balancer
from rig_model.frame import Frame
from rig_model.scene import load_rig_scene
from rig_model.tables import FrameTable

TOLERANCE = 5e-5 * 133.95e3
# rad, a position of 9 mrad and one of 12
TURNED = [[0, 0.009], [1, 0.012]]


def solved(path, positions=5, **overrides):
    scene = load_rig_scene(path, {"positions": positions} | overrides)
    balancer = Balancer(scene)
    return [balancer.solve(position) for position in scene.positions()]


def test_loop_of_one_slider():
    """Between -a and a it takes 4 h (a - h/k) a cycle, the area of its parallelogram."""
    stiffness, limit, most = 2e6, 3e3, 5e-3
    frame = Frame(FrameTable(stiffness=1e6, friction=[[stiffness, limit]]))
    frame.moved(0.0, most, 0.0, np.zeros(2))
    states = [frame.moved(0.0, y, 0.0, np.zeros(2)) for y in (most, -most, most)]
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


GAUGE = "\n[rig.frame]\ngauge_stiffness = 8e6\n"


@pytest.mark.parametrize(
    ("end", "method"),
    [(GAUGE, "broyden"), (GAUGE, "newton"), (f"{GAUGE}stiffness = 20e6\n", "newton")],
)
def test_gauge_against_hand_balance(scene_with, end, method):
    """Rollers placed by hand where the gauge has opened give the same forces in balance."""
    *_, balance = solved(scene_with(end=end), 2, **{"balance.method": method, "yaw": TURNED})
    assert balance.converged
    force = {side: balance.result[side]["force"][1] for side in ("left", "right")}
    assert 8e6 * balance.gauge == pytest.approx((force["left"] - force["right"]) / 2, abs=TOLERANCE)
    assert balance.gauge > 1e-4
    assert balance.frame.gauge_force == pytest.approx(8e6 * balance.gauge, rel=1e-12)
    for side, way in (("left", -0.5), ("right", 0.5)):
        end += f"\n[track.{side}]\noffset = [0, {way * balance.gauge}, 0]\n"
    rigid = end.replace(GAUGE, "\n[rig.frame]\ngauge_stiffness = 1e13\n")
    *_, placed = solved(scene_with(end=rigid), 2, **{"balance.method": method, "yaw": TURNED})
    assert placed.z == pytest.approx(balance.z, abs=1e-7)
    for side, value in force.items():
        assert placed.result[side]["force"][1] == pytest.approx(value, abs=4 * TOLERANCE)


def test_rigid_limit_of_the_gauge(scene_with):
    rigid = solved(scene_with(), 3)
    stiff = solved(scene_with(end="\n[rig.frame]\ngauge_stiffness = 1e13\n"), 3)
    for a, b in zip(rigid, stiff, strict=True):
        assert b.converged
        assert abs(b.gauge) < 1e-8
        np.testing.assert_allclose([b.y, b.z, b.roll], [a.y, a.z, a.roll], atol=1e-7)


def test_energy_of_frame_and_gauge(scene_with):
    """Trapezoids are exact for linear springs."""
    states = [b.frame for b in solved(scene_with(end=f"{GAUGE}stiffness = 20e6\n"), 4)]
    stored = states[-2].energy - states[0].energy
    assert stored == pytest.approx(states[-2].actuator_work + states[-2].contact_work, rel=1e-9)
    opened = states[-2].gauge_opening ** 2 - states[0].gauge_opening ** 2
    assert abs(opened) * 4e6 > 0.05


def test_gauge_needs_no_other_spring_and_friction_does(scene_with):
    with pytest.raises(CaseError, match=r"rig\.frame\.stiffness: value is missing"):
        load_rig_scene(scene_with(end=f"{GAUGE}friction = [[1e6, 1e3]]\n"))


def test_dry_friction_lags(scene_with):
    """The way back lies further out, by less than 2 h/k, and by 2 h where the force is alike."""
    end = "\n[rig.frame]\nstiffness = 20e6\nfriction = [[400e6, 2e3]]\n"
    overrides = {"yaw": [[0, 0.010], [0.5, 0.018], [1, 0.010]]}
    overrides |= {"lateral_position": [[0, 0], [1, 0]]}
    up, _, back = solved(scene_with(end=end), 3, **overrides)
    lag = back.frame.deflection - up.frame.deflection
    assert up.frame.force < 0
    assert 0 < lag < 2 * 2e3 / 20e6
    # spring and slider by hand: -F = k d + h on the way out, k d - h on the way back
    for state, way in ((up.frame, 1), (back.frame, -1)):
        assert -state.force == pytest.approx(20e6 * state.deflection + way * 2e3, rel=1e-9)


def test_where_a_second_patch_takes_over(measured_file, tmp_path):
    """Near -18 mrad the left wheel's second patch bends the lateral force's slope to ten times."""
    path = tmp_path / "scene.toml"
    path.write_text(measured_file.read_text() + "\n[rig.frame]\nstiffness = 20e6\n")
    overrides = {"yaw": [[0, -0.014], [1, -0.018]]}
    overrides |= {"lateral_position": [[0, -6.563816e-3], [0.5, -6.588622e-3], [1, -6.6e-3]]}
    assert all(balance.converged for balance in solved(path, 3, **overrides))
