"""What a wheel's evaluation and derivatives cost: complete and consistent. No time is asserted."""

from __future__ import annotations

from railpatch.evidence.bench.evaluations import GRIDS, evaluations, search_time


def test_every_grid_is_solved_and_differentiated() -> None:
    found = evaluations(quick=True)
    assert [cost.name for cost in found] == [name for name, _ in GRIDS]
    for cost in found:
        assert cost.good, cost.name
        assert cost.evaluation > 0
        assert cost.matrix > 0
        assert cost.bytes > 0


def test_the_search_takes_time() -> None:
    assert 0 < search_time(quick=True) < 1.0
