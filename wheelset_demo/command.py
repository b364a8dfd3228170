"""The sub-command ``railpatch wheelset``."""

from __future__ import annotations

import json
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
    from wheelset_demo.scene import DEFAULT, scene_file

    click.echo(scene_file(DEFAULT).read_text(encoding="utf-8"), nl=False)
    context.exit()


@click.command("wheelset")
@click.argument("scene", metavar="[SCENE.toml]", required=False, type=click.Path(path_type=Path))
@click.option(
    "-o",
    "--output",
    required=True,
    type=click.Path(dir_okay=False, path_type=Path),
    metavar="RUN.mcap",
    help="The log to write.",
)
@click.option("--distance", type=float, metavar="METRES", help="Replaces run.distance.")
@click.option("--step", type=float, metavar="SECONDS", help="Replaces run.step.")
@click.option(
    "--stepper",
    type=click.Choice(["rk4", "ros2"]),
    help="Replaces run.stepper: explicit, implicit.",
)
@click.option("--json", "as_json", is_flag=True, help="Print the summary as one JSON object.")
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
def wheelset(
    context: click.Context,
    scene: Path | None,
    output: Path,
    as_json: bool,
    quiet: bool,
    **overrides: Any,
) -> None:
    """Run a wheelset on straight track, released off-centre, and write the log.

    Without a scene it has S1002 profiles on UIC60 rails inclined 1:40. A contact that cannot be
    solved ends the run with exit code 3; the log up to there is kept.
    """
    try:
        import railpatch.pinocchio  # noqa: F401
    except ImportError as error:
        raise WrongCall(str(error)) from None
    from wheelset_demo.scene import load_wheelset_scene
    from wheelset_demo.simulation import run_scene

    try:
        loaded = load_wheelset_scene(scene, overrides)
        with progress_bar(loaded.steps, quiet) as advance:
            summary = run_scene(loaded, output, advance)
    except (CaseError, ProfileError, OSError) as error:
        raise WrongCall(str(error)) from None
    if as_json:
        click.echo(json.dumps(summary.to_dict(), allow_nan=False))
    elif not quiet:
        click.echo(f"{'scene':<16}{loaded.name}")
        click.echo(summary.text())
    if not summary.good:
        if not quiet:
            click.echo(f"status: {summary.message}; the log up to there is in {output}", err=True)
        context.exit(EXIT_NOT_CONVERGED)


@contextmanager
def progress_bar(total: int, quiet: bool) -> Iterator[Any]:
    """What to call after each step; a bar on stderr only where that is a terminal."""
    from rich.console import Console
    from rich.progress import Progress

    console = Console(stderr=True)
    shown = console.is_terminal and not quiet
    with Progress(console=console, disable=not shown, transient=True) as bar:
        task = bar.add_task("rolling", total=total)
        yield lambda _state: bar.advance(task)
