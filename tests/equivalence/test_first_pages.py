"""The examples of docs/command_line.md and docs/python.md run as printed and give the same numbers.

The C example is compiled as C11 and as C++ and run by ctest.
"""

from __future__ import annotations

import json
import math
import re
import subprocess
import sys
from pathlib import Path

import pytest
from railpatch.case import json_schema

DOCS = Path(__file__).parents[2] / "docs"
PAGES = {"toml": DOCS / "command_line.md", "python": DOCS / "python.md"}


def block(language: str) -> str:
    """The first code block of this language on its page."""
    page = PAGES[language].read_text(encoding="utf-8")
    found = re.search(rf"^```{language}\n(.*?)^```", page, re.DOTALL | re.MULTILINE)
    assert found, f"{PAGES[language]} holds no block of {language}"
    return found[1]


def creep_force_of_command(tmp_path: Path) -> list[float]:
    """Solves the page's case file with the command."""
    case = tmp_path / "case.toml"
    case.write_text(block("toml"))
    command = Path(sys.executable).with_name("railpatch")
    run = subprocess.run(
        [command, "solve", case, "--json"], capture_output=True, text=True, check=False
    )
    assert run.returncode == 0, run.stderr
    return json.loads(run.stdout)["creep_force"]


def test_command_and_python_examples_agree(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    exec(compile(block("python"), str(PAGES["python"]), "exec"), {})
    printed = [json.loads(line) for line in capsys.readouterr().out.splitlines()]
    assert len(printed) == 5
    assert printed[4][2] == pytest.approx(printed[0], rel=1e-4)  # the last of three loads
    assert printed[0] == creep_force_of_command(tmp_path)
    assert printed[1] == pytest.approx(printed[0], rel=1e-4)  # a handle of its own, same case
    assert printed[0][0] < 0  # creepage > 0 gives creep force < 0


def test_curvatures_are_half_the_curvature(capsys: pytest.CaptureFixture[str]) -> None:
    """The page's sphere of 0.4 m on a plane, 80 kN: p0 = (6 F E*^2 / (pi^3 R^2))^(1/3) (Johnson
    1985, Eq. 4.24), E* = G/(1 - nu) of like bodies."""
    page = PAGES["python"].read_text(encoding="utf-8")
    first, second = re.findall(r"^```python\n(.*?)^```", page, re.DOTALL | re.MULTILINE)
    exec(compile(first + second, str(PAGES["python"]), "exec"), {})
    found = float(capsys.readouterr().out.splitlines()[-1])
    modulus = 82e9 / (1 - 0.28)
    assert found == pytest.approx(
        (6 * 80e3 * modulus**2 / (math.pi**3 * 0.4**2)) ** (1 / 3), rel=5e-3
    )
    text = json_schema()
    assert "half the curvatures" in str(text)
