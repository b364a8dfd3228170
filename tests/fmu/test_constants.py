"""The scene as constants: in the description and by the calls, of both versions of FMI."""

from __future__ import annotations

import ctypes as ct
import zipfile
from collections.abc import Callable
from pathlib import Path

import pytest
from fmpy import read_model_description
from fmu_scenes import SCENES
from railpatch.case import load_scene
from railpatch.fmu import pack_fmu
from railpatch.fmu.scenes import kind_scene
from slave import ERROR, OK, Fmu, Reference, Size, Slave
from slave3 import Fmu3, Slave3

STARTS = {"Real": float, "Integer": int, "Boolean": lambda text: text == "true"}
TYPES = {"Real": ct.c_double, "Integer": ct.c_int, "Boolean": ct.c_int, "String": ct.c_char_p}


def test_they_say_what_the_case_says(unpacked: Callable[..., Fmu]) -> None:
    fmu = unpacked("roller")
    found = {n: v[0].attrib.get("start") for n, v in fmu.variables.items() if constant(v)}
    case = load_scene(SCENES["roller"]).case
    own = {key: name for key, name in case.profiles if name is not None}
    assert own
    assert {f"profiles.{key}": str(name) for key, name in own.items()}.items() <= found.items()
    assert float(found["track.gauge"]) == case.track.gauge
    assert float(found["track.roller_radius"]) == case.track.roller_radius
    assert float(found["wheelset.nominal_radius"]) == case.wheelset.nominal_radius
    assert float(found["material.shear_modulus[1]"]) == case.material.shear_modulus[0]
    assert found["method.normal"] == case.method.normal
    assert found["friction.law"] == "coulomb"
    assert found["track.kind"] == "roller"
    assert found["kind"] == case.kind
    # what moves is an input, or of no interest
    assert not {"wheelset.x", "wheelset.y", "friction.coefficient"} & found.keys()


def constant(variable: object) -> bool:
    """Whether it is one."""
    return variable.attrib.get("variability") == "constant"


@pytest.mark.parametrize("name", ["roller", "patch", "loaded"])
def test_the_calls_give_them_and_refuse_others(name: str, unpacked: Callable[..., Fmu]) -> None:
    fmu = unpacked(name)
    with Slave(fmu) as slave:
        slave.call("EnterInitializationMode")
        count = 0
        for variable in fmu.variables.values():
            if not constant(variable):
                continue
            base, start = variable[0].tag, variable[0].attrib["start"]
            value = TYPES[base]()
            reference = ct.byref(Reference(int(variable.attrib["valueReference"])))
            assert slave.call(f"Get{base}", reference, Size(1), ct.byref(value)) == OK
            expected = start.encode() if base == "String" else STARTS[base](start)
            assert value.value == expected
            assert slave.call(f"Set{base}", reference, Size(1), ct.byref(value)) == ERROR
            assert "is a constant" in slave.log[-1][2]
            count += 1
        assert count > 10


def test_fmi3_has_the_same(tmp_path: Path) -> None:
    """Lists of numbers are arrays there."""
    packed = {}
    for version in (2, 3):
        _, scene = kind_scene("wheelset_temperature")
        path = pack_fmu(scene, tmp_path / f"v{version}.fmu", fmi=version)
        packed[version] = read_model_description(str(path)).modelVariables
    texts = {v.name: v.start for v in packed[2] if v.variability == "constant"}
    for v in packed[3]:
        if v.variability != "constant":
            continue
        if not v.dimensions:
            assert texts[v.name] == v.start
            continue
        parts = v.start.split()
        assert parts == [texts[f"{v.name}[{k}]"] for k in range(1, len(parts) + 1)]
    folder = tmp_path / "v3"
    zipfile.ZipFile(tmp_path / "v3.fmu").extractall(folder)
    fmu = Fmu3(folder)
    with Slave3(fmu) as slave:
        assert slave.get("material.shear_modulus") == [82e9, 82e9]
        assert slave.get("profiles.wheel") == [b"S1002"]
        assert slave.get("temperature.exchange") == [True]
        assert slave.get("wheelset.nominal_radius") == [0.46]
        assert slave.set("track.gauge", 1.0) == ERROR
        assert slave.log[-1][2] == "fmi3SetFloat64: track.gauge is a constant"
