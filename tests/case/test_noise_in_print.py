"""What is 0 by symmetry is printed as 0, in tables of the terminal and of notebooks and on pages;
numbers themselves, and files, keep every bit."""

from __future__ import annotations

import io
import re

import railpatch
from case_samples import PATCH, with_values
from railpatch.command.tables import print_result, spell
from railpatch.page import tables
from rich.console import Console

STRAIGHT = with_values(PATCH, motion__creepage=[1e-3, 0.0], motion__spin_creepage=0.0)


def test_of_a_patch_that_creeps_ahead() -> None:
    result = railpatch.solve(STRAIGHT)
    # what the tolerance of the solver leaves
    assert 0 < abs(result["creep_force"][1]) < 1e-7 * abs(result["creep_force"][0])
    ahead = f"{result['creep_force'][0]:.6g}"
    told = io.StringIO()
    print_result(result, Console(file=told, width=200))
    text = told.getvalue()
    assert re.search(rf"creep_force +N +{ahead} 0\n", text)
    assert re.search(r"spin_moment +N m +0\n", text)
    html = result._repr_html_()
    assert f"<td>creep_force</td><td>{ahead}, 0</td>" in html
    assert "<td>spin_moment</td><td>0</td>" in html


def test_small_numbers_that_are_meant_stay() -> None:
    assert spell([1.0, 1e-6, -1e-9]) == "1 1e-06 0"
    assert spell(3e-17) == "3e-17"
    assert spell(3e-17, 1e-16) == spell(-0.0) == "0"
    assert spell([float("nan"), 1.0]) == " 1"
    assert tables.number(-3e-17) == tables.number(-0.0) == "0"
    assert tables.number(2.5e-9) == "2.5e\u221209"
