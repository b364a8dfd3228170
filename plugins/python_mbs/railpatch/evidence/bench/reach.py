"""What force error each method and grid reaches: the figures that ``accuracy`` chooses by.

``python -m railpatch.evidence.bench.reach [PROCESSES]`` prints the 95th percentile of the error
in creep force over friction coefficient times normal force, in per cent, on problems of
``railpatch.evidence.bench.samples``, which are not the benchmark's: random ellipses, random
shapes, and wheels at random positions; none with a layer. ``railpatch.case.choice`` holds the
greatest of each line, rounded up.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from typing import Any

import numpy as np

from railpatch.case.accuracy import fitted_size
from railpatch.case.choice import (
    FAST_ELEMENTS,
    NORMAL,
    RATIOS,
    ROWS_ON_ELLIPSE,
    ROWS_ON_PRESSURE,
)
from railpatch.case.theories import FAST
from railpatch.evidence.bench.samples import SEED, Problem, measured, problems
from railpatch.evidence.bench.statistics import percentile


def fitted(scale: int, problem: Problem, normal: str) -> dict[str, Any]:
    """Overrides of a case on fitted rows, as ``railpatch.case.choice`` makes them."""
    ratio = problem.axis_ratio if normal == "hertz" else 1.0
    size = fitted_size(scale, ratio)
    method = {"tangential": "full", "normal": normal}
    return {"elements": NORMAL * scale, "grid": {"fitted": list(size)}, "method": method}


def fast(tangential: str, normal: str) -> dict[str, Any]:
    """Overrides of a fast theory."""
    method = {"tangential": tangential, "normal": normal}
    return {"elements": FAST_ELEMENTS, "method": method}


def errors(
    every: list[Problem], choose: Any, ellipses: bool = False
) -> Iterator[tuple[str, float]]:
    """Source and percentile of the error of one choice."""
    sources = dict.fromkeys(problem.source for problem in every)
    low, high = RATIOS
    for source in sources:
        chosen = [p for p in every if p.source == source]
        if source == "random":
            chosen = [p for p in chosen if low <= p.axis_ratio <= high]
        if ellipses and not chosen[0].batch.exact_pressure:
            continue
        found = [measured(problem, choose(problem)).errors[:, 0] for problem in chosen]
        yield source, percentile(np.concatenate(found), 95)


def main(arguments: list[str]) -> None:
    """Prints one line for each method and grid."""
    with ProcessPoolExecutor(max_workers=int(arguments[0]) if arguments else 1) as pool:
        every = [p for p in problems(SEED + 1, pool.map) if p.batch.layer is None]
    lines: list[tuple[str, Any, bool]] = []
    for scale in ROWS_ON_ELLIPSE:
        lines.append((f"rows on ellipse, {scale}", lambda p, s=scale: fitted(s, p, "hertz"), True))
    for scale in ROWS_ON_PRESSURE:
        lines.append(
            (f"rows on pressure, {scale}", lambda p, s=scale: fitted(s, p, "half_space"), False)
        )
    for normal in ("kik_piotrowski", "analyn"):
        lines.append((f"rows on {normal}, 16", lambda p, n=normal: fitted(16, p, n), False))
    for name in (name for name in FAST if name != "table"):
        lines.append((name, lambda p, n=name: fast(n, "half_space"), False))
    lines.append(("table", lambda _: fast("table", "hertz"), True))
    for title, choose, ellipses in lines:
        cells = [f"{source} {100 * e:.3g}" for source, e in errors(every, choose, ellipses)]
        print(f"{title:24}", "  ".join(cells), flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
