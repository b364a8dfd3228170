"""Jumps of a wheel's forces on worn profiles, by every normal theory: ``continuity --worn``.

A wheel under a prescribed load takes equally spaced lateral positions. Wherever a force differs
by more than LIMIT of friction times load between neighbours, the interval is halved towards the
greater change until the change is less, or the positions are CLOSE: then it is a jump. Each
position is solved from the state at the left end, as a step of a run would be. A jump is
announced where the result on one of its sides warns of other heights. Where several heights carry
the load a long step may end at another one than short steps do: the change then vanishes as the
interval is halved. Those are counted as `by step`.
"""

from __future__ import annotations

import csv
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from railpatch.contact import Contact
from railpatch.evidence.continuity.scenes import wheel_case

LOAD = 8e4  # N
LIMIT = 0.005  # of friction times load
CLOSE = 1e-10  # m
SPAN = (-4e-3, 13e-3)  # m, y of a right wheel: to where worn flanges touch
POSITIONS = 100
ANNOUNCED = "other heights"
THEORIES: dict[str, dict[str, Any]] = {
    name: {"method": {"normal": name}, "grid": {"elements": [10, 10]}}
    for name in ("hertz", "kik_piotrowski", "kik_piotrowski_corrected", "analyn", "half_space")
}
THEORIES["half_space, 0.5 mm"] = {"grid": {"element_size": [5e-4, 5e-4]}}
THEORIES["fitted 12 x 12"] = {"grid": {"element_size": [5e-4, 5e-4], "fitted": [12, 12]}}
HEAD = (
    "theory", "pairs", "positions", "jumps", "unannounced", "worst", "worst unannounced", "by step",
    "warned", "unsolved",
)  # fmt: skip


@dataclass(frozen=True)
class Sample:
    """One solved position. force: N, along and across the track; None: not solved."""

    y: float
    force: np.ndarray | None
    warned: bool


@dataclass(frozen=True)
class Jump:
    """Of one pair of profiles at y, m; size: of friction times load."""

    pair: int
    y: float
    size: float
    announced: bool


@dataclass
class Found:
    """What one theory did on all pairs."""

    theory: str
    pairs: int = 0
    positions: int = 0
    by_step: int = 0
    warned: int = 0
    unsolved: int = 0
    jumps: list[Jump] = field(default_factory=list)

    @property
    def unannounced(self) -> list[Jump]:
        """Jumps of which no side warns."""
        return [jump for jump in self.jumps if not jump.announced]

    def row(self) -> tuple[Any, ...]:
        """What HEAD names."""
        sizes = [max((j.size for j in jumps), default=0.0)
                 for jumps in (self.jumps, self.unannounced)]  # fmt: skip
        return (
            self.theory, self.pairs, self.positions, len(self.jumps), len(self.unannounced),
            *(f"{size:.4f}" for size in sizes), self.by_step, self.warned, self.unsolved,
        )  # fmt: skip


def worn_case(pair: int, theory: str) -> dict[str, Any]:
    """One wheel on a worn pair of profiles."""
    return {
        **wheel_case(LOAD),
        "profiles": {"wheel": f"worn@{2 * pair}", "rail": f"worn@{2 * pair + 1}"},
        **THEORIES[theory],
    }


class Walk:
    """Solves positions of one case, one after the other."""

    def __init__(self, case: dict[str, Any]) -> None:
        self.contact = Contact(case)
        self.limit = case["friction"]["coefficient"] * case["wheelset"]["vertical_force"]

    def sample(self, y: float) -> Sample:
        """Solved from the last position."""
        result = self.contact.step(y=y)
        solved = result.status == "converged"
        warned = any(ANNOUNCED in text for text in result.warnings)
        return Sample(y, np.array(result["force"][:2]) if solved else None, warned)

    def change(self, a: Sample, b: Sample) -> float:
        """Of friction times load; 0 next to what is not solved."""
        if a.force is None or b.force is None:
            return 0.0
        return float(np.abs(b.force - a.force).max() / self.limit)

    def closer(
        self, a: Sample, b: Sample, state: bytes, found: Found
    ) -> tuple[Sample, Sample] | None:
        """The ends of a jump between two positions, if there is one; state: of the contact at a."""
        while self.change(a, b) > LIMIT:
            if b.y - a.y <= CLOSE:
                return a, b
            self.contact.restore(state)
            middle = self.sample(0.5 * (a.y + b.y))
            if self.change(a, middle) > self.change(middle, b):
                b = middle
            else:
                a, state = middle, self.contact.save()
                far, b = b, self.sample(b.y)
                found.by_step += self.change(far, b) > LIMIT
        return None

    def jumps(self, positions: Iterable[float], found: Found) -> Iterator[tuple[Sample, Sample]]:
        """The ends of each jump on the way through positions."""
        last, state = None, b""
        for y in positions:
            sample = self.sample(y)
            after = self.contact.save()
            found.positions += 1
            found.warned += sample.warned
            found.unsolved += sample.force is None
            if last and self.change(last, sample) > LIMIT:
                ends = self.closer(last, sample, state, found)
                self.contact.restore(after)
                if ends:
                    yield ends
            last, state = sample, after


def worn_jumps(theory: str, pairs: int, positions: int = POSITIONS) -> Iterator[Found]:
    """After each pair what was found so far."""
    found = Found(theory)
    for pair in range(pairs):
        walk = Walk(worn_case(pair, theory))
        found.pairs += 1
        for left, right in walk.jumps(np.linspace(*SPAN, positions).tolist(), found):
            size, announced = walk.change(left, right), left.warned or right.warned
            found.jumps.append(Jump(pair, left.y, size, announced))
        yield found


def run_worn(pairs: int, advance: Callable[[Any], None]) -> Iterator[Found]:
    """All theories."""
    for theory in THEORIES:
        found = Found(theory)
        for found in worn_jumps(theory, pairs):
            advance(found)
        yield found


def write_worn(found: list[Found], folder: Path) -> list[Path]:
    """worn.csv, and each jump in worn_jumps.csv."""
    folder.mkdir(parents=True, exist_ok=True)
    jumps = [
        (one.theory, j.pair, repr(j.y), f"{j.size:.6f}", j.announced)
        for one in found
        for j in one.jumps
    ]
    tables = {
        "worn.csv": (HEAD, [one.row() for one in found]),
        "worn_jumps.csv": (("theory", "pair", "y", "size", "announced"), jumps),
    }
    for name, (head, rows) in tables.items():
        with (folder / name).open("w", newline="", encoding="utf-8") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(head)
            writer.writerows(rows)
    return [folder / name for name in tables]
