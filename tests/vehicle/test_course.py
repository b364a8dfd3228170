"""The compiled way along the track, against its pieces asked for one by one."""

from __future__ import annotations

import numpy as np
import pytest
import vehicle_scenes as scenes

from wheelset_demo.vehicle import Simulation
from wheelset_demo.vehicle.irregularity import ARM
from wheelset_demo.vehicle.system import VehicleSystem

ALIGNMENT = {"straight": 25.0, "transition": 80.0, "arc": 100.0, "radius": 900.0, "cant": 0.12}


@pytest.fixture(scope="module")
def system() -> VehicleSystem:
    given = scenes.scene(speed=45.0, alignment=ALIGNMENT, irregular=True, duration=5.0)
    return Simulation(given).system


def on_track(system: VehicleSystem, s: np.ndarray, speed: float) -> tuple[np.ndarray, np.ndarray]:
    """Coordinates and velocities of wheelsets some centimetres beside the middle."""
    rotations, origins = system.alignment.frames(s)
    q, v = np.zeros(system.count), np.zeros(system.count)
    q[system.vehicle.carriers[:, :3]] = origins + 0.02 * rotations[:, :, 1]
    v[system.vehicle.carriers[:, :3]] = speed * rotations[:, :, 0]
    return q, v


def test_frames_and_rails_under_the_wheelsets(system):
    """In straight track, transitions, arc and beyond."""
    speed, element = 45.0, system.element
    for s in np.linspace(2.0, 210.0, 60).reshape(-1, 4):
        q, v = on_track(system, s, speed)
        system.positions[:] = s + 0.3
        inputs = system.place_track(q, v)
        np.testing.assert_allclose(system.positions, s, atol=1e-6)
        rotations, origins, bends = system.alignment.frames_and_bends(system.positions)
        np.testing.assert_allclose(element.tracks[:, :9], rotations.reshape(-1, 9), atol=1e-14)
        np.testing.assert_allclose(element.tracks[:, 9:], origins, atol=1e-12)
        deviations, slopes = system.irregularity.both(system.positions)
        assert np.array_equal(element.rails[:, 0, :, 1:], deviations)
        rates = speed * slopes[:, :, 1]
        wanted = np.concatenate([deviations.ravel(), rates.ravel()])
        np.testing.assert_allclose(inputs, wanted, rtol=1e-12)
        twist = speed * ARM * bends[:, 2]
        turned = rates + np.stack([-twist, twist], axis=1)
        np.testing.assert_allclose(element.rails[:, 1, :, 2], turned, rtol=1e-12, atol=1e-15)


def test_what_is_known_ahead(system):
    """The rails where the wheelsets will be; second differences of how the track goes on."""
    speed, step = 45.0, 1e-3
    # transition, arc
    s = np.array([45.0, 60.0, 80.0, 150.0])
    q, v = on_track(system, s, speed)
    system.positions[:] = s
    system.place_track(q, v)
    ahead, bend = system.look_ahead(np.concatenate([q, v]), step)
    deviations, slopes = system.irregularity.both(system.positions + step * speed)
    wanted = np.concatenate([deviations.ravel(), speed * slopes[:, :, 1].ravel()])
    np.testing.assert_allclose(ahead, wanted, rtol=1e-12)
    # of the rails' own places, 0.75 m from the middle, over a longer step for the digits
    way, places = 0.5, []
    for moved in (-way, 0.0, way):
        rotations, origins = system.alignment.frames(s + moved)
        places.append([origins + side * ARM * rotations[:, :, 1] for side in (-1.0, 1.0)])
    before, now, after = np.array(places)
    turns = (after - 2 * now + before) * (step * speed / way) ** 2
    rotations, _ = system.alignment.frames(s)
    sides = np.einsum("sni,nij->nsj", turns, rotations)[:, :, 1:]
    np.testing.assert_allclose(bend[:16].reshape(4, 2, 2), sides, rtol=2e-2, atol=1e-9)
    assert not bend[16:].any()
