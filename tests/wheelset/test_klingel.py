"""Kinematic wave length of coned wheelsets against Klingel (1883): 2 pi sqrt(r0 e0 / conicity).

The theory: both wheels roll without slip on rails that they touch at fixed points, e0 from the
centre line. With the lateral position y of the treads, one radius below the axle,

    y' = yaw,   yaw' = -conicity y / (r0 e0)   per metre of track.

What departs from it here, with cones of inclination g on crowns of radius R: the wheelset rolls by
the angle g y / e0, which turns the contact points on the crowns by R g y / e0 outwards, so that the
conicity is g (1 + R g / e0). r0 is the rolling radius where the cones touch, not the nominal one.
Creep is some 1e-5 and works against gravity's stiffness, W g / e0: that damps by 1e-4 a radian and
shifts the wave length by the square of it. Inertia, m omega^2 against the creep stiffness
f omega / V, is 1e-3, and shifts the wave length by its square too.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import wheelset_scenes as scenes

from wheelset_demo.simulation import simulate
from wheelset_demo.summary import summarise


def klingel(radius: float, half_distance: float, conicity: float) -> float:
    """m."""
    return 2 * np.pi * np.sqrt(radius * half_distance / conicity)


CASES = {
    # cone, crown radius (m), speed (m/s), distance (m), step (s)
    "narrow crown": (1 / 40, 0.05, 5.0, 31.0, 5e-3),
    "narrow crown, steep cone": (1 / 20, 0.05, 5.0, 22.0, 5e-3),
    "rail head": (1 / 20, 0.3, 5.0, 22.0, 5e-3),
}


@pytest.mark.parametrize("name", CASES)
def test_wave_length(name: str, tmp_path: Path, measured):
    cone, crown, speed, distance, step = CASES[name]
    profiles = {"wheel": f"cone@1:{1 / cone:.0f}", "rail": f"arc@{crown}"}
    run = {"speed": speed, "distance": distance, "step": step, "y": 0.5e-3}
    scene = scenes.scene(tmp_path, "cone.toml", **profiles, **run)
    waves = summarise(simulate(scene)).waves
    assert waves.count >= 2
    radius, half = waves.radius, waves.half_distance
    plain = klingel(radius, half, cone)
    turned = klingel(radius, half, cone * (1 + crown * cone / half))
    measured(
        f"wave length, {name}: {waves.length:.4f} m, r0 {radius:.4f} m, e0 {half:.4f} m; "
        f"Klingel {plain:.4f} m ({100 * (waves.length / plain - 1):+.3f} %), with the "
        f"contact's shift {turned:.4f} m ({100 * (waves.length / turned - 1):+.3f} %)"
    )
    assert waves.length == pytest.approx(plain, rel=0.02)
    assert waves.length == pytest.approx(turned, rel=0.0005)
    # and the conicity that the run itself shows
    assert waves.conicity == pytest.approx(cone * (1 + crown * cone / half), rel=0.003)
    # nearly free: the wave neither grows nor dies
    assert waves.last == pytest.approx(waves.first, rel=0.05)
