"""Programs of the documentation that a long claim of the book runs whole."""

from __future__ import annotations

import runpy
from pathlib import Path

from matplotlib.figure import Figure

DOCS = Path(__file__).parents[2] / "docs"


def test_fluids_draw_each_liquid() -> None:
    """Regimes, which have friction of their own, and films over rate and creepage: lines that reach
    over the axis, between nothing and the dry friction."""
    program = runpy.run_path(str(DOCS / "fluids.py"))
    for name, count in (("over_rate", 2), ("creep_curves", 5)):
        panel = Figure().add_subplot()
        program[name](panel)
        assert len(panel.lines) == count
        for line in panel.lines:
            values = line.get_ydata()
            assert (values > 0).all()
            assert (values <= 0.5).all()
