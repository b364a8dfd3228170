"""Units of a scene's keys, which stand at the beginning of their descriptions."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

# what stands before the comma or colon of a description, or in brackets at its end
UNIT = (
    r"-|%|s|m|m/s|m/s\^2|mm|rad|rad/s|rad/m|1/m|1/s|Hz|N|N/m|N s/m|N m|N m/rad|N m s/rad|kg|"
    r"kg m\^2|Pa|Pa/m|K|degrees C|s/m|m\^2|W/K|W/\(m K\)|J/\(kg K\)|kg/m\^3|J|J/m|kg/J|Pa s|1/Pa|"
    r"m\^3/s|N m/s"
)
BEFORE = re.compile(
    rf"^\(?((?:{UNIT})(?:(?: or |, )(?:{UNIT}))*|no unit|a unit|as of the key)\)?[,:;] ?"
)
WITHIN = re.compile(rf"\(((?:(?:{UNIT})(?:, )?)+|no unit|the column's unit|file|file or \w+)\)")
ALONE = re.compile(rf"^(?:{UNIT})$")
BRACKET = re.compile(r"^\[([^\]]*)\], ")
# "m, N" of rows with two numbers
APART = r", | or "


def unit_of_text(text: str) -> str:
    """Of a description: "-" of plain numbers, "" of what is no number."""
    if ALONE.match(text):
        return text
    found = BEFORE.match(text) or BRACKET.match(text) or WITHIN.search(text)
    return "" if found is None or found[1] in ("no unit", "a unit") else found[1]


def parts_of_unit(text: str) -> list[str]:
    """Of a description, by the numbers of a row: one of plain numbers and of lists."""
    unit = unit_of_text(text)
    return [""] if unit in ("as of the key", "the column's unit") else re.split(APART, unit)


def tables_of(schema: dict[str, Any], names: dict[str, Any]) -> Iterator[tuple[str, Any]]:
    """What a key's schema has below it: what follows the key's path, and the table."""
    for option in (schema, *schema.get("anyOf", ()), *schema.get("oneOf", ())):
        more = option.get("additionalProperties")
        places = [("", option), ("[]", option.get("items"))]
        places += [(".*", more)] if isinstance(more, dict) else []
        for suffix, place in places:
            if isinstance(place, dict) and "$ref" in place:
                yield suffix, names[place["$ref"].rsplit("/", 1)[-1]]


def unit_of_key(schema: dict[str, Any], steps: list[str | int]) -> str:
    """Of a key of a scene whose schema this is, by its names and numbers of lists; "" where none
    is known."""
    names, here = schema.get("$defs", {}), [schema]
    words = [step for step in steps if isinstance(step, str)]
    for place, word in enumerate(words):
        known = [table["properties"][word] for table in here if word in table.get("properties", {})]
        if place + 1 == len(words):
            units = [unit_of_text(str(key.get("description", ""))) for key in known]
            unit = next(filter(None, units), "")
            parts = re.split(APART, unit)
            last = steps[-1] if isinstance(steps[-1], int) else 0
            return parts[min(last, len(parts) - 1)]
        here = [table for key in known for _, table in tables_of(key, names)]
    return ""
