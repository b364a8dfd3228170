"""What the report shows, taken from a run log: arrays over the positions of the run."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from railpatch.case.types import SIDES
from railpatch.log.channels import unit
from railpatch.log.reader import Run, Series
from railpatch.result import SOLVED

# how units of the log are shown: factor and unit
SHOWN = {"N": (1e-3, "kN"), "m": (1e3, "mm"), "rad": (1e3, "mrad"), "Pa": (1e-6, "MPa")}


class ReportError(ValueError):
    """The log holds nothing to report."""


@dataclass
class Positions:
    """The run's n positions (or time steps).

    ``state``, ``contact``, ``balance``, ``stats``, ``energy``, ``momentum``: series of n messages
    each; where a position has none, its values are absent. ``force``: by side, on the wheel in
    track axes, N, shape (n, 3).
    ``ratio``: by side, lateral over vertical force, the same for wheel and roller; NaN without
    vertical force. ``solved``: whether all of the position converged. ``along``: the abscissa of
    plots over the run, with ``along_label``.
    """

    run: Run
    state: Series
    contact: dict[str, Series]
    balance: Series
    stats: Series
    energy: Series
    momentum: Series
    force: dict[str, np.ndarray]
    ratio: dict[str, np.ndarray]
    solved: np.ndarray
    along: np.ndarray
    along_label: str

    @property
    def count(self) -> int:
        """Number of positions, n."""
        return len(self.state)

    def along_text(self, value: str) -> str:
        """``value`` of the abscissa as one says it: "time 2.5 s"."""
        name, _, unit = self.along_label.partition(" [")
        return f"{name} {value} {unit.rstrip(']')}".rstrip()

    @property
    def counterpart(self) -> str:
        """What the wheels run on: "roller" or "rail"."""
        kind = self.run.metadata["railpatch"].get("track_kind", "")
        return kind or ("roller" if self.has_balance else "rail")

    @property
    def has_balance(self) -> bool:
        """Whether this is a run of the roller rig."""
        return len(self.run["/rig/balance"]) > 0

    @property
    def has_stats(self) -> bool:
        """Whether times and iterations were logged."""
        return len(self.run["/solver/stats"]) > 0

    @property
    def has_energy(self) -> bool:
        """Whether the balance of energies was logged."""
        return len(self.run["/wheelset/energy"]) > 0

    @property
    def has_momentum(self) -> bool:
        """Whether the balance of momenta was logged."""
        return len(self.run["/wheelset/momentum"]) > 0

    @property
    def has_distance(self) -> bool:
        """Whether the wheelset travels."""
        return bool(np.ptp(np.nan_to_num(self.state["x"])) > 0)

    @property
    def has_bulk(self) -> bool:
        """Whether bulk temperatures were logged."""
        return any(has_bulk(self.contact[side]) for side in SIDES)

    def patch_count(self, side: str) -> np.ndarray:
        """Patches of one side at each position, shape (n,)."""
        return np.array([len(m["patches"]) for m in self.contact[side].messages])


def positions(run: Run) -> Positions:
    """Collects the positions that are whole; a log that was cut off may end within one.

    Raises ReportError where there is none.
    """
    wanted = ("/wheelset/state", "/left/contact", "/right/contact")
    times = run[wanted[0]].time
    for topic in wanted[1:]:
        times = np.intersect1d(times, run[topic].time)
    if not times.size:
        raise ReportError(f"{run.path} holds no position: nothing to report")
    state = at_times(run["/wheelset/state"], times)
    contact = {side: at_times(run[f"/{side}/contact"], times) for side in SIDES}
    balance = at_times(run["/rig/balance"], times)
    force = {side: _vectors(contact[side]["force"]) for side in SIDES}
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio = {side: _finite(force[side][:, 1] / force[side][:, 2]) for side in SIDES}
    progress = state["progress"]
    has_progress = bool(np.isfinite(progress).all())
    return Positions(
        run,
        state,
        contact,
        balance,
        at_times(run["/solver/stats"], times),
        at_times(run["/wheelset/energy"], times),
        at_times(run["/wheelset/momentum"], times),
        force,
        ratio,
        _solved(contact, balance),
        progress if has_progress else times,
        "progress of the run" if has_progress else "time [s]",
    )


def scaled(topic: str, path: str, name: str) -> tuple[float, str]:
    """Factor from the log's unit to the one shown, and an axis label with it."""
    factor, shown = SHOWN.get(unit(topic, path), (1.0, unit(topic, path)))
    return factor, f"{name} [{shown}]" if shown != "-" else name


def snapshot(data: Positions, at: float | None = None) -> dict[str, Any] | None:
    """The snapshot of the fields nearest to ``at`` on the run's abscissa.

    Without ``at``, the one at the largest yaw angle. Gives {"index": position, side: patches with
    arrays}, or None where the log has none.
    """
    taken = {side: at_times(data.run[f"/{side}/fields"], data.state.time) for side in SIDES}
    have = [
        index for index in range(data.count) if any(taken[side].messages[index] for side in SIDES)
    ]
    if not have:
        return None
    if at is None:
        index = max(have, key=lambda i: abs(data.state["yaw"][i]))
    else:
        index = min(have, key=lambda i: abs(data.along[i] - at))
    chosen = {
        side: [grid_of(p) for p in taken[side].messages[index].get("patches", [])] for side in SIDES
    }
    return {"index": index} | chosen


def at_times(series: Series, times: np.ndarray) -> Series:
    """The messages at these times; an empty one where there is none."""
    by_time = dict(zip(series.time.tolist(), series.messages, strict=True))
    return Series(times, [by_time.get(time, {}) for time in times.tolist()])


def has_bulk(contact: Series) -> bool:
    """Whether a wheel's messages have bulk temperatures."""
    return bool(np.isfinite(contact["wheel_temperature"]).any())


def _vectors(values: np.ndarray) -> np.ndarray:
    return values if values.ndim == 2 else np.full((len(values), 3), np.nan)


def _finite(values: np.ndarray) -> np.ndarray:
    return np.where(np.isfinite(values), values, np.nan)


def _solved(contact: dict[str, Series], balance: Series) -> np.ndarray:
    solved = np.ones(len(balance), dtype=bool)
    for index, message in enumerate(balance.messages):
        found = [contact[side].messages[index]["status"] for side in SIDES]
        found += [message["status"]] if message else []
        solved[index] = all(status in SOLVED for status in found)
    return solved


def grid_of(patch: dict[str, Any]) -> dict[str, Any]:
    """One patch's fields as arrays: (rows, columns), or (rows, columns, 2) of vectors."""
    rows, columns = patch["rows"], patch["columns"]
    grid: dict[str, Any] = {"patch": patch["patch"]}
    for name in ("x", "y", "pressure", "element_division"):
        grid[name] = np.reshape(patch[name], (rows, columns)) if patch[name] else None
    traction = patch["traction"]
    grid["traction"] = (
        np.moveaxis(np.reshape(traction, (2, rows, columns)), 0, -1) if traction else None
    )
    # of the wheel, whose values stand before those of the rail
    warm = patch.get("temperature")
    grid["temperature"] = np.reshape(warm, (2, rows, columns))[0] if warm else None
    return grid
