"""Runs a plan in a process of its own, which is ended where a trial does not come to an end."""

from __future__ import annotations

import multiprocessing
from collections.abc import Iterator
from multiprocessing.connection import Connection

import numpy as np

from railpatch.evidence.stress.plan import Plan
from railpatch.evidence.stress.run import FAULT, Row, run_trial
from railpatch.evidence.stress.trial import Trial, nominal

LIMIT = 120.0  # s, that a trial may take
START = 300.0  # s, that the process may take to get ready
NOMINAL_RUNS = 25


def nominal_time() -> float:
    """s, of a step of the nominal case from a cold start."""
    trial = Trial("nominal", "nominal", nominal())
    return float(np.median([run_trial(trial).seconds for _ in range(NOMINAL_RUNS)]))


def serve(pipe: Connection, plan: Plan) -> None:
    """In the other process: says that it is there, then a row for each number, until None."""
    usual = nominal_time()
    pipe.send(usual)
    for index in iter(pipe.recv, None):
        pipe.send(run_trial(plan[index], usual))


def run_plan(plan: Plan, limit: float = LIMIT) -> Iterator[Row]:
    """One row after the other."""
    context = multiprocessing.get_context("spawn")
    index, total = 0, len(plan)
    while index < total:
        pipe, other = context.Pipe()
        worker = context.Process(target=serve, args=(other, plan), daemon=True)
        worker.start()
        other.close()
        try:
            if not pipe.poll(START) or not pipe.recv():
                raise TimeoutError("the process that runs the trials does not start")
            while index < total:
                index += 1
                row = ask(pipe, index - 1, limit)
                yield row if isinstance(row, Row) else lost(plan[index - 1], row, limit)
                if not isinstance(row, Row):
                    break
            else:
                pipe.send(None)
        finally:
            if index < total or worker.is_alive():
                worker.join(1.0)
            worker.kill()
            worker.join()


def ask(pipe: Connection, index: int, limit: float) -> Row | str:
    """The row of a trial, or what came of it instead."""
    try:
        pipe.send(index)
        return pipe.recv() if pipe.poll(limit) else "does not come to an end"
    except (EOFError, OSError):
        return "ended the process"


def lost(trial: Trial, reason: str, limit: float) -> Row:
    """The row of a trial that gave none."""
    nothing = float("nan")
    return Row(
        family=trial.family,
        name=trial.name,
        method=trial.method,
        steps=len(trial.moves),
        status="not_converged",
        residual=nothing,
        conditions=nothing,
        condition="",
        energy=nothing,
        iterations=0,
        products=0,
        seconds=limit,
        relative_time=nothing,
        verdict=FAULT,
        expected=False,
        reason=reason,
        note=trial.note,
    )
