"""Creep curve of the Siemens EuroSprinter 127001 locomotive, Coulomb friction of 0.33.

Three of four models computed with the program CONTACT (data/eurosprinter_models.csv, after Engel,
Beck and Alders 1998): its full theory on 44 x 44 elements over 1.1 times the axes, FASTSIM with a
parabolic bound, and the extended model. Creepage and force there are those of the rail, so both
change sign.
"""

from __future__ import annotations

import numpy as np
import pytest
import railpatch
import scipy.special
from patch_cases import Line, check, patch_case, solve
from published_data import numbers

FORCE, FRICTION, SPEED = 106.7e3, 0.33, 10.0
A, B = 6.304e-3, 12.607e-3
FULL_THEORY = 0.01  # of F_n
ELEMENT = [1.1 * 2 * A / 48, 1.1 * 2 * B / 44]
EXTENDED = {
    "friction": {
        "law": "slip_velocity",
        "kinetic": 0.14,
        "amplitude": 0.19,
        "halving_speed": 1.25,
        "memory_distance": 3e-6,
        "memory_speed": 1e-3,
    },
    "layer": {"shear_modulus": 8.2e9, "thickness": 1.25e-3},
}
SIMPLIFIED = 0.02  # of F_n: the flexibilities there are blended, and the grid is not known


@pytest.fixture(scope="module")
def curve() -> list[dict[str, float]]:
    return numbers("eurosprinter_models.csv")


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
                f"creepage {row['contact_creepage']:.4f}",
                force_ratio(row["contact_creepage"]),
                row["contact_force"],
                FULL_THEORY,
            )
            for row in curve
            if row["contact_creepage"] < 0.02
        ]
    )


def test_fastsim(curve: list[dict[str, float]]) -> None:
    lines = [
        Line(
            f"creepage {row['fastsim_creepage']:.4f}",
            force_ratio(
                row["fastsim_creepage"],
                normal="hertz",
                tangential="fastsim",
                traction_bound="parabolic",
            ),
            row["fastsim_force"],
            SIMPLIFIED,
        )
        for row in curve
        if row["fastsim_creepage"] < 0.02
    ]
    check(lines)
    # and the differences do not all go one way by more than half of that
    assert abs(np.mean([line.error for line in lines])) < SIMPLIFIED / 2


def test_extended_model(curve: list[dict[str, float]]) -> None:
    """Elastic layer and friction falling with slip velocity, with memory (Vollebregt 2014)."""
    creepages = [row["extended_creepage"] for row in curve]
    wanted = [row["extended_force"] for row in curve]
    case = patch_case(
        {"semi_axes": [A, B]},
        force=FORCE,
        element_size=ELEMENT,
        creepage=[0.0, 0.0],
        speed=SPEED,
        layer=EXTENDED["layer"],
    )
    case["friction"] = EXTENDED["friction"]
    contact = railpatch.Contact(case)
    lines = []
    for creepage, target in zip(creepages, wanted, strict=True):
        result = contact.step(creepage=[-creepage, 0.0])
        assert result.status == "converged"
        found = result["creep_force"][0] / FORCE
        lines.append(Line(f"creepage {creepage:.4f}", found, target, 0.02 * max(wanted)))
    check(lines)


def test_extended_model_on_a_wheel(curve: list[dict[str, float]]) -> None:
    """The locomotive's wheel, a cylinder of 625 mm, on a crown that gives it the same ellipse."""
    # Hertz: the curvatures' ratio by that of the axes (Johnson 1985, eq. 4.28)
    long, short = scipy.special.ellipk(0.75), scipy.special.ellipe(0.75)
    radius, ratio = 0.625, (4 * short - long) / (long - short)
    case = {
        "kind": "wheel_rail",
        "grid": {"element_size": ELEMENT},
        "wheelset": {
            "vertical_force": FORCE,
            "speed": SPEED,
            "pitch_rate": -SPEED / radius,
            "nominal_radius": radius,
            "flange_back_distance": 1.36,
            "flange_back_position": -0.07,
        },
        "track": {"gauge": 1.435},
        "profiles": {"wheel": "cylinder", "rail": f"arc@{ratio * radius:.6f}"},
        **EXTENDED,
    }
    at_rest = railpatch.solve(case)
    assert at_rest["patches"][0]["contact_area"] == pytest.approx(np.pi * A * B, rel=0.02)
    del case["wheelset"]["vertical_force"]
    case["wheelset"]["z"] = at_rest["z"]
    contact = railpatch.Contact(case)
    lines = []
    for row in curve[::5]:
        creepage = -row["extended_creepage"]
        # rolling speed is the mean of wheel's and rail's
        step = {
            "speed": SPEED * (1 + creepage / 2),
            "pitch_rate": -SPEED * (1 - creepage / 2) / radius,
        }
        result = contact.step(**step)
        assert result.status == "converged"
        patch = result["patches"][0]
        assert patch["creepage"][0] == pytest.approx(creepage, abs=2e-3 * abs(creepage) + 1e-7)
        assert patch["rolling_speed"] == pytest.approx(SPEED, rel=1e-3)
        found = patch["creep_force"][0] / FORCE
        lines.append(Line(f"creepage {creepage:.4f}", found, row["extended_force"], 0.0))
    most = max(row["extended_force"] for row in curve)
    check([Line(one.scene, one.value, one.target, 0.02 * most) for one in lines])
