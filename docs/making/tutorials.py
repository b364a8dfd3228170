"""Tutorials from the scripts in examples/: text and code of each cell, and what it prints.

A script is in the percent format that jupytext, VS Code and Spyder read: ``# %% [markdown]`` begins
text, ``# %%`` code. A cell whose last line is a plotly figure shows it, as a notebook does.
"""

from __future__ import annotations

import ast
import contextlib
import io
import os
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from making import ROOT, Pages

EXAMPLES = ROOT / "examples"


@dataclass(frozen=True)
class Cell:
    """One cell: text as Markdown, or code."""

    is_text: bool
    source: str


@dataclass(frozen=True)
class Shown:
    """What a cell of code left: what it printed, and its figure."""

    printed: str
    figure: Any


def scripts() -> list[Path]:
    """The notebooks."""
    return sorted(EXAMPLES.glob("*.py"))


def cells(script: Path) -> list[Cell]:
    """Those of a script. What stands before the first one is the notebook's head."""
    found = []
    for part in script.read_text(encoding="utf-8").split("# %%")[1:]:
        head, _, body = part.partition("\n")
        text = head.strip() == "[markdown]"
        if text:
            body = "\n".join(line.removeprefix("#").removeprefix(" ") for line in body.splitlines())
        found.append(Cell(text, body.strip("\n")))
    return found


def run(script: Path, *, listen: bool = True) -> list[Shown]:
    """Runs a script's cells of code in an empty folder. Raises what they raise."""
    names: dict[str, Any] = {"__name__": "__main__", "__file__": str(script)}
    found = []
    before = Path.cwd()
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        try:
            for cell in cells(script):
                if not cell.is_text:
                    with contextlib.redirect_stdout(io.StringIO()) as told:
                        figure = run_cell(cell.source, script, names)
                    found.append(Shown(told.getvalue() if listen else "", figure))
        finally:
            os.chdir(before)
    return found


def run_cell(source: str, script: Path, names: dict[str, Any]) -> Any:
    """Runs one cell; gives its last expression."""
    tree = ast.parse(source, str(script))
    last = tree.body.pop() if tree.body and isinstance(tree.body[-1], ast.Expr) else None
    exec(compile(tree, str(script), "exec"), names)
    if last is None:
        return None
    assert isinstance(last, ast.Expr)
    return eval(compile(ast.Expression(last.value), str(script), "eval"), names)


def figure_html(figure: Any) -> str:
    """A plotly figure as HTML; the library stands in the site."""
    text = figure.to_html(full_html=False, include_plotlyjs=False, default_height="480px")
    return '<div class="figure"><script src="../assets/plotly.min.js"></script>' + text + "</div>"


def page(script: Path) -> str:
    """The page of a script."""
    shown = iter(run(script))
    lines = []
    for cell in cells(script):
        if cell.is_text:
            lines += [cell.source, ""]
            continue
        found = next(shown)
        lines += [f"```python\n{cell.source}\n```", ""]
        if found.printed:
            lines += [f"```text\n{found.printed.rstrip()}\n```", ""]
        if hasattr(found.figure, "to_html") and hasattr(found.figure, "layout"):
            lines += [figure_html(found.figure), ""]
    lines += [f"This page is made by running `examples/{script.name}`.", ""]
    return "\n".join(lines)


def pages() -> Pages:
    """A page for each script."""
    return {f"tutorials/{script.stem}.md": page(script) for script in scripts()}
