"""Numbers that are given as arrays, or as what becomes one."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from railpatch.case.types import show
from railpatch.errors import CaseError


def plain_numbers(name: str, value: Any) -> NDArray[np.float64]:
    """Its numbers, finite or not: text, truth values, complex numbers and what an array masks are
    none. Raises CaseError."""
    try:
        given = np.asarray(value)
        found = given.astype(float) if given.dtype.kind in "iuf" else None
    except (TypeError, ValueError):
        found = None
    if found is None or np.ma.is_masked(value):
        raise CaseError(f"{name}: value is {show(value)}, allowed numbers")
    return found
