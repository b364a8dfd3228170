"""Springs and dampers: their generalised force, their energy, their power."""

from __future__ import annotations

import mbs_samples as samples
import numpy as np
import pinocchio as pin
import pytest
from railpatch.pinocchio import ForceElement, Suspension, energies

STIFFNESS = {"x": 3e5, "y": 2e5, "z": 1e6, "roll": 4e5, "yaw": 5e5}
DAMPING = {"x": 1e3, "y": 2e3, "z": 3e3, "roll": 4e3, "yaw": 5e3}


def on_wheelset(time, q, v, frame_speed=0.0, **more):
    """Suspension after one step, and the generalised force of it alone."""
    model = samples.model()
    data = model.createData()
    element = ForceElement(model, "wheelset", samples.CASE, frame_speed=frame_speed)
    suspension = Suspension(element, STIFFNESS, DAMPING, **more)
    pin.forwardKinematics(model, data, q, v)
    element.step(data, samples.no_forces(model))
    fext = samples.no_forces(model)
    suspension.step(time, fext)
    zero = np.zeros(model.nv)
    without = pin.rnea(model, data, q, zero, zero).copy()
    return suspension, without - pin.rnea(model, data, q, zero, zero, fext)


@pytest.mark.parametrize("seed", range(4))
def test_generalised_force_energy_and_power(seed):
    rng = np.random.default_rng(seed)
    q = rng.uniform(-1, 1, 6) * [1, 0.01, 0.01, 0.5, 0.5, 3]
    v = rng.uniform(-1, 1, 6) * [30, 1, 1, 1, 1, 60]
    more = {"speed": 20.0, "preload": 4e4, "reference": {"y": 1e-3, "yaw": 0.01}}
    time = 0.3
    suspension, force = on_wheelset(time, q, v, **more)
    deflection = q[:5] - [20.0 * time, 1e-3, 0, 0, 0.01]
    stiffness, damping = np.array(list(STIFFNESS.values())), np.array(list(DAMPING.values()))
    rates = v[:5] - [20.0, 0, 0, 0, 0]
    expected = -stiffness * deflection - damping * rates + [0, 0, 4e4, 0, 0]
    # no moment about the axle
    np.testing.assert_allclose(force, [*expected, 0.0], rtol=0, atol=1e-9 * abs(expected).max())
    np.testing.assert_allclose(suspension.force, expected, rtol=1e-12)
    assert suspension.potential == pytest.approx(
        0.5 * stiffness @ deflection**2 - 4e4 * deflection[2], rel=1e-12
    )
    # power on the wheelset = drive - dampers - d/dt of the potential
    step = 1e-6
    potentials = [
        on_wheelset(time + share, q + share * v, v, **more)[0].potential for share in (-step, step)
    ]
    rate = (potentials[1] - potentials[0]) / (2 * step)
    balance = suspension.drive_power - suspension.damping_power - rate
    assert float(force @ v) == pytest.approx(balance, rel=1e-6)


def test_in_a_frame_that_moves_along():
    q, v, time, frame_speed = samples.ROLLING, samples.RATES, 0.4, 15.0
    still, force = on_wheelset(time, q, v, speed=20.0)
    shift = np.array([frame_speed, 0, 0, 0, 0, 0])
    moving, same = on_wheelset(time, q - shift * time, v - shift, frame_speed, speed=20.0)
    np.testing.assert_allclose(same, force, rtol=1e-9)
    assert moving.drive_power == pytest.approx(still.drive_power, rel=1e-9)


def test_no_energies_in_a_moving_frame():
    model = samples.model()
    element = ForceElement(model, "wheelset", samples.CASE, frame_speed=15.0)
    with pytest.raises(ValueError, match=r"frame_speed: value is 15.0, allowed 0"):
        energies(model, model.createData(), samples.ROLLING, samples.RATES, element)
