"""The sub-command ``railpatch layout``."""

from __future__ import annotations

from pathlib import Path

import click

from railpatch.command.group import output_option, quiet_flag, wrong_call
from railpatch.command.output import check_output
from railpatch.layout.plots import KINDS
from railpatch.writing import write_whole


@click.command("layout")
@click.argument(
    "run", metavar="[RUN.mcap]", required=False, type=click.Path(dir_okay=False, path_type=Path)
)
@output_option("LAYOUT.json", "The layout to write.")
@click.option(
    "--kind",
    type=click.Choice(KINDS),
    default="rail",
    show_default=True,
    help="Without a log: the kind of run.",
)
@click.option(
    "--wheelsets", type=click.IntRange(1, 64), default=4, show_default=True, help="Of a vehicle."
)
@quiet_flag()
def layout(run: Path | None, output: Path, kind: str, wheelsets: int, quiet: bool) -> None:
    """Make a layout for viewers of logs, Foxglove or Lichtblick: 3D scene, plots, raw messages.

    With a log it shows what that log holds.
    """
    from railpatch.layout import layout_text
    from railpatch.log.reader import RunFileError, read_run

    check_output(output, run)
    topics = None
    try:
        if run is not None:
            log = read_run(run)
            about, topics = log.metadata["railpatch"], log.counts
            kind, wheelsets = kind_of(about, topics)
        write_whole(output, layout_text(kind, wheelsets, topics).encode())
    except (RunFileError, ValueError, OSError) as error:
        raise wrong_call(error) from None
    if not quiet:
        click.echo(output)


def kind_of(about: dict[str, str], topics: dict[str, int]) -> tuple[str, int]:
    """Kind of a log's run, and its wheelsets."""
    if "wheelsets" in about:
        return "vehicle", int(about["wheelsets"])
    return ("roller" if "/rig/balance" in topics else "rail"), 1
