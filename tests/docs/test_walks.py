"""Commands of the guides, as they stand there, one after the other in an empty folder."""

from __future__ import annotations

import re
import shlex
from pathlib import Path

import pytest
from click.testing import CliRunner
from railpatch.command.cli import cli

DOCS = Path(__file__).resolve().parents[2] / "docs"
BLOCK = re.compile(r"^```sh\n(.*?)^```", re.DOTALL | re.MULTILINE)
FORM = re.compile(r"\[|\b[A-Z]{3,}\b")
INDENTED = re.compile(r"^ {4}(railpatch .*)$", re.MULTILINE)


def commands(page: str) -> list[list[str]]:
    """Of railpatch, in a page's first block and in its indented lines, without comments; what has
    placeholders in capitals is a form, not a command."""
    text = (DOCS / page).read_text(encoding="utf-8")
    block = BLOCK.search(text)
    lines = [*(block[1].splitlines() if block else []), *INDENTED.findall(text)]
    found = [shlex.split(line, comments=True) for line in lines]
    return [
        words[1:]
        for words in found
        if words[:1] == ["railpatch"] and not FORM.search(" ".join(words))
    ]


@pytest.mark.parametrize(("page", "count"), [("measured_runs.md", 6), ("logs.md", 7)])
def test_commands_as_they_stand(
    page: str, count: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    found = commands(page)
    assert len(found) >= count
    for words in found:
        if words[0] == "match":
            # the example has measured nothing that could be matched: the command is tried with
            # an own record in tests/match
            continue
        ended = CliRunner().invoke(cli, words)
        assert ended.exit_code == 0, (words, ended.output)
