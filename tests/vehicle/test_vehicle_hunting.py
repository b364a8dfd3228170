"""Critical speeds of vehicles: against equations written for this test alone, and against runs.

A bogie of two wheelsets without axle boxes, cones on crowns, creep forces linear. Lateral
equations in the manner of Wickens (Fundamentals of Rail Vehicle Dynamics, 2003): of each wheelset y
and psi as tests/wheelset/test_textbook.py derives them, of the frame y, psi and its roll phi, with
springs at the axles' height and at the frame's centre:

    d_y = y_k - y_f -+ b psi_f     2 k_y each,      d_psi = psi_k - psi_f    2 k_x a^2 each,
    d_phi = p y_k - phi_f          2 k_z a^2 each,

with the wheelset's roll p = g / (e - g r) of y and the conicity g (1 + (R + r) p) of cones on
crowns of radius R (Wickens).

What textbooks leave out and whole contacts have: the lateral forces of spin, f23 g/r outward on
either wheel, go with the load, so that of loads that differ by D a force h D is left, h = f23 g /
(r N). From lateral motion and roll of the wheelset

    e D = -r (m y'' - Y) + I p y'' + M,

Y and M the suspension's lateral force on it and moment about x.
"""

from __future__ import annotations

import json
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import railpatch
import vehicle_parts as parts
from click.testing import CliRunner
from railpatch.command.cli import cli
from railpatch.errors import CaseError
from scipy.optimize import brentq

from wheelset_demo.hunting import Mode, Search, waves_in
from wheelset_demo.hunting_command import found_by, text_of
from wheelset_demo.scene import GRAVITY, scene_file
from wheelset_demo.vehicle import Simulation, load_vehicle_scene
from wheelset_demo.vehicle.alignment import AlignmentTable
from wheelset_demo.vehicle.deviations import DipTable
from wheelset_demo.vehicle.hunting import (
    ACCEPTED,
    Linearised,
    left_out,
    search_vehicle,
    straight,
    vehicle_mode,
)
from wheelset_demo.vehicle.wet_track import WetTable

SLOPE, CROWN, ARM, BASE = 1 / 20, 0.3, 1.0, 1.25
STIFFNESS, DAMPING = [6e5, 9e5, 1e6], [4e3, 3e3, 2e4]
FRAME, WHEELSET = parts.BODY, parts.WHEELSET
LOAD = GRAVITY * (WHEELSET["mass"] + FRAME["mass"] / 2)


def bogie(folder, places=(BASE, -BASE), **method):
    """Its scene."""
    vehicle = parts.bogie(places)
    vehicle["body"][0]["position"] = [0.0, 0.0, parts.RADIUS]
    vehicle["element"][0] |= {"stiffness": STIFFNESS, "damping": DAMPING}
    scene = parts.load(folder, vehicle)
    names = {"wheel": "cone@1:20", "rail": "arc@0.3"}
    profiles = scene.case.profiles.model_copy(update=names)
    scene = replace(scene, case=scene.case.model_copy(update={"profiles": profiles}))
    return scene.with_method(**{"tangential": "linear", **method})


def creep_coefficients(radius: float) -> tuple[float, ...]:
    """f11, f22 (N), f23 (N m), f33 (N m^2) of one wheel: Hertz's ellipse, Kalker's coefficients."""
    small = 1e-7

    def forces(creepage: list[float], spin: float) -> np.ndarray:
        motion: dict[str, Any] = {"creepage": creepage, "spin_creepage": spin}
        result = railpatch.solve(
            {
                "kind": "patch",
                "material": {"shear_modulus": 82e9, "poisson_ratio": 0.28},
                "geometry": {"curvatures": [0.5 / radius, 0.5 / CROWN]},
                "load": {"normal_force": LOAD / 2},
                "motion": {"regime": "steady_rolling", "rolling_speed": 10.0, **motion},
                "friction": {"coefficient": 0.3},
                "method": {"normal": "hertz", "tangential": "linear"},
            }
        )
        return np.array([*result["creep_force"], result["spin_moment"]]) / -small

    along, across, spin = forces([small, 0], 0), forces([0, small], 0), forces([0, 0], small)
    return along[0], across[1], spin[1], spin[2]


def textbook(speed: float, radius: float, half: float, creep: tuple[float, ...]) -> np.ndarray:
    """[14, 14], of y, psi of wheelsets 1 and 2, y, psi, phi of the frame, and of their rates."""
    f11, f22, f23, f33 = creep
    roll = SLOPE / (half - SLOPE * radius)
    s, conicity = 1 + roll * radius, SLOPE * (1 + (CROWN + radius) * roll)
    spin = roll * WHEELSET["inertia"][1] * speed / radius
    damping = np.array(
        [
            [2 * f22 * s**2 / speed, 2 * f23 * s / speed - spin],
            [spin - 2 * f23 * s / speed, 2 * (f11 * half**2 + f33) / speed],
        ]
    )
    stiffness = np.array(
        [
            [LOAD * roll * (1 + CROWN * roll) - 2 * f23 * s * roll / radius, -2 * f22 * s],
            [
                2 * (f11 * half * conicity - f33 * roll) / radius,
                -LOAD * SLOPE * half + 2 * f23,
            ],
        ]
    )
    mass, (about, *_) = WHEELSET["mass"], WHEELSET["inertia"]
    spinning = s * f23 * SLOPE / (radius * LOAD / 2) / half
    masses = [mass + about * roll**2, about] * 2
    masses[0::2] = [m + spinning * (radius * mass - about * roll) for m in masses[0::2]]
    masses += [FRAME["mass"], FRAME["inertia"][2], FRAME["inertia"][0]]
    k, c = np.zeros((7, 7)), np.zeros((7, 7))
    for first, place in ((0, BASE), (2, -BASE)):
        own = slice(first, first + 2)
        k[own, own] += stiffness
        c[own, own] += damping
        lateral, yaw, rolling = np.zeros((3, 7))
        lateral[[first, 4, 5]] = 1.0, -1.0, -place
        yaw[[first + 1, 5]] = 1.0, -1.0
        rolling[[first, 6]] = roll, -1.0
        for row, axis, lever in ((lateral, 1, 1.0), (yaw, 0, ARM), (rolling, 2, ARM)):
            k += 2 * STIFFNESS[axis] * lever**2 * np.outer(row, row)
            c += 2 * DAMPING[axis] * lever**2 * np.outer(row, row)
            share = {1: radius, 0: 0.0, 2: -1.0}[axis] * spinning
            k[first] += share * 2 * STIFFNESS[axis] * lever**2 * row
            c[first] += share * 2 * DAMPING[axis] * lever**2 * row
    lower = -np.hstack([k, c]) / np.array(masses)[:, None]
    return np.vstack([np.hstack([np.zeros((7, 7)), np.eye(7)]), lower])


@pytest.fixture(scope="module")
def places(tmp_path_factory) -> tuple[float, float]:
    """m: rolling radius and half the distance of the contacts, straight on."""
    found = Linearised(straight(bogie(tmp_path_factory.mktemp("places")), 20.0))
    assert found.values.size == 36
    wheel = found.system.element.result(0)["right"]
    (patch,) = wheel["patches"]
    return wheel["rolling_radius"], patch["position"][1]


def slowest(speed: float, places: tuple[float, float]) -> complex:
    values = np.linalg.eigvals(textbook(speed, *places, creep_coefficients(places[0])))
    waves = values[values.imag > 0.1]
    return waves[np.argmax(waves.real)]


def test_critical_speed_of_a_bogie(tmp_path, places, measured):
    """Within 0.5 %, and so its frequency and the growth at other speeds."""
    scene = bogie(tmp_path)
    mode = search_vehicle(scene, 10.0, 120.0).critical
    assert mode is not None
    speed = brentq(lambda v: slowest(v, places).real, 10.0, 120.0)
    frequency = slowest(speed, places).imag / (2 * np.pi)
    measured(
        f"critical speed of a bogie, own equations: {speed:.3f} m/s, {frequency:.3f} Hz; here "
        f"{mode.speed:.3f} m/s ({100 * (mode.speed / speed - 1):+.2f} %), {mode.frequency:.3f} Hz"
    )
    assert mode.speed == pytest.approx(speed, rel=5e-3)
    assert mode.frequency == pytest.approx(frequency, rel=5e-3)
    for part in (0.7, 1.3):
        own, found = slowest(part * speed, places), vehicle_mode(scene, part * speed)
        assert found.growth == pytest.approx(own.real, rel=0.03)
        assert (found.growth > 0) == (part > 1)


@pytest.mark.parametrize("part", [0.8, 1.3])
def test_runs_in_time_grow_as_eigenvalues_say(tmp_path, part):
    """A bogie pushed aside by 0.1 mm: growth and frequency of its waves, of crests after the first
    two waves."""
    scene = bogie(tmp_path)
    speed = part * search_vehicle(scene, 10.0, 120.0).critical.speed
    mode = vehicle_mode(scene, speed)
    given = straight(scene, speed).with_run(duration=7.0 / mode.frequency, log_every=5)
    simulation = Simulation(given)
    state = simulation.state
    lateral = [*simulation.system.vehicle.carriers[:, 1], simulation.system.vehicle.columns[0][1]]
    state.values[lateral] += 1e-4
    simulation.solve_again()
    times, y = [], []
    for state in simulation.steps():
        times.append(state.time)
        y.append(simulation.element.states[1, 1])
    growth, frequency = waves_in(np.array(times), np.array(y), 2.0 / mode.frequency)
    assert frequency == pytest.approx(mode.frequency, rel=0.01)
    assert growth == pytest.approx(mode.growth, abs=0.03 * 2 * np.pi * mode.frequency)
    assert (growth > 0) == (part > 1)


def test_sliders_that_stick_are_springs_and_those_that_slip_are_none(tmp_path):
    """The slowest wave of a bogie with sliders that stick is that of springs in their place, with
    sliders that slip that of none."""
    more = [0.0, 4e5, 0.0]

    def growth(slip: bool = False, **keys: Any) -> complex:
        scene = bogie(tmp_path)
        element = scene.vehicle.element[0].model_copy(update=keys)
        vehicle = scene.vehicle.model_copy(update={"element": [element]})
        mode = vehicle_mode(replace(scene, vehicle=vehicle), 40.0, slip)
        return complex(mode.growth, mode.frequency)

    sliders = {"friction_stiffness": more, "friction_force": [0.0, 1e3, 0.0]}
    stiffer = [a + b for a, b in zip(STIFFNESS, more, strict=True)]
    assert growth(**sliders) == pytest.approx(growth(stiffness=stiffer), rel=1e-6)
    assert growth(slip=True, **sliders) == pytest.approx(growth(), rel=1e-6)
    assert abs(growth(**sliders) - growth()) > 1e-3


def test_a_vehicle_that_hunts_from_the_command_line(tmp_path):
    """JSON and text, of the same bogie's file; what belongs to other scenes is refused."""
    bogie(tmp_path)
    file = tmp_path / "vehicle.toml"
    text = file.read_text(encoding="utf-8")
    for old, new in (
        ('"polach"', '"linear"'),
        ('wheel = "S1002"', 'wheel = "cone@1:20"'),
        ('rail = "UIC60@1:40"', 'rail = "arc@0.3"'),
    ):
        assert old in text
        text = text.replace(old, new)
    file.write_text(text, encoding="utf-8")
    done = CliRunner().invoke(cli, ["hunting", str(file), "--lowest", "20", "--json"])
    assert done.exit_code == 0, done.output
    found = json.loads(done.output)
    mode = search_vehicle(load_vehicle_scene(file), 20.0, 150.0).critical
    assert (mode.speed, mode.frequency) == (found["critical_speed"], found["frequency"])
    assert set(found["moves"]) == {"frame", "wheelset_1", "wheelset_2"}
    assert max(found["moves"].values()) == 1.0
    done = CliRunner().invoke(cli, ["hunting", str(file), "--lowest", "20"])
    assert "critical speed" in done.output
    assert "moves" in done.output
    for option in (["--simulate"], ["-o", str(tmp_path / "x.mcap")]):
        done = CliRunner().invoke(cli, ["hunting", str(file), *option])
        assert done.exit_code == 2
        assert "allowed with a scene of railpatch wheelset" in done.output
    assert CliRunner().invoke(cli, ["hunting", "--slip"]).exit_code == 2


def test_what_a_search_leaves_out_is_said():
    """A curve, irregularities and dips are named; what the contact itself would meet is refused."""
    scene = load_vehicle_scene(scene_file("vehicle_curve.toml"))
    assert left_out(replace(scene, alignment=AlignmentTable(), irregularity=None)) == []
    dip = DipTable(position=60.0, angle=0.01)
    assert left_out(replace(scene, dip=(dip,))) == ["alignment", "irregularity", "dip"]
    found = found_by("x", Search(None, Mode(1.0, -1.0, 1.0, np.ones(1)), None), 1.0, 2.0)
    text = text_of({**found, "growth": [], "left_out": ["alignment", "dip"]})
    assert "left out        alignment, dip: straight, level, undriven" in text
    wet = WetTable(position=60.0, length=10.0, water_rate=1e-6)
    with pytest.raises(CaseError, match=r"^wet: given, allowed to be left out: the search"):
        vehicle_mode(replace(scene, wet=(wet,)), 20.0)
    friction = scene.case.friction.model_copy(update={"along_track": [[0.0, 0.5], [9.0, 1.0]]})
    case = scene.case.model_copy(update={"friction": friction})
    with pytest.raises(CaseError, match=r"^friction.along_track: given, allowed to be left out"):
        vehicle_mode(replace(scene, case=case), 20.0)


def test_a_heavy_wagon_with_sliders_stands_straight():
    """Newton's steps are small there, as sliders let go after each."""
    scene = load_vehicle_scene(scene_file("freight_wagon.toml"))
    linear = Linearised(straight(scene, 20.0))
    values, system = linear.values, linear.system
    rates = system.rates(0.0, values).values
    assert np.abs(rates[system.count : 2 * system.count]).max() < ACCEPTED
