"""How the commands that measure end: files are written, what was found is shown."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TypeVar

import click

from railpatch.command.group import WrongCall

Report = TypeVar("Report")


def finish(
    report: Report,
    output: Path,
    write: Callable[[Report, Path], list[Path]],
    show: Callable[[Report], None],
    *,
    quiet: bool,
) -> None:
    """Writes a report's files into a folder; shows it and their names. Raises WrongCall."""
    try:
        written = write(report, output)
    except OSError as error:
        raise WrongCall(f"--output: {error}") from None
    if quiet:
        return
    show(report)
    for path in written:
        click.echo(path)
