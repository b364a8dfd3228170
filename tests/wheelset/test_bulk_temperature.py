"""Wheels that a run warms: each its own, on rails that are always new."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
import railpatch
import wheelset_scenes as scenes
from railpatch.log.reader import read_run
from railpatch.report.page import write_report

from wheelset_demo.coupling.held import ElementContact
from wheelset_demo.hunting import linearised
from wheelset_demo.scene import load_wheelset_scene
from wheelset_demo.simulation import Simulation, run_scene

MASS, AIR_CONDUCTANCE, START = 0.002, 0.05, 35.0
HEAT_CAPACITY = 450.0
BULK = f"""
[temperature]
wheel = {START}
rail = 20.0
[temperature.bulk]
mass = [{MASS}, 0.0]
air_conductance = [{AIR_CONDUCTANCE}, 0.0]
air_temperature = 10.0
"""


def warm(folder: Path, bulk: str = BULK, **values: object) -> Path:
    content = scenes.text_of("s1002.toml", distance=0.6, log_every=1, **values)
    file = folder / "warm.toml"
    file.write_text(content.replace("[12, 12]", "[8, 8]") + bulk, encoding="utf-8")
    return file


def test_a_run_warms_each_wheel(tmp_path: Path) -> None:
    """What a wheel stores is what came in less what the air took, by the trapezoidal rule from the
    log, whose own error falls with the square of the step: the run's first order is what is left.
    """
    missing = []
    for step in (2e-3, 1e-3):
        log = tmp_path / "run.mcap"
        run_scene(load_wheelset_scene(warm(tmp_path, step=step, write_rate=1e4)), log)
        run = read_run(log)
        for side in ("left", "right"):
            contact = run[f"/{side}/contact"]
            found, heat = contact["wheel_temperature"], contact["wheel_heat"]
            assert found[0] == START
            assert (contact["rail_temperature"] == 20.0).all()
            flow = heat - AIR_CONDUCTANCE * (found - 10.0)
            gained = np.trapezoid(flow, contact.time)
            change = found[-1] - START
            assert abs(change) > 0.5
            missing.append(abs(gained / (MASS * HEAT_CAPACITY * change) - 1))
    assert max(missing) < 0.1
    assert max(missing[2:]) < 0.6 * max(missing[:2])
    page = write_report(log, tmp_path / "report.html").read_text(encoding="utf-8")
    assert "Bulk temperatures" in page


def test_the_element_passes_time_once(tmp_path: Path) -> None:
    """However often forces are asked for; a negative time is refused."""
    simulation = Simulation(load_wheelset_scene(warm(tmp_path)))
    system, state = simulation.system, simulation.state

    def temperature() -> float:
        system.rates(0.0, state.motion)
        return system.element.result()["left"]["wheel_temperature"]

    first = temperature()
    assert first == START
    system.element.pass_time(2e-3)
    second = temperature()
    assert second != first
    assert temperature() == second
    for seconds in (-1.0, math.inf, math.nan):
        with pytest.raises(railpatch.CaseError, match="seconds"):
            system.element.pass_time(seconds)


def test_what_has_no_time_is_refused(tmp_path: Path) -> None:
    scene = load_wheelset_scene(warm(tmp_path))
    with pytest.raises(railpatch.CaseError, match=r"temperature\.bulk.*hunting"):
        linearised(scene, 20.0)
    with pytest.raises(railpatch.CaseError, match=r"temperature\.bulk"):
        ElementContact(scene)
    rails = BULK.replace(f"[{MASS}, 0.0]", "[1.0, 1.0]")
    with pytest.raises(railpatch.CaseError, match=r"temperature\.bulk\.mass.*always new"):
        Simulation(load_wheelset_scene(warm(tmp_path, rails)))
