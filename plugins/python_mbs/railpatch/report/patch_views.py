"""The patches of a run over a slider."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from railpatch.case.types import SIDES
from railpatch.log.reader import Run
from railpatch.page.viewer import patches_viewer
from railpatch.report.data import Positions, at_times, grid_of

if TYPE_CHECKING:
    from railpatch.report.vehicle.data import VehicleRun

Frames = list[list[list[dict[str, Any]]]]


def frames_of(run: Run, topics: Sequence[str], times: np.ndarray) -> tuple[list[int], Frames]:
    """Positions that have fields, and their patches by position and side."""
    taken = [at_times(run[topic], times).messages for topic in topics]
    have = [i for i in range(len(times)) if any(side[i] for side in taken)]
    frames = [[[grid_of(p) for p in side[i].get("patches", [])] for side in taken] for i in have]
    return have, frames


def viewer_of(data: Positions, start: int, other: Positions | None = None) -> str:
    """Of a wheelset's run. start: the position that is shown first; other: laid over it."""
    topics = [f"/{side}/fields" for side in SIDES]
    have, frames = frames_of(data.run, topics, data.state.time)
    beside = None
    if other is not None:
        theirs, their_frames = frames_of(other.run, topics, other.state.time)
        if theirs and other.along_label == data.along_label:
            beside = (other.run.path.name, other.along[theirs].tolist(), their_frames)
    texts = [_text(data, i) for i in have]
    names = [f"{side} wheel" for side in SIDES]
    at = data.along[have].tolist()
    return patches_viewer("patch", names, at, texts, frames, have.index(start), beside)


def _text(data: Positions, index: int) -> str:
    """Where a position is."""
    parts = [data.along_text(f"{data.along[index]:.4g}")]
    parts += [
        f"{text} {factor * data.state[name][index]:.3g} {unit}"
        for name, text, factor, unit in (("yaw", "yaw", 1e3, "mrad"), ("y", "y", 1e3, "mm"))
        if np.isfinite(data.state[name][index])
    ]
    return f"Position {index}: {', '.join(parts)}".replace("-", "\u2212")


def over_distance(
    data: VehicleRun,
    number: int,
    start: int,
    text: Callable[[int], str],
    other: VehicleRun | None = None,
) -> str:
    """Of one wheelset of a vehicle; empty where its fields were not logged."""
    topics = [f"/wheelset/{number}/{side}/fields" for side in SIDES]
    have, frames = frames_of(data.run, topics, data.times)
    if not have:
        return ""
    beside = None
    if other is not None and number in other.wheelsets:
        theirs, their_frames = frames_of(other.run, topics, other.times)
        if theirs:
            beside = (other.run.path.name, other.along[theirs].tolist(), their_frames)
    names, texts = [f"{side} wheel" for side in SIDES], [text(i) for i in have]
    at = data.along[have].tolist()
    return patches_viewer(f"patch-{number}", names, at, texts, frames, have.index(start), beside)
