"""tangential = "table": interpolated creep forces against the full theory that filled the table,
and what must hold of them exactly."""

from __future__ import annotations

import numpy as np
import pytest
from railpatch import CaseError, _core
from railpatch.case.creep_table import default_table, describe_table
from railpatch.evidence.table.check import Interpolated
from railpatch.evidence.table.recipe import Recipe
from railpatch.evidence.table.solves import (
    FRICTION,
    NORMAL_FORCE,
    SIZE,
    UNIT,
    Accurate,
    scales_of,
    slopes,
)

STEEL = 0.28
RECIPE = Recipe()
# w = (G c^2/B) (xi, eta, c phi), F = (Fx, Fy, Mz/c)/B; c^2 = a b, B = mu Fn


def random_points(count: int, seed: int, greatest: float = 4.0) -> np.ndarray:
    """w of all sizes and directions."""
    rng = np.random.default_rng(seed)
    w = rng.normal(size=(count, 3))
    size = np.exp(rng.uniform(np.log(0.01), np.log(greatest), count))
    return w * (size / np.linalg.norm(w, axis=1))[:, None]


def steel(ratio: float, poisson: float = STEEL) -> Interpolated:
    """The table for an ellipse."""
    return Interpolated(default_table(), ratio, poisson)


@pytest.mark.parametrize("ratio", [0.23, 0.9, 4.3])
def test_the_full_theory_is_met_between_the_nodes(ratio: float) -> None:
    """Random cases, solved by the table's own recipe: the error that the table states, its 95th
    percentile and worst, bound the median and the worst of these."""
    stated = describe_table(default_table().tobytes())["error"]["all"]
    solve = Accurate(RECIPE, ratio, STEEL)
    slope = slopes(RECIPE, ratio, STEEL)
    scale, table = scales_of(RECIPE, slope), steel(ratio)
    found = []
    for w in random_points(20, 7, 2.0 / abs(slope[1, 2])):
        solve.reset()
        found.append(table(w) - solve(w, scale * w))
    force = np.hypot(*np.array(found)[:, :2].T)
    print(f"\na/b {ratio}: force {np.sort(force)[-3:]}, stated {stated['force']}")
    assert np.median(force) <= stated["force"][1]
    assert force.max() <= stated["force"][2]


@pytest.mark.parametrize(
    ("ratio", "bound"),
    [
        # at nodes the table holds the same slopes, to the precision of its numbers
        (RECIPE.axis_ratios[2], 1e-5),
        (1.0, 1e-5),
        (RECIPE.axis_ratios[8], 1e-5),
        # between them the error that the table may have
        (0.3, 5e-3),
        (3.1, 5e-3),
    ],
)
def test_small_creepages_follow_the_linear_theory(ratio: float, bound: float) -> None:
    """Slopes at zero creepage are the solver's, from every direction."""
    wanted = slopes(RECIPE, ratio, STEEL)
    table = steel(ratio)
    for w in random_points(30, 3):
        w *= 1e-8 / np.linalg.norm(w)
        target = wanted @ w
        assert np.abs(table(w) - target).max() <= bound * np.abs(target).max()
    # exactly linear: the sum of the parts
    w = 1e-8 * np.array([0.4, -0.7, 0.5])
    parts = sum(table(part) for part in np.diag(w))
    assert table(w) == pytest.approx(parts, rel=1e-5, abs=1e-13)
    assert np.all(table(np.zeros(3)) == 0.0)


def test_large_creepages_slide() -> None:
    """Without spin the force has the bound's size and opposes the creepage."""
    for ratio in (0.15, 1.0, 7.0):
        table = steel(ratio)
        for angle in np.linspace(0.0, 2.0 * np.pi, 13):
            way = np.array([np.cos(angle), np.sin(angle), 0.0])
            assert table(1e6 * way) == pytest.approx(-way, abs=3e-3)
    # pure spin: the moment of the elliptic pressure's friction, 3 pi/16 mu Fn a (a = b)
    assert steel(1.0)(np.array([0.0, 0.0, 1e8])) == pytest.approx(
        [0.0, 0.0, -3.0 * np.pi / 16.0], abs=2e-4
    )


def test_symmetries_hold_to_the_bit() -> None:
    """Reversal of all signs, mirror image, reversal of xi, rolling the other way."""
    for ratio in (0.2, 2.7):
        table = steel(ratio)
        for w in random_points(200, 5):
            f = table(w)
            assert np.array_equal(table(-w), -f)
            assert np.array_equal(table(w * [1, -1, -1]), f * [1, -1, -1])
            assert np.array_equal(table(w * [-1, 1, 1]), f * [-1, 1, 1])
            assert np.array_equal(table(w * [-1, 1, -1], direction=-1), f * [-1, 1, -1])


def test_rolling_backwards_is_what_the_full_theory_gives() -> None:
    """The mirror image in x, against the solver rolling along -x."""
    ratio, w = 1.4, np.array([0.2, -0.3, 0.25])
    solve = Accurate(RECIPE, ratio, STEEL)
    mirrored = w * [-1, 1, -1]
    forward = solve(mirrored, mirrored) * [-1, 1, -1]
    assert steel(ratio)(w, direction=-1) == pytest.approx(forward, abs=6e-3)


def directions() -> list[tuple[np.ndarray, np.ndarray]]:
    """Points on planes of symmetry, at pure spin, near zero, on cells' borders; and ways across."""
    rng = np.random.default_rng(11)
    points = [
        [0.0, 0.3, 0.2],
        [0.0, -0.1, 0.7],
        [0.3, 0.4, 0.0],
        [0.1, -0.6, 0.0],
        [0.0, 0.5, 0.0],
        [0.5, 0.0, 0.0],
        [0.0, 0.0, 0.4],
        [0.0, 0.0, 2.0],
        *rng.normal(size=(6, 3)),
    ]
    return [(np.array(point), way) for point in points for way in rng.normal(size=(3, 3))]


def test_slopes_have_no_jump() -> None:
    """One-sided slopes at borders differ by what the second derivative allows and no more: they
    agree in the limit. Also across zero creepage."""
    for ratio in (0.1 * 10**0.2, 1.0, 3.3):  # a node of the table and two others
        table = steel(ratio)
        for point, way in [*directions(), (np.zeros(3), np.array([0.3, -0.5, 0.4]))]:
            jumps = []
            for step in (1e-3, 1e-4, 1e-5):
                ahead = (table(point + step * way) - table(point)) / step
                behind = (table(point) - table(point - step * way)) / step
                jumps.append(np.abs(ahead - behind).max())
            # a jump would stay; what is left of a bounded second derivative shrinks with the step
            assert jumps[-1] < 0.05 * jumps[0] + 1e-6, (ratio, point, way, jumps)


def test_slopes_have_no_jump_in_the_axis_ratio() -> None:
    w = np.array([0.2, 0.3, -0.3])
    for node in RECIPE.axis_ratios[1:-1]:
        step = 1e-4 * node
        f = [steel(node + k * step)(w) for k in (-1, 0, 1)]
        assert np.abs(f[0] - 2 * f[1] + f[2]).max() / step < 2e-2


def test_force_stays_below_the_bound_and_power_is_lost() -> None:
    case = {
        "kind": "patch",
        "geometry": {"semi_axes": [0.006, 0.004]},
        "load": {"normal_force": 8e4},
        "motion": {"creepage": [0.0, 0.0]},
        "friction": {"coefficient": 0.3},
        "method": {"normal": "hertz", "tangential": "table"},
    }
    import railpatch

    contact = railpatch.Contact(case)
    unit = 0.3 * 8e4 / (82e9 * 0.006 * 0.004)
    for w in random_points(2000, 17, 100.0):
        xi, eta, phi = unit * w / [1.0, 1.0, np.sqrt(0.006 * 0.004)]
        result = contact.step(creepage=[float(xi), float(eta)], spin_creepage=float(phi))
        fx, fy = result["creep_force"]
        assert np.hypot(fx, fy) < 0.3 * 8e4
        power = -(fx * xi + fy * eta + result["spin_moment"] * phi) * 10.0
        assert result["friction_power"] == pytest.approx(power, rel=1e-12)
        assert power > 0
    estimate = result["error_estimate"]
    # no more than the worst error that the table states
    worst = describe_table(default_table().tobytes())["error"]["all"]["force"][2]
    assert 0 < estimate["creep_force"] <= worst * 0.3 * 8e4
    assert estimate["spin_moment"] > 0
    assert result["elements"] == {"exterior": 0, "stick": 0, "slip": 0, "plastic": 0}


def test_beyond_the_axis_ratios_the_nearest_stands_in() -> None:
    for ratio, nearest in ((0.05, 0.1), (30.0, 10.0)):
        outside, inside = steel(ratio), steel(nearest)
        w = np.array([0.2, 0.1, 0.05])
        values = {"normal_force": NORMAL_FORCE, "creepage": (UNIT * w[:2]).tolist()}
        assert outside._contact.step(values)["status"] == "out_of_range"
        assert outside(w) == pytest.approx(inside(w), rel=1e-5)


def test_nodes_are_found_again() -> None:
    """A few nodes of the stored table, solved anew by the recipe inside it."""
    stored = describe_table(default_table().tobytes())
    assert {k: v for k, v in stored.items() if k in RECIPE.__dict__} == {
        k: list(v) if isinstance(v, tuple) else v for k, v in RECIPE.__dict__.items()
    }
    for i, j, k, m in ((3, 2, 5, 8), (5, 6, 12, 11), (8, 0, 4, 14)):
        ratio, n, t = RECIPE.axis_ratios[i], RECIPE.direction(j, k), RECIPE.t_nodes[m]
        scale = scales_of(RECIPE, slopes(RECIPE, ratio, STEEL))
        v = RECIPE.radius * t / (1.0 - t) * n
        solved = Accurate(RECIPE, ratio, STEEL)(v / scale, v)
        # a spline goes through its nodes; the start of an iteration moves it by its tolerance
        assert steel(ratio)(v / scale) == pytest.approx(solved, abs=5e-4)


def broken(name: str) -> bytes:
    """A table with one thing wrong."""
    table = bytearray(default_table().tobytes())
    if name == "short":
        return bytes(table[:40])
    if name == "cut":
        return bytes(table[:-8])
    if name == "magic":
        table[0] ^= 1
    if name == "altered":
        table[5000] ^= 1
    if name == "axis":
        table[24] = 3
    return bytes(table)


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("short", "too short"),
        ("cut", "length"),
        ("magic", "no creep table"),
        ("altered", "checksum"),
        ("axis", "axis"),
    ],
)
def test_a_broken_table_is_refused(name: str, text: str) -> None:
    data = np.frombuffer(broken(name), np.uint8)
    with pytest.raises(CaseError, match="creep_table.*" + text):
        Interpolated(data, 1.0, STEEL)


def test_no_table_is_refused() -> None:
    with pytest.raises(CaseError, match="creep_table is null"):
        _core.Contact({"tangential": "table", "normal": "hertz"}, False)


def test_the_unit_of_the_moment() -> None:
    """Pure spin of a circular contact in the linear theory by hand: Mz = -C33 G c^4 phi."""
    contact = steel(1.0)._contact
    phi = 1e-6
    result = contact.step({"normal_force": NORMAL_FORCE, "spin_creepage": phi})
    moment = result["right"]["patches"][0]["spin_moment"]
    c33 = -slopes(RECIPE, 1.0, STEEL)[2, 2]
    assert moment == pytest.approx(-c33 * 82e9 * SIZE**4 * phi, rel=2e-3)
    assert pytest.approx(FRICTION * NORMAL_FORCE / (82e9 * SIZE**2)) == UNIT
