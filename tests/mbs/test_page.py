"""The example of docs/multibody.md runs."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

PAGE = Path(__file__).resolve().parents[2] / "docs" / "multibody.md"


def test_example(capsys):
    (code,) = re.findall(r"```python\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.DOTALL)
    names: dict = {}
    exec(code, names)
    assert capsys.readouterr().out
    found = names["found"]
    assert found.by_q.shape == found.by_v.shape == (6, 6)
    # the bounce on the contacts, and creep forces that damp
    assert found.by_q[2, 2] < -1e5
    assert found.by_v[1, 1] < -10
    np.testing.assert_array_equal(found.by_q[:, 0], [-4e5 / 1300.0, 0, 0, 0, 0, 0])
