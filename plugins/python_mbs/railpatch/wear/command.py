"""The sub-command ``railpatch wear``."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import click

from railpatch.command.ending import told_when_ended
from railpatch.command.group import (
    folder_option,
    json_option,
    progress_bar,
    quiet_flag,
    wrong_calls,
)
from railpatch.command.output import check_folder


@click.command("wear")
@click.argument("sweep", metavar="SWEEP.toml", type=click.Path(path_type=Path))
@folder_option("Folder for profiles, page and what is needed to go on.")
@click.option(
    "--workers",
    type=click.IntRange(1, 1024),
    default=1,
    show_default=True,
    help="Processes that solve the cases of the mix; the rows do not depend on it.",
)
@json_option("Print the rows as one JSON list.")
@quiet_flag()
def wear(sweep: Path, output: Path, workers: int, as_json: bool, quiet: bool) -> None:
    """Wear profiles of wheels and rails over a mix of cases: a sweep with a table [wear].

    What is done is kept as it is done: the same command goes on where it was ended.
    """
    check_folder(output)
    from railpatch.wear.evolve import wear_profiles
    from railpatch.wear.page import write_wear_page
    from railpatch.wear.plan import load_wear

    kept = f"steps that are done are in {output}, and the same command goes on there"
    with told_when_ended(lambda: kept), wrong_calls():
        plan = load_wear(sweep)
        with progress_bar("wearing", 100, quiet) as advance:
            done = 0

            def tell(part: float) -> None:
                nonlocal done
                for _ in range(done, int(100 * part)):
                    advance(None)
                done = int(100 * part)

            rows = wear_profiles(plan, output, workers=workers, progress=tell)
    page = write_wear_page(rows, output, sweep.name)
    if as_json:
        click.echo(json.dumps(rows, allow_nan=False))
    elif not quiet:
        last = rows[-1]
        click.echo(f"{'cases':<14}{len(plan.mix.points)}")
        for name, text in told(last):
            click.echo(f"{name:<14}{text}")
        click.echo(f"{'steps':<14}{len(rows) - 1}")
        click.echo(f"{'depth':<14}{1e3 * last['depth']:.4g} mm at most")
        click.echo(f"{'page':<14}{page}")


def told(row: dict[str, Any]) -> list[tuple[str, str]]:
    """How far, and what each body has lost."""
    found = []
    if "distance" in row:
        found.append(("distance", f"{1e-3 * row['distance']:.6g} km"))
    if "passages" in row:
        found.append(("passages", f"{row['passages']:.6g}"))
    if "mass" in row:
        found.append(("off wheels", f"{1e3 * sum(row['mass'].values()):.4g} g"))
    if "rail_mass" in row:
        found.append(("off rails", f"{1e3 * sum(row['rail_mass'].values()):.4g} g/m"))
    return found
