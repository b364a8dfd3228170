"""Keys of scenes, from their JSON schemas: reference/keys/KIND.md."""

from __future__ import annotations

import json
import re
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from railpatch.case.key_units import ALONE, BEFORE, BRACKET, tables_of, unit_of_text

from making import ROOT, Pages, cell, code, table

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib


@dataclass(frozen=True)
class Key:
    """One key of a scene: its own name, and the dotted path of the table that it stands in, with []
    in lists of tables and * for any name."""

    name: str
    holder: str
    schema: dict[str, Any]
    required: bool
    is_table: bool

    @property
    def path(self) -> str:
        """Dotted."""
        return f"{self.holder}.{self.name}" if self.holder else self.name

    @property
    def text(self) -> str:
        """What the schema says of it."""
        return str(self.schema.get("description", ""))

    @property
    def unit(self) -> str:
        """Its unit: "-" of plain numbers, "" of what is no number."""
        return unit_of_text(self.text)

    @property
    def meaning(self) -> str:
        """The description without a unit at its beginning."""
        if ALONE.match(self.text):
            return self.name.replace("_", " ")
        return BRACKET.sub("", BEFORE.sub("", self.text)).strip()


def keys_of(schema: dict[str, Any]) -> list[Key]:
    """All keys of a kind of scene, each once, tables before what stands in them."""
    names, found = schema.get("$defs", {}), {}

    def walk(here: dict[str, Any], prefix: str) -> None:
        for name, content in here.get("properties", {}).items():
            inner = [(s, t) for s, t in tables_of(content, names) if "properties" in t]
            needed = name in here.get("required", ())
            key = Key(name, prefix.removesuffix("."), content, needed, bool(inner))
            found.setdefault(key.path, key)
            for suffix, content_of_table in inner:
                walk(content_of_table, f"{prefix}{name}{suffix}.")

    walk(schema, "")
    return list(found.values())


def spelt(value: Any) -> str:
    """A value as in TOML."""
    if isinstance(value, float):
        return f"{value:g}" if value % 1 or abs(value) >= 1e5 else repr(value)
    if isinstance(value, list):
        return f"[{', '.join(spelt(item) for item in value)}]"
    if isinstance(value, dict):
        return f"{{ {', '.join(f'{key} = {spelt(item)}' for key, item in value.items())} }}"
    return json.dumps(value, ensure_ascii=False)


def range_of(schema: dict[str, Any]) -> str:
    """The values that a schema allows, in words."""
    options = [o for o in schema.get("anyOf", schema.get("oneOf", ())) if o.get("type") != "null"]
    if options:
        return "; or ".join(dict.fromkeys(filter(None, map(range_of, options))))
    if "const" in schema:
        return spelt(schema["const"])
    if "enum" in schema:
        return ", ".join(spelt(word) for word in schema["enum"])
    kind = schema.get("type")
    if kind in ("number", "integer"):
        return ends_of(schema, "whole number" if kind == "integer" else "any number")
    if kind == "array":
        return list_of(schema)
    return {"string": "text", "boolean": "true, false", "object": "table"}.get(str(kind), "table")


def ends_of(schema: dict[str, Any], free: str) -> str:
    """Of a number."""
    low, high = schema.get("minimum"), schema.get("maximum")
    above, below = schema.get("exclusiveMinimum"), schema.get("exclusiveMaximum")
    parts = []
    if low is not None and high is not None:
        parts.append(f"{low:g} to {high:g}")
    else:
        parts += [f">= {low:g}"] if low is not None else []
        parts += [f"> {above:g}"] if above is not None else []
        parts += [f"<= {high:g}"] if high is not None else []
    parts += [f"< {below:g}"] if below is not None else []
    return " and ".join(parts) or free


def list_of(schema: dict[str, Any]) -> str:
    """Of a list."""
    if "prefixItems" in schema:
        return f"list of {'; '.join(range_of(item) for item in schema['prefixItems'])}"
    least, most = schema.get("minItems"), schema.get("maxItems")
    if least == most and least is not None:
        count = f"{least} "
    elif least is not None or most is not None:
        count = f"{least or 0} to {'any number of ' if most is None else most} ".replace("  ", " ")
    else:
        count = ""
    return f"list of {count}({range_of(schema.get('items', {}))})"


def scenes() -> list[dict[str, Any]]:
    """Scenes that stand in the package, the pages and the examples."""
    folders = ("plugins/python_mbs/railpatch", "rig_model", "wheelset_demo", "examples")
    files = [path for name in folders for path in sorted((ROOT / name).rglob("*.toml"))]
    texts = [path.read_text(encoding="utf-8") for path in files]
    for page in sorted((ROOT / "docs").glob("*.md")):
        texts += re.findall(r"```toml\n(.*?)```", page.read_text(encoding="utf-8"), re.DOTALL)
    found = []
    for text in texts:
        try:
            found.append(tomllib.loads(text))
        except tomllib.TOMLDecodeError:
            continue
    return found


def values_by_path(content: Any, prefix: str = "") -> Iterator[tuple[str, Any]]:
    """Every value of a scene with its dotted path."""
    for name, value in content.items():
        yield prefix + name, value
        if isinstance(value, dict):
            yield from values_by_path(value, f"{prefix}{name}.")
        elif isinstance(value, list):
            for item in value:
                if isinstance(item, dict):
                    yield from values_by_path(item, f"{prefix}{name}[].")


def seen_values() -> dict[str, list[Any]]:
    """The values of each key that some scene sets."""
    found: dict[str, list[Any]] = {}
    for scene in scenes():
        for path, value in values_by_path(scene):
            found.setdefault(path, []).append(value)
    return found


def example_of(key: Key, seen: dict[str, list[Any]]) -> str:
    """A value that a scene has there, else the default, else one within the range."""
    words = words_of(key.schema)
    for value in seen.get(key.path, ()):
        if not isinstance(value, dict) and (not words or value in words):
            text = spelt(value)
            return text if len(text) <= 60 else f"{text[:56]} ..."
    default = key.schema.get("default")
    if default is not None and default != []:
        return spelt(default)
    return allowed(key.schema)


def words_of(schema: dict[str, Any]) -> list[Any]:
    """What a choice allows; empty: it is none."""
    return [schema["const"]] if "const" in schema else list(schema.get("enum", ()))


def allowed(schema: dict[str, Any]) -> str:
    """A value within the range that a schema gives."""
    options = [o for o in schema.get("anyOf", ()) if o.get("type") != "null"]
    if options:
        return allowed(options[0])
    if "enum" in schema or "const" in schema:
        return spelt(schema.get("const", schema.get("enum", [""])[-1]))
    kind = schema.get("type")
    if kind == "boolean":
        return "true"
    if kind == "string":
        return '"..."'
    if kind == "array":
        if "prefixItems" in schema:
            return f"[{', '.join(allowed(item) for item in schema['prefixItems'])}]"
        count = schema.get("minItems", 1)
        return f"[{', '.join([allowed(schema.get('items', {}))] * count)}]"
    if kind not in ("number", "integer"):
        return "{ ... }"
    low = schema.get("minimum", schema.get("exclusiveMinimum"))
    high = schema.get("maximum", schema.get("exclusiveMaximum"))
    for value in (1, 0, low, high):
        if value is not None and inside(value, schema):
            return spelt(int(value) if kind == "integer" else float(value))
    return spelt((float(low) + float(high)) / 2)


def inside(value: float, schema: dict[str, Any]) -> bool:
    """Whether a number is within a schema's range."""
    return (
        schema.get("minimum", value) <= value <= schema.get("maximum", value)
        and not schema.get("exclusiveMinimum", value - 1) >= value
        and not schema.get("exclusiveMaximum", value + 1) <= value
    )


def default_of(key: Key) -> str:
    """The default; of a key that is needed, that it is."""
    if key.required:
        return "needed"
    default = key.schema.get("default")
    return "left out" if default is None else code(spelt(default))


def schemas() -> dict[str, tuple[str, dict[str, Any]]]:
    """Kinds of scenes by name: the command that takes such a file, and its schema."""
    from railpatch.case.kinds import kinds
    from railpatch.match.plan import MatchTable

    found = {kind.name: (kind.command, kind.schema()) for kind in kinds().values()}
    match = {"properties": {"match": {"$ref": "#/$defs/MatchTable"}}, "required": ["match"]}
    inner = MatchTable.model_json_schema()
    names = inner.pop("$defs", {})
    match["properties"]["match"]["description"] = inner.get("description", "")
    found["match"] = (
        "railpatch match SCENE -o DIR",
        match | {"$defs": {**names, "MatchTable": inner}},
    )
    return found


def page(name: str, command: str, schema: dict[str, Any], seen: dict[str, list[Any]]) -> str:
    """The page of one kind."""
    keys = keys_of(schema)
    lines = [
        f"# Keys: {name}",
        "",
        f"Scenes of this kind are taken by `{command}`; `railpatch schema --kind {name}` prints the"
        f" schema that this page is made from, `railpatch init {name} DIR` writes an example."
        if name != "match"
        else f"The table that `{command}` reads, beside those of the scene.",
        "Units are SI, temperatures in degrees Celsius.",
        "",
    ]
    tables = {"": ""} | {key.path: key.text for key in keys if key.is_table}
    for holder in dict.fromkeys(key.holder for key in keys):
        here = [key for key in keys if key.holder == holder]
        plain = holder.replace("[]", "").replace(".*", "")
        lines += [f"## {f'`[{holder}]`' if holder else 'At the top'}", ""]
        text = tables.get(holder) or tables.get(plain)
        lines += [cell(text) + ".", ""] if text else []
        rows = [
            [
                code(spelt(key.name) if "[" in key.name else key.name),
                cell(key.unit),
                "a table" if key.is_table else cell(range_of(key.schema)),
                "" if key.is_table else default_of(key),
                "" if key.is_table else code(example_of(key, seen)),
                cell(key.meaning),
            ]
            for key in here
        ]
        lines += [table(["key", "unit", "range", "default", "example", "meaning"], rows), ""]
    return "\n".join(lines)


def pages() -> Pages:
    """All pages of keys."""
    seen = seen_values()
    return {
        f"reference/keys/{name}.md": page(name, command, schema, seen)
        for name, (command, schema) in schemas().items()
    }
