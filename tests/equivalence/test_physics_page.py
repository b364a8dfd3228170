"""Cases of docs/physics.md are solved as printed, and each has the stages that it is there for."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
import railpatch

DOCS = Path(__file__).parents[2] / "docs"
# headings with a case, in order, and the optional stages of each
CASES = [
    ("Regimes", {"history"}),
    ("Regimes", {"history"}),
    ("Regimes", {"history"}),
    ("Unlike bodies", {"coupling"}),
    ("Viscoelastic bodies", set()),
    ("Third-body layer", {"plasticity"}),
    ("Friction", set()),
    ("Temperature", {"temperature"}),
]


def blocks() -> list[tuple[str, str]]:
    """Heading and text of each case of the page."""
    found, heading = [], ""
    text = (DOCS / "physics.md").read_text(encoding="utf-8")
    for match in re.finditer(r"^## ([^\n]+)$|^```toml\n(.*?)^```", text, re.DOTALL | re.MULTILINE):
        heading = match[1] or heading
        if match[2]:
            found.append((heading, match[2]))
    return found


def test_page_has_a_case_of_each_kind() -> None:
    assert [heading for heading, _ in blocks()] == [heading for heading, _ in CASES]


@pytest.mark.parametrize("index", range(len(CASES)))
def test_case_is_solved_with_its_stages(tmp_path: Path, index: int) -> None:
    path = tmp_path / "case.toml"
    path.write_text(blocks()[index][1], encoding="utf-8")
    result = railpatch.solve(path)
    assert result.status == "converged"
    assert result["residual"] <= 1e-5
    optional = {"history", "coupling", "plasticity", "temperature"}
    assert optional & set(result["stages"]) == CASES[index][1]


def test_figures_are_there() -> None:
    text = (DOCS / "physics.md").read_text(encoding="utf-8")
    figures = re.findall(r"!\[[^\]]*\]\(([^)]+)\)", text)
    assert figures
    for name in figures:
        assert 1000 < (DOCS / name).stat().st_size < 150_000


def test_the_shift_goes_to_seven_eighths_of_friction(tmp_path: Path) -> None:
    """Cattaneo 1938: 4.72e-7 m in each of five steps, 2.36e-6 m in all, for 7/8 of 400 N."""
    path = tmp_path / "case.toml"
    path.write_text(blocks()[0][1], encoding="utf-8")
    assert railpatch.solve(path)["creep_force"][0] == pytest.approx(-350.0, rel=0.01)
