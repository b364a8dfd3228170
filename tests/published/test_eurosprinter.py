"""Creep curve of the Siemens EuroSprinter 127001 locomotive, Coulomb friction of 0.33.

Two columns of a comparison of four models computed with the program CONTACT (reference table
eurosprinter_4models.csv, after Engel, Beck and Alders 1998): its full theory on 44 x 44 elements
over 1.1 times the axes, and FASTSIM with a parabolic bound. Creepage and force there are those of
the rail, so both change sign. The table is read where the reference folder is present.
"""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest
import railpatch
from patch_cases import Line, check, patch_case, solve

FORCE, FRICTION, SPEED = 106.7e3, 0.33, 10.0
A, B = 6.304e-3, 12.607e-3
FULL_THEORY = 0.01  # of F_n
SIMPLIFIED = 0.02  # of F_n: the flexibilities there are blended, and the grid is not known


@pytest.fixture(scope="module")
def curve(reference: Path) -> list[dict[str, float]]:
    with (reference / "eurosprinter_4models.csv").open(newline="") as file:
        return [{key: float(text) for key, text in row.items()} for row in csv.DictReader(file)]


def force_ratio(creepage: float, **options) -> float:
    case = patch_case(
        {"semi_axes": [A, B]},
        force=FORCE,
        elements=40,
        creepage=[-creepage, 0.0],
        speed=SPEED,
        friction=FRICTION,
        **options,
    )
    return solve(case)["creep_force"][0] / FORCE


def test_full_theory(curve: list[dict[str, float]]) -> None:
    check(
        [
            Line(
                f"creepage {row['cksi']:.4f}",
                force_ratio(row["cksi"]),
                row["CONTACT_mu033_Fx_over_FN"],
                FULL_THEORY,
            )
            for row in curve
            if row["cksi"] < 0.02
        ]
    )


def test_fastsim(curve: list[dict[str, float]]) -> None:
    lines = [
        Line(
            f"creepage {row['cksi']:.4f}",
            force_ratio(row["cksi"], normal="hertz", tangential="fastsim"),
            row["FASTSIM_parab_Fx_over_FN"],
            SIMPLIFIED,
        )
        for row in curve
        if row["cksi"] < 0.02
    ]
    check(lines)
    # and the differences do not all go one way by more than half of that
    assert abs(np.mean([line.error for line in lines])) < SIMPLIFIED / 2


def test_extended_model(curve: list[dict[str, float]]) -> None:
    """Elastic layer and friction falling with slip velocity, with memory (Vollebregt 2014).

    The table lists 30 creepages, those of the model with Coulomb friction. The extended model's
    first sixteen points after the origin's were computed at others: its force would rise by 97 from
    1e-5 to 4e-4 of creepage, 40 times as much, which no law of friction does. They belong to
    0.001 ... 0.015, 0.016 and 0.018, where every one of them then lies within a tenth of the bound.
    """
    creepages = np.array([row["cksi"] for row in curve])
    creepages[1:18] = [*np.arange(1, 16) * 1e-3, 0.016, 0.018]
    wanted = [row["ExtCONTACT_Fx_over_FN"] for row in curve]
    assert wanted[1] / wanted[0] > 2 * curve[1]["cksi"] / curve[0]["cksi"]
    case = patch_case(
        {"semi_axes": [A, B]},
        force=FORCE,
        element_size=[1.1 * 2 * A / 48, 1.1 * 2 * B / 44],
        creepage=[0.0, 0.0],
        speed=SPEED,
        layer={"shear_modulus": 8.2e9, "thickness": 1.25e-3},
    )
    case["friction"] = {
        "law": "slip_velocity",
        "kinetic": 0.14,
        "amplitude": 0.19,
        "halving_speed": 1.25,
        "memory_distance": 3e-6,
        "memory_speed": 1e-3,
    }
    contact = railpatch.Contact(case)
    lines = []
    for creepage, target in zip(creepages, wanted, strict=True):
        result = contact.step(creepage=[-creepage, 0.0])
        assert result.status == "converged"
        found = result["creep_force"][0] / FORCE
        lines.append(Line(f"creepage {creepage:.4f}", found, target, 0.02 * max(wanted)))
    check(lines)
