"""The Python interface, from signatures and docstrings: reference/python/MODULE.md."""

from __future__ import annotations

import importlib
import inspect
import re
from types import ModuleType
from typing import Any

from making import Pages

# what is public: __all__ of each
MODULES = (
    "railpatch",
    "railpatch.case",
    "railpatch.profiles",
    "railpatch.record",
    "railpatch.match",
    "railpatch.sweep",
    "railpatch.log",
    "railpatch.export",
    "railpatch.layout",
    "railpatch.report",
    "railpatch.fmu",
    "railpatch.pinocchio",
    "wheelset_demo.vehicle",
)
WIDTH = 88


def public(module: ModuleType) -> list[str]:
    """Its public names, but for the version."""
    return [name for name in module.__all__ if not name.startswith("__")]


def signature(name: str, thing: Any) -> str:
    """name(arguments) -> result, over several lines where it is long."""
    try:
        found = inspect.signature(thing)
    except (TypeError, ValueError):
        return name
    if inspect.isclass(thing):
        found = found.replace(return_annotation=inspect.Signature.empty)
    # annotations are texts, which are not quoted
    parts = [re.sub(r": '([^']*)'", r": \1", str(p)) for p in found.parameters.values()]
    kinds = [p.kind for p in found.parameters.values()]
    if inspect.Parameter.KEYWORD_ONLY in kinds and inspect.Parameter.VAR_POSITIONAL not in kinds:
        parts.insert(kinds.index(inspect.Parameter.KEYWORD_ONLY), "*")
    parts = [part for part in parts if part != "self"]
    end = ")"
    if found.return_annotation is not inspect.Signature.empty:
        returned = found.return_annotation
        end = (
            f") -> {returned if isinstance(returned, str) else inspect.formatannotation(returned)}"
        )
    text = f"{name}({', '.join(parts)}{end}"
    if len(text) <= WIDTH:
        return text
    return f"{name}(\n{''.join(f'    {part},' + chr(10) for part in parts)}{end}"


def doc(thing: Any) -> str:
    """The docstring as Markdown: names in angle brackets stay text."""
    text = inspect.getdoc(thing) or ""
    return text.replace("<", "&lt;").replace("``", "`")


def members(thing: type) -> list[tuple[str, Any, str]]:
    """Public methods and properties of a class that it or this package defines."""
    found = []
    for name, value in (
        inspect.getmembers_static(thing)
        if hasattr(inspect, "getmembers_static")
        else [(n, inspect.getattr_static(thing, n)) for n in dir(thing)]
    ):
        own = next((c for c in thing.__mro__ if name in vars(c)), object)
        inside = own.__module__.split(".")[0] in ("railpatch", "wheelset_demo", "rig_model")
        if name.startswith("_") or not inside or name.startswith("model_"):
            continue
        if isinstance(value, property):
            returned = inspect.signature(value.fget).return_annotation if value.fget else ""
            text = returned if isinstance(returned, str) else inspect.formatannotation(returned)
            found.append((f"{name}: {text}", value, name))
        elif isinstance(value, (staticmethod, classmethod)):
            found.append((signature(name, value.__func__).replace("(cls, ", "("), value, name))
        elif inspect.isfunction(value):
            found.append((signature(name, value), value, name))
    return found


def entry(module: ModuleType, name: str) -> list[str]:
    """Lines of one public name."""
    thing = getattr(module, name)
    lines = [f"## {name}", ""]
    if not callable(thing) and not inspect.isclass(thing):
        return [*lines, f"```python\n{name} = {thing!r}\n```", ""]
    word = "class " if inspect.isclass(thing) else ""
    lines += [f"```python\n{word}{signature(name, thing)}\n```", "", doc(thing), ""]
    if inspect.isclass(thing):
        for text, member, own in members(thing):
            lines += [f"### {name}.{own}", "", f"```python\n{text}\n```", "", doc(member), ""]
    return lines


def pages() -> Pages:
    """A page for each module."""
    found = {}
    for path in MODULES:
        module = importlib.import_module(path)
        lines = [f"# {path}", "", doc(module), ""]
        for name in public(module):
            lines += entry(module, name)
        found[f"reference/python/{path}.md"] = "\n".join(lines)
    return found
