"""The railpatch command."""

from __future__ import annotations

import json
from pathlib import Path

import click

from railpatch.command.group import (
    EXIT_NOT_CONVERGED,
    Commands,
    WrongCall,
    completed,
    json_option,
    quiet_flag,
    strict_flag,
    tell_warnings,
    version_option,
    wrong_call,
)

CASE = click.Path(path_type=Path)
QUIET_TEXT = "Print no table and no progress."
QUIET = quiet_flag(QUIET_TEXT)


def kind_names() -> list[str]:
    """Of scene files."""
    from railpatch.case.kinds import kinds

    return list(kinds())


def quiet_everywhere(context: click.Context, _option: click.Parameter, value: bool) -> None:
    """`railpatch --quiet COMMAND` is `railpatch COMMAND --quiet`."""
    if value and isinstance(context.command, click.Group):
        names = context.command.list_commands(context)
        context.default_map = {name: {"quiet": True} for name in names}


@click.group(cls=Commands, params=[version_option()])
@click.option(
    "--quiet",
    is_flag=True,
    is_eager=True,
    expose_value=False,
    callback=quiet_everywhere,
    help=QUIET_TEXT,
)
def cli() -> None:
    """Wheel-rail contact mechanics. Units are SI; forces act on the wheel.

    Exit codes: 0 solved (no contact included), 2 the call was wrong, 3 not converged.
    """


@cli.command()
@click.argument("case", metavar="CASE.toml", type=CASE)
@json_option()
@click.option("--fields", is_flag=True, help="With --json: add pressure, traction, ... as arrays.")
@click.option(
    "--signs",
    type=click.Choice(["contact"]),
    help="Print JSON in the units and signs of the program CONTACT: mm, N, of the rail.",
)
@click.option(
    "--mat",
    type=click.Path(dir_okay=False, path_type=Path),
    metavar="OUT.mat",
    help="Write the same with all fields for MATLAB.",
)
@strict_flag()
@QUIET
@click.pass_context
def solve(
    context: click.Context,
    case: Path,
    as_json: bool,
    fields: bool,
    signs: str | None,
    mat: Path | None,
    strict: bool,
    quiet: bool,
) -> None:
    """Solve one contact case, or all cases of an input file (.inp) of the program CONTACT.

    What can hardly be meant, a load of 50 N or a wheel that is locked, is solved all the same, with
    a warning.
    """
    if fields and not (as_json or signs):
        raise WrongCall("--fields: value is True, allowed only with --json")
    if case.suffix.lower() == ".inp" or signs or mat:
        from railpatch.command.contact_units import solve_in_contact_units

        solve_in_contact_units(
            context, case, as_json, fields, signs=signs, mat=mat, strict=strict, quiet=quiet
        )
        return
    from railpatch.contact import solve as solve_case

    result = solve_case(case, fields=fields)
    if as_json:
        click.echo(json.dumps(result.to_dict(), allow_nan=False))
    elif not quiet:
        from railpatch.command.tables import print_result

        print_result(result)
    tell_warnings(result.warnings, strict=strict, quiet=quiet)
    if not result.good:
        if not quiet:
            click.echo(f"status: {result.status}: {result.reason}", err=True)
        context.exit(EXIT_NOT_CONVERGED)


@cli.command()
@click.argument("case", metavar="CASE.toml", type=CASE)
@strict_flag()
@QUIET
@click.pass_context
def explain(context: click.Context, case: Path, strict: bool, quiet: bool) -> None:
    """Show which stages a case needs, why, and what they cost.

    The case is solved once from a cold start; the time share is measured in it.
    """
    from railpatch.case.resolve import choose
    from railpatch.contact import Contact

    contact = Contact(case, timing=True)
    result = contact.step()
    if not quiet:
        from railpatch.command.tables import print_stages

        choice = choose(contact.case)
        if choice is not None and contact.case.method.accuracy is not None:
            click.echo(choice.spell(contact.case.method.accuracy))
        print_stages([*contact.stages(), *contact.asked()], result)
    tell_warnings([*result.warnings, *contact.doubts()], strict=strict, quiet=quiet)
    if not result.good:
        context.exit(EXIT_NOT_CONVERGED)


@cli.command()
@click.option(
    "--kind",
    metavar="KIND",
    shell_complete=completed(kind_names),
    help="Of such scenes only: patch, wheel_rail, wheelset, rig, curve, wheelset_run, vehicle, "
    "sweep.",
)
@QUIET
def schema(kind: str | None, quiet: bool) -> None:
    """Print the JSON schema of case files: every key with unit, range and default.

    Without --kind that of the cases of one contact: patch, wheel_rail, wheelset.
    """
    from railpatch.case import json_schema
    from railpatch.case.kinds import kind_of

    content = json_schema() if kind is None else kind_of(kind).schema()
    if not quiet:
        click.echo(json.dumps(content, indent=2))


@cli.command()
@click.argument("kind", metavar="KIND", shell_complete=completed(kind_names))
@click.argument("folder", metavar="DIR", type=click.Path(file_okay=False, path_type=Path))
@QUIET
def init(kind: str, folder: Path, quiet: bool) -> None:
    """Write a scene to start from into a folder, with all its files.

    KIND: patch, wheel_rail, wheelset, rig, curve, wheelset_run, vehicle or sweep. Beside the scene
    stand the profiles that it names and its JSON schema, by which editors check it, and further
    examples where there are some. Files that are there are never replaced.
    """
    from railpatch.case.kinds import kind_of, write_example

    found = kind_of(kind)
    try:
        written = write_example(found, folder)
    except OSError as error:
        raise wrong_call(error) from None
    if not quiet:
        for path in written:
            click.echo(path)
        click.echo(f"next: {found.command.replace('SCENE', str(written[0]))}")


def main() -> None:
    """Entry point of the railpatch command."""
    cli(prog_name="railpatch")


if __name__ == "__main__":
    main()
