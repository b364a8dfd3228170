"""A wheelset whose cones are turned round leaves the middle without a wave: Klingel's equations,
y' = yaw, yaw' = conicity y/(r0 e0) per metre (see test_klingel.py), grow by
V sqrt(conicity/(r0 e0)) a second where no spring holds it. And the command's words where waves
grow in all of its range."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import pytest
import wheelset_scenes as scenes
from click.testing import CliRunner, Result
from railpatch import Contact
from railpatch.command.cli import cli

from wheelset_demo.hunting import search_modes, slowest_mode
from wheelset_demo.scene import WheelsetScene, load_wheelset_scene

SLOPE, CROWN = 1 / 20, 0.3  # of the cones; m, radius of the rails' heads


@pytest.fixture
def turned_round(tmp_path: Path) -> WheelsetScene:
    """hunting.toml with such wheels, and without springs and dampers for y and yaw."""
    text = scenes.text_of("hunting.toml").replace(
        '"cone@1:20"', '"turned.csv"\nwheel_file = { mirror = "none" }'
    )
    for key in ("y", "yaw"):
        text, count = re.subn(rf"(?m)^{key} = (4e5|2e3|1e3) .*$", f"{key} = 0", text)
        assert count == 2
    rows = (f"{y:.1f},{SLOPE * y:.4f}" for y in np.arange(-60, 61, 2.0))
    (tmp_path / "turned.csv").write_text("\n".join(rows))
    file = tmp_path / "scene.toml"
    file.write_text(text)
    return load_wheelset_scene(file)


def test_divergence_grows_as_kinematics_say(turned_round: WheelsetScene):
    straight = turned_round.at_speed(1.0, 0.0)
    result = Contact(straight.at_rest().case.model_dump()).step()
    radius = result["right"]["rolling_radius"]
    half = result["right"]["patches"][0]["position"][1]
    # the contacts move on the crowns as the wheelset rolls over
    conicity = SLOPE * (1 - CROWN * SLOPE / half)
    kinematic = np.sqrt(conicity / (radius * half))
    for speed in (1.0, 5.0):
        found = slowest_mode(turned_round, speed)
        assert found.divergence == pytest.approx(speed * kinematic, rel=0.01)


def test_the_search_tells_of_it(turned_round: WheelsetScene, tmp_path: Path):
    searched = search_modes(turned_round, 5.0, 20.0)
    assert searched.critical is None
    assert searched.diverging is not None
    assert searched.diverging.speed == 5.0
    ran = invoke(tmp_path / "scene.toml", "--lowest", 5, "--highest", 20)
    assert f"{searched.diverging.divergence:+.4f} 1/s at 5.00 m/s, without waves" in ran.stdout


def invoke(*arguments: object) -> Result:
    return CliRunner().invoke(cli, ["hunting", *map(str, arguments)])


def test_waves_that_grow_at_the_lowest_speed_already():
    """The critical speed of the packaged scene is 49.6 m/s."""
    ran = invoke("--lowest", 60, "--highest", 62)
    assert ran.exit_code == 0
    assert "below 60 m/s: waves already grow there" in ran.stdout
    assert "none between" not in ran.stdout
    found = json.loads(invoke("--lowest", 60, "--highest", 62, "--json").stdout)
    assert found["critical_speed"] is None
    assert found["critical_speed_below"] == 60
    assert found["divergence"] is None


@pytest.mark.parametrize("name", ["--lowest", "--highest"])
@pytest.mark.parametrize("value", ["inf", "nan", "-1", "0", "1e9"])
def test_speeds_have_bounds(name: str, value: str):
    ran = invoke(name, value)
    assert ran.exit_code == 2
    assert f"{name}: value is {float(value)}, allowed 0.05 ... 200 m/s" in ran.stderr
