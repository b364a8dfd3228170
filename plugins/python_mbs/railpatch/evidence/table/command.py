"""railpatch table."""

from __future__ import annotations

import shutil
from pathlib import Path

import click

from railpatch.command.group import output_option, progress_bar, quiet_flag
from railpatch.command.output import check_output
from railpatch.errors import CaseError
from railpatch.writing import write_whole


@click.command()
@output_option("TABLE.bin", "The table to write.")
@click.option(
    "--jobs", type=click.IntRange(1), default=1, show_default=True, help="Processes that solve."
)
@click.option("--keep", is_flag=True, help="Keep the folder of solved parts, TABLE.bin.parts.")
@quiet_flag("Print no errors and no progress.")
def table(output: Path, jobs: int, keep: bool, quiet: bool) -> None:
    """Solve the table of creep forces for tangential = 'table' anew.

    The full theory solves the table's nodes and a random sample that tells the table's error. Takes
    some minutes on one core; a run that was stopped goes on where it ended, from TABLE.bin.parts.
    """
    from railpatch.case.creep_table import describe_table
    from railpatch.evidence.table.make import make_table, part_count
    from railpatch.evidence.table.recipe import Recipe

    check_output(output)
    recipe = Recipe()
    parts = output.with_name(f"{output.name}.parts")
    try:
        with progress_bar("table", part_count(recipe), quiet) as step:
            data = make_table(recipe, parts, jobs, step)
        write_whole(output, data)
    except OSError as error:
        raise CaseError(f"{output}: cannot be written: {error.strerror or error}") from None
    if not keep:
        shutil.rmtree(parts, ignore_errors=True)
    if quiet:
        return
    click.echo(f"{output}: {len(data)} bytes; error in per cent, median / 95 % / worst")
    for name, found in describe_table(data)["error"].items():
        texts = [" / ".join(f"{100 * e:.3f}" for e in found[k]) for k in ("force", "moment")]
        click.echo(f"  {name:<22} {found['cases']:5d} cases  force {texts[0]}  moment {texts[1]}")
