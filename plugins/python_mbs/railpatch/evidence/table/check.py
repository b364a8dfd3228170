"""The error of a table, from random cases that the full theory solves on finer grids."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np

from railpatch.evidence.table.recipe import Recipe
from railpatch.evidence.table.solves import (
    Accurate,
    contact_on,
    forces_of,
    input_of,
    scales_of,
    slopes,
)

SAMPLE_PART = 40
FINER = 1.4  # nodes and rows of the check's grids over those of the table's
SEED = 20
MEDIAN_TO_WORST = (50, 95, 100)


def sample_parts(recipe: Recipe) -> int:
    """Number of parts that the sample comes in."""
    return -(-recipe.sample // SAMPLE_PART)


def sample_part(recipe: Recipe, part: int) -> np.ndarray:
    """Cases of one a/b and Poisson's ratio: [case, (a/b, nu, w, F)].

    Creepages up to 12 times and spin up to 2.5 times the saturation of the linear theory, a quarter
    of the cases without spin; half of the parts of steel.
    """
    rng = np.random.default_rng([SEED, part])
    ratio = np.exp(rng.uniform(np.log(recipe.lowest_ratio), np.log(recipe.highest_ratio)))
    poisson = recipe.poisson_ratio[1] if part % 2 == 0 else rng.uniform(0.0, 0.5)
    slope = slopes(recipe, ratio, poisson)
    scale, slope = scales_of(recipe, slope), -slope
    solve = Accurate(recipe, ratio, poisson, FINER)
    cases = np.zeros((SAMPLE_PART, 8))
    for case in cases:
        size = np.exp(rng.uniform(np.log(0.1), np.log(12.0)))
        angle = rng.uniform(-np.pi, np.pi)
        spin = 0.0 if rng.uniform() < 0.25 else rng.uniform(-2.5, 2.5)
        w = np.array(
            [
                size * np.cos(angle) / slope[0, 0],
                size * np.sin(angle) / slope[1, 1],
                spin / slope[1, 2],
            ]
        )
        solve.reset()
        case[:] = [ratio, poisson, *w, *solve(w, scale * w)]
    return cases


class Interpolated:
    """Creep forces of one a/b and Poisson's ratio from a table."""

    def __init__(self, table: np.ndarray, ratio: float, poisson: float) -> None:
        self._contact = contact_on(ratio, poisson, tangential="table", creep_table=table)

    def __call__(self, w: np.ndarray, direction: int = 1) -> np.ndarray:
        """(Fx, Fy, Mz/c)/B at w."""
        return forces_of(self._contact.step(input_of(w, direction)))


def errors(table: bytes, sample: np.ndarray) -> np.ndarray:
    """Of force over mu Fn and of moment over c mu Fn, [case, 2]."""
    data = np.frombuffer(table, np.uint8)
    found = np.zeros((len(sample), 2))
    contact, last = None, None
    for row, error in zip(sample, found, strict=True):
        if contact is None or last != (row[0], row[1]):
            last = row[0], row[1]
            contact = Interpolated(data, *last)
        difference = contact(row[2:5]) - row[5:]
        error[:] = np.hypot(difference[0], difference[1]), abs(difference[2])
    return found


def summary(sample: np.ndarray, error: np.ndarray) -> dict[str, Any]:
    """Median, 95th percentile and worst error of force and moment, by a/b and of steel."""
    ratio, steel = sample[:, 0], sample[:, 1] == 0.28
    edges = [0.1, 0.2, 0.5, 2.0, 5.0, 10.0]
    groups = {"all": ratio > 0, "steel": steel}
    for low, high in pairwise(edges):
        groups[f"a/b {low:g} ... {high:g}"] = (ratio >= low) & (ratio < high)
    groups["a/b 0.2 ... 5, steel"] = steel & (ratio >= 0.2) & (ratio < 5.0)
    return {
        name: {
            "cases": int(chosen.sum()),
            "force": np.percentile(error[chosen, 0], MEDIAN_TO_WORST).round(6).tolist(),
            "moment": np.percentile(error[chosen, 1], MEDIAN_TO_WORST).round(6).tolist(),
        }
        for name, chosen in groups.items()
        if chosen.any()
    }
