"""Measured errors of every method with what the core's error estimate is made from.

Problems, none of them the benchmark's: Hertzian contacts of random shape, load, friction, Poisson's
ratio, layer and motion; random contacts whose lateral curvature changes across them; and wheels on
rails and rollers at random positions. Their truth is the full theory on two fine grids of rows
fitted to the contact, extrapolated.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, fields, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from railpatch.case.accuracy import fitted_size
from railpatch.case.creep_table import default_table, describe_table
from railpatch.case.theories import FAST, has_tractions
from railpatch.evidence.bench.methods import room
from railpatch.evidence.bench.positions import random_patch
from railpatch.evidence.bench.problems import Batch, merged
from railpatch.evidence.bench.sets import ELLIPSES, FORCE, FRICTION, LAYERS, units
from railpatch.evidence.bench.shapes import (
    POISSON_RATIO,
    Ellipse,
    Floats,
    Surface,
    hertz_curvatures,
)
from railpatch.evidence.bench.steps import contact_of, steps_of
from railpatch.evidence.bench.surfaces import contact_box, moved
from railpatch.evidence.bench.truth import TruthFile, batches_of

SEED = 20261122
FEATURES = 23  # of the core
SHAPES, SURFACES, POSITIONS, STEPS = 160, 60, 130, 14  # random ones, and motions of each
LAYERED = 0.2  # share of the random ellipses that have a third-body layer
# share of motions at which a contact slides for the greater part, and of those of a wheel's own
SLIDING, OWN = 0.4, 0.6
RATIO = (0.1, 10.0)  # a/b of the random contacts
MOST_SPIN = 3.0  # over what saturates the linear theory, of motions that slide
# fine rows: scales of fitted_size, elements of the normal problem across, order of the error
FINE_ELLIPSE = ((20, 24), (28, 24))
FINE = ((14, 48), (20, 72))
PRESSURE = (90, 110, 130)  # elements across: the mean is the greatest pressure of other shapes
ORDER = 1.7
NORMALS = ("hertz", "half_space", "kik_piotrowski", "analyn")
GRIDS = (8, 10, 12, 14, 16, 20, 24, 32, 40)
# passes over the problems of each source, each time on other grids
PASSES = {"random": 2, "surface": 2, "position": 2, "A": 1, "B": 3, "C": 3, "D": 3}
FITTED = (6, 7, 8, 9, 10, 11, 12, 14, 16, 18, 20)
SOURCES = ("random", "surface", "position", "A", "B", "C", "D")


@dataclass(frozen=True)
class Problem:
    """A batch with its truth, [n, 4] as in ``truth.Truth``. overrides: of the case, the material.

    source: of SOURCES. number: tells it from others.
    """

    batch: Batch
    truth: Floats
    overrides: Mapping[str, Any]
    source: str
    number: int = 0

    @property
    def axis_ratio(self) -> float:
        """a/b of the contact or of the box around it."""
        a, b = self.batch.shape.semi_axes(self.batch.normal_force)[0]
        return float(a / b)


@dataclass(frozen=True)
class Family:
    """A model of the core: a theory, with the cases of its grids and normal theories.

    name: of the arrays in core/patch/error_model.inc. normals: theories of the normal
    problem, each with the share of the problems that it is taken for. units: of the network.
    stated: errors of force and moment that the theory states itself, over which the model's are.
    """

    name: str
    tangential: str
    fitted: bool = False
    normals: Mapping[str, float] = field(default_factory=lambda: dict.fromkeys(NORMALS, 1.0))
    units: int = 16

    @property
    def stated(self) -> tuple[float, float]:
        """-, of the 95th percentile."""
        if self.tangential != "table":
            return 1.0, 1.0
        error = describe_table(default_table().tobytes())["error"]["all"]
        return error["force"][1], error["moment"][1]

    def choices(
        self, problem: Problem, random: np.random.Generator, *, every: bool = False
    ) -> Iterator[dict[str, Any]]:
        """Overrides of the case: every normal theory that applies, on a random grid.

        every: whatever its share.
        """
        ellipse = problem.batch.exact_pressure
        if problem.batch.layer is not None and self.tangential != "full":
            return
        for normal, share in self.normals.items():
            left_out = random.random() >= share and not every
            if (normal == "hertz" and not ellipse) or left_out:
                continue
            elements = int(random.choice(GRIDS))
            yield self.overrides(problem, normal, elements, random)

    def overrides(
        self, problem: Problem, normal: str, elements: int, random: np.random.Generator
    ) -> dict[str, Any]:
        """Of one case. A dictionary with the key 'elements' besides."""
        method = {"normal": normal, "tangential": self.tangential}
        found: dict[str, Any] = {"elements": elements, "method": method}
        if self.fitted:
            scale = float(random.choice(FITTED))
            square = random.random() < 0.3
            size = fitted_size(scale, 1.0 if square else problem.axis_ratio)
            found["grid"] = {"fitted": list(size)}
        return found


APPROXIMATE = dict.fromkeys(("kik_piotrowski", "analyn"), 0.7)
FAMILIES = (
    Family("uniform", "full", normals={"half_space": 1.0, "hertz": 0.5}),
    Family("fitted", "full", fitted=True, normals={"hertz": 1.0, "half_space": 0.7}),
    # errors of the pressure, which no grid makes smaller, are the greater part: few units do
    Family("uniform_approximate", "full", normals=APPROXIMATE, units=6),
    Family("fitted_approximate", "full", fitted=True, normals=APPROXIMATE, units=6),
    *(Family(name, name) for name in FAST if has_tractions(name)),
    *(Family(name, name) for name in FAST if not has_tractions(name) and name != "table"),
    Family("table", "table", normals={"hertz": 1.0}),
)


@dataclass(frozen=True)
class Samples:
    """Cases of a family.

    features: [n, 23] of the core. errors: [n, 3] of force over mu Fn, moment over that times c,
    pressure over itself; estimates: the same of the core's present model. source: [n], index in
    SOURCES. case: [n], number of the problem: the same for all cases of a contact. ratio: [n], a/b.
    """

    features: Floats
    errors: Floats
    estimates: Floats
    source: NDArray[np.int64]
    case: NDArray[np.int64]
    ratio: Floats

    def part(self, chosen: NDArray[Any]) -> Samples:
        """Some of the cases."""
        return Samples(
            self.features[chosen],
            self.errors[chosen],
            self.estimates[chosen],
            self.source[chosen],
            self.case[chosen],
            self.ratio[chosen],
        )


def joined(parts: list[Samples]) -> Samples:
    """All of them as one."""
    names = [each.name for each in fields(Samples)]
    return Samples(*(np.concatenate([getattr(part, name) for part in parts]) for name in names))


def random_motion(random: np.random.Generator, count: int) -> tuple[Floats, Floats]:
    """Creepages [n, 2] and spin [n] over their units, from nearly all stick to full sliding."""
    size, angle = 10 ** random.uniform(-2.0, 1.2, count), random.uniform(-np.pi, np.pi, count)
    spin = random.choice((-1, 1), count) * 10 ** random.uniform(-1.8, 0.5, count)
    much = random.random(count) < SLIDING
    size[much] = random.uniform(0.1, 12, much.sum())
    spin[much] = random.choice((-1, 1), much.sum()) * random.uniform(0, MOST_SPIN, much.sum())
    spin[random.random(count) < 0.2] = 0
    size[random.random(count) < 0.05] = 0
    return (size * np.array([np.cos(angle), np.sin(angle)])).T, spin


def unit_of_ratio(ratio: float) -> Floats:
    """Creepage units and spin unit times c at mu Fn = G c^2, by the ellipses of set A."""
    known = np.array(sorted(ELLIPSES))
    rows = []
    for each in known:
        ellipse, creepage, spin = units(float(each))
        c2 = ellipse.a * ellipse.b
        rows.append(np.log([*(creepage * c2), spin * c2**1.5]))
    table = np.array(rows)
    # parabolas of the logarithms, which go on beyond those ellipses
    fits = np.polynomial.polynomial.polyfit(np.log(known), table, 2)
    logs = np.polynomial.polynomial.polyval(np.log(ratio), fits)
    return np.exp(logs) / (FRICTION * FORCE)


def with_motion(batch: Batch, random: np.random.Generator, steps: int) -> Batch:
    """The batch with random motions."""
    axes = batch.shape.semi_axes(batch.normal_force)[0]
    c2, capacity = float(axes.prod()), batch.friction * float(batch.normal_force[0])
    unit = unit_of_ratio(float(axes[0] / axes[1])) * capacity / c2
    creepage, spin = random_motion(random, steps)
    return replace(
        batch,
        normal_force=np.full(steps, batch.normal_force[0]),
        creepage=creepage * unit[:2],
        spin=spin * unit[2] / np.sqrt(c2),
        direction=int(random.choice((-1, 1))),
    )


def random_ellipse(
    random: np.random.Generator, index: int, steps: int = STEPS
) -> tuple[Batch, dict[str, Any]]:
    """A Hertzian contact, with its material."""
    ratio, c = np.exp(random.uniform(*np.log(RATIO))), 10 ** random.uniform(-3, -2)
    batch = Batch(
        name=f"random {index}, a/b = {ratio:.3g}",
        shape=Ellipse(c * np.sqrt(ratio), c / np.sqrt(ratio)),
        normal_force=np.array([10 ** random.uniform(3.5, 5.2)]),
        creepage=np.zeros((1, 2)),
        spin=np.zeros(1),
        friction=float(random.uniform(0.05, 0.6)),
    )
    nu = float(random.uniform(0, 0.5)) if random.random() < 0.3 else POISSON_RATIO
    if random.random() < LAYERED:
        modulus = next(iter(LAYERS.values()))[0]
        batch = replace(batch, layer=(modulus, float(10 ** random.uniform(-5, -2.7))))
    return with_motion(batch, random, steps), {"material": {"poisson_ratio": nu}}


def random_surface(random: np.random.Generator, index: int, steps: int = STEPS) -> Batch:
    """A contact whose lateral curvature changes from value to value."""
    ratio, force = np.exp(random.uniform(*np.log(RATIO))), 82e3
    b = 6e-3 / np.sqrt(ratio)
    along, across = hertz_curvatures(6e-3 * np.sqrt(ratio), b, force)
    y = np.linspace(-8 * b, 8 * b, 1601)
    # as profiles do where arcs join, here over some width
    logarithm = np.zeros_like(y)
    for _ in range(random.integers(1, 5)):
        change = np.tanh((y - b * random.uniform(-1.2, 1.2)) / (b * random.uniform(0.03, 1)))
        logarithm += random.uniform(0.1, 0.8) * random.choice((-1, 1)) * change
    curvature = across * np.exp(np.clip(logarithm, -1.5, 1.5))
    slope = np.cumsum(2 * curvature) * (y[1] - y[0])
    slope -= np.interp(0, y, slope)
    gap = np.cumsum(slope) * (y[1] - y[0])
    rows = np.stack([gap - gap.min(), 0 * y, along * (1 + random.uniform(-4, 4) * y)], axis=1)
    surface = Surface(y, rows, (20e-3 * np.sqrt(ratio), 5 * b))
    # the box from a coarse grid with some room, then from a finer one
    for margin in (1.15, 1.0):
        shift, half = contact_box(surface, force)
        size = (margin * half[0], margin * half[1])
        surface = moved(Surface(surface.y, surface.rows, size), shift)
    batch = Batch(
        name=f"surface {index}",
        shape=surface,
        normal_force=np.array([force]),
        creepage=np.zeros((1, 2)),
        spin=np.zeros(1),
    )
    return with_motion(batch, random, steps)


def random_position(random: np.random.Generator, index: int, steps: int = STEPS) -> Batch:
    """A wheel on a rail or roller, with parts of the motion that it has there and random ones."""
    batch = random_patch(random, index)
    other = with_motion(batch, random, steps)
    own = (random.random(steps) < OWN)[:, None]
    part = 10 ** random.uniform(-1.5, 0.3, steps)[:, None]
    return replace(
        other,
        direction=batch.direction,
        creepage=np.where(own, part * batch.creepage, other.creepage),
        spin=np.where(own, part * batch.spin[:, None], other.spin[:, None])[:, 0],
    )


def fine_truth(batch: Batch, overrides: Mapping[str, Any]) -> Floats:
    """[n, 4] of the batch, extrapolated; NaN where it does not converge."""
    a, b = batch.shape.semi_axes(batch.normal_force)[0]
    found = []
    fine_grids = FINE_ELLIPSE if batch.exact_pressure else FINE
    for scale, elements in fine_grids:
        fine: dict[str, Any] = {
            "grid": {"fitted": list(fitted_size(scale, float(a / b)))},
            "method": {"tolerance": 1e-6, "max_iterations": 40},
        }
        if batch.exact_pressure:
            fine["method"]["normal"] = "hertz"
        contact = contact_of(batch, merged(fine, overrides), elements)
        inputs = batch.inputs()
        steps = steps_of(batch, contact.time_steps(inputs, [False] * len(inputs), 1)[1])
        values = np.column_stack([steps.force, steps.moment, steps.pressure])
        values[~steps.good] = np.nan
        found.append(values)
    growth = (fine_grids[1][0] / fine_grids[0][0]) ** ORDER
    truth = found[1] + (found[1] - found[0]) / (growth - 1)
    if not batch.exact_pressure:
        truth[:, 3] = fine_pressure(batch)
    return truth


def fine_pressure(batch: Batch) -> float:
    """Greatest pressure over its scale; near kinks it scatters from grid to grid."""
    step = batch.take(np.array([0]))
    overrides = {"friction": None, "method": {"tangential": "none", "tolerance": 1e-7}}
    results = [contact_of(step, overrides, n).step(step.inputs()[0]) for n in PRESSURE]
    return float(np.mean(steps_of(batch.take(np.zeros(len(PRESSURE), int)), results).pressure))


def problems(
    seed: int,
    mapping: Callable[..., Iterable[Problem]] = map,
    part: float = 1.0,
    steps: int = STEPS,
) -> list[Problem]:
    """Random ones with their truth. mapping: as map, perhaps in several processes."""
    found = list(mapping(with_truth, unsolved(seed, part, steps)))
    return [replace(p, number=number) for number, p in enumerate(found)]


def with_truth(problem: Problem) -> Problem:
    """The problem with its truth, where it has none."""
    if problem.truth.size:
        return problem
    return replace(problem, truth=fine_truth(problem.batch, problem.overrides))


def unsolved(seed: int, part: float = 1.0, steps: int = STEPS) -> Iterator[Problem]:
    """Random problems without their truth. part: of the numbers above. steps: motions of each."""
    random, none = np.random.default_rng(seed), np.empty((0, 4))
    for index in range(round(part * SHAPES)):
        batch, material = random_ellipse(random, index, steps)
        yield Problem(batch, none, material, "random")
    for index in range(round(part * SURFACES)):
        yield Problem(random_surface(random, index, steps), none, {}, "surface")
    for index in range(round(part * POSITIONS)):
        yield Problem(random_position(random, index, steps), none, {}, "position")


def other_problems(names: str = "ABCD") -> Iterator[Problem]:
    """Sets of the benchmark, to test it on."""
    truth = TruthFile()
    for name in names:
        for index, batch in enumerate(batches_of(name)):
            assert isinstance(batch, Batch)
            yield Problem(batch, truth.of(name, index).values, {}, name)


def measured(problem: Problem, overrides: dict[str, Any]) -> Samples:
    """Errors and features of one method."""
    own = dict(overrides)
    elements = own.pop("elements")
    batch = problem.batch
    if own.get("method", {}).get("normal") in ("kik_piotrowski", "analyn"):
        own.update(room(batch, elements))
    contact = contact_of(batch, merged(own, problem.overrides), elements)
    results, features = [], []
    for values in batch.inputs():
        results.append(contact.step(values))
        # without an estimate there are none, and the result is left out below
        found = contact.field(1, 0, "error_features")
        features.append(np.full(FEATURES, np.nan) if found is None else found)
    return compared(batch, results, np.array(features), problem)


def compared(
    batch: Batch, results: list[dict[str, Any]], features: Floats, problem: Problem
) -> Samples:
    """The errors of results that have an estimate."""
    steps, patches = steps_of(batch, results), [r["right"]["patches"][0] for r in results]
    estimate = np.array([list(patch["error_estimate"].values()) for patch in patches])
    pressure = np.array([patch["max_pressure"] for patch in patches])
    # c of the core: of the ellipse with the contact's area
    length = np.sqrt(np.array([patch["contact_area"] for patch in patches]) / np.pi)
    unit = batch.scales()
    ratio = unit.length / length
    truth = problem.truth
    errors = np.column_stack(
        [
            np.hypot(*(steps.force - truth[:, :2]).T),
            np.abs(steps.moment - truth[:, 2]) * ratio,
            np.abs(steps.pressure / truth[:, 3] - 1),
        ]
    )
    scale = np.stack([unit.force, unit.force * length, pressure], axis=1)
    good = np.isfinite(errors).all(axis=1) & np.isfinite(estimate).all(axis=1)
    source = np.full(len(batch), SOURCES.index(problem.source))
    case, ratio = np.full(len(batch), problem.number), np.full(len(batch), problem.axis_ratio)
    return Samples(features, errors, estimate / scale, source, case, ratio).part(good)
