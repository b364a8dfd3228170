"""What the points feel at all: Morris's elementary effects over the ranges of what is sought.

Each trajectory changes one parameter after the other by a step of a grid of four levels (Morris
1991, Technometrics 33, 161-174; designs by SALib). What moves are all measured numbers; the effect
is their rms change in standard deviations of theirs, scaled to the whole range.
"""

from __future__ import annotations

import numpy as np
from scipy.stats import chi2

from railpatch.match.fit import LEVEL, Search
from railpatch.match.found_parts import Screened

TRAJECTORIES = 6
LEVELS = 4


def screened(search: Search) -> dict[str, Screened]:
    """By key, the strongest first. Raises CaseError."""
    from SALib.sample import morris

    keys, table = search.model.keys, search.model.plan.table
    if len(keys) < 2:
        return {}
    problem = {"num_vars": len(keys), "names": list(keys), "bounds": [[0.0, 1.0]] * len(keys)}
    points = morris.sample(problem, TRAJECTORIES, num_levels=LEVELS, seed=1 + table.seed)
    points = points.reshape(TRAJECTORIES, len(keys) + 1, len(keys))
    effects: dict[str, list[float]] = {key: [] for key in keys}
    for trajectory in points:
        search.anew()
        numbers = [search.model.at(shares) for shares in trajectory]
        for k in range(len(keys)):
            step = trajectory[k + 1] - trajectory[k]
            moved = int(np.argmax(np.abs(step)))
            change = (numbers[k + 1] - numbers[k]) / search.first.error[:, None]
            change = change[search.there & np.isfinite(change)] / step[moved]
            if len(change):
                effects[keys[moved]].append(float(np.sqrt(np.mean(change**2))))
    least = float(np.sqrt(chi2.ppf(LEVEL, 1) / search.there.sum()))
    found = {
        key: Screened(float(np.mean(each)), float(np.std(each)), float(np.mean(each)) > least)
        for key, each in effects.items()
        if each
    }
    return dict(sorted(found.items(), key=lambda item: -item[1].effect))
