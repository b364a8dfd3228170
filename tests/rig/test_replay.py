"""Replays as users start them: the log, exit codes, and what is left of a killed run."""

from __future__ import annotations

import contextlib
import json
import math
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from railpatch.command.cli import cli
from railpatch.log import Run, RunFileError, read_run

HERE = Path(__file__).parent
DEADLINE = 60.0  # s, for what takes one or two


def call(*arguments):
    return CliRunner().invoke(cli, ["rig", *map(str, arguments)])


@pytest.fixture(scope="module")
def logged(nominal_file, tmp_path_factory):
    """A short run through the command, and its log."""
    path = tmp_path_factory.mktemp("run") / "run.mcap"
    result = call(nominal_file, "-o", path, "--positions", 9)
    assert result.exit_code == 0, result.output
    return result, path, read_run(path)


def test_summary(logged):
    result, path, _ = logged
    assert "9, 9 converged" in result.stdout
    assert "nominal_wheel.csv" in result.stdout
    assert str(path) in result.stdout
    # no progress bar where the output is no terminal
    assert result.stderr == ""


def test_log_holds_every_position(logged):
    _, _, run = logged
    for topic in ("/wheelset/state", "/rig/balance", "/solver/stats", "/left/contact"):
        assert len(run[topic]) == 9
    state = run["/wheelset/state"]
    np.testing.assert_allclose(state["progress"], np.linspace(0, 1, 9))
    np.testing.assert_allclose(state.time, np.linspace(0, 360, 9))
    np.testing.assert_array_equal(state["z"], run["/rig/balance"]["z"])
    assert set(run["/rig/balance"]["status"]) == {"converged"}
    assert np.abs(run["/rig/balance"]["residuals"]).max() <= 5e-5 * 133.95e3
    evaluations = run["/rig/balance"]["evaluations"]
    np.testing.assert_array_equal(run["/solver/stats"]["contact_evaluations"], 2 * evaluations)
    assert not run.truncated
    assert run.stopped_by == ""


def test_log_holds_forces_and_fields(logged):
    _, _, run = logged
    vertical = run["/left/contact"]["force"][:, 2] + run["/right/contact"]["force"][:, 2]
    np.testing.assert_allclose(-vertical, 133.95e3, atol=10)
    np.testing.assert_allclose(run["/wheelset/state"]["force"][:, 2], vertical)
    fields = run["/left/fields"]
    assert len(fields) == 9
    for index, message in enumerate(fields.messages):
        patch = message["patches"][0]
        x, y = (np.unique(np.round(patch[axis], 9)) for axis in "xy")
        area = (x[1] - x[0]) * (y[1] - y[0])
        force = run["/left/contact"].messages[index]["patches"][0]["normal_force"]
        assert math.fsum(patch["pressure"]) * area == pytest.approx(force, rel=1e-3)


def test_log_carries_case_and_profiles(logged, nominal_file):
    _, _, run = logged
    text = run.attachments[nominal_file.name].data
    assert text == nominal_file.read_bytes()
    assert json.loads(run.attachments["effective.json"].data)["rig"]["positions"] == 9
    for name in ("nominal_wheel.csv", "nominal_roller.csv"):
        assert run.attachments[name].data == nominal_file.with_name(name).read_bytes()


def test_rollers_and_wheels_turn_forward(logged):
    _, _, run = logged
    state = run["/wheelset/state"]
    assert (state["pitch_rate"] < 0).all()
    assert (state["roller_pitch_rate"] > 0).all()
    step = np.diff(state.time)[0] * state["roller_pitch_rate"][0]
    turned = np.diff(state["roller_pitch"])
    np.testing.assert_allclose(np.exp(1j * turned), np.exp(1j * step), atol=1e-6)


def test_snapshots_at_a_high_rate(nominal_file, tmp_path):
    path = tmp_path / "run.mcap"
    result = call(nominal_file, "-o", path, "--rate", 200, "--duration", 0.5, "--quiet")
    assert result.exit_code == 0
    assert result.output == ""
    run = read_run(path)
    assert len(run["/wheelset/state"]) == 101
    assert 12 <= len(run["/left/fields"]) <= 14
    # 200 positions a second, and the scene 30 times: at 0, 7 * 5 ms, 14 * 5 ms ... and the last
    assert run.counts["/tf"] == run.counts["/scene/contact"] == 16


PROFILES = [f"nrc_{side}_{body}.csv" for side in ("left", "right") for body in ("roller", "wheel")]


def test_default_scene_has_the_measured_profiles(measured_file, tmp_path):
    result = call("-o", tmp_path / "run.mcap", "--positions", 2)
    assert result.exit_code == 0
    assert f"profiles      {', '.join(PROFILES)}" in result.stdout
    attached = read_run(tmp_path / "run.mcap").attachments
    assert {measured_file.name, *PROFILES} <= set(attached)


def test_position_without_balance_ends_with_3_and_a_log(scene_with, tmp_path):
    path = tmp_path / "run.mcap"
    scene = scene_with(end="\n[rig.balance]\nmax_evaluations = 4\n")
    result = call(scene, "-o", path, "--positions", 3)
    assert result.exit_code == 3
    assert "3 positions did not converge" in result.stderr
    run = read_run(path)
    assert not run.truncated
    assert set(run["/rig/balance"]["status"]) == {"not_converged"}


def test_wrong_input_ends_with_2_and_no_log(scene_with, tmp_path):
    path = tmp_path / "run.mcap"
    none = tmp_path / "none.toml"
    unknown = ("positions = 37", "positions = 37\nspeed = 3")
    for change, arguments in [
        (unknown, []),
        (("nominal_wheel.csv", "none.csv"), []),
        (None, ["--positions", "1"]),
        (None, ["--rate", "fast"]),
        (none, []),
    ]:
        scene = none if change is none else scene_with(*([change] if change else []))
        result = call(scene, *arguments, "-o", path)
        assert result.exit_code == 2, (change, arguments)
        assert "Error" in result.stderr
        assert not path.exists()
    assert call(scene_with()).exit_code == 2  # -o is missing
    result = call(scene_with(), "-o", tmp_path / "none" / "run.mcap")
    assert result.exit_code == 2
    assert "none" in result.stderr


def test_show_scene(tmp_path):
    result = call("--show-scene")
    assert result.exit_code == 0
    path = tmp_path / "mine.toml"
    path.write_text(result.stdout)
    assert "[rig]" in result.stdout
    # its profiles are found beside the package's scenes
    run = call(path, "-o", tmp_path / "run.mcap", "--positions", 2)
    assert run.exit_code == 0, run.output


def test_replay_from_the_checkout(nominal_file, tmp_path):
    """The same code without the package rig_model being installed, from any folder."""
    script = HERE.parents[1] / "rig_model" / "replay.py"
    process = subprocess.run(
        [sys.executable, script, nominal_file, "-o", "run.mcap", "--positions", "2"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert process.returncode == 0, process.stderr
    assert "2, 2 converged" in process.stdout
    assert len(read_run(tmp_path / "run.mcap")["/wheelset/state"]) == 2


def test_killed_replay_keeps_what_was_found(nominal_file, tmp_path):
    path = tmp_path / "run.mcap"
    process = subprocess.Popen(
        [sys.executable, HERE / "killed_replay.py", nominal_file, path],
        stdout=subprocess.PIPE,
        text=True,
        env=os.environ | {"PYTHONPATH": os.pathsep.join(filter(None, sys.path))},
    )
    seen, end = [], time.monotonic() + DEADLINE
    try:
        # what was found gets into the file while the replay goes on
        while len(seen) < 20 and time.monotonic() < end:
            assert process.poll() is None
            time.sleep(0.05)
            with contextlib.suppress(RunFileError, FileNotFoundError):
                seen = indices(read_run(path))
    finally:
        process.send_signal(signal.SIGKILL)
        assert process.wait(timeout=10) == -signal.SIGKILL
        process.stdout.close()
    assert len(seen) >= 20
    run = read_run(path)
    assert run.truncated
    kept = indices(run)
    assert kept == list(range(len(kept)))
    assert set(seen) <= set(kept)
    assert nominal_file.name in run.attachments


def indices(run: Run) -> list[int]:
    """Of the positions in the log."""
    return np.round(200 * run["/wheelset/state"].time).astype(int).tolist()
