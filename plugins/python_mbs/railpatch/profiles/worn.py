"""Worn wheels and rails by formula: S1002 and UIC60 at 1:40 with wear and plastic flow, numbered.

Each number is one shape: what is worn off or flows is a sum of smooth bumps along the profile's arc
length, whose depths, places and widths are drawn from the ranges below. Widths and places are as
wide as wear is usually drawn in textbooks; they are assumed, as are the depths but for the limits
named: a flange may lose some 6 mm before the thickness of EN 15313 is reached, hollow treads of 2
to 4 mm are taken out of service, and the heads of rails lose up to 10 mm. Waves of some
micrometres stand for what running leaves of the arcs: they make contacts with several places at
once. Curvature keeps the steps of the profile below and gets none beside them.
"""

from __future__ import annotations

import random
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from railpatch.profiles.curve import Profile
from railpatch.profiles.elementary import cos, hypot, sin

Array = NDArray[np.float64]
NUMBERS = 1_000_000  # of shapes
WAVES = 4
# m, wave lengths, and greatest amplitude of each wave
WAVE_LENGTHS, WAVE_HEIGHT = (6e-3, 30e-3), 8e-6


@dataclass(frozen=True)
class Bump:
    """Ranges of one bump: lateral position of its middle on the new profile, m; from its
    middle to its end, m; depth, m; direction: lateral and vertical parts, z down."""

    name: str
    place: tuple[float, float]
    width: tuple[float, float]
    depth: tuple[float, float]
    direction: tuple[float, float]


# material of a wheel lies above its surface, of a rail below
WHEEL = (
    Bump("hollow tread", (-8e-3, 10e-3), (20e-3, 45e-3), (0.0, 2e-3), (0.0, -1.0)),
    Bump("flange root", (-30e-3, -20e-3), (9e-3, 20e-3), (0.0, 0.8e-3), (-0.3, -0.7)),
    Bump("flange face", (-41e-3, -38e-3), (14e-3, 24e-3), (0.0, 3e-3), (-1.0, 0.0)),
    Bump("flow to the field side", (28e-3, 45e-3), (10e-3, 18e-3), (0.0, 0.4e-3), (0.0, 1.0)),
)
RAIL = (
    Bump("flattened head", (-15e-3, 2e-3), (18e-3, 36e-3), (0.0, 1.5e-3), (0.0, 1.0)),
    Bump("gauge corner", (-38e-3, -30e-3), (10e-3, 18e-3), (0.0, 1.2e-3), (0.6, 0.8)),
    Bump("gauge face", (-43.2e-3, -42e-3), (12e-3, 22e-3), (0.0, 2e-3), (1.0, 0.0)),
    Bump("flow to the field side", (18e-3, 25e-3), (8e-3, 14e-3), (0.0, 0.3e-3), (0.3, -0.3)),
)


def worn(base: Profile, bumps: tuple[Bump, ...], number: int) -> Profile:
    """The profile with the wear of that number (0 ... NUMBERS - 1)."""
    wear = Wear(base, bumps, number)
    s, h = base.arc_length, np.diff(base.arc_length)
    (my, mz), (ry, rz) = wear.at(s)
    dy, dz = base.dy + ry, base.dz + rz
    # arc length of the worn curve by Simpson's rule, with the slopes in the middle of each cubic
    ry, rz = wear.at(0.5 * (s[1:] + s[:-1]))[1]
    middle_y = 1.5 * np.diff(base.y) / h - 0.25 * (base.dy[1:] + base.dy[:-1]) + ry
    middle_z = 1.5 * np.diff(base.z) / h - 0.25 * (base.dz[1:] + base.dz[:-1]) + rz
    speed = hypot(dy, dz)
    step = h / 6 * (speed[1:] + 4 * hypot(middle_y, middle_z) + speed[:-1])
    length = np.concatenate([[0.0], np.cumsum(step)])
    return Profile(base.name, length, base.y + my, base.z + mz, dy / speed, dz / speed)


class Wear:
    """Displacement of a profile's points by arc length, drawn by a number."""

    def __init__(self, base: Profile, bumps: tuple[Bump, ...], number: int) -> None:
        draw = random.Random(number)  # the same on every computer
        self.bumps = [
            (
                arc_length_at(base, draw.uniform(*bump.place)),
                draw.uniform(*bump.width),
                draw.uniform(*bump.depth),
                bump.direction,
            )
            for bump in bumps
        ]
        self.waves = [
            (
                draw.uniform(0.0, WAVE_HEIGHT),
                2 * np.pi / draw.uniform(*WAVE_LENGTHS),
                draw.uniform(0.0, 2 * np.pi),
            )
            for _ in range(WAVES)
        ]

    def at(self, s: Array) -> tuple[Array, Array]:
        """Lateral and vertical displacement, m, and their rates by arc length: [2, n] each."""
        moved, rate = np.zeros((2, s.size)), np.zeros((2, s.size))
        for place, width, depth, direction in self.bumps:
            # cos^4 has three continuous derivatives where it ends
            t = 0.5 * np.pi * np.clip((s - place) / width, -1.0, 1.0)
            fall = cos(t)
            change = -2.0 * np.pi / width * sin(t) * fall * fall * fall
            for k in range(2):
                moved[k] += depth * direction[k] * (fall * fall) * (fall * fall)
                rate[k] += depth * direction[k] * change
        for height, number, phase in self.waves:
            moved[1] += height * sin(number * s + phase)
            rate[1] += height * number * cos(number * s + phase)
        return moved, rate


def arc_length_at(profile: Profile, y: float) -> float:
    """Where the profile first passes a lateral position, m."""
    after = int(np.argmax(profile.y >= y))
    before = max(after - 1, 0)
    rise = profile.y[after] - profile.y[before]
    share = (y - profile.y[before]) / rise if rise > 0 else 0.0
    arc_length = profile.arc_length
    return float(arc_length[before] + share * (arc_length[after] - arc_length[before]))
