"""The sub-command ``railpatch wear``."""

from __future__ import annotations

import json
from pathlib import Path

import click

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
@json_option("Print the rows as one JSON list.")
@quiet_flag()
def wear(sweep: Path, output: Path, as_json: bool, quiet: bool) -> None:
    """Wear wheel profiles over a mix of cases: a sweep with a table [wear].

    What is done is kept as it is done: the same command goes on where it was ended.
    """
    check_folder(output)
    from railpatch.wear.evolve import wear_profiles
    from railpatch.wear.page import write_wear_page
    from railpatch.wear.plan import load_wear

    with wrong_calls():
        plan = load_wear(sweep)
        with progress_bar("wearing", 100, quiet) as advance:
            done = 0

            def tell(part: float) -> None:
                nonlocal done
                for _ in range(done, int(100 * part)):
                    advance(None)
                done = int(100 * part)

            rows = wear_profiles(plan, output, progress=tell)
    page = write_wear_page(rows, output, sweep.name)
    if as_json:
        click.echo(json.dumps(rows, allow_nan=False))
    elif not quiet:
        last = rows[-1]
        click.echo(f"{'cases':<14}{len(plan.mix.points)}")
        click.echo(f"{'distance':<14}{1e-3 * last['distance']:.6g} km in {len(rows) - 1} steps")
        click.echo(f"{'worn off':<14}{1e3 * sum(last['mass'].values()):.4g} g")
        click.echo(f"{'depth':<14}{1e3 * last['depth']:.4g} mm at most")
        click.echo(f"{'page':<14}{page}")
