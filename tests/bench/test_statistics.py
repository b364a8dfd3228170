"""Statistics of made-up measurements with known answers."""

from __future__ import annotations

import math

import numpy as np
import pytest
from made_up import measured
from railpatch.evidence.bench.cost import SizeCost, WheelCost
from railpatch.evidence.bench.curves import cost_curves, curves, frontier_curve
from railpatch.evidence.bench.methods import FAST, FITTED, METHODS, UNIFORM, Method
from railpatch.evidence.bench.picture import spread
from railpatch.evidence.bench.sets import hertz_batch
from railpatch.evidence.bench.statistics import (
    calibration,
    fastest_within,
    frontier,
    growth,
    percentile,
    summarize,
)
from railpatch.evidence.bench.targets import Outcome, rows


def test_percentiles_are_values_that_occur() -> None:
    values = np.arange(1.0, 101.0)
    # numpy's position 0.95 * 99 = 94.05 lies between 95 and 96; the greater is taken
    assert percentile(values, 95) == 96.0
    assert percentile(values, 100) == 100.0
    assert percentile(np.array([1.0, np.nan, 3.0]), 100) == 3.0
    assert math.isnan(percentile(np.array([np.nan]), 50))


def test_summary() -> None:
    errors = np.arange(100) / 1000
    summary = summarize(
        measured(force_error=errors, cold=3e-3, warm=[*[1e-3] * 98, 5e-3, np.nan], lost=10)
    )
    assert summary.cases == 100
    assert summary.not_converged == 10
    # of the 90 that converged
    assert summary.values["force_error_max"] == pytest.approx(0.089)
    assert summary.values["force_error_median"] == pytest.approx(0.045)
    assert summary.values["warm_median"] == 1e-3
    assert summary.values["warm_p99"] == 5e-3
    assert summary.values["cold_p99"] == 3e-3
    assert summary.values["bytes"] == 2048
    assert math.isnan(summary.values["force_estimate_covers"])


def test_calibration() -> None:
    error = np.array([1.0, 1.0, 1.0, 1.0, 0.0])
    covers, within = calibration(error, np.array([0.5, 2.0, 4.0, 5.0, 0.1]))
    assert covers == pytest.approx(4 / 5)
    # the exact result has no multiple
    assert within == pytest.approx(3 / 4)
    assert all(math.isnan(share) for share in calibration(error, np.full(5, np.nan)))
    # errors smaller than those of the truth count as those
    _, within = calibration(np.full(2, 1e-5), np.array([1e-3, 2e-3]))
    assert within == pytest.approx(1 / 2)
    covers, within = calibration(np.zeros(3), np.zeros(3))
    assert covers == 1.0
    assert math.isnan(within)


def test_frontier() -> None:
    time = np.array([1.0, 2.0, 2.0, 3.0, 0.5, 4.0])
    error = np.array([5.0, 4.0, 3.0, 3.5, 9.0, 3.0])
    assert frontier(time, error) == [4, 0, 2]
    assert frontier(np.array([np.nan, 1.0]), np.array([1.0, np.nan])) == []


def test_growth() -> None:
    elements = np.array([200.0, 800.0, 3200.0])
    assert growth(elements, 3e-6 * elements**1.2) == pytest.approx(1.2)


def test_fastest_within() -> None:
    summaries = [
        summarize(measured(force_error=0.02, warm=1e-4)),
        summarize(measured(force_error=0.009, warm=3e-4)),
        summarize(measured(force_error=0.001, warm=2e-3)),
        # fast and exact where it converges, but not everywhere
        summarize(measured(force_error=0.001, warm=1e-5, lost=1)),
    ]
    assert fastest_within(summaries, 0.01) is summaries[1]
    assert fastest_within(summaries, 0.005) is summaries[2]
    assert fastest_within(summaries, 1e-4) is None


def outcome(**times: float) -> Outcome:
    """A uniform grid at 16, 32 and 64 across, all else the same."""
    grids = [
        summarize(measured(elements=n, name=UNIFORM.name, force_error=error, cold=cold, warm=warm))
        for n, error, cold, warm in (
            (16, 0.04, 0.7e-3, 0.4e-3),
            (32, 0.01, 9e-3, 2e-3),
            (64, 0.002, 20e-3, 5e-3),
        )
    ]
    costs = [SizeCost(UNIFORM, n, n * n, 1e-6 * n**2.2, 1e-7 * n**2.6) for n in (16, 32, 128)]
    return Outcome(grids, costs, (0.5e-3, 0.2e-3), WheelCost("rig", 2.6e-3, 4e-3))


def test_targets() -> None:
    found = {row.title: row for row in rows(outcome())}

    def verdict(start: str) -> str:
        return next(row.verdict for title, row in found.items() if title.startswith(start))

    assert verdict("equal grid, 16") == "must"  # warm 0.4 is above the aim of 0.25
    assert verdict("equal grid, 32") == "missed"  # cold 9 is above 8
    assert verdict("equal grid, 64") == "aim"
    assert verdict("force error of at most 1 %") == "missed"  # 2 ms
    assert verdict("force error of at most 0.3 %") == "missed"  # 5 ms
    assert verdict("table") == "-"
    assert verdict("normal problem") == "must"
    assert verdict("growth") == "missed"  # 1.1 cold, 1.3 warm
    assert verdict("rig's wheel") == "missed"
    assert verdict("rig's position") == "aim"
    assert next(r for t, r in found.items() if t.startswith("growth")).measured == "1.1 / 1.3"


def test_curves() -> None:
    found = curves([*outcome().summaries, summarize(measured(force_error=0.5, warm=1e-5))])
    assert [curve.name for curve in found] == ["method uniform", "method made_up"]
    best = frontier_curve(found)
    assert best.time.tolist() == [1e-5, 0.4e-3, 2e-3, 5e-3]
    assert best.labels[0] == "method made_up, 10 across"
    # what does not converge everywhere is on no frontier, and says so
    lost = curves([*outcome().summaries, summarize(measured(warm=1e-5, lost=30))])
    assert frontier_curve(lost).time.tolist() == [0.4e-3, 2e-3, 5e-3]
    assert lost[1].name == "method made_up (30 % without a result)"
    (cost,) = cost_curves(outcome().costs)
    assert cost.exponents == pytest.approx((1.1, 1.3))


def test_names_beside_the_axes() -> None:
    assert spread([0.1, 0.5, 0.9], 0.2) == pytest.approx([0.1, 0.5, 0.9])
    # two too near move apart about their middle, and push no other
    assert spread([0.1, 0.4, 0.4, 0.9], 0.1) == pytest.approx([0.1, 0.35, 0.45, 0.9])
    assert spread([0.5, 0.5, 0.5, 0.55], 0.1) == pytest.approx([0.3625, 0.4625, 0.5625, 0.6625])


def test_methods() -> None:
    names = [method.name for method in METHODS]
    assert len(set(names)) == len(names)
    fast = Method("fast", "fast", {}, FAST, grids=(0,))
    assert fast.count(64, 3220) == 3220
    assert fast.repeat > 1
    assert fast.point(0) == "fast"
    full = Method("full", "full", {})
    assert full.count(32, 3220) == 3220
    assert full.count(64, 3220) == pytest.approx(3220 / 8, abs=1)
    assert full.point(64) == "full, 64 across"
    assert FITTED.point(10) == "full theory, fitted rows, scale 10"


def test_fitted_rows_follow_the_ellipse() -> None:
    batch = hertz_batch(2.0, [0.0], np.array([0.0]), [1.0])
    assert callable(FITTED.overrides)
    grid = FITTED.overrides(batch, 20)["grid"]
    assert grid == {"fitted": [23, 17], "elements": None}
