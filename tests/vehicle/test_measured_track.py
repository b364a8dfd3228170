"""Measured records of the rails: files of many kinds give the same rails, wrong ones are named."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest
import vehicle_scenes as scenes
from click.testing import CliRunner
from railpatch import CaseError
from railpatch.command.cli import cli
from railpatch.log import read_run

from wheelset_demo.vehicle import Simulation, load_vehicle_scene
from wheelset_demo.vehicle.measured_track import MeasuredTrackTable, read_measured

S = np.cumsum(np.random.default_rng(3).uniform(0.2, 0.3, 900))
WAVES = {
    "left_lateral": 2e-3 * np.sin(S / 3.0),
    "right_lateral": 2e-3 * np.sin(S / 3.0 + 0.2),
    "left_vertical": 3e-3 * np.sin(S / 4.0),
    "right_vertical": 3e-3 * np.cos(S / 4.0),
}
ORDER = ("left_lateral", "left_vertical", "right_lateral", "right_vertical")


def written(path, head, columns, separator=",", comma=False):
    rows = [separator.join(f"{value:.9f}" for value in row) for row in np.transpose(columns)]
    text = "\n".join(rows)
    path.write_text(f"{head}\n{text.replace('.', ',') if comma else text}\n", encoding="utf-8")


def read(path, needed=200.0, **keys):
    return read_measured(MeasuredTrackTable(file=path.name, **keys), path.parent, needed)


def wanted():
    return np.stack([WAVES[name] for name in ORDER], axis=1)


def test_left_and_right_in_metres(tmp_path):
    """The columns by their own names and units, uneven rows, from the first row on."""
    path = tmp_path / "track.csv"
    head = "distance [m],left lateral [mm],left vertical [mm],right lateral [mm],right vertical [m]"
    own = [WAVES[name] * (1.0 if name == "right_vertical" else 1e3) for name in ORDER]
    written(path, head, [S, *own])
    found = read(path)
    np.testing.assert_allclose(found.s, S - S[0], atol=2e-9)
    np.testing.assert_allclose(found.deviations, wanted(), atol=1e-9)
    assert found.spacing[1] == pytest.approx(np.diff(S).max(), abs=1e-8)
    # what rows show: waves of twice the widest step, and of the whole length at most
    assert found.waves == pytest.approx((2 * np.diff(S).max(), S[-1] - S[0]), abs=1e-8)
    rails = found.rails(20.0, 30.0, 200.0)
    inside = found.s > 60
    at = rails.at(found.s[inside]).reshape(-1, 4)
    np.testing.assert_allclose(at, wanted()[inside], atol=1e-9)
    assert np.abs(rails.at(np.linspace(0, 17, 9))).max() < 1e-12


def test_decimal_commas_falling_chainage_middle_and_difference(tmp_path):
    """Semicolons, decimal commas, km that fall, gauge and cross level, columns of other names and
    signs: the same rails."""
    path = tmp_path / "mess.csv"
    y = 0.5 * (WAVES["left_lateral"] + WAVES["right_lateral"])
    z = 0.5 * (WAVES["left_vertical"] + WAVES["right_vertical"])
    gauge = WAVES["right_lateral"] - WAVES["left_lateral"]
    cross = WAVES["right_vertical"] - WAVES["left_vertical"]
    columns = [12.0 - S / 1e3, 1e3 * y, -1e3 * z, 1e3 * gauge, 1e3 * cross]
    written(path, "km;align;level up;spur;ueberh", columns, ";", comma=True)
    keys = {
        "distance": {"name": "km", "unit": "km", "sign": -1},
        "lateral": {"name": "align", "unit": "mm"},
        "vertical": {"name": "level up", "unit": "mm", "sign": -1},
        "gauge": {"name": "spur", "unit": "mm"},
        "cross_level": {"name": "ueberh", "unit": "mm"},
    }
    found = read(path, columns=keys)
    np.testing.assert_allclose(found.s, S - S[0], atol=1e-5)
    np.testing.assert_allclose(found.deviations, wanted(), atol=1e-10)
    # another place of the record under the vehicle
    moved = read(path, needed=150.0, columns=keys, origin=-12e3 + S[100])
    assert moved.s[100] == pytest.approx(0.0, abs=1e-5)


def test_filters(tmp_path):
    """A wave inside the band stays, shorter and longer ones are taken away, none is shifted: gains
    of Butterworth filters of order 2 that go forward and back, 1/sqrt(2) at the corner in all."""
    s = np.arange(0.0, 1000.0, 0.25)
    parts = [1e-3 * np.sin(2 * np.pi * s / length) for length in (2.0, 12.0, 300.0)]
    path = tmp_path / "band.csv"
    written(path, "distance [m],vertical [m]", [s, sum(parts)])
    found = read(path, shortest=5.0, longest=60.0)
    assert found.waves == (5.0, 60.0)
    middle = slice(1000, 3000)

    def low(length, corner):
        ratio = np.tan(np.pi * 0.25 / length) / np.tan(np.pi * 0.25 / corner)
        return 1 / (1 + (np.sqrt(2) - 1) * ratio**4)

    gains = [low(length, 5.0) * (1 - low(length, 60.0)) for length in (2.0, 12.0, 300.0)]
    assert gains[1] > 0.98
    assert max(gains[0], gains[2]) < 0.06
    expected = sum(gain * part[middle] for gain, part in zip(gains, parts, strict=True))
    np.testing.assert_allclose(found.deviations[middle, 1], expected, atol=2e-7)
    assert np.abs(found.deviations[middle, 1] - found.deviations[middle, 3]).max() == 0
    assert not found.deviations[:, ::2].any()


@pytest.mark.parametrize(
    ("head", "change", "keys", "message"),
    [
        ("distance,vertical [mm]", {}, {}, "columns.distance.unit: value is missing"),
        ("distance [m],vertical", {}, {}, "columns.vertical.unit: value is missing"),
        ("distance [m],vertical [kN]", {}, {}, "allowed m, mm"),
        ("chainage [m],vertical [mm]", {}, {}, "columns.distance: value is missing"),
        ("distance [m],vertical [m]", {}, {}, "is its unit 'mm'"),
        ("distance [m],left vertical [mm]", {}, {}, "columns.right_vertical: value is missing"),
        ("distance [m],vertical [mm]", {5: ""}, {}, ":7: measured_track.columns.vertical: 1 cells"),
        ("distance [m],vertical [mm]", {5: "abc"}, {}, "value is 'abc'"),
        ("distance [m],vertical [mm]", {}, {"needed": 1e3}, "which the run takes"),
        ("distance [m],vertical [mm]", {}, {"origin": -50.0}, "which the run takes"),
        ("distance [m],vertical [mm]", {}, {"shortest": 0.3}, "shortest: value is 0.3, allowed >="),
        ("distance [m],vertical [mm]", {}, {"longest": 1e4}, "longest: value is 10000"),
        (
            "distance [m],vertical [mm]",
            {},
            {
                "columns": {"distance": {"name": "distance"}, "vertical": {"name": "vertical"}}
                | {"left_vertical": {"name": "vertical"}, "right_vertical": {"name": "vertical"}}
            },
            "vertical: given with left_vertical",
        ),
    ],
)
def test_ambiguous_files_are_refused(tmp_path, head, change, keys, message):
    path = tmp_path / "wrong.csv"
    cells = [f"{value:.6f}" for value in 1e3 * WAVES["left_vertical"]]
    for row, cell in change.items():
        cells[row] = cell
    rows = [f"{s:.6f},{cell}" for s, cell in zip(S, cells, strict=True)]
    path.write_text("\n".join([head, *rows]) + "\n", encoding="utf-8")
    with pytest.raises(CaseError) as raised:
        read(path, **keys)
    assert message in str(raised.value)
    assert "wrong.csv" in str(raised.value)


def test_an_origin_of_the_other_sign_is_named(tmp_path):
    """A chainage that falls has sign = -1, and so has the place in it: said with the refusal."""
    path = tmp_path / "track.csv"
    written(path, "km,vertical [m]", [12.0 - S / 1e3, WAVES["left_vertical"]])
    distance = {
        "distance": {"name": "km", "unit": "km", "sign": -1},
        "vertical": {"name": "vertical"},
    }
    with pytest.raises(CaseError, match=r"is origin -11950\?$"):
        read(path, columns=distance, origin=11950.0)
    with pytest.raises(CaseError, match=r"run.duration$"):
        read(path, columns=distance, origin=13000.0)


def test_distances_and_cant_are_refused(tmp_path):
    path = tmp_path / "wrong.csv"
    written(path, "distance [m],vertical [m]", [S[::-1], WAVES["left_vertical"]])
    with pytest.raises(CaseError, match="sign = -1"):
        read(path)
    twice = S.copy()
    twice[40] = twice[39]
    written(path, "distance [m],vertical [m]", [twice, WAVES["left_vertical"]])
    with pytest.raises(CaseError, match="allowed rising"):
        read(path)
    cross = 0.25 + WAVES["left_vertical"]
    written(path, "distance [m],cross_level [m]", [S, cross])
    with pytest.raises(CaseError, match="the design's cant"):
        read(path)
    assert np.abs(read(path, longest=60.0).deviations).max() < 0.1


def test_runs_on_a_record(tmp_path):
    """A run on a record of a spectrum's own rails is that on the spectrum; the log holds the
    record, the summary its waves, the command refuses it beside a spectrum."""
    base = scenes.scene(duration=0.3, irregular=True)
    rails = Simulation(base).system.irregularity
    s = rails.pieces[0]
    path = tmp_path / "track.csv"
    head = "distance [m];left_lateral [m];left_vertical [m];right_lateral [m];right_vertical [m]"
    values = rails.at(s).reshape(-1, 4).T
    rows = [";".join(repr(float(v)) for v in row) for row in np.transpose([s, *values])]
    path.write_text("\n".join([head, *rows]).replace(".", ","), encoding="utf-8")

    text = load_vehicle_scene().text.decode()
    begin, end = text.index("[irregularity]"), text.index("[run]")
    table = '[measured_track]\nfile = "track.csv"\nbegins = 1.0\n\n'
    scene_path = tmp_path / "scene.toml"
    scene_path.write_text(text[:begin] + table + text[end:], encoding="utf-8")
    scene = load_vehicle_scene(scene_path, {"duration": 0.3}).with_method(**scenes.QUICK)
    scene = replace(scene, alignment=base.alignment)
    ours, theirs = Simulation(scene), Simulation(base)
    for _ in zip(ours.steps(), theirs.steps(), strict=True):
        pass
    # rails begin over 30 m there and over 30 m by the record's own values here
    np.testing.assert_allclose(ours.state.q, theirs.state.q, atol=2e-6)
    with pytest.raises(CaseError, match="which the run takes"):
        Simulation(scene.with_run(duration=100.0))

    command = ["vehicle", str(scene_path), "--duration", "0.02", "--method", "polach"]
    run = CliRunner().invoke(cli, [*command, "--json", "-o", str(tmp_path / "run.mcap")])
    assert run.exit_code == 0, run.output
    (summary,) = json.loads(run.stdout)["runs"].values()
    assert summary["measured_track"]["file"] == "track.csv"
    assert summary["measured_track"]["waves"][0] == pytest.approx(0.5)
    names = {f"{rail}_{way}" for rail in ("left", "right") for way in ("lateral", "vertical")}
    assert set(summary["measured_track"]["rms"]) == names
    assert read_run(tmp_path / "run.mcap").attachments["track.csv"].data == path.read_bytes()
    run = CliRunner().invoke(cli, command)
    assert "waves of 0.5 to" in run.stdout
    run = CliRunner().invoke(cli, [*command, "-o", str(path)])
    assert run.exit_code == 2
    scene_path.write_text(text[:begin] + table + text[begin:], encoding="utf-8")
    run = CliRunner().invoke(cli, command)
    assert run.exit_code == 2
    assert "measured_track: given with [irregularity]" in run.stderr
