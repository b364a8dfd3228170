"""The slowest steps of a moving wheel: what walks, what is counted. No time is asserted."""

from __future__ import annotations

import numpy as np
from railpatch import _core
from railpatch.case.to_core import config_of
from railpatch.evidence.bench.tail import (
    ACROSS,
    BOUNDS,
    LIFTS,
    LOADS,
    METHODS,
    Tail,
    Walk,
    folded,
    inputs_of,
    moving_wheel,
    quantile,
    random_walk,
    tail,
)

STEPS = 60


def test_what_leaves_the_range_comes_back_as_from_a_mirror() -> None:
    values = np.array([0.5, 1.0, 1.25, 2.0, 2.5, 3.25, -0.25])
    assert np.allclose(folded(values, 0.0, 1.0), [0.5, 1.0, 0.75, 0.0, 0.5, 0.75, 0.25])


def test_a_long_walk_is_everywhere_and_stays_inside() -> None:
    walk = random_walk(20000)
    for values, (low, high) in ((walk.y, ACROSS), (walk.load, LOADS), (walk.lift, LIFTS)):
        assert low <= values.min() < low + 0.1 * (high - low)
        assert high - 0.1 * (high - low) < values.max() <= high
    assert np.abs(np.diff(walk.y)).max() < 2e-4
    assert np.array_equal(random_walk(50).y, random_walk(50).y)


def test_percentiles_and_bins_are_those_of_the_steps() -> None:
    seconds = np.arange(1.0, 101.0)
    one = Tail("name", "force", seconds, 2 * seconds, 3 * seconds, bad=1, lifted=2)
    row = one.row()
    assert [row[f"seconds_{share}"] for share in ("50", "99", "99.99", "100")] == [50, 99, 100, 100]
    assert row["evaluations_100"] == 200
    assert row["work_50"] == 150
    assert quantile(seconds, 98.0) == 98.0
    # a bin holds its lower end: from 50, 75 and 100
    assert one.histogram() == [24, 25, 25, 25, 1, *[0] * (len(BOUNDS) - 4)]


def test_work_is_the_same_each_time() -> None:
    name, overrides = METHODS[0]
    for fixed in (False, True):
        first, again = (tail(name, overrides, fixed, STEPS) for _ in range(2))
        assert len(first.seconds) == STEPS
        assert (first.seconds > 0).all()
        assert first.bad == 0
        assert np.array_equal(first.evaluations, again.evaluations)
        assert np.array_equal(first.work, again.work)
        if fixed:
            assert (first.evaluations == 1).all()
        else:
            assert first.lifted == 0
            assert first.evaluations.max() > 1


def test_steps_where_one_patch_becomes_two_take_few_evaluations() -> None:
    """Two hundred steps of the walk over the flange's root, at light loads: in each a second part
    of contact may appear, and force rises steeply."""
    long = random_walk(20000)
    part = slice(16700, 16900)
    walk = Walk(long.y[part], long.yaw[part], long.load[part], long.lift[part])
    scene = moving_wheel(METHODS[0][1], False)
    contact = _core.Contact(config_of(scene), False)
    results = [contact.step(one) for one in inputs_of(scene, walk, False)]
    assert {result["status"] for result in results} == {"converged"}
    loads = np.array([-result["force"][2] for result in results])
    assert np.abs(loads / walk.load - 1).max() < 1e-5
    joining = [bool(result["right"]["alternatives"]) for result in results]
    assert sum(joining) > 30
    # by secants and halving alone: 9 at most, and 10 of them above 7
    assert max(result["evaluations"] for result in results) <= 7
