"""documentation/reference.csv: what the outputs must be at the start values.

Solved by the Python package's own core, not by the library in the FMU, so that it tells a user
whether that library does on his machine what it does here.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

from railpatch.case.load import Scene
from railpatch.contact import Contact
from railpatch.fmu.table import Variable

HEAD = (
    "# Real outputs at the start values, after fmi2ExitInitializationMode; SI units\nname,value\n"
)


def reference_csv(scene: Scene, variables: list[Variable]) -> str:
    """The file: one line for each Real output that the result of a step has."""
    values = dict(named(Contact(scene).step().data, ""))
    names = [v.name for v in variables if v.causality == "output" and v.base == "Real"]
    found = [name for name in names if math.isfinite(values.get(name, math.nan))]
    rows = [f"{name},{values[name]!r}\n" for name in found]
    return HEAD + "".join(rows)


def named(value: Any, name: str) -> Iterator[tuple[str, float]]:
    """Name in the FMU and value of every number in a result."""
    if isinstance(value, dict):
        for key, part in value.items():
            own = "patch" if key == "patches" else key
            yield from named(part, f"{name}.{own}" if name else own)
    elif isinstance(value, (list, tuple)):
        for number, part in enumerate(value, 1):
            yield from named(part, f"{name}[{number}]")
    elif isinstance(value, (int, float)) and not isinstance(value, bool):
        yield name, float(value)
