"""railpatch vehicle -o: what the log and its report hold, against the simulation's own numbers."""

from __future__ import annotations

import json
import re

import numpy as np
import pytest
from click.testing import CliRunner
from railpatch.case.types import SIDES
from railpatch.command.cli import cli
from railpatch.layout import layout, topics_of
from railpatch.log import read_run
from railpatch.report import write_report
from railpatch.report.vehicle import limits
from railpatch.report.vehicle.data import vehicle_run

from wheelset_demo.scene import GRAVITY, scene_file
from wheelset_demo.vehicle.command import vehicle as command
from wheelset_demo.vehicle.scene import load_vehicle_scene
from wheelset_demo.vehicle.simulation import Simulation
from wheelset_demo.vehicle.trace import run_vehicle, summarise

DURATION = 0.2


@pytest.fixture(scope="module")
def ran(tmp_path_factory):
    """A short run with the fast theory: its trace, its simulation and its log."""
    path = tmp_path_factory.mktemp("vehicle") / "run.mcap"
    scene = load_vehicle_scene(None, {"duration": DURATION, "write_rate": 100.0})
    simulation = Simulation(scene.with_method(normal="hertz", tangential="fastsim"))
    trace = run_vehicle(simulation, None, path)
    assert trace.failure is None
    return trace, simulation, read_run(path), path


def test_steps_are_thinned_by_simulation_time(ran):
    trace, _, run, _ = ran
    # kept 200 times a second; written 100 times, shown 30 times
    assert len(trace.times) == 41
    assert run["/vehicle/state"].time == pytest.approx(np.arange(21) * 0.01)
    assert run.counts["/tf"] == run.counts["/scene/contact"] == 7
    assert 0 < trace.logging_share < 1
    # 10 snapshots in the run, and its last step
    assert run.counts["/wheelset/4/right/fields"] == 11
    assert run.stopped_by == ""


def test_wheels_are_those_of_the_run(ran):
    trace, _, run, _ = ran
    data = vehicle_run(run)
    loads, guiding = trace.array("loads")[::2], trace.array("guiding")[::2]
    works = trace.array("works")[::2]
    column = 0
    for number in range(1, 5):
        state = run[f"/wheelset/{number}/state"]
        assert state["x"] == pytest.approx(trace.array("positions")[::2, number - 1], abs=1e-9)
        assert state["y"] == pytest.approx(trace.array("lateral")[::2, number - 1], abs=1e-15)
        for side in SIDES:
            wheel = number, side
            assert data.loads[wheel] == pytest.approx(loads[:, column], rel=1e-12)
            assert data.guiding[wheel] == pytest.approx(guiding[:, column], abs=1e-6)
            means = data.mean_guiding[wheel], data.mean_loads[wheel]
            assert means[0] == pytest.approx(trace.array("mean_guiding")[::2, column], abs=1e-6)
            assert means[1] == pytest.approx(trace.array("mean_loads")[::2, column], rel=1e-12)
            assert data.friction_work(wheel) == pytest.approx(works[:, 4 + column], rel=1e-12)
            column += 1


def test_wheels_of_both_sides_make_the_wheelsets_force(ran):
    _, _, run, _ = ran
    for number in range(1, 5):
        total = sum(run[f"/wheelset/{number}/{side}/contact"]["force"] for side in SIDES)
        assert run[f"/wheelset/{number}/state"]["force"] == pytest.approx(total, rel=1e-9)


def test_page_takes_loads_at_rest_and_extremes_of_every_step(ran):
    """In a curve a run's mean is not what a wheel carries at rest; of steps that are not written
    the extremes count too. A coach stands on its eight wheels alike."""
    trace, simulation, run, _ = ran
    data = vehicle_run(run)
    weight = simulation.scene.vehicle.mass * GRAVITY
    # a force of the wind's kind, in the numbers that are shown alone
    for wheel in data.loads:
        data.loads[wheel] = 1.1 * data.loads[wheel]
    for number in range(1, 5):
        assert limits.static_load(data, number) == pytest.approx(weight / 4, rel=1e-9)
        assert limits.sum_limit(data, number) == pytest.approx(10e3 + weight / 12, rel=1e-9)
    found, wheels = summarise(trace, simulation), list(data.contact)
    assert found.static_loads == pytest.approx([weight / 4] * 4, rel=1e-9)
    least = min(limits.least_load(data, wheel) for wheel in wheels)
    assert least == pytest.approx(found.load_range[0], rel=1e-15)
    assert found.unloading == pytest.approx(1 - least / (weight / 8), rel=1e-12)
    assert max(limits.unloading(data, wheel) for wheel in wheels) == found.unloading
    assert max(limits.load_spread(data, w).most for w in wheels) == found.load_range[1]
    assert max(limits.ratio_spread(data, w).most for w in wheels) == found.derailment
    assert max(limits.sum_spread(data, n).most for n in range(1, 5)) == found.shift
    assert limits.ride(data)[1] == pytest.approx(found.comfort, rel=1e-12)
    # known from the run's begin on, should it be ended from outside
    assert run["/vehicle/assessment"].messages[0]["static_load"] == pytest.approx([weight / 4] * 4)
    assert "unloading" in found.text()


def test_balance_of_energies(ran):
    trace, _, run, _ = ran
    energy = run["/vehicle/energy"]
    assert np.abs(energy["mechanical_residual"]).max() <= 1.0001 * trace.open_balance()
    lost = energy["friction_work"][-1] + energy["damping_work"][-1]
    assert trace.lost() == pytest.approx(lost)
    parts = ("kinetic", "gravity", "suspension", "elastic")
    for index, name in enumerate(parts):
        assert energy[name] == pytest.approx(trace.array("energies")[::2, index], rel=1e-12)


def test_bodies_are_where_the_simulation_has_them(ran):
    trace, simulation, run, _ = ran
    bodies = {body["name"]: body for body in run["/vehicle/bodies"].messages[-1]["bodies"]}
    poses = simulation.body_poses()
    for name, body in bodies.items():
        assert body["position"] == pytest.approx(poses[name][1], abs=1e-12)
    assert bodies["car_body"]["acceleration"] == pytest.approx(trace.felt[-1])
    # a wheelset's frame does not spin: its x axis stays level
    for number in range(1, 5):
        x, y, z, w = bodies[f"wheelset_{number}"]["orientation"]
        assert 2 * (x * z - y * w) == pytest.approx(0, abs=0.01)


def test_layout_of_a_vehicle_has_its_topics(ran):
    _, _, run, _ = ran
    assert topics_of(layout("vehicle", 4)) <= set(run.counts)


def test_report(ran, tmp_path):
    _, _, run, path = ran
    page = write_report(path, tmp_path / "report.html").read_text(encoding="utf-8")
    for name in ("track", "loads", "ratios", "positions", "accelerations", "friction", "energy"):
        assert page.count(f'id="{name}"') == 1, name
    for name in ("work", "patch-1", "patch-4"):
        assert page.count(f'id="{name}"') == 1, name
    assert 'id="momentum"' not in page
    text = re.sub(r"<(script|style).*?</\1>|<[^>]+>", " ", page, flags=re.S)
    assert "Vehicle on track" in text
    assert f"{len(run['/vehicle/state'])} logged, of which 21 converged" in text


def test_command(tmp_path):
    log = tmp_path / "run.mcap"
    done = CliRunner().invoke(
        command, ["--method", "polach", "--duration", "0.05", "-o", str(log), "--json"]
    )
    assert done.exit_code == 0, done.output
    summary = json.loads(done.stdout)["runs"]["polach"]
    assert 0 < summary["logging_share"] < 1
    # 50 a second, and the last one
    assert list(read_run(log)["/vehicle/state"].time) == pytest.approx([0, 0.02, 0.04, 0.05])
    made = CliRunner().invoke(cli, ["report", str(log), "-o", str(tmp_path / "page.html")])
    assert made.exit_code == 0, made.output


@pytest.mark.parametrize("more", [["--compare"], ["--method", "full", "--method", "polach"]])
def test_a_log_is_of_one_run(tmp_path, more):
    log = tmp_path / "run.mcap"
    done = CliRunner().invoke(command, ["-o", str(log), *more])
    assert done.exit_code == 2
    assert "allowed with one run only" in done.output
    assert not log.exists()


def test_log_that_cannot_be_written(tmp_path):
    log = tmp_path / "missing" / "run.mcap"
    done = CliRunner().invoke(command, ["-o", str(log), "--duration", "0.01"])
    assert done.exit_code == 2
    assert "missing" in done.output


def test_contact_that_fails_is_the_logs_last_step(tmp_path):
    """300 km/h into a circle of 150 m: the vehicle leaves the track."""
    text = scene_file("vehicle_curve.toml").read_text(encoding="utf-8")
    for key, value in (("radius", 150.0), ("straight", 60.0), ("transition", 20.0)):
        text, count = re.subn(rf"(?m)^{key} = \S+", f"{key} = {value}", text)
        assert count == 1
    file, log = tmp_path / "climb.toml", tmp_path / "run.mcap"
    file.write_text(text, encoding="utf-8")
    arguments = [str(file), "--method", "polach", "--duration", "3", "-o", str(log)]
    done = CliRunner().invoke(command, arguments)
    assert done.exit_code == 3
    assert "; the log up to there is in" in done.output
    run = read_run(log)
    times = run["/vehicle/state"].time
    # the last step that was good is there, past the log's pace, and just before the failed one
    assert times[-1] - times[-2] < 1.001e-3
    assert times[-2] - times[-3] < 0.02 + 1e-9
    assert "contact failed at" in run.stopped_by
    data = vehicle_run(run)
    assert list(data.solved[:-1]) == [True] * (data.count - 1)
    assert not data.solved[-1]
    page = write_report(log, tmp_path / "page.html").read_text(encoding="utf-8")
    assert "stopped before its end" in page
    assert "did not converge" in page
