"""Files of one command given to another: one line says what they are."""

from __future__ import annotations

from pathlib import Path

import pytest
from click.testing import CliRunner, Result
from railpatch.command.cli import cli

from rig_model.curve import DEFAULT as CURVE
from rig_model.scene import NOMINAL, default_scene
from wheelset_demo.scene import scene_file

SCENES = {
    "wheelset": scene_file("hunting.toml"),
    "vehicle": scene_file("vehicle_curve.toml"),
    "rig": default_scene().parent / NOMINAL,
    "curve": CURVE,
}
# command -> what its scenes are called, options
COMMANDS = {
    "solve": (None, []),
    "explain": (None, []),
    "wheelset": ("wheelset", ["-o", "run.mcap"]),
    "hunting": ("wheelset", []),
    "cosimulation": ("wheelset", []),
    "vehicle": ("vehicle", []),
    "rig": ("rig", ["-o", "run.mcap"]),
    "curve": ("curve", []),
}
PAIRS = [
    (c, s)
    for c, (own, _) in COMMANDS.items()
    for s in SCENES
    # hunting takes vehicles too
    if s != own and (c, s) != ("hunting", "vehicle")
]


def invoke(*arguments: object) -> Result:
    return CliRunner().invoke(cli, [str(argument) for argument in arguments])


@pytest.mark.parametrize(("command", "scene"), PAIRS)
def test_one_line(command: str, scene: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.chdir(tmp_path)
    own, options = COMMANDS[command]
    ran = invoke(command, SCENES[scene], *options)
    assert ran.exit_code == 2
    wanted = f"one of railpatch {own}" if own else "a contact case"
    assert ran.stderr == f"Error: this is a scene of railpatch {scene}, allowed {wanted}\n"


def test_a_match_of_an_own_scene(tmp_path: Path):
    """It is one of this command but for a table."""
    file = tmp_path / "rig.toml"
    file.write_text(SCENES["rig"].read_text() + "\n[match]\n")
    ran = invoke("rig", file, "-o", tmp_path / "run.mcap")
    assert ran.exit_code == 2
    assert ran.stderr == (
        "Error: this is a scene of railpatch match, allowed one of railpatch rig: it is without its"
        " table [match]\n"
    )


def test_a_theory_that_cannot_have_the_scenes_friction(tmp_path: Path):
    """Known from the scene, with its key, not from the core."""
    law = 'law = "slip_velocity"\nkinetic = 0.2\namplitude = 0.1\nhalving_speed = 0.5\n'
    text = SCENES["vehicle"].read_text()
    old = next(line for line in text.splitlines(True) if line.startswith("coefficient"))
    file = tmp_path / "scene.toml"
    file.write_text(text.replace(old, law))
    ran = invoke("vehicle", file, "--method", "fitted", "--duration", 0.01)
    assert ran.exit_code == 2
    allowed = "none: it must be left out with friction.law = 'slip_velocity'"
    assert ran.stderr.startswith("Error: --method fitted: grid.fitted: value is [")
    assert ran.stderr.endswith(f"], allowed {allowed}\n")
