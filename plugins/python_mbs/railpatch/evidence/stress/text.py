"""The run as words: cells of its tables, the document in Markdown, and the terminal."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from railpatch.evidence.stress.outcome import Group, Report
from railpatch.evidence.stress.run import Row

GROUP_HEAD = (
    "family", "method", "trials", "steps", "clean", "says so", "faults", "residual", "conditions",
    "energy", "iterations", "time",
)  # fmt: skip
ROW_HEAD = (
    "case", "method", "status", "residual", "conditions", "energy", "iterations", "time", "verdict",
    "why",
)  # fmt: skip
FEW_ROWS = 80
WIDTH = 180  # of lines that go elsewhere than to a terminal
INTRODUCTION = (
    "Stiff and extreme cases, each checked again by code that shares nothing with the solver: "
    "pressure and gap, traction and its bound, stick and slip by displacements of its own, sums, "
    "prescribed forces, laws of friction and yield."
)
MEANINGS = (
    ("clean", "every step ended as expected, and what is called converged meets the conditions"),
    ("says so", "a step says that it is not converged or out of range: the best iterate, no number "
     "that is none, within the bound of iterations"),
    ("fault", "a number that is none, a result called converged that fails the conditions, an end "
     "that was not expected, too many iterations, or no end"),
    ("residual", "the solver's own, the greatest of the clean rows"),
    ("conditions", "the greatest violation over what is allowed: ten times the tolerance of the "
     "solver, or rounding where sums or formulas must agree"),
    ("energy", "what is left of work of the creepages, energy taken by friction and plastic "
     "displacement, and change of elastic energy, over the greatest of them"),
    ("iterations", "of normal and tangential problem, all steps"),
    ("time", "of a step, over that of the nominal case: 24 x 24 elements, half of saturation, "
     "cold"),
)  # fmt: skip


def power(value: float) -> str:
    """Two digits; empty where there is no number."""
    if np.isnan(value) or value < 0:
        return "-"
    return "0" if value == 0 else f"{value:.1e}" if value < 0.01 or value >= 1e4 else f"{value:.2g}"


def group_cells(group: Group) -> list[str]:
    """Cells below GROUP_HEAD."""
    counts = (group.trials, group.steps, group.clean, group.says_so, group.faults)
    return [
        group.family, group.method, *map(str, counts), power(group.residual),
        power(group.conditions), power(group.energy), str(group.iterations),
        power(group.relative_time),
    ]  # fmt: skip


def row_cells(row: Row, like: int = 1) -> list[str]:
    """Cells below ROW_HEAD. like: number of rows that this one stands for."""
    name = f"{row.family}: {row.name}" + (f" (and {like - 1} like it)" if like > 1 else "")
    why = "; ".join(text for text in (row.reason, row.note) if text)
    return [
        name, row.method, row.status, power(row.residual), power(row.conditions), power(row.energy),
        str(row.iterations), power(row.relative_time), row.verdict, why,
    ]  # fmt: skip


def verdict_of(report: Report) -> str:
    """One sentence."""
    steps = sum(row.steps for row in report.rows)
    clean = sum(row.verdict == "clean" for row in report.rows)
    told = len(report.rows) - clean - len(report.faults)
    return (
        f"{len(report.rows)} trials, {steps} steps, {report.seconds:.0f} s: {clean} clean, {told} "
        f"say that they are not solved ({len(report.unexpected)} of them unexpected), "
        f"{len(report.faults)} faults."
    )


def not_clean(report: Report) -> list[list[str]]:
    """Cells of all that is not clean: faults, the unexpected, and what was expected to say so."""
    found = [row_cells(row) for row in (*report.faults, *report.unexpected)]
    return found + [row_cells(row, like) for row, like in report.told]


def markdown(report: Report) -> str:
    """The document: summary by family and method, and all that is not clean."""
    option = " --quick" if report.plan.quick else ""
    parts = [
        "# Numerical stability",
        f"{INTRODUCTION} Made by `railpatch stress{option} -o DIR --seed {report.plan.seed}`, "
        "which also writes every row as HTML and CSV.",
        f"{verdict_of(report)} {report.machine.processor}, one core.",
        markdown_table(("word", "meaning"), MEANINGS),
        markdown_table(GROUP_HEAD, map(group_cells, report.groups)),
        "## What is not clean",
        markdown_table(ROW_HEAD, not_clean(report)) if not_clean(report) else "Nothing.",
    ]
    return "\n\n".join(parts) + "\n"


def markdown_table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A table in Markdown."""
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(c.replace("|", "/") for c in line) + " |" for line in lines)


def print_report(report: Report) -> None:
    """Groups, and all that is not clean; few rows are all shown."""
    from rich.console import Console
    from rich.table import Table

    console = Console()
    if not console.is_terminal:
        console = Console(width=WIDTH)
    tables = [(GROUP_HEAD, [group_cells(group) for group in report.groups])]
    if len(report.rows) <= FEW_ROWS:
        tables.append((ROW_HEAD, [row_cells(row) for row in report.rows]))
    elif not_clean(report):
        tables.append((ROW_HEAD, not_clean(report)))
    for head, lines in tables:
        table = Table(box=None, pad_edge=False)
        for name in head:
            table.add_column(name, overflow="fold", no_wrap=name not in ("case", "why"))
        for line in lines:
            table.add_row(*line)
        console.print(table)
    console.print(verdict_of(report), highlight=False)
