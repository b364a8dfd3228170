"""The example of docs/force_element.md runs as printed."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

PAGE = Path(__file__).parents[2] / "docs/force_element.md"


def test_example(capsys):
    blocks = re.findall(
        r"^```python\n(.*?)^```", PAGE.read_text(encoding="utf-8"), re.DOTALL | re.MULTILINE
    )
    (example,) = [block for block in blocks if "railpatch.pinocchio" in block]
    names: dict[str, object] = {}
    exec(compile(example, str(PAGE), "exec"), names)
    assert capsys.readouterr().out.startswith("converged")
    assert np.isfinite(names["acceleration"]).all()
