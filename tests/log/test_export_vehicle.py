"""What ``railpatch export`` takes of a vehicle's log where nothing is asked for."""

from __future__ import annotations

from pathlib import Path

import pytest
from click.testing import CliRunner
from railpatch.command.cli import cli
from railpatch.log.table import READ

from wheelset_demo.vehicle import load_vehicle_scene
from wheelset_demo.vehicle.simulation import Simulation
from wheelset_demo.vehicle.trace import run_vehicle


@pytest.fixture(scope="module")
def log(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("export") / "a.mcap"
    scene = load_vehicle_scene().with_method(normal="hertz", tangential="polach", grid=None)
    run_vehicle(Simulation(scene.with_run(duration=0.01, log_every=5)), output=path)
    return path


def exported(log: Path, *options: str) -> tuple[list[str], str]:
    """Head of the table and what was said."""
    table = log.with_name("a.csv")
    ran = CliRunner().invoke(cli, ["export", str(log), "-o", str(table), *options])
    assert ran.exit_code == 0, ran.output
    with table.open(encoding="utf-8") as file:
        return file.readline().strip().split(","), ran.output


def test_what_is_read_first(log: Path) -> None:
    """Y, Q, Y/Q, positions, accelerations of all wheels and bodies, no patches; all by --all."""
    head, said = exported(log)
    names = [column.split(" ")[0] for column in head]
    for wanted in (
        *("/wheelset/4/state.y", "/wheelset/1/left/contact.force.y"),
        *("/wheelset/2/right/contact.derailment_quotient", "/wheelset/3/left/contact.wear_number"),
        *("/wheelset/1/left/contact.mean_guiding_force", "/vehicle/state.speed"),
        "/vehicle/bodies.bodies[0].acceleration.y",
        *("/vehicle/assessment.static_load[0]", "/vehicle/assessment.most_derailment[7]"),
    ):
        assert wanted in names, wanted
    assert not any("patches[" in name for name in names)
    assert len(names) < 300
    whole, _ = exported(log, "--all")
    assert set(head) < set(whole)
    assert f"{len(head)} columns of {len(whole)}, which --all writes" in said
    some, said = exported(log, "--signal", "approach")
    assert any("patches[0].approach" in name for name in some)
    assert "--all" not in said
    topics = {column.split(".")[0] for column in whole}
    for topic in READ:
        if topic in ("/vehicle/comfort", "/wheelset/N/support"):
            continue  # not of this scene
        left = topic.replace("/N/contact", "/1/left/contact").replace("N", "1")
        assert left in topics
