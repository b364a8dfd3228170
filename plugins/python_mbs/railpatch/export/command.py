"""The sub-command ``railpatch export``."""

from __future__ import annotations

from pathlib import Path

import click

from railpatch.command.group import WrongCall, quiet_flag, wrong_call
from railpatch.command.output import check_output


def with_library(
    _context: click.Context, _option: click.Parameter, output: Path | None
) -> Path | None:
    """Refuses a format whose library is not installed before anything else is looked at."""
    if output is not None:
        from railpatch.errors import CaseError
        from railpatch.export.formats import need_library

        try:
            need_library(output)
        except CaseError as error:
            raise wrong_call(error) from None
    return output


@click.command("export")
@click.argument("run", metavar="RUN.mcap", type=click.Path(dir_okay=False, path_type=Path))
@click.option(
    "-o",
    "--output",
    type=click.Path(dir_okay=False, path_type=Path),
    metavar="TABLE",
    callback=with_library,
    is_eager=True,
    help="The table to write; its ending chooses the format: .csv, .xlsx, .mat or .parquet.",
)
@click.option(
    "--channel",
    "channels",
    multiple=True,
    metavar="GLOB",
    help="Only these channels, as '/left/*'; may be given several times. Pressure maps and other "
    "fields of the patches are written only where their channel is named: '/left/fields'.",
)
@click.option(
    "--signal",
    "signals",
    multiple=True,
    metavar="GLOB",
    help="Only these columns, by their whole name, path or field: 'force.y', '*temperature'; may "
    "be given several times.",
)
@click.option(
    "--wear",
    is_flag=True,
    help="In place of a row for each moment what the run has worn off over the profiles of wheels "
    "and rails, of a scene with [damage]: .csv or .json.",
)
@click.option(
    "--all",
    "whole",
    is_flag=True,
    help="All columns of a vehicle's log, patches included: thousands. Without it and without "
    "--channel and --signal those that are read first.",
)
@click.option("--list", "listed", is_flag=True, help="Print names, units and meanings of columns.")
@quiet_flag()
def export(
    run: Path,
    output: Path | None,
    channels: tuple[str, ...],
    signals: tuple[str, ...],
    wear: bool,
    whole: bool,
    listed: bool,
    quiet: bool,
) -> None:
    """Write the log of a run as a table: CSV, Excel, MATLAB or Parquet.

    A row for each moment, a column for each number; units stand in the head: "name [unit]".
    """
    from railpatch.export.formats import format_of, write_table
    from railpatch.log.reader import read_run
    from railpatch.log.table import LogTable, is_read

    if output is None and not listed:
        raise WrongCall("--output: value is missing, allowed a file to write, or --list")
    check_output(output, run)
    if wear:
        if channels or signals or whole or listed or output is None:
            raise WrongCall("--wear: given, allowed with --output alone")
        export_wear(run, output, quiet)
        return
    try:
        if output is not None:
            format_of(output)
        log = read_run(run)
        table = log.table(channels, signals)
        every = len(table.columns)
        if "wheelsets" in log.metadata["railpatch"] and not (whole or channels or signals):
            read = [column for column in table.columns[1:] if is_read(column.name)]
            table = LogTable([table.columns[0], *read])
        if output is not None:
            write_table(table, output)
    except (ValueError, OSError) as error:
        raise wrong_call(error) from None
    if listed:
        for column in table.columns:
            click.echo(f"{column.head}  {column.text}")
    if output is not None and not quiet:
        count = len(table.columns)
        left = "" if count == every else f" of {every}, which --all writes"
        click.echo(f"{output}: {len(table.time)} rows, {count} columns{left}")


def export_wear(run: Path, output: Path, quiet: bool) -> None:
    """The distributions of wear of a log."""
    from railpatch.log.reader import read_run
    from railpatch.log.worn import write_worn

    if output.suffix.lower() not in (".csv", ".json"):
        raise WrongCall(
            f"--output: value is {str(output)!r}, allowed a name that ends in .csv or .json with "
            "--wear"
        )
    try:
        write_worn(read_run(run), output)
    except ValueError as error:
        raise WrongCall(f"{run}: {error}") from None
    except OSError as error:
        raise wrong_call(error) from None
    if not quiet:
        click.echo(f"{output}: wear over the profiles")
