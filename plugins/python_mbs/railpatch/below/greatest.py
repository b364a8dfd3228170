"""What is greatest at each depth, and where."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from railpatch.result import Result

Vector = NDArray[np.float64]
DEPTHS, DEEPEST = 24, 1.5
# name: (of the fields, unit)
COLUMNS = {"depth": "m", "von_mises": "Pa", "von_mises_x": "m", "von_mises_y": "m",
           "greatest_shear": "Pa", "greatest_shear_x": "m", "greatest_shear_y": "m",
           "dang_van": "Pa", "dang_van_y": "m"}  # fmt: skip


def patches_of(result: Result, side: str) -> list[dict[str, Any]]:
    """Of a wheel, alternatives last, or the one given by itself."""
    found = result.data.get(side, result.data)
    return [*found["patches"], *found["alternatives"]] if "patches" in found else [found]


def index_of(result: Result, side: str, number: int) -> int:
    """The place in the result of a patch counted from 1. Raises LookupError where there is none."""
    count = len(patches_of(result, side))
    if number > count:
        there = f"1 to {count}" if count else "none: there is no contact"
        raise LookupError(f"--patch: value is {number}, allowed {there} ({side})")
    return number - 1


def usual_depths(result: Result, side: str, patch: int) -> Vector:
    """m, [DEPTHS], by the size of the patch, closer near the surface, where stresses change most.
    patch: its place in the result. Raises LookupError where it has no pressure."""
    at = patches_of(result, side)[patch]
    if at.get("pressure") is None:
        raise LookupError(f"patch {patch + 1}: its theories give no pressure element by element")
    loaded = np.asarray(at["pressure"]) > 0
    x = np.broadcast_to(np.asarray(at["x"]), loaded.shape)[loaded]
    y = np.broadcast_to(np.asarray(at["y"])[:, None], loaded.shape)[loaded]
    size = max(np.ptp(x), np.ptp(y)) if loaded.any() else 0.0
    # one column or row of elements
    size = size or 1e-3
    return DEEPEST * size * (np.arange(DEPTHS) / (DEPTHS - 1)) ** 2


def greatest(found: Mapping[str, Any]) -> dict[str, Vector]:
    """COLUMNS, [depths] each, of a solution."""
    table: dict[str, Vector] = {"depth": found["depth"]}
    for name in ("von_mises", "greatest_shear"):
        flat = found[name].reshape(len(found["depth"]), -1)
        row, column = np.unravel_index(flat.argmax(axis=1), found[name].shape[1:])
        table |= {name: flat.max(axis=1), f"{name}_x": found["x"][column],
                  f"{name}_y": found["y"][row]}  # fmt: skip
    table["dang_van"] = found["dang_van"].max(axis=1)
    table["dang_van_y"] = found["y"][found["dang_van"].argmax(axis=1)]
    return table


def rows_of(table: Mapping[str, Vector]) -> Iterator[str]:
    """Lines of a table in mm and MPa."""
    yield "depth  von Mises   at x    at y     shear    at x    at y  Dang Van    at y"
    yield "   mm        MPa     mm      mm       MPa      mm      mm       MPa      mm"
    for row in zip(*(table[name] for name in COLUMNS), strict=True):
        scaled = (
            v * (1e3 if unit == "m" else 1e-6) + 0.0
            for v, unit in zip(row, COLUMNS.values(), strict=True)
        )
        yield "{:5.2f} {:10.1f} {:7.2f} {:7.2f} {:9.1f} {:7.2f} {:7.2f} {:9.1f} {:7.2f}".format(
            *scaled
        )
