"""The model of the core's error estimates, fitted to measured errors.

``python -m railpatch.evidence.bench.calibrate -o core/patch/error_model.inc`` makes the file
again in minutes and prints how often the estimate covers the error, and how often it is within a
factor 4 of it, on the cases it was fitted to and on others.

The model (core/patch/error_estimate.hpp) is a network of one hidden layer for the logarithm
of the error. It is fitted so that the estimate lies between the error and 4 times the error: beyond
either end the loss grows linearly with the logarithm, steeper where the estimate is too small. Then
it is moved by a constant for each theory of the normal problem until it covers the share wanted of
the cases of other contacts: by the mean of what two ranges of axis ratios need. What is printed is
of contacts that had no part in either, by their axis ratios, and of the benchmark's.
"""

from __future__ import annotations

import argparse
import textwrap
from collections.abc import Iterable, Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from itertools import chain
from pathlib import Path
from typing import Any

import numpy as np
from scipy.optimize import minimize

from railpatch.case.theories import FAST
from railpatch.evidence.bench import pressures
from railpatch.evidence.bench.samples import (
    FAMILIES,
    NORMALS,
    PASSES,
    SEED,
    SOURCES,
    Family,
    Problem,
    Samples,
    joined,
    measured,
    other_problems,
    problems,
)
from railpatch.evidence.bench.shapes import Floats
from railpatch.evidence.bench.statistics import FACTOR, NOISE

FIRST_NORMAL = 7  # feature that tells the first of NORMALS but Hertz
GEOMETRY = 12  # features of the contact area and the grid; the others are of the motion
COVERED = 0.95  # share of the cases by which a network is moved
FEW = 60  # cases of a theory of the normal problem, below which it is moved with all others
# the seeds of contacts to move networks by and of those to test them on, after that of the contacts
# they are fitted to; how many of both, of the numbers of random problems, and motions of each
MOVED_BY, TESTED_ON = 3, 7
PART, MOTIONS = 3.0, 5
RATIOS = ((0.1, 10.0), (0.2, 5.0))  # a/b of what is told
TOO_SMALL, MARGIN = 8.0, 0.15  # steepness of the loss below, and distance from both its ends
PRESSURE_UNITS = 14
PENALTY = 1e-4  # on the squares of all weights; of networks with few units ten times that
FEW_UNITS = 8
MOST = 12000  # cases that one network is fitted to
LEAST_PRESSURE = 1e-4  # relative; errors below it are of the truth


@dataclass(frozen=True)
class Network:
    """w0, then of each unit w, v0 and v. offsets: by normal theory."""

    values: Floats
    inputs: int
    offsets: tuple[float, ...] = (0.0,) * len(NORMALS)

    @property
    def units(self) -> int:
        """Hidden ones."""
        return (len(self.values) - 1) // (self.inputs + 2)

    def in_lanes(self) -> Floats:
        """As in the core: w0, then of all units w, v0 and each part of v."""
        rows = self.values[1:].reshape(self.units, -1)
        return np.concatenate([self.values[:1], rows.T.ravel()])

    def at(self, features: Floats) -> Floats:
        """[n] of features [n, inputs]."""
        rows = self.values[1:].reshape(self.units, -1)
        t = rows[:, 1] + features @ rows[:, 2:].T
        offset = np.array(self.offsets)[normal_of(features)]
        return self.values[0] + offset + (t / (1 + np.abs(t))) @ rows[:, 0]


def normal_of(features: Floats) -> Any:
    """[n], index in NORMALS, by the features that tell it."""
    told = features[:, FIRST_NORMAL : FIRST_NORMAL + len(NORMALS) - 1] > 0.5
    return np.where(told.any(axis=1), 1 + told.argmax(axis=1), 0)


def loss(
    values: Floats, features: Floats, target: Floats, width: float, penalty: float
) -> tuple[float, Floats]:
    """Of a network on standardised features, and its gradient."""
    rows = values[1:].reshape(-1, features.shape[1] + 2)
    t = rows[:, 1] + features @ rows[:, 2:].T
    size = 1 + np.abs(t)
    hidden = t / size
    excess = values[0] + hidden @ rows[:, 0] - target
    # hinges, rounded over the width
    low, high = MARGIN - excess, excess - (np.log(FACTOR) - MARGIN)
    ends = [np.sqrt(end * end + width * width) for end in (low, high)]
    total = (TOO_SMALL * (low + ends[0]) + high + ends[1]).mean() / 2
    slope = (-TOO_SMALL * (1 + low / ends[0]) + 1 + high / ends[1]) / (2 * len(target))
    inner = slope[:, None] * rows[:, 0] / size**2
    gradient = np.empty_like(rows)
    gradient[:, 0] = slope @ hidden
    gradient[:, 1] = inner.sum(axis=0)
    gradient[:, 2:] = inner.T @ features
    whole = np.concatenate([[slope.sum()], gradient.ravel()])
    whole[1:] += 2 * penalty * values[1:]
    return total + penalty * float(values[1:] @ values[1:]), whole


def fitted_network(features: Floats, target: Floats, units: int, seed: int) -> Network:
    """The network for the logarithm of errors."""
    random = np.random.default_rng(seed)
    if len(target) > MOST:
        chosen = random.choice(len(target), MOST, replace=False)
        features, target = features[chosen], target[chosen]
    mean, spread = features.mean(axis=0), features.std(axis=0)
    used = spread > 1e-9
    spread = np.where(used, spread, 1.0)
    standard = np.where(used, (features - mean) / spread, 0.0)
    count = features.shape[1]
    start = 0.5 * random.standard_normal((units, count + 2))
    start[:, 0] *= 0.2
    values = np.concatenate([[target.mean() + 0.5], start.ravel()])
    penalty = PENALTY * (10 if units < FEW_UNITS else 1)
    for width, steps in ((0.5, 150), (0.1, 300)):
        values = minimize(
            loss,
            values,
            args=(standard, target, width, penalty),
            jac=True,
            method="L-BFGS-B",
            options={"maxiter": steps, "maxfun": 2 * steps},
        ).x
    rows = values[1:].reshape(units, -1).copy()
    rows[:, 2:] = np.where(used, rows[:, 2:] / spread, 0.0)
    rows[:, 1] -= rows[:, 2:] @ mean
    return Network(np.concatenate([values[:1], rows.ravel()]), count)


def shares(features: Floats) -> Floats:
    """s of the core, the sum of scaled creepage and spin."""
    return np.expm1(features[:, GEOMETRY]) + np.expm1(features[:, GEOMETRY + 1])


def estimate_of(
    network: Network, samples: Samples, which: int, stated: tuple[float, ...]
) -> Floats:
    """The core's estimate of force (0), moment (1) or pressure (2), relative."""
    if which == 2:
        return np.exp(network.at(samples.features[:, :GEOMETRY]))
    s = shares(samples.features)
    unit = stated[which] * s / (1 + s)
    return np.maximum(NOISE * np.minimum(1, s), unit * np.exp(network.at(samples.features)))


def targets(samples: Samples, which: int, stated: tuple[float, ...]) -> tuple[Any, Any, Any, Any]:
    """Of one error: features, error, what the model is a factor of, and what is too small to
    count. Cases without motion are left out."""
    error = samples.errors[:, which]
    if which == 2:
        return samples.features[:, :GEOMETRY], error, np.ones(len(error)), LEAST_PRESSURE
    s = shares(samples.features)
    some = s > 1e-9
    s = s[some]
    return (
        samples.features[some],
        error[some],
        stated[which] * s / (1 + s),
        NOISE * np.minimum(1, s),
    )


def network_of(
    own: Samples, other: Samples, which: int, stated: tuple[float, ...], units: int
) -> Network:
    """The model of one error: fitted to the first, moved by the second."""
    features, error, unit, least = targets(own, which, stated)
    target = np.log(np.maximum(error, 0.7 * least) / unit)
    network = fitted_network(features, target, units, which)
    moves = []
    for low, high in RATIOS:
        within = (other.ratio >= low * 0.999) & (other.ratio <= high * 1.001)
        features, error, unit, least = targets(other.part(within), which, stated)
        missing = np.log(np.maximum(error, 1e-300) / unit) - network.at(features)
        # the floor covers what is below it
        missing = np.where(error <= least, -np.inf, missing)
        normal = normal_of(features)
        move = []
        for index in range(len(NORMALS)):
            group = normal == index
            chosen = group if group.sum() >= FEW else np.ones_like(group)
            move.append(float(np.quantile(missing[chosen], COVERED, method="higher")))
        moves.append(move)
    # between what the ranges of axis ratios ask for
    offsets = tuple(float(each) for each in np.mean(moves, axis=0))
    return Network(network.values, network.inputs, offsets)


def coverage(estimate: Floats, error: Floats) -> str:
    """Shares in per cent: error below the estimate, estimate within the factor."""
    within = estimate <= FACTOR * np.maximum(error, NOISE)
    return f"{100 * (error <= estimate * (1 + 1e-9)).mean():5.1f} {100 * within.mean():5.1f}"


def report(
    name: str,
    networks: list[Network],
    samples: Samples,
    which: tuple[int, ...],
    stated: tuple[float, ...],
) -> list[str]:
    """Shares by theory of the normal problem and axis ratio, of random contacts; of the sets of the
    benchmark by set. One line each."""
    random = samples.source < SOURCES.index("A")
    normal = normal_of(samples.features)
    groups = [
        (f"{NORMALS[index]}, a/b {low:g} to {high:g}", random & (normal == index) & within)
        for index in range(len(NORMALS))
        for low, high in RATIOS
        for within in [(samples.ratio >= low * 0.999) & (samples.ratio <= high * 1.001)]
    ]
    groups += [
        (f"set {source}", samples.source == index)
        for index, source in enumerate(SOURCES)
        if source in "ABCD"
    ]
    lines = []
    for title, chosen in groups:
        part = samples.part(chosen)
        if not len(part.errors):
            continue
        found = [
            coverage(estimate_of(network, part, k, stated), part.errors[:, k])
            for network, k in zip(networks, which, strict=True)
        ]
        lines.append(f"{name:20} {title:28} {len(part.errors):6}: " + " | ".join(found))
    return lines


def spelled(values: Iterable[float]) -> str:
    """Numbers of a list in C++."""
    return ", ".join(f"{value:.5g}" for value in values)


def spell(models: list[Model]) -> str:
    """The C++ source of the models."""
    lines = [
        "// Generated by python -m railpatch.evidence.bench.calibrate; do not edit.",
        "// Networks of error_estimate.hpp: w0, of all units w, v0, and v by input; those of",
        "// creep force and spin moment, or of the greatest pressure. Offsets last.",
    ]
    for model in models:
        lines.append(f"// {model.name}: {model.cases} cases")
        for index, network in enumerate(model.networks):
            text = spelled(network.in_lanes())
            lines.append(f"constexpr double {model.name}_values_{index}[] = {{")
            lines += textwrap.wrap(text, 96, initial_indent="    ", subsequent_indent="    ")
            lines.append("};")
        parts = [
            f"{{{model.name}_values_{i}, {n.inputs}, {n.units}, {{{spelled(n.offsets)}}}}}"
            for i, n in enumerate(model.networks)
        ]
        lines.append(f"constexpr network {model.name}_errors[] = {{{', '.join(parts)}}};")
    lines += ["constexpr struct {", "  rp_tangential_method method;", "  const network *errors;"]
    lines.append("} fast_errors[] = {")
    fast = [model.name for model in models if model.name in FAST]
    lines += [f"    {{RP_TANGENTIAL_{name.upper()}, {name}_errors}}," for name in fast]
    return "\n".join([*lines, "};", ""])


def samples_of(
    family: Family, problems: list[Problem], seed: int, *, every: bool = False
) -> Samples:
    """Cases of a family. every: of all theories of the normal problem, one pass over all."""
    random = np.random.default_rng([seed, FAMILIES.index(family)])
    return joined(
        [
            measured(problem, overrides)
            for problem in problems
            for _ in range(1 if every else PASSES[problem.source])
            for overrides in family.choices(problem, random, every=every)
        ]
    )


@dataclass(frozen=True)
class Model:
    """Networks of one theory, with the number of cases and lines that tell how well they do."""

    name: str
    networks: list[Network]
    cases: int
    lines: list[str]


def modelled(
    name: str,
    parts: tuple[Samples, Samples, Samples],
    which: tuple[int, ...],
    units: int,
    stated: tuple[float, ...] = (1.0, 1.0),
) -> Model:
    """Fitted to the first, moved by the second and told of the third."""
    own, other, test = parts
    networks = [network_of(own, other, k, stated, units) for k in which]
    return Model(name, networks, len(own.errors), report(name, networks, test, which, stated))


def of_family(family: Family, parts: list[list[Problem]], seed: int) -> Model:
    """The model of creep force and spin moment."""
    fit, move, test = (
        samples_of(family, part, seed + k, every=k > 0) for k, part in enumerate(parts)
    )
    return modelled(family.name, (fit, move, test), (0, 1), family.units, family.stated)


def of_pressure(normal: str, parts: tuple[Samples, Samples, Samples]) -> Model:
    """The model of the greatest pressure."""
    return modelled(f"{normal}_pressure", parts, (2,), PRESSURE_UNITS)


def pressure_models(pool: ProcessPoolExecutor, seed: int) -> Iterator[Model]:
    """Those of all theories of the normal problem."""
    found = [
        list(pool.map(pressures.of_task, pressures.tasks(seed + k, part), chunksize=8))
        for k, part in ((0, 1.0), (MOVED_BY, PART), (TESTED_ON, PART))
    ]
    found[2] += [samples for name in "AB" for samples in pressures.of_benchmark(name)]
    parts = [
        tuple(
            joined([each[normal] for each in part if normal in each and len(each[normal].errors)])
            for part in found
        )
        for normal in NORMALS[1:]
    ]
    yield from pool.map(of_pressure, NORMALS[1:], parts)


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(
        prog="python -m railpatch.evidence.bench.calibrate", description=__doc__
    )
    parser.add_argument("-o", "--output", type=Path, required=True, help="C++ file to write")
    parser.add_argument("--seed", type=int, default=SEED, help="of the random problems")
    parser.add_argument("--jobs", type=int, default=1, help="processes")
    given = parser.parse_args()
    models: list[Model] = []
    with ProcessPoolExecutor(max_workers=given.jobs) as pool:
        parts = [
            problems(given.seed, pool.map),
            problems(given.seed + MOVED_BY, pool.map, PART, MOTIONS),
            [*problems(given.seed + TESTED_ON, pool.map, PART, MOTIONS), *other_problems()],
        ]
        count = len(FAMILIES)
        found = pool.map(of_family, FAMILIES, [parts] * count, [given.seed] * count)
        for model in chain(found, pressure_models(pool, given.seed)):
            models.append(model)
            print("\n".join(model.lines), flush=True)
    given.output.write_text(spell(models), encoding="ascii")


if __name__ == "__main__":
    main()
