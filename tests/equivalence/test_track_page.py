"""The cases of docs/track.md, as they stand there."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
import railpatch

PAGE = Path(__file__).parents[2] / "docs" / "track.md"
BLOCKS = re.findall(r"^```toml\n(.*?)^```", PAGE.read_text(encoding="utf-8"), re.M | re.S)


def test_cases_are_found() -> None:
    assert len(BLOCKS) == 2


@pytest.mark.parametrize("index", range(len(BLOCKS)))
def test_case_is_solved(tmp_path: Path, index: int) -> None:
    path = tmp_path / "case.toml"
    path.write_text(BLOCKS[index], encoding="utf-8")
    assert railpatch.solve(path).status == "converged"


def test_the_step_of_the_page(tmp_path: Path) -> None:
    path = tmp_path / "case.toml"
    path.write_text(BLOCKS[1], encoding="utf-8")
    text = re.search(r"^```python\n(.*?)^```", PAGE.read_text(encoding="utf-8"), re.M | re.S)
    assert text
    contact = railpatch.Contact(path)
    exec(text[1], {"contact": contact})
    assert contact.case.wheelset.left.velocity == [0, 0.02, 0]
