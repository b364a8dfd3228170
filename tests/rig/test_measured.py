"""Records of measured runs as programmes: what they drive, what is kept beside, what is refused."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from railpatch.command.cli import cli
from railpatch.errors import CaseError
from railpatch.log import read_run

from rig_model.balance import Balancer
from rig_model.run import replay
from rig_model.scene import RigScene, load_rig_scene

# s, mrad, mm, kN, m/s
TIME = np.array([0.0, 1.0, 2.5, 3.0, 4.0])
YAW = np.array([0.0, 2.0, 5.0, 4.0, -1.0])
LATERAL = np.array([0.3, 0.6, 1.2, 1.0, 0.0])
LOAD = np.array([134.0, 120.0, 150.0, 134.0, 90.0])
SPEED = np.array([4.4704, 8.0, 2.0, 4.4704, 1.0])
GIVEN = """
[rig.columns]
time = { name = "t" }
yaw = { name = "AoA", sign = -1 }
lateral_position = { name = "y", factor = 10.0 }
"""
ROWS = "yaw = [[0, 0.0], [1, 0.01]]\nlateral_position = [[0, 0.0], [1, 1e-3]]\n"


@pytest.fixture
def rig(tmp_path: Path, nominal_file: Path) -> Callable[..., Path]:
    """The nominal scene with a table [rig] of its own beside a record."""

    def write(table: str, record: str) -> Path:
        text = nominal_file.read_text()
        path = tmp_path / "scene.toml"
        path.write_text(text[: text.index("[rig]")] + '[rig]\nrecord = "run.csv"\n' + table)
        (tmp_path / "run.csv").write_text(record)
        return path

    return write


def rows(*columns: np.ndarray, head: str) -> str:
    """A record; semicolons and decimal commas."""
    lines = [";".join(f"{value:.12g}" for value in row) for row in zip(*columns, strict=True)]
    return head + "\n" + "\n".join(lines).replace(".", ",").replace("nan", "") + "\n"


def stranger(**changed: np.ndarray) -> str:
    """In degrees to the other side, in cm."""
    given = {"t": TIME, "AoA": -np.degrees(1e-3 * YAW), "y": 0.1 * LATERAL} | changed
    return rows(*given.values(), head="t [min];AoA [deg];y [mm]" + ";x" * (len(given) - 3))


def forces(scene: RigScene) -> tuple[np.ndarray, list]:
    """N, of both wheels at each position, [n, 2, 3], and the balances."""
    balancer = Balancer(scene)
    found = [balancer.solve(position) for position in scene.positions()]
    assert all(balance.converged for balance in found)
    wheels = [[b.result[side]["force"] for side in ("left", "right")] for b in found]
    return np.array(wheels), found


def test_a_record_is_the_programme(rig):
    """In other units, with other signs, it gives the positions that the same rows in SI give."""
    scene = load_rig_scene(rig(GIVEN, stranger(t=TIME / 60 + 7.0)))
    found = scene.positions()
    np.testing.assert_allclose([p.time for p in found], TIME, atol=1e-9)
    np.testing.assert_allclose([p.progress for p in found], TIME / 4, atol=1e-9)
    np.testing.assert_allclose([p.yaw for p in found], 1e-3 * YAW, atol=1e-13)
    np.testing.assert_allclose([p.y for p in found], 1e-3 * LATERAL, atol=1e-13)
    assert (scene.count, scene.duration) == (5, pytest.approx(4.0))
    assert found[0].vertical_force is None
    assert scene.doubts == []


def test_positions_and_rate_choose_the_points(rig):
    """Straight lines between rows."""
    path = rig(GIVEN, stranger(t=TIME / 60))
    scene = load_rig_scene(path, {"positions": 9})
    at = np.linspace(0, 4, 9)
    np.testing.assert_allclose(
        [p.yaw for p in scene.positions()], 1e-3 * np.interp(at, TIME, YAW), atol=1e-13
    )
    assert load_rig_scene(path, {"rate": 10.0}).count == 41


@pytest.mark.parametrize(
    ("speed", "unit", "said"),
    [
        (16.0, "m/s", True),  # km/h
        (16.0, "km/h", False),
        (4.4704, "m/s", False),
        (8.0, "m/s", False),
        (10.0, "mph", False),
        (2.0, "m/s", True),
    ],
)
def test_a_speed_that_is_not_the_rollers(rig, speed, unit, said):
    """4.4704 m/s, 10 mph, in the scene."""
    record = rows(TIME, YAW, LATERAL, speed + 0 * TIME, head=f"t [s];AoA [mrad];y [mm];v [{unit}]")
    columns = GIVEN.replace(", factor = 10.0", "") + "speed = { name = 'v' }\n"
    doubts = load_rig_scene(rig(columns, record)).doubts
    assert len(doubts) == said, doubts
    for text in doubts:
        assert text.startswith("speed: its median of ")
        assert "track.roller_pitch_rate times track.roller_radius, 4.47" in text
        assert (speed < 4) or "'km/h'" in text


def test_a_speed_of_turning_that_is_not_the_rollers(rig):
    """5.587 rad/s of the scene are 0.889 Hz, or 53.4 rpm."""
    for unit, said in (("rad/s", 1), ("rpm", 0)):
        head = f"t [s];AoA [mrad];y [mm];w [{unit}]"
        record = rows(TIME, YAW, LATERAL, 53.4 + 0 * TIME, head=head)
        columns = GIVEN.replace(", factor = 10.0", "") + "roller_pitch_rate = { name = 'w' }\n"
        doubts = load_rig_scene(rig(columns, record)).doubts
        assert len(doubts) == said, doubts
        assert not said or "'rpm'" in doubts[0]


def test_what_the_record_lacks_stands_in_rig(rig):
    record = rows(np.array([0.0, 20, 100]), np.array([133.0, 140, 150]), head="done [%];Q [kN]")
    table = (
        f"duration = 50.0\n{ROWS}[rig.columns]\nprogress = {{ name = 'done' }}\n"
        "vertical_load = { name = 'Q' }\n"
    )
    found = load_rig_scene(rig(table, record)).positions()
    assert [p.time for p in found] == [0.0, 10.0, 50.0]
    np.testing.assert_allclose([p.yaw for p in found], [0, 0.002, 0.01])
    assert [p.vertical_force for p in found] == [133e3, 140e3, 150e3]


def test_ends_of_the_axle_give_the_yaw_angle(rig):
    """2 m apart: the left one 10 mm ahead of the middle, the right one behind."""
    record = rows(np.array([0.0, 10]), np.array([0.0, -10]), head="a [mm];b [mm]")
    table = (
        "duration = 5.0\nactuator_distance = 2.0\nlateral_position = [[0, 0.0], [1, 0.0]]\n"
        "[rig.columns]\nactuator_left = { name = 'a' }\nactuator_right = { name = 'b' }\n"
    )
    found = load_rig_scene(rig(table, record)).positions()
    np.testing.assert_allclose([p.yaw for p in found], [0.0, np.arcsin(0.01)], rtol=1e-12)


@pytest.mark.parametrize("method", ["broyden", "newton"])
def test_load_and_speed_vary(rig, method):
    """The wheels carry the load of each row; without speed in the friction law the speed changes
    no force, but the wheelset turns as fast as the rollers drive it."""
    columns = GIVEN + "vertical_load = { name = 'Q' }\n"
    base = {"time": TIME, "AoA": -np.degrees(1e-3 * YAW), "y": 0.1 * LATERAL, "Q": LOAD}
    head = "t [s];AoA [deg];y [mm];Q [kN]"
    steady = load_rig_scene(
        rig(columns, rows(*base.values(), head=head)), {"balance.method": method}
    )
    expected, slow = forces(steady)
    limit = 1.01 * steady.rig.balance.tolerance * steady.vertical_force
    np.testing.assert_allclose(-expected[:, :, 2].sum(axis=1), 1e3 * LOAD, atol=limit)
    record = rows(*base.values(), SPEED, head=head + ";v [m/s]")
    moving = load_rig_scene(
        rig(columns + "speed = { name = 'v' }\n", record), {"balance.method": method}
    )
    found, fast = forces(moving)
    # a moment about the axle of the balance's tolerance is a force of it over the wheel's radius,
    # on either wheel and in either run
    lever = steady.case.wheelset.nominal_radius
    assert np.abs(found - expected).max() < 4 * limit / lever
    factor = SPEED / (steady.roller_rate * steady.case.track.roller_radius)
    ratio = [b.pitch_rate / a.pitch_rate for a, b in zip(slow, fast, strict=True)]
    np.testing.assert_allclose(ratio, factor, rtol=2e-5)
    assert moving.positions()[1].roller_pitch_rate == pytest.approx(8.0 / 0.8001)


def test_the_log_keeps_what_was_measured(rig, tmp_path):
    """Also by the command; the report's page shows it."""
    lateral = np.array([1.0, np.nan, 3.0, 4.0, 5.0])
    columns = GIVEN + "left_lateral = { name = 'x', unit = 'kN', sign = -1 }\n"
    path = rig(columns, stranger(t=TIME / 60, L=lateral))
    log, page = tmp_path / "run.mcap", tmp_path / "run.html"
    done = CliRunner().invoke(cli, ["rig", str(path), "-o", str(log)])
    assert done.exit_code == 0, done.output
    assert "drives        yaw, lateral_position" in done.output
    run = read_run(log)
    measured = run["/rig/measured"]
    np.testing.assert_allclose(measured["left_lateral"], -1e3 * lateral)
    np.testing.assert_allclose(measured["yaw"], 1e-3 * YAW, atol=1e-13)
    assert run.attachments["run.csv"].data == (tmp_path / "run.csv").read_bytes()
    assert CliRunner().invoke(cli, ["report", str(log), "-o", str(page)]).exit_code == 0
    refused = CliRunner().invoke(cli, ["rig", str(path), "-o", str(tmp_path / "run.csv")])
    assert refused.exit_code == 2
    assert "allowed another file than" in refused.output


def test_gaps_of_what_drives_are_bridged_and_told(rig):
    yaw = -np.degrees(1e-3 * YAW)
    yaw[[1, 4]] = np.nan
    scene = load_rig_scene(rig(GIVEN, stranger(t=TIME / 60, AoA=yaw)))
    assert [round(p.time, 9) for p in scene.positions()] == [0.0, 1.0, 2.5, 3.0]
    assert scene.positions()[1].yaw == pytest.approx(1e-3 * 5.0 * 1.0 / 2.5)
    told = "\n".join(scene.doubts)
    assert "rig.columns.yaw: 1 of 4 rows have no value" in told
    assert "over 2.5 s at most" in told
    assert "1 rows at its ends lack yaw or lateral_position" in told


def test_the_filter_of_the_scene(rig):
    """A tenth of a second: rows of 50 Hz with noise that alternates from row to row."""
    time = np.arange(0, 4, 0.02)
    noise = 1.0 * (-1.0) ** np.arange(len(time))
    record = rows(time, time + noise, 0 * time, head="t [s];AoA [mrad];y [mm]")
    plain = GIVEN.replace(", sign = -1", "")
    noisy = load_rig_scene(rig(plain, record)).positions()
    smooth = load_rig_scene(rig("low_pass = 2.0\n" + plain, record)).positions()
    middle = slice(50, 150)
    expected = 1e-3 * time[middle]
    assert np.abs([p.yaw for p in noisy][middle] - expected).max() == pytest.approx(1e-3)
    assert np.abs([p.yaw for p in smooth][middle] - expected).max() < 1e-6


@pytest.mark.parametrize(
    ("table", "words"),
    [
        ("duration = 3.0\n" + GIVEN, ["rig.duration", "3", "the record has a time"]),
        (ROWS + GIVEN, ["rig.yaw", "the record's yaw and [rig]", "rig.lateral_position"]),
        (GIVEN.replace("yaw =", "roll ="), ["rig.yaw", "missing", "a column of the record"]),
        (
            GIVEN.replace("yaw =", "actuator_left =").replace('"AoA"', '"AoA", unit = "um"'),
            ["actuator_left", "given alone"],
        ),
        ("actuator_distance = 2.0\n" + GIVEN, ["rig.actuator_distance", "given"]),
        (GIVEN.replace('"t"', '"tt"'), ["rig.columns.time.name", "'tt'", "did you mean 't'"]),
        (GIVEN.replace("yaw =", "yow ="), ["rig.columns.yow", "did you mean 'yaw'"]),
        (
            GIVEN.replace('time = { name = "t"', 'distance = { name = "t", unit = "m"'),
            ["rig.columns.distance", "time or progress"],
        ),
        (GIVEN.replace('"AoA"', '"AoA", unit = "rad"'), ["'AoA'", "rad", "'deg'"]),
        ("positions = 3\nrate = 2.0\n" + GIVEN, ["'positions', 'rate'", "given with"]),
        ("rate = 1e9\n" + GIVEN, ["rig.rate", "1e+09", "at most"]),
        ("low_pass = 1e3\n" + GIVEN, ["low_pass is 1000 Hz", "at most"]),
    ],
)
def test_wrong_tables(rig, table, words):
    with pytest.raises(CaseError) as caught:
        load_rig_scene(rig(table, stranger(t=TIME / 60)))
    for word in words:
        assert word in str(caught.value)


def test_rows_too_close_for_the_log(rig):
    with pytest.raises(CaseError, match=r"positions come 5e-10 s apart, allowed 1e-08 s or more"):
        load_rig_scene(rig(GIVEN.replace('"t"', '"t", unit = "s"'), stranger(t=1e-9 * TIME)))


def test_keys_that_need_a_record(scene_with):
    for key in ("low_pass = 2.0", "actuator_distance = 2.0", "columns = {}"):
        with pytest.raises(CaseError, match=r"value is given, allowed none without 'record'"):
            load_rig_scene(scene_with(("positions = 37", f"positions = 37\n{key}")))
    with pytest.raises(CaseError, match=r"rig\.duration: value is missing, allowed s, of the run"):
        load_rig_scene(scene_with(("duration = 360.0", "")))
    with pytest.raises(CaseError, match=r"none\.csv: file not found"):
        load_rig_scene(scene_with(("positions = 37", "record = 'none.csv'")))


def test_a_replay_of_exported_results(few, tmp_path, rig):
    """What a run computes, as the record of another one, leaves nothing between both."""
    first = tmp_path / "first.mcap"
    replay(few, first)
    table = read_run(first).table()
    names = {
        "yaw": "/wheelset/state.yaw",
        "lateral_position": "/wheelset/state.y",
        "right_lateral": "/right/contact.force.y",
        "right_vertical": "/right/contact.force.z",
    }
    columns = [table.time, *(table[name].values for name in names.values())]
    text = "\n".join(",".join(map(repr, row.tolist())) for row in np.transpose(columns))
    keys = "\n".join(
        f"{key} = {{ name = '{name} ', sign = {-1 if 'right' in key else 1} }}"
        for key, name in names.items()
    )
    head = ",".join(["time [s]", *(table[name].head for name in names.values())])
    path = rig(f"[rig.columns]\ntime = {{ name = 'time' }}\n{keys}\n", f"{head}\n{text}\n")
    second = tmp_path / "second.mcap"
    assert replay(load_rig_scene(path), second).good
    run = read_run(second)
    computed = -run["/right/contact"]["force"][:, 1]
    np.testing.assert_allclose(run["/rig/measured"]["right_lateral"], computed, rtol=1e-9)
