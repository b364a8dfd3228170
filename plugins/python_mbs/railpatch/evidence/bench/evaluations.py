"""What one wheel costs: contact search, an evaluation of its force, and all derivatives of that."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from railpatch import _core
from railpatch.case.load import load_scene
from railpatch.case.moving import changed_case
from railpatch.case.to_core import config_of, input_of
from railpatch.evidence.bench.problems import merged
from railpatch.evidence.bench.surfaces import MANCHESTER

LOAD = 8e4  # N
SPEED = 20.0  # m/s
STATE = {"y": 2e-3, "yaw": 2e-3, "speed": SPEED, "pitch_rate": -1.001 * SPEED / 0.46}
# what a warm evaluation is away from the last one: some micrometres, and creepages by 1 %
NEAR = {"y": 2.01e-3, "pitch_rate": -1.00101 * SPEED / 0.46}
PASSES, QUICK_PASSES = 41, 11
# grids, and the contact search alone: undeformed distances of few elements only
SEARCH_ELEMENTS = 2
GRIDS: tuple[tuple[str, dict[str, Any]], ...] = (
    ("20 elements across", {"elements": [20, 20]}),
    ("32 elements across", {"elements": [32, 32]}),
    ("40 elements across", {"elements": [40, 40]}),
    ("elements of 0.5 mm", {"element_size": [5e-4, 5e-4]}),
    ("elements of 0.2 mm", {"element_size": [2e-4, 2e-4]}),
)


@dataclass(frozen=True)
class Evaluation:
    """Cost of one wheel on a grid. evaluation: s, of a warm step at a new position with creepages
    1 % away, median. matrix: s, of the derivatives by pose and velocity, median. ratio: median of
    matrix over evaluation in the same pass. bytes: held for derivatives. good: all converged."""

    name: str
    evaluation: float
    matrix: float
    ratio: float
    bytes: int
    good: bool


def wheel_scene(grid: dict[str, Any], method: dict[str, Any]) -> dict[str, Any]:
    """A right wheel, S1002 on UIC60, with its load on one patch."""
    size = {"element_size": None, "elements": None, **grid}
    return merged(
        MANCHESTER, {"wheelset": STATE | {"vertical_force": LOAD}, "grid": size, "method": method}
    )


def height(grid: dict[str, Any]) -> float:
    """z at which the wheel carries its load, m."""
    scene = load_scene(wheel_scene(grid, {}))
    return float(_core.Contact(config_of(scene), False).step(input_of(scene.case))["z"])


def at_height(grid: dict[str, Any], method: dict[str, Any]) -> Any:
    """The scene with z prescribed."""
    fixed: dict[str, Any] = {"wheelset": {"vertical_force": None, "z": height(grid)}}
    if method.get("tangential") == "none":
        fixed["friction"] = None
    return load_scene(merged(wheel_scene(grid, method), fixed))


def search_time(quick: bool = False) -> float:
    """s, median: placement and contact search of one wheel, profiles sampled every 0.2 mm."""
    scene = at_height({"elements": [SEARCH_ELEMENTS] * 2}, {"tangential": "none"})
    contact = _core.Contact(config_of(scene), True)
    inputs = [input_of(scene.case), input_of(changed_case(scene.case, {"y": NEAR["y"]}))]
    seconds, before = [], 0.0
    for k in range(40 * (QUICK_PASSES if quick else PASSES)):
        contact.step(inputs[k % 2])
        spent = {stage["name"]: stage["seconds"] for stage in contact.describe()}["geometry"]
        seconds.append(spent - before)
        before = spent
    return float(np.median(seconds))


def evaluations(
    quick: bool = False, progress: Callable[[Any], None] = lambda _: None
) -> list[Evaluation]:
    """Force and derivatives on each grid."""
    found = [evaluation(name, grid, quick) for name, grid in GRIDS]
    progress(found)
    return found


def evaluation(name: str, grid: dict[str, Any], quick: bool) -> Evaluation:
    """Of one grid."""
    scene = at_height(grid, {"derivatives": True})
    contact = _core.Contact(config_of(scene), False)
    inputs = [input_of(scene.case), input_of(changed_case(scene.case, NEAR))]
    good = contact.step(inputs[1])["status"] == "converged"
    times = np.empty((QUICK_PASSES if quick else PASSES, 2))
    for k, one in enumerate(times):
        begin = time.perf_counter()
        result = contact.step(inputs[k % 2])
        middle = time.perf_counter()
        matrix = contact.jacobian()
        one[:] = middle - begin, time.perf_counter() - middle
        good = good and result["status"] == matrix["status"] == "converged"
    stages = {stage["name"]: stage["bytes"] for stage in contact.describe()}
    return Evaluation(
        name=name,
        evaluation=float(np.median(times[:, 0])),
        matrix=float(np.median(times[:, 1])),
        ratio=float(np.median(times[:, 1] / times[:, 0])),
        bytes=int(stages["derivatives"]),
        good=good,
    )
