"""What a page draws on canvases: patches at any position of a run, and parallel axes."""

from __future__ import annotations

import base64
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from html import escape
from typing import Any

import numpy as np
from numpy.typing import NDArray

from railpatch.page.document import data_of
from railpatch.page.patch_figure import ELEMENT_STATES, STATE_COLORS, load_of, regular

# bytes of all patches before compression; where there are more, positions are left out
MOST_BYTES = 1_500_000
KINDS = {
    "pressure": "pressure [MPa]",
    "traction": "traction on the wheel [MPa]",
    "states": "stick and slip",
    "temperature": "surface temperature of the wheel [\u00b0C]",
}

Frame = Sequence[Sequence[dict[str, Any]]]


def patches_viewer(
    name: str,
    sides: Sequence[str],
    at: Sequence[float],
    texts: Sequence[str],
    frames: Sequence[Frame],
    start: int,
    other: tuple[str, Sequence[float], Sequence[Frame]] | None = None,
) -> str:
    """Patches over a slider; the name is unique on its page.

    frames: by position and side, the patches' fields as ``report.data.grid_of`` gives them; at:
    abscissa of each position; texts: what each says of itself; start: the position that is shown
    first; other: name, abscissas and frames of what is laid over them, as outlines.
    """
    kept = few(frames, start)
    data = _packed([frames[i] for i in kept])
    grids = [grid for frame in frames for side in frame for grid in side]
    kinds = {"pressure"}
    for field, kind in (("traction", "traction"), ("element_division", "states")):
        if any(grid[field] is not None for grid in grids):
            kinds.add(kind)
    if any(grid.get("temperature") is not None for grid in grids):
        kinds.add("temperature")
    states = sorted({s for grid in grids for s in _states(grid)} - {0})
    found = {
        **data,
        "sides": list(sides),
        "at": [float(at[i]) for i in kept],
        "text": [texts[i] for i in kept],
        "start": kept.index(start),
        "kinds": {kind: {"name": text} for kind, text in KINDS.items() if kind in kinds},
        "states": [[ELEMENT_STATES[s], STATE_COLORS[s], s] for s in states],
    }
    if other is not None:
        label, other_at, other_frames = other
        near = few(other_frames, 0)
        found["other"] = {
            **_packed([other_frames[i] for i in near]),
            "name": label,
            "at": [float(other_at[i]) for i in near],
        }
    return f'<div class=viewer id="{escape(name)}"></div>' + data_of(
        name, {"viewer": "patches", "data": found}
    )


@dataclass(frozen=True)
class Axis:
    """One of parallel ones. values: [cases]; texts: of whole-number values; logarithmic: whether
    values, all > 0, lie by their logarithm."""

    name: str
    values: NDArray[np.float64]
    texts: list[str] | None = None
    logarithmic: bool = False


def parallel_axes(name: str, axes: Sequence[Axis], color: int) -> str:
    """Cases as lines. color: number of the axis by which lines are coloured."""
    data = {
        "axes": [
            {"name": axis.name, "values": _bytes(np.asarray(axis.values, dtype="<f4"))}
            | ({"texts": list(axis.texts)} if axis.texts else {})
            | ({"logarithmic": True} if axis.logarithmic else {})
            for axis in axes
        ],
        "color": color,
    }
    return f'<div class=parallel id="{escape(name)}"></div>' + data_of(
        name, {"viewer": "parallel", "data": data}
    )


def few(frames: Sequence[Frame], start: int) -> list[int]:
    """Positions that are kept, evenly spread, with the one that is shown first."""
    sizes = [sum(7 * grid["pressure"].size for side in f for grid in side) for f in frames]
    share = -(-sum(sizes) // MOST_BYTES) or 1
    return sorted({*range(start % share, len(frames), share), start})


def _packed(frames: Iterable[Frame]) -> dict[str, Any]:
    patches: list[dict[str, Any]] = []
    found = []
    for frame in frames:
        sides = []
        for side in frame:
            sides.append([len(patches) + k for k in range(len(side))])
            # the most loaded one first
            patches += [_patch(grid) for grid in sorted(side, key=load_of, reverse=True)]
        found.append(sides)
    return {"frames": found, "patches": patches}


def _patch(grid: dict[str, Any]) -> dict[str, Any]:
    """Fields of a patch inside the box of its contact, 16 bits each."""
    even = regular(grid)
    rows, columns = (np.flatnonzero((even["pressure"] > 0).any(axis=k)) for k in (1, 0))
    if not rows.size:
        rows, columns = np.array([0]), np.array([0])
    box = (slice(rows[0], rows[-1] + 1), slice(columns[0], columns[-1] + 1))
    found: dict[str, Any] = {
        "x": _bytes(np.asarray(even["x"][box[1]], dtype="<f4")),
        "y": _bytes(np.asarray(even["y"][box[0]], dtype="<f4")),
        "pressure": _scaled(even["pressure"][box]),
    }
    if even["traction"] is not None:
        for k, name in enumerate(("tx", "ty")):
            found[name] = _scaled(even["traction"][box][..., k])
    if even["division"] is not None:
        found["states"] = _bytes(np.asarray(even["division"][box], dtype=np.uint8))
    if even.get("temperature") is not None:
        found["temperature"] = _scaled(even["temperature"][box])
    return found


def _scaled(values: NDArray[np.float64]) -> list[Any]:
    """Least value, step, and how many steps each is above it. What is 0 stays 0."""
    low, high = float(values.min()), float(values.max())
    step = (high - low) / 65535 or 1.0
    if low < 0 < high:
        low = -step * np.ceil(-low / step)
        step = (high - low) / 65534
        low = -step * np.ceil(-low / step)
    raw = np.clip(np.rint((values - low) / step), 0, 65535)
    return [low, step, _bytes(raw.astype("<u2"))]


def _states(grid: dict[str, Any]) -> set[int]:
    division = grid["element_division"]
    return set() if division is None else set(np.unique(division).tolist())


def _bytes(values: NDArray[Any]) -> str:
    return base64.b64encode(np.ascontiguousarray(values).tobytes()).decode()
