"""The table of the FMU's variables: expands variables.toml for a scene, or for the C++ table.

Imports nothing of the package, so that the build can use it before the package exists.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

# as railpatch.case.types has them: the build reads this file before there is a package
SIDES = ("left", "right")
MAX_PATCHES = 6
# of an enumeration that the scene fills
MOST_ITEMS = 1000
# each acts on the outputs of its own level and of all that follow
LEVELS = ("none", "height", "pose", "rolling", "sliding", "friction", "temperature")


@dataclass(frozen=True)
class Kind:
    """What the scene has, as far as the variables depend on it."""

    kind: str
    sides: tuple[int, ...]  # 0: left, 1: right
    max_patches: int
    conditions: frozenset[str]  # "tangential", "force" or "position", "roller", ...

    @property
    def coupled(self) -> bool:
        """Whether z is found, so that everything acts on everything."""
        return self.kind != "patch" and "force" in self.conditions

    @property
    def has_history(self) -> bool:
        """Whether a step depends on earlier ones."""
        return "history" in self.conditions


@dataclass(frozen=True)
class Variable:
    """One scalar variable."""

    reference: int
    name: str
    type: str  # declared type
    base: str  # "Real", "Integer" or "Enumeration"
    causality: str
    field: str  # of rp_input or rp_result
    plus: str  # second field that is added; may be empty
    level: str  # one of LEVELS: what it affects or depends on
    side: int | None
    range: tuple[float, float]
    description: str
    start: float | int | str | None = None
    fixed: bool = False  # a parameter that keeps its value after initialization
    patch: int | None = None
    mean_of: int = 0  # of a mean over a step: the value reference of what it is the mean of
    absent: str = ""  # what it is where its patch is not: 0, or the warmer bulk temperature
    component: int = 0  # of a vector, from 1; 0: a number of its own
    size: int = 1  # components of that vector, whether the scene has them or not
    held: bool = False  # always 0: a component without effect, of an array


@dataclass(frozen=True)
class Item:
    """What modelDescription.xml lists: a number, or in FMI 3.0 the array of a vector."""

    name: str
    variables: tuple[Variable, ...]

    @property
    def first(self) -> Variable:
        """The component whose value reference is the array's."""
        return self.variables[0]

    @property
    def is_array(self) -> bool:
        """Whether it is one."""
        return len(self.variables) > 1

    @property
    def description(self) -> str:
        """Of the whole; of the components where these differ."""
        texts = [v.description for v in self.variables if not v.held]
        if len(set(texts)) == 1:
            return texts[0]
        return "; ".join(f"[{v.component}] {v.description}" for v in self.variables if not v.held)


def items_of(variables: list[Variable], version: int) -> list[Item]:
    """In their order; in FMI 3.0 the components of a vector are together where all are there."""
    if version == 2:
        return [Item(v.name, (v,)) for v in variables]
    vectors: dict[int, list[Variable]] = {}
    for v in variables:
        if v.component:
            vectors.setdefault(v.reference - v.component + 1, []).append(v)
    found = []
    for v in variables:
        parts = vectors.get(v.reference - v.component + 1, [v]) if v.component else [v]
        if len(parts) < max(v.size, 2):
            found.append(Item(v.name, (v,)))
        elif v is parts[0]:
            found.append(Item(v.name.rpartition("[")[0], tuple(parts)))
    return found


class Table:
    """The content of variables.toml."""

    def __init__(self, path: Path) -> None:
        content = tomllib.loads(path.read_text(encoding="utf-8"))
        self.types: dict[str, dict[str, Any]] = content["type"]
        self._rows = [
            {key: value for key, value in group.items() if key != "variables"} | row
            for group in content["group"]
            for row in group["variables"]
        ]
        self._sizes: dict[tuple[str, str, int], int] = {}
        for row in self._rows:
            key = vector_of(row)
            self._sizes[key] = max(self._sizes.get(key, 1), *row.get("components", [1]))

    def fill(self, name: str, items: list[str]) -> None:
        """Gives an enumeration the scene's items."""
        self.types[name] = {**self.types[name], "items": items}

    def variables(self, kind: Kind) -> list[Variable]:
        """The variables of a scene, inputs and parameters first."""
        found = [v for row in self._rows if exists(row, kind) for v in self._expand(row, kind)]
        last = ("output", "independent", "local")
        return sorted(found, key=lambda v: (v.causality in last, v.reference))

    def everything(self) -> list[Variable]:
        """All variables of all scenes, by value reference; for the C++ table."""
        most = Kind("wheelset", (0, 1), MAX_PATCHES, frozenset())
        found: dict[int, Variable] = {}
        for row in self._rows:
            # C++ knows it as a parameter; scene.txt tells that it is an input
            if "friction input" in row.get("when", ()):
                continue
            for v in self._expand(row, most):
                # rows of one variable differ in when they hold only
                same = found.setdefault(v.reference, v)
                if (same.causality, same.field) != (v.causality, v.field):
                    raise ValueError(f"value reference {v.reference}: {same.name} and {v.name}")
        return [found[reference] for reference in sorted(found)]

    def base(self, name: str) -> str:
        """FMI's base type of a declared type."""
        declared = self.types[name]
        if "unit" in declared:
            return "Real"
        if "text" in declared:
            return "String"
        if "flag" in declared:
            return "Boolean"
        return "Enumeration" if "items" in declared else "Integer"

    def range(self, name: str) -> tuple[float, float]:
        """Smallest and largest value of a declared type."""
        declared = self.types[name]
        if "items" in declared:
            first = first_item(declared)
            # of an empty list the scene has the items: as many as it likes
            return first, first + (len(declared["items"]) or MOST_ITEMS) - 1
        if "text" in declared:
            return 0, 4294967296.0  # the number of a file: 1 and its CRC-32
        return tuple(declared["range"])

    def _expand(self, row: dict[str, Any], kind: Kind) -> Iterator[Variable]:
        """One row for every side, patch and component."""
        for side, patch in places(row["scope"], kind):
            names = {"side": "" if side is None else SIDES[side], "s": side, "p": patch}
            prefix = prefix_of(row, kind, side, patch)
            for number in row.get("components", [None]):
                index = "" if number is None else f"[{number}]"
                names["k"] = 0 if number is None else number - 1
                yield Variable(
                    reference=reference_of(row, side, patch) + names["k"],
                    name=prefix + row["name"].format(**names) + index,
                    type=row["type"],
                    base=self.base(row["type"]),
                    causality=row["causality"],
                    field=row["field"].format(**names),
                    plus=row.get("plus", "").format(**names),
                    level=level_of(row, kind),
                    side=side,
                    range=self.range(row["type"]),
                    description=row["description"].format(**names),
                    start=row.get("start"),
                    fixed=row.get("fixed", False),
                    patch=patch,
                    mean_of=mean_of(row, side, patch, names["k"]),
                    absent=row.get("absent", ""),
                    component=number or 0,
                    size=self._sizes[vector_of(row)],
                    held=row.get("held", False),
                )


def vector_of(row: dict[str, Any]) -> tuple[str, str, int]:
    """What the components of a vector have in common."""
    return row["name"], row["causality"], row["reference"]


def first_item(declared: dict[str, Any]) -> int:
    """The number of an enumeration's first item."""
    return declared.get("first", 0)


def exists(row: dict[str, Any], kind: Kind) -> bool:
    """Whether the scene has the variable."""
    needed = set(row.get("when", ()))
    if kind.kind == "patch":
        needed |= set(row.get("when_patch", ()))
    refused = set(row.get("without", ())) & kind.conditions
    return kind.kind in row.get("kinds", [kind.kind]) and needed <= kind.conditions and not refused


def places(scope: str, kind: Kind) -> list[tuple[int | None, int | None]]:
    """Side and patch of every occurrence."""
    if scope == "scene":
        return [(None, None)]
    if scope == "side":
        return [(side, None) for side in kind.sides]
    return [(side, patch) for side in kind.sides for patch in range(kind.max_patches)]


def reference_of(row: dict[str, Any], side: int | None, patch: int | None) -> int:
    """Value reference of the first component."""
    return (
        row["reference"]
        + (0 if side is None else 1000 * (side + 1))
        + (0 if patch is None else 100 * (patch + 1))
    )


def mean_of(row: dict[str, Any], side: int | None, patch: int | None, component: int) -> int:
    """Value reference of what a variable is the mean of; 0: it is none."""
    if "mean_of" not in row:
        return 0
    return reference_of({"reference": row["mean_of"]}, side, patch) + component


def level_of(row: dict[str, Any], kind: Kind) -> str:
    """What an input affects, or an output depends on."""
    if "depends_frictionless" in row and "tangential" not in kind.conditions:
        return row["depends_frictionless"]
    if "depends_fast" in row and "fast" in kind.conditions:
        return row["depends_fast"]
    return row.get("affects") or row.get("depends", "none")


def prefix_of(row: dict[str, Any], kind: Kind, side: int | None, patch: int | None) -> str:
    """What stands before the name of an output."""
    if row["causality"] != "output" or kind.kind == "patch":
        return ""
    prefix = f"{SIDES[side]}." if side is not None and kind.kind == "wheelset" else ""
    return prefix if patch is None else f"{prefix}patch[{patch + 1}]."


def dependencies(output: Variable, inputs: list[Variable], kind: Kind) -> list[Variable]:
    """The inputs and parameters that act on an output."""
    level = LEVELS.index(output.level)
    found = ("wheelset.mass", "wheelset.inertia")
    inputs = [
        v
        for v in inputs
        if v.level != "none" or (output.name == "largest_step" and v.name.startswith(found))
    ]
    if output.level != "temperature":
        inputs = [v for v in inputs if v.level != "temperature"]
    if kind.coupled and level > 0:
        return inputs
    # rails that give way move by the forces, both found by one iteration
    if "supported" in kind.conditions and level > LEVELS.index("height"):
        return inputs
    return [
        v
        for v in inputs
        if LEVELS.index(v.level) <= level
        and (v.side is None or output.side is None or v.side == output.side)
        and has_shape(v, output.side, kind)
    ]


def has_shape(known: Variable, side: int | None, kind: Kind) -> bool:
    """Whether the side's wheel or rail varies with x or pitch, if it is one of these."""
    if side is None or known.field not in ("x", "pitch"):
        return True
    return f"{known.field} {SIDES[side]}" in kind.conditions


def with_start(variable: Variable, start: float | int | str) -> Variable:
    """The variable with a start value."""
    return replace(variable, start=start)
