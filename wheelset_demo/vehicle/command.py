"""The sub-command ``railpatch vehicle``."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import click
from railpatch.command.group import (
    EXIT_NOT_CONVERGED,
    NeedingCommand,
    WrongCall,
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

# of wheelset_demo.vehicle.compare, which takes long to import; a test compares them
METHODS = ("full", "fitted", "fastsim", "kik", "analyn", "polach")


def default_scene_text() -> str:
    """The scene that is run by default."""
    from wheelset_demo.scene import scene_file

    return scene_file("vehicle_curve.toml").read_text(encoding="utf-8")


@click.command("vehicle", cls=NeedingCommand, needs=need_pinocchio)
@scene_argument()
@click.option(
    "--method",
    "methods",
    type=click.Choice(METHODS),
    multiple=True,
    help="Contact theory in place of the scene's; may be given several times.",
)
@click.option("--compare", is_flag=True, help="The full theory beside Hertz and FASTSIM: times.")
@output_option("RUN.mcap", "The log to write, of one run.", required=False)
@click.option("--duration", type=float, metavar="SECONDS", help="Replaces run.duration.")
@click.option("--step", type=float, metavar="SECONDS", help="Replaces run.step.")
@click.option("--threads", type=int, metavar="NUMBER", help="Replaces run.threads.")
@click.option(
    "--step-times",
    is_flag=True,
    help="How long each step took: histogram, 99.99 %, worst, steps longer than they simulate.",
)
@json_option("Print the summaries as one JSON object.")
@show_scene_option(default_scene_text)
@strict_flag()
@quiet_flag("Print no summary and no progress.")
@click.pass_context
def vehicle(
    context: click.Context,
    scene: Path | None,
    methods: tuple[str, ...],
    compare: bool,
    output: Path | None,
    step_times: bool,
    as_json: bool,
    strict: bool,
    quiet: bool,
    **overrides: Any,
) -> None:
    """Run a vehicle of any bodies and wheelsets on its track.

    Without a scene a coach runs 20 s at 300 km/h through a curve whose rails have irregularities. A
    contact that cannot be solved ends the run with exit code 3; the log up to there is kept.
    """
    if compare and methods:
        raise WrongCall(f"--compare: given with --method {methods[0]}, allowed one of them")
    if output is not None and (compare or len(methods) > 1):
        raise WrongCall(f"--output: value is {str(output)!r}, allowed with one run only")
    from wheelset_demo.scene import scene_file
    from wheelset_demo.system import ContactFailure
    from wheelset_demo.vehicle.compare import COMPARED
    from wheelset_demo.vehicle.plausible import doubts_of
    from wheelset_demo.vehicle.scene import DEFAULT, load_vehicle_scene

    file = scene_file(DEFAULT) if scene is None else scene
    try:
        with wrong_calls():
            loaded = load_vehicle_scene(scene, overrides)
            record = () if loaded.measured is None else (loaded.measured.path,)
            check_output(output, file, *record, *files_of(loaded.case, file.parent))
            # said first: a run that fails has its reason there
            doubts = doubts_of(loaded)
            tell_warnings(doubts, strict=strict, quiet=quiet)
            chosen = COMPARED if compare else methods
            found = run_all(loaded, chosen, quiet, output, step_times=step_times)
    except ContactFailure as failure:
        # one in a run is in its summary
        if not quiet:
            click.echo(f"status: {failure}; before the first step", err=True)
        context.exit(EXIT_NOT_CONVERGED)
    if as_json:
        content = {name: summary.to_dict() for name, summary in found.items()}
        click.echo(json.dumps({"scene": loaded.name, "runs": content}, allow_nan=False))
    elif not quiet:
        show(loaded.name, found)
    warned = dict.fromkeys(text for summary in found.values() for text in summary.warnings)
    tell_warnings([text for text in warned if text not in doubts], strict=strict, quiet=quiet)
    failed = {name: summary for name, summary in found.items() if not summary.good}
    for name, summary in failed.items():
        if not quiet:
            kept = "" if output is None else f"; the log up to there is in {output}"
            click.echo(f"status: {name}: {summary.message}{kept}", err=True)
    if failed:
        context.exit(EXIT_NOT_CONVERGED)


def run_all(
    scene: Any,
    methods: tuple[str, ...],
    quiet: bool,
    output: Path | None = None,
    *,
    step_times: bool = False,
) -> dict[str, Any]:
    """Name of the theory, or "scene" for the scene's own -> summary. output: the log of one."""
    from wheelset_demo.vehicle.compare import run_summary, with_theory

    chosen = {name: with_theory(scene, name) for name in methods} or {"scene": scene}
    kept = 1 + -(-scene.steps // scene.run.log_every)
    found = {}
    for name, one in chosen.items():
        with progress_bar(f"rolling, {name}", kept, quiet) as advance:
            found[name] = run_summary(one, advance, output, step_times=step_times)
    return found


def show(name: str, found: dict[str, Any]) -> None:
    """Summaries, and the table of times where several theories ran."""
    from wheelset_demo.vehicle.compare import THEORIES, table_of

    click.echo(f"{'scene':<16}{name}")
    for key, summary in found.items():
        if key in THEORIES:
            click.echo(f"{'theory':<16}{THEORIES[key].text}")
        click.echo(summary.text())
    if len(found) > 1:
        click.echo("")
        click.echo(table_of(found))
