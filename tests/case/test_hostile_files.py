"""Scene files that no scene can be are refused in a line, and at once where they are long."""

from __future__ import annotations

from pathlib import Path

import pytest
from railpatch import CaseError, solve
from railpatch.case.load import DEEPEST, LARGEST, depth


@pytest.mark.parametrize("text", [f"a = {'[' * 5000}{']' * 5000}", f"a{'.a' * 3000} = 1"])
def test_nested_files_are_refused(tmp_path: Path, text: str) -> None:
    scene = tmp_path / "scene.toml"
    scene.write_text(text)
    with pytest.raises(CaseError, match=f"nested too deeply, allowed {DEEPEST} levels"):
        solve(scene)


def test_depth_counts_tables_and_arrays() -> None:
    assert depth(1) == 0
    assert depth({}) == 1
    assert depth({"a": [1, {"b": 2}], "c": 3}) == 3


def test_a_file_of_half_a_gigabyte_is_not_read(tmp_path: Path) -> None:
    scene = tmp_path / "scene.toml"
    with scene.open("wb") as file:
        file.truncate(500_000_000)
    with pytest.raises(CaseError, match=f"has 500000000 bytes, allowed at most {LARGEST}"):
        solve(scene)


@pytest.mark.parametrize("source", [5, None, b"kind"])
def test_what_is_no_case_is_refused(source: object) -> None:
    with pytest.raises(CaseError, match=r"case: value is .*, allowed a dictionary or the path"):
        solve(source)  # type: ignore[arg-type]
