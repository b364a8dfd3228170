"""Scenes of the vehicle that the tests of vehicle/ share."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from wheelset_demo.vehicle import Simulation, VehicleScene, load_vehicle_scene
from wheelset_demo.vehicle.alignment import AlignmentTable

# quick, and with creep forces that have no steps of a grid
QUICK = {"normal": "hertz", "tangential": "polach"}


def scene(
    *,
    speed: float | None = None,
    alignment: dict[str, Any] | None = None,
    irregular: bool = False,
    method: dict[str, Any] | None = None,
    **run: Any,
) -> VehicleScene:
    """The packaged one with some changes; on straight and level track where nothing is said."""
    given = load_vehicle_scene().with_run(**run).with_method(**(method or QUICK))
    if speed is not None:
        wheelset = given.case.wheelset.model_copy(update={"speed": speed})
        given = replace(given, case=given.case.model_copy(update={"wheelset": wheelset}))
    table = AlignmentTable(**(alignment or {}))
    return replace(given, alignment=table, irregularity=given.irregularity if irregular else None)


def finished(given: VehicleScene) -> Simulation:
    """After its last step."""
    simulation = Simulation(given)
    for _ in simulation.steps():
        pass
    return simulation


def shaken(simulation: Simulation, seed: int) -> np.ndarray:
    """[size], values near the start: bodies some centimetres and hundredths off."""
    rng = np.random.default_rng(seed)
    values = simulation.state.values.copy()
    count = simulation.system.count
    values[: 2 * count] += 0.02 * rng.standard_normal(2 * count)
    values[2 * count :] = 1e3 * rng.standard_normal(len(values) - 2 * count)
    return values
