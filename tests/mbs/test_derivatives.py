"""Derivatives of accelerations by the tangent space against central differences.

Left out are differences with an event between their ends: an element or a patch that changes its
state, or the greatest depth passing to the next element.
"""

from __future__ import annotations

from typing import Any

import mbs_samples as samples
import numpy as np
import pinocchio as pin
import pytest
from railpatch import CaseError
from railpatch.pinocchio import (
    Body,
    ForceElement,
    StateChain,
    Suspension,
    acceleration_derivatives,
    wheelset_model,
)
from railpatch.pinocchio.derivative import angular_velocity
from railpatch.pinocchio.element import STATE

BOUND = 1e-5  # relative to the greatest entry of the row, in usual units
# what changes a coordinate or a rate by a good part of what matters, by STATE
USUAL = np.array([1e-3, 1e-3, 1e-4, 1e-4, 1e-3, 1e-3, 1, 0.01, 0.01, 0.01, 0.01, 1])
# of the differences: small against an element, large against the solver's tolerance
LENGTH, TURN, VELOCITY = 2e-9, 2e-8, 8e-5
EXACT = samples.case(method={"tolerance": 1e-11, "max_iterations": 1000, "derivatives": True})
CARRIER = Body(300.0, (300.0, 20.0, 300.0))
STIFFNESS = {"x": 4e6, "y": 2e6, "z": 1e6, "roll": 3e5, "yaw": 2e6}
DAMPING = {"x": 1e4, "y": 2e4, "z": 3e4, "roll": 4e3, "yaw": 5e3}


class Composite:
    """A wheelset on the composite carrier with a suspension; the tangent space is plain."""

    joint = "wheelset"
    track = wheelset = None
    steps = (2e-8, 2e-8, 1e-9, 1e-8, 4e-7, 1e-7, *[VELOCITY] * 6)

    def model(self) -> pin.Model:
        return wheelset_model(samples.WHEELSET, samples.RADIUS, carrier_body=CARRIER)

    def place(self, q: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return q, v


class FreeFlyer(Composite):
    """A carrier on a free-flyer: its velocities are in its own axes."""

    steps = (2e-8, 2e-8, 1e-9, 1e-8, 1e-7, 4e-7, 1e-7, *[VELOCITY] * 7)

    def model(self) -> pin.Model:
        return wheelset_model(
            samples.WHEELSET, samples.RADIUS, carrier="free_flyer", carrier_body=CARRIER
        )

    def place(self, q: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        held = samples.turn("x", q[3]) @ samples.turn("z", q[4])
        spin = v[3] * np.eye(3)[0] + v[4] * samples.turn("x", q[3])[:, 2]
        position = np.append(pin.SE3ToXYZQUAT(pin.SE3(held, q[:3])), q[5])
        return position, np.concatenate([held.T @ v[:3], held.T @ spin, [v[5]]])


class OneBody(Composite):
    """A body on a bare free-flyer in any axes, on a track anywhere in the world."""

    joint = "body"
    steps = (*[LENGTH] * 3, *[TURN] * 3, *[VELOCITY] * 6)

    def __init__(self) -> None:
        pin.seed(5)
        # not far from the wheelset, or differences would be of great levers
        self.track, self.wheelset = pin.SE3.Random(), pin.SE3.Random()
        self.wheelset.translation *= 0.1

    def model(self) -> pin.Model:
        model = pin.Model()
        joint = model.addJoint(0, pin.JointModelFreeFlyer(), pin.SE3.Identity(), "body")
        model.appendBodyToJoint(
            joint, pin.Inertia(1600.0, np.zeros(3), np.diag([700, 110, 700])), self.wheelset
        )
        return model

    def place(self, q: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        # the wheelset in the track, turned by pitch too, then both placements
        held = samples.turn("x", q[3]) @ samples.turn("z", q[4])
        axle = samples.turn("y", q[5])
        spin = v[3] * np.eye(3)[0] + v[4] * samples.turn("x", q[3])[:, 2] + v[5] * held[:, 1]
        placed = pin.SE3(held @ axle, q[:3] - [0, 0, samples.RADIUS])
        motion = pin.Motion(placed.rotation.T @ v[:3], placed.rotation.T @ spin)
        joint = self.track * placed * self.wheelset.inverse()
        return pin.SE3ToXYZQUAT(joint), self.wheelset.act(motion).vector


class Bench:
    """Accelerations of one sample, element and suspension stepped."""

    time = 0.1

    def __init__(self, sample: Composite, case: dict[str, Any] = EXACT) -> None:
        self.model = sample.model()
        self.data = self.model.createData()
        self.element = ForceElement(
            self.model, sample.joint, case, wheelset=sample.wheelset, track=sample.track
        )
        reference = {"x": 0.01, "y": 2e-3, "roll": 1e-3, "yaw": -1e-3}
        self.suspension = Suspension(
            self.element, STIFFNESS, DAMPING, reference=reference, speed=20.0, preload=1e5
        )
        self.torque = np.zeros(self.model.nv)

    def step(self, q: np.ndarray, v: np.ndarray) -> pin.StdVec_Force:
        fext = samples.no_forces(self.model)
        pin.forwardKinematics(self.model, self.data, q, v)
        status = self.element.step(self.data, fext)
        assert status in ("converged", "no_contact")
        self.suspension.step(self.time, fext)
        return fext

    def accelerations(self, q: np.ndarray, v: np.ndarray) -> np.ndarray:
        return pin.aba(self.model, self.data, q, v, self.torque, self.step(q, v)).copy()

    def derivatives(self, q: np.ndarray, v: np.ndarray):
        fext = self.step(q, v)
        forces = [self.element, self.suspension]
        return acceleration_derivatives(self.model, self.data, q, v, self.torque, fext, forces)

    def choices(self) -> list[Any]:
        """What the derivatives keep: see the head."""
        result, found = self.element.result(fields=True), []
        core = self.element.contacts[0]._core
        for index, side in enumerate(("left", "right")):
            for number, patch in enumerate(result[side]["patches"]):
                division = np.asarray(patch["element_division"])
                deepest = int(np.argmin(core.field(index, number, "undeformed_distance")))
                found.append((side, division.shape, division.tobytes(), deepest))
        return found

    def ends(self, q: np.ndarray, v: np.ndarray, column: int, step: float):
        """q, v on both sides, in the tangent space."""
        for sign in (step, -step):
            change = np.zeros(2 * self.model.nv)
            change[column] = sign
            moved = pin.integrate(self.model, q, change[: self.model.nv])
            yield moved, v + change[self.model.nv :]


SAMPLES = {"composite": Composite, "free_flyer": FreeFlyer, "one body": OneBody}


@pytest.mark.parametrize("name", SAMPLES)
def test_states_follow_the_tangent_space(name: str):
    sample = SAMPLES[name]()
    bench = Bench(sample, samples.case(method={"derivatives": True}))
    model, data = bench.model, bench.data
    for motion in samples.random_motions(5, 6):
        q, v = sample.place(*motion)
        bench.step(q, v)
        pin.computeForwardKinematicsDerivatives(model, data, q, v, bench.torque)
        chain = StateChain(model, data).of(bench.element, 0)
        found = np.hstack([chain.by_q, chain.by_v])
        _, by_state = angular_velocity(bench.element.states[0])
        for column in range(2 * model.nv):
            states, spins = [], []
            for end in bench.ends(q, v, column, 1e-6):
                bench.step(*end)
                states.append(bench.element.states[0].copy())
                spins.append(angular_velocity(states[-1])[0])
            expected = (states[0] - states[1]) / 2e-6
            np.testing.assert_allclose(found[:, column], expected, rtol=0, atol=3e-7)
            spin = (spins[0] - spins[1]) / 2e-6
            np.testing.assert_allclose(by_state @ found[:, column], spin, rtol=0, atol=3e-7)


@pytest.mark.parametrize("name", SAMPLES)
def test_accelerations_against_central_differences(name: str, measured):
    sample = SAMPLES[name]()
    bench = Bench(sample)
    compared = left_out = 0
    worst = 0.0
    for motion in samples.random_motions(17, 4):
        q, v = sample.place(*motion)
        made = bench.derivatives(q, v)
        found = np.hstack([made.by_q, made.by_v])
        here = bench.choices()
        states = made.chain.of(bench.element, 0)
        # how far a column moves the wheelset, in usual units
        moved = np.abs(np.hstack([states.by_q, states.by_v]) / USUAL[:, None]).max(axis=0)
        scale = np.abs(found / moved).max(axis=1)
        # nothing turns the free carrier about the axle: what is left of great forces in balance
        scale = np.maximum(scale, 1e-3 * scale.max())
        for column, step in enumerate(sample.steps):
            ends, same = [], True
            for end in bench.ends(q, v, column, step):
                ends.append(bench.accelerations(*end))
                same = same and bench.choices() == here
            if not same:
                left_out += 1
                continue
            compared += 1
            expected = (ends[0] - ends[1]) / (2 * step)
            missed = np.abs(found[:, column] - expected) / moved[column] / scale
            worst = max(worst, missed.max())
            assert (missed <= BOUND).all(), (column, missed, found[:, column], expected)
    measured(f"{name}: {compared} columns, {left_out} left out, greatest error {worst:.1e}")
    assert compared > 2 * left_out


def test_time_moves_the_reference():
    bench = Bench(Composite())
    q, v = samples.random_motions(17, 1)[0]
    found = bench.derivatives(q, v).by_time
    ends = []
    for time in (0.11, 0.09):
        bench.time = time
        ends.append(bench.accelerations(q, v))
    np.testing.assert_allclose(found, (ends[0] - ends[1]) / 0.02, rtol=1e-8, atol=1e-6)


def test_powers_against_central_differences():
    bench = Bench(Composite())
    for q, v in samples.random_motions(23, 2):
        bench.step(q, v)
        here = bench.choices()
        contact = bench.element.contact_power_derivatives()
        found = np.vstack([contact, bench.suspension.power_derivatives()])
        scale = np.abs(found * USUAL).max(axis=1)
        compared = 0
        for column, step in enumerate(Composite.steps):
            powers, same = [], True
            for end in bench.ends(q, v, column, step):
                bench.step(*end)
                same = same and bench.choices() == here
                spring = bench.suspension
                power = [bench.element.contact_power, spring.damping_power, spring.drive_power]
                powers.append(power)
            if not same:
                continue
            compared += 1
            expected = (np.array(powers[0]) - powers[1]) / (2 * step)
            missed = np.abs(found[:, column] - expected) * USUAL[column]
            assert (missed <= BOUND * scale).all(), STATE[column]
        assert compared >= 8


def test_two_wheelsets_of_one_model():
    first, second = samples.model(), samples.model()
    for index, name in enumerate(first.names):
        second.names[index] = f"second {name}"
    model = pin.appendModel(first, second, 0, pin.SE3(np.eye(3), np.array([2.5, 0.0, 0.0])))
    joints = [model.getJointId(name) for name in model.names if "wheelset" in name]
    both = ForceElement(model, joints, EXACT)
    (qa, va), (qb, vb) = samples.random_motions(11, 2)
    found = stepped(model, both, np.concatenate([qa, qb]), np.concatenate([va, vb]))
    for index, (q, v) in enumerate(((qa, va), (qb, vb))):
        alone = stepped(first, ForceElement(first, "wheelset", EXACT), q, v)
        part = slice(6 * index, 6 * index + 6)
        for name in ("by_q", "by_v"):
            block, other = getattr(found, name)[part], getattr(alone, name)
            np.testing.assert_allclose(block[:, part], other, rtol=0, atol=1e-7 * other.max())
            # one wheelset's forces do not depend on the other
            assert (np.delete(block, range(6 * index, 6 * index + 6), axis=1) == 0).all()


def stepped(model: pin.Model, element: ForceElement, q: np.ndarray, v: np.ndarray):
    """Derivatives of a model with an element alone."""
    data, fext = model.createData(), samples.no_forces(model)
    pin.forwardKinematics(model, data, q, v)
    element.step(data, fext)
    return acceleration_derivatives(model, data, q, v, np.zeros(model.nv), fext, [element])


def test_nothing_changes():
    plain, bench = Bench(Composite()), Bench(Composite())
    motions = samples.random_motions(2, 5)
    for q, v in motions:
        expected = plain.accelerations(q, v)
        found = bench.derivatives(q, v)
        np.testing.assert_allclose(found.acceleration, expected, rtol=1e-10, atol=1e-8)
        np.testing.assert_array_equal(bench.element.contact_wrench, plain.element.contact_wrench)


def test_wheels_in_the_air_leave_the_suspension():
    bench = Bench(Composite())
    q = samples.rolling(0, 0, -0.02, 0, 0, 0)
    made = bench.derivatives(q, samples.RATES)
    mass = samples.WHEELSET.mass + CARRIER.mass
    assert made.by_q[1, 1] == pytest.approx(-STIFFNESS["y"] / mass, rel=1e-12)
    assert made.by_v[2, 2] == pytest.approx(-DAMPING["z"] / mass, rel=1e-12)


def test_a_case_without_derivatives_says_so():
    bench = Bench(Composite(), samples.CASE)
    with pytest.raises(CaseError, match=r"method\.derivatives: value is False, allowed True"):
        bench.derivatives(samples.ROLLING, samples.RATES)
