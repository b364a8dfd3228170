"""``railpatch solve`` for input files of the program CONTACT, and in its units and signs."""

from __future__ import annotations

import io
import json
from pathlib import Path
from typing import Any

import click
import scipy

from railpatch.case.load import load_scene
from railpatch.case.patch import PatchCase
from railpatch.command.group import EXIT_NOT_CONVERGED, tell_warnings, wrong_calls
from railpatch.command.output import check_output
from railpatch.command.tables import print_result
from railpatch.contact import solve
from railpatch.inp.run import solve_file
from railpatch.inp.signs import for_matlab, in_contact, without_fields
from railpatch.result import Result
from railpatch.writing import write_whole


def solve_in_contact_units(
    context: click.Context,
    case: Path,
    as_json: bool,
    fields: bool,
    *,
    signs: str | None,
    mat: Path | None,
    strict: bool,
    quiet: bool,
) -> None:
    """All cases of a file: tables, JSON in our units or theirs, a file for MATLAB."""
    check_output(mat, case)
    with_fields = fields or mat is not None
    results: list[Result] = []
    theirs: list[dict[str, Any]] = []
    with wrong_calls():
        if case.suffix.lower() == ".inp":
            for one in solve_file(case, fields=with_fields):
                results.append(one.result)
                theirs.append(one.in_contact())
        else:
            results = [solve(case, with_fields)]
            theirs = [{"case": 1, **in_contact(results[0].to_dict(), motion=last_motion(case))}]
        if mat is not None:
            write_whole(mat, matlab(theirs))
    if signs:
        shown = theirs if fields else without_fields(theirs)
        click.echo(json.dumps(shown, allow_nan=False))
    elif as_json:
        click.echo(json.dumps([result.to_dict() for result in results], allow_nan=False))
    elif not quiet:
        for number, result in zip((one["case"] for one in theirs), results, strict=True):
            click.echo(f"case {number}")
            print_result(result)
    for result in results:
        tell_warnings(result.warnings, strict=strict, quiet=quiet)
    bad = [result for result in results if not result.good]
    if bad:
        if not quiet:
            click.echo(f"status: {bad[0].status}: {bad[0].reason}", err=True)
        context.exit(EXIT_NOT_CONVERGED)


def last_motion(file: Path) -> dict[str, Any] | None:
    """[motion] of a case's last step, of which its result is."""
    case = load_scene(file).case
    if not isinstance(case, PatchCase):
        return None
    motion = case.motion
    return motion.model_dump() | {
        "creepage": (motion.creepages or [[None, None]])[-1],
        "regime": motion.of_steps[-1],
    }


def matlab(cases: list[dict[str, Any]]) -> bytes:
    """A file with one struct for each case: case1, case2, ..."""
    buffer = io.BytesIO()
    scipy.io.savemat(
        buffer, {f"case{one['case']}": for_matlab(one) for one in cases}, oned_as="row"
    )
    return buffer.getvalue()
