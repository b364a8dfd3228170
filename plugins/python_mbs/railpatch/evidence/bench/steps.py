"""Steps of a batch through the core, with their run times, as arrays."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from railpatch import _core
from railpatch.case.load import load_scene
from railpatch.case.to_core import config_of
from railpatch.evidence.bench.problems import Scales
from railpatch.evidence.bench.sets import AnyBatch
from railpatch.evidence.bench.shapes import Floats

COUNTS = ("normal_iterations", "newton_iterations", "inner_iterations")
ESTIMATES = ("creep_force", "spin_moment", "max_pressure")


@dataclass(frozen=True)
class Steps:
    """Results of n steps over their scales (see ``problems.Scales``); a NaN: not given.

    force: -, [n, 2] over friction coefficient times normal force. moment, pressure, power: -, [n].
    estimate: -, [n, 3], of the errors of force, moment and pressure, the last one relative to
    the pressure itself. counts: [n, 3], of COUNTS.
    """

    good: NDArray[np.bool_]
    force: Floats
    moment: Floats
    pressure: Floats
    power: Floats
    estimate: Floats
    counts: NDArray[np.int64]


def contact_of(batch: AnyBatch, overrides: Mapping[str, Any], elements: int) -> _core.Contact:
    """The core's handle. Raises CaseError where the schema refuses the case."""
    return _core.Contact(config_of(load_scene(batch.case(overrides, elements))), False)


def steps_of(batch: AnyBatch, results: list[dict[str, Any]]) -> Steps:
    """Results of the batch's steps, over its scales."""
    patches = [result["right"]["patches"][0] for result in results]
    unit = batch.scales()
    pressure = np.array([patch["max_pressure"] for patch in patches])
    power = np.array([patch["friction_power"] for patch in patches])
    return Steps(
        good=np.array([patch["status"] == "converged" for patch in patches]),
        force=np.array([patch["creep_force"] for patch in patches]) / unit.force[:, None],
        moment=np.array([patch["spin_moment"] for patch in patches]) / (unit.force * unit.length),
        pressure=pressure / unit.pressure,
        # without rigid slip there is no power, and no scale for it
        power=np.divide(power, unit.power, out=np.zeros_like(power), where=unit.power != 0),
        estimate=estimates(patches, unit, pressure),
        counts=np.array([[patch[name] for name in COUNTS] for patch in patches]),
    )


def estimates(patches: list[dict[str, Any]], unit: Scales, pressure: Floats) -> Floats:
    """Error estimates over the scales: given by name or in the order of ESTIMATES, in N, N m, Pa.

    A result without them has NaN.
    """
    found = np.full((len(patches), len(ESTIMATES)), np.nan)
    for row, patch in zip(found, patches, strict=True):
        given = patch["error_estimate"]
        if isinstance(given, Mapping):
            given = [given[name] for name in ESTIMATES]
        if isinstance(given, (list, tuple)):
            row[:] = [np.nan if value is None else value for value in given]
    return found / np.stack([unit.force, unit.force * unit.length, pressure], axis=1)
