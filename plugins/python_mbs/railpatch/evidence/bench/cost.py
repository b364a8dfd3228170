"""Run times beside the sets: over the grid's size, of the normal problem, of a rig's wheels."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from railpatch import _core
from railpatch.case.load import load_scene
from railpatch.case.moving import changed_case
from railpatch.case.to_core import config_of, input_of
from railpatch.evidence.bench.measure import time_apart
from railpatch.evidence.bench.methods import Method
from railpatch.evidence.bench.problems import merged
from railpatch.evidence.bench.sets import FORCE, MAGNITUDES, hertz_batch, units
from railpatch.evidence.bench.shapes import Floats, Quadratic

SIZES = (16, 20, 24, 32, 40, 48, 64, 80, 96, 128)
QUICK_SIZES = (16, 24, 32, 48, 64)
NORMAL_SIZE = 32
WARM_LOAD = 1.01  # change of the load between two warm steps of the normal problem
LEAST_TIME = 0.5  # s, spent on each size at least, for a median that holds
MOST_PASSES = 25
RIG_POSITIONS = 73


@dataclass(frozen=True)
class SizeCost:
    """Cost of a method on one grid. elements: in contact. cold, warm: s, medians."""

    method: Method
    across: int
    elements: int
    cold: float
    warm: float


@dataclass(frozen=True)
class WheelCost:
    """A rig's wheelset through a run. scene: file. wheel: s, of one wheel, warm, median.
    position: s, of finding a balanced position, median."""

    scene: str
    wheel: float
    position: float


def size_cost(method: Method, across: int) -> SizeCost:
    """Median over four partial slips of a circular contact, spin and direction mixed."""
    middle = [MAGNITUDES[i] for i in (5, 10)]
    batch = hertz_batch(1.0, (0.0, 1.0), np.radians([30.0]), middle)
    contact = method.contact(batch, across)
    begin = time.perf_counter()
    timed = time_apart(contact, batch, 1)
    once = time.perf_counter() - begin
    timed = time_apart(contact, batch, passes(once))
    counts = [r["right"]["patches"][0]["elements"] for r in timed.cold_results]
    return SizeCost(
        method=method,
        across=across,
        elements=int(np.median([sum(count[1:]) for count in counts])),
        cold=float(np.median(timed.cold)),
        warm=float(np.median(timed.warm)),
    )


def passes(once: float) -> int:
    """How often to repeat what takes so long."""
    return int(np.clip(LEAST_TIME / max(once, 1e-9), 1, MOST_PASSES))


def normal_cost() -> tuple[float, float]:
    """s, the normal problem alone at 32 across: cold, and warm with the load changed by 1 %.

    The elements keep their size, so the contact's edge moves over them.
    """
    ellipse, _, _ = units(1.0)
    tables = Quadratic(ellipse.a, ellipse.b, FORCE).tables(NORMAL_SIZE)
    size = [2 * ellipse.a / NORMAL_SIZE, 2 * ellipse.b / NORMAL_SIZE]
    case = merged(
        {"kind": "patch", "load": {"normal_force": FORCE}, **tables},
        {"grid": {"elements": None, "element_size": size}, "method": {"tangential": "none"}},
    )
    contact = _core.Contact(config_of(load_scene(case)), False)
    inputs = [{"normal_force": force} for force in (FORCE, WARM_LOAD * FORCE, FORCE)]
    seconds, _ = contact.time_steps(inputs, [True, False, False], 2 * MOST_PASSES)
    return float(np.median(seconds[:, 0])), float(np.median(seconds[:, 1:]))


def wheel_cost(positions: int, progress: Callable[[Any], None] = lambda _: None) -> WheelCost:
    """The roller rig's run, with NRC's measured profiles."""
    from rig_model.balance import Balancer
    from rig_model.scene import default_scene, load_rig_scene

    scene = load_rig_scene(default_scene(), {"positions": positions})
    balancer, states, searches = Balancer(scene), [], []
    for position in scene.positions():
        begin = time.perf_counter()
        balance = balancer.solve(position)
        searches.append(time.perf_counter() - begin)
        states.append(
            {
                "y": position.y,
                "yaw": position.yaw,
                "z": balance.z,
                "roll": balance.roll,
                "pitch_rate": balance.pitch_rate,
            }
        )
        progress(position)
    fixed = scene.at_height()
    contact = _core.Contact(config_of(fixed), False)
    inputs = [input_of(changed_case(fixed.case, state)) for state in states]
    seconds, _ = contact.time_steps(inputs, [False] * len(inputs), 3)
    later = np.median(seconds, axis=0)[1:]
    return WheelCost(
        scene=Path(scene.name).stem,
        wheel=float(np.median(later)) / 2,
        position=float(np.median(searches[1:])),
    )


def growth_points(costs: list[SizeCost]) -> tuple[Floats, Floats, Floats]:
    """Elements in contact, cold and warm times of one method."""
    return (
        np.array([c.elements for c in costs], dtype=float),
        np.array([c.cold for c in costs]),
        np.array([c.warm for c in costs]),
    )
