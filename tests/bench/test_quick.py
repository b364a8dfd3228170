"""A quick run: complete, and its errors within what the theories allow. No time is asserted."""

from __future__ import annotations

import csv
import gzip
import json
import re
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from click.testing import CliRunner, Result
from page_checks import check_page
from railpatch.command.cli import cli
from railpatch.evidence.bench import cost, evaluations, features, methods, run, tail
from railpatch.evidence.bench.measure import COLUMNS
from railpatch.evidence.bench.methods import METHODS, UNIFORM, Method
from railpatch.evidence.bench.sets import SETS
from railpatch.evidence.bench.targets import TARGETS

FILES = (
    "report.html",
    "summary.csv",
    "cases.csv.gz",
    "cost.csv",
    "features.csv",
    "tail.csv",
    "run.json",
    "frontier.svg",
)
# 95th percentiles of the force error. Uniform elements: the contact's edge, and with it the length
# of each row, is uncertain by an element of the n across. Fast theories err by 5 to 30 %. Fitted
# rows of scale 14: below a per cent, what they are for
FASTSIM_ERROR = 0.3
FITTED_ERROR = 0.01


def bench(*arguments: str) -> Result:
    return CliRunner().invoke(cli, ["bench", *arguments])


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("bench") / "out"
    with pytest.MonkeyPatch.context() as patch:
        # all is timed, but not over and over
        patch.setattr(methods, "FAST_REPEAT", 1)
        patch.setattr(cost, "MOST_PASSES", 1)
        patch.setattr(evaluations, "QUICK_PASSES", 2)
        patch.setattr(features, "QUICK_PASSES", 2)
        patch.setattr(tail, "QUICK_STEPS", 20)
        patch.setattr(run, "QUICK_RIG_POSITIONS", 5)
        result = bench("--quick", "-o", str(path))
    assert result.exit_code == 0, result.output
    for name in FILES:
        assert str(path / name) in result.output
    return path


@pytest.fixture(scope="module")
def summary(folder: Path) -> list[dict[str, str]]:
    with (folder / "summary.csv").open(newline="") as file:
        return list(csv.DictReader(file))


def test_every_point_is_there(summary: list[dict[str, str]]) -> None:
    wanted = [
        (method.name, str(elements), name)
        for method in METHODS
        for elements in method.quick
        for name in SETS
        if name in method.sets
    ]
    assert [(row["method"], row["elements"], row["set"]) for row in summary] == wanted
    assert all(float(row["warm_median"]) > 0 for row in summary)
    assert all(float(row["bytes"]) > 0 for row in summary)


def test_errors(summary: list[dict[str, str]]) -> None:
    full = [row for row in summary if row["method"] == UNIFORM.name]
    for row in full:
        assert row["not_converged"] == "0", row["label"]
        if row["set"] != "W":
            assert float(row["force_error_p95"]) <= 1 / int(row["elements"]), row["label"]
        # results do not depend on the start by more than the solver's tolerance
        assert float(row["start_difference_max"]) <= 1e-5, row["label"]
    errors = [float(row["force_error_p95"]) for row in full if row["set"] == "A"]
    assert errors == sorted(errors, reverse=True)
    rows = [r for r in summary if r["method"].startswith("fitted")]
    assert all(row["not_converged"] == "0" for row in rows)
    fitted = [float(r["force_error_p95"]) for r in rows if r["set"] == "A"]
    assert fitted == sorted(fitted, reverse=True)
    assert fitted[-1] < FITTED_ERROR
    for row in summary:
        if row["method"] == "fastsim" and row["set"] == "A":
            assert errors[-1] < float(row["force_error_p95"]) < FASTSIM_ERROR
            # Hertz's pressure is exact
            assert float(row["pressure_error_max"]) < 1e-9


def test_cases(folder: Path, summary: list[dict[str, str]]) -> None:
    with gzip.open(folder / "cases.csv.gz", "rt", newline="") as file:
        rows = list(csv.DictReader(file))
    assert set(COLUMNS) <= set(rows[0])
    assert len(rows) == sum(int(row["cases"]) for row in summary)
    chosen = [
        float(row["force_error"])
        for row in rows
        if (row["method"], row["elements"], row["set"]) == (UNIFORM.name, "16", "A")
        and row["good"] == "1"
    ]
    stated = next(
        float(row["force_error_max"])
        for row in summary
        if (row["method"], row["elements"], row["set"]) == (UNIFORM.name, "16", "A")
    )
    assert max(chosen) == pytest.approx(stated, rel=1e-5)


def test_page(folder: Path, summary: list[dict[str, str]]) -> None:
    check_page(folder / "report.html")
    page = (folder / "report.html").read_text(encoding="utf-8")
    body = re.sub(r"<(script|style).*?</\1>", "", page, flags=re.S)
    assert "src=" not in body
    assert "<link" not in body
    text = re.sub(r"<[^>]+>", " ", body)
    for row in summary:
        assert row["label"] in text
    for name, problem_set in SETS.items():
        assert f"Set {name}: {problem_set.title}" in text
    for target in TARGETS:
        assert target.title in text.replace("&#x27;", "'")
    for word in ("FFT", "Truth", "Error estimates", "The slowest steps", "CONTACT"):
        assert word in text
    for figure in ("frontier", "cost"):
        assert f'id="{figure}"' in page


def test_pictures(folder: Path) -> None:
    root = ElementTree.parse(folder / "frontier.svg").getroot()
    assert root.tag.endswith("svg")
    assert (folder / "frontier.png").read_bytes().startswith(b"\x89PNG")


def test_run_file(folder: Path) -> None:
    content = json.loads((folder / "run.json").read_text())
    assert content["quick"] is True
    assert content["machine"]["fft_time"] > 0
    assert len(content["targets"]) == len(TARGETS)
    with (folder / "cost.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    elements = np.array([int(row["elements"]) for row in rows if row["method"] == UNIFORM.name])
    assert (np.diff(elements) > 0).all()


def test_refused_method_ends_the_run(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    wrong = Method("new", "a new theory", {"method": {"tangential": "unheard_of"}}, sets="A")
    monkeypatch.setattr(methods, "METHODS", (wrong,))
    result = bench("--quick", "-o", str(tmp_path / "out"))
    assert result.exit_code == 2
    assert "method.tangential" in result.output
    assert not (tmp_path / "out").exists()


def test_method_without_a_grid() -> None:
    # a method that takes the grid away, as one that chooses it does
    free = Method("free", "free", {"grid": None}, grids=(0,), quick=(0,), sets="A")
    run.Plan((free,), "A", True).check()


@pytest.mark.parametrize(
    ("arguments", "word"),
    [
        (["--sets", "AX"], "--sets"),
        (["--sets", "AA"], "--sets"),
        (["--methods", "fastsim,none_such"], "none_such"),
        (["--truth-file", "absent.npz"], "absent.npz"),
    ],
)
def test_wrong_calls(arguments: list[str], word: str, tmp_path: Path) -> None:
    result = bench("-o", str(tmp_path / "out"), *arguments)
    assert result.exit_code == 2
    assert word in result.output
    assert not (tmp_path / "out").exists()
