"""A liquid between wheels and rollers: a paste of oxide dries from row to row of a replay; bodies
that store heat, and what has no time, refuse it by name."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

import pytest
from railpatch.errors import CaseError

from rig_model.balance import Balancer
from rig_model.curve import load_curve_scene
from rig_model.scene import load_rig_scene, scenes

TIME = 100.0  # s
DRYING = f"oxide = {{ solid_content = 0.2, drying = {{ time = {TIME} }} }}\n"
# which fast theories do not have
LAYER = """[layer]
shear_modulus = 8.2e9                # Pa
thickness = 5e-5                     # m
"""
FAST = """
[method]
normal = "hertz"
tangential = "fastsim"
"""
FILM = """
[fluid]
model = "film"
roughness = 2e-6
boundary_friction = 0.15
liquid = "water"
"""
WARM = "temperature = 20.0\n"
BULK = """
[temperature]
conductivity = 50.0
heat_capacity = 450.0
density = 7850.0
bulk = { mass = [300.0, 300.0] }
"""
Write = Callable[..., Path]


@pytest.fixture
def wet(scene_with: Write) -> Write:
    """The nominal scene by fast theories, with a film and what else there is of it."""
    coarse = ("element_size = [0.4e-3, 0.4e-3]", "elements = [12, 12]")
    return lambda end: scene_with(coarse, (LAYER, ""), end=FAST + FILM + end)


def test_a_paste_dries_from_row_to_row(wet: Write) -> None:
    """Once by the time between two rows, however often each row's search solves it; a second
    replay begins anew, and a last paste that is dry has dry friction."""
    scene = load_rig_scene(wet(WARM + DRYING), {"positions": 4})
    balancer = Balancer(scene)
    frictions = []
    for position in scene.positions():
        balance = balancer.solve(position)
        assert balance.converged
        assert balance.evaluations > 1 or position.index > 0
        for side in ("left", "right"):
            water = balance.result[side]["oxide_water"]
            assert water == pytest.approx(math.exp(-position.time / TIME), rel=1e-12)
        frictions.append(balance.result["right"]["patches"][0]["effective_friction"])
    # thinner than what packs at 0.14 of the water: more friction from row to row
    assert frictions[-2] < frictions[-1] < scene.case.friction.coefficient
    again = Balancer(scene).solve(scene.positions()[0])
    assert again.result["right"]["oxide_water"] == 1.0


def test_not_beside_stored_heat(wet: Write) -> None:
    path = wet(DRYING + BULK)
    with pytest.raises(CaseError, match=r"fluid\.oxide\.drying: value is given, allowed none"):
        load_rig_scene(path)


def test_not_in_a_steady_curve(tmp_path: Path) -> None:
    source = scenes() / "curve_s1002.toml"
    path = tmp_path / "curve.toml"
    path.write_text(source.read_text(encoding="utf-8") + FILM + WARM + DRYING, encoding="utf-8")
    with pytest.raises(CaseError, match=r"fluid\.oxide\.drying: value is given, .* has no time"):
        load_curve_scene(path)
