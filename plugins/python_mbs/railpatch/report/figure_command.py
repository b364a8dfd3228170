"""The sub-command ``railpatch figure``."""

from __future__ import annotations

import tempfile
from pathlib import Path

import click

from railpatch.command.group import WrongCall, quiet_flag, wrong_call
from railpatch.command.output import check_output, refusal
from railpatch.page.browser import BrowserError, find_browser
from railpatch.page.printing import PICTURES, figure_names, write_figure

LOG = ".mcap"


@click.command("figure")
@click.argument(
    "source", metavar="RUN.mcap|PAGE.html", type=click.Path(dir_okay=False, path_type=Path)
)
@click.argument("name", metavar="[NAME]", required=False)
@click.option(
    "-o",
    "--output",
    type=click.Path(dir_okay=False, path_type=Path),
    metavar="FIGURE.png|.svg",
    help="The picture to write.",
)
@click.option(
    "--width",
    type=click.IntRange(300, 4000),
    default=900,
    show_default=True,
    help="px; a PNG has two pixels for each.",
)
@click.option("--dark", is_flag=True, help="On a dark ground.")
@click.option("--at", type=float, metavar="NUMBER", help="Of a log, as for railpatch report.")
@quiet_flag()
def figure(
    source: Path,
    name: str | None,
    output: Path | None,
    width: int,
    dark: bool,
    at: float | None,
    quiet: bool,
) -> None:
    """Write one figure of a page, or of the report of a log, as PNG or SVG.

    Without NAME it lists the names that the page has. It needs a browser: Chromium, Chrome or Edge
    on the path, or the command that RAILPATCH_BROWSER names.
    """
    if (name is None) != (output is None):
        missing = "--output" if output is None else "NAME"
        raise WrongCall(f"{missing}: value is missing, allowed with NAME and --output both")
    if output is not None:
        check_output(output, source)
        if output.suffix.lower() not in PICTURES:
            raise refusal(output, f"a name that ends in {' or '.join(PICTURES)}")
    try:
        if output is not None:
            find_browser()
        with tempfile.TemporaryDirectory() as folder:
            page = page_of(source, Path(folder), at)
            names = figure_names(page)
            if name is None or output is None:
                click.echo("\n".join(names))
                return
            check_name(source, output, name, names)
            write_figure(output, page, name, width=width, dark=dark)
    except (BrowserError, ValueError, OSError) as error:
        raise wrong_call(error) from None
    if not quiet:
        click.echo(output)


def page_of(source: Path, folder: Path, at: float | None) -> Path:
    """The page itself, or the report of a log."""
    if source.suffix.lower() != LOG:
        if at is not None:
            raise WrongCall("--at: value is given, allowed with a log")
        return source
    from railpatch.report import write_report

    return write_report(source, folder / "report.html", at=at)


def check_name(source: Path, output: Path, name: str, names: dict[str, bool]) -> None:
    """Raises WrongCall where the page has no such figure, or none of that format."""
    if name not in names:
        allowed = ", ".join(names) or "none: this page has no figures"
        raise WrongCall(f"NAME: value is {name!r}, allowed of {source.name} {allowed}")
    if not names[name] and output.suffix.lower() != PICTURES[0]:
        raise refusal(output, f"a name that ends in {PICTURES[0]}: {name} is drawn point by point")
