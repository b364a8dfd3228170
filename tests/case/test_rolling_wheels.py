"""Keys of shapes along x and of transient rolling of wheels."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import railpatch
from case_samples import WHEELSET, with_values
from railpatch import CaseError
from railpatch.case.load import load_scene
from railpatch.case.to_core import config_of

FLAT = {"flat": {"depth": 5e-4}}
LEVEL = [[0.0, 0.0], [0.1, 0.0], [0.2, 0.0], [0.3, 0.0]]
TRANSIENT = {"motion__regime": "transient_rolling", "wheelset__time_step": 1e-4}
LAYER = {"shear_modulus": 1e9, "thickness": 1e-5, "yield_stress": 1e8}


@pytest.mark.parametrize(
    ("values", "problem"),
    [
        ({"wheelset__left": {"runout": [0.0] * 7}}, "wheelset.left.runout: value is 7 values"),
        ({"wheelset__left": {"runout": [0.2] * 9}}, "wheelset.left.runout[0]: value is 0.2"),
        ({"wheelset__left": {"flat": {"depth": 0.0}}}, "wheelset.left.flat.depth: value is 0.0"),
        ({"wheelset__right": {"joint": {}}}, "wheelset.right.joint: value is a table"),
        ({"track__left": {"running_surface": LEVEL[:3]}}, "track.left.running_surface: value is 3"),
        ({"track__left": {"running_surface": LEVEL[::-1]}}, "track.left.running_surface: value"),
        ({"track__left": {"joint": {"depth": 1e-3}}}, "track.left.joint.position: value"),
        ({"wheelset__left": FLAT, "method__normal": "analyn"}, "wheelset.left.flat: value"),
        (
            {"wheelset__left": FLAT, "method__reference_surface": "curved"},
            "wheelset.left.flat: value is given",
        ),
        ({"motion__regime": "transient_rolling"}, "wheelset.time_step: value is 0.0"),
        ({**TRANSIENT, "grid": {"elements": [20, 20]}}, "grid.element_size: value is missing"),
        ({**TRANSIENT, "method__tangential": "fastsim"}, "method.tangential: value is 'fastsim'"),
        (
            {"wheelset__right": {"flat": {"depth": 2e-5, "rounding": 6e-3}}},
            "wheelset.right.flat.rounding: value is 0.006, allowed <= 0.00286, a third of the",
        ),
        ({**TRANSIENT, "layer": LAYER}, "layer.yield_stress: value is given"),
        ({**TRANSIENT, "temperature": {}}, "temperature: value is given"),
        ({"motion__regime": "shift"}, "motion.regime: value is 'shift'"),
    ],
)  # fmt: skip
def test_wrong_values(values: dict[str, Any], problem: str) -> None:
    with pytest.raises(CaseError) as caught:
        load_scene(with_values(WHEELSET, **values))
    assert any(line.startswith(problem) for line in caught.value.problems), caught.value.problems


def test_shapes_do_not_move() -> None:
    contact = railpatch.Contact(with_values(WHEELSET, wheelset__left=FLAT))
    contact.step(left={"offset": [0.0, 0.0, 1e-5]})
    with pytest.raises(CaseError, match=r"wheelset\.left\.flat"):
        contact.step(left={"flat": {"depth": 1e-3}})


def test_files_hold_the_same_as_lists(tmp_path: Path) -> None:
    runout = 1e-4 * np.sin(np.linspace(0, 2 * np.pi, 100, endpoint=False))
    np.savetxt(tmp_path / "runout.csv", runout)
    surface = np.array([[0.0, 0.0], [0.2, -1e-4], [0.5, 1e-4], [0.9, 0.0]])
    np.savetxt(tmp_path / "rail.csv", surface, delimiter=",")
    values = {
        "wheelset__left": {"runout": "runout.csv"},
        "track__right": {"running_surface": "rail.csv"},
    }
    read = config_of(load_scene(with_values(WHEELSET, **values), tmp_path))
    assert read["runout"][0] == pytest.approx(runout, abs=1e-18)
    assert read["runout"][1] is None
    given = {"track__right": {"running_surface": surface.tolist()}}
    heights = read["rail_height"][1]
    listed = config_of(load_scene(with_values(WHEELSET, **given)))
    assert np.array_equal(heights, listed["rail_height"][1])
    x = read["rail_height_start"] + read["rail_height_spacing"] * np.arange(len(heights))
    for place, height in surface:
        assert np.interp(place, x, heights) == pytest.approx(height, abs=1e-8)
    (tmp_path / "rail.csv").write_text("0 0\n1 oops\n")
    with pytest.raises(CaseError, match=r"running_surface: .*rail\.csv:2"):
        config_of(load_scene(with_values(WHEELSET, **values), tmp_path))


def test_what_is_not_asked_for_is_not_there() -> None:
    config = config_of(load_scene(WHEELSET))
    assert not {"runout", "rail_height", "rail_height_start"} & set(config)
    assert config["regime"] == "steady_rolling"
    plain = railpatch.Contact(WHEELSET).stages()
    history = next(stage for stage in plain if stage["name"] == "history")
    assert not history["present"]
    assert history["bytes"] == 0
    rolling = railpatch.Contact(with_values(WHEELSET, **TRANSIENT)).stages()
    assert next(stage for stage in rolling if stage["name"] == "history")["bytes"] > 0
