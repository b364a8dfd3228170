"""Sensitivities of a sweep's outputs, by SALib."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from railpatch.sweep.plan import LEVELS, Plan


def indices_of(plan: Plan, values: NDArray[np.float64]) -> list[tuple[Any, ...]]:
    """Of an output, [cases]: (key, mu*, its 95 % interval, sigma) of the design morris; (key, first
    index, interval, total index, interval) of saltelli. The keys are taken over their ranges from 0
    to 1. Intervals are bootstrapped with the sweep's seed.
    """
    from SALib.analyze import morris, sobol

    if np.ptp(values) == 0:
        return [(key, *[0.0] * (3 if plan.table.design == "morris" else 4)) for key in plan.keys]
    if plan.table.design == "morris":
        found = morris.analyze(
            plan.problem(), plan.unit_points(), values, num_levels=LEVELS, seed=1 + plan.table.seed
        )
        return list(
            zip(
                plan.keys,
                *map(_numbers, (found["mu_star"], found["mu_star_conf"], found["sigma"])),
                strict=True,
            )
        )
    found = sobol.analyze(plan.problem(), values, calc_second_order=False, seed=1 + plan.table.seed)
    return list(
        zip(
            plan.keys,
            *map(_numbers, (found["S1"], found["S1_conf"], found["ST"], found["ST_conf"])),
            strict=True,
        )
    )


def _numbers(values: Any) -> list[float]:
    return [float(value) for value in np.asarray(values)]
