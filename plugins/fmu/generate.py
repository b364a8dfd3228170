"""Writes the C++ table of variables: python generate.py TABLE.PY VARIABLES.TOML OUTPUT.INC

Run by CMake. Writes one line {reference, type, role, field...} for each variable.
"""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path
from typing import Any

STRUCTS = {"input": "rp_input", "output": "rp_result", "parameter": ""}


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


def line(variable: Any) -> str:
    """One entry of the C++ table."""
    low, high = (float(limit) for limit in variable.range)
    kind = "real" if variable.base == "Real" else "integer"
    return (
        f"{{{variable.reference}, Type::{kind}, Role::{variable.causality}, "
        f"{place(variable, variable.field)}, {place(variable, variable.plus)}, {low!r}, {high!r}}},"
    )


def main() -> None:
    """Writes the file."""
    module, table, output = (Path(argument) for argument in sys.argv[1:])
    lines = [line(variable) for variable in load(module).Table(table).everything()]
    output.write_text("\n".join(lines) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
