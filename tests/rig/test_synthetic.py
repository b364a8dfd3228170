"""The worked example: what its record was made with is found from it."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from railpatch.case.load import read_toml
from railpatch.match import load_match, run_match

from rig_model.synthetic import OFFSET, SEEK, TRUTH, write_synthetic


def test_the_example_finds_its_truth(tmp_path: Path) -> None:
    """Few positions and coarse elements, seed and noise as they are shipped."""
    path = write_synthetic(tmp_path, count=9, elements=2e-3)
    assert read_toml(tmp_path / "truth.toml") == TRUTH
    plan = load_match(path)
    assert len(plan.explanations[0].content["rig"]["columns"]) == 7
    options = {"starts": 1, "folds": 0, "intervals": "covariance", "discrepancy": False}
    found = run_match(replace(plan, table=plan.table.model_copy(update=options)))
    assert set(found.parameters) == set(SEEK)
    for key, truth in TRUTH.items():
        parameter = found.parameters[key]
        assert parameter.low < truth < parameter.high, key
    # 32 degrees of freedom tell the noise, 1 % of half the load, to an eighth
    noise = found.explanations[0].fit.noise.error
    assert noise.mean() == pytest.approx(0.01 * 0.5 * 133.95e3, rel=0.4)
    # the whole ranges are far wider than what is found
    width = found.parameters[OFFSET].high - found.parameters[OFFSET].low
    assert width < 0.5 * (SEEK[OFFSET]["high"] - SEEK[OFFSET]["low"])
