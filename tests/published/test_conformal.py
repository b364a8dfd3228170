"""Conformal contact of S1002 on UIC60 against the program CONTACT (Vtech CMCC, open source version
of 2023, its example mbench_conf, first case): the Manchester benchmark's profiles with another cant
of 0.025, right wheel, y = 6.25 mm, yaw 24 mrad, position prescribed, friction from 0.3 at an
inclination of 10 degrees to 0.2 at 20 degrees, elements of 0.2 mm. Contact has two parts whose
inclinations reach from 21 to 70 degrees.

CONTACT's coefficients are those of the arc length alone, ours are corrected for inclination, and
its patches share a plane up to other distances. Bounds: forces 2 % of the vertical one, greatest
pressure 2 % as for the benchmark itself, energy and power 3 %, one element at each end
of the 13 rows in contact.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import railpatch
from published_data import MANCHESTER

# on the wheel, in our units
FORCE = [775.5, -4779.0, -1.016e4]  # N
PRESSURE, ELEMENTS, ROWS, ENERGY, POWER = 1181e6, 418, 13, 0.1074, 192.5  # Pa, -, -, J, W
POSITION = [-7.2534e-3, 0.7236467, 5.2094e-3]  # m
ANGLES = [-69.84, -20.87]  # degrees


def conformal_case(surface: str) -> dict[str, Any]:
    return {
        "kind": "wheel_rail",
        "wheelset": {
            "y": 6.25e-3,
            "z": 0.172e-3,
            "yaw": 0.024,
            "speed": 2.0,
            "pitch_rate": -4.3481124,
            "nominal_radius": 0.46,
            "flange_back_distance": 1.36,
            "flange_back_position": -0.07,
        },
        "track": {"gauge": 1.435, "gauge_height": 0.014, "cant": 0.025},
        "profiles": MANCHESTER,
        "grid": {"element_size": [2e-4, 2e-4]},
        "friction": {
            "coefficient": 0.3,
            "factor": [[np.radians(10), 1.0], [np.radians(20), 2 / 3]],
        },
        "method": {"reference_surface": surface, "patch_rule": "contact"},
    }


def test_gauge_corner() -> None:
    result = railpatch.solve(conformal_case("curved"), fields=True)
    assert result.status == "converged"
    (patch,) = result["patches"]
    assert result["force"] == pytest.approx(FORCE, abs=0.02 * 1.016e4)
    assert patch["max_pressure"] == pytest.approx(PRESSURE, rel=0.02)
    elements = patch["elements"]["stick"] + patch["elements"]["slip"]
    assert elements == pytest.approx(ELEMENTS, abs=2 * ROWS)
    assert patch["elements"]["stick"] == 0
    assert patch["elastic_energy"] == pytest.approx(ENERGY, rel=0.03)
    # all slips: the power of rigid motion and that of micro-slip are the same
    assert patch["friction_power"] == pytest.approx(POWER, rel=0.03)
    assert patch["position"] == pytest.approx(POSITION, abs=5e-5)
    touching = patch["row_angle"][(patch["pressure"] > 0).any(axis=1)]
    # rows are 0.2 mm apart, on arcs of 13 mm and more
    row = np.degrees(0.2 / 13)
    assert np.degrees([touching[0], touching[-1]]) == pytest.approx(ANGLES, abs=1.5 * row)


def test_plane_is_far_from_it() -> None:
    """What the curved surface is for: one plane for both parts presses them together."""
    result = railpatch.solve(conformal_case("plane"))
    (patch,) = result["patches"]
    assert result["force"][2] < 1.1 * FORCE[2]
    assert patch["max_pressure"] > 1.4 * PRESSURE
