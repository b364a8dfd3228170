"""Rails with irregularities: the spectra, and what is made of them."""

from __future__ import annotations

import math
import tracemalloc

import numpy as np
import pytest
from railpatch import CaseError
from railpatch.case.load import check_table
from scipy.integrate import quad

from wheelset_demo.vehicle.irregularity import (
    ARM,
    BLOCK,
    CUT,
    LEVELS,
    RISE,
    WAVES,
    IrregularityTable,
    Waves,
    irregularity_of,
    record,
    spectrum,
)


@pytest.mark.parametrize(
    ("kind", "cycles", "density"),
    [
        # 1/m, m^2/(1/m): "ORE B176 high level" in the manual of GENSYS, program TRC_IPSD
        ("lateral", 0.00318, 4.6657e-3),
        ("lateral", 0.0200, 2.3194e-4),
        ("lateral", 0.1000, 6.1608e-6),
        ("lateral", 0.2000, 7.3333e-7),
        ("vertical", 0.00318, 8.2268e-3),
        ("vertical", 0.0200, 4.0897e-4),
        ("vertical", 0.1000, 1.0863e-5),
        ("vertical", 0.2000, 1.2931e-6),
    ],
)
def test_published_densities(kind, cycles, density):
    found = 2 * math.pi * spectrum(kind, "high", np.array(2 * math.pi * cycles))
    # 0.00318 stands for 1/314.16
    assert float(found) == pytest.approx(density, rel=1e-3)


@pytest.mark.parametrize("level", ["low", "high"])
@pytest.mark.parametrize("kind", ["lateral", "vertical"])
def test_variance_of_waves_is_the_integral(kind, level):
    """Between W1 and W2 the integral of S is A Wc^2/(Wc^2 - Wr^2) (atan(W/Wr)/Wr - atan(W/Wc)/Wc).

    A sum of waves whose numbers are drawn within equal shares of log W has that variance but for
    the drawing: with 400 shares, whose densities differ by 1 % within each, some 1e-3.
    """
    table = IrregularityTable(level=level, shortest=3.0, longest=120.0, seed=7)
    waves = Waves(kind, table, np.random.default_rng(table.seed))
    amplitude = LEVELS[level][0 if kind == "lateral" else 1]

    def part(w: float) -> float:
        return math.atan(w / RISE) / RISE - math.atan(w / CUT) / CUT

    low, high = 2 * math.pi / 120.0, 2 * math.pi / 3.0
    wanted = amplitude * CUT**2 / (CUT**2 - RISE**2) * (part(high) - part(low))
    assert 0.5 * np.sum(waves.amplitudes**2) == pytest.approx(wanted, rel=5e-3)


def test_process_has_the_variance():
    """Over 100 km, of one realisation: waves of 120 m pass 800 times, of variances that add as
    sums of n independent waves do: within some per cent."""
    table = IrregularityTable(seed=3)
    waves = Waves("vertical", table, np.random.default_rng(3))
    s = np.arange(0.0, 1e5, 7.3)
    values = waves.at(s)
    wanted, _ = quad(
        lambda w: float(spectrum("vertical", "low", np.array(w))),
        2 * math.pi / 120.0,
        2 * math.pi / 3.0,
        limit=200,
    )
    assert np.var(values) == pytest.approx(wanted, rel=0.05)
    assert abs(values.mean()) < 0.05 * math.sqrt(wanted)


def test_rails_follow_from_the_processes():
    """Both rails move sideways together; their heights differ by the cross level."""
    table = IrregularityTable(seed=2, begins=10.0)
    s, deviations = record(table, 400.0, 20.0)
    assert np.all(deviations[s <= 20.0] == 0)
    left_y, left_z, right_y, right_z = deviations.T
    assert np.array_equal(left_y, right_y)
    generator = np.random.default_rng(2)
    _, vertical, cross = (
        Waves(kind, table, generator).at(s) for kind in ("lateral", "vertical", "cross")
    )
    full = s > 30.0
    np.testing.assert_allclose(0.5 * (left_z + right_z)[full], vertical[full], atol=1e-12)
    np.testing.assert_allclose((right_z - left_z)[full], 2 * ARM * cross[full], atol=1e-12)
    rails = irregularity_of(table, 400.0, 20.0)
    at = np.array([31.7, 200.2])
    assert rails.at(at).shape == (2, 2, 2)
    # between the record's points, 12 in the shortest wave, the spline is off by some micrometres
    between = Waves("lateral", table, np.random.default_rng(2)).at(at)
    np.testing.assert_allclose(rails.at(at)[:, 0, 0], between, atol=5e-6)
    assert not np.array_equal(record(IrregularityTable(seed=4), 60.0, 0.0)[1][:60], deviations[:60])


def test_waves_are_summed_in_blocks():
    """As one by one, whatever the number of points."""
    waves = Waves("cross", IrregularityTable(), np.random.default_rng(0))
    s = np.linspace(0.0, 500.0, 2 * BLOCK + 5)
    found = waves.at(s)
    for k in (0, BLOCK - 1, BLOCK, 2 * BLOCK, len(s) - 1):
        wanted = np.sum(waves.amplitudes * np.cos(waves.numbers * s[k] + waves.phases))
        assert found[k] == pytest.approx(wanted, abs=1e-14)
    assert waves.at(np.zeros(0)).shape == (0,)


def test_memory_of_a_long_record():
    """60 s at 300 km/h: the angles of all waves at all points would be 77 MB."""
    tracemalloc.start()
    record(IrregularityTable(), 1.2 * 83.3 * 60 + 121.6, 21.6)
    _, most = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert most < 4 * 8 * BLOCK * WAVES


@pytest.mark.parametrize(
    ("table", "message"),
    [
        ({"level": "worst"}, r"irregularity.level"),
        ({"shortest": 50.0, "longest": 20.0}, r"irregularity.longest: value is 20.0, allowed > "),
        ({"factor": -1.0}, r"irregularity.factor"),
    ],
)
def test_bad_tables(table, message):
    with pytest.raises(CaseError, match=message):
        check_table(IrregularityTable, table, "irregularity")
