"""How fine a discretisation is for an accuracy: one place for all that choose one."""

from __future__ import annotations

# nodes along rolling and rows that [grid] fitted takes
LEAST, MOST = 3, 64
# longer contacts take more nodes and fewer rows; measured, see `railpatch bench`
ASPECT_POWER = 0.22
# rows for each unit of the scale at least: long contacts err by too few rows first
LEAST_ROWS = 0.8


def fitted_size(scale: float, axis_ratio: float = 1.0) -> tuple[int, int]:
    """Nodes along rolling and rows of [grid] fitted.

    scale: nodes and rows of a contact as long as it is wide. axis_ratio: a/b, semi-axis along
    rolling over the lateral one. Raises ValueError where that is beyond what [grid] takes.
    """
    if not axis_ratio > 0:
        raise ValueError(f"axis_ratio: value is {axis_ratio}, allowed > 0")
    stretch = axis_ratio**ASPECT_POWER
    nodes, rows = round(scale * stretch), max(round(scale / stretch), round(LEAST_ROWS * scale))
    if not LEAST <= min(nodes, rows) <= max(nodes, rows) <= MOST:
        raise ValueError(
            f"scale: value is {scale}, that is {nodes} nodes and {rows} rows at a/b = "
            f"{axis_ratio:g}, allowed {LEAST} to {MOST} of both"
        )
    return nodes, rows
