"""The sub-command ``railpatch subsurface``."""

from __future__ import annotations

import json
from pathlib import Path

import click

from railpatch.case.asked import depth_doubts
from railpatch.case.types import BODIES, SIDES
from railpatch.command.group import (
    EXIT_NOT_CONVERGED,
    WrongCall,
    json_option,
    output_option,
    quiet_flag,
    strict_flag,
    tell_warnings,
    wrong_calls,
)
from railpatch.command.output import check_output, files_of, refusal
from railpatch.subsurface import DANG_VAN

FORMATS = (".html", ".csv", ".npz")


@click.command("subsurface")
@click.argument("case", metavar="CASE.toml", type=click.Path(path_type=Path))
@output_option(
    "OUT", "A page (.html), a table of all points (.csv) or arrays (.npz).", required=False
)
@click.option(
    "--depth",
    "depths",
    type=click.FloatRange(0, 1),
    multiple=True,
    metavar="LENGTH",
    help="m, below the body's surface; may be given several times.  [default: 24 depths from 0 to "
    "1.5 times the patch's length or width, whichever is greater, closer near the surface]",
)
@click.option("--body", type=click.Choice(BODIES), default="rail", show_default=True)
@click.option(
    "--side", type=click.Choice(SIDES), default="right", show_default=True, help="Of a wheelset."
)
@click.option(
    "--patch",
    type=click.IntRange(1),
    default=1,
    show_default=True,
    help="Of several patches of a wheel, counted from 1 as in the table of `railpatch solve`; "
    "alternatives after them.",
)
@click.option(
    "--dang-van",
    type=click.FloatRange(0, 3),
    default=DANG_VAN,
    show_default="1/3",
    help="Weight of the hydrostatic stress in Dang Van's criterion.",
)
@json_option()
@strict_flag()
@quiet_flag("Print no table.")
@click.pass_context
def subsurface(
    context: click.Context,
    case: Path,
    output: Path | None,
    depths: tuple[float, ...],
    body: str,
    side: str,
    patch: int,
    dang_van: float,
    as_json: bool,
    strict: bool,
    quiet: bool,
) -> None:
    """Find the stresses below the surface under one patch of a case.

    Prints the greatest von Mises stress, shear and Dang Van stress at each depth, and where.
    """
    check_output(output, case)
    if output is not None and output.suffix.lower() not in FORMATS:
        raise refusal(output, f"a name that ends in {', '.join(FORMATS)}")
    from railpatch.below.greatest import greatest, index_of, rows_of, usual_depths
    from railpatch.contact import Contact
    from railpatch.subsurface import Subsurface

    with wrong_calls():
        contact = Contact(case)
        check_output(output, case, *files_of(contact.case, case.parent))
        result = contact.step(fields=True)
        doubts = depth_doubts({"--depth": max(depths, default=0.0)})
        tell_warnings([*result.warnings, *doubts], strict=strict, quiet=quiet)
        if not result.solved:
            if not quiet:
                click.echo(f"status: {result.status}: {result.reason}", err=True)
            context.exit(EXIT_NOT_CONVERGED)
        try:
            index = index_of(result, side, patch)
            below = Subsurface(
                contact, depths or usual_depths(result, side, index), dang_van=dang_van
            )
            found = below.solve(side=side, patch=index, body=body)
        except LookupError as error:
            raise WrongCall(str(error)) from None
        table = greatest(found)
        if output is not None:
            from railpatch.below.written import write

            write(output, case.name, found, table, f"{body}, {side}, patch {patch}")
    if as_json:
        click.echo(json.dumps({name: values.tolist() for name, values in table.items()}))
    elif not quiet:
        for row in rows_of(table):
            click.echo(row)
