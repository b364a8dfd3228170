"""Laws of friction and yield, straight from a checked case; shares nothing with the solver."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from railpatch.case.common import Layer
from railpatch.case.friction import Friction
from railpatch.evidence.stress.half_space import Array

LEAST_YIELD = 0.1  # of the initial yield stress, below which a softening layer does not go

# by the speed over that which halves a term, and how steeply each falls at rest
SHAPES: dict[str, Callable[[Array], Array]] = {
    "exponential": lambda u: np.exp2(-u),
    "polach": lambda u: np.exp2(-u),  # from other numbers
    "rational": lambda u: 1 / (1 + u),
    "linear": lambda u: np.maximum(0, 1 - u / 2),
}
STEEPEST = {"exponential": np.log(2.0), "polach": np.log(2.0), "rational": 1.0, "linear": 0.5}


def by_speed(friction: Friction, speed: Array) -> Array:
    """-, coefficient of friction at a speed of micro-slip (m/s), without memory and factor."""
    if friction.law == "coulomb":
        return np.full_like(speed, friction.greatest)
    value = np.full_like(speed, friction.kinetic_coefficient)
    for amplitude, halving in zip(*friction.terms, strict=True):
        u = speed / halving
        value += amplitude * SHAPES[friction.shape](u)
    return value


def steepest_fall(friction: Friction) -> float:
    """s/m, of the coefficient with the speed of micro-slip: of each term at rest, without
    memory."""
    slope = STEEPEST[friction.shape]
    terms = zip(*friction.terms, strict=True)
    return sum(slope * max(amplitude, 0.0) / halving for amplitude, halving in terms)


def steepest_softening(layer: Layer) -> float:
    """Pa/m, of the yield stress with plastic displacement."""
    if layer.hardening_table is None:
        return max(-(layer.hardening or 0.0), 0.0)
    places, values = np.array(layer.hardening_table).T
    return float(max(0.0, *(-np.diff(values) / np.diff(places))))


def by_temperature(friction: Friction, temperature: Array) -> Array:
    """-, at a surface temperature (degrees C): straight over the range (report, eq. 19)."""
    assert friction.reference is not None
    assert friction.change is not None
    assert friction.reference_temperature is not None
    assert friction.temperature_range is not None
    above = (temperature - friction.reference_temperature) / friction.temperature_range
    return friction.reference + friction.change * np.clip(above, 0, 1)


def range_of(friction: Friction) -> tuple[float, float]:
    """-, least and greatest coefficient that the law gives, without factor."""
    if friction.law == "coulomb":
        return friction.greatest, friction.greatest
    if friction.law == "temperature":
        assert friction.reference is not None
        assert friction.change is not None
        ends = (friction.reference, friction.reference + friction.change)
        return min(ends), max(ends)
    amplitudes = friction.terms[0]
    kinetic = friction.kinetic_coefficient
    return kinetic + sum(min(a, 0.0) for a in amplitudes), friction.greatest


def factors(friction: Friction, y: Array) -> Array:
    """-, [ny], factor of the law over the lateral position of a patch."""
    if friction.factor is None:
        return np.ones_like(y)
    places, values = np.array(friction.factor).T
    return np.interp(y, places, values)


def yield_stress(layer: Layer, displacement: Array) -> Array:
    """Pa, over the accumulated plastic displacement (m)."""
    if layer.hardening_table is not None:
        places, values = np.array(layer.hardening_table).T
        return np.interp(displacement, places, values)
    assert layer.yield_stress is not None
    straight = layer.yield_stress + (layer.hardening or 0.0) * displacement
    return np.maximum(straight, LEAST_YIELD * layer.yield_stress)
