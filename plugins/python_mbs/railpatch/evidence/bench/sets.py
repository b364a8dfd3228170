"""The sets of problems that every method is measured on."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from railpatch.evidence.bench.problems import FRICTION, Batch
from railpatch.evidence.bench.shapes import POISSON_RATIO, SHEAR_MODULUS, Ellipse, Floats, Quadratic
from railpatch.evidence.bench.surfaces import stored_patches
from railpatch.evidence.bench.wheels import WheelRun, random_run

SEED = 20261121
FORCE = 82e3  # N
# a/b -> semi-axis a (m), and Kalker's C11, C22, C23 at nu = 0, 1/4, 1/2 (Kalker 1990, table E3)
ELLIPSES = {
    0.2: (4e-3, (2.59, 3.37, 4.81), (2.59, 2.63, 2.66), (0.483, 0.603, 0.809)),
    0.5: (6e-3, (2.88, 3.62, 4.83), (2.88, 3.01, 3.14), (0.827, 0.929, 1.07)),
    1.0: (9e-3, (3.40, 4.12, 5.20), (3.40, 3.67, 3.98), (1.33, 1.47, 1.63)),
    2.0: (12e-3, (4.37, 5.10, 6.11), (4.37, 4.90, 5.56), (2.35, 2.62, 2.96)),
    5.0: (20e-3, (6.96, 7.78, 8.82), (6.96, 8.14, 9.79), (5.72, 6.63, 7.89)),
}
SPINS = (0.0, 0.5, 1.0, 2.0)
DIRECTIONS = np.radians(np.arange(-90, 91, 30))
MAGNITUDES = (
    0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.7, 0.9, 1.1, 1.4, 1.7, 2, 2.5, 3, 3.5, 4, 5, 6, 7, 8, 9, 10, 12,
)  # fmt: skip
# flexibility of a third-body layer: that of the NRC rig's model, and that of the EuroSprinter's
LAYERS = {"0.05 mm": (8.2e9, 5e-5), "1.25 mm": (8.2e9, 1.25e-3)}
SEQUENCE_STEPS = 60
WHEEL_RUNS, WHEEL_STEPS = 2, 20


AnyBatch = Batch | WheelRun


@dataclass(frozen=True)
class ProblemSet:
    """A named set. whole: makes its batches. quick: steps that --quick takes."""

    name: str
    title: str
    whole: Callable[[], Sequence[AnyBatch]]
    quick: int


def units(ratio: float) -> tuple[Ellipse, Floats, float]:
    """Ellipse with units of creepage [2] and spin (rad/m) at which the linear theory saturates.

    Creepage: mu F / (G c^2 C_jj); spin: mu F / (G c^3 C_23); c^2 = a b.
    """
    a, *columns = ELLIPSES[ratio]
    ellipse = Ellipse(a, a / ratio)
    c = np.sqrt(ellipse.a * ellipse.b)
    # parabola through the values at nu = 0, 1/4, 1/2
    c11, c22, c23 = (
        np.polyval(np.polyfit((0, 0.25, 0.5), column, 2), POISSON_RATIO) for column in columns
    )
    force = FRICTION * FORCE / (SHEAR_MODULUS * c**2)
    return ellipse, force / np.array([c11, c22]), float(force / (c * c23))


def hertz_batch(
    ratio: float,
    spins: Sequence[float],
    directions: Floats,
    magnitudes: Sequence[float],
    layer: str | None = None,
) -> Batch:
    """Every combination, the magnitude of creepage running fastest, then its direction."""
    ellipse, creepage_unit, spin_unit = units(ratio)
    spin, direction, magnitude = (
        values.ravel() for values in np.meshgrid(spins, directions, magnitudes, indexing="ij")
    )
    creepage = magnitude * np.array([np.cos(direction), np.sin(direction)])
    return Batch(
        name=f"a/b = {ratio:g}" + (f", layer {layer}" if layer else ""),
        shape=ellipse,
        normal_force=np.full(len(spin), FORCE),
        creepage=creepage.T * creepage_unit,
        spin=spin * spin_unit,
        layer=LAYERS[layer] if layer else None,
    )


def hertzian() -> list[Batch]:
    """3220 Hertzian patches: all combinations of the tables above."""
    return [hertz_batch(ratio, SPINS, DIRECTIONS, MAGNITUDES) for ratio in ELLIPSES]


def layered() -> list[Batch]:
    """144 Hertzian patches with an elastic third-body layer."""
    return [
        hertz_batch(ratio, (0.0, 1.0), DIRECTIONS[[3, 4, 6]], (0.3, 1.0, 2.0, 5.0), layer)
        for ratio in (0.5, 1.0, 2.0)
        for layer in LAYERS
    ]


def sequences() -> list[Batch]:
    """Random walks of creepage, spin and load, each step by 0.1 to 10 %; the size of the contact
    follows the load."""
    return [
        random_walk(ratio, np.random.default_rng([SEED, index]))
        for index, ratio in enumerate((0.5, 1.0, 1.0, 2.0))
    ]


def random_walk(ratio: float, random: np.random.Generator) -> Batch:
    """One sequence, from a creepage near saturation."""
    ellipse, creepage_unit, spin_unit = units(ratio)
    state = np.array([*random.uniform(-1, 1, 3), 0.0])  # scaled creepages and spin, log of the load
    rows = []
    for size in 10 ** random.uniform(-3, -1, SEQUENCE_STEPS):
        rows.append(state.copy())
        step = random.standard_normal(4)
        state += size * step / np.linalg.norm(step)
    xi, eta, spin, load = np.array(rows).T
    return Batch(
        name=f"walk {int(1e6 * random.random()):06d}, a/b = {ratio:g}",
        shape=Quadratic(ellipse.a, ellipse.b, FORCE),
        normal_force=FORCE * np.exp(load),
        creepage=np.stack([xi, eta], axis=1) * creepage_unit,
        spin=spin * spin_unit,
        ordered=True,
    )


def wheel_runs() -> list[WheelRun]:
    """Random walks of a wheel on its rail, near the positions of the Manchester benchmark."""
    return [
        random_run(f"wheel {index + 1}", WHEEL_STEPS, np.random.default_rng([SEED, 10 + index]))
        for index in range(WHEEL_RUNS)
    ]


SETS = {
    "A": ProblemSet("A", "Hertzian patches", hertzian, 240),
    "B": ProblemSet("B", "non-elliptic patches", stored_patches, 16),
    "C": ProblemSet("C", "sequences as in a simulation", sequences, 120),
    "D": ProblemSet("D", "with an elastic layer", layered, 36),
    "W": ProblemSet("W", "a wheel on its rail, as in a simulation", wheel_runs, 40),
}


def sample(batches: Sequence[AnyBatch], count: int) -> list[tuple[AnyBatch, NDArray[np.int64]]]:
    """Batches with the indices of at most so many of all their steps.

    The choice depends on the seed alone; of ordered steps the first ones are taken.
    """
    total = sum(map(len, batches))
    if count >= total:
        return [(batch, np.arange(len(batch))) for batch in batches]
    if batches[0].ordered:
        shares = [np.arange(-(-count // len(batches)))] * len(batches)
        return [(b, share[: len(b)]) for b, share in zip(batches, shares, strict=True)]
    chosen = np.sort(np.random.default_rng(SEED).permutation(total)[:count])
    first, found = 0, []
    for batch in batches:
        inside = chosen[(chosen >= first) & (chosen < first + len(batch))] - first
        if inside.size:
            found.append((batch, inside))
        first += len(batch)
    return found
