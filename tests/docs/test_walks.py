"""Commands of the guides, as they stand there, one after the other in an empty folder."""

from __future__ import annotations

import shlex
import sys
from pathlib import Path

import pytest
from click.testing import CliRunner
from railpatch.command.cli import cli

DOCS = Path(__file__).resolve().parents[2] / "docs"
sys.path.insert(0, str(DOCS))

import walks  # noqa: E402


@pytest.mark.parametrize(("page", "count"), [("measured_runs.md", 6), ("logs.md", 7)])
def test_commands_as_they_stand(
    page: str, count: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    lines = [shlex.split(line) for line in walks.commands(page)]
    found = [words[1:] for words in lines if words[0] == "railpatch"]
    assert len(found) >= count
    for words in found:
        if words[0] == "match":
            # the example has measured nothing that could be matched: the command is tried with
            # an own record in tests/match
            continue
        ended = CliRunner().invoke(cli, words)
        assert ended.exit_code == 0, (words, ended.output)


@pytest.mark.parametrize("walk", walks.WALKS, ids=lambda w: f"{w.person} {w.page} {w.spoken}")
def test_each_person_has_something_to_follow(walk: walks.Walk) -> None:
    """What the page gives to do; who follows it, and what to install, stands on the page too."""
    installs, lines, code = walks.words_of(walk)
    assert lines
    assert bool(code) == (walk.page.endswith(".py") and not walk.spoken)
    first = next(w for w in walks.WALKS if w.person == walk.person)
    if walk == first:
        assert installs, "the first page does not say what to install"
