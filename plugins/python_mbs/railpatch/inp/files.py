"""Input files as a whole: their cases in order, and what goes on from case to case."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from railpatch.case.load import check_case
from railpatch.errors import CaseError
from railpatch.inp.blocks import Case, control, read_blocks
from railpatch.inp.mapping import Mapping
from railpatch.inp.words import Reader, read_text


@dataclass(frozen=True)
class Converted:
    """A case, or why there is none.

    begins: the case that its sequence begins with. offset: m, of the grid's middle from the origin
    that the file's moments and creepages are about.
    """

    case: Case
    tables: dict[str, Any] | None
    refused: str | None
    begins: int
    offset: tuple[float, float] = (0.0, 0.0)


def cases_of(path: Path) -> list[Case]:
    """All cases that are to be computed. Raises CaseError with file and line."""
    return read_cases(path.name, read_text(path))


def read_cases(name: str, text: str) -> list[Case]:
    """Of a text."""
    reader = Reader(name, text)
    kept: dict[tuple[int, int, int], Case] = {}
    found: list[Case] = []
    number = 0
    module: tuple[int, int, int] | None = None
    while not reader.ended:
        if module is None:
            line = reader.line
            reader.expect("MODULE REID CPID")
            kind = reader.integer("the module, 0, 1 or 3")
            first, second = reader.optional(), reader.optional()
            reader.end_line()
            if kind == 0:
                return found
            if kind not in (1, 3):
                raise reader.error(f"module {kind}: allowed 0, 1, 3", line)
            module = kind, int(first or 0), int(second if second is not None else 1)
        line = reader.line
        digits = control(reader, module[0])
        number += 1
        case = _next(reader, kept.get(module), module, digits, number, line)
        kept[module] = case
        if case.digits["R"] not in (2, 3):
            found.append(case)
        if case.digits["R"] in (1, 3):
            module = None
    raise reader.error("ends without 'module 0'")


def _next(
    reader: Reader,
    before: Case | None,
    module: tuple[int, int, int],
    digits: dict[str, int],
    number: int,
    line: int,
) -> Case:
    """A case over the one before of the same patch."""
    kind, *patch = module
    if before is None:
        digits["P"] = 2
        if digits["L"] == 1 and digits["T"] != 0:
            raise reader.error("L = 1 in the first case: there is no friction to keep", line)
        if digits["S"] in (1, 2):
            raise reader.error(f"S = {digits['S']} in the first case", line)
    if kind == 1 and before is not None:
        for name in ("D", "C3"):
            if digits[name] < 2:
                digits[name + "_kept"] = 1
    blocks = dict(before.blocks) if before is not None else {}
    case = Case(kind, (patch[0], patch[1]), number, line, digits, blocks)
    case = read_blocks(reader, case)
    # digits that keep what was
    kept = dict(case.digits)
    if before is not None and kind == 1:
        for name in ("D", "C3"):
            if kept[name] < 2:
                kept[name] = before.digits[name]
    return replace(case, digits=kept)


def convert(path: Path) -> list[Converted]:
    """Every case of a file as tables of a TOML, or why not. Raises CaseError where the file cannot
    be read."""
    found = []
    began: dict[tuple[int, tuple[int, int]], int] = {}
    without: set[tuple[int, tuple[int, int]]] = set()  # whose last case has no tractions
    for case in cases_of(path):
        key = case.module, case.patch
        goes_on = case.digits["T"] in (1, 2) and case.digits["P"] == 0 and key in began
        if not goes_on or key in without:
            began[key] = case.number
        (without.discard if case.digits["T"] > 0 else without.add)(key)
        mapping = Mapping(case, path.name, path.parent)
        try:
            tables, refused = mapping.tables(), None
            check_case(tables)
        except CaseError as error:
            tables, refused = None, named(str(error), case, path.name)
        except (KeyError, OverflowError, ValueError) as error:
            what = f"{error} is missing or out of range"
            tables, refused = None, f"{path.name}, line {case.line}, case {case.number}: {what}"
        found.append(Converted(case, tables, refused, began[key], mapping.offset))
    return found


def named(error: str, case: Case, name: str) -> str:
    """With file, line and case, which errors of our own keys have not."""
    if error.startswith(name):
        return error
    return f"{name}, line {case.line}, case {case.number}: {error}"


def sequences(found: list[Converted]) -> list[list[Converted]]:
    """The cases of each sequence, in order."""
    groups: dict[int, list[Converted]] = {}
    for one in found:
        groups.setdefault(one.begins, []).append(one)
    return list(groups.values())
