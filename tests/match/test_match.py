"""Parameters from points that were made with known ones: found, inside their intervals, and what
the points cannot tell is said."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import railpatch
from click.testing import CliRunner
from page_checks import check_page
from railpatch.command.cli import cli
from railpatch.match import load_match, run_match
from railpatch.match.command import example_text

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
polach_k_a = 1.0
polach_k_s = 1.0
"""
MATCH = """
[match]
record = "points.csv"
starts = 2
[match.inputs]
"creepage[0]" = { name = "slip", unit = "%" }
[match.observed]
"creep_force[0]" = { name = "traction", unit = "-", sign = -1, over = "normal_force" }
[match.seek]
"friction.coefficient" = { low = 0.05, high = 0.6 }
"method.polach_k_a" = { low = 0.05, high = 1.0, logarithmic = true }
"""
TRUTH = {"friction.coefficient": 0.34, "method.polach_k_a": 0.4}


def made_points(folder: Path, seed: int, noise: float, count: int = 60) -> None:
    """Points of the scene with the true values, in other units and signs, with noise."""
    slip = np.geomspace(2e-4, 2e-2, count)
    case = load_text(SCENE)
    case["friction"]["coefficient"] = TRUTH["friction.coefficient"]
    case["method"]["polach_k_a"] = TRUTH["method.polach_k_a"]
    creepage = np.column_stack([slip, np.zeros(count)])
    force = railpatch.solve_many(case, {"creepage": creepage})["creep_force"][:, 0]
    random = np.random.default_rng(seed)
    traction = -force / 8e4 + noise * random.standard_normal(count)
    lines = [f"{100 * s:.6g};{t:.6g}" for s, t in zip(slip, traction, strict=True)]
    (folder / "points.csv").write_text("slip;traction\n" + "\n".join(lines) + "\n")


def load_text(text: str) -> dict[str, Any]:
    try:
        import tomllib
    except ImportError:
        import tomli as tomllib
    return tomllib.loads(text)


def written(folder: Path, text: str = MATCH, scene: str = SCENE) -> Path:
    path = folder / "match.toml"
    path.write_text(scene + text)
    return path


@pytest.fixture
def points(tmp_path: Path) -> Path:
    made_points(tmp_path, 1, 0.005)
    return tmp_path


def test_finds_what_the_points_were_made_with(points: Path) -> None:
    found = run_match(load_match(written(points)))
    own = found.explanations[0]
    for key, truth in TRUTH.items():
        parameter = found.parameters[key]
        assert parameter.low < truth < parameter.high
        assert parameter.low < parameter.value < parameter.high
        assert abs(parameter.value - truth) < 0.1 * truth
    # noise of 0.005, of which 60 points know the size to some tenth
    assert own.fit.rms[0] == pytest.approx(0.005, rel=0.3)
    assert own.fit.noise.size == 0
    assert own.not_told == ()
    assert own.predicted is not None
    assert own.predicted.within > 0.85


def test_values_follow_least_squares(points: Path) -> None:
    """The optimum is one: no neighbour has a smaller sum of squares."""
    text = MATCH.replace(
        "starts = 2", 'starts = 1\nloss = "linear"\ndiscrepancy = false\nfolds = 0'
    )
    found = run_match(load_match(written(points, text)))
    search, fit = found.explanations[0].search, found.explanations[0].fit

    def squares(shares: np.ndarray) -> float:
        return float(np.sum((search.computed(shares) - search.measured) ** 2))

    least = squares(fit.shares)
    for k in range(2):
        for step in (-0.01, 0.01):
            moved = fit.shares.copy()
            moved[k] += step
            assert squares(moved) > least
    # intervals: where the likelihood, with the other parameter sought anew, has fallen by 3.84 / 2
    for k, (low, high) in enumerate(fit.intervals):
        for end in (low, high):
            others = []
            for other in np.linspace(0.0, 1.0, 401):
                shares = np.array([other, other])
                shares[k] = end
                others.append(squares(shares))
            rise = (min(others) - least) / fit.noise.error[0] ** 2
            assert rise == pytest.approx(3.84, rel=0.15)


def test_says_what_cannot_be_told(points: Path) -> None:
    """Two stiffnesses in series are known by one number."""
    scene = SCENE.replace('tangential = "polach"', 'tangential = "full"').replace(
        "polach_k_a = 1.0\npolach_k_s = 1.0", "[grid]\nelements = [8, 8]"
    )
    scene += "[layer]\nshear_modulus = 8e9\nthickness = 1e-4\n"
    text = MATCH.replace(
        '"method.polach_k_a" = { low = 0.05, high = 1.0, logarithmic = true }',
        '"layer.shear_modulus" = { low = 1e8, high = 1e12, logarithmic = true }\n'
        '"layer.thickness" = { low = 1e-6, high = 1e-1, logarithmic = true }',
    ).replace("starts = 2", 'starts = 1\nintervals = "covariance"\nfolds = 0')
    rows = (points / "points.csv").read_text().splitlines()
    (points / "points.csv").write_text("\n".join(rows[:1] + rows[1::6]) + "\n")
    found = run_match(load_match(written(points, text, scene)))
    told = " ".join(found.explanations[0].not_told)
    assert "layer.shear_modulus and layer.thickness: nearly only their quotient" in told or (
        "layer.thickness: not known" in told and "layer.shear_modulus: not known" in told
    )
    assert "friction.coefficient" not in told


def test_explanations_are_compared(points: Path) -> None:
    text = MATCH + (
        '[match.explanations.kalker]\nchange = { "method.polach_k_a" = 1.0 }\n'
        'seek = { "friction.coefficient" = { low = 0.05, high = 0.6 } }\n'
    )
    own, kalker = run_match(load_match(written(points, text))).explanations
    assert kalker.explanation.name == "kalker"
    assert kalker.fit.rms[0] > 2 * own.fit.rms[0]
    assert kalker.criterion > own.criterion + 10
    assert own.predicted is not None
    assert kalker.predicted is not None
    assert own.predicted.density > kalker.predicted.density


def test_a_prior_holds_what_points_do_not_know(points: Path) -> None:
    prior = '"method.polach_k_s" = { low = 0.02, high = 1.0, prior = 0.5, prior_error = 0.001 }\n'
    found = run_match(load_match(written(points, MATCH.replace("folds", "folds") + prior)))
    assert found.parameters["method.polach_k_s"].value == pytest.approx(0.5, abs=3e-3)


def test_command_writes_a_scene_that_runs(points: Path) -> None:
    ran = CliRunner().invoke(
        cli, ["match", str(written(points)), "-o", str(points / "out"), "--json"]
    )
    assert ran.exit_code == 0, ran.output
    shown = json.loads(ran.stdout)
    stored = json.loads((points / "out" / "match.json").read_text())
    assert shown["parameters"] == stored["parameters"]
    assert set(stored["parameters"]) == set(TRUTH)
    result = railpatch.solve(points / "out" / "match.toml")
    assert result.status == "converged"
    rows = (points / "out" / "match.csv").read_text().splitlines()
    assert len(rows) == 61
    check_page(points / "out" / "match.html")
    page = (points / "out" / "match.html").read_text()
    assert "friction.coefficient" in page


def test_example_is_a_match(tmp_path: Path) -> None:
    path = tmp_path / "example.toml"
    path.write_text(example_text())
    (tmp_path / "creep_curve.csv").write_text(
        "creepage,traction\n0.1,0.1\n0.5,0.3\n1,0.3\n2,0.28\n"
    )
    plan = load_match(path)
    assert [e.name for e in plan.explanations] == ["the scene", "coulomb"]
    assert plan.inputs()["creepage[0]"].tolist() == pytest.approx([1e-3, 5e-3, 1e-2, 2e-2])
    for explanation in plan.explanations:
        start = {key: sought.at(0.5) for key, sought in explanation.seek.items()}
        assert railpatch.solve(explanation.case(start)).status == "converged"


WRONG = {
    "no table": ("", "match: value is missing"),
    "misspelt": (MATCH.replace("starts", "start"), "start"),
    "ends": (MATCH.replace("low = 0.05, high = 0.6", "low = 0.6, high = 0.05"), "below high"),
    "logarithm": (MATCH.replace("low = 0.05, high = 1.0", "low = 0.0, high = 1.0"), "> 0 where"),
    "column": (MATCH.replace('"slip"', '"slipp"'), "did you mean 'slip'"),
    "input": (MATCH.replace("creepage[0]", "creepages[0]"), "match.inputs"),
    "component": (MATCH.replace("creepage[0]", "creepage[2]"), "[0] to [1]"),
    "result": (MATCH.replace("creep_force[0]", "creep_force"), "allowed creep_force[0 to 1]"),
    "key": (MATCH.replace("method.polach_k_a", "method.polach_ka"), "polach_ka"),
    "range": (MATCH.replace("high = 0.6", "high = 60.0"), "coefficient"),
    "prior": (MATCH.replace("high = 0.6", "high = 0.6, prior = 0.3"), "prior_error"),
    "leave out": (MATCH + '[match.explanations.a]\nleave_out = ["layer"]\n', "leave_out"),
    "record": (MATCH.replace("points.csv", "other.csv"), "other.csv"),
}


@pytest.mark.parametrize("name", WRONG)
def test_what_is_wrong_is_named(name: str, points: Path) -> None:
    text, words = WRONG[name]
    ran = CliRunner().invoke(cli, ["match", str(written(points, text)), "-o", str(points / "out")])
    assert ran.exit_code == 2, ran.output
    assert words in ran.stderr
    assert not (points / "out").exists()


@pytest.mark.long
def test_intervals_hold_the_truth(tmp_path: Path, measured: Any) -> None:
    """100 curves of 60 to 200 points, noise 0.5 to 3 % of the load."""
    random = np.random.default_rng(7)
    inside = dict.fromkeys(TRUTH, 0)
    bias = {key: [] for key in TRUTH}
    for seed in range(100):
        made_points(tmp_path, seed, random.uniform(0.005, 0.03), int(random.integers(60, 200)))
        found = run_match(load_match(written(tmp_path)))
        for key, truth in TRUTH.items():
            parameter = found.parameters[key]
            inside[key] += parameter.low < truth < parameter.high
            bias[key].append((parameter.value - truth) / (parameter.high - parameter.low))
    measured(f"match: intervals of 95 % hold the truth in {inside} of 100")
    for key in TRUTH:
        assert 90 <= inside[key] <= 98
        assert abs(np.mean(bias[key])) < 0.2
