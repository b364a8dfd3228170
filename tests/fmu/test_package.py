"""What is in an FMU: the archive, the description, the library's symbols, the documentation."""

from __future__ import annotations

import re
import subprocess
import sys
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import fmpy
import pytest
from case_samples import PATCH, with_values
from fmpy import read_model_description, simulate_fmu
from fmpy.validation import validate_fmu
from fmu_scenes import OWN, RAIL, SCENES
from lxml import etree
from railpatch.case import load_scene
from railpatch.errors import CaseError
from railpatch.fmu import pack_fmu
from slave import Fmu

BACKENDS = ("eigen", "fftw")
SYSTEM_LIBRARIES = {"libc.so.6", "libm.so.6", "libpthread.so.0", "libdl.so.2"}


def tool(*command: str | Path) -> str:
    """What a program prints."""
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout


@pytest.mark.parametrize("name", SCENES)
def test_fmpy_finds_nothing_and_simulates(name: str, packed: Callable[..., Path]) -> None:
    path = packed(name, "eigen")
    assert validate_fmu(str(path)) == []
    rows = simulate_fmu(str(path), stop_time=0.01, step_size=1e-3, output_interval=1e-3)
    assert len(rows) == 11


@pytest.mark.parametrize("name", SCENES)
def test_every_real_says_all(name: str, unpacked: Callable[..., Fmu]) -> None:
    fmu = unpacked(name)
    types = {t.attrib["name"] for t in fmu.root.iter("SimpleType")}
    units = {u.attrib["name"]: u for u in fmu.root.iter("Unit")}
    assert "time" not in fmu.variables
    for variable in fmu.variables.values():
        value = variable[0]
        assert variable.attrib["description"]
        if value.tag in ("String", "Boolean"):
            continue
        assert value.attrib["declaredType"] in types
        if value.tag == "Real":
            keys = {"quantity", "unit", "displayUnit", "nominal"}
            if variable.attrib["causality"] != "local":
                keys |= {"min", "max"}
            assert keys <= value.attrib.keys()
            shown = {d.attrib["name"] for d in units[value.attrib["unit"]].iter("DisplayUnit")}
            assert value.attrib["displayUnit"] in shown
        if variable.attrib["causality"] in ("input", "parameter"):
            start = float(value.attrib["start"])
            assert float(value.attrib["min"]) <= start <= float(value.attrib["max"])


def test_names_follow_the_interface(unpacked: Callable[..., Fmu]) -> None:
    expected = {
        "roller": "wheelset.y wheelset.z wheelset.pitch_rate track.roller_pitch_rate force[1] "
        "wheelset.left.offset[3] left.force[1] left.moment[3] left.patch[1].normal_force "
        "right.patch[6].position[1] left.patch[1].friction_power friction.coefficient z status",
        "loaded": "wheelset.vertical_force wheelset.roll z",
        "left_wheel": "force[3] patch[1].creep_force[2] wheelset.left.offset[1] patch_count",
        "patch": "normal_force creepage[1] creepage[2] spin_creepage rolling_speed direction "
        "creep_force[1] spin_moment approach residual iterations",
        "patch_approach": "approach normal_force",
    }
    absent = {
        "loaded": "wheelset.z",
        "left_wheel": "left.force[1] wheelset.right.offset[1]",
        "frictionless": "wheelset.speed left.patch[1].creep_force[1] friction.coefficient",
        "patch_normal": "creepage[1] creep_force[1]",
        "rail": "track.roller_pitch_rate left.patch[7].normal_force",
    }
    for name, names in expected.items():
        assert set(names.split()) <= unpacked(name).variables.keys(), name
    for name, names in absent.items():
        assert not set(names.split()) & unpacked(name).variables.keys(), name


def test_value_references_never_change(unpacked: Callable[..., Fmu]) -> None:
    """Masters store them: a change breaks finished models."""
    references = unpacked("roller").references
    assert references["wheelset.y"] == 1
    assert references["wheelset.left.offset[3]"] == 1003
    assert references["force[1]"] == 43
    assert references["left.force[1]"] == 1043
    assert references["right.patch[2].position[1]"] == 2220
    assert len(set(references.values())) == len(references)


@pytest.mark.parametrize("backend", BACKENDS)
def test_library_needs_only_the_system_and_shows_only_fmi(
    backend: str, unpacked: Callable[..., Fmu]
) -> None:
    path = unpacked("patch", backend).binary_path
    symbols = tool("nm", "-D", "--defined-only", path).split()[2::3]
    assert len(symbols) == 44
    assert all(symbol.startswith("fmi2") for symbol in symbols)
    dynamic = tool("readelf", "-dW", path)
    needed = set(re.findall(r"\(NEEDED\).*\[(.*)\]", dynamic))
    assert needed <= SYSTEM_LIBRARIES | {"ld-linux-x86-64.so.2"}
    assert not re.search(r"RPATH|RUNPATH|TEXTREL", dynamic)
    assert re.search(r"GNU_STACK .* RW ", tool("readelf", "-lW", path))


def test_archive_suits_every_importer(packed: Callable[..., Path]) -> None:
    path = packed("roller", "eigen")
    assert path.stat().st_size < 5e6
    for info in zipfile.ZipFile(path).infolist():
        assert info.filename.isascii()
        assert not re.search(r"\\|^/|\./", info.filename)
        assert info.compress_type in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED)
        assert info.extract_version <= 20
        assert info.external_attr >> 28 == 0o10  # a plain file


def test_same_date_same_bytes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000000")
    paths = [tmp_path / folder / "same.fmu" for folder in ("one", "two")]
    for path in paths:
        path.parent.mkdir()
        pack_fmu(load_scene(SCENES["patch"]), path)
    assert paths[0].read_bytes() == paths[1].read_bytes()
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000002")
    pack_fmu(load_scene(SCENES["patch"]), paths[1])
    guids = [read_model_description(str(path)).guid for path in paths]
    assert guids[0] == guids[1]
    other = {**SCENES["patch"], "friction": {"coefficient": 0.31}}
    pack_fmu(load_scene(other), paths[1])
    assert read_model_description(str(paths[1])).guid != guids[0]


def test_documentation_is_complete_and_offline(unpacked: Callable[..., Fmu]) -> None:
    fmu = unpacked("roller", "eigen")
    page = (fmu.folder / "documentation" / "index.html").read_text()
    assert not re.search(r"(src|href)=", page)
    for name, variable in fmu.variables.items():
        # constants stand as keys of the case
        shown = name.partition("[")[0] if variable.attrib["causality"] == "local" else name
        assert f"<code>{shown}</code>" in page, name
    # pictures of the frames are in the page itself, and name each point and turn
    assert page.count("<svg") == 3
    drawn = page[page.index("<svg") : page.rindex("</svg>")]
    for word in (
        "A left",
        "P right",
        "wheelset.yaw",
        "wheelset.roll",
        "wheelset.right.rotation[1]",
    ):
        assert word in drawn, word
    for picture in re.findall(r"<svg.*?</svg>", page, re.DOTALL):
        etree.fromstring(picture)
    notice = (fmu.folder / "documentation" / "licenses" / "NOTICE.txt").read_text()
    assert "Mozilla" in notice
    assert "FFTW" not in notice


def test_the_variant_with_fftw_says_gpl(unpacked: Callable[..., Fmu]) -> None:
    fmu = unpacked("patch", "fftw")
    assert fmu.root.attrib["license"] == "GPL-3.0-or-later"
    assert "GPL" in fmu.root.attrib["description"]
    assert fmu.binary_path.name.endswith("_fftw_gpl.so")


def railpatch(*arguments: str | Path) -> subprocess.CompletedProcess[str]:
    """Runs the command."""
    command = [Path(sys.executable).with_name("railpatch"), *arguments]
    return subprocess.run(command, capture_output=True, text=True, check=False)


def test_command_packs_the_default_and_a_case(tmp_path: Path) -> None:
    path = tmp_path / "9 default.fmu"
    run = railpatch("fmu", "-o", path)
    assert run.returncode == 0, run.stderr
    assert read_model_description(str(path)).coSimulation.modelIdentifier == "fmu_9_default"
    case = tmp_path / "my case.toml"
    case.write_text('kind = "patch"\ngeometry.semi_axes = [6e-3, 6e-3]\nload.normal_force = 1e5\n')
    run = railpatch("fmu", case, "-o", path, "--quiet")
    assert (run.returncode, run.stdout) == (0, ""), run.stderr
    description = read_model_description(str(path))
    assert description.modelName == "my case"
    assert "max_pressure" in [v.name for v in description.modelVariables]


def test_a_wrong_call_writes_nothing(tmp_path: Path) -> None:
    case = tmp_path / "case.toml"
    case.write_text('kind = "patch"\ngeometry.semi_axes = [6e-3]\nload.normal_force = 1e5\n')
    run = railpatch("fmu", case, "-o", tmp_path / "a.fmu")
    assert run.returncode == 2
    assert "geometry.semi_axes" in run.stderr
    assert railpatch("fmu", "-o", tmp_path / "absent" / "a.fmu").returncode == 2
    assert list(tmp_path.iterdir()) == [case]


def refused(case: dict[str, Any], tmp_path: Path) -> str:
    """What packing the case says; nothing is written."""
    path = tmp_path / "case.fmu"
    with pytest.raises(CaseError) as caught:
        pack_fmu(load_scene(case), path, name="case", backend="eigen")
    assert not path.exists()
    return str(caught.value)


def test_a_scene_that_the_core_refuses_is_not_packed(tmp_path: Path) -> None:
    turned = with_values(RAIL, track__right={"rotation": [0, 0.01, 0]})
    assert "rail_rotation" in refused(turned, tmp_path)


def test_regimes_with_steps_of_their_own_are_not_packed(tmp_path: Path) -> None:
    shift = {"regime": "shift", "creepage": [1e-4, 0.0]}
    assert "motion.regime" in refused(with_values(PATCH, motion=shift), tmp_path)
    rolled = {"regime": "transient_rolling", "distance": 1e-2, "steps": 4}
    case = with_values(PATCH, motion={**rolled, "creepage": [1e-4, 0.0], "rolling_speed": 10.0})
    assert "motion.steps" in refused(case, tmp_path)


def test_a_start_that_cannot_be_solved_is_not_packed(tmp_path: Path) -> None:
    assert "out_of_range" in refused(with_values(RAIL, wheelset__z=0.02), tmp_path)


def test_a_start_outside_the_range_is_not_packed(tmp_path: Path) -> None:
    text = refused(with_values(PATCH, motion__rolling_speed=2000.0), tmp_path)
    assert "rolling_speed" in text
    assert "2000" in text
    assert "1000" in text


def test_irregularities_of_a_run_are_not_packed(tmp_path: Path) -> None:
    case = with_values(RAIL, track__irregularity="record.csv")
    assert "track.irregularity" in refused(case, tmp_path)


def test_the_page_names_the_scene(unpacked: Callable[..., Fmu]) -> None:
    """Profiles, gauge, material, grid, method, friction, as keys of the case."""
    fmu = unpacked("rail")
    page = (fmu.folder / "documentation" / "index.html").read_text()
    scene = page[page.index("<h2>This scene</h2>") : page.index("<h2>Frames and signs</h2>")]
    for key, value in (
        ("profiles.wheel", "S1002"),
        ("track.gauge", "1.435"),
        ("wheelset.nominal_radius", "0.46"),
        ("method.normal", "half_space"),
        ("friction.law", "coulomb"),
    ):
        assert re.search(rf"<code>{key}</code></td><td>{value}</td>", scene), key
    assert "material.shear_modulus" in scene
    assert "grid.element_size" in scene
    # what is an input is not fixed
    assert "<code>wheelset.y</code>" not in scene


def test_a_patch_has_no_text_of_wheelsets(unpacked: Callable[..., Fmu]) -> None:
    page = (unpacked("patch").folder / "documentation" / "index.html").read_text()
    frames = page[page.index("<h2>Frames and signs</h2>") : page.index("<h2>Outputs</h2>")]
    assert "wheelset" not in frames.lower()


@pytest.mark.parametrize("fmi", [2, 3])
def test_terminals_hold_variables_that_are_there(fmi: int, tmp_path: Path) -> None:
    schema = Path(fmpy.__file__).with_name("schema") / "fmi3" / "fmi3TerminalsAndIcons.xsd"
    for name, terminals in (
        ("rail", ["wheelset", "left_wheel", "left_rail", "right_wheel", "right_rail"]),
        ("left_wheel", ["wheelset", "left_wheel", "left_rail"]),
        ("patch", ["contact"]),
    ):
        path = tmp_path / f"{name}.fmu"
        pack_fmu(load_scene(SCENES[name]), path, backend=OWN, fmi=fmi)
        with zipfile.ZipFile(path) as archive:
            root = etree.fromstring(archive.read("terminalsAndIcons/terminalsAndIcons.xml"))
            assert archive.read("terminalsAndIcons/icon.png")[1:4] == b"PNG"
            assert etree.fromstring(archive.read("terminalsAndIcons/icon.svg")).tag.endswith("svg")
        assert etree.XMLSchema(etree.parse(str(schema))).validate(root)
        assert [terminal.get("name") for terminal in root.iter("Terminal")] == terminals
        names = {v.name for v in read_model_description(str(path)).modelVariables}
        members = [m.get("variableName") for m in root.iter("TerminalMemberVariable")]
        assert set(members) <= names
        assert len(set(members)) == len(members)
        # what moves a scene is in a terminal, z too, whose output has the same name
        moving = {
            v.name
            for v in read_model_description(str(path)).modelVariables
            if v.causality == "input" and v.name.startswith(("wheelset.", "track."))
        }
        assert moving <= set(members)
        if name == "rail":
            assert "wheelset.z" in moving
