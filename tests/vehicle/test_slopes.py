"""Rails that are not level: a gradient seen as one is the same as rails that rise."""

from __future__ import annotations

import math

import numpy as np
import pinocchio as pin
import pytest
import vehicle_scenes as scenes
from railpatch import Contact
from railpatch.pinocchio import Body, ForceElement, wheelset_model

from wheelset_demo.vehicle import Simulation
from wheelset_demo.vehicle.slope import slope_wrenches

RADIUS, SPEED, SLOPE = 0.46, 50.0, 8e-4
CASE = {
    "kind": "wheelset",
    "friction": {"coefficient": 0.3},
    "method": {"normal": "hertz", "tangential": "polach"},
    "wheelset": {
        "z": 0.0,
        "nominal_radius": RADIUS,
        "flange_back_distance": 1.36,
        "flange_back_position": -0.070,
    },
    "track": {"kind": "rail"},
    "profiles": {"wheel": "S1002", "rail": "UIC60@1:40"},
}
BODY = Body(mass=1300.0, inertia=(700.0, 110.0, 700.0))
LOAD = 1.1e5  # N


def height(y: float) -> float:
    """m, of the wheelset under its load."""
    wheelset = {key: value for key, value in CASE["wheelset"].items() if key != "z"}
    motion = {"y": y, "speed": SPEED, "pitch_rate": -SPEED / RADIUS, "vertical_force": LOAD}
    return Contact({**CASE, "wheelset": wheelset | motion}).step()["z"]


class Stepped:
    """One contact of a wheelset y (m) off the middle.

    turned: the track frame about y by the slope; climbing: the wheelset rises and falls with rails
    of the slope; rate: and the rails are given their vertical rate.
    """

    def __init__(self, y: float, *, turned=False, climbing=False, rate=False) -> None:
        model = wheelset_model(BODY, nominal_radius=RADIUS)
        data = model.createData()
        element = ForceElement(model, "wheelset", CASE)
        z = height(y)
        q = np.array([0.0, y, z, 0.0, 0.0, 0.0])
        v = np.array([SPEED, 0.0, 0.0, 0.0, 0.0, -SPEED / RADIUS])
        self.turn = np.eye(3)
        if turned:
            # z down: rails that fall ahead
            self.turn = pin.utils.rotate("y", -math.atan(SLOPE))
            element.tracks[0, :9] = self.turn.ravel()
            q[:3] = self.turn @ [0.0, y, z - RADIUS] + [0.0, 0.0, RADIUS]
            v[:3] = self.turn @ v[:3]
        if climbing:
            v[2] = SPEED * SLOPE
        if rate:
            element.rails[0, 1, :, 2] = SPEED * SLOPE
        pin.forwardKinematics(model, data, q, v)
        fext = pin.StdVec_Force([pin.Force.Zero() for _ in range(model.njoints)])
        assert element.step(data, fext) == "converged"
        result = element.result()
        patches = [patch for side in ("left", "right") for patch in result[side]["patches"]]
        self.lateral = np.array([patch["creepage"][1] for patch in patches])
        self.angle = np.array([patch["contact_angle"] for patch in patches])
        self.normals = element.lateral_normals
        self.wheels = element.wheels.copy()
        self.wrench = np.concatenate(
            [self.turn @ part for part in element.contact_wrench[0].reshape(2, 3)]
        )


@pytest.mark.parametrize("y", [0.0, 0.004])
def test_a_slope_makes_no_lateral_creepage(y):
    """Level track, a gradient as a turned track, and as rails that rise with their rate: one
    lateral creepage. Without the rate it is off by the slope times the sine of the contact angle.
    """
    level, turned = Stepped(y), Stepped(y, turned=True)
    rising, resting = Stepped(y, climbing=True, rate=True), Stepped(y, climbing=True)
    false = SLOPE * np.sin(level.angle)
    assert np.abs(false).min() > 1e-5
    # the second order of the slope is a thousandth of the first
    np.testing.assert_allclose(turned.lateral, level.lateral, atol=2e-3 * np.abs(false).min())
    np.testing.assert_allclose(rising.lateral, level.lateral, atol=2e-3 * np.abs(false).min())
    np.testing.assert_allclose(np.abs(resting.lateral - level.lateral), np.abs(false), rtol=0.02)


@pytest.mark.parametrize("y", [0.0, 0.004])
def test_force_along_a_slope(y):
    """What the turned track's forces have along the world's x, and their moment about z, that
    rising rails get from their slope."""
    turned, rising = Stepped(y, turned=True), Stepped(y, climbing=True, rate=True)
    slopes = np.zeros((1, 2, 2))
    slopes[:, :, 1] = SLOPE
    wrenches = slope_wrenches(rising.wheels, rising.normals, slopes, np.array([RADIUS]), 0.75)
    ahead, spinning, turning = wrenches.sum(axis=(0, 1))
    assert ahead == pytest.approx(-SLOPE * rising.wrench[2], rel=1e-12)
    wanted = turned.wrench - rising.wrench
    assert ahead == pytest.approx(wanted[0], rel=0.01)
    # one that stands aside is turned by what its wheels carry differently, none about the axle
    assert turning == pytest.approx(wanted[5], abs=0.01 * SLOPE * LOAD)
    assert abs(wanted[5]) > 0.1 * SLOPE * LOAD or y == 0
    assert spinning == 0
    assert wanted[4] == pytest.approx(0.0, abs=0.01 * SLOPE * LOAD * RADIUS)


def missing(simulation: Simulation) -> float:
    """-, of the friction's work, in the balance of the contacts of a whole run."""
    before = simulation.element.pressure_energy
    *_, state = simulation.steps()
    contact, friction, *_ = state.work
    stored = simulation.element.pressure_energy - before
    return abs(contact + friction + stored) / friction


def without_slopes(simulation: Simulation) -> None:
    """Their forces are left out."""
    simulation.system._add_slope_wrenches = lambda: 0.0
    simulation._compiled.core.sloped = False


def test_contacts_balance_on_irregular_rails():
    """Work of the contacts = friction and elastic energy, to the hundredths that creepages at the
    undeformed wheel leave open (railpatch.pinocchio.energy)."""
    given = scenes.scene(duration=1.0, irregular=True)
    assert missing(Simulation(given)) < 0.03
    # and without the forces along the slopes a third and more is missing
    simulation = Simulation(given)
    without_slopes(simulation)
    assert missing(simulation) > 0.3


def test_contacts_balance_in_a_transition():
    """Cant that changes lifts the outer rail and lowers the inner one: slopes as others."""
    alignment = {"straight": 25.0, "transition": 80.0, "arc": 1e3, "radius": 3e3, "cant": 0.15}
    given = scenes.scene(speed=45.0, alignment=alignment, duration=1.5)
    simulation = Simulation(given)
    assert missing(simulation) < 0.03
    simulation = Simulation(given)
    without_slopes(simulation)
    assert missing(simulation) > 1.0


def test_slope_of_a_transition():
    """Bloss: in the middle 1.5 of the mean; at the contacts half the cant up and half down."""
    alignment = {"straight": 25.0, "transition": 80.0, "radius": 1500.0, "cant": 0.15}
    system = Simulation(scenes.scene(speed=45.0, alignment=alignment)).system
    places = np.full(4, 25.0 + 40.0)
    system.positions[:] = places
    q, v = np.zeros(system.count), np.zeros(system.count)
    q[system.vehicle.carriers[:, :3]] = system.alignment.frames(places)[1]
    v[system.vehicle.carriers[:, 0]] = 45.0
    system.place_track(q, v)
    slope = 1.5 * math.asin(0.15 / 1.5) * 0.75 / 80.0
    rates = system.element.rails[:, 1]
    np.testing.assert_allclose(rates[:, 0], np.tile([0, 0, -45.0 * slope], (4, 1)), rtol=1e-3)
    np.testing.assert_allclose(rates[:, 1], np.tile([0, 0, 45.0 * slope], (4, 1)), rtol=1e-3)
