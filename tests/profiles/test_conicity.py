"""Equivalent conicity against closed forms and the motion integrated over time.

Cubic difference dr = k y^3: S = k y^4 / 4, so that I = 4 K / (A sqrt(k)) with the lemniscate's
quarter K, the integral of du / sqrt(1 - u^4) from 0 to 1, and tan(gamma) = (pi A / (4 K))^2 k.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from railpatch.profiles.pairing.conicity import equivalent_conicity
from railpatch.profiles.pairing.contact_points import ContactPoints, contact_points, positions
from scipy.integrate import solve_ivp

LEMNISCATE = 1.3110287771460599


def time_integrated(points: ContactPoints, amplitude: float, distance: float) -> float:
    """tan(gamma) by Klingel (1883) from the wave length of y' = yaw, yaw' = -dr / (e r0)."""
    radius = points.dimensions.nominal_radius
    difference = points.rolling_radius_difference

    def rates(_x: float, state: np.ndarray) -> list[float]:
        return [state[1], -np.interp(state[0], points.y, difference) / (distance * radius)]

    def turning(_x: float, state: np.ndarray) -> float:
        return state[1]

    # at the start yaw falls from 0; it rises through 0 half a wave later
    turning.terminal, turning.direction = True, 1
    run = solve_ivp(
        rates, (0, 200), [amplitude, 0], events=turning, rtol=1e-10, atol=1e-13, max_step=0.02
    )
    length = 2 * run.t_events[0][0]
    return 2 * math.pi**2 * distance * radius / length**2


@pytest.mark.parametrize("amplitude", [1e-4, 3e-3, 9e-3])
@pytest.mark.parametrize("centre", [0.0, 8e-4])
def test_a_linear_difference_is_its_cone(amplitude: float, centre: float) -> None:
    y = np.linspace(-0.01, 0.01, 201)
    found = equivalent_conicity(y, 2 * 0.05 * (y - centre), amplitude)
    assert found == pytest.approx(0.05, rel=1e-9)
    # sign: the opposite difference; side: the track seen from its other end
    assert equivalent_conicity(y, -2 * 0.05 * (y - centre), amplitude) == -found
    mirrored = equivalent_conicity(y, 2 * 0.05 * (y + centre), amplitude)
    assert mirrored == pytest.approx(found, rel=1e-12)


@pytest.mark.parametrize("amplitude", [1e-3, 4e-3])
def test_a_cubic_difference(amplitude: float) -> None:
    y = np.linspace(-0.005, 0.005, 20_001)
    found = equivalent_conicity(y, 2e3 * y**3, amplitude)
    exact = (math.pi * amplitude / (4 * LEMNISCATE)) ** 2 * 2e3
    assert found == pytest.approx(exact, rel=1e-6)


@pytest.mark.parametrize(
    ("wheel", "rail"),
    [("cone@1:20", "UIC60@1:40"), ("cone@1:40", "UIC60"), ("cone@1:10", "arc@0.3")],
)
def test_a_cone_on_any_rail(wheel: str, rail: str) -> None:
    points = contact_points(wheel, rail, positions(5e-3, 5e-4))
    cone = 1 / float(wheel.split(":")[1])
    for amplitude in (1e-3, 3e-3, 4.5e-3):
        assert points.conicity(amplitude) == pytest.approx(cone, rel=1e-9)


def test_a_cylinder_has_none() -> None:
    assert contact_points("cylinder", "arc@0.3", positions(5e-3, 1e-3)).conicity(3e-3) == 0.0


def test_s1002_on_uic60_is_the_motion_integrated_over_time() -> None:
    points = contact_points("S1002", "UIC60@1:40")
    for amplitude in (1e-3, 3e-3, 6e-3):
        # neither the distance of the contacts nor the radius matters
        for distance in (1.5, 1.1):
            value = time_integrated(points, amplitude, distance)
            assert points.conicity(amplitude) == pytest.approx(value, rel=2e-5)
    # nor the sampling
    finer = contact_points("S1002", "UIC60@1:40", positions(5e-3, 2e-5))
    assert finer.conicity(3e-3) == pytest.approx(points.conicity(3e-3), rel=1e-3)


def test_no_wave_gives_nan() -> None:
    y = np.linspace(-0.005, 0.005, 101)
    assert math.isnan(equivalent_conicity(y, y, 6e-3))  # beyond the samples
    assert math.isnan(equivalent_conicity(y, np.full(101, 1e-3), 1e-3))  # no equilibrium
    # driven away from the middle, back further out
    assert math.isnan(equivalent_conicity(y, 100 * y**3 - 1e-4 * y, 1.1e-3))


def test_wrong_samples_are_refused() -> None:
    y = np.linspace(-1e-3, 1e-3, 11)
    for values in ((y, y[1:]), (y[::-1], y), (y, y * np.nan)):
        with pytest.raises(ValueError, match="rolling_radius_difference"):
            equivalent_conicity(*values, 1e-4)
    with pytest.raises(ValueError, match="amplitude is 0, allowed > 0 m"):
        equivalent_conicity(y, y, 0)
