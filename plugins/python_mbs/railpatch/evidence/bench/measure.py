"""Errors, run times and work of one method on one grid over a set of problems."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from railpatch.evidence.bench.methods import Method
from railpatch.evidence.bench.problems import Batch
from railpatch.evidence.bench.sets import AnyBatch, sample
from railpatch.evidence.bench.shapes import Floats
from railpatch.evidence.bench.steps import steps_of
from railpatch.evidence.bench.truth import Truth, TruthFile, batches_of

WARM_CHANGE = 1.01  # of the creepages and spin, between a warm step and the one before
COLUMNS = (
    "force_error",
    "moment_error",
    "pressure_error",
    "power_error",
    "truth_agreement",
    "cold",
    "warm",
    "cold_iterations",
    "warm_iterations",
    "cold_products",
    "warm_products",
    "start_difference",
    "force_estimate",
    "moment_estimate",
    "pressure_estimate",
)


@dataclass(frozen=True)
class Measured:
    """A method on one grid over n steps of a set.

    place: [n, 2], index of the batch and of the step in it. good: [n], cold and warm converged.
    columns: name -> [n] (see COLUMNS). Errors and estimates: of the creep force (vector) over
    friction coefficient times normal force; of the spin moment over that times c; of the greatest
    pressure over its truth; of the power over ``problems.Scales.power``. truth_agreement: of the
    force. cold, warm: s. iterations: of normal and tangential problem. products: of the
    tangential operator. start_difference: force of a warm minus that of a cold start. bytes: held.
    """

    method: Method
    elements: int
    set_name: str
    place: NDArray[np.int64]
    good: NDArray[np.bool_]
    columns: dict[str, Floats]
    bytes: int

    @property
    def point(self) -> str:
        """Method and grid as text."""
        return self.method.point(self.elements)


@dataclass(frozen=True)
class Timed:
    """Results of a batch from cold and from warm starts, and the time of each step."""

    cold_results: list[dict[str, Any]]
    warm_results: list[dict[str, Any]]
    cold: Floats
    warm: Floats


def time_apart(contact: Any, batch: Batch, repeat: int) -> Timed:
    """Each step cold, then with creepages changed by one per cent, then back."""
    inputs: list[dict[str, Any]] = []
    for base, near in zip(batch.inputs(), batch.inputs(WARM_CHANGE), strict=True):
        inputs += [base, near, base]
    seconds, results = contact.time_steps(inputs, [True, False, False] * len(batch), repeat)
    seconds = np.median(seconds, axis=0).reshape(-1, 3)
    return Timed(results[::3], results[2::3], seconds[:, 0], seconds[:, 1:].mean(axis=1))


def time_ordered(contact: Any, batch: AnyBatch, repeat: int) -> Timed:
    """Each step cold; then all in their order, each from the one before. The first is not warm."""
    inputs, count = batch.inputs(), len(batch)
    cold, cold_results = contact.time_steps(inputs, [True] * count, repeat)
    warm, warm_results = contact.time_steps(inputs, [True] + [False] * (count - 1), repeat)
    warm = np.median(warm, axis=0)
    warm[0] = np.nan
    return Timed(cold_results, warm_results, np.median(cold, axis=0), warm)


def measure(
    method: Method,
    elements: int,
    set_name: str,
    truth: TruthFile,
    limit: int | None = None,
    progress: Callable[[Any], None] = lambda _: None,
) -> Measured:
    """Measures a method. limit: most steps; progress: told of each finished batch.

    Raises CaseError where the schema refuses the method.
    """
    batches = batches_of(set_name)
    total = min(sum(map(len, batches)), limit or sum(map(len, batches)))
    places, goods, columns, held = [], [], [], []
    for batch, chosen in sample(batches, method.count(elements, total)):
        index = batches.index(batch)
        part = batch.take(chosen)
        contact = method.contact(part, elements)
        timed = (time_ordered if batch.ordered else time_apart)(contact, part, method.repeat)
        known = truth.of(set_name, index)
        found = columns_of(part, timed, Truth(known.values[chosen], known.agreement[:, chosen]))
        goods.append(found.pop("good").astype(bool))
        columns.append(found)
        places.append(np.column_stack([np.full(len(chosen), index), chosen]))
        held.append(sum(stage["bytes"] for stage in contact.describe()))
        progress(batch)
    return Measured(
        method=method,
        elements=elements,
        set_name=set_name,
        place=np.concatenate(places),
        good=np.concatenate(goods),
        columns={name: np.concatenate([part[name] for part in columns]) for name in COLUMNS},
        bytes=max(held),
    )


def columns_of(batch: AnyBatch, timed: Timed, truth: Truth) -> dict[str, Floats]:
    """The columns of a batch, and whether each step is good."""
    cold, warm = (steps_of(batch, results) for results in (timed.cold_results, timed.warm_results))
    force, moment, pressure = truth.values[:, :2], truth.values[:, 2], truth.values[:, 3]
    difference = warm.force - force
    start = warm.force - cold.force
    return {
        "good": cold.good & warm.good,
        "force_error": np.hypot(*difference.T),
        "moment_error": np.abs(warm.moment - moment),
        "pressure_error": np.abs(warm.pressure / pressure - 1),
        "power_error": np.abs(warm.power - batch.true_power(force, moment)),
        "truth_agreement": truth.agreement[0, :, 0],
        "cold": timed.cold,
        "warm": timed.warm,
        "cold_iterations": cold.counts[:, :2].sum(axis=1).astype(float),
        "warm_iterations": warm.counts[:, :2].sum(axis=1).astype(float),
        "cold_products": cold.counts[:, 2].astype(float),
        "warm_products": warm.counts[:, 2].astype(float),
        "start_difference": np.hypot(*start.T),
        "force_estimate": warm.estimate[:, 0],
        "moment_estimate": warm.estimate[:, 1],
        "pressure_estimate": warm.estimate[:, 2],
    }
