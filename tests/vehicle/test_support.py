"""Track below the rails: rest, balances, derivatives, dipped joints; logs, pages that show it."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
import vehicle_scenes as scenes
from railpatch import CaseError, Contact
from railpatch.case.types import SIDES
from railpatch.log import read_run
from railpatch.report import write_report
from scipy.integrate import solve_ivp

from wheelset_demo.scene import GRAVITY
from wheelset_demo.vehicle import Simulation, load_vehicle_scene
from wheelset_demo.vehicle.deviations import DipTable, deviations_of, dip_at
from wheelset_demo.vehicle.support import SupportTable
from wheelset_demo.vehicle.trace import run_vehicle, step_doubts, summarise

# rail, pads, a concrete sleeper, ballast: of the size that vehicle simulations take (assumed)
WHOLE = SupportTable(
    rail_mass=60.0,
    pad_stiffness=[30e6, 120e6],
    pad_damping=[20e3, 30e3],
    sleeper_mass=300.0,
    sleeper_inertia=180.0,
    ballast_stiffness=[25e6, 50e6],
    ballast_damping=[40e3, 60e3],
)
# of one wheel, as British practice takes it for P2 (GM/TT0088, from memory): 245 kg, 62 MN/m,
# 55.4 kN s/m
MASS, STIFFNESS, DAMPING = 245.0, 62e6, 55.4e3
ONE = SupportTable(rail_mass=MASS, pad_stiffness=[20e6, STIFFNESS], pad_damping=[20e3, DAMPING])


def on(support, **keys):
    return replace(scenes.scene(**keys), support=support)


@pytest.mark.parametrize("support", [WHOLE, ONE])
def test_rest(support):
    """Rails lie down by the wheel load over their springs in series, the wheelsets with them, and
    stay."""
    simulation = Simulation(on(support, duration=0.2))
    weight = simulation.scene.vehicle.mass * GRAVITY / 8
    rigid = Simulation(scenes.scene(duration=0.2))
    pad, ballast = support.pad_stiffness[1], support.ballast_stiffness
    down = weight / pad + (0.0 if ballast is None else weight / ballast[1])
    for _ in simulation.steps():
        places = simulation.system.support.place
        np.testing.assert_allclose(places[:, [1, 3]], down, rtol=5e-3)
        if ballast is not None:
            np.testing.assert_allclose(places[:, 5], weight / ballast[1], rtol=5e-3)
            np.testing.assert_allclose(places[:, [4, 6]], 0.0, atol=1e-7)
    moved = simulation.element.states[:, 2] - rigid.element.states[:, 2]
    np.testing.assert_allclose(moved, down, rtol=0.01)
    # and what the pads carry is the wheels' load
    np.testing.assert_allclose(simulation.system.support.forces[:, [1, 3]], weight, rtol=3e-3)


def test_energy_closes():
    """Kinetic, gravity's and springs' energy, the track's with them, change by the work of contacts
    and drive less dampers'; and the contacts' work is that of friction and elastic energy as nearly
    as on rigid ground, where the rails' power is none."""
    missing, open_contacts = [], []
    for support, step in ((WHOLE, 1e-3), (WHOLE, 2.5e-4), (None, 2.5e-4)):
        given = on(support, duration=0.3, irregular=True, step=step)
        trace = run_vehicle(Simulation(given))
        assert trace.failure is None
        missing.append(trace.open_balance() / trace.lost())
        works, stores = trace.array("works"), trace.array("energies")
        elastic = stores[-1, 3] - stores[0, 3]
        open_contacts.append(abs(works[-1, 0] + works[-1, 1] + elastic) / works[-1, 1])
    assert missing[0] < 0.05
    assert missing[1] < 0.3 * missing[0]
    assert open_contacts[1] < 1.2 * open_contacts[2]


def test_derivatives():
    """Of the track's coordinates and of what they do to the bodies, against differences."""
    simulation = Simulation(on(WHOLE, duration=0.05, irregular=True))
    for _ in simulation.steps():
        pass
    system, state = simulation.system, simulation.state
    system.rates(state.time, state.values)
    matrix, inputs = system.derivatives(state.values, range(4))
    n, nv = system.count, system.model.nv
    own = np.r_[n : 2 * n]

    def rates_at(values):
        return system.rates(state.time, values).values

    scale = np.abs(matrix[own]).max(axis=1)
    for column in [*range(nv, n, 3), *range(n + nv, 2 * n, 3), *system.vehicle.carriers[0, 1:3]]:
        step = 1e-8 if column < n else 1e-5
        moved = state.values.copy()
        moved[column] += step
        high = rates_at(moved)
        moved[column] -= 2 * step
        found = (high - rates_at(moved))[own] / (2 * step)
        size = np.abs(matrix[own, column]).max()
        assert size > 0
        off = np.abs(found - matrix[own, column]) / np.maximum(size, 1e-3 * scale)
        assert off.max() < 0.02, (column, off.argmax(), off.max())
    # a rail that is lifted by the record or by its own coordinate presses alike, but for the pad
    k, m = WHOLE.pad_stiffness[1], WHOLE.rail_mass
    assert matrix[n + nv + 1, nv + 1] == pytest.approx(inputs[n + nv + 1, 1] - k / m, rel=1e-9)


def soft(given):
    """Nothing above the wheelsets takes part, as the formula assumes."""
    elements = []
    for one in given.vehicle.element:
        changes = {"primary springs": {"stiffness": [*one.stiffness[:2], 1e4]}}
        changes["primary vertical dampers"] = {"damping": [*one.damping[:2], 1e-3]}
        elements.append(one.model_copy(update=changes.get(one.name, {})))
    return replace(given, vehicle=given.vehicle.model_copy(update={"element": elements}))


def jenkins(angle, speed, unsprung):
    """N, P2 - P0 of Jenkins et al. 1974."""
    both = unsprung + MASS
    lost = math.pi * DAMPING / (4 * math.sqrt(STIFFNESS * both))
    return angle * speed * math.sqrt(unsprung / both) * (1 - lost) * math.sqrt(STIFFNESS * unsprung)


@pytest.mark.parametrize(("angle", "speed"), [(0.01, 40.0), (0.02, 30.0)])
def test_dipped_joint(angle, speed):
    """Both forces of a dipped joint. P1 and the force on the pad against the same masses integrated
    by themselves on the contact's law of force over depth: 2 %, which is left of time steps of 60
    us. The pad spring's peak against the formula of P2, which is of the first order in damping (the
    damped oscillation itself is 2.5 % above it) and has a rigid contact, whose P1 rings on in the
    peak: 8 %."""
    length, start = 4.0, 21.56
    dip = DipTable(position=start + 0.5 + 0.5 * length, angle=angle, length=length)
    duration = (0.5 * length + 0.55) / speed + 0.012
    given = on(ONE, speed=speed, duration=duration, step=6e-5, log_every=1)
    simulation = Simulation(soft(replace(given, dip=(dip,))))
    rows = []
    for state in simulation.steps():
        spring = STIFFNESS * simulation.system.support.place[0, 1]
        load = -simulation.element.wheels[0, 0, 2]
        rows.append([state.time, simulation.system.positions[0], load, spring])
    time, position, load, spring = np.array(rows).T
    before = position < dip.position - 0.03
    peaks = load.max() - load[before][-1], spring.max() - spring[before][-1]

    vehicle = simulation.scene.vehicle
    unsprung = 0.5 * vehicle.wheelset[0].mass_on_rails
    wanted = by_itself(simulation.scene, dip, time[-1], unsprung, load[0], start)
    assert peaks[0] == pytest.approx(wanted[0], rel=0.02)
    assert peaks[1] == pytest.approx(wanted[1], rel=0.02)
    assert peaks[1] == pytest.approx(jenkins(angle, speed, unsprung), rel=0.08)


def by_itself(scene, dip, end, unsprung, static, start):
    """N, greatest contact and spring force above those before the joint: two masses."""
    case = scene.at_height().case.model_dump()
    case["wheelset"]["pitch_rate"] = -scene.speed / case["wheelset"]["nominal_radius"]
    contact = Contact(case)
    depths = np.linspace(1.5e-4, 6e-4, 91)
    forces = np.array([-contact.step(z=float(z))["left"]["force"][2] for z in depths])
    assert forces[0] == 0

    def rates(t, y):
        down = dip_at(dip, np.array([start + scene.speed * t]))[0]
        force = np.interp(y[0] - y[1] - down, depths, forces)
        rail = force - STIFFNESS * y[1] - DAMPING * y[3]
        return [y[2], y[3], (static - force) / unsprung, rail / MASS]

    rest = static / STIFFNESS
    first = [rest + np.interp(static, forces, depths), rest, 0.0, 0.0]
    found = solve_ivp(rates, (0, end), first, max_step=4e-5, rtol=1e-7, atol=1e-10)
    s = start + scene.speed * found.t
    down = found.y[0] - found.y[1] - dip_at(dip, s)
    load, spring = np.interp(down, depths, forces), STIFFNESS * found.y[1]
    at = np.flatnonzero(s < dip.position - 0.03)[-1]
    return load.max() - load[at], spring.max() - spring[at]


def test_shape_of_a_dip():
    """Depth angle length/8 less the corner's angle corner/8, slopes of half the angle beside it,
    level where it ends, on the rail that has it. Where the curvature jumps a C2 spline is beyond
    the slope by some hundredth of it."""
    dip = DipTable(position=60.0, angle=0.01, length=2.0, corner=0.04, rails="right")
    rails = deviations_of(None, (dip,), 200.0, 20.0)
    assert rails is not None
    s = np.linspace(58.0, 62.0, 40001)
    found, slope = rails.both(s)
    assert not found[:, 0].any()
    assert not found[:, :, 0].any()
    np.testing.assert_allclose(found[:, 1, 1], dip_at(dip, s), atol=2e-7)
    assert found[:, 1, 1].max() == pytest.approx(0.01 * 2 / 8 - 0.01 * 0.04 / 8, abs=1e-7)
    change = slope[:, 1, 1].min() - slope[:, 1, 1].max()
    assert -change == pytest.approx(0.01 * (1 - 0.02), rel=0.015)
    assert np.abs(rails.at(np.array([0.0, 30.0, 58.9, 150.0]))).max() < 1e-8


def test_logs_pages_and_summaries_show_it(tmp_path):
    """Channels, report, summary; and a run on rigid ground has none of them."""
    given = on(WHOLE, duration=0.1, irregular=True)
    simulation = Simulation(given)
    trace = run_vehicle(simulation, None, tmp_path / "run.mcap")
    summary = summarise(trace, simulation)
    run = read_run(tmp_path / "run.mcap")
    for number in range(1, 5):
        below = run[f"/wheelset/{number}/support"]
        moved = [run[f"/wheelset/{number}/{s}/contact"]["rail_deflection"] for s in SIDES]
        rates = [run[f"/wheelset/{number}/{s}/contact"]["rail_deflection_rate"] for s in SIDES]
        # the pad's law, from what is logged
        for k, side in enumerate(SIDES):
            sleeper = below["sleeper"][:, 1] + (-0.75, 0.75)[k] * below["sleeper"][:, 2]
            length = moved[k][:, 1] - sleeper
            spring = WHOLE.pad_stiffness[1] * length
            off = below[f"{side}_pad_force"][:, 1] - spring
            # what is left is the damper's, by rates of rail and sleeper
            assert np.abs(off).max() < WHOLE.pad_damping[1] * 2 * np.abs(rates[k][:, 1]).max()
        assert below["left_ballast_force"].shape == (len(below), 2)
    assert summary.support is not None
    down = max(
        np.abs(run[f"/wheelset/{n}/{s}/contact"]["rail_deflection"][:, 1]).max()
        for n in range(1, 5)
        for s in SIDES
    )
    assert down <= summary.support["rail_deflection"]["vertical"] < 1.5 * down
    assert "pad" in summary.text()
    write_report(tmp_path / "run.mcap", tmp_path / "run.html")
    assert "Track below the rails" in (tmp_path / "run.html").read_text(encoding="utf-8")
    rigid = Simulation(scenes.scene(duration=0.01))
    trace = run_vehicle(rigid, None, tmp_path / "rigid.mcap")
    assert summarise(trace, rigid).support is None
    assert not len(read_run(tmp_path / "rigid.mcap")["/wheelset/1/support"])


def test_tables_are_read_and_refused(tmp_path):
    text = load_vehicle_scene().text.decode()
    good = """
[support]
rail_mass = 60.0
pad_stiffness = [30e6, 120e6]

[[dip]]
position = 60.0
angle = 0.01
"""
    path = tmp_path / "scene.toml"
    path.write_text(text + good, encoding="utf-8")
    scene = load_vehicle_scene(path)
    assert scene.support is not None
    assert scene.support.rail_mass == 60.0
    assert [dip.angle for dip in scene.dip] == [0.01]
    for old, new, message in (
        ("60.0\npad", "0.0\npad", "support.rail_mass"),
        ("[[dip]]", "sleeper_mass = 300.0\n[[dip]]", "support.sleeper_inertia"),
        ("[[dip]]", "ballast_damping = [1e3, 1e3]\n[[dip]]", "support.ballast_damping"),
        ("position = 60.0", "position = 22.0", r"dip\[0\].position"),
        ("angle = 0.01", "angle = 0.01\ncorner = 0.9", r"dip\[0\].corner"),
        ("[support]", "[track.rail_support]\nstiffness = [1e7, 1e7]\n[support]", "rail_support"),
    ):
        path.write_text(text + good.replace(old, new), encoding="utf-8")
        with pytest.raises(CaseError, match=message):
            load_vehicle_scene(path)


def test_steps_that_are_too_long_are_told():
    """A joint's corner needs a step on it; an open balance of a tenth of the loss is told."""
    scene = scenes.scene()
    way = scene.speed * scene.run.step
    sharp = replace(scene, dip=(DipTable(position=10.0, angle=0.01, corner=0.9 * way),))
    even = replace(scene, dip=(DipTable(position=10.0, angle=0.01, corner=1.1 * way),))
    assert "dip[0].corner" in step_doubts(sharp, 0.0, 0.0)[0]
    assert step_doubts(even, 0.0, 0.0) == []
    assert "open by 834 J where 1.57e+03 J were lost" in step_doubts(even, 834.0, 1570.0)[0]
    assert step_doubts(even, 49.0, 0.0) == step_doubts(even, 90.0, 1570.0) == []
