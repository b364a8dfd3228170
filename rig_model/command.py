"""The sub-command ``railpatch rig``."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import click
from railpatch.commands import EXIT_NOT_CONVERGED, WrongCall
from railpatch.errors import CaseError, ProfileError


def show_scene(context: click.Context, _option: click.Parameter, value: bool) -> None:
    """Prints the scene that is run by default, and ends."""
    if not value or context.resilient_parsing:
        return
    from rig_model.scene import default_scene

    click.echo(default_scene().read_text(encoding="utf-8"), nl=False)
    context.exit()


@click.command("rig")
@click.argument("scene", metavar="[SCENE.toml]", required=False, type=click.Path(path_type=Path))
@click.option(
    "-o",
    "--output",
    required=True,
    type=click.Path(dir_okay=False, path_type=Path),
    metavar="RUN.mcap",
    help="The log to write.",
)
@click.option("--positions", type=int, metavar="NUMBER", help="Replaces rig.positions.")
@click.option("--rate", type=float, metavar="HZ", help="Replaces rig.rate: positions per second.")
@click.option("--duration", type=float, metavar="SECONDS", help="Replaces rig.duration.")
@click.option(
    "--show-scene",
    is_flag=True,
    is_eager=True,
    expose_value=False,
    callback=show_scene,
    help="Print the scene that is run by default, as a start for one's own.",
)
@click.option("--quiet", is_flag=True, help="Print no summary and no progress.")
@click.pass_context
def rig(
    context: click.Context, scene: Path | None, output: Path, quiet: bool, **overrides: Any
) -> None:
    """Replay a run of NRC's roller rig: balance every position, write the log.

    Without a scene it is the dry run at 10 mph and 13,750 lb a side, with NRC's measured profiles
    where $RAILPATCH_REFERENCE or ../shared/reference beside the checkout holds them, else with
    nominal ones. A log that was cut off can be read up to less than a second before its end.
    """
    # scipy and the log's libraries take a while to import; other commands need not wait for them
    from rig_model.run import replay
    from rig_model.scene import load_rig_scene

    try:
        loaded = load_rig_scene(scene, overrides)
        if not quiet:
            click.echo(f"scene         {loaded.name}")
            click.echo(f"profiles      {profiles_used(loaded, chosen=scene is None)}")
        with progress_bar(loaded.rig.count, quiet) as advance:
            summary = replay(loaded, output, advance)
    except (CaseError, ProfileError, OSError) as error:
        raise WrongCall(str(error)) from None
    if not quiet:
        click.echo(summary.text())
    if not summary.good:
        if not quiet:
            missed = len(summary.converged) - int(summary.converged.sum())
            click.echo(f"status: {missed} positions did not converge", err=True)
        context.exit(EXIT_NOT_CONVERGED)


def profiles_used(scene: Any, *, chosen: bool) -> str:
    """Which profiles a run has. chosen: the scene is the one that is run by default."""
    from rig_model.scene import NOMINAL, PROFILE_KEYS, REFERENCE_VARIABLE

    given = scene.case.profiles.model_dump(include=set(PROFILE_KEYS), exclude_none=True)
    names = ", ".join(sorted({Path(name).name for name in given.values()}))
    if not chosen:
        return names
    if scene.name == NOMINAL:
        return f"nominal ({names}); set {REFERENCE_VARIABLE} for the measured ones: not found"
    return f"measured ({names})"


@contextmanager
def progress_bar(total: int, quiet: bool) -> Iterator[Any]:
    """What to call after each position; a bar on stderr only where that is a terminal."""
    from rich.console import Console
    from rich.progress import MofNCompleteColumn, Progress

    console = Console(stderr=True)
    shown = console.is_terminal and not quiet
    columns = (*Progress.get_default_columns(), MofNCompleteColumn())
    with Progress(*columns, console=console, disable=not shown, transient=True) as bar:
        task = bar.add_task("balancing", total=total)
        yield lambda _balance: bar.advance(task)
