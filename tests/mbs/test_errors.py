"""Wrong calls: each is refused by name before Pinocchio sees it."""

from __future__ import annotations

import math

import mbs_samples as samples
import numpy as np
import pinocchio as pin
import pytest
from railpatch import CaseError
from railpatch.pinocchio import Body, ForceElement, Suspension, wheelset_model


@pytest.fixture
def ready():
    """Element and data, at a state in contact."""
    model = samples.model()
    data = model.createData()
    pin.forwardKinematics(model, data, samples.ROLLING, samples.RATES)
    return ForceElement(model, "wheelset", samples.CASE), data, model


@pytest.mark.parametrize("length", [0, 1, 6, 8])
def test_fext_of_another_length(ready, length):
    element, data, _ = ready
    fext = pin.StdVec_Force([pin.Force.Zero() for _ in range(length)])
    with pytest.raises(ValueError, match=rf"fext: length is {length}, allowed 7, one for each"):
        element.step(data, fext)
    assert all((force.vector == 0).all() for force in fext)


@pytest.mark.parametrize("fext", [None, np.zeros((7, 6)), [pin.Force.Zero()] * 7, "fext"])
def test_fext_of_another_type(ready, fext):
    element, data, _ = ready
    with pytest.raises(TypeError, match=r"fext: value is of type \w+, allowed pinocchio"):
        element.step(data, fext)


def test_data_of_another_model(ready):
    element, _, model = ready
    with pytest.raises(ValueError, match=r"data: belongs to a model of 1 joints, allowed 7"):
        element.step(pin.Model().createData(), samples.no_forces(model))


@pytest.mark.parametrize(
    ("joint", "message"),
    [
        ("axle", "joint: value is 'axle', allowed x, y, z, roll, yaw, wheelset"),
        (0, "joint: value is 0, allowed 1 to 6"),
        (7, "joint: value is 7"),
        (2.0, "joint: value is 2.0"),
    ],
)
def test_joint_that_the_model_lacks(joint, message):
    with pytest.raises(ValueError, match=message):
        ForceElement(samples.model(), joint, samples.CASE)


@pytest.mark.parametrize(
    ("case", "message"),
    [
        (
            samples.case(wheelset={"z": None, "vertical_force": 1e5}),
            r"wheelset.vertical_force: value is 100000.0, allowed 'z'",
        ),
        (samples.case(track={"curvature": 1e-3}), r"track.curvature: value is 0.001, allowed 0"),
        (
            samples.case(
                track={"rail_support": {"stiffness": [2e7, 5e7]}}, wheelset={"time_step": 1e-3}
            ),
            r"wheelset.time_step: value is 0.001, allowed 0: forces are asked for several times",
        ),
        (
            {
                **samples.case(
                    wheelset={"time_step": 1e-3},
                    grid={"elements": None, "element_size": [1e-3, 1e-3]},
                ),
                "motion": {"regime": "transient_rolling"},
            },
            r"motion.regime: value is 'transient_rolling', allowed 'steady_rolling'",
        ),
        (
            samples.case(track={"gage": 1.4}),
            r"track.gage: value is 1.4, but the key is unknown.*did you mean 'gauge'",
        ),
        (
            {**samples.CASE, "kind": "wheel_rail"},
            r"kind: value is 'wheel_rail', allowed 'wheelset'",
        ),
    ],
)
def test_case_that_does_not_fit(case, message):
    with pytest.raises(CaseError, match=message):
        ForceElement(samples.model(), "wheelset", case)


@pytest.mark.parametrize("asked", [False, True])
def test_derivatives_need_a_step_and_the_option(asked):
    """No zeros for what was never found."""
    case = samples.case(method={"derivatives": asked})
    element = ForceElement(samples.model(), "wheelset", case)
    with pytest.raises(CaseError):
        element.derivatives()


def test_numbers_that_are_none():
    """By name; a joint twice would have its forces twice."""
    model = samples.model()
    with pytest.raises(ValueError, match="joint: value is 'wheelset' twice, allowed once"):
        ForceElement(model, ["wheelset", "wheelset"], samples.CASE)
    for speed in (math.nan, math.inf):
        with pytest.raises(CaseError, match=r"frame_speed: value is .*, allowed a finite number"):
            ForceElement(model, "wheelset", samples.CASE, frame_speed=speed)
    element = ForceElement(model, "wheelset", samples.CASE)
    for seconds in ("1", None, True, math.nan, -1.0):
        with pytest.raises(CaseError, match=r"seconds: value is .*, allowed >= 0 and finite"):
            element.pass_time(seconds)
    for index in (1, -1, 0.5, None, True):
        for asked in (element.state, element.result, element.derivatives):
            with pytest.raises(CaseError, match=r"index: value is .*, allowed 0 to 0"):
                asked(index)


def test_lists_of_different_length():
    with pytest.raises(CaseError, match="case: value is a list of 2, allowed 1"):
        ForceElement(samples.model(), "wheelset", [samples.CASE, samples.CASE])


def test_state_outside_the_library_s_range(ready):
    element, data, model = ready
    fallen = samples.rolling(0, 0, 0, np.pi / 2, 0, 0)
    pin.forwardKinematics(model, data, fallen, samples.RATES)
    before = element.state()
    with pytest.raises(CaseError, match="roll"):
        element.step(data, samples.no_forces(model))
    assert element.state() == before


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"nominal_radius": 0.0}, "nominal_radius: value is 0.0"),
        ({"wheelset": Body(1.0, (1.0, 1.0, 2.0))}, "allowed equal ones about x and z"),
        ({"carrier": "rope"}, "carrier: value is 'rope'"),
        ({"carrier": "free_flyer"}, "carrier_body: missing"),
    ],
)
def test_model_builder(arguments, message):
    given = {"wheelset": samples.WHEELSET, "nominal_radius": 0.46, **arguments}
    with pytest.raises(ValueError, match=message):
        wheelset_model(**given)


@pytest.mark.parametrize("values", [(0.0, (1, 1, 1)), (1.0, (1, -1, 1)), (np.nan, (1, 1, 1))])
def test_body(values):
    with pytest.raises(ValueError, match="body: values are"):
        Body(*values)


@pytest.mark.parametrize(
    ("stiffness", "damping", "message"),
    [
        ({"pitch": 1.0}, {}, "stiffness.pitch: the key is unknown"),
        ({"x": -1.0}, {}, "stiffness.x: value is -1.0"),
        ({}, {"y": np.inf}, "damping.y: value is inf"),
    ],
)
def test_suspension(ready, stiffness, damping, message):
    with pytest.raises(ValueError, match=message):
        Suspension(ready[0], stiffness, damping)
