"""Beside parameters: what points feel, measuring chains, samples of the posterior, each row's own
lateral position; by points that were made with known values."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from railpatch.case.kinds import kind_of
from railpatch.command.cli import cli
from railpatch.errors import CaseError
from railpatch.match import load_match, run_match, sample, write_match

SCENE = """
kind = "patch"
[geometry]
semi_axes = [6e-3, 4e-3]
[load]
normal_force = 8e4
[motion]
creepage = [0.0, 0.0]
spin_creepage = 0.0
[friction]
coefficient = 0.3
[method]
normal = "hertz"
tangential = "polach"
polach_k_a = 0.4
polach_k_s = 0.4
[match]
record = "points.csv"
starts = 1
folds = 0
discrepancy = false
loss = "linear"
intervals = "covariance"
[match.inputs]
"creepage[0]" = { name = "slip", unit = "%" }
[match.observed]
"creep_force[0]" = { name = "traction", sign = -1, over = "normal_force", error = 0.005 }
[match.seek]
"friction.coefficient" = { low = 0.05, high = 0.6, start = 0.4 }
"""
TRUTH = 0.34
OFFSET = 0.02


@pytest.fixture
def points(tmp_path: Path) -> Path:
    """By Polach's formula (2005), k_A = k_S = 0.4: F = 2 Q mu/pi (k e/(1 + (k e)^2) + atan(k e)),
    with e so large that half of the points slide; an offset beside noise of 0.005."""
    random = np.random.default_rng(4)
    slip = np.geomspace(1e-4, 3e-2, 40)
    import railpatch

    case = {
        "kind": "patch",
        "geometry": {"semi_axes": [6e-3, 4e-3]},
        "load": {"normal_force": 8e4},
        "motion": {"creepage": [0.0, 0.0], "spin_creepage": 0.0},
        "friction": {"coefficient": TRUTH},
        "method": {
            "normal": "hertz", "tangential": "polach", "polach_k_a": 0.4, "polach_k_s": 0.4,
        },
    }  # fmt: skip
    creepage = np.column_stack([slip, np.zeros(40)])
    force = railpatch.solve_many(case, {"creepage": creepage})["creep_force"][:, 0]
    traction = -force / 8e4 + OFFSET + 0.005 * random.standard_normal(40)
    rows = [f"{100 * s:.6g};{t:.6g}" for s, t in zip(slip, traction, strict=True)]
    (tmp_path / "points.csv").write_text("slip;traction [-]\n" + "\n".join(rows) + "\n")
    return tmp_path


def written(folder: Path, text: str) -> Path:
    (folder / "match.toml").write_text(text)
    return folder / "match.toml"


def test_an_offset_is_found_beside_the_parameters(points: Path) -> None:
    """As a third number of linear least squares gives it."""
    plain = run_match(load_match(written(points, SCENE))).parameters["friction.coefficient"]
    text = SCENE.replace("error = 0.005", "error = 0.005, offset_error = 0.05")
    found = run_match(load_match(written(points, text)))
    own = found.explanations[0]
    parameter = found.parameters["friction.coefficient"]
    value, error = own.chains["creep_force[0]"]["offset"]
    # signs of the column count: what is computed is against what was measured
    assert value == pytest.approx(-OFFSET, abs=3 * error)
    assert error < 0.005
    assert parameter.low < TRUTH < parameter.high
    assert not plain.low < TRUTH < plain.high
    # the same by Golub and Pereyra's way: the offset eliminated from residual and slope, its prior
    # of 0.05 as a further equation
    search, fit = own.search, own.fit
    slope, left = fit.slopes[0, :, 0] / 0.005, fit.left[0] / 0.005
    ones = np.ones(40) / 0.005
    matrix = np.append(ones, 1 / 0.05)
    away = np.eye(41) - np.outer(matrix, matrix) / (matrix @ matrix)
    projected = away @ np.append(slope, 0.0)
    assert fit.covariance[0, 0] == pytest.approx(1 / (projected @ projected), rel=1e-6)
    assert value == pytest.approx(float(matrix[:-1] @ left / (matrix @ matrix)), rel=1e-6)
    assert search.chains(fit)["creep_force[0]"]["offset"][1] == pytest.approx(
        (matrix @ matrix) ** -0.5, rel=1e-6
    )


def test_a_factor_keeps_the_friction_from_being_told(points: Path) -> None:
    """Where points slide they measure the product of both."""
    text = SCENE.replace("error = 0.005", "error = 0.005, offset_error = 0.05")
    narrow = run_match(load_match(written(points, text))).parameters["friction.coefficient"]
    text = text.replace("offset_error", "factor_error = 0.1, offset_error")
    wide = run_match(load_match(written(points, text))).parameters["friction.coefficient"]
    assert wide.high - wide.low > 2 * (narrow.high - narrow.low)
    assert wide.low < TRUTH < wide.high
    assert wide.high - wide.low < 2 * 1.96 * 0.11 * TRUTH


def test_screening_says_what_points_do_not_feel(points: Path) -> None:
    """Poisson's ratio by a thousandth moves nothing."""
    text = SCENE.replace("starts = 1", "starts = 1\nscreening = true") + (
        '"material.poisson_ratio" = { low = 0.279, high = 0.281 }\n'
        '"method.polach_k_a" = { low = 0.05, high = 0.95 }\n'
    )
    own = run_match(load_match(written(points, text))).explanations[0]
    felt = own.screening
    assert set(felt) == {"friction.coefficient", "method.polach_k_a", "material.poisson_ratio"}
    assert next(iter(felt)) == "friction.coefficient"
    # over its range of 0.55 friction moves the points that slide by 110 errors
    assert 30 < felt["friction.coefficient"].effect < 110
    assert not felt["material.poisson_ratio"].felt
    assert any("material.poisson_ratio: the points do not feel" in s for s in own.not_told)


def test_samples_agree_with_the_interval(points: Path) -> None:
    """One parameter, normal noise: the posterior is all but normal."""
    text = SCENE.replace("starts = 1", 'starts = 1\nsampling = "emcee"\nsamples = 120')
    text = text.replace("error = 0.005", "error = 0.005, offset_error = 0.05")
    found = run_match(load_match(written(points, text)))
    drawn = found.explanations[0].samples["friction.coefficient"]
    parameter = found.parameters["friction.coefficient"]
    width = parameter.high - parameter.low
    # 768 samples of a walk that forgets itself in some ten steps know the ends to a tenth or two
    assert drawn.median == pytest.approx(parameter.value, abs=0.15 * width)
    assert drawn.low == pytest.approx(parameter.low, abs=0.2 * width)
    assert drawn.high == pytest.approx(parameter.high, abs=0.2 * width)
    again = run_match(load_match(points / "match.toml")).explanations[0].samples
    assert again["friction.coefficient"] == drawn


def test_a_sampler_that_is_absent_is_named(points: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sample, "find_spec", lambda name: None)
    text = SCENE.replace("starts = 1", 'starts = 1\nsampling = "emcee"')
    with pytest.raises(CaseError, match=r"emcee is not installed: .*railpatch\[sampling\]"):
        run_match(load_match(written(points, text)))


def test_editors_know_the_table() -> None:
    """In schemas of what can be matched, and of nothing else."""
    for name in ("patch", "wheelset", "rig"):
        schema = kind_of(name).schema()
        assert "match" in schema["properties"]
        assert "match" not in schema["required"]
        assert {"seek", "sought"} <= set(schema["$defs"]["MatchTable"]["properties"])
    assert "match" not in kind_of("curve").schema()["properties"]


RIG = """
[rig]
record = "record.csv"
[match]
starts = 1
intervals = "covariance"
[match.rows.lateral_position]
low = -3e-3
high = 3e-3
starts = 7
[match.observed]
left_ratio = { error = 0.005 }
right_ratio = { error = 0.005 }
left_longitudinal = { error = 100.0 }
right_longitudinal = { error = 100.0 }
[match.seek]
"friction.coefficient" = { low = 0.2, high = 0.8, start = 0.45 }
"""


def test_lateral_positions_that_nobody_measured(tmp_path: Path) -> None:
    """Friction from forces and yaw alone, on a nominal rig of three rows with known positions."""
    from rig_model.follow import Follower
    from rig_model.scene import NOMINAL, scenes

    lateral, yaw = (0.5e-3, 1.2e-3, -1.0e-3), (2e-3, 8e-3, -5e-3)
    text = (scenes() / NOMINAL).read_text()
    text = text[: text.index("[rig]")].replace("[0.4e-3, 0.4e-3]", "[1e-3, 1e-3]")
    names = [f"{s}_{n}" for s in ("left", "right") for n in ("lateral", "vertical", "longitudinal")]
    heads = ["time [s]", "yaw [rad]", "lateral_position [m]", *(f"{name} [N]" for name in names)]
    table = np.column_stack([10.0 * np.arange(3), yaw, lateral, np.full((3, 6), 5e4)])

    def record(columns: list[int]) -> None:
        rows = [",".join(repr(float(row[k])) for k in columns) for row in table]
        named = ",".join(heads[k] for k in columns)
        (tmp_path / "record.csv").write_text("\n".join([named, *rows]) + "\n")

    record(list(range(9)))
    path = written(tmp_path, text + '[rig]\nrecord = "record.csv"\n')
    from railpatch.case.load import read_toml

    content = read_toml(path)
    table[:, 3:] = Follower(content, tmp_path, names).computed(content).T
    record([0, 1, *range(3, 9)])
    path = written(tmp_path, text.replace("coefficient = 0.52", "coefficient = 0.4") + RIG)
    found = run_match(load_match(path))
    own = found.explanations[0]
    parameter = found.parameters["friction.coefficient"]
    assert parameter.low < 0.52 < parameter.high
    assert parameter.high - parameter.low < 0.04
    assert own.rows is not None
    assert own.rows.values == pytest.approx(lateral, abs=5e-5)
    assert np.all((own.rows.low < lateral) & (lateral < own.rows.high))
    write_match(found, tmp_path / "out")
    stored = json.loads((tmp_path / "out" / "match.json").read_text())
    assert stored["rows"]["lateral_position"]["value"] == own.rows.values.tolist()
    head, first = (tmp_path / "out" / "match.csv").read_text().splitlines()[:2]
    assert float(first.split(",")[head.split(",").index('"lateral_position"')]) == pytest.approx(
        own.rows.values[0]
    )
    # what comes of it runs: rows stand in the scene
    ended = kind_of("rig").run(tmp_path / "out" / "match.toml", tmp_path / "again.mcap")
    assert ended.status == "converged"


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        ("rows.roll", "allowed lateral_position, yaw"),
        ("discrepancy", "false with rows"),
        ("factor", "none of them with rows"),
        ("patch", "allowed of a rig only"),
    ],
)
def test_what_rows_are_not_for_is_named(points: Path, changed: str, words: str) -> None:
    text = SCENE + "[match.rows.lateral_position]\nlow = -1e-3\nhigh = 1e-3\n"
    if changed == "rows.roll":
        from rig_model.scene import NOMINAL, scenes

        rig = (scenes() / NOMINAL).read_text()
        text = rig[: rig.index("[rig]")] + RIG.replace("rows.lateral_position", "rows.roll")
        (points / "record.csv").write_text("time [s],yaw [rad]\n0,0.001\n1,0.002\n")
    elif changed == "discrepancy":
        text = text.replace("discrepancy = false", "discrepancy = true")
    elif changed == "factor":
        text = text.replace("error = 0.005", "error = 0.005, factor_error = 0.1")
    ran = CliRunner().invoke(cli, ["match", str(written(points, text)), "-o", str(points / "o")])
    assert ran.exit_code == 2, ran.output
    assert words in ran.stderr
