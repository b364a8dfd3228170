"""The benchmark's outcome on the terminal."""

from __future__ import annotations

from rich.console import Console
from rich.table import Table

from railpatch.evidence.bench.page import REACHED, milliseconds, percent
from railpatch.evidence.bench.run import Report
from railpatch.evidence.bench.targets import rows


def print_report(report: Report) -> None:
    """Targets, and errors and warm times of every method on the first set."""
    console = Console()
    for name, text in report.machine.rows():
        console.print(f"{name}: {text}", highlight=False)
    targets = Table(
        "time", "measured", "wanted, at most", "hoped for", "", box=None, pad_edge=False
    )
    for row in rows(report.outcome):
        targets.add_row(row.title, row.measured, row.must, row.aim, REACHED[row.verdict])
    console.print(targets)
    table = Table(
        "method", "set", "cases", "force error 95 % [%]", "cold [ms]", "warm [ms]", "lost",
        box=None, pad_edge=False,
    )  # fmt: skip
    for s in report.outcome.of_set(report.plan.sets[0]):
        table.add_row(
            s.label,
            s.problem_set,
            str(s.cases),
            percent(s.values["force_error_p95"]),
            milliseconds(s.values["cold_median"]),
            milliseconds(s.values["warm_median"]),
            str(s.not_converged),
        )
    console.print(table)
