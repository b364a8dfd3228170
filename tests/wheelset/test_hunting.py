"""Hunting: critical speed from eigenvalues and from runs in time."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import wheelset_scenes as scenes
from click.testing import CliRunner
from railpatch.command.cli import cli

from wheelset_demo import hunting
from wheelset_demo.coupling.study import with_elements
from wheelset_demo.hunting import Mode, critical_mode, critical_speed_in_time, run_at, slowest_mode
from wheelset_demo.scene import WheelsetScene, load_wheelset_scene, scene_file

AGREEMENT = 0.03


def fast(folder: Path, normal: str, tangential: str) -> WheelsetScene:
    """The scene with a fast theory, whose derivatives are by differences, and longer steps."""
    text = scenes.text_of("hunting.toml", step=2e-3)
    methods = f'[method]\nnormal = "{normal}"\ntangential = "{tangential}"\n'
    file = folder / "fast.toml"
    file.write_text(text.replace("[method]\n", methods))
    return load_wheelset_scene(file)


# elements across: a small grid, and the scene's own
@pytest.fixture(scope="module", params=[8, pytest.param(12, marks=pytest.mark.long)])
def full(request: pytest.FixtureRequest) -> WheelsetScene:
    """The scene of the package: full theory on the half-space."""
    return with_elements(load_wheelset_scene(scene_file("hunting.toml")), request.param)


@pytest.fixture(scope="module")
def mode(full: WheelsetScene) -> Mode:
    """Its critical one."""
    found = critical_mode(full, 10.0, 100.0)
    assert found is not None
    return found


def test_full_theory_eigenvalues_and_runs_in_time(full: WheelsetScene, mode: Mode, measured):
    speed, runs = critical_speed_in_time(full, 0.9 * mode.speed, 1.1 * mode.speed, mode.frequency)
    # below it waves die, above it they grow: as the eigenvalues say
    for run in runs:
        expected = slowest_mode(full, run.speed)
        assert run.growth == pytest.approx(expected.growth, abs=0.01)
        assert run.frequency == pytest.approx(expected.frequency, rel=0.01)
    below, above = runs[0], runs[1]
    assert below.growth < -0.05
    assert above.growth > 0.05
    measured(
        f"critical speed, full theory: {mode.speed:.3f} m/s of eigenvalues, {speed:.3f} m/s "
        f"in time ({100 * (speed / mode.speed - 1):+.3f} %); {mode.frequency:.3f} Hz, waves of "
        f"{mode.wave_length:.2f} m; growth {below.growth:+.4f} 1/s at {below.speed:.1f} m/s, "
        f"{above.growth:+.4f} 1/s at {above.speed:.1f} m/s"
    )
    assert speed == pytest.approx(mode.speed, rel=AGREEMENT)


def test_fast_theory(tmp_path: Path, measured):
    """Another: test_command_in_time."""
    scene = fast(tmp_path, "hertz", "fastsim")
    mode = critical_mode(scene, 10.0, 100.0)
    assert mode is not None
    speed, _ = critical_speed_in_time(scene, 0.85 * mode.speed, 1.2 * mode.speed, mode.frequency)
    measured(
        f"critical speed, FASTSIM: {mode.speed:.3f} m/s of eigenvalues, {speed:.3f} m/s "
        f"in time ({100 * (speed / mode.speed - 1):+.3f} %)"
    )
    assert speed == pytest.approx(mode.speed, rel=AGREEMENT)


def test_hunting_grows_until_friction_bounds_it(full: WheelsetScene, mode: Mode):
    run = run_at(full, 1.6 * mode.speed, slowest_mode(full, 1.6 * mode.speed).frequency)
    assert np.abs(run.y).max() > 5 * abs(run.y[0])


def invoke(*arguments: object):
    return CliRunner().invoke(cli, ["hunting", *map(str, arguments)])


def test_command():
    ran = invoke("--json", "--lowest", 30, "--highest", 70)
    assert ran.exit_code == 0, ran.output
    found = json.loads(ran.stdout)
    mode = critical_mode(load_wheelset_scene(scene_file("hunting.toml")), 30.0, 70.0)
    assert mode is not None
    assert found["critical_speed"] == mode.speed
    assert [g["growth"] < 0 for g in found["growth"]] == [True, False]
    shown = invoke("--lowest", 30, "--highest", 70)
    assert f"{mode.speed:.2f} m/s" in shown.stdout
    assert invoke("--show-scene").stdout == scene_file("hunting.toml").read_text()


def test_command_in_time(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    scene = fast(tmp_path, "hertz", "polach")
    # the text tells what the numbers told, of the same runs
    runs: list[Any] = []

    def once(*arguments: Any) -> Any:
        runs[:] = runs or [critical_speed_in_time(*arguments)]
        return runs[0]

    monkeypatch.setattr(hunting, "critical_speed_in_time", once)
    ran = invoke(tmp_path / scene.name, "--simulate", "--json")
    assert ran.exit_code == 0, ran.output
    found = json.loads(ran.stdout)
    assert found["critical_speed_in_time"] == pytest.approx(found["critical_speed"], rel=AGREEMENT)
    assert "in time" in invoke(tmp_path / scene.name, "--simulate").stdout


def test_no_critical_speed_is_no_error():
    ran = invoke("--lowest", 10, "--highest", 20)
    assert ran.exit_code == 0
    assert "none between 10 and 20 m/s" in ran.stdout


def test_wrong_calls(tmp_path: Path):
    assert "allowed below --highest" in invoke("--lowest", 90, "--highest", 20).stderr
    ran = invoke(tmp_path / "none.toml")
    assert ran.exit_code == 2
    assert "none.toml" in ran.stderr


@pytest.mark.parametrize(
    ("key", "table"),
    [
        ("wheelset.left.flat", "[wheelset.left.flat]\ndepth = 3e-4\nangle = 0.0"),
        ("track.right.joint", "[track.right.joint]\nposition = 0.0\ndepth = 1e-3"),
        ("wheelset.right.runout", f"[wheelset.right]\nrunout = {[0.0, 1e-5] * 6}"),
        ("friction.along_track", ""),
    ],
)
def test_one_place_of_track_and_wheels(tmp_path: Path, key: str, table: str):
    """A flat was taken to be under the wheel all along: 47.5 in place of 49.5 m/s."""
    text = scene_file("hunting.toml").read_text(encoding="utf-8") + f"\n{table}\n"
    if not table:
        text = text.replace("[friction]", "[friction]\nalong_track = [[-1.0, 0.5], [1.0, 1.0]]")
    file = tmp_path / "scene.toml"
    file.write_text(text, encoding="utf-8")
    ran = invoke(file)
    assert ran.exit_code == 2
    assert f"{key}: given, allowed to be left out: the search for a hunting speed" in ran.stderr
