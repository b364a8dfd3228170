"""FMI 3.0: the numbers are those of FMI 2.0, vectors are arrays, and calls keep the standard."""

from __future__ import annotations

import ast
import ctypes as ct
import subprocess
import sys
import zipfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from fmpy import read_model_description, simulate_fmu
from fmpy.validation import validate_fmu
from fmu_scenes import MOTIONS, OWN, SCENES, STEP
from railpatch.case import load_scene
from railpatch.fmu import pack_fmu
from railpatch.fmu.scenes import kind_scene, kinds
from slave import Fmu, Reference, Size, Slave
from slave3 import DISCARD, ERROR, OK, Fmu3, Slave3

# scenes whose inputs do not move in a step: a selection of every kind, quick ones
SAME = ("patch", "hot", "plastic", "prescribed_force", "rail", "roller", "loaded", "left_wheel")
SAME += ("patches", "transient", "supported", "flat", "frictionless", "transient_patch")


@pytest.fixture(scope="session")
def three(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], Fmu3]:
    """Name of a scene -> its FMU for FMI 3.0, unpacked and loaded."""
    folder = tmp_path_factory.mktemp("fmi3")
    found: dict[str, Fmu3] = {}

    def unpack(name: str) -> Fmu3:
        if name not in found:
            path = folder / f"{name}.fmu"
            pack_fmu(load_scene(SCENES[name]), path, name=name, backend=OWN, fmi=3)
            zipfile.ZipFile(path).extractall(folder / name)
            found[name] = Fmu3(folder / name)
        return found[name]

    return unpack


@pytest.mark.parametrize("name", SAME)
def test_the_numbers_are_those_of_fmi_2(
    name: str, three: Callable[[str], Fmu3], unpacked: Callable[..., Fmu]
) -> None:
    """To the bit, after the same inputs and steps."""
    with Slave(unpacked(name)) as old, Slave3(three(name)) as new:
        old.initialize()
        new.initialize()
        assert new.outputs() == old.outputs()
        for k, values in enumerate(MOTIONS[name]):
            assert old.set(values) == new.set_components(values) == OK, new.log
            assert old.step(k * STEP, STEP) == new.step(k * STEP, STEP) == OK, new.log
            assert new.outputs() == old.outputs(), k
        assert new.time == pytest.approx(len(MOTIONS[name]) * STEP)


@pytest.mark.parametrize("name", kinds())
def test_every_kind_is_valid_and_simulated(name: str, tmp_path: Path) -> None:
    path = tmp_path / f"{name}.fmu"
    pack_fmu(kind_scene(name)[1], path, name=name, backend=OWN, fmi=3)
    assert validate_fmu(str(path)) == []
    description = read_model_description(str(path))
    types = ["CoSimulation"] + ["ModelExchange"] * (description.modelExchange is not None)
    for fmi_type in types:
        rows = simulate_fmu(
            str(path), fmi_type=fmi_type, stop_time=3e-3, step_size=1e-3, output_interval=1e-3
        )
        assert len(rows) == 4
        assert all(np.isfinite(rows[n]).all() for n in rows.dtype.names)


def test_vectors_are_arrays(three: Callable[[str], Fmu3]) -> None:
    fmu = three("rail")
    vectors = ("force", "left.moment", "wheelset.left.rotation", "track.right.offset")
    assert [fmu.size(name) for name in vectors] == [3, 3, 3, 3]
    assert fmu.size("left.patch[1].creepage") == 2
    # a vector of which a part is an input and a part is found is none
    mixed = three("prescribed_force").variables
    assert {"creepage[1]", "creepage[2]", "tangential_force[1]"} <= set(mixed)
    # without gaps between 1 and the last, no name twice, each reference once
    assert len(set(fmu.references.values())) == len(fmu.references)


def test_a_component_without_effect_is_0(three: Callable[[str], Fmu3]) -> None:
    with Slave3(three("rail")) as slave:
        slave.initialize()
        assert slave.set("wheelset.left.rotation", 1e-4, 0.0, 1e-4) == OK
        assert slave.set("wheelset.left.rotation", 1e-4, 1e-9, 1e-4) == ERROR
        assert "wheelset.left.rotation[2] is 1e-09, allowed 0" in slave.log[-1][2]
        assert slave.get("wheelset.left.rotation") == [1e-4, 0.0, 1e-4]
        # its derivative is 0, whatever the core says of it
        status, change = slave.derivative(
            "Directional", ["force"], ["wheelset.left.rotation"], [0.0, 1.0, 0.0]
        )
        assert (status, change) == (OK, [0.0, 0.0, 0.0])


def test_the_library_shows_fmi_3_only(three: Callable[[str], Fmu3]) -> None:
    path = three("patch").binary_path
    listed = subprocess.run(
        ["nm", "-D", "--defined-only", path], capture_output=True, text=True, check=True
    )
    symbols = listed.stdout.split()[2::3]
    assert len(symbols) == 75
    assert all(symbol.startswith("fmi3") for symbol in symbols)


@pytest.mark.parametrize("name", ["patch", "rail"])
def test_derivatives_forwards_and_backwards(name: str, three: Callable[[str], Fmu3]) -> None:
    """Adjoint ones are the same matrix from the other side; both agree with differences."""
    fmu = three(name)
    unknown = ["creep_force", "spin_moment"] if name == "patch" else ["force", "left.moment"]
    known = (
        ["creepage", "normal_force"]
        if name == "patch"
        else ["wheelset.left.offset", "wheelset.yaw"]
    )
    rows = sum(map(fmu.size, unknown))
    columns = sum(map(fmu.size, known))
    with Slave3(fmu) as slave:
        slave.initialize()
        forwards = np.empty((rows, columns))
        for k, unit in enumerate(np.eye(columns)):
            status, forwards[:, k] = slave.derivative("Directional", unknown, known, list(unit))
            assert status == OK, slave.log
        for k, unit in enumerate(np.eye(rows)):
            status, back = slave.derivative("Adjoint", unknown, known, list(unit))
            assert status == OK, slave.log
            assert back == list(forwards[k])
        assert np.abs(forwards).max() > 0
        # a product with a seed of all unknowns
        seed = np.linspace(-1, 2, rows)
        assert slave.derivative("Adjoint", unknown, known, list(seed))[1] == pytest.approx(
            forwards.T @ seed, rel=1e-12
        )
        assert slave.derivative("Adjoint", unknown, known, [0.0])[0] == ERROR
        assert slave.derivative("Directional", unknown, known, [np.nan] * columns)[0] == ERROR


def test_derivatives_are_those_of_fmi_2(
    three: Callable[[str], Fmu3], unpacked: Callable[..., Fmu]
) -> None:
    """Which are compared with differences in test_derivatives.py."""
    with Slave(unpacked("patch")) as old, Slave3(three("patch")) as new:
        old.initialize()
        new.initialize()
        names = ["creep_force[1]", "creep_force[2]"]
        seeds = {"creepage[1]": 1.0, "creepage[2]": 0.5, "friction.coefficient": 0.1}
        known = ["creepage", "friction.coefficient"]
        found = new.derivative("Directional", ["creep_force"], known, [1.0, 0.5, 0.1])
        assert found == old.derivative(names, seeds)


def test_a_discarded_step_never_was(three: Callable[[str], Fmu3]) -> None:
    """The FMU is in the state before the call: it steps on, to the same bits."""
    fmu = three("transient")
    with Slave3(fmu) as plain, Slave3(fmu) as slave:
        for one in (plain, slave):
            one.initialize()
            assert one.set("wheelset.yaw", 1e-3) == OK
            assert one.step(0.0, STEP) == OK
        before = slave.outputs()
        assert slave.set("wheelset.z", 0.9) == OK
        assert slave.step(STEP, STEP) == DISCARD
        assert slave.time == STEP
        assert slave.outputs() == before
        assert [line[0] for line in slave.log] == [DISCARD]
        for one in (plain, slave):
            assert one.set("wheelset.z", 2.1e-4) == OK
            assert one.step(STEP, STEP) == OK, one.log
        assert slave.outputs() == plain.outputs()


def test_states_are_saved_restored_and_carried_over(
    three: Callable[[str], Fmu3], tmp_path: Path
) -> None:
    fmu = three("transient_patch")
    with Slave3(fmu) as slave, Slave3(fmu) as fresh:
        slave.initialize()
        assert slave.step(0.0, STEP) == OK
        state = slave.save()
        content = slave.serialize(state)
        assert slave.step(STEP, STEP) == OK
        after = slave.outputs()
        assert slave.restore(state) == OK
        assert slave.get("time") == [STEP]
        assert slave.step(STEP, STEP) == OK
        assert slave.outputs() == after
        # on an instance that was merely made
        status, carried = fresh.deserialize(content)
        assert status == OK
        assert fresh.restore(carried) == OK
        assert fresh.step(STEP, STEP) == OK
        assert fresh.outputs() == after
        assert fresh.call("Reset") == OK
        assert fresh.initialize().step(0.0, STEP) == OK
        assert fresh.save()
        assert slave.deserialize(content[:-1])[0] == ERROR
        assert slave.deserialize(bytes([content[0] ^ 1]) + content[1:])[0] == ERROR
        assert slave.call("FreeFMUState", ct.byref(state)) == OK
        assert not state
    path = tmp_path / "state"
    path.write_bytes(content)
    run = subprocess.run(
        [sys.executable, Path(__file__).with_name("slave3.py"), fmu.folder, path],
        capture_output=True,
        text=True,
        check=True,
    )
    printed = {name: float.fromhex(value) for name, value in ast.literal_eval(run.stdout).items()}
    assert printed == after


def test_start_values_are_read_before_initialization(three: Callable[[str], Fmu3]) -> None:
    with Slave3(three("rail")) as slave:
        assert slave.get("wheelset.z") == [2e-4]
        reference = (Reference * 1)(slave.fmu.references["force"])
        values = (ct.c_double * 3)()
        assert slave.call("GetFloat64", reference, Size(1), values, Size(3)) == ERROR
        assert "is an output" in slave.log[-1][2]
        assert slave.enter(2.5) == OK
        assert slave.get("time") == [2.5]
        assert slave.get("force")[2] < 0


def test_types_of_the_standard(three: Callable[[str], Fmu3]) -> None:
    """Enumerations are Int64, counts Int32; others are refused by name."""
    fmu = three("patch")
    with Slave3(fmu) as slave:
        slave.initialize()
        assert slave.get("status") == [0]
        assert slave.get("iterations")[0] > 0
        assert slave.set("direction", -1) == OK
        assert slave.set("direction", 0) == ERROR
        reference = (Reference * 1)(fmu.references["status"])
        values = (ct.c_double * 4)()
        for kind in ("Float32", "Int8", "UInt8", "Int16", "UInt16", "UInt32", "UInt64"):
            for way in ("Get", "Set"):
                before = len(slave.log)
                assert slave.call(f"{way}{kind}", reference, Size(1), values, Size(1)) == ERROR
                assert f"there is no {kind} with value reference" in slave.log[before][2]
                assert slave.call(f"{way}{kind}", None, Size(0), None, Size(0)) == OK
        assert slave.call("GetInt32", reference, Size(1), values, Size(1)) == ERROR
        assert slave.call("GetFloat64", None, Size(1), values, Size(1)) == ERROR


@pytest.mark.parametrize("count", [0, 1, 2, 4])
def test_the_number_of_values_is_checked(count: int, three: Callable[[str], Fmu3]) -> None:
    with Slave3(three("rail")) as slave:
        slave.initialize()
        assert slave.set("wheelset.left.offset", 0.0, 0.0, 0.0, 0.0, count=count) == ERROR
        assert f"the number of values is {count}, but the variables have 3" in slave.log[-1][2]
        # a component alone is not a variable
        inner = (Reference * 1)(slave.fmu.references["wheelset.left.offset"] + 1)
        assert slave.call("SetFloat64", inner, Size(1), (ct.c_double * 1)(0.0), Size(1)) == ERROR


NEVER = {
    "EnterConfigurationMode": (),
    "ExitConfigurationMode": (),
    "EnterStepMode": (),
    "EvaluateDiscreteStates": (),
    "EnterEventMode": (),
    "EnterContinuousTimeMode": (),
    "SetTime": (ct.c_double(1.0),),
    "GetContinuousStates": (None, Size(0)),
    "GetNumberOfContinuousStates": (ct.byref(Size()),),
    "GetVariableDependencies": (Reference(1), None, None, None, None, Size(0)),
    "GetOutputDerivatives": (None, Size(0), None, None, Size(0)),
    "GetIntervalDecimal": (None, Size(0), None, None),
    "SetShiftDecimal": (None, Size(0), None),
    "ActivateModelPartition": (Reference(1), ct.c_double(0.0)),
    "EnterInitializationMode": (
        *(ct.c_bool(False), ct.c_double(0), ct.c_double(0), ct.c_bool(False), ct.c_double(0)),
    ),
    "ExitInitializationMode": (),
}


@pytest.mark.parametrize("name", NEVER)
def test_calls_that_a_slave_in_step_mode_does_not_allow(
    name: str, three: Callable[[str], Fmu3]
) -> None:
    """An error, one line in the log, and the slave goes on."""
    with Slave3(three("patch")) as slave:
        slave.initialize()
        assert slave.call(name, *NEVER[name]) == ERROR
        assert [(line[0], line[1]) for line in slave.log] == [(ERROR, "logStatusError")]
        assert slave.log[0][2].startswith(f"fmi3{name}: ")
        assert slave.step(0.0, STEP) == OK


def test_model_exchange_follows_its_inputs(three: Callable[[str], Fmu3]) -> None:
    with Slave3(three("patch"), exchange=True) as slave:
        slave.initialize()
        flags = [ct.c_bool(True) for _ in range(5)]
        when = ct.c_double()
        update = (*map(ct.byref, flags), ct.byref(when))
        assert slave.call("UpdateDiscreteStates", *update) == OK
        assert not any(flag.value for flag in flags)
        assert slave.call("EnterContinuousTimeMode") == OK
        before = slave.get("creep_force")
        assert slave.set("creepage", 5e-4, 1e-4) == OK
        assert slave.get("creep_force") != before
        assert slave.call("SetTime", ct.c_double(0.25)) == OK
        assert slave.get("time") == [0.25]
        assert slave.set("direction", -1) == ERROR  # discrete: in event mode
        assert slave.call("EnterEventMode") == OK
        assert slave.set("direction", -1) == OK
        count = Size(7)
        assert slave.call("GetNumberOfEventIndicators", ct.byref(count)) == OK
        assert count.value == 0
        assert slave.call("Terminate") == OK
        assert slave.step(0.0, STEP) == ERROR


def test_instances_that_cannot_be_made_say_why(three: Callable[[str], Fmu3]) -> None:
    fmu = three("transient")
    for made, why in (
        (Slave3(fmu, token="{wrong}"), "instantiationToken is"),
        (Slave3(fmu, location=None), "resourcePath is NULL"),
        (Slave3(fmu, location="/absent/"), "resourcePath is"),
        (Slave3(fmu, exchange=True), "this scene has a history"),
        (Slave3(fmu, event_mode=True), "eventModeUsed is fmi3True"),
    ):
        assert not made.component
        assert len(made.log) == 1
        assert why in made.log[0][2]
        assert made.log[0][2].startswith("fmi3Instantiate")
    quiet = Slave3(fmu, callbacks=False)
    assert quiet.component
    with quiet:
        quiet.initialize()


def test_only_errors_are_told_where_logging_is_off(three: Callable[[str], Fmu3]) -> None:
    with Slave3(three("rail"), logging=False) as slave:
        slave.initialize()
        assert slave.set("wheelset.z", 0.9) == OK
        assert slave.step(0.0, STEP) == DISCARD
        assert slave.log == []
        assert slave.set("wheelset.z", np.nan) == ERROR
        assert len(slave.log) == 1
