"""Warnings of what a patch can hardly be meant to have, beside those that a step finds."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from railpatch.case.gap import KEY, read_gap
from railpatch.case.own_influence import influence_doubts

WIDEST = 4.0  # m, of a line contact: few rollers are as wide
NEAREST = 25.0  # per cent of the elements
STEEP = 0.25  # of the grid, that they may be apart


def patch_doubts(case: Any, folder: Path) -> list[str]:
    """Of any kind of case; of others than patches there are none. folder: where paths start."""
    if case.kind != "patch":
        return []
    return [*wide_lines(case), *steep_gaps(case, folder), *influence_doubts(case, folder)]


def wide_lines(case: Any) -> list[str]:
    """Of a line contact that is longer than any roller."""
    width = case.geometry.width
    if width is None or width <= WIDEST:
        return []
    return [f"geometry.width is {width:g} m, above {WIDEST:g} m: of a line contact, in m"]


def steep_gaps(case: Any, folder: Path) -> list[str]:
    """Of surfaces that stand on edge: the nearest quarter of the elements is farther apart than a
    quarter of the grid's width. Others may be, where there is no material."""
    gap = read_gap(case.geometry.undeformed_distance, folder)
    if gap is None:
        return []
    sides = np.array(case.grid.element_size) * gap.shape[::-1]
    apart, extent = float(np.percentile(gap, NEAREST) - gap.min()), float(sides.max())
    if apart <= STEEP * extent:
        return []
    return [
        f"{KEY}: three quarters of the elements are {apart:.3g} m or more farther apart than the "
        f"nearest, on a grid of {extent:.3g} m: distances are in m"
    ]
