"""Truth: results of fine grids of several discretisations, extrapolated, and their agreement.

``railpatch bench --truth -o DIR`` computes it, resuming what DIR holds; DIR/truth.npz then replaces
the file of this package.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import dataclass, replace
from functools import cache
from importlib import resources
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from railpatch import _core
from railpatch.evidence.bench.methods import FITTED, UNIFORM, Method, tangential
from railpatch.evidence.bench.sets import SETS, AnyBatch
from railpatch.evidence.bench.shapes import Floats
from railpatch.evidence.bench.steps import steps_of

FILE = "truth.npz"
TOLERANCE = 1e-7
SAMPLE_SEED = 0
VALUES = ("force along rolling", "lateral force", "spin moment", "greatest pressure")


@dataclass(frozen=True)
class Recipe:
    """One way to the truth: a discretisation on several grids, extrapolated to size zero.

    grids: of the method. order: of the error in the element size. sets: that it is for. most: steps
    of each batch that it takes, drawn by SAMPLE_SEED; None: all.
    """

    name: str
    method: Method
    grids: tuple[int, ...]
    order: float
    sets: str = "ABCDW"
    most: int | None = None

    def chosen(self, count: int) -> NDArray[np.int64]:
        """Indices of the steps it takes of so many."""
        order = np.random.default_rng(SAMPLE_SEED).permutation(count)
        return np.sort(order[: self.most])

    def extrapolated(self, values: list[Floats]) -> Floats:
        """Values at size zero: least squares of value = limit + c size^order over the grids."""
        sizes = (min(self.grids) / np.array(self.grids)) ** self.order
        stacked = np.array(values)
        fit = np.polynomial.polynomial.polyfit(sizes, stacked.reshape(len(sizes), -1), 1)
        return fit[0].reshape(stacked.shape[1:])


# of a set, the first gives the truth, the others say how far to trust it. Orders: measured on 200
# patches of set A, grids of 24 to 96 across (uniform: the smallest residuals of its own fits) and
# scales of 14 to 44 (fitted). Fitted rows take the pressure of a row as half an ellipse, exact for
# Hertz alone: other contacts have other uniform grids instead. Even and odd grids of a wheel come
# from both sides: each recipe has both. Uniform elements are much longer than thin layers (D) are
# thick: fitted rows, closer at the edges and within 0.05 % of each other, are the truth there
UNIFORM_ORDER, FITTED_ORDER = 1.07, 1.7
# the orders are those of grids that read the spin at the elements
PLAIN = replace(UNIFORM, overrides=tangential("full", spin_offset="none"))
MANY = tuple(range(40, 81))
RECIPES = (
    Recipe("uniform", PLAIN, MANY[::8], UNIFORM_ORDER, "ABC"),
    Recipe("fitted rows", FITTED, tuple(range(14, 23)), FITTED_ORDER, "ACD"),
    Recipe("fitted rows, fine", FITTED, (27, 32, 38, 44), FITTED_ORDER, "A", most=40),
    Recipe("uniform, many", PLAIN, MANY, UNIFORM_ORDER, "D"),
    Recipe("uniform, odd", PLAIN, MANY[7::8], UNIFORM_ORDER, "B"),
    Recipe("uniform, pairs", PLAIN, tuple(n for n in MANY if n % 4 < 2), UNIFORM_ORDER, "W"),
    Recipe("uniform, other pairs", PLAIN, tuple(n for n in MANY if n % 4 > 1), UNIFORM_ORDER, "W"),
)


def recipes_of(name: str) -> tuple[Recipe, ...]:
    """Those for a set, the truth first."""
    return tuple(recipe for recipe in RECIPES if name in recipe.sets)


@dataclass(frozen=True)
class Truth:
    """Truth of one batch.

    values: [n, 4], of VALUES over their scales (see ``problems.Scales``). agreement: [r, n, 3], how
    far each other recipe differs in force (vector), moment and pressure (relative); NaN for steps
    that it does not take.
    """

    values: Floats
    agreement: Floats


@cache
def batches_of(name: str) -> list[AnyBatch]:
    """The batches of a set."""
    return SETS[name].whole()


def problem_sum(batches: list[AnyBatch]) -> float:
    """A number that tells whether a truth was made for these problems."""
    parts = [batch.checksum() for batch in batches]
    return float(np.dot(np.arange(1, len(parts) + 1), parts))


def solve_batch(recipe: Recipe, batch: AnyBatch, elements: int) -> Floats:
    """[n, 4], of VALUES on one grid; NaN where a step does not converge, warm or cold."""
    contact = recipe.method.contact(batch, elements, {"method": {"tolerance": TOLERANCE}})
    inputs = batch.inputs()
    _, results = contact.time_steps(inputs, [False] * len(inputs), 1)
    for i, result in enumerate(results):
        if result["status"] != "converged":
            results[i] = contact.time_steps([inputs[i]], [True], 1)[1][0]
    steps = steps_of(batch, results)
    values = np.column_stack([steps.force, steps.moment, steps.pressure])
    values[~steps.good] = np.nan
    return values


def combine(batch: AnyBatch, by_recipe: list[Floats]) -> Truth:
    """The first recipe's values with the differences of the others from them."""
    values = by_recipe[0].copy()
    differences = np.array([other - values for other in by_recipe[1:]])
    agreement = np.stack(
        [
            np.hypot(differences[..., 0], differences[..., 1]),
            np.abs(differences[..., 2]),
            np.abs(differences[..., 3] / values[:, 3]),
        ],
        axis=-1,
    )
    if batch.exact_pressure:
        values[:, 3] = 1.0
        agreement[..., 2] *= 0.0
    return Truth(values, agreement)


def compute_truth(
    folder: Path, names: str, jobs: int, progress: Callable[[Any], None] = lambda _: None
) -> Path:
    """Computes what the folder does not hold yet; returns the file of the truth.

    names: letters of the sets. jobs: processes. progress: told of each finished grid of a batch.
    """
    parts = folder / "parts"
    parts.mkdir(parents=True, exist_ok=True)
    with ProcessPoolExecutor(max_workers=jobs) as pool:
        waiting = [pool.submit(compute_part, parts, *task) for task in tasks(names)]
        for done in as_completed(waiting):
            progress(done.result())
    arrays: dict[str, Any] = {"recipe": json.dumps(described(RECIPES))}
    for name in names:
        truths = [assembled(parts, name, index) for index in range(len(batches_of(name)))]
        arrays[f"{name}_values"] = np.concatenate([t.values for t in truths]).astype(np.float32)
        agreement = np.concatenate([t.agreement for t in truths], axis=1)
        arrays[f"{name}_agreement"] = agreement.astype(np.float32)
        arrays[f"{name}_sum"] = problem_sum(batches_of(name))
    output = folder / FILE
    np.savez_compressed(output, **arrays)
    return output


def assembled(parts: Path, name: str, index: int) -> Truth:
    """The truth of one batch from its files."""
    batch, by_recipe = batches_of(name)[index], []
    for recipe in recipes_of(name):
        values = [np.load(part_path(parts, recipe, name, index, n)) for n in recipe.grids]
        whole = np.full((len(batch), len(VALUES)), np.nan)
        whole[recipe.chosen(len(batch))] = recipe.extrapolated(values)
        by_recipe.append(whole)
    return combine(batch, by_recipe)


def tasks(names: str) -> list[tuple[int, str, int, int]]:
    """Recipe, set, batch, elements: the dearest first."""
    found = [
        (recipe, name, index, elements)
        for recipe, content in enumerate(RECIPES)
        for name in names
        if name in content.sets
        for elements in content.grids
        for index in range(len(batches_of(name)))
    ]
    return sorted(found, key=lambda task: -task[3])


def part_path(parts: Path, recipe: Recipe, name: str, index: int, elements: int) -> Path:
    """File of one batch on one grid; another recipe or version of the problems has another one."""
    part = f" {recipe.most} steps" if recipe.most else ""
    key = f"{recipe.method.name} {problem_sum(batches_of(name)):.9g} {_core.version()}{part}"
    return parts / f"{fingerprint(key)}_{name}{index}_{elements}.npy"


def fingerprint(text: str) -> str:
    """Short and the same in every process."""
    return hashlib.sha256(text.encode()).hexdigest()[:12]


def compute_part(parts: Path, recipe: int, name: str, index: int, elements: int) -> Path:
    """One batch on one grid, unless its file is there."""
    path = part_path(parts, RECIPES[recipe], name, index, elements)
    if not path.exists():
        batch = batches_of(name)[index]
        part = batch.take(RECIPES[recipe].chosen(len(batch)))
        values = solve_batch(RECIPES[recipe], part, elements)
        partial = path.with_suffix(".partial.npy")
        np.save(partial, values)
        partial.replace(path)
    return path


def described(recipes: tuple[Recipe, ...]) -> list[dict[str, Any]]:
    """The recipes as they are stored with the truth."""
    return [
        {
            "name": recipe.name,
            "method": recipe.method.label,
            "sets": recipe.sets,
            "most": recipe.most,
            "grids": list(recipe.grids),
            "unit": recipe.method.unit,
            "order": recipe.order,
            "tolerance": TOLERANCE,
            "version": _core.version(),
            "fft": _core.fft_backend(),
        }
        for recipe in recipes
    ]


class TruthFile:
    """The stored truth. Raises ValueError where it is not of these problems."""

    def __init__(self, path: Path | None = None) -> None:
        place = path or resources.files("railpatch.evidence.bench").joinpath(FILE)
        with place.open("rb") as file:
            self._arrays = dict(np.load(file))
        self.recipes: list[dict[str, Any]] = json.loads(str(self._arrays["recipe"]))
        for name in self.names:
            if not np.isclose(
                self._arrays[f"{name}_sum"], problem_sum(batches_of(name)), rtol=1e-9
            ):
                raise ValueError(f"truth of set {name}: made for other problems, allowed --truth")

    @property
    def names(self) -> str:
        """Letters of the sets that have a truth."""
        return "".join(name for name in SETS if f"{name}_values" in self._arrays)

    def of(self, name: str, index: int) -> Truth:
        """Truth of one batch; NaN for a set that has none: it is measured for its run times."""
        batches = batches_of(name)
        if name not in self.names:
            count = len(batches[index])
            return Truth(np.full((count, len(VALUES)), np.nan), np.full((1, count, 3), np.nan))
        first = sum(map(len, batches[:index]))
        part = slice(first, first + len(batches[index]))
        values = self._arrays[f"{name}_values"][part].astype(float)
        return Truth(values, self.agreement(name)[:, part])

    def agreement(self, name: str) -> Floats:
        """[r, n, 3], of a whole set: of the recipes after its first one."""
        return self._arrays[f"{name}_agreement"].astype(float)

    def recipes_of(self, name: str) -> list[dict[str, Any]]:
        """The stored recipes of a set, the truth first."""
        return [recipe for recipe in self.recipes if name in recipe["sets"]]
