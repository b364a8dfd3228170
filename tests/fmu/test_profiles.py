"""Profiles packed beside the case's own: a fixed parameter chooses, and the numbers are its own."""

from __future__ import annotations

import math
import os
import re
import resource
import shutil
import subprocess
import sys
import zipfile
import zlib
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
import railpatch
from case_samples import with_values
from click.testing import CliRunner
from fmpy import read_model_description, simulate_fmu
from fmpy.validation import validate_fmu
from fmu_scenes import MOTIONS, OWN, SCENES, STEP, run
from railpatch.case import load_scene
from railpatch.errors import CaseError
from railpatch.fmu import pack_fmu
from railpatch.fmu.command import fmu as command
from slave import ERROR, OK, Fmu, Slave
from test_model_exchange import CONTINUOUS, EVENT, brought_to
from test_numbers import scale_of

WHEELS = ["S1002", "cone@1:20"]
RAILS = ["UIC60@1:40", "UIC60@1:20", "60E1@1:40"]
FURTHER = {"wheel_profiles": WHEELS[1:], "rail_profiles": RAILS[1:]}
OTHER = {"profiles.wheel": 2, "profiles.rail": 3}
# z or the load given, one wheel alone, a history, rollers
NAMES = ["rail", "loaded", "left_wheel", "transient", "roller"]


@dataclass
class Pack:
    """FMUs of scenes, packed and unpacked once."""

    folder: Path
    found: dict[Any, Fmu]

    def path(self, name: str, **options: Any) -> Path:
        """With further profiles, unless given otherwise."""
        path = self.folder / f"f{len(list(self.folder.glob('*.fmu')))}.fmu"
        return pack_fmu(load_scene(SCENES[name]), path, backend=OWN, **(options or FURTHER))

    def choice(self, name: str) -> Fmu:
        """The FMU of a scene with further profiles."""
        return self._fmu((name,), lambda: self.path(name))

    def alone(self, name: str, wheel: int, rail: int) -> Fmu:
        """That of a scene with these profiles, and no others."""
        profiles = {"wheel": WHEELS[wheel - 1], "rail": RAILS[rail - 1]}
        scene = load_scene(with_values(SCENES[name], profiles=profiles))
        path = self.folder / f"{name}_{wheel}_{rail}_alone.fmu"
        return self._fmu((name, wheel, rail), lambda: pack_fmu(scene, path, backend=OWN))

    def _fmu(self, key: Any, pack: Callable[[], Path]) -> Fmu:
        if key not in self.found:
            path = pack()
            zipfile.ZipFile(path).extractall(path.with_suffix(""))
            self.found[key] = Fmu(path.with_suffix(""))
        return self.found[key]


@pytest.fixture(scope="module")
def pack(tmp_path_factory: pytest.TempPathFactory) -> Pack:
    """One folder for all."""
    return Pack(tmp_path_factory.mktemp("profiles"), {})


def started(fmu: Fmu, values: dict[str, float], *, exchange: bool = False) -> Slave:
    """An initialized instance."""
    slave = Slave(fmu, exchange=exchange)
    assert slave.set(values) == OK, slave.log
    return slave.initialize()


def course(fmu: Fmu, name: str, values: dict[str, float]) -> list[dict[str, float]]:
    """Outputs at the start and after steps."""
    with started(fmu, values) as slave:
        return [slave.outputs(), *(run(slave, [m], k * STEP) for k, m in enumerate(MOTIONS[name]))]


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize(("wheel", "rail"), [(1, 1), (2, 1), (1, 2), (2, 3)])
def test_a_choice_gives_the_bits_of_that_profile_alone(
    name: str, wheel: int, rail: int, pack: Pack
) -> None:
    values = {"profiles.wheel": wheel, "profiles.rail": rail}
    found = course(pack.choice(name), name, values)
    assert found == course(pack.alone(name, wheel, rail), name, {})
    if (wheel, rail) != (1, 1):
        assert found != course(pack.choice(name), name, {})


@pytest.mark.parametrize(("wheel", "rail"), [(1, 1), (2, 1), (2, 3)])
def test_a_choice_gives_the_numbers_of_python(wheel: int, rail: int, pack: Pack) -> None:
    profiles = {"wheel": WHEELS[wheel - 1], "rail": RAILS[rail - 1]}
    result = railpatch.Contact(with_values(SCENES["rail"], profiles=profiles)).step()
    values = {"profiles.wheel": wheel, "profiles.rail": rail}
    with started(pack.choice("rail"), values) as slave:
        outputs = slave.outputs()
    assert outputs["status"] == 0
    for i in range(3):
        for side in ("left", "right"):
            bound = 1e-12 * scale_of(f"{side}.force[{i + 1}]", outputs)
            assert abs(outputs[f"{side}.force[{i + 1}]"] - result[side]["force"][i]) <= bound
            assert outputs[f"{side}.rolling_radius"] == result[side]["rolling_radius"]


def test_outputs_follow_the_choice_in_initialization_mode(pack: Pack) -> None:
    fmu = pack.choice("rail")
    expected = [course(fmu, "rail", values)[0] for values in ({}, OTHER)]
    assert expected[0] != expected[1]
    with Slave(fmu) as slave:
        assert slave.setup() == OK
        assert slave.call("EnterInitializationMode") == OK
        assert slave.get("profiles.wheel", "profiles.rail") == [1, 1]
        assert slave.outputs() == expected[0]
        assert slave.set(OTHER) == OK
        assert slave.get("profiles.wheel", "profiles.rail") == [2, 3]
        assert slave.outputs() == expected[1]
        assert slave.set({"profiles.wheel": 1, "profiles.rail": 1}) == OK
        assert slave.outputs() == expected[0]
        _, before = slave.derivative(["force[3]"], {"wheelset.z": 1e-5})
        assert slave.set(OTHER) == OK
        _, after = slave.derivative(["force[3]"], {"wheelset.z": 1e-5})
        assert before != after
        assert slave.call("ExitInitializationMode") == OK
        assert slave.outputs() == expected[1]


@pytest.mark.parametrize("exchange", [False, True])
def test_derivatives_are_those_of_the_profile_alone(exchange: bool, pack: Pack) -> None:
    seeds = {"wheelset.y": 1e-5, "wheelset.yaw": 1e-5}
    found = []
    for fmu, values in ((pack.choice("rail"), OTHER), (pack.alone("rail", 2, 3), {})):
        with started(fmu, values, exchange=exchange) as slave:
            found.append(slave.derivative(["force[2]", "moment[3]"], seeds))
            assert found[-1][0] == OK, slave.log
    assert found[0] == found[1]


def test_reset_goes_back_to_the_cases_own(pack: Pack) -> None:
    fmu = pack.choice("rail")
    expected = course(fmu, "rail", {})
    with started(fmu, OTHER) as slave:
        run(slave, MOTIONS["rail"], 0)
        assert slave.call("Reset") == OK
        slave.initialize()
        assert slave.get("profiles.wheel", "profiles.rail") == [1, 1]
        assert [
            slave.outputs(),
            *(run(slave, [m], k * STEP) for k, m in enumerate(MOTIONS["rail"])),
        ] == expected


@pytest.mark.parametrize("name", NAMES)
def test_a_state_brings_its_choice_along(name: str, pack: Pack) -> None:
    """To one that is merely instantiated, one with another choice, and back on the same one."""
    fmu, rest = pack.choice(name), MOTIONS[name][:1] * 2
    with started(fmu, OTHER) as slave:
        before = run(slave, MOTIONS[name][:1], 0)
        state = slave.save()
        content = slave.serialize(state)
        expected = run(slave, rest, STEP)
        assert slave.restore(state) == OK
        assert slave.outputs() == before
        assert run(slave, rest, STEP) == expected
        # a reset is an instance with another choice
        assert slave.call("Reset") == OK
        slave.initialize()
        assert slave.restore(state) == OK, slave.log
        assert run(slave, rest, STEP) == expected
    for values in (None, {}, {"profiles.rail": 2}):
        with Slave(fmu) if values is None else started(fmu, values) as other:
            status, handle = other.deserialize(content)
            assert status == OK, other.log
            assert other.restore(handle) == OK, other.log
            assert other.get("profiles.wheel", "profiles.rail") == [2, 3]
            assert other.outputs() == before
            assert run(other, rest, STEP) == expected
            assert other.serialize(handle) == content


def test_a_state_before_initialization_has_its_choice_too(pack: Pack) -> None:
    fmu = pack.choice("rail")
    expected = course(fmu, "rail", OTHER)
    with Slave(fmu) as slave:
        own = slave.save()
        assert slave.set(OTHER) == OK
        content = slave.serialize(slave.save())
        assert slave.restore(own) == OK
        slave.initialize()
        assert slave.get("profiles.wheel", "profiles.rail") == [1, 1]
    with Slave(fmu) as slave:
        _, handle = slave.deserialize(content)
        assert slave.restore(handle) == OK, slave.log
        slave.initialize()
        assert slave.outputs() == expected[0]
        assert run(slave, MOTIONS["rail"], 0) == expected[-1]


def test_model_exchange(pack: Pack) -> None:
    fmu, moved = pack.choice("rail"), {"wheelset.y": 1e-4}
    with started(pack.alone("rail", 2, 3), {}, exchange=True) as model:
        assert model.set(moved) == OK
        expected = model.outputs()
    with started(fmu, OTHER, exchange=True) as model:
        assert model.set(moved) == OK
        assert model.outputs() == expected
        content = model.serialize(model.save())
        assert model.set({"profiles.rail": 1}) == ERROR
        assert "profiles.rail is fixed" in model.log[-1][2]
    for state in (None, EVENT, CONTINUOUS):
        with Slave(fmu, exchange=True) if state is None else brought_to(fmu, state) as model:
            _, handle = model.deserialize(content)
            assert model.restore(handle) == OK, model.log
            assert model.outputs() == expected
            assert model.get("profiles.wheel", "profiles.rail") == [2, 3]


def test_other_numbers_are_refused(pack: Pack) -> None:
    with Slave(pack.choice("rail")) as slave:
        for name, most in (("profiles.wheel", 2), ("profiles.rail", 3)):
            for value in (0, most + 1, -1, 2**31 - 1):
                assert slave.set({name: value}) == ERROR
                text = slave.log[-1][2]
                assert re.search(rf"{name} is {value:.10g}\D.*allowed 1 \.\.\. {most}$", text), text
        slave.initialize()
        assert slave.get("profiles.wheel", "profiles.rail") == [1, 1]


def test_fixed_after_initialization(pack: Pack) -> None:
    with started(pack.choice("rail"), OTHER) as slave:
        expected = slave.outputs()
        for value in (1, 2):
            assert slave.set({"profiles.wheel": value}) == ERROR
            text = slave.log[-1][2]
            assert "profiles.wheel is fixed" in text
            assert "initialization mode" in text
        assert slave.get("profiles.wheel") == [2]
        assert slave.outputs() == expected


def test_the_description_lists_the_profiles(pack: Pack) -> None:
    path = pack.path("rail")
    assert validate_fmu(str(path)) == []
    description = read_model_description(str(path))
    for body, items in (("wheel", WHEELS), ("rail", RAILS)):
        [variable] = [v for v in description.modelVariables if v.name == f"profiles.{body}"]
        assert (variable.causality, variable.variability) == ("parameter", "fixed")
        assert (variable.type, variable.start) == ("Enumeration", "1")
        assert (variable.min, variable.max) == ("1", str(len(items)))
        assert [i.name for i in variable.declaredType.items] == items
        assert [int(i.value) for i in variable.declaredType.items] == [1, 2, 3][: len(items)]
    page = zipfile.ZipFile(path).read("documentation/index.html").decode()
    assert "1 UIC60@1:40, 2 UIC60@1:20, 3 60E1@1:40" in page


def test_only_what_is_given_is_there(pack: Pack) -> None:
    """The other variables are those of the FMU without a choice."""

    def names(**options: Any) -> list[tuple[str, int]]:
        path = pack.path("rail", **options)
        variables = read_model_description(str(path)).modelVariables
        varying = [v for v in variables if v.variability != "constant"]
        return [(v.name, v.valueReference) for v in varying]

    plain = names(averages=False)
    assert not [name for name, _ in plain if name.startswith("profiles")]
    rail = names(rail_profiles=RAILS[1:])
    assert [v for v in rail if v not in plain] == [("profiles.rail", 40)]
    assert [v for v in rail if v in plain] == plain


@pytest.mark.parametrize("fmi_type", ["CoSimulation", "ModelExchange"])
def test_fmpy_simulates_a_choice(fmi_type: str, pack: Pack) -> None:
    path = str(pack.path("rail"))
    settings = {"stop_time": 2e-3, "output_interval": 1e-3, "output": ["force[3]"]}
    found = [
        simulate_fmu(path, fmi_type=fmi_type, start_values=values, **settings)["force[3]"][-1]
        for values in ({}, {"profiles.wheel": 2}, {"profiles.rail": 2})
    ]
    assert len(set(found)) == 3
    with started(pack.alone("rail", 2, 1), {}) as slave:
        assert slave.step(0, STEP) == OK
        assert found[1] == pytest.approx(slave.get("force[3]")[0], rel=1e-4)


def wheel_file(path: Path) -> str:
    """A conical wheel as points in mm, with a round edge so that it is no line, and a flange."""
    points = (
        f"{y} {-y / 30 + 1e-6 * y * y + 25 * math.exp(-(((y + 54) / 6) ** 2))}\n"
        for y in range(-65, 66)
    )
    path.write_text("".join(points))
    return str(path)


def test_the_command_takes_names_and_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A file's place is that of the call, not the case's folder; its name is the item's."""
    wheel_file(tmp_path / "worn.txt")
    monkeypatch.chdir(tmp_path)
    (tmp_path / "case").mkdir()
    lines = [f'{k} = "{v}"' for k, v in SCENES["rail"]["profiles"].items()]
    case = tmp_path / "case" / "case.toml"
    case.write_text(
        'kind = "wheelset"\ngrid.element_size = [5e-4, 5e-4]\nfriction.coefficient = 0.3\n'
        "[wheelset]\nz = 2e-4\nspeed = 2.0\npitch_rate = -4.4\nnominal_radius = 0.46\n"
        "flange_back_distance = 1.36\nflange_back_position = -0.07\n"
        '[track]\nkind = "rail"\ngauge = 1.435\ngauge_height = 0.014\n[profiles]\n'
        + "\n".join(lines)
    )
    given = ["--wheel-profile", "worn.txt", "--wheel-profile", "cone@1:20"]
    ran = CliRunner().invoke(command, [str(case), "-o", "a.fmu", *given])
    assert ran.exit_code == 0, ran.output
    description = read_model_description("a.fmu")
    varying = [v for v in description.modelVariables if v.variability != "constant"]
    [variable] = [v for v in varying if v.name.startswith("profiles")]
    assert [i.name for i in variable.declaredType.items] == ["S1002", "worn.txt", "cone@1:20"]
    # nothing is written over a profile that is read
    run_over = CliRunner().invoke(command, [str(case), "-o", "worn.txt", *given])
    assert run_over.exit_code != 0
    assert (tmp_path / "worn.txt").read_text().startswith("-65")


SECTIONS = {
    f"track__{side}__sections": [{"position": 0.0, "profile": "UIC60@1:40"}]
    for side in ("left", "right")
}


@pytest.mark.parametrize(
    ("case", "options", "words"),
    [
        (SCENES["patch"], {"wheel_profiles": ["S1002"]}, "allowed with wheels only"),
        (
            with_values(
                SCENES["rail"],
                profiles={"wheel_left": "S1002", "wheel_right": "cone@1:20", "rail": "UIC60@1:40"},
            ),
            {"wheel_profiles": ["cone@1:40"]},
            "left and right wheel have the same profile, here 'S1002' and 'cone@1:20'",
        ),
        (
            with_values(SCENES["rail"], profiles={"wheel": "S1002"}, **SECTIONS),
            {"rail_profiles": ["UIC60@1:20"]},
            "no 'sections'",
        ),
        (SCENES["rail"], {"rail_profiles": ["UIC60@1:40"]}, "'UIC60@1:40' is there twice"),
        (SCENES["rail"], {"wheel_profiles": ["missing.txt"]}, "missing.txt: file not found"),
        (SCENES["rail"], {"wheel_profiles": ["UIC60"]}, "is a rail, not a wheel"),
        (
            SCENES["rail"],
            {"rail_profiles": ["UIC60@1:20"], "wheel_profiles": ["missing.txt"]},
            "a with profiles.wheel = 'missing.txt', profiles.rail = 'UIC60@1:40': ",
        ),
        (
            SCENES["rail"],
            {"rail_profiles": ["UIC60@1:20", "cylinder"]},
            "profiles.rail = 'cylinder': the start values cannot be solved: out_of_range",
        ),
    ],
    ids=["patch", "sides", "sections", "twice", "file", "role", "label", "unsolvable"],
)
def test_what_cannot_be_packed(
    case: dict[str, Any], options: dict[str, Any], words: str, tmp_path: Path
) -> None:
    with pytest.raises(CaseError) as error:
        pack_fmu(load_scene(case), tmp_path / "a.fmu", name="a", backend=OWN, **options)
    assert words in str(error.value)
    assert list(tmp_path.iterdir()) == []


def test_sides_with_equal_profiles_are_one_choice(pack: Pack) -> None:
    sides = {f"wheel_{side}": "S1002" for side in ("left", "right")}
    scene = load_scene(with_values(SCENES["rail"], profiles={**sides, "rail": "UIC60@1:40"}))
    path = pack_fmu(scene, pack.folder / "sides.fmu", backend=OWN, **FURTHER)
    zipfile.ZipFile(path).extractall(path.with_suffix(""))
    found = course(Fmu(path.with_suffix("")), "rail", OTHER)
    assert found == course(pack.alone("rail", 2, 3), "rail", {})


def signed(body: bytes) -> bytes:
    """With its checksum."""
    return body + b"end %08x\n" % zlib.crc32(body)


def test_a_damaged_choice_is_refused(pack: Pack, tmp_path: Path) -> None:
    fmu = pack.choice("rail")
    text = (fmu.folder / "resources" / "scene.txt").read_bytes()
    body = text[: text.rindex(b"end ")]
    line = next(part for part in body.split(b"\n") if part.startswith(b"choice rail 2 y "))
    damaged = {
        "number": body.replace(b"choice rail 2 ", b"choice rail 1 "),
        "gap": body.replace(b"choice rail 2 ", b"choice rail 7 "),
        "body": body.replace(b"choice rail 2 ", b"choice axle 2 "),
        "array": body.replace(b"choice rail 2 y ", b"choice rail 2 x "),
        "short": body.replace(line, b"choice rail 2 y 1 0.0"),
        "missing": body.replace(line + b"\n", b""),
    }
    for name, content in damaged.items():
        assert content != body, name
        (tmp_path / "scene.txt").write_bytes(signed(content))
        with Slave(fmu, location=f"file://{tmp_path}") as slave:
            assert slave.component is None, name
            assert "scene.txt of the resources cannot be used" in slave.log[0][2]
    shutil.copy(fmu.folder / "resources" / "scene.txt", tmp_path)
    with Slave(fmu, location=f"file://{tmp_path}") as slave:
        assert slave.component, slave.log


def test_without_memory_the_choice_is_an_error(pack: Pack) -> None:
    """A process of its own, whose memory is limited to what it has before the contact is made."""
    program = Path(__file__)
    done = subprocess.run(
        [sys.executable, program, pack.choice("rail").folder],
        capture_output=True,
        text=True,
        check=False,
        env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)},
    )
    assert done.returncode == 0, done.stderr
    text, status, after = done.stdout.splitlines()
    assert text.startswith("fmi2ExitInitializationMode: ")
    assert "out of memory" in text
    assert [int(status), int(after)] == [ERROR, 0]


def limited(folder: Path) -> None:
    """Chooses, initializes without memory, and resets with it."""
    with Slave(Fmu(folder)) as slave:
        assert slave.set(OTHER) == OK
        assert slave.call("EnterInitializationMode") == OK
        pages = int(Path("/proc/self/statm").read_text().split()[0])
        _, most = resource.getrlimit(resource.RLIMIT_AS)
        resource.setrlimit(resource.RLIMIT_AS, (pages * resource.getpagesize(), most))
        status = slave.call("ExitInitializationMode")
        resource.setrlimit(resource.RLIMIT_AS, (most, most))
        print(slave.log[0][2], status, sep="\n")
        assert slave.call("Reset") == OK
        slave.initialize()
        print(slave.get("status")[0])


if __name__ == "__main__":
    limited(Path(sys.argv[1]))
