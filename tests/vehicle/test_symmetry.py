"""What the whole model must share with simpler ones: a mirror image, two masses on springs."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
import vehicle_scenes as scenes

from wheelset_demo.vehicle import Simulation


def curving(hand: float) -> Simulation:
    """1.2 s at 40 m/s from the straight into a curve to the right (1) or to the left (-1)."""
    alignment = {"straight": 25.0, "transition": 60.0, "arc": 500.0, "radius": hand * 1000.0}
    given = scenes.scene(speed=40.0, alignment={**alignment, "cant": 0.05}, duration=1.2)
    # dampers ahead on the right and behind on the left have no mirror image
    lateral = next(e for e in given.vehicle.element if e.name == "secondary lateral dampers")
    for place in lateral.places:
        place.at[0] = math.copysign(9.5, place.at[0])
    return scenes.finished(given)


def test_a_left_curve_is_the_mirror_image_of_a_right_one():
    right, left = curving(1.0), curving(-1.0)
    # lateral and vertical position, roll, yaw
    signs = np.array([-1.0, 1.0, -1.0, -1.0])
    one, other = (run.element.states[:, 1:5] for run in (right, left))
    assert np.abs(one[:, 0]).max() > 1e-3
    np.testing.assert_allclose(signs * other, one, atol=1e-6 * np.abs(one).max())
    forces, mirrored = right.element.wheels[:, :, :3], left.element.wheels[:, ::-1, :3]
    wanted = mirrored * np.array([1.0, -1.0, 1.0])
    np.testing.assert_allclose(forces, wanted, atol=1e-5 * np.abs(forces).max())
    ahead = right.system.slope_wrenches[:, :, 0], left.system.slope_wrenches[:, ::-1, 0]
    assert np.abs(ahead[0]).max() > 1.0
    np.testing.assert_allclose(*ahead, atol=1e-5 * np.abs(ahead[0]).max())


def test_bounce_is_that_of_two_masses():
    """Car body on secondary springs on both bogies on primary ones, without dampers:

        (k2 - m1 w^2) (k1 + k2 - m2 w^2) = k2^2,    w^2 = (a +- sqrt(a^2 - 4 b)) / 2,
        a = k2/m1 + (k1 + k2)/m2,  b = k1 k2 / (m1 m2):  1.074 and 7.471 Hz.

    The wheels' contacts below are some thousand times as stiff as the springs; on them stand
    axle boxes and wheelsets, which move with the bogies by as little.
    """
    given = scenes.scene(duration=0.01)
    none = {"damping": [0.0] * 3, "turning_damping": [0.0] * 3, "series_stiffness": [0.0] * 3}
    elements = [e.model_copy(update=none) for e in given.vehicle.element]
    vehicle = given.vehicle.model_copy(update={"element": elements})
    simulation = scenes.finished(replace(given, vehicle=vehicle))
    system, n = simulation.system, simulation.system.count
    matrix, _ = system.derivatives(simulation.state.values, range(4))
    eigenvalues, shapes = np.linalg.eig(matrix)
    car, first, second = (system.vehicle.columns[k][2] for k in range(3))
    m1, m2, k1, k2 = 32000.0, 2 * 2615.0, 8 * 1.22e6, 4 * 430e3
    a, b = k2 / m1 + (k1 + k2) / m2, k1 * k2 / (m1 * m2)
    for sign, hertz in ((-1.0, 1.074), (1.0, 7.471)):
        squared = 0.5 * (a + sign * math.sqrt(a * a - 4 * b))
        wanted = math.sqrt(squared) / (2 * math.pi)
        assert wanted == pytest.approx(hertz, abs=5e-4)
        # in this mode the bogies go with the car body by a share
        share = 1 - m1 * squared / k2
        alike = np.abs(shapes[first] - share * shapes[car]) + np.abs(shapes[first] - shapes[second])
        size = np.abs(shapes[[car, first]]).max(axis=0)
        # of modes that are mostly up and down
        shown = (size > 0.1 * np.abs(shapes[:n]).max(axis=0)) & (eigenvalues.imag > 1.0)
        alike = np.where(shown, alike / np.where(shown, size, 1.0), np.inf)
        found = np.abs(eigenvalues[np.argmin(alike)]) / (2 * math.pi)
        assert alike.min() < 0.02
        assert found == pytest.approx(wanted, rel=2e-3)
