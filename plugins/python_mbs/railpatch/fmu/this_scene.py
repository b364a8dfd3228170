"""The table "This scene" of an FMU's page: the case that it was made of, key by key."""

from __future__ import annotations

from collections.abc import Iterator
from html import escape
from typing import Any

from pydantic import BaseModel

from railpatch.case.load import Case

# what is a variable of the FMU stands in the tables of variables; these are fixed when it is packed
LEFT_OUT = {"kind"}
LONGEST = 120  # characters of a value


def scene_table(case: Case, inputs: set[str]) -> str:
    """HTML. inputs: names of variables, whose values are start values."""
    rows = ["<tr><th>key of the case</th><th>value</th><th>meaning</th></tr>"]
    rows.append(f"<tr><td><code>kind</code></td><td>{escape(case.kind)}</td><td></td></tr>")
    for name, value, meaning, _ in keys_of(case, ""):
        if name in inputs or name in LEFT_OUT:
            continue
        cells = (f"<code>{escape(name)}</code>", escape(spelled(value)), escape(meaning))
        rows.append("<tr>" + "".join(f"<td>{cell}</td>" for cell in cells) + "</tr>")
    return "<table>\n" + "\n".join(rows) + "\n</table>"


def keys_of(model: BaseModel, before: str) -> Iterator[tuple[str, Any, str, bool]]:
    """Name, value and meaning of every key that has a value, and whether it is the default."""
    for name, field in type(model).model_fields.items():
        value = getattr(model, name)
        if value is None:
            continue
        whole = f"{before}{name}"
        if isinstance(value, BaseModel):
            yield from keys_of(value, f"{whole}.")
        else:
            yield whole, value, field.description or "", value == field.default


def spelled(value: Any) -> str:
    """As in a case file; long lists are cut."""
    text = "true" if value is True else "false" if value is False else str(value)
    return text if len(text) <= LONGEST else f"{text[:LONGEST]} ..."
