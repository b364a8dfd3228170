"""The state of the start: quasi-static where friction holds the wheelset, at rest sideways where it
cannot."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import wheelset_scenes as scenes

from wheelset_demo.simulation import simulate
from wheelset_demo.start import released
from wheelset_demo.system import COUNT, System

SPEED = 50.0  # m/s


def text(friction: float, **more: object) -> str:
    """The scene of hunting with worn-like profiles, small grids; the first y is the wheelset's."""
    content = scenes.text_of("hunting.toml", speed=SPEED, coefficient=friction, y=4e-3, **more)
    content = content.replace("elements = [12, 12]", "elements = [8, 8]")
    return content.replace("cone@1:20", "S1002").replace("arc@0.3", "UIC60@1:40")


@pytest.mark.parametrize("friction", [0.05, 0.03, 1e-5])
def test_a_wheelset_that_friction_cannot_hold_starts_at_rest_sideways(
    tmp_path: Path, friction: float
) -> None:
    """Newton's method found rates of y of 0.9 to 2.1 m/s, at which the dampers held it."""
    file = tmp_path / "scene.toml"
    file.write_text(text(friction), encoding="utf-8")
    scene = scenes.load_wheelset_scene(file)
    system = System(scene)
    motion = released(scene, system).motion
    assert motion[COUNT + 1] == motion[COUNT + 4] == 0.0
    # it carries its load, upright
    accelerations = system.rates(0.0, motion).motion[COUNT:]
    assert np.abs(accelerations[[2, 3]]).max() < 1e-3


def test_it_rolls_where_friction_holds_it(tmp_path: Path) -> None:
    file = tmp_path / "scene.toml"
    file.write_text(text(0.3), encoding="utf-8")
    scene = scenes.load_wheelset_scene(file)
    motion = released(scene, System(scene)).motion
    assert 0.0 < abs(motion[COUNT + 1]) < 1e-3 * SPEED
    assert abs(motion[COUNT + 4]) > 0.0


def test_a_run_without_friction_keeps_its_energy(tmp_path: Path) -> None:
    """It slid off the rails within 6 ms."""
    file = tmp_path / "scene.toml"
    file.write_text(text(1e-5, distance=2.0, step=1e-3), encoding="utf-8")
    trace = simulate(scenes.load_wheelset_scene(file))
    assert trace.failure is None
    assert np.abs(trace.coordinate(1)).max() < 5e-3
