"""docs/contact_users.md: its input files are solved as printed, and give the numbers beside them;
what is said where a line is missing."""

from __future__ import annotations

import json
import math
import re
from pathlib import Path

import pytest
from click.testing import CliRunner
from railpatch.command.cli import cli
from railpatch.errors import CaseError
from railpatch.inp.files import read_cases

PAGE = (Path(__file__).resolve().parents[2] / "docs/contact_users.md").read_text(encoding="utf-8")
FENCE = re.compile(r"^```(inp|python)\n(.*?)^```", re.DOTALL | re.MULTILINE)


def blocks(language: str) -> list[str]:
    return [text for name, text in FENCE.findall(PAGE) if name == language]


HERTZ, WHEEL = blocks("inp")


def said(file: str) -> dict[str, float]:
    """Numbers that the page gives of a file."""
    found = re.search(
        rf"`railpatch solve {file} --signs contact` gives (.*?)(?:;|\\.\\n)", PAGE, re.S
    )
    assert found
    return {name: float(value) for name, value in re.findall(r"(\w+) = (-?[\d.]+)", found[1])}


def solved(folder: Path, file: str, text: str) -> dict:
    (folder / file).write_text(text, encoding="utf-8")
    run = CliRunner().invoke(cli, ["solve", str(folder / file), "--signs", "contact", "--json"])
    assert run.exit_code == 0, run.output
    return json.loads(run.stdout)[0]


def test_the_basic_case_is_hertz(tmp_path: Path) -> None:
    """A sphere of 400 mm on a plane, 80 kN: p0 = (6 F E*^2 / (pi^3 R^2))^(1/3), and the approach
    pi^2 p0^2 R / (4 E*^2) (Johnson 1985, Eqs. 4.23 and 4.24); E* = G/(1 - nu) of like bodies."""
    found, page = solved(tmp_path, "hertz.inp", HERTZ), said("hertz.inp")
    assert set(page) == {"FX", "PEN", "PMAX"}
    for name, value in page.items():
        assert found[name] == pytest.approx(value, rel=5e-4)
    modulus = 82e3 / (1 - 0.28)
    peak = (6 * 80e3 * modulus**2 / (math.pi**3 * 400.0**2)) ** (1 / 3)
    assert round(peak) == 1079
    assert "Hertz has 1079" in PAGE
    assert found["PMAX"] == pytest.approx(peak, rel=2e-3)
    approach = (math.pi * peak / (2 * modulus)) ** 2 * 400.0
    assert found["PEN"] == pytest.approx(approach, rel=2e-3)


def test_the_wheel_on_its_rail(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (script,) = blocks("python")
    exec(compile(script, "contact_users.md", "exec"), {})
    found, page = solved(tmp_path, "wheel.inp", WHEEL), said("wheel.inp")
    assert set(page) == {"Z_WS", "FX_TR", "FY_TR", "FN", "PMAX"}
    for name, value in page.items():
        assert (found | found["patches"][0])[name] == pytest.approx(value, rel=1e-3)
    # the force that the file gives
    assert found["FZ_TR"] == pytest.approx(60000.0, rel=1e-5)


@pytest.mark.parametrize(
    ("text", "without", "message"),
    [
        (
            HERTZ,
            "CHI DQ",
            "NU2: expected a number, found 'IPOTCN', in NU1 NU2 G1 G2 (materials of both bodies, "
            "C3 >= 2); before it line 10 was read as CHI DQ VELOC (rolling direction, step and "
            "speed, T = 2, 3 with C3 >= 2)",
        ),
        (
            HERTZ,
            "EPS",
            "in MAXGS MAXIN MAXNR MAXOUT EPS (solver, G other than 1); before it line 6",
        ),
        (HERTZ, "FN CKSI", "in FN CKSI CETA CPHI (load and creepages); before it line 7 was"),
        (HERTZ, "FSTAT", "in FSTAT FKIN (friction, L = 0); before it line 8 was read as FN CKSI"),
        (HERTZ, "IPOTCN  ", "IPOTCN is 48, allowed -6 ... -1, 1 ... 4; before it line 11 was read"),
        (WHEEL, "FSTAT", "in NU1 NU2 G1 G2 (materials of both bodies, C3 >= 2); before it line 7"),
        (WHEEL, "DY DZ", "in DY DZ DROLL VY VZ VROLL (deviation of the rail, Z = 2, 3); before it"),
        (WHEEL, "VS VY", "in VS VY VZ VROLL VYAW VPITCH (velocity, E >= 2); before it line 15"),
    ],
)
def test_a_missing_line_is_told(text: str, without: str, message: str) -> None:
    """Which line was expected, what it holds, and as what the one before was read."""
    lines = [line for line in text.splitlines() if without not in line]
    assert len(lines) == len(text.splitlines()) - 1
    with pytest.raises(CaseError) as error:
        read_cases("case.inp", "\n".join(lines))
    assert message in str(error.value)
    assert "line" in str(error.value)
