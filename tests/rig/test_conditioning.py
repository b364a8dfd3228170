"""Friction that conditions: closed forms of its strips, and its part in the rig's balance."""

from __future__ import annotations

import pickle

import numpy as np
import pytest
from railpatch.errors import CaseError
from railpatch.log import read_run

from rig_model.balance import Balancer
from rig_model.conditioning import Band, Conditioning, Load, Pose, load_over
from rig_model.run import replay
from rig_model.scene import load_rig_scene
from rig_model.tables import ConditioningTable

WORK, BIN = 1e6, 1e-3
LOAD = Load(3, np.array([0.25, 0.25, 0.25, 0.25]), 800.0)
SIDES = ("left", "right")
CONE = 1 / 20


def table(**keys):
    return ConditioningTable(plateau=1.5, work=WORK, bin=BIN, **keys)


def scene_of(path, positions=9, **overrides):
    return load_rig_scene(path, {"positions": positions} | overrides)


def solved(scene):
    balancer = Balancer(scene)
    return [balancer.solve(position) for position in scene.positions()]


def test_constant_work_is_an_exponential():
    """Over n strips P t/(n b) for each metre: 1 - exp(-P t/(n b w0)), in any number of steps."""
    conditioning = Conditioning(table())
    for time in (0.0, 1.0, 4.0, 9.0):
        state = conditioning.moved(dict.fromkeys(SIDES, LOAD), time)["left"]
    expected = 1 - np.exp(-800.0 * 9.0 / (4 * BIN * WORK))
    assert state.conditioning == pytest.approx(expected, rel=1e-12)
    assert state.factor == pytest.approx(1 + 0.5 * expected, rel=1e-12)
    assert state.work == pytest.approx(7200.0, rel=1e-12)
    np.testing.assert_allclose(state.position, BIN * np.array([3.5, 4.5, 5.5, 6.5]))


@pytest.mark.parametrize(("key", "constant"), [("recovery_time", 2.0), ("recovery_work", 1600.0)])
def test_what_is_left_recovers(key, constant):
    """By exp(-t/t0), or by the wheel's work beside it over W0: 800 W for 3 s are 2400 J."""
    conditioning = Conditioning(table(**{key: constant}))
    band = conditioning.worn(Band(), LOAD, 5.0)
    before = band.over(3, 4)
    after = conditioning.worn(band, Load(20, LOAD.shares, LOAD.power), 3.0).over(3, 4)
    lost = 3.0 / constant if key == "recovery_time" else 2400.0 / constant
    np.testing.assert_allclose(after, before * np.exp(-lost), rtol=1e-12)


def test_load_lies_where_the_pressure_is():
    """4 mm of pressure 1 and 4 mm of pressure 3 about 750 mm, on strips of 4 mm from 744 mm."""
    y = (np.arange(32) - 15.5) * 2.5e-4
    pressure = np.where(y[:, None] < 0, 1.0, 3.0) * np.ones((32, 5))
    patch = {"x": np.arange(5.0), "y": y, "pressure": pressure, "position": [0.0, 0.75, 0.0]}
    patch |= {"contact_angle": 0.0, "share": 1.0, "normal_force": 5e4}
    wheel = {"patches": [patch], "alternatives": []}
    wheel |= {"friction_power": 7.0, "plastic_power": float("nan")}
    pose = Pose((0.0, 0.0, 0.0), 0.0, 0.0, 0.0)
    for body in ("wheel", "roller"):
        load = load_over(wheel, pose, 4e-3, body)
        assert (load.first, load.power) == (186, 7.0)
        # 2 mm of a quarter, the rest of it with 2 mm of three quarters, and the rest
        np.testing.assert_allclose(load.shares, [0.125, 0.5, 0.375], rtol=1e-9)


def test_no_change_is_the_plain_balance(scene_with):
    plain = solved(scene_of(scene_with(), 5))
    alike = solved(scene_of(scene_with(end="\n[rig.conditioning]\nplateau = 1.0\nwork = 1e7\n"), 5))
    for a, b in zip(plain, alike, strict=True):
        assert (a.evaluations, a.status) == (b.evaluations, b.status)
        assert b.z == pytest.approx(a.z, abs=1e-12)
        np.testing.assert_allclose(b.result["force"], a.result["force"], atol=1e-3)
        assert b.result["axle_torque"] == pytest.approx(a.result["axle_torque"], abs=1e-3)


def there_and_back(scene_with, plateau, more="", **overrides):
    """12, 18 and 12 mrad at one place."""
    path = scene_with(end=f"{more}\n[rig.conditioning]\nplateau = {plateau}\nwork = 2e6\n")
    overrides |= {"yaw": [[0, 0.012], [0.5, 0.018], [1, 0.012]]}
    overrides |= {"lateral_position": [[0, 0], [1, 0]]}
    return solved(scene_of(path, 3, **overrides))


def test_rising_friction_gives_more_on_the_way_back_and_falling_less(scene_with):
    """T/N changes by the factor at most; L/V is less by up to the contact angle, 1:20."""
    up, top, back = (lateral_share(b) for b in there_and_back(scene_with, 1.3))
    assert up == pytest.approx(lateral_share(there_and_back(scene_with, 1.0)[0]), rel=1e-4)
    assert 1.02 * abs(up) < abs(back) < 1.3 * (abs(up) + CONE) - CONE
    assert abs(top) < 0.52 * 1.3
    up, _, back = (lateral_share(b) for b in there_and_back(scene_with, 0.8))
    assert 0.8 * (abs(up) + CONE) - CONE < abs(back) < 0.98 * abs(up)


def test_both_methods_agree_with_a_frame(scene_with):
    """Residuals are below 5e-5 of the load, and L/V changes by 1.3 times as much at most."""
    frame = "\n[rig.frame]\nstiffness = 20e6\n"
    ways = (
        there_and_back(scene_with, 1.3, frame, **{"balance.method": method})
        for method in ("broyden", "newton")
    )
    for a, b in zip(*ways, strict=True):
        assert a.converged
        assert b.converged
        assert lateral_share(a) == pytest.approx(lateral_share(b), abs=5e-4)
        for side in SIDES:
            one, other = a.conditioning[side], b.conditioning[side]
            assert one.factor == pytest.approx(other.factor, abs=5e-4)


def lateral_share(balance):
    """L/V of the right wheel."""
    force = balance.result["right"]["force"]
    return force[1] / force[2]


def test_copies_go_on_with_the_same_bits(scene_with):
    end = "\n[rig.frame]\nstiffness = 20e6\nfriction = [[10e6, 5e3]]\n"
    end += "\n[rig.conditioning]\nplateau = 1.3\nwork = 2e6\nrecovery_time = 100\n"
    scene = scene_of(scene_with(end=end), 5)
    balancer = Balancer(scene)
    first, rest = scene.positions()[:2], scene.positions()[2:]
    for position in first:
        balancer.solve(position)
    again = pickle.loads(pickle.dumps(balancer))
    for position in rest:
        a, b = balancer.solve(position), again.solve(position)
        assert (a.z, a.y, a.roll, a.pitch_rate) == (b.z, b.y, b.roll, b.pitch_rate)
        assert a.conditioning == b.conditioning
        assert a.frame == b.frame
        assert a.result["force"] == b.result["force"]


def test_log_and_its_absence(scene_with, tmp_path):
    end = "\n[rig.conditioning]\nplateau = 1.3\nwork = 2e6\nbody = 'roller'\n"
    for name, text in (("with", end), ("without", "")):
        replay(scene_of(scene_with(end=text), 3, snapshot_every=2), tmp_path / f"{name}.mcap")
    run = read_run(tmp_path / "with.mcap")
    for side in SIDES:
        logged = run[f"/{side}/conditioning"]
        assert len(logged) == 3
        assert logged["factor"][0] == 1.0
        last = logged.messages[-1]
        strips = np.array(last["conditioned"])
        assert len(last["position"]) == len(strips) > 10
        assert 0 <= strips.min() < strips.max() <= 1
        assert not logged.messages[1]["position"]
        # the work of half of each interval at either end's power
        work = np.trapezoid(logged["power"], logged.time)
        assert last["work"] == pytest.approx(work, rel=1e-9)
    assert "/left/conditioning" not in read_run(tmp_path / "without.mcap").counts


LAYER = """[layer]
shear_modulus = 8.2e9                # Pa
thickness = 5e-5                     # m
"""
ALONG = "coefficient = 0.52\nalong_track = [[0, 1], [1, 1]]"


@pytest.mark.parametrize(
    ("change", "text"),
    [
        (("coefficient = 0.52", ALONG), "friction.along_track: value is given"),
        ((LAYER, "[method]\nnormal = 'hertz'\ntangential = 'polach'\n"), "'polach'"),
    ],
)
def test_refused_by_name(scene_with, change, text):
    path = scene_with(change, end="\n[rig.conditioning]\nplateau = 1.3\nwork = 2e6\n")
    with pytest.raises(CaseError, match=text):
        load_rig_scene(path)


@pytest.mark.parametrize(
    "keys",
    ["plateau = -0.1\nwork = 1e6", "plateau = 1.2\nwork = 0.0", "plateau = 1.2", "work = 1e6"],
)
def test_ranges(scene_with, keys):
    with pytest.raises(CaseError, match=r"rig\.conditioning\.(plateau|work): value is"):
        load_rig_scene(scene_with(end=f"\n[rig.conditioning]\n{keys}\n"))
