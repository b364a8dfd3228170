"""Saved states: the same bits afterwards, also in another process; other bytes are refused."""

from __future__ import annotations

import ctypes as ct
import json
import random
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
import slave as slave_program
from fmu_scenes import MOTIONS, SCENES, STEP, run
from slave import ERROR, OK, Fmu, Slave

Unpack = Callable[..., Fmu]


@pytest.mark.parametrize("name", SCENES)
def test_restored_state_gives_the_same_bits(name: str, unpacked: Unpack) -> None:
    first, rest = MOTIONS[name][:1], [*MOTIONS[name], *MOTIONS[name][:1]]
    with Slave(unpacked(name)).initialize() as slave:
        before = run(slave, first, 0)
        state = slave.save()
        expected = run(slave, rest, STEP)
        assert slave.restore(state) == OK
        assert slave.outputs() == before
        assert run(slave, rest, STEP) == expected
        # also on one that was only instantiated, and by way of bytes
        content = slave.serialize(state)
        with Slave(unpacked(name)) as other:
            status, handle = other.deserialize(content)
            assert status == OK, other.log
            assert other.restore(handle) == OK, other.log
            assert other.outputs() == before
            assert run(other, rest, STEP) == expected
            assert other.serialize(handle) == content


@pytest.mark.parametrize("name", ["patch", "roller", "patches", "hot"])
def test_another_process_gives_the_same_bits(name: str, unpacked: Unpack, tmp_path: Path) -> None:
    fmu = unpacked(name)
    with Slave(fmu).initialize(start=2.0) as slave:
        run(slave, MOTIONS[name][:1], 2.0)
        (tmp_path / "state").write_bytes(slave.serialize(slave.save()))
        expected = run(slave, MOTIONS[name], 2.0 + STEP)
    steps = {"time": 2.0 + STEP, "values": MOTIONS[name]}
    (tmp_path / "steps.json").write_text(json.dumps(steps))
    program = Path(slave_program.__file__)
    command = [sys.executable, program, fmu.folder, tmp_path / "state", tmp_path / "steps.json"]
    output = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    found = {
        k: float.fromhex(v) if isinstance(v, str) else v for k, v in json.loads(output).items()
    }
    assert found == expected


@pytest.mark.parametrize("name", ["patch", "rail"])
def test_reset_and_repeat_give_the_same_bits(name: str, unpacked: Unpack) -> None:
    with Slave(unpacked(name)).initialize() as slave:
        expected = run(slave, MOTIONS[name], 0)
        assert slave.outputs() == expected
        assert slave.call("Reset") == OK
        slave.initialize()
        assert run(slave, MOTIONS[name], 0) == expected
    with Slave(unpacked(name)).initialize() as slave:
        assert run(slave, MOTIONS[name], 0) == expected


def test_gets_in_initialization_mode_change_nothing_later(unpacked: Unpack) -> None:
    with Slave(unpacked("rail")).initialize() as slave:
        expected = run(slave, MOTIONS["rail"], 0)
    with Slave(unpacked("rail")) as slave:
        assert slave.setup() == OK
        assert slave.call("EnterInitializationMode") == OK
        at_start = slave.outputs()
        assert slave.set({"wheelset.z": 1.9e-4}) == OK
        changed = slave.outputs()
        assert slave.get("wheelset.z", "z") == [1.9e-4, 1.9e-4]
        assert changed["force[3]"] != at_start["force[3]"]
        assert slave.set({"wheelset.z": 2.0e-4}) == OK
        assert slave.outputs() == at_start
        assert slave.call("ExitInitializationMode") == OK
        assert slave.outputs() == at_start
        assert run(slave, MOTIONS["rail"], 0) == expected


def test_state_carries_time_mode_and_parameters(unpacked: Unpack) -> None:
    with Slave(unpacked("patch")) as slave:
        fresh = slave.save()
        slave.initialize(start=5.0)
        assert slave.set({"friction.coefficient": 0.1, "creepage[1]": 0.1}) == OK
        assert slave.step(5.0, STEP) == OK
        late = slave.save()
        assert slave.restore(fresh) == OK
        assert slave.step(5.0, STEP) == ERROR  # instantiated again
        assert slave.restore(late) == OK
        assert slave.get("friction.coefficient") == [0.1]
        assert slave.step(5.0, STEP) == ERROR  # the time is 5.001
        assert slave.step(5.0 + STEP, STEP) == OK


def test_other_bytes_are_refused(unpacked: Unpack) -> None:
    with Slave(unpacked("patch")).initialize() as slave:
        content = slave.serialize(slave.save())
        expected = run(slave, MOTIONS["patch"], 0)
        with Slave(unpacked("rail")).initialize() as other:
            foreign = other.serialize(other.save())
        wrong = [b"", b"\0", content[:-1], content + b"\0", content[:80], foreign]
        draw = random.Random(3)
        # fewer than the log repeats
        for _ in range(80):
            at = draw.randrange(len(content))
            changed = bytes([content[at] ^ (1 << draw.randrange(8))])
            wrong.append(content[:at] + changed + content[at + 1 :])
        for number, altered in enumerate(wrong):
            slave.log.clear()
            status, handle = slave.deserialize(altered)
            assert (status, handle.value) == (ERROR, None), number
            assert len(slave.log) == 1
        assert slave.outputs() == expected


def test_handles_are_checked(unpacked: Unpack) -> None:
    with Slave(unpacked("patch")).initialize() as slave, Slave(unpacked("patch")) as other:
        state = slave.save()
        value = state.value
        assert slave.call("GetFMUstate", ct.byref(state)) == OK  # used again
        assert state.value == value
        assert other.restore(state) == ERROR
        assert slave.restore(ct.c_void_p(12345)) == ERROR
        assert slave.restore(None) == ERROR
        assert slave.call("GetFMUstate", ct.byref(ct.c_void_p(12345))) == ERROR
        assert slave.call("FreeFMUstate", ct.byref(ct.c_void_p(12345))) == ERROR
        assert slave.call("FreeFMUstate", ct.byref(ct.c_void_p())) == OK
        assert slave.call("FreeFMUstate", None) == OK
        assert slave.call("FreeFMUstate", ct.byref(state)) == OK
        assert state.value is None
        assert slave.restore(ct.c_void_p(value)) == ERROR
        # one importer hands over the handle in place of its address
        state = slave.save()
        assert slave.call("FreeFMUstate", state) == OK
        assert slave.restore(state) == ERROR
        size = ct.c_size_t()
        assert slave.call("SerializedFMUstateSize", state, ct.byref(size)) == ERROR
        state = slave.save()
        assert slave.call("SerializedFMUstateSize", state, None) == ERROR
        assert slave.call("SerializeFMUstate", state, None, ct.c_size_t(10**6)) == ERROR
        buffer = ct.create_string_buffer(10)
        assert slave.call("SerializeFMUstate", state, buffer, ct.c_size_t(10)) == ERROR
