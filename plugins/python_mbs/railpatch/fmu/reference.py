"""documentation/reference*.csv: what the outputs must be at the start values, and over some steps.

Solved by the Python package's own core, not by the library in the FMU, so that it tells a user
whether that library does on his machine what it does here.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

from railpatch.case.load import Case, Scene
from railpatch.case.patch import PatchCase
from railpatch.contact import Contact
from railpatch.errors import CaseError
from railpatch.fmu.table import Variable
from railpatch.result import SOLVED

HEAD = (
    "# Real outputs at the start values, after fmi2ExitInitializationMode; SI units\nname,value\n"
)
STEPS = 20  # of a series
# parts of the reach to try, until all steps are solved
SIZES = (1.0, 0.1, 0.01, 0.0)
# how far an input moves, key of a step: so far, and by this part of its start value
REACH = {
    "y": (2e-4, 0.0),
    "yaw": (5e-4, 0.0),
    "z": (5e-6, 0.0),
    "vertical_force": (0.0, 0.1),
    "pitch_rate": (0.0, 1e-3),
    "normal_force": (0.0, 0.1),
    "approach": (0.0, 0.05),
    "spin_creepage": (0.05, 0.1),
}


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


def series(
    scene: Scene, variables: list[Variable], step: float, name: str
) -> tuple[dict[str, list[float]], dict[str, list[float]]]:
    """Inputs and outputs over time, columns by name: some inputs move to and fro by sines.

    Row 0 is the start, each further one the end of a communication step of `step` (s); the inputs
    of a row are set at its time, and act in the step that begins there. Raises CaseError where not
    even inputs at rest can be solved.
    """
    moves = moves_of(scene.case, variables)
    for size in SIZES:
        found = solved_series(scene, moves, step, size)
        if found is not None:
            break
    else:
        raise CaseError(f"{name}: the start values cannot be solved again from their solution")
    rows, inputs = found
    wanted = [v.name for v in variables if v.causality == "output" and v.base == "Real"]
    # the solver's own residual is what rounding makes of it
    kept = [n for n in wanted if n.rpartition(".")[2] != "residual"]
    kept = [n for n in kept if all(math.isfinite(row.get(n, math.nan)) for row in rows)]
    times = [k * step for k in range(STEPS + 1)]
    outputs = {"time": times, **{n: [row[n] for row in rows] for n in kept}}
    return {"time": times, **inputs}, outputs


def moves_of(case: Case, variables: list[Variable]) -> dict[str, tuple[str, float, float]]:
    """Input -> key of a step, start value, how far it moves: scalars that are continuous."""
    found = {}
    for v in variables:
        key = v.name.removeprefix("wheelset.")
        if v.causality == "input" and key in REACH:
            assert v.start is not None
            start, (absolute, relative) = float(v.start), REACH[key]
            found[v.name] = key, start, absolute + relative * abs(start)
    return found


def solved_series(
    scene: Scene, moves: dict[str, tuple[str, float, float]], step: float, size: float
) -> tuple[list[dict[str, float]], dict[str, list[float]]] | None:
    """Rows of outputs and columns of inputs; None where a step is not solved."""
    contact, rows = Contact(scene), []
    inputs: dict[str, list[float]] = {name: [] for name in moves}
    changes: dict[str, Any] = {}
    for k in range(STEPS + 1):
        # with the inputs of the row before; at the start no time has passed
        result = contact.step(**(passing(scene.case, changes, step) if k else {}))
        if result.status not in SOLVED:
            return None
        rows.append(dict(named(result.data, "")))
        for number, (name, (key, start, reach)) in enumerate(moves.items(), 1):
            value = start + size * reach * math.sin(2 * math.pi * number * k / STEPS)
            inputs[name].append(value)
            changes[key] = value
    return rows, inputs


def passing(case: Case, changes: dict[str, Any], step: float) -> dict[str, Any]:
    """The changes with the time that passes, where that counts."""
    if not isinstance(case, PatchCase):
        return {**changes, "time_step": step}
    if case.motion.regime != "transient_rolling":
        return changes
    return {**changes, "distance": step * case.motion.rolling_speed, "steps": 1}


def csv_of(columns: dict[str, list[float]]) -> str:
    """As fmpy and spreadsheets read it."""
    lines = [",".join(f'"{name}"' for name in columns)]
    lines += [",".join(map(repr, row)) for row in zip(*columns.values(), strict=True)]
    return "\n".join([*lines, ""])
