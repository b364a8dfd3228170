"""Driven wheelsets: torques without resultant, load transfer, slip control on a friction step."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pinocchio as pin
import pytest
import vehicle_parts as parts
import vehicle_scenes as scenes
from click.testing import CliRunner
from railpatch.case.fluid import Fluid
from railpatch.case.friction import Friction
from railpatch.command.cli import cli
from railpatch.errors import CaseError
from railpatch.log import read_run

from wheelset_demo.scene import scene_file
from wheelset_demo.vehicle import Simulation, load_vehicle_scene
from wheelset_demo.vehicle.drives import drive_of
from wheelset_demo.vehicle.trace import run_vehicle
from wheelset_demo.vehicle.traction import DriveTable

RADIUS, TORQUE, COUPLER = 0.625, 46875.0, 1.05
STEP = 20.0  # m, where friction falls


def locomotive(*, control: bool = True, friction: float = 0.5, **run):
    """That of the package with a quick theory; the full torque from the start."""
    scene = load_vehicle_scene(scene_file("locomotive.toml"))
    scene = scene.with_run(**{"step": 2e-3, **run}).with_method(tangential="polach")
    law = scene.case.friction.model_copy(
        update={"along_track": [[STEP, 1.0], [STEP + 1.0, friction]]}
    )
    drives = [
        drive.model_copy(
            update={"torque": [[0.0, TORQUE]]} | ({} if control else {"slip_control": None})
        )
        for drive in scene.vehicle.drive
    ]
    vehicle = scene.vehicle.model_copy(update={"drive": drives})
    case = scene.case.model_copy(update={"friction": law})
    return replace(scene, vehicle=vehicle, case=case)


def table(**control):
    return DriveTable(
        wheelsets=[1],
        reaction="frame",
        torque=[[0.0, 1000.0]],
        slip_control={"target": 0.1, "proportional": 200.0, "integral": 100.0, **control},
    )


def test_controller_in_closed_form():
    """A slip above the target at 10 m/s: 1 m/s is sought, 2 m/s found, e = -1 m/s; from an integral
    of 1000 N m it falls by 100 e T a sample, and the proportional part takes 200 N m."""
    drive = drive_of(table(period=0.1, rate=1e9), np.array([0.5]))
    # wheels that do not slip: what is wanted
    drive.update(2.0, 10.0, np.array([-20.0]))
    assert drive.torque == pytest.approx([1000.0])
    found = []
    for k in range(1, 4):
        drive.update(2.0 + 0.1 * k, 10.0, np.array([-24.0]))
        found.append(drive.torque[0])
    assert found == pytest.approx([790.0, 780.0, 770.0])
    # between samples it is held
    drive.update(2.34, 10.0, np.array([-20.0]))
    assert drive.torque[0] == pytest.approx(770.0)
    # and it does not wind up: back at the target all of what is wanted within some samples
    for k in range(4, 40):
        drive.update(2.0 + 0.1 * k, 10.0, np.array([-20.0]))
    assert drive.torque[0] == pytest.approx(1000.0)


def test_rate_and_brakes():
    """Torques change by the rate at most; brakes see wheels that turn too slowly."""
    drive = drive_of(table(period=0.1, rate=500.0), np.array([0.5]))
    drive.update(0.0, 10.0, np.array([-40.0]))
    assert drive.torque[0] == pytest.approx(950.0)
    braking = table(period=0.1, rate=1e9).model_copy(update={"torque": [[0.0, -1000.0]]})
    drive = drive_of(braking, np.array([0.5]))
    drive.update(0.0, 10.0, np.array([-20.0]))
    assert drive.torque[0] == pytest.approx(-1000.0)
    drive.update(0.1, 10.0, np.array([-16.0]))
    assert drive.torque[0] == pytest.approx(-790.0)


def test_torques_have_no_resultant():
    """The vehicle turned as one does no work against its drives; their power is that of the
    difference of angular velocities along the axles."""
    simulation = Simulation(locomotive(duration=0.01))
    system = simulation.system
    values = scenes.shaken(simulation, 5)
    n = system.count
    q, v = values[:n], values[n : 2 * n]
    tau = np.zeros(n)
    power = system.drives.add(q, v, tau)
    assert power == pytest.approx(float(tau @ v), rel=1e-12)
    data = system.model.createData()
    pin.forwardKinematics(system.model, data, q, v)
    world = pin.ReferenceFrame.LOCAL_WORLD_ALIGNED

    def turning(name):
        return pin.getVelocity(system.model, data, system.vehicle.joints[name], world).angular

    wanted = 0.0
    for k, frame in enumerate(("bogie_1", "bogie_1", "bogie_2", "bogie_2"), start=1):
        name = f"wheelset_{k}"
        axle = data.oMi[system.vehicle.joints[name]].rotation[:, 1]
        wanted -= TORQUE * axle @ (turning(name) - turning(frame))
    assert power == pytest.approx(wanted, rel=1e-9)


@pytest.fixture(scope="module")
def pulling():
    """Steady traction on dry rails: a car body that pitches no longer after half a second."""
    scene = locomotive(duration=1.0, friction=1.0, log_every=50)
    light = scene.vehicle.body[0].model_copy(update={"inertia": [8e4, 1e5, 1e5]})
    vehicle = scene.vehicle.model_copy(update={"body": [light, *scene.vehicle.body[1:]]})
    simulation = Simulation(replace(scene, vehicle=vehicle))
    first = simulation.system.suspension.statics.loads
    for _ in simulation.steps():
        pass
    return simulation, first


def test_pull_and_load_transfer(pulling):
    """What wheels pull with is torque over radius, and the coupler takes it; about a point on the
    rails loads shift by pull times coupler height."""
    simulation, first = pulling
    wrenches = simulation.element.contact_wrench
    pull = wrenches[:, 0].sum()
    assert pull == pytest.approx(4 * TORQUE / RADIUS, rel=0.01)
    places = np.array([axle.x for axle in simulation.scene.vehicle.axles])
    shift = -(places @ (-wrenches[:, 2] - first))
    assert shift == pytest.approx(pull * COUPLER, rel=0.01)
    # the leading wheelset of each bogie is lighter, the leading bogie too
    loads = -wrenches[:, 2]
    assert loads[0] < loads[1]
    assert loads[:2].sum() < loads[2:].sum()


def test_energy_closes_while_pulling():
    """Of what the drives put in, less than a thousandth is missing; better with shorter steps."""
    missing = []
    for step in (2e-3, 1e-3):
        trace = run_vehicle(Simulation(locomotive(duration=0.2, step=step)))
        missing.append(trace.open_balance() / trace.works[-1][3])
    assert 0 < missing[1] < 1e-3
    assert missing[1] < 0.7 * missing[0]


def test_slip_control_on_a_friction_step():
    """Friction falls to a half under wheelset after wheelset. With control all come back to the
    slip that is sought, 3 % of the speed, and pull with what the rails give; without it they spin:
    torque less friction over their inertia."""
    ends, heats, slips = [], [], []
    for control in (True, False):
        simulation = Simulation(locomotive(control=control, duration=2.1, log_every=20))
        trace = run_vehicle(simulation)
        assert trace.failure is None
        state = simulation.state
        slips.append(simulation.system.drives.slip_speeds(state.q, state.v))
        ends.append(simulation)
        heats.append(trace.works[-1][1])
    speed = float(ends[0].state.v[0])
    np.testing.assert_allclose(slips[0], 0.03 * speed, rtol=0.1)
    assert (slips[1] > 5.0).all()
    assert heats[1] > 3 * heats[0]
    wheels = ends[0].element.wheels
    used = wheels[:, :, 0] / -wheels[:, :, 2]
    # Polach's law at half of 0.55 and this slip; a little of the contact still adheres
    law = 0.5 * 0.55 * (0.6 * np.exp(-0.6 * slips[0].mean()) + 0.4)
    np.testing.assert_allclose(used, law, rtol=0.03)
    # what the controller leaves is what the rails take
    held = ends[0].system.drives.torque / RADIUS
    np.testing.assert_allclose(held, wheels[:, :, 0].sum(axis=1), rtol=0.03)


def test_slip_control_on_wet_rails():
    """A film of water bears half of the load: the drives ask for five times as much as the wetted
    asperities give. All wheelsets come to the slip that is sought and use the contacts' own
    effective friction whole."""
    scene = locomotive(duration=1.0, log_every=100)
    fluid = Fluid(
        model="film",
        share="film_ratio",
        roughness=0.5765e-6,
        boundary_friction=0.1485,
        liquid="water",
        temperature=20.0,
    )
    wet = {"friction": Friction(coefficient=0.5), "fluid": fluid}
    ramp = [[0.0, 0.0], [1.0, TORQUE]]
    drives = [one.model_copy(update={"torque": ramp}) for one in scene.vehicle.drive]
    simulation = Simulation(
        replace(
            scene,
            case=scene.case.model_copy(update=wet),
            vehicle=scene.vehicle.model_copy(update={"drive": drives}),
        )
    )
    assert run_vehicle(simulation).failure is None
    slips = simulation.system.drives.slip_speeds(simulation.state.q, simulation.state.v)
    np.testing.assert_allclose(slips, 0.03 * simulation.state.v[0], rtol=0.05)
    wheels = simulation.element.wheels
    used = wheels[:, :, 0] / -wheels[:, :, 2]
    for index in range(4):
        result = simulation.element.result(index)
        for side, part in zip(("left", "right"), used[index], strict=True):
            (patch,) = result[side]["patches"]
            assert 0.05 < patch["effective_friction"] < 0.1485
            assert part == pytest.approx(patch["effective_friction"], rel=0.01)
    held = simulation.system.drives.torque
    assert (held < 0.25 * TORQUE).all()


def test_traction_in_log_and_report(tmp_path):
    log, page = tmp_path / "run.mcap", tmp_path / "page.html"
    scene = scene_file("locomotive.toml")
    call = ["vehicle", str(scene), "--duration", "0.05", "--json", "-o", str(log)]
    done = CliRunner().invoke(cli, call)
    assert done.exit_code == 0, done.output
    assert len(json.loads(done.output)["runs"]["scene"]["friction"]) == 8
    state = read_run(log)["/wheelset/4/state"]
    # it rises to 46875 N m in a second, sampled every 10 ms
    assert state["drive_torque"][-1] == pytest.approx(TORQUE * 0.04, rel=0.3)
    assert np.abs(state["slip_speed"]).max() < 0.1
    made = CliRunner().invoke(cli, ["report", str(log), "-o", str(page)])
    assert made.exit_code == 0, made.output
    assert "<h2>Traction</h2>" in page.read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("drive", "message"),
    [
        ({"reaction": "car"}, r"vehicle.drive\[0\].reaction: value is 'car', allowed frame"),
        ({"wheelsets": [1, 3]}, r"vehicle.drive\[0\].wheelsets: value is \[1, 3\], allowed 1 to 2"),
        ({"wheelsets": [1, 1]}, "allowed each once"),
        ({"torque": [[1.0, 1.0], [0.0, 2.0]]}, "allowed times that increase"),
        (
            {
                "torque": [[0.0, 1.0], [1.0, -2.0]],
                "slip_control": {"target": 0.1, "proportional": 1.0, "integral": 1.0},
            },
            "allowed torques of one sign with a slip control",
        ),
        (
            {"slip_control": {"target": 0.1, "proportional": 0.0, "integral": 0.0}},
            "slip_control.integral: value is 0.0",
        ),
    ],
)
def test_refused(tmp_path, drive, message):
    vehicle = parts.bogie()
    given = {"wheelsets": [1], "reaction": "frame", "torque": [[0.0, 100.0]], **drive}
    with pytest.raises(CaseError, match=message):
        parts.load(tmp_path, {**vehicle, "drive": [given]})
