"""Regimes of water: Polach 2005 (Wear 258), dry and wet, whose parameters stand in docs/fluids.md.

The table was computed independently from F = (2 mu Q/pi)(k_A e/(1 + (k_A e)^2) + atan(k_S e)),
e = G pi a b c_11 |s|/(4 Q mu), mu = mu_0 ((1 - A) exp(-B |s| V) + A), with Kalker's published
c_11 of 4.12 at Q = 100 kN, a = b = 6 mm, G = 82 GPa, Poisson's ratio 0.25.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
import railpatch
from case_samples import WHEELSET, with_values
from railpatch.case import CaseError
from railpatch.case.fluid import DRY_FRICTION
from scipy.interpolate import PchipInterpolator

CREEPAGES = [1e-3, 3e-3, 1e-2, 3e-2, 0.1, 0.3]
# F/Q by water rate and speed
TABLE = {
    (0.0, 5.0): [0.08331, 0.21508, 0.35909, 0.43830, 0.44304, 0.34999],
    (0.0, 20.0): [0.08329, 0.21405, 0.34504, 0.38691, 0.30923, 0.22727],
    (1e-6, 5.0): [0.02416, 0.06875, 0.15370, 0.20226, 0.24863, 0.24387],
    (1e-6, 20.0): [0.02416, 0.06871, 0.15201, 0.19437, 0.21562, 0.16973],
}
KNOTS = {0.0: (1.0, 0.4, 0.55, 0.4, 0.6), 25e-9: (0.3, 0.1, 0.05, 1.0, 0.0)}
KNOTS |= {1e-6: (0.3, 0.1, 0.30, 0.4, 0.2)}
LOAD, RADIUS, MODULUS = 1e5, 6e-3, 82e9


def contact(rate: float = 0.0, **fluid: Any) -> railpatch.Contact:
    return railpatch.Contact(
        {
            "kind": "patch",
            "material": {"shear_modulus": MODULUS, "poisson_ratio": 0.25},
            "geometry": {"semi_axes": [RADIUS, RADIUS]},
            "load": {"normal_force": LOAD},
            "motion": {"creepage": [1e-3, 0.0], "rolling_speed": 5.0},
            "fluid": {"model": "regimes", "water_rate": rate, **fluid},
            # the core's own coefficient for this ratio of axes is not Kalker's to the last digit
            "method": {
                "normal": "hertz",
                "tangential": "polach",
                "percent_kalker": 100 * 4.12 / own_coefficient(),
            },
        }
    )


def own_coefficient() -> float:
    """c_11 of the linear theory."""
    result = railpatch.solve(
        {
            "kind": "patch",
            "material": {"shear_modulus": MODULUS, "poisson_ratio": 0.25},
            "geometry": {"semi_axes": [RADIUS, RADIUS]},
            "load": {"normal_force": LOAD},
            "motion": {"creepage": [1e-6, 0.0], "rolling_speed": 5.0},
            "friction": {"coefficient": 0.5},
            "method": {"normal": "hertz", "tangential": "linear"},
        }
    )
    return -result["creep_force"][0] / (MODULUS * RADIUS**2 * 1e-6)


def polach(knot: tuple[float, ...], creepage: float, speed: float) -> float:
    """N, of a pure longitudinal creepage."""
    k_a, k_s, mu0, a, b = knot
    mu = mu0 * ((1 - a) * math.exp(-b * creepage * speed) + a)
    e = MODULUS * math.pi * RADIUS**2 * 4.12 * creepage / (4 * LOAD * mu)
    return 2 * LOAD * mu / math.pi * (k_a * e / (1 + (k_a * e) ** 2) + math.atan(k_s * e))


@pytest.mark.parametrize(("place", "expected"), TABLE.items())
def test_published_regimes(place: tuple[float, float], expected: list[float]) -> None:
    rate, speed = place
    of = contact(rate)
    found = [
        -of.step(creepage=[c, 0.0], rolling_speed=speed)["creep_force"][0] / LOAD for c in CREEPAGES
    ]
    assert found == pytest.approx(expected, abs=5.1e-6)


def test_damp_knot_is_calibrated() -> None:
    """Sustained 0.05 at 25 microlitres a second (Buckley-Johnstone et al. 2019)."""
    result = contact(25e-9).step(creepage=[0.1, 0.0])
    assert -result["creep_force"][0] / LOAD == pytest.approx(0.05, rel=0.05)
    assert result["effective_friction"] == pytest.approx(0.05)


@pytest.mark.parametrize("creepage", [1e-3, 2e-2])
def test_forces_between_knots(creepage: float) -> None:
    """Shape-preserving over ln(q + q0): beside scipy's."""
    x = np.log(np.array(list(KNOTS)) + 1e-9)
    forces = [polach(knot, creepage, 5.0) for knot in KNOTS.values()]
    curve = PchipInterpolator(x, forces)
    of = contact()
    for rate in (0.0, 1e-10, 1e-9, 7e-9, 25e-9, 26e-9, 1e-7, 6e-7, 1e-6, 1e-3):
        found = -of.step(creepage=[creepage, 0.0], water_rate=rate)["creep_force"][0]
        expected = float(curve(min(math.log(rate + 1e-9), x[-1])))
        assert found == pytest.approx(expected, rel=1e-9), rate


def test_own_knots_are_met() -> None:
    knots = [
        [0.0, 1.0, 0.4, 0.55, 0.4, 0.6],
        [1e-9, 0.8, 0.3, 0.35, 0.5, 0.5],
        [1e-8, 0.4, 0.2, 0.08, 0.9, 0.1],
        [1e-7, 0.3, 0.2, 0.15, 0.8, 0.2],
        [1e-6, 0.3, 0.1, 0.30, 0.4, 0.2],
    ]
    of = contact(0.0, knots=knots)
    for rate, *knot in knots:
        found = -of.step(creepage=[0.02, 0.0], water_rate=rate)["creep_force"][0]
        assert found == pytest.approx(polach(tuple(knot), 0.02, 5.0), rel=1e-9)
    x = np.log(np.array([k[0] for k in knots]) + 1e-9)
    curve = PchipInterpolator(x, [polach(tuple(k[1:]), 0.02, 5.0) for k in knots])
    for rate in np.geomspace(1e-10, 1e-6, 23):
        found = -of.step(water_rate=float(rate))["creep_force"][0]
        assert found == pytest.approx(float(curve(math.log(rate + 1e-9))), rel=1e-9)


def test_recovery_on_the_rail() -> None:
    """F = F_wet exp(-tau W) + F_dry (1 - exp(-tau W))."""
    tau = 2e-3
    of = contact(25e-9, recovery={"coefficient": tau})
    wet, dry = (polach(KNOTS[rate], 0.02, 5.0) for rate in (25e-9, 0.0))
    for work in (0.0, 100.0, 1e3, 1e5):
        left = math.exp(-tau * work)
        found = -of.step(creepage=[0.02, 0.0], rail_work=[0.0, work])["creep_force"][0]
        assert found == pytest.approx(wet * left + dry * (1 - left), rel=1e-9)


def test_friction_of_dry_rails_is_the_cores() -> None:
    """By which pages judge Nadal's limit: at a slip of nothing Polach's law gives mu_0."""
    slow = {"geometry": {"semi_axes": [RADIUS, RADIUS]}, "load": {"normal_force": LOAD}}
    slow |= {"kind": "patch", "motion": {"creepage": [1e-9, 0.0], "rolling_speed": 5.0}}
    slow |= {"fluid": {"model": "regimes", "water_rate": 0.0}}
    slow |= {"method": {"normal": "hertz", "tangential": "polach"}}
    found = railpatch.solve(slow)["effective_friction"]
    assert found == pytest.approx(DRY_FRICTION, rel=1e-6)


def test_recovery_of_a_wheel() -> None:
    """Each metre of its circumference takes the friction's work once a turn; part of the state."""
    fluid = {"model": "regimes", "water_rate": 25e-9, "recovery": {"coefficient": 1e-3}}
    case = with_values(
        WHEELSET,
        friction=None,
        fluid=fluid,
        method={"normal": "hertz", "tangential": "polach"},
        wheelset__z=None,
        wheelset__vertical_force=1.2e5,
        wheelset__speed=10.0,
        wheelset__pitch_rate=-22.4,
        wheelset__time_step=0.5,
    )
    of = railpatch.Contact(case)
    work = rate = 0.0
    for step in range(6):
        result = of.step()
        wheel = result["right"]
        work += 0.5 * rate
        mu = wheel["patches"][0]["effective_friction"]
        # of both first knots at that slip, the friction of the damp one is 0.05
        patch = wheel["patches"][0]
        slip = patch["rolling_speed"] * math.hypot(*patch["creepage"])
        dry = 0.55 * (0.6 * math.exp(-0.6 * slip) + 0.4)
        assert mu == pytest.approx(dry + (0.05 - dry) * math.exp(-1e-3 * work), rel=1e-9), step
        rate = wheel["friction_power"] / (2 * math.pi * wheel["rolling_radius"])
        if step == 2:
            saved, then = of.save(), (work, rate)
    last = result.to_dict()
    of.restore(saved)
    work, rate = then
    for _ in range(3):
        again = of.step().to_dict()
    for key in ("force", "friction_power"):
        assert again[key] == last[key]
    assert mu > 0.06
    of.reset()
    assert of.step()["right"]["patches"][0]["effective_friction"] == pytest.approx(0.05)


def test_refusals() -> None:
    for changes, named in (
        ({"knots": [[0.0, 1, 0.4, 0.5, 0.4, 0.6]] * 2}, "knots"),
        ({"roughness": 1e-6}, "roughness"),
        ({"rail_work": [1.0, 1.0]}, "rail_work"),
    ):
        with pytest.raises(CaseError, match=named):
            contact(0.0, **changes)
