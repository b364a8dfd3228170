"""railpatch wear: steps bounded by depth, mass, going on, refusals."""

from __future__ import annotations

import itertools
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner
from railpatch import CaseError
from railpatch.command.cli import cli
from railpatch.wear.evolve import read_points, smoothed, take_off, wear_profiles
from railpatch.wear.plan import load_wear

SCENE = """kind = "wheelset"
[friction]
coefficient = 0.3
[grid]
elements = [10, 10]
[wheelset]
vertical_force = 120e3
roll = "balanced"
pitch_rate = "free"
speed = 20.0
nominal_radius = 0.46
flange_back_distance = 1.36
flange_back_position = -0.070
[track]
gauge = 1.435
gauge_height = 0.014
[profiles]
wheel = "S1002"
rail = "UIC60@1:40"
[damage]
"""
SWEEP = """[sweep]
scene = "wheelset.toml"
design = "list"
[[vary]]
key = "wheelset.y"
values = [-0.004, 0.0, 0.002, 0.004]
[[vary]]
key = "wheelset.yaw"
values = [-0.001, 0.0, 0.0005, 0.001]
[wear]
distance = 1.5e6
weights = [1, 2, 2, 1]
"""


def written(folder: Path, more: str = "", scene: str = SCENE, sweep: str = SWEEP) -> Path:
    (folder / "wheelset.toml").write_text(scene, encoding="utf-8")
    path = folder / "sweep.toml"
    path.write_text(sweep + more, encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, list[dict[str, Any]]]:
    folder = tmp_path_factory.mktemp("wear")
    rows = wear_profiles(load_wear(written(folder, "largest_depth = 5e-5\n")), folder / "out")
    return folder, rows


def test_steps_are_bounded_by_depth_and_mass_is_kept(
    run: tuple[Path, list[dict[str, Any]]],
) -> None:
    """What profiles lose is what the contacts wear off, to 0.1 %, recomputed from the files."""
    folder, rows = run
    assert rows[-1]["distance"] == 1.5e6
    assert len(rows) > 2
    for before, after in itertools.pairwise(rows):
        assert abs(after["balance"]) < 1e-3
        for side in ("left", "right"):
            y, z = read_points(folder / "out" / before["profiles"][side])
            same, worn = read_points(folder / "out" / after["profiles"][side])
            assert (y == same).all()
            lost = z - worn
            assert lost.max() < 5.1e-5
            assert lost.min() > -1e-9
            order = np.argsort(y)
            tread = y[order] > y[np.argmax(z)]
            section = np.trapezoid(lost[order][tread], y[order][tread])
            mass = after["mass"][side] - before["mass"][side]
            assert section * 2 * np.pi * 0.46 * 7850 == pytest.approx(mass, rel=1e-3)
    assert all(row["y_over_q"] > 0 and row["conicity"] > 0 for row in rows)


def test_does_not_depend_on_the_number_of_steps(
    run: tuple[Path, list[dict[str, Any]]], tmp_path: Path
) -> None:
    """Half the depth by step: mass within 2 %."""
    _, rows = run
    finer = wear_profiles(load_wear(written(tmp_path, "largest_depth = 2.5e-5\n")), tmp_path / "o")
    assert len(finer) > len(rows)
    assert finer[-1]["mass"]["right"] == pytest.approx(rows[-1]["mass"]["right"], rel=0.02)


def test_goes_on_where_it_was_ended(run: tuple[Path, list[dict[str, Any]]], tmp_path: Path) -> None:
    """Ended after the first step and called again: the same rows and files, to the bit."""
    folder, rows = run
    plan = load_wear(written(tmp_path, "largest_depth = 5e-5\n"))

    def stop(part: float) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        wear_profiles(plan, tmp_path / "out", progress=stop)
    assert len(json.loads((tmp_path / "out" / "wear.json").read_text())["rows"]) == 2
    assert wear_profiles(plan, tmp_path / "out") == rows
    for name in rows[-1]["profiles"].values():
        assert (tmp_path / "out" / name).read_bytes() == (folder / "out" / name).read_bytes()
    other = load_wear(written(tmp_path, "largest_depth = 4e-5\n"))
    with pytest.raises(CaseError, match="another wear run"):
        wear_profiles(other, tmp_path / "out")


def test_the_command(run: tuple[Path, list[dict[str, Any]]]) -> None:
    """Goes on with what is done, writes the page, prints rows."""
    folder, rows = run
    arguments = ["wear", str(folder / "sweep.toml"), "-o", str(folder / "out"), "--json"]
    ended = CliRunner().invoke(cli, arguments)
    assert ended.exit_code == 0, ended.output
    assert json.loads(ended.output) == rows
    page = (folder / "out" / "wear.html").read_text(encoding="utf-8")
    for text in ("worn off", "equivalent conicity", "Both wheels", "mass balance open by [%]"):
        assert text in page


def test_smoothing_keeps_the_sum_and_depth_goes_along_z() -> None:
    """A bell curve; from the flange's tip on."""
    depth = np.zeros(400)
    depth[190:210] = 1e-5
    found = smoothed(depth, 2.5e-4, 1.5e-3)
    assert found.sum() == pytest.approx(depth.sum(), rel=1e-12)
    assert found.max() < depth.max()
    y = np.linspace(-0.05, 0.05, 11)
    z = np.where(y < -0.03, 0.028, 0.0)
    worn = take_off(y, z, np.array([-1.0, 1.0]), np.array([1e-4, 1e-4]))
    np.testing.assert_allclose(z - worn, 1e-4)


@pytest.mark.parametrize(
    ("sweep", "scene", "text"),
    [
        (SWEEP.split("[wear]")[0], SCENE, "wear: the table"),
        (SWEEP, SCENE.replace("[damage]\n", ""), "damage"),
        (SWEEP.replace("weights = [1, 2, 2, 1]", "weights = [1]"), SCENE, "wear.weights"),
        (SWEEP.replace("distance = 1.5e6", "distance = -1.0"), SCENE, "wear.distance"),
    ],
    ids=["no table", "no damage", "weights", "distance"],
)
def test_refused_by_name(tmp_path: Path, sweep: str, scene: str, text: str) -> None:
    """The error names the key."""
    with pytest.raises(CaseError, match=text):
        load_wear(written(tmp_path, scene=scene, sweep=sweep))
