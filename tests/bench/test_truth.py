"""The stored truth: whole, possible, and what coarser grids and closed forms say."""

from __future__ import annotations

from importlib import resources

import numpy as np
import pytest
from railpatch.evidence.bench.methods import FITTED, UNIFORM
from railpatch.evidence.bench.sets import DIRECTIONS, ELLIPSES, MAGNITUDES, SPINS
from railpatch.evidence.bench.truth import (
    FILE,
    FITTED_ORDER,
    PLAIN,
    UNIFORM_ORDER,
    Recipe,
    TruthFile,
    batches_of,
    combine,
    compute_truth,
    recipes_of,
    solve_batch,
)

MOST_BYTES = 300_000
# of the force, 95th percentile: a tenth of the one per cent that methods are chosen for, by the
# finest check. Checks that take every step of a set, and those of thin layers (D), which uniform
# grids do not resolve: a third of it
AGREED, AGREED_ALL = 1e-3, 3e-3
SEED = 4


@pytest.fixture(scope="module")
def truth() -> TruthFile:
    return TruthFile()


def test_file(truth: TruthFile) -> None:
    assert truth.names == "ABCDW"
    for name in truth.names:
        assert len(truth.agreement(name)) == len(truth.recipes_of(name)) - 1 >= 1
    assert all(recipe["grids"] and recipe["version"] for recipe in truth.recipes)
    data = resources.files("railpatch.evidence.bench").joinpath(FILE).read_bytes()
    assert len(data) <= MOST_BYTES


@pytest.mark.parametrize("name", "ABCD")
def test_values(truth: TruthFile, name: str) -> None:
    agreement = truth.agreement(name)
    # the first check takes every step
    assert np.isfinite(agreement[0]).all()
    assert np.percentile(agreement[0, :, 0], 95) <= AGREED_ALL
    finest = agreement[-1, :, 0]
    assert np.percentile(finest[np.isfinite(finest)], 95) <= (AGREED_ALL if name == "D" else AGREED)
    for index, batch in enumerate(batches_of(name)):
        found = truth.of(name, index)
        assert found.values.shape == (len(batch), 4)
        assert (np.hypot(*found.values[:, :2].T) <= 1 + found.agreement[0, :, 0] + AGREED).all()
        assert (found.values[:, 3] > 0).all()
        # friction takes power out
        power = batch.true_power(found.values[:, :2], found.values[:, 2])
        assert (power >= -AGREED).all()
        if batch.exact_pressure:
            assert (found.values[:, 3] == 1).all()


def table(truth: TruthFile, index: int) -> np.ndarray:
    """Truth of one ratio of set A, [spin, direction, magnitude, 4]."""
    return truth.of("A", index).values.reshape(len(SPINS), len(DIRECTIONS), len(MAGNITUDES), 4)


@pytest.mark.parametrize("index", range(len(ELLIPSES)))
def test_closed_forms(truth: TruthFile, index: int) -> None:
    values = table(truth, index)
    # nothing moves: no force; without spin, mirrored directions give mirrored forces
    assert np.abs(values[0, :, 0, :3]).max() == pytest.approx(0, abs=1e-9)
    mirrored = values[0, ::-1] * [1, -1, -1, 1]
    assert np.abs(values[0] - mirrored).max() < AGREED
    # a creepage of many times saturation makes all slide: mu F, along an axis exactly against it
    slide = values[0, :, -1, :2]
    assert np.hypot(*slide.T) == pytest.approx(1, abs=AGREED)
    assert np.abs(slide[[0, 3, 6]] - [[0, 1], [-1, 0], [0, -1]]).max() < AGREED
    # small creepages: the linear theory, whose coefficients are known to 2 %, and which a tenth of
    # saturation leaves by about a thirtieth: 1 - (1 - 0.1)^(1/3) of Johnson's cubic law
    assert np.hypot(*values[0, :, 1, :2].T) == pytest.approx(0.1, rel=0.07)


@pytest.mark.parametrize("name", "ABCD")
def test_coarser_grids_say_the_same(truth: TruthFile, name: str) -> None:
    # cases drawn by seed, recomputed by cheaper recipes; these know by their own difference how
    # far they can be trusted
    even = Recipe("even", PLAIN, (24, 28, 32, 36), UNIFORM_ORDER)
    odd = Recipe("odd", PLAIN, (23, 27, 31, 35), UNIFORM_ORDER)
    rows = Recipe("rows", FITTED, (12, 16), FITTED_ORDER)
    recipes = (even, odd) if name == "B" else (even, rows)
    random = np.random.default_rng(SEED)
    batches = batches_of(name)
    for index in random.choice(len(batches), 3, replace=False):
        batch, stored = batches[index], truth.of(name, index)
        chosen = np.sort(random.choice(len(batch), min(3, len(batch)), replace=False))
        part = batch.take(chosen)
        again = combine(
            part,
            [r.extrapolated([solve_batch(r, part, n) for n in r.grids]) for r in recipes],
        )
        difference = np.hypot(*(again.values - stored.values[chosen])[:, :2].T)
        allowed = 2 * again.agreement[0, :, 0].max() + stored.agreement[0, chosen, 0] + AGREED
        assert (difference <= allowed).all(), (name, batch.name, chosen, difference, allowed)


def test_extrapolation() -> None:
    recipe = Recipe("", UNIFORM, (10, 20, 40), 2.0)
    values = [np.array([[3.0 + 7.0 / n**2, -1.0]]) for n in recipe.grids]
    assert recipe.extrapolated(values) == pytest.approx(np.array([[3.0, -1.0]]))


def test_computing_goes_on_where_it_stopped(tmp_path, monkeypatch: pytest.MonkeyPatch) -> None:
    recipes = (
        Recipe("even", UNIFORM, (8, 10), 1.0),
        Recipe("rows", FITTED, (7, 9), 1.0, "AD"),
        Recipe("odd", UNIFORM, (7, 9), 1.0, "B"),
    )
    monkeypatch.setattr("railpatch.evidence.bench.truth.RECIPES", recipes)
    first = compute_truth(tmp_path, "D", 1).read_bytes()
    parts = sorted((tmp_path / "parts").iterdir())
    assert len(parts) == 4 * len(batches_of("D"))
    kept = {path: path.stat().st_mtime_ns for path in parts[1:]}
    parts[0].unlink()
    assert compute_truth(tmp_path, "D", 1).read_bytes() == first
    assert parts[0].exists()
    assert {path: path.stat().st_mtime_ns for path in parts[1:]} == kept
    found = TruthFile(tmp_path / FILE)
    assert found.names == "D"
    assert [recipe["name"] for recipe in found.recipes] == ["even", "rows", "odd"]
    assert [recipe.name for recipe in recipes_of("B")] == ["even", "odd"]


def test_truth_of_other_problems_is_refused(tmp_path) -> None:
    data = dict(np.load(resources.files("railpatch.evidence.bench").joinpath(FILE).open("rb")))
    data["A_sum"] = data["A_sum"] * 1.001
    np.savez(tmp_path / "other.npz", **data)
    with pytest.raises(ValueError, match="set A"):
        TruthFile(tmp_path / "other.npz")


def test_set_without_truth(tmp_path, monkeypatch: pytest.MonkeyPatch) -> None:
    recipe = Recipe("one", UNIFORM, (7, 8), 1.0)
    monkeypatch.setattr("railpatch.evidence.bench.truth.RECIPES", (recipe, recipe))
    found = TruthFile(compute_truth(tmp_path, "C", 1)).of("D", 0)
    assert found.values.shape == (len(batches_of("D")[0]), 4)
    assert np.isnan(found.values).all()
    assert np.isnan(found.agreement).all()


def test_power_of_full_sliding() -> None:
    # all slides: the power is the friction force times the rigid slip velocity, no spin
    batch = batches_of("A")[2].take(np.array([22]))
    along = batch.creepage / np.linalg.norm(batch.creepage)
    assert batch.spin[0] == 0
    assert batch.true_power(-along, np.zeros(1))[0] == pytest.approx(1.0)
    assert batch.scales().slip[0] == pytest.approx(np.linalg.norm(batch.creepage))
