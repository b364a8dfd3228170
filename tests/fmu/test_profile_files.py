"""Profiles that are read at run time: prepared files, by fixed parameters that are strings."""

from __future__ import annotations

import ctypes as ct
import zipfile
import zlib
from pathlib import Path
from typing import Any

import pytest
from case_samples import PATCH, with_values
from click.testing import CliRunner
from fmpy import simulate_fmu
from fmpy.validation import validate_fmu
from fmu_scenes import OWN, RAIL, SCENES, STEP
from railpatch.case import load_scene
from railpatch.errors import CaseError
from railpatch.fmu import pack_fmu
from railpatch.profiles.pairing.command import profile as command
from slave import ERROR, OK, Fmu, Reference, Size, Slave
from slave3 import Fmu3, Slave3

OTHER = {"profiles__wheel": "cone@1:20", "profiles__rail": "UIC60@1:20"}


def packed(folder: Path, case: dict[str, Any], **options: Any) -> Fmu | Fmu3:
    """The FMU of a case, valid, unpacked and loaded."""
    folder.mkdir(exist_ok=True)
    path = folder / "a.fmu"
    pack_fmu(load_scene(case), path, backend=OWN, **options)
    assert validate_fmu(str(path)) == []
    zipfile.ZipFile(path).extractall(path.with_suffix(""))
    return (Fmu3 if options.get("fmi") == 3 else Fmu)(path.with_suffix(""))


def prepared(folder: Path, source: str, role: str, name: str = "a") -> Path:
    """A prepared profile, made by the command."""
    path = folder / f"{name}_{role}.profile"
    ran = CliRunner().invoke(command, [source, "-o", str(path), "--role", role])
    assert ran.exit_code == 0, ran.output
    return path


def give(slave: Slave, name: str, path: object) -> int:
    """fmi2SetString."""
    reference = (Reference * 1)(slave.fmu.references[name])
    return slave.call("SetString", reference, Size(1), (ct.c_char_p * 1)(str(path).encode()))


def told(slave: Slave, name: str) -> str:
    """fmi2GetString."""
    value = (ct.c_char_p * 1)()
    reference = (Reference * 1)(slave.fmu.references[name])
    assert slave.call("GetString", reference, Size(1), value) == OK
    return value[0].decode()


def names_of(body: str) -> list[str]:
    """The parameters of both sides."""
    return [f"profiles.{body}_{side}_file" for side in ("left", "right")]


def test_files_give_the_bits_of_a_scene_with_these_profiles(tmp_path: Path) -> None:
    fmu = packed(tmp_path, RAIL, profile_files=True)
    plain = packed(tmp_path / "plain", RAIL)
    other = packed(tmp_path / "other", with_values(RAIL, **OTHER))
    wheel = prepared(tmp_path, OTHER["profiles__wheel"], "wheel")
    rail = prepared(tmp_path, OTHER["profiles__rail"], "rail", "mit Leerzeichen ü")
    outputs = plain.names("output")
    with Slave(fmu) as slave, Slave(plain) as usual, Slave(other) as wanted:
        for one in (slave, usual):
            one.initialize()
        assert slave.get(*outputs) == usual.get(*outputs)
        assert slave.call("Reset") == OK
        for name in names_of("wheel"):
            assert give(slave, name, wheel) == OK
        for name in names_of("rail"):
            assert give(slave, name, "file://" + str(rail)) == OK, slave.log
        for one in (slave, wanted):
            one.initialize()
            assert one.step(0.0, STEP) == OK
        assert told(slave, names_of("wheel")[0]) == str(wheel)
        assert slave.get(*outputs) == wanted.get(*outputs)
        # they are fixed, and gone after a reset
        assert give(slave, names_of("wheel")[0], "") == ERROR
        assert "is fixed" in slave.log[-1][2]
        assert slave.call("Reset") == OK
        assert usual.call("Reset") == OK
        for one in (slave, usual):
            one.initialize()
        assert told(slave, names_of("wheel")[0]) == ""
        assert slave.get(*outputs) == usual.get(*outputs)


def test_one_side_alone(tmp_path: Path) -> None:
    fmu = packed(tmp_path, RAIL, profile_files=True)
    other = packed(tmp_path / "other", with_values(RAIL, profiles__wheel="cone@1:20"))
    wheel = prepared(tmp_path, "cone@1:20", "wheel")
    with Slave(fmu) as slave, Slave(fmu) as usual, Slave(other) as wanted:
        assert give(slave, "profiles.wheel_left_file", wheel) == OK
        for one in (slave, usual, wanted):
            one.initialize()
        assert slave.get("left.force[2]") == wanted.get("left.force[2]")
        assert slave.get("right.force[2]") == usual.get("right.force[2]")


def test_a_state_carries_them(tmp_path: Path) -> None:
    """Into an instance that was merely made, also where the file is gone."""
    fmu = packed(tmp_path, RAIL, profile_files=True)
    wheel = prepared(tmp_path, "cone@1:20", "wheel")
    with Slave(fmu) as slave:
        for name in names_of("wheel"):
            assert give(slave, name, wheel) == OK
        slave.initialize()
        assert slave.step(0.0, STEP) == OK
        state = slave.save()
        size = Size()
        assert slave.call("SerializedFMUstateSize", state, ct.byref(size)) == OK
        blob = (ct.c_char * size.value)()
        assert slave.call("SerializeFMUstate", state, blob, size) == OK
        assert slave.step(STEP, STEP) == OK
        expected = slave.outputs()
    wheel.unlink()
    with Slave(fmu) as slave:
        state = ct.c_void_p()
        assert slave.call("DeSerializeFMUstate", blob, size, ct.byref(state)) == OK, slave.log
        assert slave.restore(state) == OK, slave.log
        assert told(slave, "profiles.wheel_left_file") == str(wheel)
        assert slave.step(STEP, STEP) == OK, slave.log
        assert slave.outputs() == expected


def ended(lines: list[str]) -> str:
    """A file of these lines, with its checksum."""
    text = "".join(lines)
    return f"{text}end {zlib.crc32(text.encode('ascii')):08x}\n"


def test_bad_files_are_refused_and_change_nothing(tmp_path: Path) -> None:
    fmu = packed(tmp_path, RAIL, profile_files=True)
    good = prepared(tmp_path, "cone@1:20", "wheel")
    text = good.read_text()
    lines = text.splitlines(True)
    count = int(lines[4].split()[1])
    bad = {
        "absent": (None, "cannot be read, tried"),
        "other": ("y,z\n0,0\n", "it is no prepared profile"),
        "altered": (text.replace("0.0", "0.1", 1), "its checksum is wrong"),
        "cut": (text[: len(text) // 2], "it has no end: it was cut off"),
        "cut at its end": (text[:-3], "it has no end: it was cut off"),
        "with a line of its own": (
            text.replace("\nend ", "\nown 1\nend "),
            "line 9 is not understood: begins with 'own', expected body, name, arc_length",
        ),
        "cut in its y": ("".join(lines[:4]) + lines[4][:60], f"'y' announces {count} values and"),
        "with its y cut": (
            "".join([*lines[:4], " ".join(lines[4].split()[:-3]) + "\n", *lines[5:]]),
            f"line 5 is not understood: 'y' announces {count} values and has {count - 3}",
        ),
        "with a word": (
            text.replace("\nz ", "\nz x"),
            "line 6 is not understood: 'z' says no count, expected a whole number",
        ),
        "with a comma": (
            "".join([*lines[:4], f"y {count} 0,1 " + lines[4].split(" ", 3)[3], *lines[5:]]),
            "line 5 is not understood: 'y' has '0,1' as value 1, expected a finite number",
        ),
        "of nobody": (
            text.replace("body wheel", "body tyre"),
            "line 2 is not understood: 'body' is 'tyre', expected wheel or rail",
        ),
        "without its dz": (ended(lines[:7]), "its array 'dz' is missing"),
        "with a short dz": (
            ended([*lines[:7], "dz 2 0.0 0.0\n"]),
            f"its arrays differ in length: 'arc_length' has {count} values, 'dz' has 2",
        ),
        "short": ("".join(text.splitlines(True)[:-1]), "it has no end"),
        "empty": ("", "it has no end"),
    }
    with Slave(fmu) as slave, Slave(fmu) as usual:
        for name, (content, why) in bad.items():
            path = tmp_path / f"{name}.profile"
            if content is not None:
                path.write_text(content)
            assert give(slave, "profiles.wheel_left_file", path) == ERROR, name
            assert why in slave.log[-1][2], slave.log[-1]
            assert str(path) in slave.log[-1][2] or content is None
        assert give(slave, "profiles.rail_left_file", good) == ERROR
        assert "it is the profile of a wheel" in slave.log[-1][2]
        for one in (slave, usual):
            one.initialize()
        assert slave.outputs() == usual.outputs()


def test_fmi3_and_fmpy_take_them(tmp_path: Path) -> None:
    wheel = prepared(tmp_path, "cone@1:20", "wheel")
    other = packed(tmp_path / "other", with_values(RAIL, profiles__wheel="cone@1:20"))
    with Slave(other) as wanted:
        wanted.initialize()
        force = wanted.get("left.force[1]", "left.force[2]", "left.force[3]")
    fmu = packed(tmp_path, RAIL, profile_files=True, fmi=3)
    with Slave3(fmu) as slave:
        for name in names_of("wheel"):
            assert slave.set(name, str(wheel).encode()) == OK, slave.log
        slave.initialize()
        assert slave.get("profiles.wheel_left_file") == [str(wheel).encode()]
        assert slave.get("left.force") == force
    packed(tmp_path / "two", RAIL, profile_files=True)
    found = simulate_fmu(
        str(tmp_path / "two" / "a.fmu"),
        start_values={name: str(wheel) for name in names_of("wheel")},
        output=["left.force[2]"],
        stop_time=2 * STEP,
        step_size=STEP,
        output_interval=STEP,
    )
    assert found["left.force[2]"][0] == force[1]


def test_what_has_no_such_files(tmp_path: Path) -> None:
    with pytest.raises(CaseError, match="--profile-files: given, allowed with wheels only"):
        pack_fmu(load_scene(PATCH), tmp_path / "a.fmu", backend=OWN, profile_files=True)
    fmu = packed(tmp_path, SCENES["sections"], profile_files=True)
    assert set(names_of("wheel")) & fmu.references.keys()
    assert not set(names_of("rail")) & fmu.references.keys()
