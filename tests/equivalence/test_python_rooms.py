"""Imports between the rooms of the Python packages: in the order of their table, no circles."""

from __future__ import annotations

import ast
import re
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
TABLE = ROOT / "plugins/python_mbs/README.md"
PACKAGES = (ROOT / "plugins/python_mbs/railpatch", ROOT / "rig_model", ROOT / "wheelset_demo")
EVIDENCE = "railpatch.evidence"
COMMANDS = "railpatch.command.group"
# compiled: no source to read
CORE = "railpatch._core"

Sources = dict[str, str]
Imports = dict[str, set[str]]


@cache
def rooms() -> list[str]:
    """From the floor up."""
    found = re.findall(r"^\| `([\w.]+)` \|", TABLE.read_text(encoding="utf-8"), re.MULTILINE)
    assert len(found) == len(set(found)) > 10
    return found


@cache
def sources() -> Sources:
    """Module -> its text. A package's own module ends in '.__init__'."""
    return {
        ".".join(path.relative_to(package.parent).with_suffix("").parts): path.read_text("utf-8")
        for package in PACKAGES
        for path in sorted(package.rglob("*.py"))
    }


def name_of(module: str) -> str:
    """As it is imported."""
    return module.removesuffix(".__init__")


def imports_of(module: str, text: str, known: set[str]) -> set[str]:
    """The modules of these packages that a module imports, anywhere in its text."""
    found = set()
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Import):
            names = [(alias.name, alias.name) for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{module}:{node.lineno}: a relative import"
            whole = str(node.module)
            names = [(f"{whole}.{alias.name}", whole) for alias in node.names]
        else:
            continue
        for full, package in names:
            if full in known:
                found.add(full)
            elif package in known and full != CORE:
                found.add(package)
    # a package's module imports those in it; these import the package by being imported
    return found - {name_of(module)}


def graph_of(texts: Sources) -> Imports:
    """Module -> what it imports."""
    known = {name_of(module) for module in texts}
    return {name_of(m): imports_of(m, text, known) for m, text in texts.items()}


def circle(graph: Imports) -> list[str]:
    """Modules that import each other, one after the other; empty where there are none."""
    done: set[str] = set()
    path: list[str] = []

    def visit(module: str) -> list[str]:
        if module in path:
            return [*path[path.index(module) :], module]
        if module in done:
            return []
        path.append(module)
        found = next(filter(None, map(visit, sorted(graph[module]))), [])
        path.pop()
        done.add(module)
        return found

    return next(filter(None, map(visit, sorted(graph))), [])


def room_of(module: str, order: list[str]) -> str:
    """The room with the longest name that the module is in."""
    inside = [room for room in order if module == room or module.startswith(f"{room}.")]
    assert inside, f"{module}: in no room of {TABLE.name}"
    return max(inside, key=len)


def upward(graph: Imports, order: list[str]) -> list[str]:
    """Imports of rooms below in the table."""
    return [
        f"{module} ({room_of(module, order)}) imports {other} ({room_of(other, order)})"
        for module, others in graph.items()
        for other in sorted(others)
        if order.index(room_of(other, order)) > order.index(room_of(module, order))
    ]


def test_no_circles() -> None:
    """No two modules import each other, directly or around."""
    assert " -> ".join(circle(graph_of(sources()))) == ""


def test_order_of_rooms() -> None:
    """A room imports those above it in the table."""
    assert upward(graph_of(sources()), rooms()) == []


def test_every_room_holds_modules() -> None:
    """The table has no row for what is gone, and every folder of the package is in it."""
    held = {room_of(module, rooms()) for module in graph_of(sources())}
    assert held == set(rooms())
    folders = {f"railpatch.{path.parent.name}" for path in PACKAGES[0].glob("*/__init__.py")}
    assert folders <= set(rooms())


def test_nothing_imports_the_evidence() -> None:
    """Only by its name in the command table."""
    outside = [
        f"{module} imports {other}"
        for module, others in graph_of(sources()).items()
        for other in others
        if other.startswith(EVIDENCE) and not module.startswith(EVIDENCE)
    ]
    assert outside == []
    # by a name that is loaded later
    named = {
        module
        for module, text in sources().items()
        for node in ast.walk(ast.parse(text))
        if isinstance(node, ast.Constant) and re.match(r"(railpatch\.)?evidence\.", str(node.value))
    }
    assert {m for m in named if not m.startswith(EVIDENCE)} == {COMMANDS}


CHAIN = {"a": "import b", "b": "def f():\n    import c", "c": "from a import x"}
FOLDER = {"a": "import b", "b": "from c import d", "c.__init__": "", "c.d": "import b"}
PLAIN = {"a": "from b import c", "b.__init__": "", "b.c": ""}
UPWARD = {"low": "", "low.part": "def f():\n    from high.part import x", "high.part": "import low"}


@pytest.mark.parametrize(
    ("texts", "shown"), [(CHAIN, "a -> b -> c -> a"), (FOLDER, "b -> c.d -> b"), (PLAIN, "")]
)
def test_a_circle_is_named(texts: Sources, shown: str) -> None:
    """The check finds what it looks for, also in functions and by names of packages."""
    assert " -> ".join(circle(graph_of(texts))) == shown


def test_an_upward_import_is_named() -> None:
    """The check finds what it looks for."""
    found = upward(graph_of(UPWARD), ["low", "high"])
    assert found == ["low.part (low) imports high.part (high)"]
