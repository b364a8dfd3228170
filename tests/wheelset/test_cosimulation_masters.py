"""Masters with the real FMU: steps that it discards, energies, one millisecond, the command."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import wheelset_scenes as scenes
from click.testing import CliRunner
from page_checks import check_page
from railpatch.command.cli import cli

from wheelset_demo.coupling.energy import balance, release
from wheelset_demo.coupling.held import ElementContact, held_run
from wheelset_demo.coupling.linear import linearise
from wheelset_demo.coupling.masters import MASTERS, Hold, Master, Point
from wheelset_demo.coupling.multibody import Multibody
from wheelset_demo.coupling.slave import ContactSlave, CouplingFailure
from wheelset_demo.coupling.stability import Rolling, is_stable
from wheelset_demo.hunting import PITCH
from wheelset_demo.scene import WheelsetScene
from wheelset_demo.simulation import Simulation
from wheelset_demo.start import released
from wheelset_demo.system import COUNT, System

SPEEDS = (0.2, 2.0, 20.0, 80.0)


@pytest.mark.parametrize("speed", SPEEDS)
def test_implicit_steps_of_one_millisecond_are_stable(
    speed: float, scene: WheelsetScene, slave: ContactSlave
):
    # those of explicit masters end far below at low speeds
    rolling = Rolling(scene, speed)
    side = Multibody(rolling.scene)
    assert is_stable(rolling, MASTERS["implicit"](side, slave), 1e-3)
    assert is_stable(rolling, MASTERS["leapfrog"](side, slave), 1e-3) == (speed > 50)


def test_leapfrog_is_the_held_run_in_the_process(scene: WheelsetScene, slave: ContactSlave):
    step, steps = 2.5e-4, 40
    *_, expected = held_run(scene, ElementContact(scene), step, steps)
    master = MASTERS["leapfrog"](Multibody(scene), slave)
    point = master.begin(0.0, released(scene, System(scene)).motion)
    for _ in range(steps):
        point = master.step(point, step)
    # the FFT libraries differ, so forces by the solver's tolerance of 1e-8
    assert point.motion[:5] == pytest.approx(expected.motion[:5], abs=1e-10)


@pytest.mark.parametrize(
    "name", ["linear", "mean", "iterate", "iterate-newton", "implicit", "exchange"]
)
def test_masters_converge_to_the_run_in_the_process(
    name: str, scene: WheelsetScene, slave: ContactSlave
):
    # 20 ms of the wave; masters of order 2 at steps of 0.2 ms against ros2 in this process at 50 us
    moving, start = release(scene, 20.0)
    run = moving.run.model_copy(update={"distance": 0.4, "step": 5e-5, "log_every": 1000})
    simulation = Simulation(replace(moving, run=run))
    simulation.run()
    master = MASTERS[name](Multibody(moving), slave)
    point = master.begin(0.0, start)
    for _ in range(100):
        point = master.step(point, 2e-4)
    off = (point.motion - simulation.state.motion)[[1, 4, COUNT + 4]]
    # parts of the wave: y, yaw, its rate, of 2 mm and 16.6 m
    turn = 2 * np.pi / 16.6
    wave = 2e-3 * np.array([1.0, turn, 20.0 * turn**2])
    assert np.abs(off / wave).max() < 1e-4


@pytest.mark.parametrize("name", MASTERS)
def test_energies_at_the_interface_agree(name: str, scene: WheelsetScene, slave: ContactSlave):
    # all are stable at 20 us but the one whose outputs are late, which is at 5 us
    moving, start = release(scene, 20.0)
    found = balance(moving, start, slave, name, 5e-6 if name == "parallel" else 2e-5, 2e-3)
    expected = Simulation(moving)
    power = expected.system.rates(0.0, expected.state.motion).work[1]
    # the wave hardly moves in so short a time
    assert found.friction == pytest.approx(power * found.duration, rel=0.02)
    assert found.share < 1e-4


def test_energy_is_made_where_held_forces_drive_the_bounce(
    scene: WheelsetScene, slave: ContactSlave
):
    # closed form: |x| grows by the determinant 1 + (w h)^2/2 of two eigenvalues in each step
    rolling = Rolling(scene, 20.0)
    rate, frequency = rolling.system.least_damped_bounce
    step, steps, bounce = 5e-4, 60, 1e-6
    start = rolling.system.motion.copy()
    start[2] += bounce
    master = MASTERS["hold"](Multibody(rolling.scene), slave)
    point = master.begin(0.0, start)
    sizes = []
    for _ in range(steps):
        point = master.step(point, step)
        sizes.append(rolling.size(point.time, point.motion))
    grown = np.polyfit(step * np.arange(steps // 2), np.log(sizes[steps // 2 :]), 1)[0]
    expected = 0.5 * np.log1p(0.5 * (frequency * step) ** 2) / step - rate
    assert grown == pytest.approx(expected, rel=0.1)
    # what the multibody side was given and the FMU's side did not give is in the bounce
    stiffness = frequency**2 / rolling.system.b[COUNT - 1 + 2, 2]
    kept = 0.5 * stiffness * bounce**2 * (sizes[-1] / sizes[0]) ** 2
    assert point.taken - point.given == pytest.approx(kept, rel=0.5)


def run_on(master: Master, point: Point, step: float, steps: int) -> Point:
    """The last point."""
    for _ in range(steps):
        point = master.step(point, step)
    return point


class Thrown(Hold):
    """One that asks for a place far off the rails in a step longer than a limit."""

    limit = 3e-4

    def move(self, point: Point, step: float):
        """See Hold."""
        motion, work = super().move(point, step)
        if step > self.limit:
            motion[1] = 0.5
        return motion, work


def test_a_discarded_step_is_halved(scene: WheelsetScene, slave: ContactSlave):
    start = released(scene, System(scene)).motion
    side = Multibody(scene)
    found, expected = [], []
    for master, steps, step in (
        (Thrown(side, slave, halvings=2), 3, 1e-3),
        (Hold(side, slave), 12, 2.5e-4),
    ):
        point = master.begin(0.0, start)
        for _ in range(steps):
            point = master.step(point, step)
        (found if isinstance(master, Thrown) else expected).append(point)
    assert found[0].time == pytest.approx(3e-3)
    # a restored FMU steps to the same bits
    assert (found[0].motion == expected[0].motion).all()


@pytest.mark.parametrize("name", MASTERS)
def test_a_contact_that_fails_ends_every_master(
    name: str, scene: WheelsetScene, slave: ContactSlave
):
    # thrown off the rails sideways: fmi2Discard whatever the step, once a profile ends
    start = Rolling(scene, 20.0).system.motion.copy()
    start[7] = 3.0
    master = MASTERS[name](Multibody(scene.at_speed(20.0, 0.0)), slave, halvings=1)
    with pytest.raises(CouplingFailure) as failure:
        run_on(master, master.begin(0.0, start), 1e-3, 100)
    text = str(failure.value)
    assert text.startswith("step of 0.0005 s at 0.0")
    call = "fmi2GetReal" if name == "exchange" else "fmi2DoStep"
    assert f"halved 1 times, cannot be done: {call}: at time 0.0" in text
    assert "out of its range of validity" in text
    # another run begins as if nothing had been
    assert master.begin(0.0, Rolling(scene, 20.0).start).heard.wrench[2] < -1e5


def test_an_iteration_that_does_not_converge_is_halved(scene: WheelsetScene, slave: ContactSlave):
    # plain iteration does up to 2 V m/f, 0.8 ms at this speed
    rolling = Rolling(scene, 20.0)
    side = Multibody(rolling.scene)
    start = rolling.start.copy()
    start[[7, 10]] += 1e-3
    master = MASTERS["iterate"](side, slave)
    with pytest.raises(CouplingFailure, match="the iteration does not converge"):
        run_on(master, master.begin(0.0, start), 2e-3, 5)
    master = MASTERS["iterate"](side, slave, halvings=2)
    assert run_on(master, master.begin(0.0, start), 2e-3, 5).time == pytest.approx(1e-2)


def test_linearised_motion_goes_on_as_it_is(scene: WheelsetScene):
    found = linearise(scene, 20.0)
    system = System(scene.at_speed(20.0, 0.0))
    rates = system.rates(0.0, found.motion).motion
    rates[0] -= 20.0
    assert np.abs(np.delete(rates, PITCH)).max() < 1e-5


def invoke(*arguments: object):
    return CliRunner().invoke(cli, ["cosimulation", *map(str, arguments)])


def test_command(tmp_path: Path):
    page = tmp_path / "page.html"
    ran = invoke("--speeds", 20, "--masters", "leapfrog,implicit", "-o", page, "--json")
    assert ran.exit_code == 0, ran.output
    found = json.loads(ran.stdout)
    first, second = found["rows"]
    # 2 V m/f of the spin, which is stiffer than the bounce at this speed
    assert first["by_runs"] == pytest.approx(found["speeds"][0]["creep"], rel=0.1)
    assert second["by_runs"] > 1e-2
    assert second["at_1_ms"]["share"] < 1e-4
    assert first["at_1_ms"] is None
    check_page(page, keys=(2, 2))
    text = page.read_text()
    assert "<svg" in text
    assert "leapfrog" in text


def test_speeds_that_fail_leave_the_others(tmp_path: Path):
    """At 200 m/s the reference run, above the critical speed, leaves the contact's range."""
    page = tmp_path / "page.html"
    call = ["--speeds", "20,200", "--masters", "leapfrog", "--elements", 4]
    ran = invoke(*call, "--json", "-o", page)
    assert ran.exit_code == 3
    assert "status: at 200 m/s: contact failed" in ran.stderr
    found = json.loads(ran.stdout)
    assert [row["speed"] for row in found["rows"]] == [20]
    assert found["rows"][0]["by_runs"] > 0
    assert [(f["speed"], "out_of_range" in f["message"]) for f in found["failures"]] == [
        (200, True)
    ]
    assert "<td>failed</td>" in page.read_text()


def test_wrong_calls(tmp_path: Path):
    assert "--speeds: value is '0'" in invoke("--speeds", 0).stderr
    assert "allowed parallel, hold" in invoke("--masters", "other").stderr
    assert "ends in .html or .svg" in invoke("-o", tmp_path / "a.png").stderr
    history = tmp_path / "history.toml"
    layer = "[layer]\nshear_modulus = 8e9\nthickness = 5e-5\nyield_stress = 2e8\n\n[friction]"
    history.write_text(scenes.text_of("hunting.toml").replace("[friction]", layer))
    assert "a scene of wheels without history" in invoke(history, "--quick").stderr
    ran = invoke(tmp_path / "none.toml")
    assert ran.exit_code == 2
    assert "none.toml" in ran.stderr


def test_names_are_those_of_the_masters():
    from wheelset_demo.cosimulation_command import NAMES

    assert tuple(MASTERS) == NAMES
