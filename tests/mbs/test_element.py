"""The force element: the same numbers as Contact.step(), put at the right place."""

from __future__ import annotations

import mbs_samples as samples
import numpy as np
import pinocchio as pin
import pytest
import railpatch
from railpatch import CaseError
from railpatch.pinocchio import Body, ForceElement, wheelset_model


def stepped(element, model, data, q, v):
    """fext of one step, from zero."""
    fext = samples.no_forces(model)
    pin.forwardKinematics(model, data, q, v)
    status = element.step(data, fext)
    return status, fext


def test_same_as_contact_step():
    model = samples.model()
    data = model.createData()
    element = ForceElement(model, "wheelset", samples.CASE)
    contact = railpatch.Contact(samples.CASE)
    statuses = set()
    for q, v in samples.random_motions(7, 40):
        status, _ = stepped(element, model, data, q, v)
        moving = {key: value for key, value in element.state().items() if key in samples.MOVING}
        result = contact.step(**moving)
        statuses.add(status)
        assert status == result.status
        expected = np.array(result["force"] + result["moment"])
        scale = max(1.0, np.abs(expected).max())
        np.testing.assert_allclose(element.contact_wrench[0], expected, atol=1e-12 * scale, rtol=0)
        found = element.result(fields=True)
        for side in ("left", "right"):
            assert found[side]["status"] == result[side]["status"]
            assert found[side]["force"] == result[side]["force"]
            assert len(found[side]["patches"]) == len(result[side]["patches"])
    assert statuses >= {"converged", "no_contact"}


def test_lateral_forces_without_friction_are_those_of_the_normals():
    """But for a millionth of friction; with it creep takes a part."""
    model = samples.model()
    # both wheels in contact
    middle = samples.rolling(0, -1e-3, 0, -1e-4, -2e-3, 0)
    parts = []
    for coefficient in (1e-6, 0.3):
        case = {**samples.CASE, "friction": {"coefficient": coefficient}}
        element = ForceElement(model, "wheelset", case)
        status, _ = stepped(element, model, model.createData(), middle, samples.RATES)
        assert status == "converged"
        lateral, loads = element.wheels[:, :, 1], -element.wheels[:, :, 2]
        assert element.lateral_normals.shape == (1, 2)
        parts.append(np.abs(lateral - element.lateral_normals) / loads)
        # the contacts lean inward
        assert element.lateral_normals[0, 0] > 0 > element.lateral_normals[0, 1]
    assert parts[0].max() < 2e-6
    assert parts[1].min() > 1e-3


def test_lateral_forces_of_normals_on_a_curved_surface():
    """The lateral creep force there holds a part of pressure."""
    model = samples.model()
    on_the_root = samples.rolling(0, 4.5e-3, -4e-4, 0, 0, 0)
    found = []
    for coefficient in (1e-6, 0.3):
        method = {"reference_surface": "curved"}
        case = samples.case(friction={"coefficient": coefficient}, method=method)
        element = ForceElement(model, "wheelset", case)
        stepped(element, model, model.createData(), on_the_root, samples.RATES)
        found.append((element.wheels[0, 1, 1], element.lateral_normals[0, 1]))
    (free, normals), (with_creep, beside_creep) = found
    assert abs(free) > 1e4
    assert normals == pytest.approx(free, rel=1e-5)
    # creep changes the pressure a little there, and adds a force of its own
    assert beside_creep == pytest.approx(normals, rel=0.02)
    assert abs(with_creep - beside_creep) > 0.05 * abs(normals)


def test_wheels_in_the_air():
    model = samples.model()
    data = model.createData()
    element = ForceElement(model, "wheelset", samples.CASE)
    lifted = samples.ROLLING - [0, 0, 5e-3, 0, 0, 0]
    status, fext = stepped(element, model, data, lifted, samples.RATES)
    assert status == "no_contact"
    assert all((force.vector == 0).all() for force in fext)
    assert element.contact_power == element.friction_power == element.elastic_energy == 0
    tilted = samples.rolling(0, 0, -4e-4, 1e-3, 0, 0)
    status, _ = stepped(element, model, data, tilted, samples.RATES)
    assert status == "converged"
    result = element.result()
    assert [result[side]["status"] for side in ("left", "right")] == ["no_contact", "converged"]


def generalised(model, data, q, fext):
    """J^T f of an fext: what inverse dynamics needs less with it than without."""
    zero = np.zeros(model.nv)
    without = pin.rnea(model, data, q, zero, zero).copy()
    return without - pin.rnea(model, data, q, zero, zero, fext)


def direct(model, data, q, joint, force, moment, centre):
    """J^T f with the Jacobian of the wheelset's centre; all in world axes."""
    pin.computeJointJacobians(model, data, q)
    jacobian = pin.getJointJacobian(model, data, joint, pin.LOCAL_WORLD_ALIGNED)
    lever = centre - data.oMi[joint].translation
    linear = jacobian[:3] - pin.skew(lever) @ jacobian[3:]
    return linear.T @ force + jacobian[3:].T @ moment


@pytest.mark.parametrize("carrier", ["composite", "free_flyer"])
def test_fext_gives_the_generalised_force_of_the_wrench(carrier):
    model = wheelset_model(
        samples.WHEELSET,
        samples.RADIUS,
        carrier=carrier,
        carrier_body=Body(300.0, (300.0, 20.0, 300.0)),
    )
    data = model.createData()
    joint = model.getJointId("wheelset")
    element = ForceElement(model, "wheelset", samples.CASE)
    for q, v in samples.random_motions(3, 12):
        position, velocity = q, v
        if carrier == "free_flyer":
            # the carrier has the roll and yaw angle, the other joint the pitch angle
            held = samples.turn("x", q[3]) @ samples.turn("z", q[4])
            placed = pin.SE3(held, q[:3])
            position = np.append(pin.SE3ToXYZQUAT(placed), q[5])
            spin = v[3] * np.eye(3)[0] + v[4] * samples.turn("x", q[3])[:, 2]
            velocity = np.concatenate([held.T @ v[:3], held.T @ spin, [v[5]]])
        _, fext = stepped(element, model, data, position, velocity)
        np.testing.assert_allclose(list(element.state().values())[:5], q[:5], atol=1e-13)
        np.testing.assert_allclose(list(element.state().values())[6:], v, atol=1e-12)
        force, moment = element.contact_wrench[0, :3], element.contact_wrench[0, 3:]
        centre = data.oMi[joint].translation.copy()
        expected = direct(model, data, position, joint, force, moment, centre)
        found = generalised(model, data, position, fext)
        scale = max(1.0, np.abs(expected).max())
        np.testing.assert_allclose(found, expected, rtol=0, atol=1e-10 * scale)


def test_wrench_with_wheelset_and_track_frames():
    pin.seed(5)
    track, wheelset = pin.SE3.Random(), pin.SE3.Random()
    model = pin.Model()
    joint = model.addJoint(0, pin.JointModelFreeFlyer(), pin.SE3.Identity(), "body")
    model.appendBodyToJoint(joint, pin.Inertia.Random(), pin.SE3.Identity())
    data = model.createData()
    element = ForceElement(model, "body", samples.CASE, wheelset=wheelset, track=track)
    q = samples.ROLLING
    attitude = samples.turn("x", q[3]) @ samples.turn("z", q[4])
    placed = track * pin.SE3(attitude, q[:3] - [0, 0, samples.RADIUS])
    position = pin.SE3ToXYZQUAT(placed * wheelset.inverse())
    _, fext = stepped(element, model, data, position, np.zeros(6))
    force, moment = (track.rotation @ part for part in np.split(element.contact_wrench[0], 2))
    assert np.linalg.norm(force) > 1e4
    expected = direct(model, data, position, joint, force, moment, placed.translation)
    found = generalised(model, data, position, fext)
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-10 * np.abs(expected).max())


def test_adds_to_what_is_there_and_leaves_other_joints():
    model = samples.model()
    data = model.createData()
    element = ForceElement(model, "wheelset", samples.CASE)
    _, alone = stepped(element, model, data, samples.ROLLING, samples.RATES)
    fext = pin.StdVec_Force([pin.Force(np.full(6, float(i))) for i in range(model.njoints)])
    element.reset()
    element.step(data, fext)
    joint = model.getJointId("wheelset")
    for index in range(model.njoints):
        added = alone[index].vector if index == joint else 0.0
        np.testing.assert_array_equal(fext[index].vector, added + np.full(6, float(index)))


def test_several_wheelsets_in_one_call():
    first, second = samples.model(), samples.model()
    for index, name in enumerate(first.names):
        second.names[index] = f"second {name}"
    model = pin.appendModel(first, second, 0, pin.SE3(np.eye(3), np.array([2.5, 0.0, 0.0])))
    names = [name for name in model.names if "wheelset" in name]
    joints = [model.getJointId(name) for name in names]
    assert len(joints) == 2
    data = model.createData()
    both = ForceElement(model, joints, samples.CASE)
    single = ForceElement(first, "wheelset", samples.CASE)
    (qa, va), (qb, vb) = samples.random_motions(11, 2)
    _, fext = stepped(both, model, data, np.concatenate([qa, qb]), np.concatenate([va, vb]))
    for index, (q, v) in enumerate(((qa, va), (qb, vb))):
        single.reset()
        _, alone = stepped(single, first, first.createData(), q, v)
        expected = alone[first.getJointId("wheelset")].vector
        np.testing.assert_allclose(fext[joints[index]].vector, expected, rtol=1e-9)
    assert both.state(1)["x"] == pytest.approx(qb[0] + 2.5, abs=1e-12)
    assert both.solves == 2


def test_power_is_that_of_the_generalised_force():
    model = samples.model()
    data = model.createData()
    element = ForceElement(model, "wheelset", samples.CASE)
    for q, v in samples.random_motions(21, 8):
        _, fext = stepped(element, model, data, q, v)
        expected = float(generalised(model, data, q, fext) @ v)
        scale = np.abs(element.contact_wrench).max() * 20
        assert element.contact_power == pytest.approx(expected, abs=1e-12 * scale)
        assert element.friction_power > 0 or not element.elastic_energy


@pytest.mark.parametrize(
    "changes",
    [
        {"method": {"normal": "hertz", "tangential": "fastsim"}},
        {"method": {"normal": "hertz", "tangential": "polach"}},
        {"layer": {"thickness": 20e-6, "shear_modulus": 8e9, "yield_stress": 2e8}},
    ],
    ids=["fastsim", "polach", "yields"],
)
def test_powers_are_those_of_the_result(changes):
    model = samples.model()
    case = samples.case(**changes)
    element = ForceElement(model, "wheelset", case)
    contact = railpatch.Contact(case)
    q, v = samples.random_motions(5, 1)[0]
    stepped(element, model, model.createData(), q, v)
    moving = {key: value for key, value in element.state().items() if key in samples.MOVING}
    result = contact.step(**moving)
    assert result["creep_power"] > 0
    assert element.creep_power == result["creep_power"]
    assert element.friction_power == result["friction_power"]
    assert element.elastic_energy == result["elastic_energy"]
    assert element.contact_power == pytest.approx(result["contact_power"], rel=1e-9)
    # not the same quantity
    assert abs(element.friction_power / element.creep_power - 1) > 1e-5
    for side, row in zip(("left", "right"), element.wheels[0], strict=True):
        assert row[6] == result[side]["creep_power"]
        assert row[8] == result[side]["friction_power"]


def test_saved_state_gives_the_same_bits():
    model = samples.model()
    data = model.createData()
    element = ForceElement(model, "wheelset", samples.CASE)
    motions = samples.random_motions(2, 6)
    stepped(element, model, data, *motions[0])
    saved = element.save()
    first = [stepped(element, model, data, *m)[1][6].vector.copy() for m in motions[1:]]
    element.restore(saved)
    second = [stepped(element, model, data, *m)[1][6].vector.copy() for m in motions[1:]]
    np.testing.assert_array_equal(first, second)
    other = ForceElement(model, "wheelset", samples.CASE)
    other.restore(saved)
    np.testing.assert_array_equal(stepped(other, model, data, *motions[1])[1][6].vector, first[0])


@pytest.mark.parametrize("state", [b"", b"123", b"\x04\x00\x00\x00abcd", b"\x00" * 64])
def test_other_bytes_are_no_state(state):
    element = ForceElement(samples.model(), "wheelset", samples.CASE)
    with pytest.raises(CaseError, match="state: value is no state"):
        element.restore(state)


def test_without_friction():
    case = samples.case(method={"tangential": "none"}, friction={"coefficient": None})
    case.pop("friction")
    model = samples.model()
    element = ForceElement(model, "wheelset", case)
    stepped(element, model, model.createData(), samples.ROLLING, samples.RATES)
    assert element.friction_power == 0
    assert element.elastic_energy > 0
