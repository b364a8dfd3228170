"""Sequences of input files whose regime changes, and those of wheels."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import railpatch
from click.testing import CliRunner
from inp_parts import BASIC, WHEEL, text_of, with_profiles
from railpatch.command.cli import cli
from railpatch.inp.run import solve_file


@pytest.fixture(scope="module")
def folder(tmp_path_factory) -> Path:
    return with_profiles(tmp_path_factory.mktemp("inp"))


# a shift, two steps of transient rolling, one of steady rolling and one of transient rolling more
SHIFT = text_of(BASIC, first="201100", rolling="", motion="50000. -0.004 0. 0.", end="")
ROLLS = "3 MODULE\n002100\n102000\n0130211\n50000. -0.0012 0. 0.\n"
ROLLS += "0d 0.6 15000.\n0.28 0.28 82000. 82000.\n"
STEADY = ROLLS.replace("002100", "003100")


def test_a_change_of_regime_is_one_contact(folder: Path) -> None:
    path = folder / "changes.inp"
    path.write_text(SHIFT + ROLLS + ROLLS + "0 MODULE\n")
    found = solve_file(path)
    assert [one.converted.begins for one in found] == [1, 1, 1]
    first = found[0].converted.tables
    own = railpatch.Contact(
        {
            **first,
            "motion": {**first["motion"], "regimes": ["shift"]},
            "method": {**first["method"], "spin_offset": "none"},
        }
    )
    forces = [own.step()["creep_force"]]
    rolling = {"rolling_speed": 15.0, "distance": 6e-4}
    for _ in range(2):
        step = own.step(regime="transient_rolling", creepage=[1.2e-3, 0.0], **rolling)
        forces.append(step["creep_force"])
    assert [one.result["creep_force"] for one in found] == forces
    # what the shift left is still there
    alone = railpatch.solve(found[1].converted.tables)
    assert abs(forces[1][0]) > 2 * abs(alone["creep_force"][0])
    # and as one file
    out = folder / "changes"
    done = CliRunner().invoke(cli, ["convert", str(path), "-o", str(out)])
    assert done.exit_code == 0, done.output
    whole = railpatch.solve(done.output.split()[0])
    assert whole["creep_force"] == forces[-1]
    assert [step["regime"] for step in whole["steps"]] == ["shift", *["transient_rolling"] * 2]


def test_rolling_on_from_a_steady_case(folder: Path) -> None:
    """A steady case needs nothing of what was before, and the next one goes on from it."""
    path = folder / "steady.inp"
    path.write_text(SHIFT + STEADY + ROLLS + "0 MODULE\n")
    found = solve_file(path)
    assert [one.converted.begins for one in found] == [1, 2, 2]
    steady, rolled = (np.array(one.result["creep_force"]) for one in found[1:])
    # a step over one element leaves the steady state as it is
    assert np.abs(rolled - steady).max() < 1e-4 * np.abs(steady).max()
    # after a case without tangential problem all begins anew
    none = ROLLS.replace("002100", "000100").replace("0d 0.6 15000.\n", "")
    path.write_text(SHIFT + none.replace("-0.0012 0. 0.", "0. 0. 0.") + ROLLS + "0 MODULE\n")
    assert [one.converted.begins for one in solve_file(path)] == [1, 2, 3]


def test_a_sequence_of_wheels(folder: Path) -> None:
    """Steps of a wheel in transient rolling, after a steady one."""
    first = text_of(WHEEL, end="")
    step = "1 1\n1002100\n0110002\n0130211\n0 2.1 60000. 0 0.1d 0\n20000. 0 0 0 0 -43.48\n"
    path = folder / "wheels.inp"
    path.write_text(first + step + step + "0\n")
    found = solve_file(path)
    assert [one.converted.begins for one in found] == [1, 1, 1]
    tables = found[0].converted.tables
    own = railpatch.Contact(
        {
            **tables,
            "motion": {"regime_changes": True},
            "wheelset": {**tables["wheelset"], "time_step": 2e-5},
            "method": {**tables["method"], "spin_offset": "contact"},
        },
        folder=folder,
    )
    rows = [own.step(), *(own.step(regime="transient_rolling", y=2.1e-3) for _ in range(2))]
    for row, one in zip(rows, found, strict=True):
        assert row["force"] == one.result["force"]
    done = CliRunner().invoke(cli, ["convert", str(path), "-o", str(folder / "no")])
    assert done.exit_code == 2
    assert "railpatch solve" in done.output


def test_force_and_torque_on_a_wheel(folder: Path) -> None:
    """F = 1 and 2: FX and MY are of the rail, MY in N mm; signs of the other program again."""
    path = folder / "driven.inp"
    for digit, last, kept in (("1", "-3000.", "FX"), ("2", "-1.38e6", "")):
        path.write_text(text_of(WHEEL, first=f"12031{digit}0", velocity=f"20000. 0 0 0 0 {last}"))
        (found,) = solve_file(path)
        assert found.result.status == "converged"
        # 1380 N m by 460 mm are 3000 N
        assert found.result["force"][0] == pytest.approx(3000.0, rel=1e-4 if kept else 0.02)
        assert found.result["axle_torque"] == pytest.approx(1380.0, rel=0.02 if kept else 1e-4)
