"""The kinds of scene files: what their tables are, an example of each, the command that takes it.

Packages that run contacts add kinds of their own by entry points of the group "railpatch.kinds",
each the name of a function that gives a SceneKind.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cache
from importlib import resources
from importlib.metadata import entry_points
from pathlib import Path
from typing import Any

from pydantic import BaseModel, create_model

from railpatch._core import version
from railpatch.case.load import KINDS, read_toml
from railpatch.errors import CaseError
from railpatch.writing import write_whole

ENTRY_POINT_GROUP = "railpatch.kinds"
# tables that may stand in scenes of other packages' kinds, for commands that take such: the name of
# a function that gives the table's model and whether a kind may have it
TABLE_GROUP = "railpatch.tables"


@dataclass(frozen=True)
class Ending:
    """How a solve or a run ended: its status, why it is not good, warnings, and its numbers."""

    status: str
    reason: str | None
    warnings: list[str]
    values: dict[str, Any]


@dataclass(frozen=True)
class Prepared:
    """A run's scene with its record, for a match: content with what nobody said, forces: names of
    all that were measured, units: of the record's columns, and warnings."""

    content: dict[str, Any]
    forces: tuple[str, ...]
    units: dict[str, str]
    warnings: list[str]


@dataclass(frozen=True)
class SceneKind:
    """One kind of scene file.

    model: its tables. scene: an example, with the files that it names beside it. command: what
    takes such a file, with SCENE for its name. run: of a run, runs a scene's file and writes the
    log to another; raises CaseError, ProfileError, OSError. None: one contact, which is solved.
    follow: of a run that can be matched, takes a scene's content, the folder of its files, names of
    what is measured and what is unknown in each row, and gives what railpatch.match.model asks of
    a ``Followed``. prepare: of the same, takes the content, the folder and what is unknown in each
    row, and gives it ``Prepared`` for a match. base: the kind whose example this one's names, which
    is written beside. units: of a run's own numbers by their dotted names, or by the name of the
    table that they stand in. others: further examples of the kind, written beside it.
    """

    name: str
    model: type[BaseModel]
    scene: Path
    command: str
    run: Callable[[Path, Path], Ending] | None = None
    base: str | None = None
    follow: Callable[..., Any] | None = None
    prepare: Callable[..., Prepared] | None = None
    others: tuple[Path, ...] = ()
    units: Mapping[str, str] = field(default_factory=dict)

    def schema(self) -> dict[str, Any]:
        """The JSON schema of such files, with tables that other commands read of them."""
        model = self.model
        for entry in sorted(entry_points(group=TABLE_GROUP), key=lambda entry: entry.name):
            table, may_have = entry.load()()
            if may_have(self):
                model = with_tables(model, {entry.name: table}, entry.name)
        return {
            "$schema": "https://json-schema.org/draft/2020-12/schema",
            "$id": f"urn:railpatch:{version()}:{self.name}",
            **model.model_json_schema(),
            "title": f"Railpatch scene: {self.name}",
        }

    def files(self) -> list[Path]:
        """The profile files that the example names."""
        found = set()
        for scene in (self.scene, *self.others):
            named = read_toml(scene).get("profiles", {}).values()
            places = [scene.parent / name for name in named if isinstance(name, str)]
            found |= {place for place in places if place.is_file()}
        return sorted(found)


def with_tables(
    case: type[BaseModel], tables: Mapping[str, Any], *optional: str
) -> type[BaseModel]:
    """A case's model with tables of a run beside its own. optional: those that may be left out."""
    fields: dict[str, Any] = {
        name: (table | None, None) if name in optional else (table, ...)
        for name, table in tables.items()
    }
    return create_model(f"Run{case.__name__}", __base__=case, **fields)


@cache
def kinds() -> dict[str, SceneKind]:
    """All kinds by name: those of one contact first."""
    examples = {"patch": "patch", "wheel_rail": "wheel", "wheelset": "wheelset_rail"}
    folder = Path(str(resources.files("railpatch.fmu"))) / "kinds"
    found = {
        name: SceneKind(name, KINDS[name], folder / f"{file}.toml", "railpatch solve SCENE")
        for name, file in examples.items()
    }
    entries = sorted(entry_points(group=ENTRY_POINT_GROUP), key=lambda entry: entry.name)
    return found | {entry.name: entry.load()() for entry in entries}


def kind_of(name: str) -> SceneKind:
    """The kind of that name. Raises CaseError."""
    if name not in kinds():
        raise CaseError(f"kind: value is {name!r}, allowed {', '.join(kinds())}")
    return kinds()[name]


def contents_of(kind: SceneKind) -> dict[str, bytes]:
    """Of the files of the example by name: the scene, its schema, what the scene names."""
    schema = f"{kind.name}.schema.json"
    head = f"#:schema {schema}\n".encode()
    return {
        f"{kind.name}.toml": head + kind.scene.read_bytes(),
        **{scene.name: head + scene.read_bytes() for scene in kind.others},
        schema: (json.dumps(kind.schema(), indent=2) + "\n").encode(),
        **{file.name: file.read_bytes() for file in kind.files()},
        **(contents_of(kind_of(kind.base)) if kind.base else {}),
    }


def write_example(kind: SceneKind, folder: Path) -> list[Path]:
    """Writes the example into a folder; returns what was written, the scene first.

    Raises CaseError where one of the files is there already, then nothing is written; OSError.
    """
    contents = contents_of(kind)
    there = [name for name in contents if (folder / name).exists()]
    if there:
        raise CaseError(f"{folder}: has {', '.join(there)}, allowed a folder without")
    folder.mkdir(parents=True, exist_ok=True)
    return [write_whole(folder / name, content) for name, content in contents.items()]
