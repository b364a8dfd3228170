"""One input of a wheel moved step by step, and the largest jump of its forces beyond their slope.

A sweep is solved at coarse steps, and again at fine ones wherever something happens: patches or
shares change, or the forces do what the slope on either side does not explain. Between neighbouring
samples i and i + 1, a distance h apart, the jump is

    |F[i+1] - F[i] - h (slope before i + slope after i + 1)/2|.

It is not divided by h, so at fine steps it is the jump within a micrometre, and at coarse ones,
where none is above the limit, a bound of it. A jump keeps its size when the step becomes smaller;
what is steep or bends sharply does not: so what is above the limit is looked at again at a tenth of
the fine step.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

import numpy as np

from railpatch.case.types import SIDES
from railpatch.contact import Contact

COMPONENTS = ("Fx", "Fy", "Fz", "Mx", "My", "Mz")
LIMIT = 0.2  # % of the wheel load per micrometre
CLOSER = 10  # how much smaller the steps are where the limit is exceeded
MARGIN = 2  # fine steps around what is looked at more closely


@dataclass(frozen=True)
class Path:
    """What moves: inputs of the case as a function of one number, in steps of ``unit``."""

    name: str
    changes: Callable[[float], dict[str, Any]]
    start: float
    stop: float
    coarse: float
    fine: float
    label: str = "y [mm]"
    scale: float = 1e3  # of the label's unit


@dataclass(frozen=True)
class Sample:
    """One solved position: forces in % of the wheel load, what the patches are, what went wrong."""

    at: float
    forces: np.ndarray  # [wheels, 6]; moments over the nominal radius
    shares: tuple[tuple[float, ...], ...]
    status: str

    def is_event(self, other: Sample) -> bool:
        """Whether patches change on the way to the other, or several divisions count."""
        mixed = any(share < 1 for wheel in self.shares + other.shares for share in wheel)
        return mixed or [len(w) for w in self.shares] != [len(w) for w in other.shares]


@dataclass
class Sweep:
    """The samples of a path in order, and what was found of jumps."""

    path: Path
    samples: list[Sample]
    closer: list[list[Sample]] = field(default_factory=list)

    @property
    def at(self) -> np.ndarray:
        """Positions."""
        return np.array([sample.at for sample in self.samples])

    @property
    def forces(self) -> np.ndarray:
        """% of the wheel load, [samples, wheels, 6]."""
        return np.array([sample.forces for sample in self.samples])

    @property
    def jumps(self) -> np.ndarray:
        """% of the wheel load, between samples i + 1 and i + 2: [samples - 3, wheels, 6]."""
        return jumps_of(self.samples)

    @property
    def worst(self) -> float:
        """% of the wheel load per fine step."""
        return float(self.jumps.max(initial=0.0))

    @property
    def remaining(self) -> float:
        """% of the wheel load: of the jumps above the limit what is left at smaller steps."""
        return max((float(jumps_of(part).max()) for part in self.closer), default=0.0)

    @property
    def jump(self) -> float:
        """% of the wheel load: the worst, or what is left of it at smaller steps."""
        return min(self.worst, self.remaining) if self.closer else self.worst

    @property
    def worst_at(self) -> tuple[float, str]:
        """Position and component of the worst."""
        index, _, component = np.unravel_index(int(self.jumps.argmax()), self.jumps.shape)
        return float(self.at[index + 1]), COMPONENTS[component]

    @property
    def bad(self) -> int:
        """Samples that are not solved."""
        return sum(sample.status not in ("converged", "no_contact") for sample in self.samples)

    @property
    def most_patches(self) -> int:
        """Most solutions of one wheel at once."""
        return max((len(w) for sample in self.samples for w in sample.shares), default=0)


def jumps_of(samples: list[Sample]) -> np.ndarray:
    """What the slopes on either side do not explain, between all inner neighbours."""
    if len(samples) < 4:
        return np.zeros((0, 1, 6))
    at = np.array([sample.at for sample in samples])
    forces = np.array([sample.forces for sample in samples])
    step = np.diff(at)[:, None, None]
    rise = np.diff(forces, axis=0)
    slope = rise / step
    return np.abs(rise[1:-1] - 0.5 * step[1:-1] * (slope[:-2] + slope[2:]))


class Measure:
    """Solves the positions of a path of one case."""

    def __init__(self, case: Mapping[str, Any], path: Path, load: float) -> None:
        self.contact = Contact(case)
        self.path = path
        self.sides = [side for side in SIDES if side in self.contact.case.sides]
        self.load = load / len(self.sides)
        self.radius = float(case["wheelset"]["nominal_radius"])

    def sample(self, at: float) -> Sample:
        """The forces at one position."""
        result = self.contact.step(**self.path.changes(at))
        wheels = [result[side] for side in self.sides] if len(self.sides) > 1 else [result]
        forces = [[*w["force"], *(m / self.radius for m in w["moment"])] for w in wheels]
        shares = tuple(tuple(p["share"] for p in w["patches"] + w["alternatives"]) for w in wheels)
        return Sample(at, 100 * np.array(forces) / self.load, shares, result.status)

    def samples(self, start: float, stop: float, step: float) -> list[Sample]:
        """Equal steps from start to stop."""
        count = round((stop - start) / step)
        return [self.sample(start + (stop - start) * i / count) for i in range(count + 1)]

    def sweep(self) -> Sweep:
        """Coarse steps, fine ones where something happens, smaller ones at jumps."""
        path = self.path
        coarse = self.samples(path.start, path.stop, path.coarse)
        jumps = jumps_of(coarse).max(axis=(1, 2))
        wanted = np.zeros(len(coarse) - 1, dtype=bool)
        wanted[1:-1] |= jumps > LIMIT
        wanted |= [a.is_event(b) for a, b in pairwise(coarse)]
        # what happens may end just beyond the interval
        wanted = np.convolve(wanted, [1, 1, 1], "same") > 0
        samples = [coarse[0]]
        for i, closely in enumerate(wanted):
            if closely:
                samples += self.samples(coarse[i].at, coarse[i + 1].at, path.fine)[1:]
            else:
                samples.append(coarse[i + 1])
        found = Sweep(path, samples)
        self.look_closer(found)
        return found

    def look_closer(self, found: Sweep) -> None:
        """Jumps above the limit at smaller steps, the worst ones first."""
        above = np.flatnonzero(found.jumps.max(axis=(1, 2)) > LIMIT) + 1
        worst = sorted(above, key=lambda i: -found.jumps[i - 1].max())[:20]
        step = found.path.fine / CLOSER
        margin = MARGIN * found.path.fine
        for i in worst:
            a, b = found.samples[i].at - margin, found.samples[i + 1].at + margin
            found.closer.append(self.samples(a, b, step))


def measure(case: Mapping[str, Any], path: Path, load: float | None = None) -> Sweep:
    """The sweep of one case along one path; load: N, of all wheels, where the case has none."""
    return Measure(case, path, float(load or case["wheelset"]["vertical_force"])).sweep()
