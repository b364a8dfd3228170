"""The sub-command ``railpatch report``."""

from __future__ import annotations

from pathlib import Path

import click

from railpatch.command.group import quiet_flag, wrong_call
from railpatch.command.output import check_page
from railpatch.page.browser import BrowserError
from railpatch.report.figure_command import figure

__all__ = ["figure", "report"]


@click.command("report")
@click.argument("run", metavar="RUN.mcap", type=click.Path(dir_okay=False))
@click.option(
    "-o",
    "--output",
    required=True,
    type=click.Path(dir_okay=False, writable=True),
    metavar="REPORT.html|.pdf",
    help="The page to write; a PDF is made by Chromium, Chrome or Edge.",
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
    type=click.Path(exists=True),
    metavar="FILE",
    help="Lay a file of measurements over the run: a table whose columns are called as quantities "
    "are, or are told by --columns. Or the folder of another reference of the roller rig, in a "
    "file named as the package's own: nrc_dry_10mph_13750lb.csv.",
)
@click.option(
    "--columns",
    type=click.Path(dir_okay=False, exists=True),
    metavar="COLUMNS.toml",
    help="What the columns of that file are: a table [columns], or a rig's scene with "
    "[rig.columns].",
)
@click.option(
    "--beside",
    type=click.Path(dir_okay=False, exists=True),
    metavar="OTHER.mcap",
    help="Lay another log over the run.",
)
@quiet_flag()
def report(
    run: str,
    output: str,
    at: float | None,
    reference: str | None,
    columns: str | None,
    beside: str | None,
    quiet: bool,
) -> None:
    """Make a page of plots and tables from the log of a run.

    The page needs no network. A log that was cut off is reported up to its end.
    """
    check_page(Path(output), run, reference, columns, beside)
    # plotly takes a while to import; other commands need not wait for it
    from railpatch.report import write_report

    try:
        written = write_report(run, output, reference, at, columns=columns, beside=beside)
    except (BrowserError, ValueError, OSError) as error:
        raise wrong_call(error) from None
    if not quiet:
        click.echo(written)
