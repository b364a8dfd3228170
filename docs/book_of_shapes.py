"""How far a table of the shapes of one pair of profiles serves another: docs/many_states.md.

    python docs/book_of_shapes.py [SHAPES [STATES]]

Shapes of random places of a pair, solved by the full theory as `railpatch table` does; random
states of the other pair, by them and by the full theory on finer rows. Errors of the creep force
over friction coefficient times normal force, in per cent: of all states, and of those whose shape
is nearest to one of the book. Takes about 2 s a shape and 0.05 s a state on one core.
"""

from __future__ import annotations

import sys
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from railpatch.evidence.table.pair import Pair, Ranges
from railpatch.evidence.table.pair_command import pair_case
from railpatch.evidence.table.shapes import FAR, STATES, Shapes, distance, tried

PAIRS = (("S1002", "UIC60@1:40"), ("worn@14", "worn@15"))
LEVELS = (0.5, 0.9, 0.95, 0.99)
NEAREST = (0.5, 0.75, 1.0)  # parts of the states
SEED = 20261124


def pair_of(profiles: tuple[str, str], seed: int) -> Pair:
    """A right wheel over the ranges of `railpatch table`."""
    return Pair(pair_case(*profiles), ".", Ranges(), seed, " on ".join(profiles))


def book_of(pair: Pair, count: int) -> Shapes:
    """Shapes of random places."""
    shapes = Shapes(pair, 1)
    while len(shapes) < count:
        shapes.add(pair.place())
    return shapes


def judged(book: Shapes, pair: Pair, states: int) -> tuple[np.ndarray, np.ndarray]:
    """Errors of the force of states of a pair, and the distance of each to the book's shapes."""
    book.pair = pair
    errors: list[float] = []
    distances: list[float] = []
    with TemporaryDirectory() as folder:
        table = Path(folder) / "book.bin"
        table.write_bytes(book.data(FAR, [1.0, 1.0], {}))
        while len(errors) < states:
            place = pair.place()
            found, _ = tried(book, place, table)
            errors += found.tolist()
            distances += [distance(book, place)] * len(found)
    return np.array(errors), np.array(distances)


def main() -> None:
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 300
    states = int(sys.argv[2]) if len(sys.argv) > 2 else 100 * STATES
    print("| shapes of | on states of | | median | 90 % | 95 % | 99 % |")
    print(7 * "|---" + "|")
    for own, other in (PAIRS, PAIRS[::-1]):
        book = book_of(pair_of(own, SEED), count)
        error, away = judged(book, pair_of(other, SEED + 1), states)
        for part in NEAREST:
            near = error[away <= np.quantile(away, part)]
            cells = " | ".join(f"{100 * level:.2f}" for level in np.quantile(near, LEVELS))
            print(
                f"| {book_name(own)} ({count}) | {book_name(other)} | nearest {part:.0%} "
                f"| {cells} |",
                flush=True,
            )


def book_name(profiles: tuple[str, str]) -> str:
    """Of a pair."""
    return ", ".join(profiles)


if __name__ == "__main__":
    main()
