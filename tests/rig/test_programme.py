"""Where the wheelset is put, and how the next balance is predicted."""

from __future__ import annotations

import numpy as np
import pytest
from railpatch.errors import CaseError

from rig_model.predict import MEMORY, Predictor
from rig_model.programme import Position, drift, monotone, polygon
from rig_model.scene import load_rig_scene

# yaw in mrad, y in mm: the positions published for the NRC run, dry, 10 mph, 13,750 lb a side
PUBLISHED = {
    0: (0, 0.3),
    1: (2, 0.6472964),
    3: (6, 1.3),
    5: (10, 1.832089),
    7: (14, 2.179385),
    9: (18, 2.3),
    19: (-2, -0.04729636),
    21: (-6, -6.3),
    23: (-10, -6.459627),
    25: (-14, -6.563816),
    27: (-18, -6.6),
    33: (-6, -6.24),
    35: (-2, -2.084189),
}


@pytest.fixture(scope="module")
def run(nominal_file):
    return load_rig_scene(nominal_file).positions()


def test_37_positions_two_mrad_apart(run):
    yaw = np.array([position.yaw for position in run])
    assert len(run) == 37
    np.testing.assert_allclose(np.abs(np.diff(yaw)), 2e-3, rtol=1e-9)
    assert (yaw.max(), yaw.min()) == (0.018, -0.018)
    assert [position.index for position in run] == list(range(37))
    assert run[0].time == 0
    assert run[-1].time == 360.0
    assert run[-1].progress == 1.0


@pytest.mark.parametrize("index", PUBLISHED)
def test_published_positions_are_met(run, index):
    yaw, y = PUBLISHED[index]
    assert run[index].yaw == pytest.approx(1e-3 * yaw, abs=1e-12)
    assert run[index].y == pytest.approx(1e-3 * y, abs=1e-9)


def test_branches(run):
    """The return from 18 mrad repeats the way out; that from -18 differs near -2 to -6 mrad."""
    for index in range(10):
        assert run[18 - index].y == pytest.approx(run[index].y, abs=1e-9)
    difference = {round(1e3 * run[i].yaw): run[54 - i].y - run[i].y for i in range(19, 27)}
    assert difference[-2] == pytest.approx(-2.0368926e-3, abs=1e-9)
    assert difference[-6] == pytest.approx(0.06e-3, abs=1e-9)
    assert difference[-10] == pytest.approx(0, abs=1e-9)
    assert abs(difference[-4]) > 0.5e-3


def test_lateral_position_does_not_overshoot():
    table = [[0, 0.0], [0.1, 0.0], [0.2, 1.0], [1, 1.0]]
    at = np.linspace(0, 1, 500)
    values = np.array(monotone(table, at))
    assert values.min() == 0
    assert values.max() == 1
    assert (np.diff(values) >= 0).all()
    assert max(polygon(table, at)) == 1


def test_rate(nominal_file):
    scene = load_rig_scene(nominal_file, {"rate": 200.0, "duration": 2.0})
    run = scene.positions()
    assert len(run) == 401
    np.testing.assert_allclose(np.diff([position.time for position in run]), 5e-3)
    # a dozen snapshots in all, and in a run that turns at its quarters the turns among them
    assert 12 <= len(run) / scene.snapshot_every() <= 14
    every = load_rig_scene(nominal_file, {"positions": 37}).snapshot_every()
    assert {9, 27, 36} <= set(range(0, 37, every))


def along(progress, y, yaw):
    return Position(0, progress, progress, y, yaw)


def test_prediction_extrapolates_a_parabola_exactly():
    predictor = Predictor(lambda p: np.array([p.y, 0.0]), np.ones(2))

    def truth(t):
        return np.array([2 * t**2 - t + 1e-3 * t, 3 * t])

    for t in (0.0, 0.1, 0.2, 0.3, 0.4):
        predictor.remember(along(t, 1e-3 * t, 1e-2 * t), truth(t), None)
    found = predictor.predict(along(0.5, 0.5e-3, 0.5e-2))
    np.testing.assert_allclose(found.unknowns, truth(0.5), atol=1e-12)
    assert found.jacobian is None


def test_first_prediction_is_the_baseline():
    predictor = Predictor(lambda p: np.array([p.y]), np.ones(1))
    assert predictor.predict(along(0, 7.0, 0)).unknowns == [7.0]


def test_place_passed_before_is_remembered_with_its_jacobian():
    predictor = Predictor(lambda p: np.zeros(1), np.ones(1))
    for k, y in enumerate((0.0, 1e-3, 2e-3, 3e-3)):
        predictor.remember(along(0.1 * k, y, 0), np.array([10.0 * k]), np.full((1, 1), k))
    back = predictor.predict(along(0.4, 2e-3, 0))
    assert back.unknowns == [20.0]
    assert back.jacobian == [[2]]
    assert predictor.predict(along(0.4, 4e-3, 0)).jacobian is None


def test_memory_is_bounded():
    predictor = Predictor(lambda p: np.zeros(1), np.ones(1))
    for k in range(MEMORY + 10):
        predictor.remember(along(k, k, 0), np.array([2.0 * k]), None)
    assert predictor.predict(along(MEMORY + 10, MEMORY + 10, 0)).unknowns == [2 * (MEMORY + 10)]
    # the first ones are forgotten: of those that are left this is the nearest
    assert predictor.predict(along(MEMORY + 11, 3.0, 0)).unknowns == [2 * 10.0]


def test_drift_is_a_natural_spline():
    """Through 0, 1, 0 at 0, h, 2h: 1/2 + 3/16 half way (de Boor 1978, chapter 4); a line of two."""
    assert drift([0.0, 1.0, 0.0], np.array([0.25, 0.5, 0.75])) == pytest.approx(
        [11 / 16, 1.0, 11 / 16], rel=1e-12
    )
    assert drift([1.0, 3.0], np.array([0.25, 1.0])) == pytest.approx([1.5, 3.0], rel=1e-12)


def test_drift_is_added(scene_with, nominal_file):
    end = "\n[rig.drift]\nyaw = [0.0, 2e-4]\nlateral_position = [1e-3]\n"
    plain = load_rig_scene(nominal_file).positions()
    for a, b in zip(plain, load_rig_scene(scene_with(end=end)).positions(), strict=True):
        assert b.yaw - a.yaw == pytest.approx(2e-4 * a.progress, abs=1e-15)
        assert b.y - a.y == pytest.approx(1e-3, abs=1e-15)


@pytest.mark.parametrize("keys", ["", "yaw = []", "yaw = [0.2]", "lateral_position = [-0.2]"])
def test_drift_out_of_range(scene_with, keys):
    with pytest.raises(CaseError, match=r"rig\.drift\.(yaw|lateral_position): value is"):
        load_rig_scene(scene_with(end=f"\n[rig.drift]\n{keys}\n"))
