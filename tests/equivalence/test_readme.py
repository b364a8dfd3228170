"""The README's examples run as printed, and command line and Python give the same numbers.

The C example is compiled as C11 and as C++ and run by ctest.
"""

from __future__ import annotations

import json
import re
import subprocess
import sys
from pathlib import Path

import pytest

README = Path(__file__).parents[2] / "README.md"


def block(language: str) -> str:
    """The README's first code block of this language."""
    found = re.search(rf"^```{language}\n(.*?)^```", README.read_text(), re.DOTALL | re.MULTILINE)
    assert found, f"README.md holds no block of {language}"
    return found[1]


def creep_force_of_command(tmp_path: Path) -> list[float]:
    """Solves the README's case file with the command."""
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
    exec(compile(block("python"), str(README), "exec"), {})
    printed = [json.loads(line) for line in capsys.readouterr().out.splitlines()]
    assert len(printed) == 5
    assert printed[4][2] == pytest.approx(printed[0], rel=1e-4)  # the last of three loads
    assert printed[0] == creep_force_of_command(tmp_path)
    assert printed[1] == pytest.approx(printed[0], rel=1e-4)  # a handle of its own, same case
    assert printed[0][0] < 0  # creepage > 0 gives creep force < 0
