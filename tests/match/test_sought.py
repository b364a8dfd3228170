"""The short spellings: what is sought by its ends alone, forces by component, columns by name."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from railpatch import CaseError, solve_many
from railpatch.case.load import check_table, read_toml
from railpatch.command.cli import cli
from railpatch.errors import RecordError
from railpatch.match import load_match, run_match
from railpatch.match.command import match
from railpatch.match.plan import MatchTable
from railpatch.record import MeasuredColumn, read_record

from rig_model.balance import Balancer
from rig_model.scene import NOMINAL, load_rig_scene, rig_scene_of, scenes

SOUGHT = """
[match]
starts = 1
# key of the scene = bounds
sought = { "friction.coefficient" = [0.1, 0.8], "rig.frame.stiffness" = [1e6, 1e10], \
"rig.offset.y" = [-2e-3, 2e-3], "rig.offset.yaw" = [-1e-3, 1e-3] }
[rig]
record = "run.csv"
[rig.columns]
yaw = { column = "AoA mrad", unit = "mrad" }
"""
TRUTH = {"mu": 0.45, "stiffness": 2e7, "y": 4e-4, "yaw": 3e-4}
# N, of each force
NOISE = 300.0
YAW = np.array([0.0, 2.0, 4.0, 7.0, 10.0, 12.0, -2.0, -5.0, -8.0, -12.0])  # mrad, as recorded
AXES = "XLV"


def head() -> str:
    """The packaged rig's tables but [rig], on coarse elements."""
    text = (scenes() / NOMINAL).read_text().partition("[rig]")[0]
    return text.replace("[0.4e-3, 0.4e-3]", "[2e-3, 2e-3]")


@pytest.fixture(scope="module")
def forces() -> np.ndarray:
    """N, on rollers, [positions, side, axis], with noise."""
    content = read_toml(scenes() / NOMINAL)
    content["grid"]["element_size"] = [2e-3, 2e-3]
    content["friction"]["coefficient"] = TRUTH["mu"]
    progress = np.linspace(0.0, 1.0, len(YAW)).tolist()
    content["rig"] = {
        "duration": 9.0, "positions": len(YAW), "frame": {"stiffness": TRUTH["stiffness"]},
        "yaw": [[p, 1e-3 * v + TRUTH["yaw"]] for p, v in zip(progress, YAW.tolist(), strict=True)],
        "lateral_position": [[0.0, TRUTH["y"]], [1.0, TRUTH["y"]]],
    }  # fmt: skip
    scene = rig_scene_of(content, scenes())
    balancer = Balancer(scene)
    found = [balancer.solve(position).result for position in scene.positions()]
    exact = [[-np.array(result[side]["force"]) for side in ("left", "right")] for result in found]
    return np.array(exact) + NOISE * np.random.default_rng(5).standard_normal((len(YAW), 2, 3))


def written(folder: Path, forces: np.ndarray, columns: str, text: str = "") -> Path:
    """run.csv and a scene after the interface."""
    heads = ["AoA mrad", *(f"{axis}_{side} kN" for side in ("left", "right") for axis in AXES)]
    rows = np.column_stack([YAW, 1e-3 * forces.reshape(len(YAW), 6)])
    lines = [",".join(heads), *(",".join(f"{v:.7g}" for v in row) for row in rows)]
    (folder / "run.csv").write_text("\n".join(lines) + "\n")
    path = folder / "scene.toml"
    path.write_text(head() + (text or SOUGHT) + columns)
    return path


def columns_of(first: int, axes: str) -> str:
    """[rig.columns] of forces on rollers; first: the number of x."""
    return "".join(
        f'"{side}.force[{first + AXES.index(axis)}]" = '
        f'{{ column = "{axis}_{side} kN", unit = "kN", sign = -1 }}\n'
        for side in ("left", "right")
        for axis in axes
    )


def test_a_file_after_the_interface(tmp_path: Path, forces: np.ndarray) -> None:
    """From command to match.json; the truth is inside, though neither frame, offsets, lateral
    positions nor times are in the scene."""
    path = written(tmp_path, forces, columns_of(0, "XL"))
    runner = CliRunner()
    done = runner.invoke(match, [str(path), "--record", str(tmp_path / "run.csv"), "-o",
                                str(tmp_path / "out")])  # fmt: skip
    assert done.exit_code == 0, done.output
    assert "rig.lateral_position: nobody says it" in done.output
    found = json.loads((tmp_path / "out/match.json").read_text())
    units = {"friction.coefficient": "-", "rig.frame.stiffness": "N/m", "rig.offset.y": "m",
             "rig.offset.yaw": "rad"}  # fmt: skip
    assert list(found["parameters"]) == list(units)
    truths = [TRUTH[key] for key in ("mu", "stiffness", "y", "yaw")]
    for (key, one), truth in zip(found["parameters"].items(), truths, strict=True):
        assert list(one) == ["value", "low", "high", "unit"]
        assert one["unit"] == units[key]
        assert one["low"] < truth < one["high"], (key, one)
    assert found["residuals"]["rms"] == pytest.approx(NOISE, rel=0.35)
    assert found["residuals"]["unit"] == "N"
    measured = ["left_longitudinal", "left_lateral", "right_longitudinal", "right_lateral"]
    assert [key for key in measured if key in found["residuals"]] == measured
    (own,) = found["comparison"]
    assert list(own) == ["model", "log_likelihood_held_out"]
    assert own["log_likelihood_held_out"] < 0
    # what comes out runs
    made = load_rig_scene(tmp_path / "out/match.toml")
    assert made.rig.offset is not None
    assert made.rig.offset.y == found["parameters"]["rig.offset.y"]["value"]
    assert made.positions()[3].yaw == pytest.approx(7e-3 + made.rig.offset.yaw, abs=1e-15)


def test_components_count_from_0_or_from_1(tmp_path: Path, forces: np.ndarray) -> None:
    """[0] and [3] say it; of [2] alone a vertical force's evenness does, and a lateral one is told
    with a warning."""
    path = written(tmp_path, forces, "")
    run = path.with_name("run.csv")

    def read(key: str, name: str, *more: str) -> tuple[list[str], list[str]]:
        columns = {key: MeasuredColumn(name=f"{name} kN", unit="kN", sign=-1)}
        for other in more:
            columns[other] = MeasuredColumn(name="X_right kN", unit="kN", sign=-1)
        record = read_record(run, columns)
        return [*record.signals], record.warnings

    assert read("left.force[2]", "V_left") == (["left_vertical"], [])
    assert read("left.force[1]", "L_left") == (["left_lateral"], [])
    names, warnings = read("left.force[2]", "L_left")
    assert names == ["left_lateral"]
    assert "counted from 1" in warnings[0]
    assert read("left.force[2]", "L_left", "right.force[0]")[0] == [
        "left_vertical", "right_longitudinal",
    ]  # fmt: skip
    assert read("left.force[2]", "L_left", "left.force[3]")[0] == ["left_lateral", "left_vertical"]
    with pytest.raises(RecordError, match=r"left\.force\[3\].*allowed \[0\] to \[2\]"):
        read("left.force[0]", "X_left", "left.force[3]")
    with pytest.raises(RecordError, match="left_lateral, allowed one of them"):
        read("left.force[1]", "L_left", "left_lateral")
    column = {"left.force[1]": MeasuredColumn(column="L_left kN", unit="kN", sign=-1)}
    values = read_record(run, column).signals["left_lateral"]
    assert np.abs(values - forces[:, 0, 1]).max() < 1e-2


def test_the_interface_to_the_letter(tmp_path: Path, forces: np.ndarray) -> None:
    """Its columns and all five of what it seeks; one lateral force alone cannot tell all, and that
    is said."""
    text = SOUGHT.replace('"rig.frame', '"layer.shear_modulus" = [1e8, 1e11], "rig.frame')
    text = text.replace("starts = 1", 'starts = 1\nintervals = "covariance"\nfolds = 0')
    column = '"left.force[2]" = { column = "L_left kN", unit = "kN", sign = -1 }\n'
    plan = load_match(written(tmp_path, forces, column, text))
    assert list(plan.table.observed) == ["left_lateral"]
    assert [sought.logarithmic for sought in plan.explanations[0].seek.values()] == [
        False, True, True, False, False,
    ]  # fmt: skip
    found = run_match(plan)
    assert found.to_dict()["comparison"] == [
        {"model": "the scene", "log_likelihood_held_out": None}
    ]
    assert len(found.parameters) == 5
    assert found.explanations[0].not_told


def test_offsets_absent_change_nothing() -> None:
    """And of a run without a record they are added to its rows."""
    content = read_toml(scenes() / NOMINAL)
    before = rig_scene_of(content, scenes()).positions()
    content["rig"]["offset"] = {"y": 1e-3}
    after = rig_scene_of(content, scenes()).positions()
    assert [p.y for p in after] == [p.y + 1e-3 for p in before]
    assert [p.yaw for p in after] == [p.yaw for p in before]
    content["rig"]["offset"] = {"y": 0.2}
    with pytest.raises(CaseError, match=r"rig.offset.y: value is 0.2, allowed"):
        rig_scene_of(content, scenes())


PATCH = """kind = "patch"
[material]
shear_modulus = 82e9
poisson_ratio = 0.28
[geometry]
semi_axes = [6e-3, 6e-3]
[load]
normal_force = 1e5
[motion]
creepage = [0.0, 0.0]
[friction]
coefficient = 0.3
[method]
normal = "hertz"
tangential = "polach"
[match]
record = "curve.csv"
starts = 1
sought = { "friction.coefficient" = [0.05, 0.6] }
"""


@pytest.mark.parametrize(
    ("heads", "over", "sign"),
    [
        ("creepage,force", 1.0, -1),
        ("creepage [%],creep_force [kN]", 1e3, 1),
        ("Creepage,Traction", 1e5, -1),
        ("creepage[0],creep_force[0] [N]", 1.0, 1),
    ],
)
def test_a_creep_curve_by_sought_alone(tmp_path: Path, heads: str, over: float, sign: int) -> None:
    """Creepage and force of whatever sign; units as in the heads, else SI."""
    (tmp_path / "case.toml").write_text(PATCH)
    content = read_toml(tmp_path / "case.toml")
    del content["match"]
    content["friction"]["coefficient"] = 0.4
    creepage = np.linspace(0.0, 2e-2, 30)
    states = {"creepage": np.column_stack([creepage, 0 * creepage])}
    force = np.asarray(solve_many(content, states)["creep_force"])[:, 0]
    force = force + 400.0 * np.random.default_rng(2).standard_normal(len(force))
    scale = 100.0 if "%" in heads else 1.0
    rows = [f"{scale * c:.8g},{sign * f / over:.8g}" for c, f in zip(creepage, force, strict=True)]
    (tmp_path / "curve.csv").write_text("\n".join([heads, *rows]) + "\n")
    path = tmp_path / "scene.toml"
    path.write_text(PATCH)
    plan = load_match(path)
    assert [("sign = -1" in text) for text in plan.warnings] == [True] * (sign == -1)
    found = run_match(plan)
    one = found.parameters["friction.coefficient"]
    assert one.low < 0.4 < one.high
    assert one.high - one.low < 0.01
    assert found.to_dict()["parameters"]["friction.coefficient"]["unit"] == "-"


def test_the_terminal_tells_units(tmp_path: Path) -> None:
    """Of what is found and of what is left, apart from each other however long the numbers are."""
    sought = 'sought = { "friction.coefficient" = [0.05, 0.6]'
    text = PATCH.replace(sought, sought + ', "load.normal_force" = [5e4, 2e5]')
    (tmp_path / "scene.toml").write_text(text + 'intervals = "covariance"\n')
    creepage = np.linspace(1e-3, 2e-2, 12)
    content = read_toml(tmp_path / "scene.toml")
    del content["match"]
    states = {"creepage": np.column_stack([creepage, 0 * creepage])}
    force = np.asarray(solve_many(content, states)["creep_force"])[:, 0]
    force = force + 100.0 * np.random.default_rng(4).standard_normal(len(force))
    rows = "".join(f"{c:.8g},{f:.8g}\n" for c, f in zip(creepage, force, strict=True))
    (tmp_path / "curve.csv").write_text("creepage,force [N]\n" + rows)
    call = ["match", str(tmp_path / "scene.toml"), "-o", str(tmp_path / "out")]
    shown = CliRunner().invoke(cli, call).stdout.splitlines()
    assert re.fullmatch(r"load\.normal_force +\S+ +\S+ to \S+ N", shown[1])
    assert re.fullmatch(r"friction\.coefficient +\S+ +\S+ to \S+", shown[0])
    assert re.fullmatch(r"rms of creep_force\[0\] +\S+ N", shown[2])


def test_columns_that_are_not_known_are_named(tmp_path: Path) -> None:
    path = tmp_path / "scene.toml"
    path.write_text(PATCH)
    (tmp_path / "curve.csv").write_text("slip,pull\n0.001,1\n0.002,2\n")
    with pytest.raises(CaseError, match=r"match.inputs: .* called creepage, "):
        load_match(path)
    (tmp_path / "curve.csv").write_text("creepage,force [mm]\n0.001,1\n0.002,2\n")
    with pytest.raises(RecordError, match=r"unit is 'mm', allowed one of a force"):
        load_match(path)


@pytest.mark.parametrize(
    ("head", "message"),
    [
        ("creepage [mm]", r"inputs.creepage\[0\].*unit: value is 'mm', allowed -, %, permille"),
        ("creepage,spin_creepage [1/mm]", r"spin_creepage.*'1/mm', allowed rad/m"),
        ("creepage,speed [N]", r"rolling_speed.*value is 'N', allowed m/s, km/h"),
    ],
)
def test_units_are_those_of_the_key_that_a_column_drives(
    tmp_path: Path, head: str, message: str
) -> None:
    path = tmp_path / "scene.toml"
    path.write_text(PATCH)
    zeros = ",1" * head.count(",")
    rows = "".join(f"{1e-3 * k}{zeros},{1e3 * k}\n" for k in range(1, 6))
    (tmp_path / "curve.csv").write_text(f"{head},force [N]\n{rows}")
    with pytest.raises(RecordError, match=message):
        load_match(path)


def test_an_observed_force_in_what_is_no_force_is_refused(tmp_path: Path) -> None:
    text = (
        PATCH
        + """
[match.inputs]
"creepage[0]" = { name = "slip", unit = "%" }
[match.observed]
"creep_force[0]" = { name = "pull", unit = "kp" }
"""
    )
    path = tmp_path / "scene.toml"
    path.write_text(text)
    (tmp_path / "curve.csv").write_text("slip;pull\n" + "".join(f"{k};{k}\n" for k in range(6)))
    with pytest.raises(RecordError, match=r"creep_force\[0\].*value is 'kp', allowed N, kN"):
        load_match(path)


@pytest.mark.parametrize(("unit", "scale"), [("", 1e2), ("", 1e3), ("%", 1e2), ("‰", 1e3)])
def test_creepages_that_can_hardly_be_meant(tmp_path: Path, unit: str, scale: float) -> None:
    """Creepages to 5 %, in per cent or per mille: said in the head, they are these; else a
    warning names the unit that would fit."""
    path = tmp_path / "scene.toml"
    path.write_text(PATCH)
    creepage = np.linspace(2e-3, 5e-2, 25)
    head = f"creepage [{unit}]" if unit else "creepage"
    rows = "".join(f"{scale * c:.6g},{-1e4 * c:.6g}\n" for c in creepage)
    (tmp_path / "curve.csv").write_text(f"{head},force [N]\n{rows}", encoding="utf-8")
    plan = load_match(path)
    doubts = [text for text in plan.warnings if "hardly meant of a creepage" in text]
    if unit:
        assert doubts == []
        np.testing.assert_allclose(plan.inputs()["creepage[0]"], creepage, rtol=1e-5)
    else:
        assert len(doubts) == 1
        assert doubts[0].endswith("'permille'?" if scale > 1e2 else "'%' or 'permille'?")


@pytest.mark.parametrize(
    ("table", "message"),
    [
        ({}, "match.sought: value is missing"),
        ({"sought": {"a": [0.0, 1.0]}, "seek": {"a": {"low": 0.0, "high": 1.0}}}, "with 'seek'"),
        ({"sought": {"a": [1.0, 0.0]}}, r"match.sought.a.*low: value is 1.0, allowed below high"),
        ({"sought": {"a": [1.0]}}, r"match.sought.a"),
    ],
)
def test_wrong_tables_are_refused(table: dict, message: str) -> None:
    with pytest.raises(CaseError, match=message):
        check_table(MatchTable, table, "match")
