"""Input files solved as they are, sequences step by step."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from railpatch.contact import Contact, solve
from railpatch.errors import CaseError
from railpatch.inp.files import Converted, convert, sequences
from railpatch.inp.sequences import begun, changes_of
from railpatch.inp.signs import in_contact
from railpatch.result import Result


@dataclass(frozen=True)
class Solved:
    """A case and its result."""

    converted: Converted
    result: Result

    def in_contact(self) -> dict[str, object]:
        """In CONTACT's units and signs, with the case's number."""
        tables = self.converted.tables or {}
        result = in_contact(self.result.to_dict(), self.converted.offset, tables.get("motion"))
        return {"case": self.converted.case.number, **result}


def solve_file(path: Path, *, fields: bool = False) -> list[Solved]:
    """All cases of a file, in order. Raises CaseError, also where one has no counterpart."""
    found = convert(path)
    if refused := [one.refused for one in found if one.refused]:
        raise CaseError(refused)
    out: list[Solved] = []
    for steps in sequences(found):
        first = steps[0]
        assert first.tables is not None
        if len(steps) == 1:
            out.append(Solved(first, solve(first.tables, fields, folder=path.parent)))
            continue
        contact = Contact(begun(steps), folder=path.parent)
        out.append(Solved(first, contact.step(fields=fields)))
        for step in steps[1:]:
            changes = changes_of(step, steps, path.name)
            out.append(Solved(step, contact.step(fields=fields, **changes)))
    return sorted(out, key=lambda one: one.converted.case.number)
