"""Wear over the profiles of wheel and rail along a run."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from railpatch.case.types import BODIES, show
from railpatch.errors import CaseError

Array = NDArray[np.float64]
LOW, HIGH, BINS = -0.2, 0.2, 1600  # m, of a profile's y
ROUNDED = 1e-9  # of shares


class Distribution:
    """Mass that wears off, by y of each profile: sums of rows times the way rolled.

    wheel, rail: kg/m, [BINS], mass by width of the wheel's profile; of the rail the mass is that
    of the whole way. outside: kg, beyond the bins. y: m, [BINS], middles.
    """

    def __init__(self) -> None:
        self.edges = np.linspace(LOW, HIGH, BINS + 1)
        self.y = 0.5 * (self.edges[1:] + self.edges[:-1])
        self.wheel, self.rail = np.zeros(BINS), np.zeros(BINS)
        self.outside = {"wheel": 0.0, "rail": 0.0}
        self.way = 0.0

    def add(self, rows: dict[str, Array], way: float, share: float = 1.0) -> None:
        """Rows of a patch (railpatch.damage.patch) over a way (m), with its share in the wheel.
        Raises CaseError for those of a patch given by itself, and a way or share that is none."""
        check_number("way", way, 0 <= way < math.inf, ">= 0 and finite")
        check_number("share", share, 0 <= share <= 1 + ROUNDED, "0 to 1")
        for body in BODIES:
            if body not in rows:
                raise CaseError(["rows: of a patch without profiles, allowed those of a wheel"])
            place = rows[body]
            if not place.size:
                continue
            order = np.argsort(place)
            place, mass = place[order], (rows["wear"] * rows["height"])[order] * way * share
            half = 0.5 * abs(place[-1] - place[0]) / max(len(place) - 1, 1)
            edges = np.append(place - half, place[-1] + half)
            whole = np.concatenate([[0.0], np.cumsum(mass)])
            inside = np.diff(np.interp(self.edges, edges, whole))
            target = self.wheel if body == "wheel" else self.rail
            target += inside / (self.edges[1] - self.edges[0])
            self.outside[body] += float(mass.sum() - inside.sum())

    def merge(self, other: Distribution) -> None:
        """Adds the sums of another one."""
        self.wheel += other.wheel
        self.rail += other.rail
        for body, mass in other.outside.items():
            self.outside[body] += mass

    def depth(self, body: str, density: float, length: float) -> Array:
        """m, [BINS], that has worn off, measured across y. density: kg/m^3. length: m, over which
        the mass is spread: round the wheel, or along the rail. Raises CaseError."""
        check_number("density", density, 0 < density < math.inf, "> 0 and finite")
        check_number("length", length, 0 < length < math.inf, "> 0 and finite")
        return self._of(body) / (density * length)

    def mass(self, body: str) -> float:
        """kg, all of it. Raises CaseError."""
        mass = self._of(body)
        return float(mass.sum() * (self.edges[1] - self.edges[0])) + self.outside[body]

    def _of(self, body: str) -> Array:
        if body not in BODIES:
            raise CaseError([f"body: value is {show(body)}, allowed 'wheel', 'rail'"])
        return self.wheel if body == "wheel" else self.rail


def check_number(name: str, value: float, good: bool, allowed: str) -> None:
    """Raises CaseError where it is not good."""
    if not good:
        raise CaseError([f"{name}: value is {show(value)}, allowed {allowed}"])


def summed(numbers: list[tuple[float, dict[str, Any]]]) -> dict[str, float | None]:
    """Of a wheel's patches by share: sums of rates, the greatest of indices, None where none is
    known."""
    found: dict[str, float | None] = {}
    for name in ("wear_rate", "whole_life_damage"):
        found[name] = math.fsum(share * values[name] for share, values in numbers)
    for name in ("wheel_depth_rate", "rail_depth", "fatigue_index", "stress_index"):
        known = [values[name] for _, values in numbers if values[name] is not None]
        found[name] = max(known, default=None)
    return found
