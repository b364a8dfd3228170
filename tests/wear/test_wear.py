"""railpatch wear: steps bounded by depth, mass, going on, refusals."""

from __future__ import annotations

import itertools
import json
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
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


BOTH = SWEEP.replace("distance = 1.5e6", 'bodies = "both"\ndistance = 1.5e6\npassages = 6e5')


@pytest.fixture(scope="module")
def both(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, list[dict[str, Any]]]:
    """Wheels and rails together, steps by default."""
    folder = tmp_path_factory.mktemp("both")
    return folder, wear_profiles(load_wear(written(folder, sweep=BOTH)), folder / "out")


def lost(folder: Path, before: str, after: str, body: str) -> tuple[np.ndarray, np.ndarray]:
    """m, y and the depth that has worn off between two files, of a rail its head from above."""
    y, z = read_points(folder / before)
    same, worn = read_points(folder / after)
    assert (y == same).all()
    return y, (worn - z if body == "rail" else z - worn)


def test_rails_wear_with_the_wheels(both: tuple[Path, list[dict[str, Any]]]) -> None:
    """What a rail loses by metre is what all passages wear off, to 0.1 %, from the files."""
    folder, rows = both
    assert (rows[-1]["distance"], rows[-1]["passages"]) == (1.5e6, pytest.approx(6e5))
    for before, after in itertools.pairwise(rows):
        assert abs(after["balance"]) < 1e-3
        for side in ("left", "right"):
            y, depth = lost(folder / "out", before["rails"][side], after["rails"][side], "rail")
            assert depth.min() > -1e-9
            assert depth.max() < 2.1e-5
            order = np.argsort(y)
            section = np.trapezoid(depth[order], y[order])
            mass = after["rail_mass"][side] - before["rail_mass"][side]
            assert section * 7850 == pytest.approx(mass, rel=1e-3)
    # a wheel and its rail lose the same in each contact: by metre and passage, by metre and turn
    first = rows[1]
    of_rail = first["rail_mass"]["left"] + first["rail_mass"]["right"]
    of_wheel = first["mass"]["left"] + first["mass"]["right"]
    assert of_rail / first["passages"] == pytest.approx(of_wheel / first["distance"], rel=1e-12)


def test_the_profiles_do_not_depend_on_the_number_of_steps(
    both: tuple[Path, list[dict[str, Any]]], tmp_path: Path
) -> None:
    """Steps of half the depth: every place of every profile within 2 % of the greatest depth."""
    folder, rows = both
    plan = load_wear(written(tmp_path, "largest_depth = 1e-5\n", sweep=BOTH))
    finer = wear_profiles(plan, tmp_path / "out")
    assert len(finer) > 1.5 * len(rows)
    for body, key in (("wheel", "profiles"), ("rail", "rails")):
        for side in ("left", "right"):
            depths = [
                lost(at / "out", one[0][key][side], one[-1][key][side], body)[1]
                for at, one in ((folder, rows), (tmp_path, finer))
            ]
            assert abs(depths[0] - depths[1]).max() < 0.02 * depths[1].max(), (body, side)


def test_rails_alone_by_passages(tmp_path: Path) -> None:
    """Wheels stay; both rails alike where asked."""
    sweep = SWEEP.replace("distance = 1.5e6", 'bodies = "rail"\npassages = 1e5\nrails_alike = true')
    rows = wear_profiles(load_wear(written(tmp_path, sweep=sweep)), tmp_path / "out")
    assert rows[-1]["passages"] == 1e5
    assert "distance" not in rows[-1]
    assert not list((tmp_path / "out").glob("wheel_*"))
    files = [(tmp_path / "out" / name).read_bytes() for name in rows[-1]["rails"].values()]
    assert files[0] == files[1]
    arguments = ["wear", str(tmp_path / "sweep.toml"), "-o", str(tmp_path / "out")]
    ended = CliRunner().invoke(cli, arguments)
    assert ended.exit_code == 0, ended.output
    assert "off rails" in ended.output
    page = (tmp_path / "out" / "wear.html").read_text(encoding="utf-8")
    for text in ("Both rails", "passages", "off rails [g/m]", "greatest Y/Q"):
        assert text in page


def test_a_worker_that_ends_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """What is done stays for the next call."""

    def ended(*_: Any) -> Any:
        raise BrokenProcessPool

    monkeypatch.setattr(ProcessPoolExecutor, "map", ended)
    with pytest.raises(CaseError, match="one of 2 ended, by a signal"):
        wear_profiles(load_wear(written(tmp_path, sweep=SWEEP)), tmp_path / "out", workers=2)
    assert len(json.loads((tmp_path / "out" / "wear.json").read_text())["rows"]) == 1


def test_processes_give_the_same_rows_and_files(
    both: tuple[Path, list[dict[str, Any]]], tmp_path: Path
) -> None:
    folder, rows = both
    plan = load_wear(written(tmp_path, sweep=BOTH))
    assert wear_profiles(plan, tmp_path / "out", workers=2) == rows
    for path in (folder / "out").glob("*.csv"):
        assert (tmp_path / "out" / path.name).read_bytes() == path.read_bytes()


@pytest.mark.parametrize(
    ("sweep", "scene", "text"),
    [
        (SWEEP.split("[wear]")[0], SCENE, "wear: the table"),
        (SWEEP, SCENE.replace("[damage]\n", ""), "damage"),
        (SWEEP.replace("weights = [1, 2, 2, 1]", "weights = [1]"), SCENE, "wear.weights"),
        (SWEEP.replace("distance = 1.5e6", "distance = -1.0"), SCENE, "wear.distance"),
        (SWEEP.replace("distance = 1.5e6", ""), SCENE, r"distance: .*missing"),
        (SWEEP + "passages = 1e5\n", SCENE, "passages"),
        (SWEEP + "rails_alike = true\n", SCENE, "rails_alike"),
        (SWEEP.replace("distance = 1.5e6", 'bodies = "rail"'), SCENE, "passages"),
        (
            BOTH,
            SCENE.replace("[track]", '[track]\nkind = "roller"\nroller_radius = 1.0'),
            "a roller is no rail",
        ),
        (
            BOTH.replace("wheelset.yaw", "profiles.rail").replace(
                "[-0.001, 0.0, 0.0005, 0.001]", '["UIC60", "UIC60", "UIC60@1:20", "UIC60@1:40"]'
            ),
            SCENE,
            "none of rail profiles",
        ),
    ],
    ids=[
        *("no table", "no damage", "weights", "distance", "no distance", "no rails"),
        *("alike", "no passages", "roller", "varied"),
    ],
)
def test_refused_by_name(tmp_path: Path, sweep: str, scene: str, text: str) -> None:
    """The error names the key."""
    with pytest.raises(CaseError, match=text):
        load_wear(written(tmp_path, scene=scene, sweep=sweep))
