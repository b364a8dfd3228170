"""Cases without a mistake are solved, and none has a warning."""

from __future__ import annotations

from collections import Counter

import railpatch
from case.correct import FEATURES, ODD, correct_cases
from case.mistakes import FOOT

CASES = correct_cases()


def test_none_has_a_warning() -> None:
    unsolved, warned = [], []
    for name, case in CASES:
        result = railpatch.solve(case)
        if result.status != "converged":
            unsolved.append((name, result.status, result.reason))
        if result.warnings:
            warned.append((name, result.warnings))
    assert unsolved == []
    assert warned == []


def test_they_are_of_all_kinds() -> None:
    assert len(CASES) >= 200
    assert len(dict(CASES)) == len(CASES)
    counts = Counter(case["kind"] for _, case in CASES)
    for kind, count in counts.items():
        assert f"| `{kind}` | {count} |" in FOOT
    named = {part for name, _ in CASES for part in name.split(": ")[-1].split(" + ")}
    assert set(ODD) == FEATURES - named
