"""What a run was made with: all checked tables as they ran, beside the case file as it was read.

Options of a command may replace keys of the file; the log then says which, and holds both.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pydantic import BaseModel

from railpatch.case.load import check_case, check_table, plain, tomllib
from railpatch.case.resolve import resolved
from railpatch.case.scene_profiles import Shelf, note_lines, profile_notes
from railpatch.errors import CaseError
from railpatch.pressure_error import run_doubts

# name of the attachment
EFFECTIVE = "effective.json"
# their names are those of the attached files, not the paths they were found at
PROFILES = "profiles"


@dataclass(frozen=True)
class Effective:
    """data: JSON of all tables, complete, null where a key is left out. about: metadata of the log:
    theory, grid, step and duration (s), the keys that differ from the case file, and what was
    assumed of its profile files, and warnings of the error that their noise leaves."""

    data: bytes
    about: dict[str, str]


def effective(
    text: bytes,
    case: Any,
    tables: Mapping[str, Any],
    *,
    step: float,
    duration: float,
    names: Mapping[str, str],
) -> Effective:
    """Of a checked case and the run's own tables, by name.

    text: the case file. names: of the attached profile files, by the paths in the case.
    """
    content = dumped(case) | {name: dumped(table) for name, table in tables.items()}
    given = content[PROFILES].items()
    content[PROFILES] = {
        key: names.get(value, value) if isinstance(value, str) else value for key, value in given
    }
    read = as_read(text, tables)
    shelf = Shelf(case, Path())
    return Effective(
        json.dumps(content, allow_nan=False, indent=1).encode(),
        {
            "theory": theory_of(case),
            "grid": grid_of(case),
            "step": f"{step:.9g}",
            "duration": f"{duration:.9g}",
            "overrides": "; ".join(differences(read, content)),
            "profiles": " | ".join(note_lines(profile_notes(case, shelf))),
            "doubts": " | ".join(run_doubts(case, Path(), shelf)),
        },
    )


def dumped(table: Any) -> Any:
    """Plain values of a checked table, of several, or None."""
    if isinstance(table, BaseModel):
        return table.model_dump(mode="json")
    return None if table is None else [dumped(item) for item in table]


def as_read(text: bytes, tables: Mapping[str, Any]) -> dict[str, Any]:
    """The tables of the file with its own values: complete where these are allowed by themselves,
    else the keys that it gives."""
    content = plain(tomllib.loads(text.decode("utf-8")))
    own = {name: content.pop(name, None) for name in tables}
    try:
        read = dumped(check_case(content))
    except CaseError:
        read = content
    for name, value in own.items():
        model = type(tables[name])
        try:
            checked = issubclass(model, BaseModel)
            read[name] = dumped(check_table(model, value or {}, name)) if checked else value
        except CaseError:
            read[name] = value
    return read


def differences(read: Any, ran: Any, key: str = "") -> Iterator[str]:
    """'run.step 0.001 -> 0.002' of each value; what the file does not give by itself counts only
    in a table that is complete."""
    if key == PROFILES or read == ran:
        return
    if isinstance(read, dict) and isinstance(ran, dict):
        for name in read:
            if name in ran:
                yield from differences(read[name], ran[name], f"{key}.{name}" if key else name)
    elif not (isinstance(read, list) and isinstance(ran, list) and tables_in(ran)):
        yield f"{key} {shown(read)} -> {shown(ran)}"


def tables_in(values: list[Any]) -> bool:
    """Whether it is a list of tables: no option replaces these."""
    return any(isinstance(value, dict) for value in values)


def shown(value: Any) -> str:
    """As short as it can be read."""
    if value is None:
        return "left out"
    if isinstance(value, dict):
        parts = (f"{k} {shown(v)}" for k, v in value.items() if v is not None)
        return "{" + ", ".join(parts) + "}"
    return value if isinstance(value, str) else json.dumps(value)


def theory_of(case: Any) -> str:
    """Normal and tangential method, those that [method] accuracy has chosen too."""
    method = resolved(case).method
    return f"{method.normal}, {method.tangential}"


def grid_of(case: Any) -> str:
    """Elements, their size, or nodes; empty without a grid."""
    grid = resolved(case).grid
    if grid is None:
        return ""
    given = grid.model_dump(mode="json", exclude_none=True)
    parts = [
        f"{name} {value[0]:g} x {value[1]:g}{' m' if name == 'element_size' else ''}"
        for name, value in given.items()
    ]
    return ", ".join(parts).replace("_", " ")
