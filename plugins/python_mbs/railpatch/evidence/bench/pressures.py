"""Measured errors of the greatest pressure: one load of each random contact, on several grids."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np

from railpatch.evidence.bench.methods import room
from railpatch.evidence.bench.positions import random_patch
from railpatch.evidence.bench.problems import Batch
from railpatch.evidence.bench.samples import (
    FEATURES,
    GRIDS,
    NORMALS,
    SEED,
    SOURCES,
    Samples,
    fine_pressure,
    random_ellipse,
    random_surface,
)
from railpatch.evidence.bench.shapes import Floats
from railpatch.evidence.bench.steps import contact_of, steps_of
from railpatch.evidence.bench.truth import TruthFile, batches_of

COUNTS = {"random": 60, "surface": 150, "position": 300}
PASSES = 4  # grids of each contact and theory
TESTS = 0.25  # of the counts: those to test on

Task = tuple[int, str, int]  # seed, source, number


def tasks(seed: int, part: float = 1.0) -> list[Task]:
    """Random contacts."""
    return [(seed, s, i) for s, count in COUNTS.items() for i in range(round(part * count))]


def random_contact(task: Task) -> tuple[Batch, float]:
    """A contact with its greatest pressure over Hertz's."""
    seed, source, index = task
    random = np.random.default_rng([seed, SOURCES.index(source), index])
    if source == "random":
        # a layer is for tractions
        return replace(random_ellipse(random, index)[0].take(np.array([0])), layer=None), 1.0
    make = random_surface if source == "surface" else random_patch
    batch = make(random, index).take(np.array([0]))
    return batch, fine_pressure(batch)


def of_task(task: Task) -> dict[str, Samples]:
    """Errors by theory."""
    batch, truth = random_contact(task)
    return measured(batch, truth, SOURCES.index(task[1]), task[2])


def of_benchmark(name: str) -> Iterator[dict[str, Samples]]:
    """Errors on a set of the benchmark, the first step of each batch."""
    for index, batch in enumerate(batches_of(name)):
        assert isinstance(batch, Batch)
        truth = float(TruthFile().of(name, index).values[0, 3])
        yield measured(batch.take(np.array([0])), truth, SOURCES.index(name), index)


def measured(batch: Batch, truth: float, source: int, number: int) -> dict[str, Samples]:
    """Errors of every theory but Hertz's.

    ANALYN is exact for quadratic surfaces, which the features do not tell from others: a model that
    knew those would take every contact that is nearly an ellipse for one of them.
    """
    random = np.random.default_rng([SEED, source, number])
    return {
        normal: of_theory(batch, truth, normal, random.choice(GRIDS, PASSES), (source, number))
        for normal in NORMALS[1:]
        if normal != "analyn" or not batch.exact_pressure
    }


def of_theory(
    batch: Batch, truth: float, normal: str, grids: Floats, place: tuple[int, int]
) -> Samples:
    """Errors of one theory on some grids."""
    features, errors = [], []
    for elements in grids:
        overrides: dict[str, Any] = {
            "friction": None,
            "method": {"tangential": "none", "normal": normal},
        }
        if normal != "half_space":
            overrides.update(room(batch, int(elements)))
        contact = contact_of(batch, overrides, int(elements))
        steps = steps_of(batch, [contact.step(batch.inputs()[0])])
        if not steps.good[0]:
            continue
        features.append(contact.field(1, 0, "error_features"))
        errors.append([0.0, 0.0, abs(steps.pressure[0] / truth - 1)])
    count = len(errors)
    return Samples(
        np.array(features).reshape(count, FEATURES),
        np.array(errors).reshape(count, 3),
        np.full((count, 3), np.nan),
        np.full(count, place[0]),
        np.full(count, place[1] + 10**6 * place[0]),
        np.full(count, float(np.divide(*batch.shape.semi_axes(batch.normal_force)[0]))),
    )
