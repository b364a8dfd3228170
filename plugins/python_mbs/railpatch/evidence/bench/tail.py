"""The slowest steps of a wheel that moves as in a simulation at 1 ms, from tread to lift-off.

A user in real time waits for the slowest step. Run times of a shared machine have a tail of their
own, so times are those of the processor, the same steps are made several times, from the same state
to the same bits, and of each the least time counts; what a step took in evaluations and operator
products is the same on every machine.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from railpatch import _core
from railpatch.case.load import load_scene
from railpatch.case.moving import changed_case
from railpatch.case.to_core import config_of, input_of
from railpatch.evidence.bench.problems import merged
from railpatch.evidence.bench.shapes import Floats
from railpatch.evidence.bench.surfaces import MANCHESTER

SEED = 16
STEPS, QUICK_STEPS = 20000, 300
AT_ONCE = 500  # steps whose results are held
REPEATS = 5  # times that each step is made; the least time is that of the step
LOAD = (
    8e4  # N, about which that prescribed wanders, and of the heights of which those prescribed do
)
SPEED = 20.0  # m/s
# m of lateral position, from the tread's field side to the flange; of steps at 1 ms: how far one
# moves usually, and the share of its speed that the next one keeps
ACROSS = (-6e-3, 6.5e-3)
SIDEWAYS, KEPT = 3e-5, 0.99
LOADS = (1e4, 1.5e5)  # N
# m, up from where the wheel carries its load: an eighth of the steps is without contact
LIFTS = (-4e-5, 1e-4)
YAW = 5e-3  # rad, most
SHARES = (50.0, 99.0, 99.99, 100.0)  # %, of steps that take at most as long
# bounds of the histogram, in medians; the last bin is open
BOUNDS = (0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 8.0)


def fastsim(normal: str) -> tuple[str, dict[str, Any]]:
    """A fast normal theory with FASTSIM on 10 x 10 elements."""
    name = {"hertz": "Hertz", "kik_piotrowski": "Kik-Piotrowski", "analyn": "ANALYN"}[normal]
    method = {"normal": normal, "tangential": "fastsim"}
    return f"{name} and FASTSIM", {"grid": {"elements": [10, 10]}, "method": method}


METHODS: tuple[tuple[str, dict[str, Any]], ...] = (
    (
        "Hertz and table",
        {"grid": {"elements": [8, 8]}, "method": {"normal": "hertz", "tangential": "table"}},
    ),
    *(fastsim(normal) for normal in ("hertz", "kik_piotrowski", "analyn")),
    ("half-space, full, 12 x 12", {"grid": {"elements": [12, 12]}}),
    ("half-space, fitted 8 x 8", {"grid": {"elements": [24, 24], "fitted": [8, 8]}}),
)


@dataclass(frozen=True, eq=False)
class Tail:
    """Steps of one method. prescribed: what is, "force" or "position". seconds: [n], of the
    processor, of a step: the least of the times that it was made.
    evaluations: [n], of the contact. work: [n], operator products of all of these, as
    method.max_work counts them. bad: steps that are neither converged nor without contact.
    lifted: steps without contact."""

    name: str
    prescribed: str
    seconds: Floats
    evaluations: Floats
    work: Floats
    bad: int
    lifted: int

    def row(self) -> dict[str, Any]:
        """Percentiles by SHARES of seconds, evaluations and work, as a line of a table."""
        found: dict[str, Any] = {"method": self.name, "prescribed": self.prescribed}
        found |= {"steps": len(self.seconds), "bad": self.bad, "lifted": self.lifted}
        for name in ("seconds", "evaluations", "work"):
            values = getattr(self, name)
            for share in SHARES:
                found[f"{name}_{share:g}"] = quantile(values, share)
        return found

    def histogram(self) -> list[int]:
        """Steps between BOUNDS, in medians of the seconds; the first below all, the last beyond."""
        edges = np.array([-np.inf, *BOUNDS, np.inf]) * quantile(self.seconds, 50.0)
        return [int(count) for count in np.histogram(self.seconds, edges)[0]]


def quantile(values: Floats, share: float) -> float:
    """The least of the values that so many per cent of all are not above."""
    return float(np.percentile(values, share, method="inverted_cdf"))


def folded(values: Floats, low: float, high: float) -> Floats:
    """What leaves the range is thrown back into it, as by mirrors at both ends."""
    width = high - low
    return low + width - np.abs((values - low) % (2 * width) - width)


@dataclass(frozen=True, eq=False)
class Walk:
    """Random walk of n steps: y (m), yaw (rad), load (N), lift (m); each [n]."""

    y: Floats
    yaw: Floats
    load: Floats
    lift: Floats


def random_walk(steps: int, seed: int = SEED) -> Walk:
    """Smooth in y, as a mass moves; rough in load, as over irregularities."""
    random = np.random.default_rng(seed)
    noise = random.standard_normal((4, steps))
    speed, y = 0.0, np.empty(steps)
    for k in range(steps):
        y[k] = (y[k - 1] if k else 0.0) + speed
        speed = KEPT * speed + SIDEWAYS * np.sqrt(1 - KEPT**2) * noise[0, k]
    load = LOAD * (1 + 0.03 * np.cumsum(noise[2]))
    return Walk(
        y=folded(y, *ACROSS),
        yaw=folded(2e-4 * np.cumsum(noise[1]), -YAW, YAW),
        load=folded(load, *LOADS),
        lift=folded(5e-6 * np.cumsum(noise[3]), *LIFTS),
    )


def moving_wheel(overrides: dict[str, Any], fixed: bool) -> Any:
    """A right wheel, S1002 on UIC60@1:40; fixed: z is prescribed, else the vertical force."""
    wheel: dict[str, Any] = {"speed": SPEED, "pitch_rate": -SPEED / 0.46}
    wheel |= {"vertical_force": None, "z": 0.0} if fixed else {"vertical_force": LOAD}
    own = {"wheelset": wheel, "grid": {"element_size": None}}
    return load_scene(merged(merged(MANCHESTER, own), overrides))


def heights(y: Floats) -> Floats:
    """z at which the wheel without yaw carries its load at each y, m."""
    scene = moving_wheel(METHODS[0][1], False)
    contact = _core.Contact(config_of(scene), False)
    place = np.linspace(*ACROSS, 251)
    found = [
        contact.step(input_of(changed_case(scene.case, {"y": float(one)})))["z"] for one in place
    ]
    return np.interp(y, place, np.array(found, dtype=float))


def inputs_of(scene: Any, walk: Walk, fixed: bool) -> Iterator[dict[str, Any]]:
    """Fields of rp_input for each step."""
    name = "z" if fixed else "vertical_force"
    values = heights(walk.y) - walk.lift if fixed else walk.load
    for y, yaw, value in zip(walk.y, walk.yaw, values, strict=True):
        change = {"y": float(y), "yaw": float(yaw), name: float(value)}
        yield input_of(changed_case(scene.case, change))


def work_of(result: dict[str, Any]) -> tuple[float, float, bool, bool]:
    """Evaluations, operator products, whether a step is bad, and whether there was no contact."""
    status = result["status"]
    lifted = status == "no_contact"
    return result["evaluations"], result["work"], status != "converged" and not lifted, lifted


def tail(
    name: str, overrides: dict[str, Any], fixed: bool, steps: int, repeats: int = REPEATS
) -> Tail:
    """Walks with one method, each step from what the one before left, several times over."""
    scene = moving_wheel(overrides, fixed)
    contact = _core.Contact(config_of(scene), False)
    inputs = list(inputs_of(scene, random_walk(steps), fixed))
    seconds, counted = [], []
    for begin in range(0, steps, AT_ONCE):
        part = inputs[begin : begin + AT_ONCE]
        state, times = contact.save(), []
        for _ in range(repeats):
            contact.restore(state)
            once, results = contact.time_steps(part, [False] * len(part), 1, processor_time=True)
            times.append(np.asarray(once)[0])
        seconds.append(np.min(times, axis=0))
        counted += [work_of(result) for result in results]
    evaluations, work, bad, lifted = np.array(counted, dtype=float).T
    prescribed = "position" if fixed else "force"
    return Tail(
        name,
        prescribed,
        np.concatenate(seconds),
        evaluations,
        work,
        int(bad.sum()),
        int(lifted.sum()),
    )


def tails(quick: bool = False, progress: Callable[[Any], None] = lambda _: None) -> list[Tail]:
    """Every method, with force and with position prescribed."""
    steps = QUICK_STEPS if quick else STEPS
    found = [
        tail(name, overrides, fixed, steps)
        for name, overrides in METHODS
        for fixed in (False, True)
    ]
    progress(found)
    return found
