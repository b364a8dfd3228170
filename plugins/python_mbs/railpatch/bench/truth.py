"""Truth: results of fine grids of several discretisations, extrapolated, and their agreement.

``railpatch bench --truth -o DIR`` computes it, resuming what DIR holds; DIR/truth.npz then replaces
the file of this package.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Mapping
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import dataclass
from functools import cache
from importlib import resources
from pathlib import Path
from typing import Any

import numpy as np

from railpatch import _core
from railpatch.bench.sets import SETS, AnyBatch
from railpatch.bench.shapes import Floats
from railpatch.bench.steps import contact_of, steps_of

FILE = "truth.npz"
TOLERANCE = 1e-7
VALUES = ("force along rolling", "lateral force", "spin moment", "greatest pressure")


@dataclass(frozen=True)
class Recipe:
    """One way to the truth: a discretisation on several grids, extrapolated to size zero.

    overrides: keys of the case. grids: elements across. order: of the error in the element size.
    wheel_grids: of whole wheels (set W), whose potential contact is larger than the contact; the
    same if left out.
    """

    name: str
    overrides: Mapping[str, Any]
    grids: tuple[int, ...]
    order: float
    wheel_grids: tuple[int, ...] = ()

    def grids_of(self, name: str) -> tuple[int, ...]:
        """The grids for a set."""
        return self.wheel_grids if name == "W" and self.wheel_grids else self.grids

    def extrapolated(self, values: list[Floats], grids: tuple[int, ...]) -> Floats:
        """Values at size zero: least squares of value = limit + c size^order over the grids."""
        sizes = (min(grids) / np.array(grids)) ** self.order
        stacked = np.array(values)
        fit = np.polynomial.polynomial.polyfit(sizes, stacked.reshape(len(sizes), -1), 1)
        return fit[0].reshape(stacked.shape[1:])


# the first gives the truth, the second says how far to trust it
RECIPES = (
    Recipe("uniform, even", {}, (40, 48, 56, 64), 1.0, wheel_grids=(32, 40, 48)),
    Recipe("uniform, odd", {}, (39, 47, 55, 63), 1.0, wheel_grids=(31, 39, 47)),
)


@dataclass(frozen=True)
class Truth:
    """Truth of one batch.

    values: [n, 4], of VALUES over their scales (see ``problems.Scales``). agreement: [n, 3], how
    far the discretisations differ in force (vector), moment and pressure (relative).
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
    overrides = dict(recipe.overrides)
    overrides["method"] = {"tolerance": TOLERANCE, **overrides.get("method", {})}
    contact = contact_of(batch, overrides, elements)
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
    """The first recipe's values with the greatest difference of the others from them."""
    values = by_recipe[0].copy()
    differences = np.array([other - values for other in by_recipe[1:]])
    agreement = np.column_stack(
        [
            np.hypot(differences[..., 0], differences[..., 1]).max(axis=0),
            np.abs(differences[..., 2]).max(axis=0),
            np.abs(differences[..., 3] / values[:, 3]).max(axis=0),
        ]
    )
    if batch.exact_pressure:
        values[:, 3], agreement[:, 2] = 1.0, 0.0
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
        arrays[f"{name}_agreement"] = np.concatenate([t.agreement for t in truths]).astype(
            np.float32
        )
        arrays[f"{name}_sum"] = problem_sum(batches_of(name))
    output = folder / FILE
    np.savez_compressed(output, **arrays)
    return output


def assembled(parts: Path, name: str, index: int) -> Truth:
    """The truth of one batch from its files."""
    by_recipe = []
    for recipe in RECIPES:
        grids = recipe.grids_of(name)
        values = [np.load(part_path(parts, recipe, name, index, n)) for n in grids]
        by_recipe.append(recipe.extrapolated(values, grids))
    return combine(batches_of(name)[index], by_recipe)


def tasks(names: str) -> list[tuple[int, str, int, int]]:
    """Recipe, set, batch, elements: the dearest first."""
    found = [
        (recipe, name, index, elements)
        for recipe, content in enumerate(RECIPES)
        for name in names
        for elements in content.grids_of(name)
        for index in range(len(batches_of(name)))
    ]
    return sorted(found, key=lambda task: -task[3])


def part_path(parts: Path, recipe: Recipe, name: str, index: int, elements: int) -> Path:
    """File of one batch on one grid; another recipe or version of the problems has another one."""
    text = json.dumps(described((recipe,))[0]["overrides"], sort_keys=True)
    key = f"{recipe.name} {text} {problem_sum(batches_of(name)):.9g} {_core.version()}"
    return parts / f"{fingerprint(key)}_{name}{index}_{elements}.npy"


def fingerprint(text: str) -> str:
    """Short and the same in every process."""
    return hashlib.sha256(text.encode()).hexdigest()[:12]


def compute_part(parts: Path, recipe: int, name: str, index: int, elements: int) -> Path:
    """One batch on one grid, unless its file is there."""
    path = part_path(parts, RECIPES[recipe], name, index, elements)
    if not path.exists():
        values = solve_batch(RECIPES[recipe], batches_of(name)[index], elements)
        partial = path.with_suffix(".partial.npy")
        np.save(partial, values)
        partial.replace(path)
    return path


def described(recipes: tuple[Recipe, ...]) -> list[dict[str, Any]]:
    """The recipes as they are stored with the truth."""
    return [
        {
            "name": recipe.name,
            "overrides": dict(recipe.overrides),
            "grids": list(recipe.grids),
            "wheel_grids": list(recipe.wheel_grids),
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
        place = path or resources.files("railpatch.bench").joinpath(FILE)
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
            return Truth(np.full((count, len(VALUES)), np.nan), np.full((count, 3), np.nan))
        first = sum(map(len, batches[:index]))
        part = slice(first, first + len(batches[index]))
        arrays = [
            self._arrays[f"{name}_{key}"][part].astype(float) for key in ("values", "agreement")
        ]
        return Truth(*arrays)

    def agreement(self, name: str) -> Floats:
        """[n, 3], of a whole set."""
        return self._arrays[f"{name}_agreement"].astype(float)
