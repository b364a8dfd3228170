"""The command railpatch vehicle, and scenes that are refused."""

from __future__ import annotations

import json

import pytest
from click.testing import CliRunner
from railpatch.errors import CaseError

from wheelset_demo.scene import scene_file
from wheelset_demo.vehicle import Simulation
from wheelset_demo.vehicle.command import METHODS, vehicle
from wheelset_demo.vehicle.compare import THEORIES, rows_of
from wheelset_demo.vehicle.scene import load_vehicle_scene

NAMES = ("vehicle_curve.toml", "vehicle_straight.toml")


def call(*arguments: str):
    return CliRunner().invoke(vehicle, [*arguments])


def test_methods_are_the_theories():
    assert set(METHODS) == set(THEORIES)


@pytest.mark.parametrize("name", NAMES)
def test_packaged_scenes(name):
    loaded = load_vehicle_scene(scene_file(name))
    assert loaded.irregularity is not None
    assert (loaded.alignment.radius is None) == (name == "vehicle_straight.toml")
    assert loaded.run.step == 1e-3


def test_published_ratios():
    """FRA report, Table 5: Hertz and FASTSIM 17.36 s, Kik-Piotrowski 25.97 s, CONTACT 383.0 s."""
    base = THEORIES["fastsim"].published
    assert THEORIES["full"].published / base == pytest.approx(22.1, abs=0.05)
    assert THEORIES["kik"].published / base == pytest.approx(1.5, abs=0.05)


def test_comparison():
    result = call("--compare", "--duration", "0.01", "--threads", "2", "--json")
    assert result.exit_code == 0, result.output
    runs = json.loads(result.output)["runs"]
    assert list(runs) == ["fastsim", "kik", "full"]
    for run in runs.values():
        assert run["steps"] == 10
        assert run["seconds"]["total"] > run["seconds"]["contact"] / 2 > 0
        assert len(run["friction"]) == 8


def test_ratios_of_the_table():
    """By hand: total over total of Hertz and FASTSIM, each in its column."""

    class Found:
        def __init__(self, total, real_time):
            self.seconds = {"total": total, "cpu": 2 * total, "contact": 0.5 * total**2}
            self.real_time, self.duration = real_time, 20.0

    base, full = rows_of({"fastsim": Found(2.0, 0.1), "full": Found(6.0, 0.3)})
    assert base[1:] == ["2", "4", "2", "1", "1", "1", "1", "0.1", "0.2", "0.868"]
    assert full[1:] == ["6", "12", "18", "3", "3", "9", "22.1", "0.3", "0.6", "19.1"]
    assert full[0] == "half-space, full, 16 x 16"


def test_table_of_times_compares():
    """Of two theories a row each beside published times; one alone has nothing to stand beside."""
    result = call("--method", "polach", "--method", "fastsim", "--duration", "0.005")
    assert result.exit_code == 0, result.output
    *_, header, row, other, published = result.output.splitlines()
    assert header.split()[-2:] == ["CPU", "published"]
    assert row.startswith("Hertz, polach, 10 x 10")
    assert other.startswith("Hertz, fastsim, 10 x 10")
    assert "CONTACT 383 s" in published
    result = call("--method", "fastsim", "--duration", "0.005")
    assert result.exit_code == 0, result.output
    assert "Hertz, fastsim, 10 x 10" in result.output
    assert "published" not in result.output


def test_wrong_calls(tmp_path):
    assert call("--compare", "--method", "full").exit_code == 2
    assert call(str(tmp_path / "none.toml")).exit_code == 2
    result = call("--duration", "-1")
    assert result.exit_code == 2
    assert "run.duration: value is -1" in result.output


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("mass = 32000.0 ", "mass = 0.0 ", r"vehicle.body\[0\].mass: value is 0.0"),
        (
            "[10.78, 8.22, -8.22, -10.78]",
            "[10.78, 8.22, 8.22, -10.78]",
            "vehicle.wheelset.positions: value is 8.22, allowed each place for one wheelset only",
        ),
        (
            '"axle_box_4_left"], at',
            '"axle_box_9_left"], at',
            r"element\[0\].places\[5\].between: value is 'axle_box_9_left', allowed car_body",
        ),
        ('name = "bogie_2"', 'name = "bogie_1"', r"vehicle.body\[2\].name: value is 'bogie_1'"),
        ('name = "bogie_2"', 'name = "track_1"', "value is 'track_1', allowed one that is no"),
        ('["bogie_1", "car_body"]', '["car_body", "car_body"]', "allowed two bodies"),
        (
            "[[vehicle.wheelset]]",
            '[[vehicle.body]]\nname = "box"\nmass = 1.0\ninertia = [1.0, 1.0, 1.0]\n'
            "position = [0.0, 0.0, 1.0]\n[[vehicle.wheelset]]",
            "vehicle.body 'box': value is free, allowed an element that holds it",
        ),
        (
            "turning_stiffness = [0.0, 80e3, 0.0]",
            "turning_stiffness = [0.0, 0.0, 0.0]",
            "vehicle.element: nothing holds axle_box_[1-4]_(left|right), allowed elements",
        ),
        ("radius = 4000.0", "radius = 40.0", "alignment.radius: value is 40.0"),
        ('level = "low"', 'level = "lower"', "irregularity.level"),
        ("z = 0.0 ", "vertical_force = 1e5 ", "wheelset.vertical_force: given, allowed 'z'"),
        ("duration = 20.0", "duration = 1e-9", "run.step: value is 0.001"),
        ("gauge = 1.435", "gauge = 1.435\ncurvature = 1e-3", "track.curvature: value is 0.001"),
        ("inertia = [810.0, 112.0, 810.0]", "inertia = [810.0, 112.0, 800.0]", "equal ones"),
        (
            "stiffness = [160e3, 160e3, 430e3]",
            "stiffness = [160e3, 160e3, 0.0]",
            "vehicle.element: nothing holds car_body.z, allowed elements with a stiffness there",
        ),
        (
            "straight = 150.0",
            "straight = 20.0",
            "alignment.straight: value is 20.0, allowed >= 21.56",
        ),
        ("threads = 1", "threads = 0", "run.threads: value is 0"),
        ("duration = 20.0", "duration = 2000.0", "200122 m of track, allowed <= 100000 m"),
        ("[0.025, 0.0], [0.030", "[0.025, 10.0], [0.030", r"bump_stop.y: value is \[10.0, 600.0"),
        ("[0.030, 600.0]", "[0.030, -600.0]", "forces from 0 on that do not fall"),
        ("[0.065, 230000.0]", "[0.065, 23000.0]", "forces from 0 on that do not fall"),
    ],
)
def test_refused(tmp_path, old, new, message):
    text = scene_file("vehicle_curve.toml").read_text(encoding="utf-8")
    assert old in text
    changed = tmp_path / "changed.toml"
    changed.write_text(text.replace(old, new), encoding="utf-8")
    with pytest.raises(CaseError, match=message):
        Simulation(load_vehicle_scene(changed))


def test_contact_that_fails_before_the_first_step(tmp_path, monkeypatch):
    """A curve that begins under the vehicle, which checks of a scene refuse otherwise."""
    text = scene_file("vehicle_curve.toml").read_text(encoding="utf-8")
    for old, new in (
        ("straight = 150.0", "straight = 0.0"),
        ("transition = 300.0", "transition = 5.0"),
        ("radius = 4000.0", "radius = 150.0"),
    ):
        assert old in text
        text = text.replace(old, new)
    file = tmp_path / "tight.toml"
    file.write_text(text, encoding="utf-8")
    refused = call(str(file), "--method", "polach", "--duration", "0.01")
    assert refused.exit_code == 2
    assert "alignment.straight: value is 0.0, allowed >= 21.56" in refused.output
    monkeypatch.setattr("wheelset_demo.vehicle.scene.check_run", lambda **_: None)
    failed = call(str(file), "--method", "polach", "--duration", "0.01")
    assert failed.exit_code == 3, failed.output
    assert "status: contact failed at 0 s" in failed.output
    assert "before the first step" in failed.output
