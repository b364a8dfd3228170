"""Keys that are unknown where they stand: the table that has them, or a key that is near."""

from __future__ import annotations

import difflib
from collections.abc import Collection, Iterator, Mapping, Sequence
from typing import Annotated, Any, get_args, get_origin

from pydantic import BaseModel
from pydantic.fields import FieldInfo

from railpatch.case.types import show

# of each file in which a key may stand: names of its tables -> what they are, models or fields
Tables = Sequence[Mapping[str, Any]]
# of tables named in a message, and how alike a key of another table must be
MOST, ALIKE = 3, 0.8


def models_in(annotation: Any) -> Iterator[type[BaseModel]]:
    """Models that a type names: itself, those of a union or a list."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        yield annotation
    for part in get_args(annotation):
        yield from models_in(part)


def is_list(annotation: Any) -> bool:
    """Whether a type is a list, or a list or none."""
    origin = get_origin(annotation)
    if origin is Annotated:
        return is_list(get_args(annotation)[0])
    return origin is list or (origin is not None and any(map(is_list, get_args(annotation))))


def keys_in(tables: Mapping[str, Any], above: str = "") -> Iterator[tuple[str, str]]:
    """(key, table) of all tables of a file: "mass", "[[vehicle.body]]"; of those outside tables
    the table is empty."""
    for name, of in tables.items():
        if not above:
            yield name, ""
        annotation = of.annotation if isinstance(of, FieldInfo) else of
        path = f"{above}.{name}" if above else name
        shown = f"[[{path}]]" if is_list(annotation) else f"[{path}]"
        for model in models_in(annotation):
            for key in model.model_fields:
                yield key, shown
            yield from keys_in(model.model_fields, path)


def homes(name: str, files: Tables) -> list[str]:
    """The tables of the first file that has the key, each once."""
    for tables in files:
        found = list(dict.fromkeys(table for key, table in keys_in(tables) if key == name))
        if found:
            return found
    return []


def unknown_key(key: str, name: str, value: Any, names: Collection[str], files: Tables = ()) -> str:
    """Names the key, what is allowed there, and the table that the key is of, or a key that was
    perhaps meant: of the same table, else of others. files: where it may have its place."""
    text = f"{key}: value is {show(value)}, but the key is unknown, allowed {', '.join(names)}"
    found = homes(name, files)
    close = difflib.get_close_matches(name, names, 1, ALIKE if found else 0.6)
    if found:
        shown = [table or "the top of the file, before all tables" for table in found]
        more = f" and {len(shown) - MOST} more tables" if len(shown) > MOST else ""
        text += f"; {name!r} is a key of {', '.join(shown[:MOST])}{more}"
    if close:
        return f"{text}; did you mean '{close[0]}'?"
    if found:
        return text
    table_of = {known: table for tables in files for known, table in keys_in(tables) if table}
    far = difflib.get_close_matches(name, list(table_of), 1, ALIKE)
    return f"{text}; did you mean '{far[0]}' of {table_of[far[0]]}?" if far else text
