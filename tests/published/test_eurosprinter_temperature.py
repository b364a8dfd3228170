"""Creep curve of the Siemens EuroSprinter 127001 locomotive with friction that depends on the
surface temperature (report DOT/FRA/ORD-24/18, section 3.3.4; data/eurosprinter_temperature.csv, of
the program CONTACT).

The table's temperatures carry the own heat of an element twice, and with friction that depends on
temperature its forces do so too: a bias that grows with the creepage. The bound is 5 % of the
curve's peak; how far the temperatures are apart is asserted from both sides, against the same sum
with that element counted twice.
"""

from __future__ import annotations

import numpy as np
import pytest
import railpatch
from patch_cases import Line, check, solve
from published_data import numbers

FORCE, FRICTION, SPEED = 106.7e3, 0.33, 10.0
A, B = 6.304e-3, 12.607e-3
ACROSS = 40  # 44 elements over 1.1 times the axes
CURVES = {
    "coulomb": None,
    "rise_1200": (0.19, 1200.0),
    "fall_1200": (-0.19, 1200.0),
    "fall_400": (-0.19, 400.0),
}
BOUND = 0.05  # of the curve's peak
READING = 0.01  # of a temperature, where full sliding is not complete and grids differ


@pytest.fixture(scope="module")
def table() -> list[dict[str, float]]:
    return numbers("eurosprinter_temperature.csv")


def run(creepage: float, law: tuple[float, float] | None, fields: bool = False) -> railpatch.Result:
    friction: dict = {"coefficient": FRICTION}
    if law:
        friction = {
            "law": "temperature",
            "reference": FRICTION,
            "change": law[0],
            "reference_temperature": 0.0,
            "temperature_range": law[1],
        }
    case = {
        "kind": "patch",
        "material": {"shear_modulus": 82e9, "poisson_ratio": 0.28},
        "geometry": {"semi_axes": [A, B]},
        "load": {"normal_force": FORCE},
        "grid": {"elements": [ACROSS, ACROSS]},
        "motion": {"creepage": [-creepage, 0.0], "rolling_speed": SPEED},
        "friction": friction,
        "temperature": {},
        "method": {"normal": "hertz"},
    }
    return solve(case, fields=fields)


@pytest.mark.parametrize("name", CURVES)
def test_creep_force(table: list[dict[str, float]], name: str) -> None:
    column = f"{name}_force"
    peak = max(row[column] for row in table)
    bound = (BOUND if CURVES[name] else 0.01) * peak
    check(
        [
            Line(
                f"{name}, creepage {row['creepage']:.4f}",
                run(row["creepage"], CURVES[name])["creep_force"][0] / FORCE,
                row[column],
                bound,
            )
            for row in table[::2]
        ]
    )


def test_temperature_and_its_known_bias(table: list[dict[str, float]]) -> None:
    """Where all slides: ours, and what the own heat twice makes of it."""
    lines = []
    for row in table:
        if row["creepage"] < 0.01:
            continue
        result = run(row["creepage"], None, fields=True)
        fields = result
        flux = SPEED * np.hypot(*fields["traction"]) * np.hypot(*fields["micro_slip"])
        own = np.sqrt(2 * 2 * A / ACROSS / (SPEED * np.pi)) * flux
        rise = np.array(fields["temperature"])[0] + own / (2 * np.sqrt(50.0 * 450.0 * 7850.0))
        target = row["coulomb_temperature"]
        name = f"own heat twice, creepage {row['creepage']:.4f}"
        lines.append(Line(name, rise.max(), target, READING * target))
        assert 0.08 < 1 - result["max_temperature"] / target < 0.13
    check(lines)
