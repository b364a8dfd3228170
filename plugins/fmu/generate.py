"""Writes the C++ table of variables: python generate.py TABLE.PY VARIABLES.TOML FOLDER

Run by CMake. Into variables.inc one line {reference, type, role, field...} for each variable; into
references.inc the value references of the scene's own, by name.
"""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path
from typing import Any

TYPES = {"Real": "real", "Integer": "integer", "Enumeration": "enumeration", "String": "text"}
STRUCTS = {"input": "rp_input", "output": "rp_result", "parameter": "", "independent": ""}


def load(path: Path) -> Any:
    """The module of that file, which is not installed yet."""
    spec = importlib.util.spec_from_file_location(path.stem, path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[path.stem] = module
    spec.loader.exec_module(module)
    return module


def place(variable: Any, field: str) -> str:
    """Where a field lies in its struct; 0 for none."""
    struct = STRUCTS[variable.causality]
    return f"offsetof({struct}, {field})" if struct and field else "no_field"


def line(variable: Any, types: Any) -> str:
    """One entry of the C++ table. types: those that variables.toml declares."""
    low, high = (float(limit) for limit in variable.range)
    side = 0 if variable.side is None else variable.side + 1
    patch = 0 if variable.patch is None else variable.patch + 1
    return (
        f"{{{variable.reference}, Type::{TYPES[variable.base]}, Role::{variable.causality}, "
        f"{place(variable, variable.field)}, {place(variable, variable.plus)}, {low!r}, {high!r}, "
        f"{side}, {patch}, {variable.mean_of}, Absent::{absent(variable)}, "
        f'{str(variable.fixed).lower()}, "{unit(types[variable.type])}"}},'
    )


def unit(declared: Any) -> str:
    """As messages write it; none of what has no dimension."""
    found = declared.get("unit", "1")
    return "" if found == "1" else found.replace(".", " ")


def absent(variable: Any) -> str:
    """What it is where its patch is not."""
    if variable.type == "Status":
        return "no_contact"
    return variable.absent.replace(" ", "_") or "zero"


def names(variables: list[Any]) -> dict[str, int]:
    """The value references of what no side has, of a vector the first."""
    found: dict[str, int] = {}
    for variable in variables:
        # a file of each side by the left one's
        if variable.side is None or (variable.base == "String" and variable.side == 0):
            found.setdefault(variable.name.split("[")[0].replace(".", "_"), variable.reference)
    return found


def main() -> None:
    """Writes the files."""
    module, table, folder = (Path(argument) for argument in sys.argv[1:])
    known = load(module).Table(table)
    variables = known.everything()
    references = [f"{name} = {reference}," for name, reference in names(variables).items()]
    for name, lines in (
        ("variables.inc", [line(variable, known.types) for variable in variables]),
        ("references.inc", references),
    ):
        (folder / name).write_text("\n".join(lines) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
