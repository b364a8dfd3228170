"""The case of docs/conformal.md is solved as printed."""

from __future__ import annotations

import re
from pathlib import Path

import railpatch

DOCS = Path(__file__).parents[2] / "docs"


def test_case_is_solved(tmp_path: Path) -> None:
    text = (DOCS / "conformal.md").read_text(encoding="utf-8")
    (block,) = re.findall(r"^```toml\n(.*?)^```", text, re.DOTALL | re.MULTILINE)
    path = tmp_path / "case.toml"
    path.write_text(block, encoding="utf-8")
    result = railpatch.solve(path)
    assert result.status == "converged"
    assert "coupling" in result["stages"]
