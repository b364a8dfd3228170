"""Cases of an input file as TOML files, with what they name beside them."""

from __future__ import annotations

import copy
import json
import shutil
from pathlib import Path
from typing import Any

from railpatch.errors import CaseError
from railpatch.inp.files import Converted, sequences
from railpatch.inp.sequences import changes_of, joined
from railpatch.writing import write_whole


def plan(found: list[Converted], source: Path) -> list[tuple[str, dict[str, Any]]]:
    """Names and tables of all files. Raises CaseError with every case that has no counterpart."""
    wrong = [one.refused for one in found if one.refused]
    files: list[tuple[str, dict[str, Any]]] = []
    for steps in sequences(found):
        if any(step.refused for step in steps):
            continue
        try:
            for step in steps[1:]:
                changes_of(step, steps, source.name)
            files.append((steps[0].case.name, joined(steps, source.name)))
        except CaseError as error:
            wrong.append(str(error))
    if wrong:
        raise CaseError(wrong)
    return files


def write_cases(files: list[tuple[str, dict[str, Any]]], source: Path, folder: Path) -> list[Path]:
    """Writes them and their undeformed distances and copies profiles; gives the TOML files.

    Raises CaseError where a profile is missing; OSError.
    """
    profiles: dict[str, Path] = {}
    for _, tables in files:
        for table, key in named_profiles(tables):
            profiles[table[key]] = source.parent / table[key]
    for name in profiles:
        if text := missing_profile(name, source):
            raise CaseError(text)
    if len({place.name for place in profiles.values()}) < len(profiles):
        raise CaseError(f"{source.name}: names several profiles alike in different folders")
    folder.mkdir(parents=True, exist_ok=True)
    for place in profiles.values():
        if place.resolve() != (folder / place.name).resolve():
            shutil.copyfile(place, folder / place.name)
    written = []
    for name, tables in files:
        whole = copy.deepcopy(tables)
        for table, key in named_profiles(whole):
            table[key] = Path(table[key]).name
        rows = whole.get("geometry", {}).get("undeformed_distance")
        if rows is not None:
            gap = f"{name}_gap.csv"
            lines = (",".join(repr(float(value)) for value in row) for row in rows)
            write_whole(folder / gap, ("\n".join(lines) + "\n").encode())
            whole["geometry"]["undeformed_distance"] = gap
        written.append(write_whole(folder / f"{name}.toml", toml_of(whole).encode()))
    return written


def missing_profile(name: str, source: Path) -> str | None:
    """What is said of a profile that an input file names and that is not there."""
    place = source.parent / name
    return None if place.is_file() else f"{source.name}: the profile {name!r} is not there: {place}"


def named_profiles(tables: dict[str, Any]) -> list[tuple[dict[str, Any], str]]:
    """Tables and keys that name a profile's file."""
    own = tables.get("profiles", {})
    found = [(own, body) for body in ("wheel", "rail") if body in own]
    for table in ("wheelset", "track"):
        for side in ("left", "right"):
            sections = tables.get(table, {}).get(side, {}).get("sections", ())
            found += [(section, "profile") for section in sections]
    return found


def toml_of(table: dict[str, Any], name: str = "") -> str:
    """Of tables of texts, numbers and lists, whose spelling TOML shares with JSON."""
    plain = {key: value for key, value in table.items() if not isinstance(value, dict)}
    lines = [f"[{name}]"] if name and plain else []
    lines += [f"{key} = {value_of(value)}" for key, value in plain.items()]
    parts = ["\n".join(lines) + "\n"] if lines else []
    for key, value in table.items():
        if isinstance(value, dict):
            parts.append(toml_of(value, f"{name}.{key}" if name else key))
    return "\n".join(parts)


def value_of(value: Any) -> str:
    """Of a text, a number or a list, perhaps of tables."""
    if isinstance(value, list) and value and isinstance(value[0], dict):
        rows = [
            ", ".join(f"{key} = {value_of(item)}" for key, item in row.items()) for row in value
        ]
        return "[\n" + "".join(f"  {{ {row} }},\n" for row in rows) + "]"
    return json.dumps(value, allow_nan=False)
