"""What a log says of the run it holds, where options have replaced keys of the case file."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner
from railpatch.case.load import check_case
from railpatch.command.cli import cli
from railpatch.log import Run, read_run

from wheelset_demo.scene import load_wheelset_scene

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

QUICK_VEHICLE = ["--method", "fastsim", "--duration", 0.02]
# command and options -> what must be in the file, and what in the run, by key
CASES: dict[str, tuple[list[Any], dict[str, tuple[Any, Any]]]] = {
    "wheelset": (
        ["wheelset", "--distance", 0.5, "--step", 2e-3, "--stepper", "rk4"],
        {"run.distance": (60.0, 0.5), "run.step": (1e-3, 2e-3), "run.stepper": ("ros2", "rk4")},
    ),
    "vehicle": (
        ["vehicle", *QUICK_VEHICLE, "--step", 2e-3, "--threads", 2],
        {
            "method.normal": ("half_space", "hertz"),
            "method.tangential": ("full", "fastsim"),
            "grid.elements": ([16, 16], [10, 10]),
            "run.duration": (20.0, 0.02),
            "run.step": (1e-3, 2e-3),
            "run.threads": (1, 2),
        },
    ),
    "hunting": (["hunting", "fast.toml", "--speed", 30.0], {"wheelset.speed": (50.0, 30.0)}),
    "rig": (
        ["rig", "--method", "newton", "--positions", 2],
        {"rig.balance.method": ("broyden", "newton"), "rig.positions": (37, 2)},
    ),
}


def quick_hunting() -> str:
    """The scene of the package, with a fast theory."""
    text = CliRunner().invoke(cli, ["hunting", "--show-scene"]).stdout
    methods = '[method]\nnormal = "hertz"\ntangential = "polach"\n'
    assert text.count("[method]\n") == 1
    return text.replace("[method]\n", methods)


def invoke(*arguments: object) -> None:
    ended = CliRunner().invoke(cli, [str(argument) for argument in arguments])
    assert ended.exit_code == 0, ended.output


def value_at(content: Any, key: str) -> Any:
    for part in key.split("."):
        content = content.get(part) if isinstance(content, dict) else None
    return content


def effective(run: Run) -> dict[str, Any]:
    return json.loads(run.attachments["effective.json"].data)


@pytest.mark.parametrize("name", CASES)
def test_the_log_holds_the_file_and_what_ran(
    tmp_path: Path, name: str, monkeypatch: pytest.MonkeyPatch
):
    arguments, keys = CASES[name]
    monkeypatch.chdir(tmp_path)
    if "fast.toml" in arguments:
        Path("fast.toml").write_text(quick_hunting(), encoding="utf-8")
    log, page = tmp_path / "run.mcap", tmp_path / "report.html"
    invoke(*arguments, "-o", log)
    run = read_run(log)
    about = run.metadata["railpatch"]
    file = tomllib.loads(run.attachments[about["scene"]].data.decode())
    content = effective(run)
    for key, (read, ran) in keys.items():
        assert value_at(file, key) in (read, None), key
        assert value_at(content, key) == ran, key
        assert f"{key} {spelled(read)} -> {spelled(ran)}" in about["overrides"]
    method = content["method"]
    assert about["theory"] == f"{method['normal']}, {method['tangential']}"
    own = ("body", "suspension", "run", "vehicle", "alignment", "irregularity", "rig")
    own += ("dip", "support", "measured_track", "comfort", "wet")
    assert check_case({k: v for k, v in content.items() if k not in own}).kind == "wheelset"
    invoke("report", log, "-o", page)
    text = page.read_text(encoding="utf-8")
    assert about["theory"] in text
    for key in keys:
        assert key in text


def spelled(value: Any) -> str:
    return value if isinstance(value, str) else json.dumps(value)


def test_nothing_is_replaced_without_options(tmp_path: Path):
    """And what runs is what the file says, to the last key."""
    file, log = tmp_path / "scene.toml", tmp_path / "run.mcap"
    shown = CliRunner().invoke(cli, ["wheelset", "--show-scene"]).stdout
    file.write_text(shown.replace("distance = 60.0", "distance = 0.5"))
    invoke("wheelset", file, "-o", log)
    run, scene = read_run(log), load_wheelset_scene(file)
    assert run.attachments["scene.toml"].data == file.read_bytes()
    about = run.metadata["railpatch"]
    assert about["overrides"] == ""
    assert (about["step"], about["duration"]) == ("0.001", "0.025")
    assert about["grid"] == "elements 12 x 12"
    assert effective(run)["run"] == scene.run.model_dump(mode="json")
    assert effective(run)["body"] == scene.body.model_dump(mode="json")
    assert effective(run)["wheelset"] == scene.case.wheelset.model_dump(mode="json")
    page = tmp_path / "report.html"
    invoke("report", log, "-o", page)
    assert "not as in the case file" in page.read_text(encoding="utf-8")
