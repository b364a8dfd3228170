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
@click.option("--wheel", metavar="PROFILE", help="Of a pair: the wheel's profile, file or name.")
@click.option("--rail", metavar="PROFILE", help="Of a pair: the rail's profile, file or name.")
@click.option(
    "--case",
    type=click.Path(exists=True, dir_okay=False, path_type=Path),
    metavar="CASE.toml",
    help="Of a pair: profiles, track or roller, gauge, material and normal theory of a case of "
    "kind wheel_rail, in place of --wheel and --rail.",
)
@click.option(
    "--error",
    type=click.FloatRange(0.002, 0.1),
    default=0.01,
    show_default=True,
    help="Of a pair: error of the creep force over friction's bound, below which 95 % shall lie.",
)
@click.option("--y", type=(float, float), metavar="MM MM", help="Of a pair: lateral positions.")
@click.option("--load", type=(float, float), metavar="KN KN", help="Of a pair: loads of the wheel.")
@click.option(
    "--yaw", type=float, metavar="MRAD", help="Of a pair: the greatest yaw angle to either side."
)
@click.option(
    "--check",
    type=click.IntRange(100),
    default=2000,
    show_default=True,
    help="Of a pair: states held out that tell the table's error.",
)
@click.option(
    "--shapes",
    "most",
    type=click.IntRange(50, 20000),
    default=2000,
    show_default=True,
    help="Of a pair: shapes at most, where --error is not reached sooner.",
)
@click.option("--seed", type=click.IntRange(0), default=1, show_default=True, help="Of a pair.")
@quiet_flag("Print no errors and no progress.")
def table(
    output: Path, jobs: int, keep: bool, wheel: str | None, rail: str | None, case: Path | None,
    error: float, y: tuple[float, float] | None, load: tuple[float, float] | None,
    yaw: float | None, check: int, most: int, seed: int, quiet: bool,
) -> None:  # fmt: skip
    """Solve a table of creep forces for tangential = 'table'.

    Alone: the package's table of ellipses anew. The full theory solves the table's nodes and a
    random sample that tells the table's error. Takes some minutes on one core; a run that was
    stopped goes on where it ended, from TABLE.bin.parts.

    With --wheel and --rail, or --case: a table for the contacts of one pair of profiles, which are
    no ellipses, for method.table_file. The full theory solves shapes until random states err by
    less than --error; takes from minutes to more than an hour on one core. A run that was stopped
    goes on as well.
    """
    if case is not None or wheel is not None or rail is not None:
        from railpatch.evidence.table.pair_command import make_pair

        make_pair(
            output, jobs, (wheel, rail), case, error, (y, load, yaw), check, most, seed, keep, quiet
        )
        return
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
