"""The sub-command ``railpatch convert``."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from railpatch.command.group import WrongCall, quiet_flag, wrong_calls
from railpatch.command.output import check_folder
from railpatch.errors import CaseError
from railpatch.inp.files import Converted, sequences
from railpatch.inp.files import convert as cases_of_file
from railpatch.inp.sequences import changes_of, joined
from railpatch.inp.written import missing_profile, named_profiles, plan, write_cases


@click.command("convert")
@click.argument("source", metavar="CASE.inp", type=click.Path(path_type=Path))
@click.option(
    "-o",
    "--output",
    metavar="DIR",
    type=click.Path(file_okay=False, path_type=Path),
    help="Folder for the cases, their profiles and undeformed distances.",
)
@click.option(
    "--list",
    "listed",
    is_flag=True,
    help="Of a file, or all .inp files of a folder: what each case would be, or why it has no "
    "counterpart; nothing is written.",
)
@quiet_flag("Print nothing.")
@click.pass_context
def convert(
    context: click.Context, source: Path, output: Path | None, listed: bool, quiet: bool
) -> None:
    """Make TOML files of the cases in an input file of the program CONTACT.

    What has no counterpart is refused by line and name, and nothing is written. Steps of a shift
    and of rolling that go on from each other are one file.
    """
    if listed == (output is not None):
        raise WrongCall("say either -o DIR or --list")
    if listed:
        bad = show_list(source, quiet=quiet)
        if bad:
            context.exit(2)
        return
    assert output is not None
    check_folder(output)
    with wrong_calls():
        written = write_cases(plan(cases_of_file(source), source), source, output)
    if not quiet:
        for path in written:
            click.echo(str(path))


def show_list(source: Path, *, quiet: bool) -> bool:
    """Whether a case, or a file, cannot be converted."""
    files = [source]
    if source.is_dir():
        files = sorted(file for file in source.iterdir() if file.suffix.lower() == ".inp")
    if not files:
        raise WrongCall(f"{source}: has no .inp files")
    bad = False
    for path in files:
        lines = []
        try:
            found = cases_of_file(path)
            of_steps = states_of_steps(found, path)
            for one in found:
                wrong = one.refused or first_missing(one.tables or {}, path)
                state, is_wrong = of_steps.get(one.case.number, ("", False))
                lines.append(
                    f"{path.name}: case {one.case.number}: "
                    f"{wrong or (one.tables or {})['kind'] + state}"
                )
                bad = bad or wrong is not None or is_wrong
        except CaseError as error:
            bad = True
            lines.append(f"cannot be read: {error}")
        if not quiet:
            for line in lines:
                click.echo(line)
    return bad


def states_of_steps(found: list[Converted], source: Path) -> dict[int, tuple[str, bool]]:
    """By their number, of cases that are steps of one contact: which, and at the first one why no
    file has them all, if so; and whether it is wrong."""
    out: dict[int, tuple[str, bool]] = {}
    for steps in sequences(found):
        first = steps[0].case.number
        if len(steps) == 1 or any(step.refused for step in steps):
            continue
        for k, step in enumerate(steps, start=1):
            out[step.case.number] = (
                f", step {k} of {len(steps)} of the contact of case {first}",
                False,
            )
        try:
            for step in steps[1:]:
                changes_of(step, steps, source.name)
            joined(steps, source.name)
        except CaseError as error:
            out[first] = f", step 1 of {len(steps)}: {error}", True
    return out


def first_missing(tables: dict[str, Any], source: Path) -> str | None:
    """What is said of the first profile of a case that is not there."""
    texts = (missing_profile(table[key], source) for table, key in named_profiles(tables))
    return next(filter(None, texts), None)
