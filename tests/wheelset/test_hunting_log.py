"""railpatch hunting -o: the run's log, what was found attached, and both in the report."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import pytest
import wheelset_scenes as scenes
from click.testing import CliRunner
from railpatch.command.cli import cli
from railpatch.log import read_run
from railpatch.report import write_report

from wheelset_demo.hunting import waves_in


def invoke(*arguments: object):
    return CliRunner().invoke(cli, ["hunting", *map(str, arguments)])


@pytest.fixture(scope="module")
def scene(tmp_path_factory) -> Path:
    file = tmp_path_factory.mktemp("scene") / "fast.toml"
    text = scenes.text_of("hunting.toml")
    assert text.count("[method]\n") == 1
    method = '[method]\nnormal = "hertz"\ntangential = "polach"\n'
    file.write_text(text.replace("[method]\n", method), encoding="utf-8")
    return file


@pytest.fixture(scope="module")
def ran(scene: Path, tmp_path_factory):
    log = tmp_path_factory.mktemp("log") / "run.mcap"
    done = invoke(scene, "-o", log, "--lowest", 40, "--highest", 60, "--json")
    assert done.exit_code == 0, done.output
    return json.loads(done.stdout), log


def test_log_is_of_a_run_that_hunts(ran):
    found, log = ran
    run = read_run(log)
    assert run.stopped_by == ""
    speed = found["log"]["speed"]
    assert speed == pytest.approx(1.1 * found["critical_speed"])
    state = run["/wheelset/state"]
    assert state["speed"] == pytest.approx(speed, rel=1e-3)
    # the waves of the run grow as the eigenvalue at its speed says
    attached = json.loads(run.attachments["hunting.json"].data)
    [mode] = [m for m in attached["modes"] if m["speed"] == pytest.approx(speed)]
    growth, frequency = waves_in(state.time, state["y"], 2.0 / mode["frequency"])
    assert growth == pytest.approx(mode["growth"], rel=0.05)
    assert frequency == pytest.approx(mode["frequency"], rel=0.01)
    signs = [np.sign(m["growth"]) for m in attached["modes"]]
    assert signs == sorted(signs)
    assert {-1.0, 1.0} <= set(signs)


def test_momenta_are_logged(ran):
    _, log = ran
    found = read_run(log)["/wheelset/momentum"]
    mass = 1600.0  # kg, wheelset and axle boxes of the scene
    speed = read_run(log)["/wheelset/state"]["speed"]
    assert found["momentum"][:, 0] == pytest.approx(mass * speed, rel=1e-12)
    # the bounds of docs/multibody.md
    assert np.abs(found["residual"]).max() < 1e-12 * mass * speed[0]
    moved = found["momentum"] - found["momentum"][0]
    assert found["impulse"] + found["residual"] == pytest.approx(moved, abs=1e-9)
    assert np.abs(found["turning_residual"]).max() < 1e-6 * np.abs(found["turning"][0]).max()


def test_report(ran, tmp_path):
    found, log = ran
    page = write_report(log, tmp_path / "report.html").read_text(encoding="utf-8")
    for name in ("waves", "hunting", "momentum", "energy"):
        assert page.count(f'id="{name}"') == 1, name
    text = re.sub(r"<(script|style).*?</\1>|<[^>]+>", " ", page, flags=re.S)
    assert f"{found['critical_speed']:.2f} m/s" in text
    assert "critical speed, from eigenvalues" in text


def test_a_speed_of_its_own(scene: Path, tmp_path):
    log = tmp_path / "run.mcap"
    # waves grow in all of the range, so that the run's speed has to be given
    where = ("--lowest", 55, "--highest", 60)
    refused = invoke(scene, "-o", log, *where)
    assert refused.exit_code == 2
    assert "--speed: left out" in refused.stderr
    assert not log.exists()
    done = invoke(scene, "-o", log, *where, "--speed", 58)
    assert done.exit_code == 0, done.output
    assert f"{log}, at 58.00 m/s, converged" in done.stdout
    page = write_report(log, tmp_path / "report.html").read_text(encoding="utf-8")
    assert "below 55.00 m/s (198.0 km/h): waves grow there" in page


@pytest.mark.parametrize("arguments", [["--speed", 20], ["--speed", 0, "-o", "x.mcap"]])
def test_wrong_calls(arguments: list):
    done = invoke(*arguments)
    assert done.exit_code == 2
    assert "--speed: value is" in done.stderr
