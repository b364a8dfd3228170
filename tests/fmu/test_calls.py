"""Illegal calls: fmi2Error and one line in the log, in every state; nothing changes by them."""

from __future__ import annotations

import ctypes as ct
import math
from collections.abc import Callable
from typing import Any

import pytest
from slave import DISCARD, ERROR, OK, Fmu, Integer, Real, Reference, Size, Slave

Unpack = Callable[..., Fmu]
NONE = Size(0)
STATE = ct.c_void_p()

INSTANTIATED, INITIALIZATION, COMPLETE, FAILED, TERMINATED, ERROR_STATE = range(6)
ALL = {INSTANTIATED, INITIALIZATION, COMPLETE, FAILED, TERMINATED, ERROR_STATE}
GETS = ALL - {INSTANTIATED}
SETS = {INSTANTIATED, INITIALIZATION, COMPLETE}
ASKED = {COMPLETE, FAILED, TERMINATED}
# FMI 2.0, section 4.2.4: where each call is allowed, and with which arguments it does nothing
CALLS: dict[str, tuple[set[int], tuple[Any, ...]]] = {
    "SetDebugLogging": (ALL, (1, NONE, None)),
    "SetupExperiment": ({INSTANTIATED}, (0, Real(0), Real(0), 0, Real(0))),
    "EnterInitializationMode": ({INSTANTIATED}, ()),
    "ExitInitializationMode": ({INITIALIZATION}, ()),
    "Terminate": ({COMPLETE, FAILED}, ()),
    "Reset": (ALL, ()),
    **{f"Get{kind}": (GETS, (None, NONE, None)) for kind in ("Real", "Integer")},
    **{f"Get{kind}": (GETS, (None, NONE, None)) for kind in ("Boolean", "String")},
    **{f"Set{kind}": (SETS, (None, NONE, None)) for kind in ("Real", "Integer")},
    **{f"Set{kind}": (SETS, (None, NONE, None)) for kind in ("Boolean", "String")},
    "FreeFMUstate": (ALL, (ct.byref(STATE),)),
    "GetDirectionalDerivative": (GETS, (None, NONE, None, NONE, None, None)),
    "SetRealInputDerivatives": (SETS, (None, NONE, None, None)),
    "GetRealOutputDerivatives": (GETS - {INITIALIZATION}, (None, NONE, None, None)),
    "DoStep": ({COMPLETE}, (Real(0), Real(1e-3), 1)),
    "CancelStep": (set(), ()),
    "GetStatus": (ASKED, (0, ct.byref(Integer()))),
    "GetRealStatus": (ASKED, (2, ct.byref(Real()))),
    "GetBooleanStatus": (ASKED, (3, ct.byref(Integer()))),
}


def brought_to(fmu: Fmu, state: int) -> Slave:
    """An instance in that state."""
    slave = Slave(fmu)
    if state == INITIALIZATION:
        assert slave.call("EnterInitializationMode") == OK
    if state >= COMPLETE:
        slave.initialize()
    if state == FAILED:
        assert slave.set({"wheelset.z": 0.02}) == OK
        assert slave.step(0, 1e-3) == DISCARD
    if state == TERMINATED:
        assert slave.call("Terminate") == OK
    if state == ERROR_STATE:
        assert slave.call("Reset") == OK
        assert slave.set({"wheelset.z": 0.02}) == OK
        assert slave.call("EnterInitializationMode") == OK
        assert slave.call("ExitInitializationMode") == ERROR
    slave.log.clear()
    return slave


@pytest.mark.parametrize("state", sorted(ALL))
def test_every_call_in_every_state(state: int, unpacked: Unpack) -> None:
    fmu = unpacked("frictionless")
    for name, (allowed, arguments) in CALLS.items():
        with brought_to(fmu, state) as slave:
            status = slave.call(name, *arguments)
            if state in allowed:
                assert (status, slave.log) == (OK, []), name
            else:
                assert status == ERROR, name
                [(logged, category, text)] = slave.log
                assert (logged, category) == (ERROR, "logStatusError"), name
                assert name in text


@pytest.mark.parametrize("state", sorted(ALL))
def test_states_can_be_saved_and_restored_everywhere(state: int, unpacked: Unpack) -> None:
    with brought_to(unpacked("frictionless"), state) as slave:
        handle = slave.save()
        assert slave.restore(handle) == OK
        content = slave.serialize(handle)
        assert slave.deserialize(content)[0] == OK
        assert slave.log == []


def refused(slave: Slave, name: str, *arguments: Any) -> None:
    """fmi2Error, and one line."""
    slave.log.clear()
    assert slave.call(name, *arguments) == ERROR, name
    assert len(slave.log) == 1, name
    assert slave.log[0][:2] == (ERROR, "logStatusError")


def test_wrong_values_are_refused_and_change_nothing(unpacked: Unpack) -> None:
    fmu = unpacked("patch")
    one = Size(1)
    with Slave(fmu).initialize() as slave:
        before = slave.outputs()
        force, direction = fmu.references["normal_force"], fmu.references["direction"]
        output = fmu.references["creep_force[1]"]
        real, whole = (Real * 2)(1e4, 1e4), (Integer * 1)(1)
        refused(slave, "SetReal", (Reference * 1)(output), one, real)
        for value in (math.nan, math.inf, -math.inf, -1e-9, -1.0, 1e12):
            refused(slave, "SetReal", (Reference * 1)(force), one, (Real * 1)(value))
        # the first is good, the second not: neither is set
        refused(slave, "SetReal", (Reference * 2)(force, 99), Size(2), real)
        refused(slave, "SetInteger", (Reference * 1)(direction), one, (Integer * 1)(2))
        for wrong in (0, 77, 2**32 - 1, direction):
            refused(slave, "GetReal", (Reference * 1)(wrong), one, real)
            refused(slave, "SetReal", (Reference * 1)(wrong), one, real)
        refused(slave, "GetInteger", (Reference * 1)(force), one, whole)
        for function in ("GetReal", "SetReal", "GetInteger", "GetString", "SetBoolean"):
            refused(slave, function, None, one, real)
            refused(slave, function, (Reference * 1)(force), one, None)
        refused(slave, "GetString", (Reference * 1)(force), one, real)
        refused(slave, "GetDirectionalDerivative", None, one, None, one, None, None)
        refused(slave, "SetRealInputDerivatives", None, one, None, None)
        refused(slave, "GetRealOutputDerivatives", None, one, None, None)
        assert slave.get("normal_force") == [1e5]
        assert slave.outputs() == before
        assert slave.step(0, 1e-3) == OK


def test_wrong_steps_are_refused(unpacked: Unpack) -> None:
    with Slave(unpacked("patch")) as slave:
        assert slave.call("SetupExperiment", 1, Real(1e-6), Real(1.0), 1, Real(1.01)) == OK
        assert slave.call("EnterInitializationMode") == OK
        assert slave.call("ExitInitializationMode") == OK
        for time, step in (
            (1.0, 0.0),
            (1.0, -1e-3),
            (1.0, math.nan),
            (1.0, math.inf),
            (0.999, 1e-3),
            (math.nan, 1e-3),
            (1.0, 0.02),
        ):
            refused(slave, "DoStep", Real(time), Real(step), 1)
        for time in (1.0, 1.001 + 1e-12, 1.002, 1.003):
            assert slave.step(time, 1e-3) == OK, slave.log
        value = Real()
        assert slave.call("GetRealStatus", 2, ct.byref(value)) == OK
        assert value.value == pytest.approx(1.004)


def test_wrong_experiments_are_refused(unpacked: Unpack) -> None:
    with Slave(unpacked("patch")) as slave:
        for arguments in (
            (1, Real(-1), Real(0), 0, Real(0)),
            (1, Real(math.nan), Real(0), 0, Real(0)),
            (0, Real(0), Real(math.nan), 0, Real(0)),
            (0, Real(0), Real(1), 1, Real(0.5)),
        ):
            refused(slave, "SetupExperiment", *arguments)


def test_a_direction_of_0_is_refused(unpacked: Unpack) -> None:
    with Slave(unpacked("patch")).initialize() as slave:
        assert slave.set({"direction": 0}) == ERROR
        assert "direction is 0, allowed -1 and 1" in slave.log[0][2]
        assert slave.step(0, 1e-3) == OK
        assert slave.get("direction") == [1]


def test_a_refused_number_is_answered_in_its_unit(unpacked: Unpack) -> None:
    with Slave(unpacked("patch")).initialize() as slave:
        assert slave.set({"rolling_speed": -2.0}) == ERROR
        assert slave.log[-1][2].endswith("rolling_speed is -2, allowed 0 ... 1000 m/s")
        assert slave.set({"spin_creepage": 1e9}) == ERROR
        assert slave.log[-1][2].endswith(" ... 10000 rad/m")
        # without dimension
        assert slave.set({"creepage[1]": 1e9}) == ERROR
        assert slave.log[-1][2].endswith("creepage[1] is 1e+09, allowed -100 ... 100")


def test_status_of_a_step(unpacked: Unpack) -> None:
    with brought_to(unpacked("frictionless"), FAILED) as slave:
        value, time, ended = Integer(), Real(1), Integer(1)
        assert slave.call("GetStatus", 0, ct.byref(value)) == OK
        assert slave.call("GetRealStatus", 2, ct.byref(time)) == OK
        assert slave.call("GetBooleanStatus", 3, ct.byref(ended)) == OK
        assert (value.value, time.value, ended.value) == (DISCARD, 0.0, 0)
        assert slave.call("GetStringStatus", 1, ct.byref(ct.c_char_p())) == DISCARD
        assert slave.call("GetIntegerStatus", 0, ct.byref(value)) == DISCARD
        refused(slave, "GetStatus", 9, ct.byref(value))
        refused(slave, "GetStatus", 0, None)


def test_instantiation_is_forgiving_where_it_can(unpacked: Unpack) -> None:
    fmu = unpacked("patch_normal")
    for name in ("a b", "/a/path/to.fmu", "100% #1"):
        with Slave(fmu, callbacks=False, name=name).initialize() as slave:
            assert slave.step(0, 1e-3) == OK
            assert slave.call("GetReal", None, Size(1), None) == ERROR
    for changes in ({"name": ""}, {"guid": "{other}"}, {"guid": None}):
        with Slave(fmu, **changes) as slave:
            assert slave.component is None
            assert len(slave.log) == 1
    free = fmu.binary.fmi2FreeInstance
    free(None)
    assert fmu.binary.fmi2Reset(None) == ERROR


def test_the_log_can_be_switched(unpacked: Unpack, capfd: pytest.CaptureFixture[str]) -> None:
    """But for what tells why a call failed, which is always said, up to a hundred times alike."""
    with Slave(unpacked("patch"), logging=False).initialize() as slave:
        refused(slave, "GetReal", None, Size(1), None)
        names = (ct.c_char_p * 1)(b"logStatusDiscard")
        assert slave.call("SetDebugLogging", 1, Size(1), names) == OK
        refused(slave, "GetReal", None, Size(1), None)
        assert slave.call("SetDebugLogging", 1, Size(1), (ct.c_char_p * 1)(b"logAll")) == OK
        refused(slave, "GetReal", None, Size(1), None)
        refused(slave, "SetDebugLogging", 1, Size(1), (ct.c_char_p * 1)(b"other"))
        refused(slave, "SetDebugLogging", 1, Size(1), None)
        slave.log.clear()
        for _ in range(1000):
            slave.call("GetReal", None, Size(1), None)
        assert 1 < len(slave.log) < 200
        assert "left out" in slave.log[-1][2]
        assert slave.call("SetDebugLogging", 0, NONE, None) == OK
        refused(slave, "GetInteger", None, Size(1), None)
    assert capfd.readouterr() == ("", "")
