"""The sub-command ``railpatch wheelset``."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import click
from railpatch.command.group import (
    EXIT_NOT_CONVERGED,
    NeedingCommand,
    json_option,
    need_pinocchio,
    output_option,
    progress_bar,
    quiet_flag,
    scene_argument,
    show_scene_option,
    strict_flag,
    tell_warnings,
    wrong_calls,
)
from railpatch.command.output import check_output, files_of


def default_scene_text() -> str:
    """The scene that is run by default."""
    from wheelset_demo.scene import DEFAULT, scene_file

    return scene_file(DEFAULT).read_text(encoding="utf-8")


@click.command("wheelset", cls=NeedingCommand, needs=need_pinocchio)
@scene_argument()
@output_option("RUN.mcap", "The log to write.")
@click.option("--distance", type=float, metavar="METRES", help="Replaces run.distance.")
@click.option("--step", type=float, metavar="SECONDS", help="Replaces run.step.")
@click.option(
    "--stepper",
    type=click.Choice(["rk4", "ros2"]),
    help="Replaces run.stepper: explicit, implicit.",
)
@json_option("Print the summary as one JSON object.")
@show_scene_option(default_scene_text)
@strict_flag()
@quiet_flag("Print no summary and no progress.")
@click.pass_context
def wheelset(
    context: click.Context,
    scene: Path | None,
    output: Path,
    as_json: bool,
    strict: bool,
    quiet: bool,
    **overrides: Any,
) -> None:
    """Run a wheelset on straight track, released off-centre, and write the log.

    Without a scene it has S1002 profiles on UIC60 rails inclined 1:40. A contact that cannot be
    solved ends the run with exit code 3; the log up to there is kept.
    """
    from wheelset_demo.scene import DEFAULT, load_wheelset_scene, scene_file
    from wheelset_demo.simulation import run_scene

    file = scene_file(DEFAULT) if scene is None else scene
    with wrong_calls():
        loaded = load_wheelset_scene(scene, overrides)
        check_output(output, file, *files_of(loaded.case, file.parent))
        with progress_bar("rolling", loaded.steps, quiet) as advance:
            summary = run_scene(loaded, output, advance)
    if as_json:
        click.echo(json.dumps(summary.to_dict(), allow_nan=False))
    elif not quiet:
        click.echo(f"{'scene':<16}{loaded.name}")
        click.echo(summary.text())
    tell_warnings(summary.warnings, strict=strict, quiet=quiet)
    if not summary.good:
        if not quiet:
            click.echo(f"status: {summary.message}; the log up to there is in {output}", err=True)
        context.exit(EXIT_NOT_CONVERGED)
