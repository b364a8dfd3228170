"""What ``accuracy`` in [method] chooses: the cheapest method and grid whose measured error is no
greater."""

from __future__ import annotations

from railpatch.case.accuracy import fitted_size
from railpatch.case.choice import (
    FAST_ELEMENTS,
    FINER,
    NORMAL,
    REACHED,
    ROWS_ON_APPROXIMATE,
    ROWS_ON_ELLIPSE,
    ROWS_ON_PRESSURE,
    TABLE_ON_ELLIPSE,
    Choice,
    axis_ratio,
    smallest,
)
from railpatch.case.common import Grid
from railpatch.case.load import Case
from railpatch.case.patch import PatchCase


def takes_table(case: Case, ratio: float | None, normal: str) -> bool:
    """Whether the table of creep forces is left to choose, and exact enough."""
    accuracy = case.method.accuracy
    open_choice = "tangential" not in case.method.model_fields_set and case.has_tangential
    if (
        not open_choice
        # stresses below are those of pressures and tractions, which it has not
        or case.subsurface is not None
        or ratio is None
        or normal != "hertz"
        or (case.layer is not None and case.layer.thickness > 0)
    ):
        return False
    prescribed = isinstance(case, PatchCase) and any(case.motion.prescribed)
    return accuracy >= TABLE_ON_ELLIPSE and not prescribed


def choose(case: Case) -> Choice | None:
    """What the case's accuracy asks for; None without one."""
    method = case.method
    if method.accuracy is None:
        return None
    ratio = axis_ratio(case)
    given = "normal" in method.model_fields_set or ratio is None
    normal = method.normal if given else "hertz"
    tangential = "table" if takes_table(case, ratio, normal) else method.tangential
    if tangential == "table" and normal == "hertz":
        # where the table's own estimate is too great the full theory follows
        scale = smallest(ROWS_ON_ELLIPSE, method.accuracy)
        follows = fitted_size(scale, ratio or 1.0) if takes_table(case, ratio, normal) else None
        finer = 1 + FINER if follows else 0
        return Choice(normal, tangential, FAST_ELEMENTS, follows, TABLE_ON_ELLIPSE, finer)
    rows = ROWS_ON_ELLIPSE if normal == "hertz" else ROWS_ON_PRESSURE
    scale = smallest(rows, method.accuracy)
    errors = [REACHED[name] for name in (normal, tangential) if name in REACHED]
    if tangential != "full":
        elements = FAST_ELEMENTS if tangential in REACHED else NORMAL * scale
        return Choice(normal, tangential, elements, None, max(errors, default=rows[scale]))
    if normal in REACHED:
        size = (ROWS_ON_APPROXIMATE, ROWS_ON_APPROXIMATE)
        return Choice(normal, tangential, NORMAL * ROWS_ON_APPROXIMATE, size, REACHED[normal])
    size = fitted_size(scale, ratio if normal == "hertz" and ratio else 1.0)
    return Choice(normal, tangential, NORMAL * scale, size, rows[scale], FINER)


def resolved(case: Case) -> Case:
    """The case with the method and the grid that its accuracy chooses."""
    choice = choose(case)
    if choice is None:
        return case
    fitted = list(choice.fitted) if choice.fitted else None
    grid = Grid(elements=[choice.elements] * 2, fitted=fitted)
    method = case.method.model_copy(
        update={"accuracy": None, "normal": choice.normal, "tangential": choice.tangential}
    )
    return case.model_copy(update={"grid": grid, "method": method})
