"""Model exchange: no states, no events, outputs that follow the inputs at once."""

from __future__ import annotations

import ctypes as ct
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fmpy import simulate_fmu
from fmu_scenes import MOTIONS, SCENES
from slave import DISCARD, ERROR, OK, Fmu, Integer, Real, Reference, Size, Slave

Unpack = Callable[..., Fmu]
HISTORY = (
    "transient", "transient_patch", "supported", "springs", "plastic", "falling", "hot",
    "falling_wheels", "falling_transient",
)  # fmt: skip
NONE = Size(0)
INSTANTIATED, INITIALIZATION, EVENT, CONTINUOUS, TERMINATED, ERROR_STATE = range(6)
ALL = {INSTANTIATED, INITIALIZATION, EVENT, CONTINUOUS, TERMINATED, ERROR_STATE}
ASKED = ALL - {INSTANTIATED}
FLAG = ct.byref(Integer())


class EventInfo(ct.Structure):
    """fmi2EventInfo."""

    _fields_ = (
        ("needed", ct.c_int),
        ("terminate", ct.c_int),
        ("nominals", ct.c_int),
        ("values", ct.c_int),
        ("defined", ct.c_int),
        ("next", ct.c_double),
    )


# FMI 2.0, section 3.2.3: where each call is allowed, and with which arguments it does nothing
CALLS: dict[str, tuple[set[int], tuple[Any, ...]]] = {
    "SetDebugLogging": (ALL, (1, NONE, None)),
    "SetupExperiment": ({INSTANTIATED}, (0, Real(0), Real(0), 0, Real(0))),
    "EnterInitializationMode": ({INSTANTIATED}, ()),
    "ExitInitializationMode": ({INITIALIZATION}, ()),
    "Terminate": ({EVENT, CONTINUOUS}, ()),
    "Reset": (ALL, ()),
    "EnterEventMode": ({EVENT, CONTINUOUS}, ()),
    "NewDiscreteStates": ({EVENT}, (ct.byref(EventInfo()),)),
    "EnterContinuousTimeMode": ({EVENT}, ()),
    "CompletedIntegratorStep": ({CONTINUOUS}, (1, FLAG, FLAG)),
    "SetTime": ({EVENT, CONTINUOUS}, (Real(0.5),)),
    "SetContinuousStates": ({CONTINUOUS}, (None, NONE)),
    "GetDerivatives": (ASKED, (None, NONE)),
    "GetEventIndicators": (ASKED, (None, NONE)),
    "GetContinuousStates": (ASKED, (None, NONE)),
    "GetNominalsOfContinuousStates": (ALL, (None, NONE)),
    "GetReal": (ASKED, (None, NONE, None)),
    "GetInteger": (ASKED, (None, NONE, None)),
    "SetReal": (ALL - {TERMINATED, ERROR_STATE}, (None, NONE, None)),
    "SetInteger": ({INSTANTIATED, INITIALIZATION, EVENT}, (None, NONE, None)),
    "GetDirectionalDerivative": (ASKED, (None, NONE, None, NONE, None, None)),
    "FreeFMUstate": (ALL, (ct.byref(ct.c_void_p()),)),
    # of co-simulation
    "DoStep": (set(), (Real(0), Real(1e-3), 1)),
    "CancelStep": (set(), ()),
    "GetStatus": (set(), (0, FLAG)),
    "SetRealInputDerivatives": (set(), (None, NONE, None, None)),
    "GetRealOutputDerivatives": (set(), (None, NONE, None, None)),
}


def brought_to(fmu: Fmu, state: int) -> Slave:
    """An instance in that state."""
    model = Slave(fmu, exchange=True)
    assert model.component, model.log
    if state == ERROR_STATE:
        assert model.set({"wheelset.z": 0.02}) == OK
    if state >= INITIALIZATION:
        assert model.call("EnterInitializationMode") == OK
    if state >= EVENT:
        left = model.call("ExitInitializationMode")
        assert left == (ERROR if state == ERROR_STATE else OK), model.log
    if state == CONTINUOUS:
        assert model.call("EnterContinuousTimeMode") == OK
    if state == TERMINATED:
        assert model.call("Terminate") == OK
    model.log.clear()
    return model


@pytest.mark.parametrize("state", sorted(ALL))
def test_every_call_in_every_state(state: int, unpacked: Unpack) -> None:
    fmu = unpacked("frictionless")
    for name, (allowed, arguments) in CALLS.items():
        with brought_to(fmu, state) as model:
            status = model.call(name, *arguments)
            if state in allowed:
                assert (status, model.log) == (OK, []), name
            else:
                assert status == ERROR, name
                [(_, category, text)] = model.log
                assert category == "logStatusError"
                assert name in text


def test_calls_of_model_exchange_are_refused_in_co_simulation(unpacked: Unpack) -> None:
    for name in ("EnterEventMode", "EnterContinuousTimeMode"):
        with Slave(unpacked("frictionless")).initialize() as slave:
            assert slave.call(name) == ERROR
            assert "model exchange" in slave.log[0][2]


def test_wrong_arguments(unpacked: Unpack) -> None:
    with brought_to(unpacked("frictionless"), CONTINUOUS) as model:
        assert model.call("CompletedIntegratorStep", 1, None, FLAG) == ERROR
        assert model.call("SetTime", Real(math.nan)) == ERROR
        assert model.call("GetDerivatives", (Real * 1)(), Size(1)) == ERROR
        assert model.call("EnterEventMode") == OK
        assert model.call("NewDiscreteStates", None) == ERROR
        assert len(model.log) == 4
        info = EventInfo(1, 1, 1, 1, 1, 1.0)
        assert model.call("NewDiscreteStates", ct.byref(info)) == OK
        assert [getattr(info, name) for name, _ in info._fields_] == [0] * 6


def test_outputs_follow_at_once(unpacked: Unpack) -> None:
    """The same numbers as a slave's after its step, to the solver's tolerance."""
    fmu = unpacked("rail")
    with brought_to(fmu, CONTINUOUS) as model, Slave(fmu).initialize() as slave:
        for k, values in enumerate(MOTIONS["rail"]):
            assert model.call("SetTime", Real(1e-3 * (k + 1))) == OK
            assert model.set(values) == OK
            assert slave.set(values) == OK
            assert slave.step(1e-3 * k, 1e-3) == OK
            names = ["force[1]", "force[2]", "force[3]", "moment[3]", "z", "status"]
            assert model.get(*names) == pytest.approx(slave.get(*names), rel=1e-9, abs=1e-9)


def test_a_failed_solve_is_discarded_and_the_next_one_works(unpacked: Unpack) -> None:
    with brought_to(unpacked("rail"), CONTINUOUS) as model:
        before = model.outputs()
        assert model.set({"wheelset.z": 0.02}) == OK
        number = (Reference * 1)(model.fmu.references["force[3]"])
        assert model.call("GetReal", number, Size(1), (Real * 1)()) == DISCARD
        assert model.set({"wheelset.z": 2.0e-4}) == OK
        found = model.outputs()
        for name in ("force[1]", "force[3]", "status"):
            assert found[name] == pytest.approx(before[name], rel=1e-4, abs=1e-6)


def test_derivatives_are_those_at_the_values_set(unpacked: Unpack) -> None:
    """A pass-through shows which inputs count; a slave's stay those of its last step."""
    fmu = unpacked("rail")
    seeds = {"wheelset.z": 1e-5}
    with brought_to(fmu, CONTINUOUS) as model, Slave(fmu).initialize() as slave:
        _, [at_start] = slave.derivative(["force[3]"], seeds)
        for one in (model, slave):
            assert one.set({"wheelset.z": 3e-4}) == OK
        status, [moved] = model.derivative(["force[3]"], seeds)
        assert status == OK, model.log
        assert slave.derivative(["force[3]"], seeds) == (OK, [at_start])
        assert slave.step(0, 1e-3) == OK
        _, [stepped] = slave.derivative(["force[3]"], seeds)
    assert moved == pytest.approx(stepped, rel=1e-6)
    assert abs(moved - at_start) > 0.1 * abs(at_start)


def test_states_of_the_other_interface_are_refused(unpacked: Unpack) -> None:
    fmu = unpacked("rail")
    with brought_to(fmu, CONTINUOUS) as model, Slave(fmu).initialize() as slave:
        assert model.set({"wheelset.y": 1e-4}) == OK
        expected = model.outputs()
        content = model.serialize(model.save())
        _, handle = slave.deserialize(content)
        assert slave.restore(handle) == ERROR
        for state in (INSTANTIATED, INITIALIZATION, EVENT, CONTINUOUS):
            with brought_to(fmu, state) as other:
                status, handle = other.deserialize(content)
                assert status == OK
                assert other.restore(handle) == OK, other.log
                assert other.outputs() == expected


@pytest.mark.parametrize("name", SCENES)
def test_offered_where_there_is_no_history(name: str, unpacked: Unpack) -> None:
    fmu = unpacked(name)
    assert (fmu.root.find("ModelExchange") is None) == (name in HISTORY)
    with Slave(fmu, exchange=True) as model:
        assert (model.component is None) == (name in HISTORY)


def test_outputs_after_the_end_are_those_of_the_last_inputs(unpacked: Unpack) -> None:
    fmu = unpacked("rail")
    found = []
    for read_before in (True, False):
        with brought_to(fmu, CONTINUOUS) as model:
            assert model.set({"wheelset.z": 2.1e-4}) == OK
            if read_before:
                model.outputs()
            assert model.call("Terminate") == OK
            found.append(model.outputs())
    assert found[0] == found[1]


def test_parameters_are_set_in_event_mode(unpacked: Unpack) -> None:
    """FMI 2.0.4, section 3.2.3: in continuous-time mode only continuous inputs and states are."""
    with brought_to(unpacked("rail"), CONTINUOUS) as model:
        assert model.set({"friction.coefficient": 0.2}) == ERROR
        assert "friction.coefficient is a parameter" in model.log[-1][2]
        assert model.get("friction.coefficient") == [0.3]
        assert model.call("EnterEventMode") == OK
        assert model.set({"friction.coefficient": 0.2}) == OK


@pytest.mark.parametrize("name", ["rail", "patch", "closed_form", "frictionless"])
def test_fmpy_simulates_it(name: str, packed: Callable[..., Path]) -> None:
    """With an input over time: outputs without lag, those of solves at the inputs themselves."""
    time = np.linspace(0, 0.01, 11)
    known, low, high, output = {
        "patch": ("normal_force", 5e4, 1e5, "creep_force[1]"),
        "closed_form": ("normal_force", 5e4, 1e5, "creep_force[1]"),
    }.get(name, ("wheelset.y", 0.0, 1e-3, "force[2]"))
    signal = np.array(
        list(zip(time, np.linspace(low, high, 11), strict=True)),
        dtype=[("time", float), (known, float)],
    )
    path = str(packed(name, "eigen"))
    settings = {"stop_time": 0.01, "output_interval": 1e-3, "input": signal, "output": [output]}
    rows = simulate_fmu(path, fmi_type="ModelExchange", **settings)
    assert len(rows) == 11
    assert len(set(rows[output])) == 11
    late = simulate_fmu(path, fmi_type="CoSimulation", step_size=1e-3, **settings)
    # co-simulation gives at each point what the inputs one step before gave
    assert late[output][2:] == pytest.approx(rows[output][1:-1], rel=1e-3)
