"""The command: files, exit codes, help."""

from __future__ import annotations

import csv
from pathlib import Path

from click.testing import CliRunner
from page_checks import check_page
from railpatch.command.cli import cli


def run(*arguments: object):
    return CliRunner().invoke(cli, ["stress", *map(str, arguments)])


def test_files(tmp_path: Path) -> None:
    result = run("-o", tmp_path, "--only", "shape: a/b = 5*")
    assert result.exit_code == 0, result.output
    assert "0 faults" in result.output
    with (tmp_path / "stress.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert {row["method"] for row in rows} >= {"full", "fitted rows", "table", "fastsim"}
    page = (tmp_path / "stress.html").read_text(encoding="utf-8")
    text = (tmp_path / "stress.md").read_text(encoding="utf-8")
    for row in rows:
        assert f"shape: {row['name']}" in page
        assert float(row["residual"]) <= 1e-5 or row["status"] != "converged"
    assert "# Numerical stability" in text
    check_page(tmp_path / "stress.html")


def test_nothing_matches(tmp_path: Path) -> None:
    result = run("-o", tmp_path / "new", "--only", "nothing of that kind")
    assert result.exit_code == 2
    assert "--only" in result.output
    assert not (tmp_path / "new").exists()


def test_quiet(tmp_path: Path) -> None:
    result = run("-o", tmp_path, "--only", "load: 1 N, full", "--quiet")
    assert (result.exit_code, result.output) == (0, "")
    assert sorted(path.name for path in tmp_path.iterdir()) == [
        "stress.csv", "stress.html", "stress.md",
    ]  # fmt: skip
