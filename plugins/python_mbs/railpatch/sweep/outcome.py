"""A sweep that is done."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

from railpatch.result import GOOD
from railpatch.sweep.plan import Plan
from railpatch.sweep.work import Row


@dataclass
class Sweep:
    """A sweep in its folder. rows: by case, in the order of the points; outputs: their names.

    reused: cases that were in the folder before; solved: cases that this run solved; written: the
    files made at the end; wall_time: s.
    """

    plan: Plan
    folder: Path
    outputs: tuple[str, ...]
    rows: list[Row]
    reused: int
    solved: int
    wall_time: float
    written: list[Path] = field(default_factory=list)

    @property
    def failed(self) -> list[int]:
        """Numbers of the cases without a good result."""
        return [i for i, row in enumerate(self.rows) if row.status not in GOOD]

    def never(self) -> list[str]:
        """Outputs that no good case has; none where no case is good."""
        good = [row.outputs for row in self.rows if row.status in GOOD]
        values = zip(self.outputs, zip(*good, strict=True), strict=True) if good else ()
        return [name for name, of in values if all(value is None for value in of)]
