"""Wheels with flats and rails with joints against rigid-body geometry in closed form."""

from __future__ import annotations

import copy
from typing import Any

import numpy as np
import pytest
import railpatch
from case_samples import WHEELSET, with_values
from railpatch.case.longitudinal import flat_runout, joint_height
from railpatch.case.rolling import Flat, Joint

RADIUS = 0.46
DEPTH = 5e-4
EDGE = np.arccos(1 - DEPTH / RADIUS)  # rad, half the angle of the flat


def one_wheel(**values: Any) -> dict[str, Any]:
    case = with_values(
        copy.deepcopy(WHEELSET),
        **{
            "method__tangential": "none",
            "friction": None,
            "grid__element_size": [5e-4, 5e-4],
            **values,
        },
    )
    case["kind"] = "wheel_rail"
    return case


def heights(case: dict[str, Any], steps: list[dict[str, float]]) -> np.ndarray:
    """m, the wheelset's z at which wheel and rail begin to touch, within 1e-8 m."""
    contact = railpatch.Contact(case)

    def onset(step: dict[str, float]) -> float:
        apart, touching = -1e-3, 3e-3
        while touching - apart > 1e-8:
            z = 0.5 * (apart + touching)
            if contact.step(z=z, **step)["status"] == "no_contact":
                apart = z
            else:
                touching = z
        return touching

    return np.array([onset(step) for step in steps])


def test_depth_of_a_flat_is_recovered() -> None:
    """Wheel centre over the middle of the flat: lower by its depth."""
    flat = {"depth": DEPTH, "angle": 0.3}
    z = heights(one_wheel(wheelset__right={"flat": flat}), [{"pitch": 0.3}, {"pitch": 1.5}])
    assert z[0] - z[1] == pytest.approx(DEPTH, abs=2e-7)


def test_a_rigid_wheel_turns_over_the_end_of_its_flat() -> None:
    """On the end of the chord the centre lies R cos(edge - |pitch|) above the rail; the rounded end
    takes away at most b/4, b as in flat_runout."""
    rounding = 2e-3
    pitches = np.concatenate([np.linspace(0.1, 1.0, 6), -np.linspace(0.05, 0.95, 6)]) * EDGE
    case = one_wheel(wheelset__right={"flat": {"depth": DEPTH, "rounding": rounding}})
    z = heights(case, [{"pitch": float(p)} for p in [1.0, *pitches]])
    drop = z[1:] - z[0]
    sharp = RADIUS * (1 - np.cos(EDGE - np.abs(pitches)))
    assert np.all(drop > sharp - 2e-7)
    assert np.all(drop < sharp + np.tan(EDGE) * rounding / 8 + 2e-7)
    # exactly: the lowest point of the wheel as it is drawn
    a = np.linspace(-0.1, 0.1, 400_001)
    drawn = [
        RADIUS - ((RADIUS + flat_runout(RADIUS, Flat(depth=DEPTH, rounding=rounding), p - a))
                  * np.cos(a)).max()
        for p in pitches
    ]  # fmt: skip
    # splines through points half a millimetre apart hardly cut the rounded ends
    assert drop == pytest.approx(np.array(drawn), abs=3e-7)


def test_length_of_a_flat() -> None:
    angles = np.linspace(-0.1, 0.1, 20001)
    runout = flat_runout(RADIUS, Flat(depth=DEPTH, rounding=5e-4), angles)
    touched = angles[runout < 0]
    length = 2 * np.sqrt(2 * RADIUS * DEPTH)
    assert RADIUS * np.ptp(touched) == pytest.approx(length, abs=6e-4)
    assert runout.min() == pytest.approx(-DEPTH, rel=1e-9)


def test_a_wheel_follows_a_long_dip() -> None:
    """A cosine dip with curvature far below the wheel's: the centre goes down as the rail does,
    and by slope^2 R/2 less, since the contact lies up the slope (parallel curve, second order)."""
    x = np.linspace(-1, 1, 401)
    wave = 5e-4 * (1 + np.cos(np.pi * x))
    surface = [[float(a), float(-b)] for a, b in zip(x, wave, strict=True)]
    case = one_wheel(track__right={"running_surface": surface})
    at = np.array([-0.75, -0.5, -0.2, 0.0, 0.4])
    z = heights(case, [{"x": float(p)} for p in [5.0, *at]])
    slope = -5e-4 * np.pi * np.sin(np.pi * at)
    expected = 5e-4 * (1 + np.cos(np.pi * at)) - 0.5 * RADIUS * slope**2
    assert z[1:] - z[0] == pytest.approx(expected, abs=3e-7)


def test_a_wheel_falls_into_a_gap() -> None:
    """Over the middle of a gap between sharp ends: by gap^2/(8 R), and by the rounding's part."""
    gap = 0.012
    joint = {"position": 2.0, "gap": gap, "rounding": 1e-3}
    z = heights(one_wheel(track__right={"joint": joint}), [{"x": 0.0}, {"x": 2.0}])
    low, high = gap**2 / (8 * RADIUS), (gap + 1e-3) ** 2 / (8 * RADIUS)
    assert low - 2e-7 < z[1] - z[0] < high + 2e-7


def test_heights_of_a_joint() -> None:
    joint = Joint(position=1.0, depth=2e-3, length=0.4, step=5e-4, rounding=4e-3)
    x = np.array([0.0, 0.9, 1.0, 1.1, 3.0])
    # the kink of the parabolas is rounded over r = 2 mm: |x| becomes r/2 there
    hang = np.array([0.0, 0.5, 1 - 2 * 1e-3 / 0.4, 0.5, 0.0])
    expected = -2e-3 * hang**2 + 5e-4 * np.array([0, 0, 0.5, 1, 1])
    assert joint_height(joint, x) == pytest.approx(expected, abs=1e-15)


def test_forces_are_continuous_over_a_flat() -> None:
    """No jump above 0.2 % of the load per micrometre of rolling beyond what the slope explains: at
    a fixed height, steps of 2 um where contact comes to, is on and leaves the ends."""
    case = one_wheel(
        wheelset__z=4e-4,
        wheelset__right={"flat": {"depth": DEPTH, "rounding": 5e-3}},
        grid__element_size=[1e-3, 1e-3],
    )
    contact = railpatch.Contact(case)
    load = contact.step(pitch=1.0)["force"][2]
    for start in (-2.0 * EDGE, -EDGE, -0.35 * EDGE, -1e-5, 0.4 * EDGE, EDGE, 1.6 * EDGE):
        pitches = start + 2e-6 / RADIUS * np.arange(40)
        force = np.array([contact.step(pitch=float(p))["force"][2] for p in pitches])
        jump = np.abs(np.diff(force, 2)).max()
        assert jump < 2 * 0.002 * abs(load), f"from {start}: {jump / load}"
