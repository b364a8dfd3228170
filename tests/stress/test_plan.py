"""Trials by number and pattern, and the verdicts on them."""

from __future__ import annotations

import time

import pytest
from railpatch.evidence.stress import watch
from railpatch.evidence.stress.plan import Plan
from railpatch.evidence.stress.run import CLEAN, FAULT, SAYS_SO, run_trial
from railpatch.evidence.stress.trial import Move, Trial, moves, nominal


def test_same_seed_same_trials() -> None:
    one, other = Plan(seed=3, quick=True), Plan(seed=3, quick=True)
    assert list(one) == list(other)
    assert one[len(one) - 1] != Plan(seed=4, quick=True)[len(one) - 1]


def test_names_are_unique() -> None:
    plan = Plan(quick=True)
    names = [(trial.family, trial.name, trial.method) for trial in plan]
    assert len(set(names)) == len(names) == len(plan)


def test_pattern() -> None:
    families = {trial.family for trial in Plan(only="load: 1 n, f*")}
    assert families == {"load"}
    mixed = Plan(quick=True, only="mixture: 7:*")
    assert [trial.name for trial in mixed] == [Plan(quick=True, only="mixture")[7].name]
    assert len(Plan(only="no such trial")) == 0


@pytest.mark.parametrize(
    "pattern",
    ["shape: *", "grid: *", "friction: coefficient*", "creepage: *", "spin: *", "speed: *",
     "load: *", "layer: *", "prescribed force: *", "sequence: *", "distance: *",
     "line contact: *", "option: *", "wheel: *", "shift: *", "transient: *", "plastic: *",
     "slip velocity: *", "temperature: *"],
)  # fmt: skip
def test_no_faults(pattern: str) -> None:
    rows = [run_trial(trial) for trial in Plan(quick=True, only=pattern)]
    assert len(rows) >= 6
    faults = [f"{row.name}, {row.method}: {row.reason}" for row in rows if row.verdict == FAULT]
    assert not faults
    unexpected = [f"{row.name}, {row.method}: {row.reason}" for row in rows if not row.expected]
    assert not unexpected


def test_verdicts() -> None:
    clean = run_trial(Trial("test", "clean", nominal()))
    assert (clean.verdict, clean.expected, clean.status) == (CLEAN, True, "converged")
    few = nominal({"method": {"max_iterations": 1}})
    told = run_trial(Trial("test", "few iterations", few))
    assert (told.verdict, told.expected, told.status) == (SAYS_SO, False, "not_converged")
    lost = run_trial(Trial("test", "not expected", nominal(), moves({}, expects=("no_contact",))))
    assert (lost.verdict, lost.reason) == (FAULT, "converged, expected no_contact")
    wrong = run_trial(Trial("test", "wrong", nominal({"friction": {"coefficient": -1.0}})))
    assert wrong.verdict == FAULT
    assert "friction.coefficient" in wrong.reason
    bad_step = Trial("test", "wrong step", nominal(), (Move(), Move({"normal_force": -1.0})))
    assert run_trial(bad_step).reason.startswith(
        "step 2: refused, expected converged (normal_force"
    )


class Endless(Plan):
    """A trial that takes for ever, and one that ends the process, between two good ones."""

    def __len__(self) -> int:
        return 4

    def __getitem__(self, index: int) -> Trial:
        import os

        inside = watch.multiprocessing.parent_process() is not None
        if index == 1 and inside:
            time.sleep(1000)
        if index == 2 and inside:
            os._exit(7)
        return Trial("test", str(index), nominal())


def test_what_does_not_end_is_ended() -> None:
    rows = list(watch.run_plan(Endless(), limit=3.0))
    assert [row.name for row in rows] == ["0", "1", "2", "3"]
    reasons = ["", "does not come to an end", "ended the process", ""]
    assert [row.reason for row in rows] == reasons
    assert [row.verdict for row in rows] == [CLEAN, FAULT, FAULT, CLEAN]
