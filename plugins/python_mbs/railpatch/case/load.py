"""Loading a case from a TOML file or a dictionary."""

from __future__ import annotations

import sys
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from pydantic import BaseModel, Field, TypeAdapter, ValidationError

from railpatch.case.homes import Tables
from railpatch.case.messages import problems
from railpatch.case.patch import PatchCase
from railpatch.case.types import show
from railpatch.case.wheel import WheelRailCase, WheelsetCase
from railpatch.errors import CaseError

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

Case = PatchCase | WheelRailCase | WheelsetCase
KINDS: dict[str, type[PatchCase] | type[WheelRailCase] | type[WheelsetCase]] = {
    "patch": PatchCase,
    "wheel_rail": WheelRailCase,
    "wheelset": WheelsetCase,
}
# bytes of a file and tables or arrays in each other, far above what any scene has
LARGEST = 64_000_000
DEEPEST = 32
# suffixes of files that hold numbers, not scenes
TABLES = (".csv", ".tsv", ".txt", ".dat", ".parquet", ".xlsx", ".mat")
# tables that a contact case has not, by which files of other commands are known
OTHERS = {
    "match": "match",
    "sweep": "sweep",
    "vehicle": "vehicle",
    "rig": "rig",
    "curve": "curve",
    "body": "wheelset",
}


@dataclass(frozen=True)
class Scene:
    """A checked case and the folder that its paths start from."""

    case: Case
    folder: Path


def load_scene(source: Mapping[str, Any] | str | Path, folder: str | Path | None = None) -> Scene:
    """Checks a case given as a dictionary or as the path of a TOML file.

    folder: where relative paths start; default: the file's folder, for a dictionary the working
        directory. Raises CaseError with every problem found.
    """
    if isinstance(source, Mapping):
        content, home = dict(source), Path(folder or ".")
    elif not isinstance(source, str | PathLike):
        raise CaseError(
            f"case: value is {show(source)}, allowed a dictionary or the path of a TOML file"
        )
    else:
        path = Path(source)
        content, home = read_toml(path), Path(folder or path.parent)
    refuse_others(content)
    return Scene(check_case(plain(content)), home)


def refuse_others(content: Mapping[str, Any], command: str | None = None) -> None:
    """Says once what a file of another command is, in place of all its unknown keys.

    command: the one that its scenes are for; None: contact cases. Raises CaseError.
    """
    found = next((name for table, name in OTHERS.items() if table in content), None)
    if found == command or (found is None and content.get("kind") not in KINDS):
        return
    wanted = f"one of railpatch {command}" if command else "a contact case"
    own = ", ".join(f"[{table}]" for table, name in OTHERS.items() if name == command)
    shown = f"a scene of railpatch {found}" if found else f"a contact case, without {own}"
    inside = any(table in content for table, name in OTHERS.items() if name == command)
    more = f": it is without its table [{found}]" if inside and found == "match" else ""
    raise CaseError(f"this is {shown}, allowed {wanted}{more}")


def read_toml(path: Path) -> dict[str, Any]:
    """The content of a TOML file."""
    try:
        size = path.stat().st_size
        if size > LARGEST:
            raise CaseError(f"{path}: has {size} bytes, allowed at most {LARGEST}")
        content = tomllib.loads(path.read_text(encoding="utf-8"))
        if depth(content) > DEEPEST:
            raise RecursionError
    except OSError as error:
        raise CaseError(f"{path}: cannot be read: {error.strerror or error}") from None
    except UnicodeDecodeError:
        raise CaseError(f"{path}: is not a text file in UTF-8{_table_hint(path)}") from None
    except tomllib.TOMLDecodeError as error:
        raise CaseError(f"{path}: is not TOML: {error}{_table_hint(path)}") from None
    except RecursionError:
        raise CaseError(f"{path}: is nested too deeply, allowed {DEEPEST} levels") from None
    return content


def _table_hint(path: Path) -> str:
    """What reads a table of numbers, where one was given in place of a scene."""
    if path.suffix.lower() not in TABLES:
        return ""
    return (
        f"; scenes, sweeps and wear are TOML files, and a table of numbers ({path.suffix}) is read"
        " where one names it, as a record or a profile: 'railpatch init' writes some to start from"
    )


def depth(content: Any) -> int:
    """How many tables and arrays lie in each other at most; counted without recursion."""
    level, found = [content], 0
    while level := [v for v in level if isinstance(v, dict | list)]:
        found += 1
        level = [v for part in level for v in (part.values() if isinstance(part, dict) else part)]
    return found


def plain(value: Any) -> Any:
    """numpy arrays and numbers, tuples and mappings as plain Python values."""
    if isinstance(value, np.ndarray | np.generic):
        return value.tolist()
    if isinstance(value, Mapping):
        return {key: plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    return value


def check_case(content: dict[str, Any], beside: Iterable[str] = ()) -> Case:
    """The checked case. beside: further tables that its file may have, taken out of the content,
    by name, with their models where a key of theirs may have got elsewhere. Raises CaseError."""
    kind = content.get("kind")
    model = KINDS.get(kind) if isinstance(kind, str) else None
    if model is None:
        shown = show(kind) if "kind" in content else "missing"
        raise CaseError(f"kind: value is {shown}, allowed 'patch', 'wheel_rail' or 'wheelset'")
    return check_table(model, content, beside=beside)


def check_table(
    model: type[BaseModel],
    content: Any,
    prefix: str = "",
    beside: Iterable[str] = (),
    among: Tables = (),
) -> Any:
    """One checked table of a case. prefix: its key. beside: as check_case. among: files, by the
    names of their tables, in which keys that are unknown here are looked for, before contact
    cases. Raises CaseError."""
    try:
        return model.model_validate(content)
    except ValidationError as error:
        # of other kinds too: whoever writes a key of theirs learns which
        files = (*among, *(kind.model_fields for kind in KINDS.values()))
        raise CaseError(problems(model, error, prefix, beside, files)) from None


def json_schema() -> dict[str, Any]:
    """The JSON schema of a case file."""
    adapter: TypeAdapter[Any] = TypeAdapter(Annotated[Case, Field(discriminator="kind")])
    schema = adapter.json_schema()
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "Railpatch case file",
        **schema,
    }
