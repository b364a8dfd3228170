"""The sub-command ``railpatch report``."""

from __future__ import annotations

from pathlib import Path

import click

from railpatch.command.group import quiet_flag, wrong_call
from railpatch.command.output import check_page


@click.command("report")
@click.argument("run", metavar="RUN.mcap", type=click.Path(dir_okay=False))
@click.option(
    "-o",
    "--output",
    required=True,
    type=click.Path(dir_okay=False, writable=True),
    metavar="REPORT.html",
    help="The page to write.",
)
@click.option(
    "--at",
    type=float,
    metavar="NUMBER",
    help="Show the patches nearest to this progress (0 to 1; where the run has none: "
    "time in s; of a vehicle: distance in m). By default those at the largest yaw angle, or "
    "guiding force.",
)
@click.option(
    "--reference",
    type=click.Path(file_okay=False, exists=True),
    metavar="DIR",
    help="Folder of another reference of the roller rig, in a file named as the package's own: "
    "nrc_dry_10mph_13750lb.csv.",
)
@quiet_flag()
def report(run: str, output: str, at: float | None, reference: str | None, quiet: bool) -> None:
    """Make a page of plots and tables from the log of a run.

    The page needs no network. A log that was cut off is reported up to its end.
    """
    check_page(Path(output), run)
    # plotly takes a while to import; other commands need not wait for it
    from railpatch.report import write_report

    try:
        written = write_report(run, output, reference, at)
    except (ValueError, OSError) as error:
        raise wrong_call(error) from None
    if not quiet:
        click.echo(written)
