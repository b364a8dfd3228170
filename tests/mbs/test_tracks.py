"""A track that bends, rails that are not straight, several threads."""

from __future__ import annotations

import mbs_samples as samples
import numpy as np
import pinocchio as pin
import pytest
from railpatch import CaseError, Contact
from railpatch.pinocchio import ForceElement

COUNT = 4
CURVATURE = 1 / 500.0
TIGHT = {"method": {"tolerance": 1e-10}}


def chained(count: int) -> pin.Model:
    """Several wheelsets in one model, joints "wheelset", "wheelset_2", ..."""
    model = pin.Model()
    for k in range(count):
        part = samples.model()
        for j in range(1, part.njoints):
            part.names[j] = f"{part.names[j]}_{k}"
        model = pin.appendModel(model, part, 0, pin.SE3.Identity())
    return model


def names(count: int) -> list[str]:
    """Of the joints that spin."""
    return [f"wheelset_{k}" for k in range(count)]


def forces_of(element: ForceElement, model: pin.Model, q: np.ndarray, v: np.ndarray) -> np.ndarray:
    """[wheelsets, 6], of one step."""
    data, fext = model.createData(), samples.no_forces(model)
    pin.forwardKinematics(model, data, q, v)
    assert element.step(data, fext) == "converged"
    return element.contact_wrench.copy()


def test_a_bend_is_the_curvature_of_a_case():
    """The wheelset's whole velocity on a track frame at rest gives the creepages that the core
    finds with `curvature`: forward by V (1 - kappa y), turning by kappa V."""
    speed = samples.RATES[0]
    q, v = samples.ROLLING.copy(), samples.RATES.copy()
    q[0] = 0.0
    y, roll = q[1], q[3]
    v[0] = speed * (1 - CURVATURE * y)
    v[1] += -speed * CURVATURE * q[0]
    # about the world's z: of the angles' rates, whose yaw axis leans by the roll
    v[4] += CURVATURE * speed * np.cos(roll)
    v[5] += CURVATURE * speed * np.sin(roll)
    model = samples.model()
    found = forces_of(ForceElement(model, "wheelset", samples.case(**TIGHT)), model, q, v)[0]

    contact = Contact(samples.case(**TIGHT, track={"curvature": CURVATURE}))
    given = dict(zip(samples.MOVING, [0.0] * len(samples.MOVING), strict=True))
    order = ("y", "z", "roll", "yaw")
    given.update(zip(order, samples.ROLLING[1:5].tolist(), strict=True))
    rates = ("speed", "vy", "vz", "roll_rate", "yaw_rate", "pitch_rate")
    given.update(zip(rates, samples.RATES.tolist(), strict=True))
    curved = contact.step(**given)
    straight = contact_forces(Contact(samples.case(**TIGHT)).step(**given))
    wanted = contact_forces(curved)
    # a bend that does not show could not be told from none
    assert np.abs(wanted - straight)[0] > 100.0
    assert np.abs(found - wanted).max() < 1e-6 * np.abs(wanted).max()


def contact_forces(result: object) -> np.ndarray:
    """[6]."""
    return np.array([*result["force"], *result["moment"]])


def test_each_wheelset_has_a_track_of_its_own():
    """Forces in track axes depend on the wheelset's place on its track, not in the world."""
    rng = np.random.default_rng(3)
    model = chained(2)
    element = ForceElement(model, names(2), samples.case(**TIGHT))
    q, v = np.tile(samples.ROLLING, 2), np.tile(samples.RATES, 2)
    same = forces_of(element, model, q, v)
    assert np.array_equal(same[0], same[1])

    # the second track elsewhere; its wheelset is moved along in the world by hand
    turn = pin.SE3(pin.exp3(0.3 * rng.standard_normal(3)), 10 * rng.standard_normal(3))
    element.tracks[1, :9], element.tracks[1, 9:] = turn.rotation.ravel(), turn.translation
    element.positions[1] = 7.0
    data, fext = model.createData(), samples.no_forces(model)
    pin.forwardKinematics(model, data, q, v)
    joint = element.joints[1]
    data.oMi[joint] = turn * data.oMi[joint]
    element.step(data, fext)
    np.testing.assert_allclose(element.contact_wrench[1], same[0], rtol=0, atol=1e-3)
    assert element.states[1, 0] == pytest.approx(element.states[0, 0] + 7.0)


def test_rails_that_deviate_are_those_of_a_case():
    """`rails` adds to offset and velocity of the case's rails."""
    model = samples.model()
    left, right = [0.0, 4e-4, -5e-5], [0.0, -3e-4, 2e-5]
    moving = [0.0, 0.02, 0.0]
    track = {"left": {"offset": left, "velocity": moving}, "right": {"offset": right}}
    wanted = forces_of(
        ForceElement(model, "wheelset", samples.case(**TIGHT, track=track)),
        model,
        samples.ROLLING,
        samples.RATES,
    )
    half = {"left": {"offset": [0.5 * part for part in left]}}
    element = ForceElement(model, "wheelset", samples.case(**TIGHT, track=half))
    element.rails[0, 0] = [[0.5 * part for part in left], right]
    element.rails[0, 1, 0] = moving
    found = forces_of(element, model, samples.ROLLING, samples.RATES)
    np.testing.assert_allclose(found, wanted, rtol=0, atol=1e-6 * np.abs(wanted).max())
    # by wheel: their sum is the wheelset's
    np.testing.assert_allclose(
        element.wheels[0, :, :6].sum(axis=0), element.contact_wrench[0], rtol=1e-12, atol=1e-9
    )
    assert element.wheels[0, :, 6].sum() == pytest.approx(element.creep_power)
    assert element.wheels[0, :, 8].sum() == pytest.approx(element.friction_power)


@pytest.mark.parametrize("method", [("hertz", "fastsim"), ("half_space", "full")])
def test_threads_give_the_same_bits(method):
    normal, tangential = method
    model = chained(COUNT)
    case = samples.case(method={"normal": normal, "tangential": tangential})
    rng = np.random.default_rng(11)
    elements = [ForceElement(model, names(COUNT), case, threads=t) for t in (1, 2, 3, 6)]
    for _ in range(5):
        q = np.tile(samples.ROLLING, COUNT)
        q[1::6] += 1e-3 * rng.standard_normal(COUNT)
        v = np.tile(samples.RATES, COUNT)
        first, *others = [forces_of(element, model, q, v) for element in elements]
        assert len({first[k].tobytes() for k in range(COUNT)}) == COUNT
        for other in others:
            assert other.tobytes() == first.tobytes()


def test_an_error_on_a_thread_is_raised_and_forgotten():
    model = chained(COUNT)
    element = ForceElement(model, names(COUNT), samples.case(), threads=2)
    q, v = np.tile(samples.ROLLING, COUNT), np.tile(samples.RATES, COUNT)
    bad = q.copy()
    bad[6 * 2 + 3] = 1.7
    with pytest.raises(CaseError, match="roll"):
        forces_of(element, model, bad, v)
    assert np.isfinite(forces_of(element, model, q, v)).all()


@pytest.mark.parametrize("threads", [0, 257, 2.0, True])
def test_bad_threads(threads):
    with pytest.raises(CaseError, match=r"threads: value is .*, allowed 1 to 256"):
        ForceElement(samples.model(), "wheelset", samples.case(), threads=threads)
