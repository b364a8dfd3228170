"""What changes in a rig's run is sought like any other key of its scene."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from railpatch.match import load_match
from railpatch.match.model import model_of

from rig_model.scene import NOMINAL, scenes

TABLES = """
[rig]
record = "record.csv"
duration = 360.0
lateral_position = [[0, 0], [0.3, 0], [0.5, -8e-3], [0.8, 0], [1, 0]]
[rig.balance]
tolerance = 2e-5
[rig.frame]
stiffness = 20e6
friction = [[10e6, 5e3]]
gauge_stiffness = 50e6
[rig.conditioning]
plateau = 1.2
work = 3e6
recovery_time = 300.0
[rig.drift]
yaw = [1e-4, 2e-4]
lateral_position = [2e-4]
[match.observed]
left_lateral = {}
right_lateral = {}
"""
LAYER = """[layer]
shear_modulus = 8.2e9                # Pa
thickness = 5e-5                     # m
"""
FASTSIM = """[method]
normal = "hertz"
tangential = "fastsim"
"""
RESIDUAL = 2e-5 * 133.95e3  # N
KEYS = {
    "rig.frame.stiffness": (10e6, 30e6),
    "rig.frame.friction[0][1]": (2e3, 8e3),
    "rig.frame.gauge_stiffness": (10e6, 90e6),
    "rig.conditioning.plateau": (1.0, 1.4),
    "rig.conditioning.work": (1e6, 5e6),
    "rig.conditioning.recovery_time": (20.0, 500.0),
    "rig.drift.yaw[1]": (0.0, 4e-4),
    "rig.drift.lateral_position[0]": (0.0, 2e-3),
}
RECORD = "progress [-],yaw [mrad],left_lateral [kN],right_lateral [kN]\n"
ROWS = ("0,6,1,1", "0.3,10,1,1", "0.5,12,1,1", "0.8,8,1,1", "1,6,1,1")


@pytest.fixture
def plan(tmp_path: Path):
    path = tmp_path / "scene.toml"
    text = (scenes() / NOMINAL).read_text()
    text = text[: text.index("[rig]")].replace("[0.4e-3, 0.4e-3]", "[1e-3, 1e-3]") + TABLES
    assert LAYER in text
    text = text.replace(LAYER, FASTSIM)
    for key, (low, high) in KEYS.items():
        text += f'[match.seek."{key}"]\nlow = {low}\nhigh = {high}\n'
    path.write_text(text)
    path.with_name("record.csv").write_text(RECORD + "\n".join(ROWS) + "\n")
    return load_match(path)


def test_every_key_moves_the_forces(plan) -> None:
    model = model_of(plan, plan.explanations[0], 1)
    middle = np.full(len(KEYS), 0.5)
    base = model.at(middle)
    assert np.isfinite(base).all()
    for k, key in enumerate(KEYS):
        moved = model.at(middle - 0.4 * (np.arange(len(KEYS)) == k))
        assert np.abs(moved - base).max() > 3 * RESIDUAL, key
