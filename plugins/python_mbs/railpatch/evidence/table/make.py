"""Solves the nodes of a table part by part and puts the parts together."""

from __future__ import annotations

import os
from collections.abc import Callable
from concurrent.futures import Executor, ProcessPoolExecutor, as_completed
from pathlib import Path
from typing import Any

import numpy as np

from railpatch import _core
from railpatch.evidence.table.blob import pack
from railpatch.evidence.table.check import errors, sample_part, sample_parts, summary
from railpatch.evidence.table.recipe import MIRROR, Recipe, spin_rules
from railpatch.evidence.table.solves import Accurate, scales_of, sliding, slopes
from railpatch.evidence.table.spline import coefficients


def slope_part(recipe: Recipe, i: int) -> np.ndarray:
    """Slopes at zero creepage [poisson, 3, 3] of an a/b."""
    ratio = recipe.axis_ratios[i]
    return np.array([slopes(recipe, ratio, poisson) for poisson in recipe.poisson_ratio])


def forces_at(solves: list[Accurate], v: np.ndarray, scale: np.ndarray) -> np.ndarray:
    """Forces [poisson, 3] at v."""
    steel = solves[1](v / scale[1], v)
    if spin_rules(v):
        return np.array([solves[0](v / scale[0], v), steel, solves[2](v / scale[2], v)])
    coarse = np.array([solve.coarse(v / s) for solve, s in zip(solves, scale, strict=True)])
    return steel + coarse - coarse[1]


def force_part(recipe: Recipe, i: int, j: int, slope: np.ndarray) -> np.ndarray:
    """Forces [poisson, theta, t, 3] of an a/b and a share of spin.

    Steel is solved as accurately as the recipe asks for; for the other Poisson's ratios the coarser
    grid tells the difference, but where spin rules.
    """
    ratio = recipe.axis_ratios[i]
    scale = scales_of(recipe, slope)
    solves = [Accurate(recipe, ratio, poisson) for poisson in recipe.poisson_ratio]
    found = np.zeros((3, recipe.theta + 1, recipe.t + 1, 3))
    for k in range(recipe.theta + 1):
        # pure spin has one direction; without spin one half is the mirror image of the other
        if j == recipe.psi and k > 0:
            found[:, k] = found[:, 0]
            continue
        if j == 0 and k > recipe.theta // 2:
            found[:, k] = MIRROR * found[:, recipe.theta - k]
            continue
        n = recipe.direction(j, k)
        for solve in solves:
            solve.reset()
        for m, t in enumerate(recipe.t_nodes[1:-1], start=1):
            found[:, k, m] = forces_at(solves, recipe.radius * t / (1.0 - t) * n, scale)
        for p in range(3):
            found[p, k, -1] = sliding(ratio, n / scale[p])
    return found


class Parts:
    """Parts of a table, kept in a folder: what is found there is not solved again."""

    def __init__(self, folder: Path, pool: Executor, step: Callable[[Any], None]) -> None:
        self._folder, self._pool, self._step = folder, pool, step
        folder.mkdir(parents=True, exist_ok=True)

    def __call__(
        self, name: str, solve: Callable[..., np.ndarray], arguments: list[tuple[Any, ...]]
    ) -> np.ndarray:
        """solve(*arguments) for each, stacked."""
        files = [self._folder / f"{name}-{i}.npy" for i in range(len(arguments))]
        waiting = {
            self._pool.submit(solve, *values): file
            for file, values in zip(files, arguments, strict=True)
            if not file.exists()
        }
        for _ in range(len(files) - len(waiting)):
            self._step(None)
        for future in as_completed(waiting):
            keep(waiting[future], future.result())
            self._step(None)
        return np.array([np.load(file) for file in files])


def keep(file: Path, values: np.ndarray) -> None:
    """Writes a part whole or not at all."""
    temporary = file.with_suffix(f".{os.getpid()}")
    with temporary.open("wb") as stream:
        np.save(stream, values)
    temporary.replace(file)


def part_count(recipe: Recipe) -> int:
    """Number of parts, for a progress bar."""
    return (recipe.ratios + 1) * (recipe.psi + 2) + sample_parts(recipe)


def make_table(recipe: Recipe, folder: Path, jobs: int, step: Callable[[Any], None]) -> bytes:
    """The bytes of the table. step is called after each part. Raises NotSolved."""
    with ProcessPoolExecutor(jobs) as pool:
        parts = Parts(folder / recipe.key(), pool, step)
        numbers = range(recipe.ratios + 1)
        slope = parts("slope", slope_part, [(recipe, i) for i in numbers])
        nodes = [(recipe, i, j, slope[i]) for i in numbers for j in range(recipe.psi + 1)]
        force = parts("force", force_part, nodes)
        sample = parts("sample", sample_part, [(recipe, i) for i in range(sample_parts(recipe))])
    force = force.reshape(recipe.ratios + 1, recipe.psi + 1, *force.shape[1:])
    force, slope = np.moveaxis(force, 2, 0), np.moveaxis(slope, 1, 0)
    found = coefficients(recipe, force, slope, scales_of(recipe, slope))
    about: dict[str, Any] = {"version": _core.version()}
    sample = sample.reshape(-1, sample.shape[-1])
    error = errors(pack(recipe, found, about, [0.0, 0.0]), sample)
    about["error"] = summary(sample, error)
    return pack(recipe, found, about, np.percentile(error, 95, axis=0).tolist())
