"""What commands write: never over an input, and refused before anything is computed."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

import click
import pytest
from click.testing import CliRunner, Result
from railpatch.command.cli import cli
from railpatch.log import RunLog

from rig_model.scene import NOMINAL, default_scene
from wheelset_demo.hunting_command import default_scene_text as hunting_text
from wheelset_demo.scene import scene_file

RIG = default_scene().parent
WHEEL, ROLLER = "nominal_wheel.csv", "nominal_roller.csv"
GAP = "\n".join(["0 0 0 0"] * 4)
PATCH = """kind = "patch"
[geometry]
undeformed_distance = "gap.csv"
[grid]
element_size = [1e-3, 1e-3]
[load]
approach = 1e-5
[method]
tangential = "none"
"""
# commands that write a folder, or have no input
FOLDERS = {name: (name,) for name in ("bench", "continuity", "stress")} | {
    "convert": ("convert", "case.inp"),
    "match": ("match", "match.toml"),
    "sweep": ("sweep", "sweep.toml"),
    "wear": ("wear", "sweep.toml"),
}


def invoke(*arguments: object) -> Result:
    return CliRunner().invoke(cli, [str(argument) for argument in arguments])


def with_profiles(folder: Path, text: str) -> str:
    """A scene on the rail whose wheels have a profile file of their own."""
    wheel = 'wheel = "S1002"' if 'wheel = "S1002"' in text else 'wheel = "cone:1/40"'
    assert text.count(wheel) == 1
    (folder / WHEEL).write_bytes((RIG / WHEEL).read_bytes())
    return text.replace(wheel, f'wheel = "{WHEEL}"')


def scene(folder: Path, name: str, text: str) -> Path:
    file = folder / name
    file.write_text(text, encoding="utf-8")
    return file


def rig_scene(folder: Path) -> Path:
    for name in (WHEEL, ROLLER, NOMINAL):
        (folder / name).write_bytes((RIG / name).read_bytes())
    return folder / NOMINAL


def log(folder: Path) -> Path:
    file = folder / "run.mcap"
    RunLog(file, case_text="", case_name="scene.toml").close()
    return file


def vehicle_text() -> str:
    return scene_file("vehicle_curve.toml").read_text()


def s1002_text() -> str:
    return scene_file("s1002.toml").read_text()


def patch(folder: Path) -> Path:
    (folder / "gap.csv").write_text(GAP)
    return scene(folder, "patch.toml", PATCH)


# name of the input that is given as output -> makes the input, gives the arguments before it
CASES: dict[tuple[str, str], Callable[[Path], list[object]]] = {
    ("wheelset", "scene.toml"): lambda f: ["wheelset", scene(f, "scene.toml", s1002_text())],
    ("wheelset", WHEEL): lambda f: [
        "wheelset",
        scene(f, "scene.toml", with_profiles(f, s1002_text())),
    ],
    ("hunting", "scene.toml"): lambda f: ["hunting", scene(f, "scene.toml", hunting_text())],
    # an ending that the command takes
    ("cosimulation", "scene.svg"): lambda f: [
        "cosimulation",
        scene(f, "scene.svg", hunting_text()),
    ],
    ("vehicle", "scene.toml"): lambda f: ["vehicle", scene(f, "scene.toml", vehicle_text())],
    ("vehicle", WHEEL): lambda f: [
        "vehicle",
        scene(f, "scene.toml", with_profiles(f, vehicle_text())),
    ],
    ("rig", NOMINAL): lambda f: ["rig", rig_scene(f)],
    ("rig", WHEEL): lambda f: ["rig", rig_scene(f)],
    ("fmu", "patch.toml"): lambda f: ["fmu", patch(f)],
    ("fmu", "gap.csv"): lambda f: ["fmu", patch(f)],
    ("fmu", ROLLER): lambda f: ["fmu", rig_scene(f)],
    ("subsurface", "patch.toml"): lambda f: ["subsurface", patch(f)],
    ("subsurface", "gap.csv"): lambda f: ["subsurface", patch(f)],
    ("report", "run.mcap"): lambda f: ["report", log(f)],
    ("figure", "run.mcap"): lambda f: ["figure", log(f), "traction"],
    ("export", "run.mcap"): lambda f: ["export", log(f)],
    ("layout", "run.mcap"): lambda f: ["layout", log(f)],
    ("profile", WHEEL): lambda f: [
        "profile",
        rig_scene(f).with_name(WHEEL),
        "--rail",
        f / ROLLER,
    ],
    ("profile", ROLLER): lambda f: [
        "profile",
        rig_scene(f).with_name(WHEEL),
        "--rail",
        f / ROLLER,
    ],
}


def commands_that_write() -> set[str]:
    context = click.Context(cli)
    commands = {name: cli.get_command(context, name) for name in cli.list_commands(context)}
    return {n for n, c in commands.items() if any(p.name == "output" for p in c.params)}


def test_all_commands_are_here():
    assert {name for name, _ in CASES} | {*FOLDERS, "table"} == commands_that_write()


@pytest.mark.parametrize("link", ["itself", "hard link"])
@pytest.mark.parametrize(("command", "name"), CASES)
def test_inputs_are_not_overwritten(tmp_path: Path, command: str, name: str, link: str):
    arguments = CASES[command, name](tmp_path)
    before = {file: file.read_bytes() for file in tmp_path.iterdir()}
    output = tmp_path / name
    if link == "hard link":
        output = tmp_path / f"other_{name}"
        os.link(tmp_path / name, output)
    refused = invoke(*arguments, "-o", output)
    assert refused.exit_code == 2, refused.output
    assert f"--output: value is {str(output)!r}, allowed another file than" in refused.output
    assert {file: file.read_bytes() for file in before} == before


@pytest.mark.parametrize("command", sorted(commands_that_write() - set(FOLDERS)))
def test_folders_that_are_not_there(tmp_path: Path, command: str):
    """Known at once, not after minutes."""
    arguments = next((make(tmp_path) for (name, _), make in CASES.items() if name == command), [])
    output = tmp_path / "absent" / "out.svg"
    refused = invoke(*(arguments or [command]), "-o", output)
    assert refused.exit_code == 2, refused.output
    assert f"--output: value is {str(output)!r}, allowed a file in a folder that" in refused.output


@pytest.mark.parametrize("command", FOLDERS)
def test_folders_that_cannot_be(tmp_path: Path, command: str):
    file = tmp_path / "file"
    file.write_text("kept")
    refused = invoke(*FOLDERS[command], "-o", file / "below")
    assert refused.exit_code == 2, refused.output
    assert f"--output: value is {str(file / 'below')!r}, allowed a folder" in refused.output
    assert file.read_text() == "kept"


@pytest.mark.parametrize(
    ("name", "allowed"), [("", "a file in a folder"), (300 * "a", "File name")]
)
def test_names_that_no_file_has(name: str, allowed: str):
    refused = invoke("wheelset", "-o", name)
    assert refused.exit_code == 2
    assert "--output: value is '" in refused.output
    assert allowed in refused.output


def test_a_check_leaves_nothing_behind(tmp_path: Path):
    """Output that can be written, scene that cannot be released: no empty file."""
    text = hunting_text()
    load = next(line for line in text.splitlines() if line.startswith("vertical_force"))
    heavy = scene(tmp_path, "scene.toml", text.replace(load, "vertical_force = 1e12"))
    ended = invoke("hunting", heavy, "-o", tmp_path / "run.mcap")
    assert ended.exit_code in (2, 3), ended.output
    assert [file.name for file in tmp_path.iterdir()] == ["scene.toml"]


def test_a_profile_of_another_ending_is_told_of_both(tmp_path: Path) -> None:
    refused = invoke("profile", "S1002", "-o", tmp_path / "x.foo")
    assert refused.exit_code == 2
    assert "a name that ends in .html or .htm or .pdf or .profile" in refused.output
