"""The sub-command ``railpatch continuity``."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from railpatch.command.group import (
    EXIT_NOT_CONVERGED,
    folder_option,
    progress_bar,
    quiet_flag,
)
from railpatch.command.output import check_folder
from railpatch.evidence.ending import finish


@click.command("continuity")
@folder_option("Folder for table and pictures.")
@click.option("--quick", is_flag=True, help="One wheel on one grid, in about a minute.")
@click.option("--compare", is_flag=True, help="The rule of the program CONTACT as well.")
@click.option(
    "--worn",
    type=click.IntRange(1, 1000),
    metavar="PAIRS",
    help="Jumps on that many pairs of worn profiles instead, by every normal theory.",
)
@quiet_flag()
@click.pass_context
def continuity(
    context: click.Context,
    output: Path,
    quick: bool,
    compare: bool,
    worn: int | None,
    quiet: bool,
) -> None:
    """Sweep a wheel over y, z, yaw and speed, and measure the greatest jumps of its forces.

    Ends with exit code 3 where the blended rule leaves a jump above 0.2 % of the wheel load that
    does not shrink with the step, or worn profiles one of 0.5 % of friction times load that no
    warning announces.
    """
    from railpatch.evidence.continuity.scenes import scenes
    from railpatch.evidence.continuity.sweep import LIMIT
    from railpatch.evidence.continuity.table import HEAD, RULES, draw, run, write_table

    check_folder(output)
    if worn is not None:
        if quick or compare:
            raise click.UsageError("--worn goes without --quick and --compare")
        worn_pairs(context, output, worn, quiet)
        return
    plan = list(scenes(quick))
    rules = RULES if compare else RULES[:1]
    with progress_bar("continuity", len(plan) * len(rules), quiet) as advance:
        entries = list(run(plan, rules, advance))

    def write(found: list[Any], folder: Path) -> list[Path]:
        return [write_table(found, folder), *draw(found, folder)]

    def show(found: list[Any]) -> None:
        for row in (HEAD, *(entry.row() for entry in found)):
            click.echo("  ".join(str(value) for value in row))

    finish(entries, output, write, show, quiet=quiet)
    if any(e.rule == RULES[0] and e.sweep.jump > LIMIT for e in entries):
        context.exit(EXIT_NOT_CONVERGED)


def worn_pairs(context: click.Context, output: Path, pairs: int, quiet: bool) -> None:
    """The table of worn profiles."""
    from railpatch.evidence.continuity.worn import HEAD, THEORIES, Found, run_worn, write_worn

    with progress_bar("continuity", pairs * len(THEORIES), quiet) as advance:
        found = list(run_worn(pairs, advance))

    def show(rows: list[Found]) -> None:
        for row in (HEAD, *(one.row() for one in rows)):
            click.echo("  ".join(str(value) for value in row))

    finish(found, output, write_worn, show, quiet=quiet)
    if any(one.unannounced for one in found):
        context.exit(EXIT_NOT_CONVERGED)
