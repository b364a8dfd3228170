"""No mistake of docs/mistakes.md gives a wrong result without a word, and the page says which."""

from __future__ import annotations

from pathlib import Path

import pytest
from case.mistakes import FOOT, HEAD, MISTAKES, PERSONS, section

PAGE = Path(__file__).parents[2] / "docs" / "mistakes.md"


@pytest.mark.parametrize("person", PERSONS)
def test_every_mistake_is_told(person: str) -> None:
    page = PAGE.read_text(encoding="utf-8")
    lines = section(person)
    silent = [line for line in lines[4:] if line.endswith("| 0 |  |")]
    assert silent == []
    assert "\n".join(lines) in page, "python tests/case/mistakes.py > docs/mistakes.md"


def test_the_page_has_them_all() -> None:
    page = PAGE.read_text(encoding="utf-8")
    assert page.startswith(HEAD)
    assert len(MISTAKES) >= 60
    assert page.endswith(FOOT)
    assert page.removesuffix(FOOT).count("\n| ") == len(MISTAKES) + len(PERSONS)
