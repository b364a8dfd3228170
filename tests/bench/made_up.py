"""Measurements made up for tests, with known statistics."""

from __future__ import annotations

from typing import Any

import numpy as np
from railpatch.evidence.bench.measure import COLUMNS, Measured
from railpatch.evidence.bench.methods import FULL, Method


def measured(
    count: int = 100, elements: int = 10, name: str = "made_up", lost: int = 0, **columns: Any
) -> Measured:
    """Columns that are not given are zero; the last ``lost`` cases did not converge."""
    values = {column: np.zeros(count) for column in COLUMNS}
    for kind in ("force", "moment", "pressure"):
        values[f"{kind}_estimate"] = np.full(count, np.nan)
    values.update({key: np.broadcast_to(value, count) for key, value in columns.items()})
    return Measured(
        method=Method(name, f"method {name}", {}, FULL),
        elements=elements,
        set_name="A",
        place=np.zeros((count, 2), dtype=int),
        good=np.arange(count) < count - lost,
        columns={key: np.asarray(value, dtype=float) for key, value in values.items()},
        bytes=2048,
    )
