"""railpatch wheelset: scenes, exit codes, log and report."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest
import wheelset_scenes as scenes
from click.testing import CliRunner
from railpatch import CaseError
from railpatch.command.cli import cli
from railpatch.log import read_run
from railpatch.report.command import report

from wheelset_demo.scene import load_wheelset_scene, scene_file

PROJECT = Path(__file__).resolve().parents[2]


def invoke(*arguments: object):
    return CliRunner().invoke(cli, ["wheelset", *map(str, arguments)])


def test_run_log_and_report(tmp_path: Path):
    log = tmp_path / "run.mcap"
    ran = invoke("-o", log, "--distance", 1.0, "--json")
    assert ran.exit_code == 0, ran.output
    summary = json.loads(ran.stdout)
    assert summary["good"]
    assert summary["steps"] == 50
    assert summary["distance"] == pytest.approx(1.0, rel=1e-3)
    assert summary["waves"]["length"] is None
    run = read_run(log)
    assert run.stopped_by == ""
    assert run.metadata["railpatch"]["track_kind"] == "rail"
    assert run.attachments["s1002.toml"].data == scene_file("s1002.toml").read_bytes()
    state, energy = run["/wheelset/state"], run["/wheelset/energy"]
    assert len(state) == len(energy) == 8
    assert state["y"][0] == 0.004
    assert (state["speed"] > 19.9).all()
    assert energy["friction_work"][-1] == pytest.approx(summary["energies"]["friction"])
    assert set(run["/left/contact"]["status"]) == {"converged"}
    assert run.counts["/right/fields"] > 0
    assert run.counts["/scene/bodies"] == 1
    page = tmp_path / "report.html"
    made = CliRunner().invoke(report, [str(log), "-o", str(page)])
    assert made.exit_code == 0, made.output
    assert "Energies" in page.read_text()


def test_fitted_rows_log_and_report(tmp_path: Path):
    """The same run on fitted rows, whose fields have places of their own."""
    file, log, page = tmp_path / "scene.toml", tmp_path / "run.mcap", tmp_path / "report.html"
    text = scenes.text_of("s1002.toml")
    assert text.count("elements = [12, 12]") == 1

    def friction_work(grid: str, to: Path) -> float:
        file.write_text(text.replace("elements = [12, 12]", grid), encoding="utf-8")
        ran = invoke(file, "-o", to, "--distance", 1.0, "--json")
        assert ran.exit_code == 0, ran.output
        summary = json.loads(ran.stdout)
        assert summary["good"]
        return summary["energies"]["friction"]

    found = friction_work("elements = [24, 24]\nfitted = [8, 8]", log)
    # the work on uniform grids, half of it error at twelve elements across, is of first order
    coarse, fine = (friction_work(f"elements = [{n}, {n}]", tmp_path / "u.mcap") for n in (12, 24))
    assert found == pytest.approx(2 * fine - coarse, rel=0.05)
    run = read_run(log)
    assert run.counts["/right/fields"] > 0
    assert set(run["/left/contact"]["status"]) == {"converged"}
    made = CliRunner().invoke(report, [str(log), "-o", str(page)])
    assert made.exit_code == 0, made.output
    assert "Energies" in page.read_text()


def test_summary_text_and_quiet(tmp_path: Path):
    ran = invoke("-o", tmp_path / "run.mcap", "--distance", 0.1)
    assert ran.exit_code == 0
    for word in ("s1002.toml", "wave length", "Klingel", "balance", "momentum", "in friction"):
        assert word in ran.stdout
    assert ran.stderr == ""
    quiet = invoke("-o", tmp_path / "run.mcap", "--distance", 0.1, "--quiet")
    assert (quiet.exit_code, quiet.output) == (0, "")


def test_script_does_the_same(tmp_path: Path):
    log = tmp_path / "run.mcap"
    script = PROJECT / "wheelset_demo" / "run.py"
    command = [sys.executable, str(script), "-o", str(log), "--distance", "0.1"]
    ran = subprocess.run(command, capture_output=True, text=True, cwd=tmp_path)
    assert ran.returncode == 0, ran.stderr
    assert len(read_run(log)["/wheelset/state"]) == 2
    version = subprocess.run([*command[:2], "--version"], capture_output=True, text=True)
    assert version.stdout.startswith("railpatch ")


def test_the_scene_that_is_run_can_be_printed(tmp_path: Path):
    shown = invoke("--show-scene")
    assert shown.exit_code == 0
    assert shown.stdout == scene_file("s1002.toml").read_text()


def test_contact_that_fails_ends_the_run(tmp_path: Path):
    text = scenes.text_of("s1002.toml", y=0.0, speed=40.0, distance=20.0, write_rate=1e4)
    file, log = tmp_path / "climb.toml", tmp_path / "run.mcap"
    file.write_text(text.replace("[wheelset]\n", "[wheelset]\nyaw = 0.08\n"))
    ran = invoke(file, "-o", log, "--step", 2e-4)
    assert ran.exit_code == 3
    assert "status: contact failed at" in ran.stderr
    assert "out_of_range" in ran.stderr
    run = read_run(log)
    assert "contact failed at" in run.stopped_by
    statuses = [run[f"/{side}/contact"]["status"] for side in ("left", "right")]
    assert "out_of_range" in {status[-1] for status in statuses}
    assert len(run["/wheelset/energy"]) == len(run["/wheelset/state"]) - 1 > 1


@pytest.mark.parametrize("stepper", ["ros2", "rk4"])
def test_steps_that_are_too_long_end_the_run(stepper: str, tmp_path: Path):
    log = tmp_path / "run.mcap"
    ran = invoke("-o", log, "--step", 0.02, "--stepper", stepper, "--distance", 20.0)
    assert ran.exit_code == 3
    assert "status: contact failed at" in ran.stderr
    assert "contact failed at" in read_run(log).stopped_by


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("mass = 1300.0", "mas = 1300.0", "body.mas: value is 1300.0, but the key is unknown"),
        ("mass = 1300.0", "mass = 0.0", "body.mass: value is 0.0, allowed > 0"),
        ("[run]", "[ran]", "run: value is missing"),
        ("y = 0.004", "y = 4.0", "wheelset.y: value is 4.0, allowed <= 1"),
        ("y = 0.004", "y = 0.03", "wheelset.y: value is 0.03, allowed one where both wheels"),
        ("speed = 20.0", "speed = 0.0", "wheelset.speed: value is 0.0, allowed > 0 m/s"),
        ("speed = 20.0", "speed = 20.0\nroll = 0.1", "wheelset.roll: value is 0.1, allowed: leave"),
        (
            "speed = 20.0",
            'speed = 20.0\nroll = "balanced"',
            "wheelset.roll: value is 'balanced', allowed: leave",
        ),
        ("vertical_force = 120e3", "z = 0.0", "wheelset.z: value is given, allowed 'vertical"),
        ("vertical_force = 120e3", "vertical_force = 1e3", "allowed >= 15696, the weight"),
        ("step = 1e-3", "step = 1.0", "run.step: value is 1.0, allowed <= 0.1"),
        ('stepper = "ros2"', 'stepper = "euler"', "run.stepper: value is 'euler', allowed 'rk4'"),
        ("x = 4e5", "x = 0.0", "suspension.stiffness.x: value is 0.0, allowed > 0"),
        ("carrier_mass = 300.0", "", "body.carrier_mass: value is None, allowed only with"),
        ('kind = "rail"', 'kind = "rail"\ncurvature = 1e-3', "track.curvature: value is 0.001"),
        ('wheel = "S1002"', 'wheel = "none.prw"', "none.prw"),
    ],
)
def test_wrong_scene(old: str, new: str, message: str, tmp_path: Path):
    text = scenes.text_of("s1002.toml")
    assert old in text
    file, log = tmp_path / "scene.toml", tmp_path / "run.mcap"
    file.write_text(text.replace(old, new, 1))
    ran = invoke(file, "-o", log)
    assert ran.exit_code == 2, ran.output
    assert message in ran.stderr
    assert not log.exists()


def test_every_problem_is_named(tmp_path: Path):
    text = scenes.text_of("s1002.toml").replace("mass = 1300.0", "mass = -1.0")
    file = tmp_path / "scene.toml"
    file.write_text(text.replace("gauge = 1.435", "gauge = 0.0").replace("step = 1e-3", "step = 0"))
    with pytest.raises(CaseError) as caught:
        load_wheelset_scene(file)
    assert [line.split(":")[0] for line in caught.value.problems] == [
        "body.mass",
        "run.step",
        "track.gauge",
    ]


def test_log_that_cannot_be_written(tmp_path: Path):
    ran = invoke("-o", tmp_path / "missing" / "run.mcap", "--distance", 0.1)
    assert ran.exit_code == 2
    assert "missing" in ran.stderr
