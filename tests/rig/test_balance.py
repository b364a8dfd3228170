"""The balance: equilibrium checked by other code, robustness, and what a failure looks like."""

from __future__ import annotations

import math

import numpy as np
import pytest

from rig_model.balance import Balancer
from rig_model.scene import load_rig_scene

LOAD = 133.95e3
TOLERANCE = 5e-5 * LOAD


def solved(path, **overrides):
    scene = load_rig_scene(path, overrides)
    balancer = Balancer(scene)
    return [balancer.solve(position) for position in scene.positions()]


@pytest.fixture(scope="module")
def run(nominal_file):
    return solved(nominal_file, positions=13)


def creep_torque(balance):
    """N m about the axle: pressures on a body of revolution have no moment about its axis."""
    total = 0.0
    for side in ("left", "right"):
        for patch in balance.result[side]["patches"]:
            x, y = patch["creep_force"]
            along = x * math.cos(balance.position.yaw) + y * math.sin(balance.position.yaw)
            total += along * balance.result[side]["rolling_radius"]
    return total


def test_nominal_profiles_run(run):
    assert [balance.status for balance in run] == ["converged"] * 13
    assert max(balance.evaluations for balance in run[1:]) <= 8


def test_forces_balance(run):
    """Summed from the patches' forces and places, not from the wheels' resultants."""
    for balance in run:
        vertical, roll_moment = 0.0, 0.0
        for side in ("left", "right"):
            for patch in balance.result[side]["patches"]:
                c, s = math.cos(patch["contact_angle"]), math.sin(patch["contact_angle"])
                lateral, normal = patch["creep_force"][1], -patch["normal_force"]
                fy, fz = c * lateral - s * normal, s * lateral + c * normal
                _, y, z = patch["position"]
                centre = balance.z - 0.3556
                vertical += fz
                roll_moment += (y - balance.position.y) * fz - (z - centre) * fy
        assert -vertical == pytest.approx(LOAD, abs=1.01 * TOLERANCE)
        # the patches' own moments about their reference, some 20 N m, are left out here
        assert roll_moment == pytest.approx(0, abs=50 + TOLERANCE)
        assert np.abs(balance.residuals).max() <= TOLERANCE


def test_load_shifts_with_yaw(run):
    """At +18 mrad the lateral forces load the left wheel, at -18 mrad the right one."""
    share = {
        round(1e3 * balance.position.yaw): balance.result["left"]["force"][2] / -LOAD
        for balance in run
    }
    assert share[18] > 0.6
    assert share[-18] < 0.4


def test_torque_in_wheelset_axes_frees_the_axle(scene_with):
    free = solved(scene_with(), positions=5)
    track = solved(scene_with(end='\n[rig.balance]\naxle_torque = "track"\n'), positions=5)
    for balance in free:
        assert balance.converged
        # lateral creep forces lie beside the axle, by their place along the roller: some N m
        assert abs(creep_torque(balance)) < 25
        yaw, (along, across, _) = balance.position.yaw, balance.result["moment"]
        # of all forces, about a level axle: its roll makes no difference
        assert abs(math.cos(yaw) * across - math.sin(yaw) * along) < 1.1 * TOLERANCE
    assert abs(creep_torque(track[1])) > 150
    assert abs(free[1].pitch_rate - track[1].pitch_rate) > 1e-3
    assert free[0].pitch_rate == pytest.approx(track[0].pitch_rate, abs=1e-4)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("coefficient = 0.52", "coefficient = 0.05"),
        ("vertical_force = 133.95e3", "vertical_force = 320e3"),
        ("roller_pitch_rate = 5.587302", "roller_pitch_rate = 1.1"),
        ("roller_pitch_rate = 5.587302", "roller_pitch_rate = -5.587302"),
    ],
)
def test_load_speed_and_friction_are_free(scene_with, old, new):
    run = solved(scene_with((old, new)), positions=9)
    assert all(balance.converged for balance in run)


def test_start_out_of_contact_is_mended(scene_with):
    path = scene_with(end="\n[rig.start]\nz = -0.01\nroll = 0.0\npitch_rate = -12.5\n")
    first = solved(path, positions=2)[0]
    assert first.converged
    assert first.z == pytest.approx(solved(scene_with(), positions=2)[0].z, abs=1e-7)


def test_given_start_is_used(scene_with, run):
    text = f"z = {run[0].z}\nroll = {run[0].roll}\npitch_rate = {run[0].pitch_rate}\n"
    first = solved(scene_with(end=f"\n[rig.start]\n{text}"), positions=2)[0]
    assert first.converged
    assert first.evaluations == 1


def test_wheelset_beside_the_rollers(scene_with, nominal_file):
    text = nominal_file.read_text()
    begin = text.index("lateral_position =")
    end = text.index("\n]", begin) + 2
    table = text[begin:end]
    path = scene_with((table, "lateral_position = [[0, 0.0], [0.5, 0.0], [1, 0.3]]"))
    first, last = solved(path, positions=2)
    assert first.converged
    assert last.status == "out_of_range"
    assert last.residuals is None
    assert last.result["left"]["patches"] == []


def test_unsolved_contact_is_never_converged(scene_with, run):
    """At the very balance, with solvers that may not finish."""
    text = f"z = {run[0].z}\nroll = {run[0].roll}\npitch_rate = {run[0].pitch_rate}\n"
    path = scene_with(end=f"\n[rig.start]\n{text}\n[method]\nmax_iterations = 1\n")
    first = solved(path, positions=2)[0]
    assert first.status == "not_converged"
    assert first.residuals is not None


def test_same_run_gives_the_same_bits(few):
    def values():
        balancer = Balancer(few)
        return [(b.z, b.roll, b.pitch_rate) for b in map(balancer.solve, few.positions())]

    assert values() == values()
