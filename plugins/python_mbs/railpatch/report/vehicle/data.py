"""What the report of a vehicle shows, taken from its log: arrays over the steps of the run."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import scipy

from railpatch.case.types import SIDES
from railpatch.log.channels import LEAST_LOAD, SLIDING
from railpatch.log.reader import Run, Series
from railpatch.report.data import ReportError, at_times, grid_of
from railpatch.result import SOLVED

Wheel = tuple[int, str]


@dataclass
class VehicleRun:
    """The run's n steps.

    ``state``, ``bodies``, ``energy``, ``stats``: series of n messages each; where a
    step has none, its values are absent. ``wheelsets``: state by number, from 1. ``contact``: by
    number and side. ``along``: m, the vehicle's distance, the abscissa of plots.
    """

    run: Run
    state: Series
    bodies: Series
    energy: Series
    stats: Series
    wheelsets: dict[int, Series]
    contact: dict[Wheel, Series]
    along: np.ndarray
    along_label: str = "distance [m]"

    @property
    def count(self) -> int:
        """Number of steps, n."""
        return len(self.state)

    @property
    def times(self) -> np.ndarray:
        """s, [n]."""
        return self.state.time

    @cached_property
    def assessment(self) -> dict[str, Any]:
        """What the run says of itself as a whole; empty where the log has nothing of it."""
        messages = self.run["/vehicle/assessment"].messages
        return messages[-1] if messages else {}

    @cached_property
    def statuses(self) -> dict[Wheel, np.ndarray]:
        """By wheel, [n]."""
        return {wheel: series["status"] for wheel, series in self.contact.items()}

    @cached_property
    def solved(self) -> np.ndarray:
        """[n], whether all contacts of a step were solved."""
        return np.all([np.isin(found, SOLVED) for found in self.statuses.values()], axis=0)

    @cached_property
    def loads(self) -> dict[Wheel, np.ndarray]:
        """N, by wheel, [n]: Q, down on the rail."""
        return {wheel: -_component(series["force"], 2) for wheel, series in self.contact.items()}

    @cached_property
    def guiding(self) -> dict[Wheel, np.ndarray]:
        """N, by wheel, [n]: Y, on the rail, outward > 0."""
        return {
            (number, side): (1.0 if side == "left" else -1.0) * _component(series["force"], 1)
            for (number, side), series in self.contact.items()
        }

    @property
    def width(self) -> int:
        """Steps in 2 m, 1 or more."""
        between = np.median(np.diff(self.along)) if self.count > 1 else 0.0
        return max(1, round(SLIDING / between)) if between > 0 else 1

    @cached_property
    def means_logged(self) -> bool:
        """Whether the log has means of every time step."""
        series = next(iter(self.contact.values()))
        return all(message.get("mean_wheel_load") is not None for message in series.messages)

    @property
    def averaging(self) -> str:
        """What mean_guiding and mean_loads are, in words."""
        if self.means_logged:
            return "averaged over the last 2 m of way, every time step"
        if self.width == 1:
            return "as logged: steps are too far apart to average over 2 m"
        return f"averaged over 2 m of way ({self.width} logged steps)"

    @cached_property
    def mean_loads(self) -> dict[Wheel, np.ndarray]:
        """N, by wheel, [n]: Q over 2 m, of every time step where the log has it."""
        return self._means("mean_wheel_load", self.loads)

    @cached_property
    def mean_guiding(self) -> dict[Wheel, np.ndarray]:
        """N, by wheel, [n]: Y, outward > 0, over 2 m."""
        return self._means("mean_guiding_force", self.guiding)

    def _means(self, name: str, values: dict[Wheel, np.ndarray]) -> dict[Wheel, np.ndarray]:
        if self.means_logged:
            return {wheel: series[name] for wheel, series in self.contact.items()}
        return {
            wheel: scipy.ndimage.uniform_filter1d(found, self.width)
            for wheel, found in values.items()
        }

    def ratio(self, wheel: Wheel) -> np.ndarray:
        """-, [n], Y/Q of the means; NaN for a wheel without load."""
        load = self.mean_loads[wheel]
        safe = np.where(load > LEAST_LOAD, load, np.nan)
        return self.mean_guiding[wheel] / safe

    def friction_work(self, wheel: Wheel) -> np.ndarray:
        """J, [n], since the start; NaN where it was not logged."""
        series = self.contact[wheel]
        if "friction_work" not in series.messages[0]:
            return np.full(self.count, np.nan)
        return series["friction_work"]

    def body_names(self) -> list[str]:
        """In their order."""
        first = next((m for m in self.bodies.messages if m), {})
        return [body["name"] for body in first.get("bodies", [])]


def vehicle_run(run: Run) -> VehicleRun:
    """Collects the steps that are whole. Raises ReportError where there is none."""
    numbers = range(1, int(run.metadata["railpatch"]["wheelsets"]) + 1)
    axles = {number: run[f"/wheelset/{number}/state"] for number in numbers}
    wheels = {(n, side): run[f"/wheelset/{n}/{side}/contact"] for n in numbers for side in SIDES}
    times = run["/vehicle/state"].time
    for series in (*axles.values(), *wheels.values()):
        times = np.intersect1d(times, series.time)
    if not times.size:
        raise ReportError(f"{run.path} holds no step: nothing to report")
    state = at_times(run["/vehicle/state"], times)
    return VehicleRun(
        run,
        state,
        at_times(run["/vehicle/bodies"], times),
        at_times(run["/vehicle/energy"], times),
        at_times(run["/solver/stats"], times),
        {number: at_times(series, times) for number, series in axles.items()},
        {wheel: at_times(series, times) for wheel, series in wheels.items()},
        state["x"],
    )


def snapshot(data: VehicleRun, number: int, at: float | None) -> dict[str, Any] | None:
    """Fields of a wheelset's patches nearest to a distance (m), or None.

    Without one, those at its greatest guiding force. Gives {"index": step, side: patches}.
    """
    taken = {
        side: at_times(data.run[f"/wheelset/{number}/{side}/fields"], data.times) for side in SIDES
    }
    have = [i for i in range(data.count) if any(taken[side].messages[i] for side in SIDES)]
    if not have:
        return None
    if at is None:
        force = np.max([np.abs(data.guiding[number, side]) for side in SIDES], axis=0)
        index = max(have, key=lambda i: force[i])
    else:
        index = min(have, key=lambda i: abs(data.along[i] - at))
    found = {side: taken[side].messages[index].get("patches", []) for side in SIDES}
    return {"index": index} | {side: [grid_of(p) for p in found[side]] for side in SIDES}


def _component(values: np.ndarray, index: int) -> np.ndarray:
    return values[:, index] if values.ndim == 2 else np.full(len(values), np.nan)
