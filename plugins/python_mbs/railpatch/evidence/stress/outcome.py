"""A whole run: its rows, and their summary by family and method."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from railpatch.evidence.bench.machine import Machine, this_machine
from railpatch.evidence.stress.plan import Plan
from railpatch.evidence.stress.run import CLEAN, FAULT, SAYS_SO, Row
from railpatch.evidence.stress.watch import LIMIT, run_plan


@dataclass(frozen=True, kw_only=True)
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
        family=family,
        method=method,
        trials=len(rows),
        steps=sum(row.steps for row in rows),
        clean=verdicts.count(CLEAN),
        says_so=verdicts.count(SAYS_SO),
        faults=verdicts.count(FAULT),
        residual=greatest(row.residual for row in solved),
        conditions=greatest(row.conditions for row in rows),
        energy=greatest(row.energy for row in rows),
        iterations=max(row.iterations for row in rows),
        relative_time=greatest(row.relative_time for row in rows),
    )


def greatest(values: Iterable[float]) -> float:
    """Of those that are numbers; NaN without any."""
    known = [value for value in values if not np.isnan(value)]
    return max(known, default=float("nan"))


def run_stress(
    plan: Plan, progress: Callable[[Row], None] = lambda _: None, limit: float = LIMIT
) -> Report:
    """Runs a plan."""
    machine, begin, rows = this_machine(), time.perf_counter(), []
    for row in run_plan(plan, limit):
        rows.append(row)
        progress(row)
    return Report(plan, machine, rows, time.perf_counter() - begin)
