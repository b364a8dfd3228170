"""The README's example of the force element runs as printed."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

README = Path(__file__).parents[2] / "README.md"


def test_example(capsys):
    blocks = re.findall(r"^```python\n(.*?)^```", README.read_text(), re.DOTALL | re.MULTILINE)
    (example,) = [block for block in blocks if "railpatch.pinocchio" in block]
    names: dict[str, object] = {}
    exec(compile(example, str(README), "exec"), names)
    assert capsys.readouterr().out.startswith("converged")
    assert np.isfinite(names["acceleration"]).all()
