"""The methods that are measured: one line each.

A method whose case the schema refuses ends the run with that message; where it does not apply to a
set of problems, ``sets`` says so.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

# cost of a step: "full" solves a system on the grid, fewer problems are taken on fine grids;
# "fast" takes microseconds, every problem is taken several times
FULL, FAST = "full", "fast"
FAST_REPEAT = 5
WHOLE_UP_TO = 32  # elements across: beyond, the number of problems falls with the cube of them
COARSE = (8, 10, 12, 16, 20, 24, 32, 48, 64)


@dataclass(frozen=True)
class Method:
    """A method on its grids.

    overrides: keys of the case that it replaces; None takes a table or key away. grids: elements
    across the contact; (0,) for a method that chooses itself. quick: those of --quick. sets: that
    it applies to. growth: its cost is measured over the number of elements.
    """

    name: str
    label: str
    overrides: Mapping[str, Any]
    cost: str = FULL
    grids: tuple[int, ...] = COARSE
    quick: tuple[int, ...] = (10, 16, 24, 32)
    sets: str = "ABCDW"
    growth: bool = field(default=False)

    @property
    def repeat(self) -> int:
        """Passes over the problems."""
        return FAST_REPEAT if self.cost == FAST else 1

    def count(self, elements: int, total: int) -> int:
        """How many of a set's problems are taken."""
        if self.cost == FAST or elements <= WHOLE_UP_TO:
            return total
        return max(1, round(total * (WHOLE_UP_TO / elements) ** 3))

    def point(self, elements: int) -> str:
        """Name of the method on one grid."""
        return f"{self.label}, {elements} across" if elements else self.label


def tangential(name: str, **method: Any) -> dict[str, Any]:
    """Overrides that choose a theory."""
    return {"method": {"tangential": name, **method}}


UNIFORM = Method("uniform", "full theory, uniform grid", tangential("full"), growth=True)
METHODS = (
    UNIFORM,
    Method("uniform_hertz", "full theory, Hertz pressure", tangential("full", normal="hertz"),
           grids=(16, 32), quick=(16,), sets="ACD"),
    Method("fastsim", "FASTSIM", tangential("fastsim", normal="hertz"), FAST,
           grids=(10, 16, 20, 32), quick=(10, 20), sets="AC"),
    Method("fastsim_half_space", "FASTSIM, half-space pressure", tangential("fastsim"), FAST,
           grids=(10, 20), quick=(10,), sets="ABCW"),
)  # fmt: skip


def chosen_methods(names: str | None) -> tuple[Method, ...]:
    """Those named, separated by commas; all by default. Raises ValueError for others."""
    if names is None:
        return METHODS
    known = {method.name: method for method in METHODS}
    wanted = [name.strip() for name in names.split(",")]
    wrong = [name for name in wanted if name not in known]
    if wrong:
        raise ValueError(f"methods: value is {wrong[0]!r}, allowed {', '.join(known)}")
    return tuple(known[name] for name in wanted)
