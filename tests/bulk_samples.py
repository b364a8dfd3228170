"""Two bodies of steel that friction and each other warm and the air cools: solved another way."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import expm

HEAT_CAPACITY = 450.0  # J/(kg K), that of cases which give none


def exchange_of(wheel: Mapping[str, Any]) -> float:
    """W/K, what a contact lets through by the difference of bulk temperatures: that part of the
    wheel's heat that is not half of friction's, bodies being alike."""
    gap = wheel["rail_temperature"] - wheel["wheel_temperature"]
    return float((wheel["wheel_heat"] - 0.5 * wheel["friction_power"]) / gap)


def lumped(
    bulk: Mapping[str, Any], wheel: Mapping[str, Any], time: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Temperatures [2], degrees C, and heat that the air took [2], J, after a time (s) of constant
    friction and exchange.

    bulk: a table [temperature.bulk]. wheel: results at the beginning. By the matrix exponential of
    both bodies' linear equations, with the air's part as two more unknowns.
    """
    capacity = np.array(bulk["mass"]) * HEAT_CAPACITY
    air, cold = np.array(bulk["air_conductance"]), bulk.get("air_temperature", 0.0)
    g, friction = exchange_of(wheel), 0.5 * wheel["friction_power"]
    system = np.zeros((5, 5))
    system[:2, :2] = (g * np.array([[-1.0, 1.0], [1.0, -1.0]]) - np.diag(air)) / capacity[:, None]
    system[:2, 4] = (friction + air * cold) / capacity
    system[2:4, :2], system[2:4, 4] = np.diag(air), -air * cold
    start = [wheel["wheel_temperature"], wheel["rail_temperature"], 0.0, 0.0, 1.0]
    end = expm(system * time) @ start
    return end[:2], end[2:4]
