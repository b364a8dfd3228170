"""How long each time step of a run took, against the time that it simulates."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

Vector = NDArray[np.float64]
# of the histogram's edges: each is twice the one before the last
HALF_OCTAVE = 2**0.5
# times the step: the least and the greatest edge, whole octaves of it
LEAST, GREATEST = 2.0**-4, 2.0**5
SHARES = {"median": 0.5, "99 %": 0.99, "99.99 %": 0.9999}
BAR = 40


class StepTimes:
    """Times of a run's steps, in memory that is there before the first one.

    step: s, that a time step simulates. threads: that the run has. wall, cpu: [done], s, by the
    clock and of all threads, of each step without what the caller of steps() does in between.
    """

    def __init__(self, count: int, step: float, threads: int) -> None:
        self.step, self.threads, self.done = step, threads, 0
        # written to, or the system would find its pages one by one in the steps
        self._times = np.full((2, count), 0.0)

    def add(self, wall: float, cpu: float) -> None:
        """One more step."""
        self._times[0, self.done] = wall
        self._times[1, self.done] = cpu
        self.done += 1

    @property
    def wall(self) -> Vector:
        """[done], s."""
        return self._times[0, : self.done]

    @property
    def cpu(self) -> Vector:
        """[done], s."""
        return self._times[1, : self.done]

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers: step in s, steps, edges of the histogram in s, and of both clocks what
        spread() says. Times below the first edge and from the last on have bins of their own."""
        edges = self.edges()
        return {
            "step": self.step,
            "steps": self.done,
            "edges": edges.tolist(),
            "wall": spread(self.wall, self.step, edges, own=True),
            # of several threads the sum is no time that a step takes
            "cpu": spread(self.cpu, self.step, edges, own=self.threads == 1),
        }

    def edges(self) -> Vector:
        """[19], s, of the histogram: half octaves, the step among them."""
        count = round(2 * np.log2(GREATEST / LEAST)) + 1
        return self.step * LEAST * HALF_OCTAVE ** np.arange(count)


def spread(times: Vector, step: float, edges: Vector, *, own: bool) -> dict[str, Any]:
    """Of times (s): mean, those by SHARES that so great a part does not exceed, worst, the number
    of the worst step, misses, the number of steps that took longer than they simulate, and counts
    of the histogram. own: whether misses mean something, else None. A share that wants more steps
    than there are is None, and so is all of no steps."""
    found: dict[str, Any] = {"mean": None, **dict.fromkeys(SHARES), "worst": None}
    found |= {"worst_step": None, "misses": None}
    if len(times):
        found["mean"], found["worst"] = float(times.mean()), float(times.max())
        found["worst_step"] = int(times.argmax())
        ordered = np.sort(times)
        for name, share in SHARES.items():
            if len(times) * (1 - share) >= 1 - 1e-9:
                found[name] = float(ordered[math.ceil(share * len(times) - 1e-9) - 1])
        if own:
            found["misses"] = int(np.count_nonzero(times > step))
    places = np.searchsorted(edges, times, side="right")
    found["counts"] = np.bincount(places, minlength=len(edges) + 1).tolist()
    return found


def text_of(found: dict[str, Any]) -> str:
    """Lines for the terminal, of to_dict()."""
    lines = [f"steps of {1e3 * found['step']:g} ms: {found['steps']}, times in ms"]
    for key, name in (("cpu", "CPU, all threads"), ("wall", "by the clock")):
        of = found[key]
        shown = [f"{part} {ms(of[part])}" for part in ("mean", *SHARES, "worst")]
        misses = "-" if of["misses"] is None else str(of["misses"])
        lines.append(f"{name:<18}{', '.join(shown)}, longer than the step: {misses}")
    lines.append(f"{'ms':>17}{'CPU':>10}{'clock':>10}")
    edges = [0.0, *found["edges"], float("inf")]
    most = max(found["cpu"]["counts"], default=0) or 1
    for k, (cpu, wall) in enumerate(
        zip(found["cpu"]["counts"], found["wall"]["counts"], strict=True)
    ):
        if cpu or wall:
            bar = "#" * -(-BAR * cpu // most)
            label = f"{ms(edges[k])} to {ms(edges[k + 1])}"
            lines.append(f"{label:>17}{cpu:>10}{wall:>10}  {bar}".rstrip())
    return "\n".join(lines)


def ms(seconds: float | None) -> str:
    """Three figures; a dash where there is none."""
    if seconds is None:
        return "-"
    return "..." if seconds == float("inf") else f"{1e3 * seconds:.3g}"
