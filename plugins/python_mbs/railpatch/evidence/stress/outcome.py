"""A whole run: its rows, their summary by family and method, and the files."""

from __future__ import annotations

import csv
from collections.abc import Callable, Iterable, Sequence
from dataclasses import asdict, dataclass, fields
from functools import cached_property
from pathlib import Path

import numpy as np

from railpatch.evidence.bench.machine import Machine, this_machine
from railpatch.evidence.stress.plan import Plan
from railpatch.evidence.stress.run import CLEAN, FAULT, SAYS_SO, Row
from railpatch.evidence.stress.watch import LIMIT, run_plan


@dataclass(frozen=True)
class Group:
    """Rows of a family and method in numbers. conditions, energy, ...: the greatest."""

    family: str
    method: str
    trials: int
    steps: int
    clean: int
    says_so: int
    faults: int
    residual: float
    conditions: float
    energy: float
    iterations: int
    relative_time: float


@dataclass(frozen=True)
class Report:
    """All rows of a plan. seconds: of the whole run, checks included."""

    plan: Plan
    machine: Machine
    rows: list[Row]
    seconds: float

    @cached_property
    def groups(self) -> list[Group]:
        """By family and method, in the order of the rows."""
        keys = dict.fromkeys((row.family, row.method) for row in self.rows)
        return [
            group(*key, [row for row in self.rows if (row.family, row.method) == key])
            for key in keys
        ]

    @property
    def faults(self) -> list[Row]:
        """Rows that must not be."""
        return [row for row in self.rows if row.verdict == FAULT]

    @property
    def unexpected(self) -> list[Row]:
        """Rows that say that they are not solved where they should be."""
        return [row for row in self.rows if row.verdict == SAYS_SO and not row.expected]

    @cached_property
    def told(self) -> list[tuple[Row, int]]:
        """Rows that say that they are not solved, as expected: one of each family, method, status
        and note, with the number of its like."""
        found: dict[tuple[str, ...], list[Row]] = {}
        for row in self.rows:
            if row.verdict == SAYS_SO and row.expected:
                key = (row.family, row.method, row.status, row.note)
                found.setdefault(key, []).append(row)
        return [(rows[0], len(rows)) for rows in found.values()]


def group(family: str, method: str, rows: Sequence[Row]) -> Group:
    """A group of rows."""
    verdicts = [row.verdict for row in rows]
    solved = [row for row in rows if row.verdict == CLEAN]
    return Group(
        family, method, len(rows), sum(row.steps for row in rows),
        *(verdicts.count(verdict) for verdict in (CLEAN, SAYS_SO, FAULT)),
        greatest(row.residual for row in solved), greatest(row.conditions for row in rows),
        greatest(row.energy for row in rows), max(row.iterations for row in rows),
        greatest(row.relative_time for row in rows),
    )  # fmt: skip


def greatest(values: Iterable[float]) -> float:
    """Of those that are numbers; NaN without any."""
    known = [value for value in values if not np.isnan(value)]
    return max(known, default=float("nan"))


def run_stress(
    plan: Plan, progress: Callable[[Row], None] = lambda _: None, limit: float = LIMIT
) -> Report:
    """Runs a plan."""
    import time

    machine, begin, rows = this_machine(), time.perf_counter(), []
    for row in run_plan(plan, limit):
        rows.append(row)
        progress(row)
    return Report(plan, machine, rows, time.perf_counter() - begin)


def write_report(report: Report, folder: Path) -> list[Path]:
    """Writes stress.html, stress.csv and stress.md."""
    from railpatch.evidence.stress.page import page
    from railpatch.evidence.stress.text import markdown

    folder.mkdir(parents=True, exist_ok=True)
    written = [folder / f"stress.{suffix}" for suffix in ("html", "csv", "md")]
    written[0].write_text(page(report), encoding="utf-8")
    write_rows(report.rows, written[1])
    written[2].write_text(markdown(report), encoding="utf-8")
    return written


def write_rows(rows: Sequence[Row], path: Path) -> None:
    """One line for each trial; columns as in ``run.Row``."""
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, [column.name for column in fields(Row)])
        writer.writeheader()
        for row in rows:
            values = asdict(row)
            writer.writerow(
                {name: f"{value:.4g}" if isinstance(value, float) else value
                 for name, value in values.items()}
            )  # fmt: skip
