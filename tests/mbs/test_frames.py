"""From a joint's placement and velocity to the wheelset's position and rates in track axes."""

from __future__ import annotations

import mbs_samples as samples
import numpy as np
import pinocchio as pin
import pytest
from railpatch.pinocchio import ForceElement
from railpatch.pinocchio.element import STATE, STATUSES


def test_composite_coordinates_are_those_of_railpatch():
    model = samples.model()
    data, fext = model.createData(), samples.no_forces(model)
    element = ForceElement(model, "wheelset", samples.CASE)
    rng = np.random.default_rng(1)
    for _ in range(200):
        # up to the library's range of 1.5 rad
        q = rng.uniform(-1, 1, 6) * [9, 0.5, 0.5, 1.45, 1.45, np.pi]
        v = rng.uniform(-1, 1, 6) * [30, 1, 1, 5, 5, 90]
        pin.forwardKinematics(model, data, q, v)
        element.step(data, fext)
        state = element.state()
        assert list(state) == list(STATE)
        np.testing.assert_allclose(list(state.values()), [*q, *v], rtol=0, atol=2e-12)


def pose(q: np.ndarray) -> pin.SE3:
    """Of the wheelset in track axes."""
    x, y, z, roll, yaw, pitch = q
    rotation = samples.turn("x", roll) @ samples.turn("z", yaw) @ samples.turn("y", pitch)
    return pin.SE3(rotation, np.array([x, y, z - samples.RADIUS]))


def twist(q: np.ndarray, v: np.ndarray) -> pin.Motion:
    """Of the wheelset in its own axes, by the definition of the rates."""
    _, _, _, roll, yaw, _ = q
    rolled = samples.turn("x", roll)
    axle = rolled @ samples.turn("z", yaw) @ [0, 1, 0]
    spin = v[3] * np.array([1, 0, 0]) + v[4] * rolled @ [0, 0, 1] + v[5] * axle
    back = pose(q).rotation.T
    return pin.Motion(back @ v[:3], back @ spin)


@pytest.mark.parametrize("seed", range(3))
def test_any_joint_wheelset_and_track_frame(seed):
    rng = np.random.default_rng(seed)
    pin.seed(seed)
    track, wheelset = pin.SE3.Random(), pin.SE3.Random()
    frame_speed = rng.uniform(-30, 30)
    model = pin.Model()
    joint = model.addJoint(0, pin.JointModelFreeFlyer(), pin.SE3.Random(), "axle box")
    model.appendBodyToJoint(joint, pin.Inertia.Random(), pin.SE3.Identity())
    element = ForceElement(
        model, joint, samples.CASE, wheelset=wheelset, track=track, frame_speed=frame_speed
    )
    data, fext = model.createData(), samples.no_forces(model)
    for q, v in samples.random_motions(seed, 20):
        placed = model.jointPlacements[joint].inverse() * track * pose(q) * wheelset.inverse()
        speed = v.copy()
        speed[0] -= frame_speed
        velocity = wheelset.act(twist(q, speed))
        pin.forwardKinematics(model, data, pin.SE3ToXYZQUAT(placed), velocity.vector)
        element.step(data, fext)
        pitch = np.remainder(q[5] + np.pi, 2 * np.pi) - np.pi
        expected = [*q[:5], pitch, *v]
        np.testing.assert_allclose(list(element.state().values()), expected, rtol=0, atol=1e-12)


def test_rates_are_derivatives_of_the_angles():
    # differences over a short motion, for a definition that uses no formula of ours
    q, v = samples.rolling(0, 0, 0, 0.3, -0.2, 0.5), samples.RATES
    step = 1e-6
    model = samples.model()
    data, fext = model.createData(), samples.no_forces(model)
    element = ForceElement(model, "wheelset", samples.CASE)
    states = []
    for share in (-step, step):
        placed = pose(q) * pin.exp6(pin.Motion(share * twist(q, v).vector))
        roll = np.arctan2(placed.rotation[2, 1], placed.rotation[1, 1])
        yaw = np.arcsin(-placed.rotation[0, 1])
        states.append([roll, yaw])
    rates = (np.array(states[1]) - states[0]) / (2 * step)
    pin.forwardKinematics(model, data, q, v)
    element.step(data, fext)
    found = element.state()
    np.testing.assert_allclose([found["roll_rate"], found["yaw_rate"]], rates, atol=1e-6)


def test_statuses_are_the_core_s():
    from railpatch import _core

    assert dict(enumerate(STATUSES)) == _core.STATUSES
