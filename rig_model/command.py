"""The sub-command ``railpatch rig``."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import click
from railpatch.command.group import (
    EXIT_NOT_CONVERGED,
    json_option,
    output_option,
    progress_bar,
    quiet_flag,
    scene_argument,
    show_scene_option,
    strict_flag,
    tell_warnings,
    wrong_calls,
)
from railpatch.command.output import check_output


def default_scene_text() -> str:
    """The scene that is run by default."""
    from rig_model.scene import default_scene

    return default_scene().read_text(encoding="utf-8")


@click.command("rig")
@scene_argument()
@output_option("RUN.mcap", "The log to write.")
@click.option("--positions", type=int, metavar="NUMBER", help="Replaces rig.positions.")
@click.option("--rate", type=float, metavar="HZ", help="Replaces rig.rate: positions per second.")
@click.option("--duration", type=float, metavar="SECONDS", help="Replaces rig.duration.")
@click.option(
    "--method",
    type=click.Choice(["broyden", "newton"]),
    help="Replaces rig.balance.method: how balances are searched.",
)
@show_scene_option(default_scene_text)
@strict_flag()
@quiet_flag("Print no summary and no progress.")
@click.pass_context
def rig(
    context: click.Context,
    scene: Path | None,
    output: Path,
    strict: bool,
    quiet: bool,
    **overrides: Any,
) -> None:
    """Replay a run of NRC's roller rig: balance every position, write the log.

    Without a scene it is the dry run at 10 mph and 13,750 lb a side with the profiles that NRC
    measured. A log that was cut off can be read up to less than a second before its end.
    """
    # scipy and the log's libraries take a while to import; other commands need not wait for them
    from railpatch.pressure_error import run_doubts

    from rig_model.run import replay
    from rig_model.scene import default_scene, load_rig_scene

    overrides["balance.method"] = overrides.pop("method")
    with wrong_calls():
        loaded = load_rig_scene(scene, overrides)
        check_output(output, scene or default_scene(), *loaded.all_files())
        if not quiet:
            click.echo(f"scene         {loaded.name}")
            click.echo(f"profiles      {profiles_used(loaded)}")
            if loaded.measured is not None:
                click.echo(loaded.measured.text())
        with progress_bar("balancing", loaded.count, quiet) as advance:
            summary = replay(loaded, output, advance)
    if not quiet:
        click.echo(summary.text())
    doubts = [*run_doubts(loaded.case, Path()), *loaded.doubts]
    tell_warnings([*doubts, *summary.warned.lines()], strict=strict, quiet=quiet)
    if not summary.good:
        if not quiet:
            missed = len(summary.converged) - int(summary.converged.sum())
            click.echo(f"status: {missed} positions did not converge", err=True)
        context.exit(EXIT_NOT_CONVERGED)


def profiles_used(scene: Any) -> str:
    """Which profiles a run has."""
    from railpatch.case.wheel import PROFILE_KEYS

    given = scene.case.profiles.model_dump(include=set(PROFILE_KEYS), exclude_none=True)
    return ", ".join(sorted({Path(name).name for name in given.values()}))


def default_curve_text() -> str:
    """The curves that are found by default."""
    from rig_model.curve import DEFAULT

    return DEFAULT.read_text(encoding="utf-8")


@click.command("curve")
@scene_argument()
@click.option(
    "--radius",
    type=float,
    multiple=True,
    metavar="METRES",
    help="Replaces curve.radius; may be given several times; above 0: to the right.",
)
@json_option()
@show_scene_option(default_curve_text)
@strict_flag()
@quiet_flag()
@click.pass_context
def curve(
    context: click.Context,
    scene: Path | None,
    radius: tuple[float, ...],
    as_json: bool,
    strict: bool,
    quiet: bool,
) -> None:
    """Find the steady position of a wheelset in curves, by Newton's and by Broyden's method.

    Without a scene it has S1002 profiles on UIC60 rails inclined 1:40, in curves of 600 and 175 m.
    """
    from railpatch.pressure_error import run_doubts

    from rig_model.curve import METHODS, load_curve_scene, steady_curves

    with wrong_calls():
        loaded = load_curve_scene(scene, radius=list(radius) or None)
        found = {method: steady_curves(loaded, method) for method in METHODS}
    curves = [item for method in METHODS for item in found[method]]
    if as_json:
        rows = {method: [item.to_dict() for item in found[method]] for method in METHODS}
        click.echo(json.dumps(rows, allow_nan=False))
    elif not quiet:
        print_curves(found)
    doubts = run_doubts(loaded.case, loaded.folder)
    tell_warnings([*doubts, *warned_of(curves).lines()], strict=strict, quiet=quiet)
    if not all(item.converged for item in curves):
        context.exit(EXIT_NOT_CONVERGED)


def warned_of(curves: list[Any]) -> Any:
    """Warnings by the curves' radii."""
    from railpatch.result import Warned

    warned = Warned()
    for item in curves:
        warned.add(f"{item.radius:g} m", item.result.warnings)
    return warned


def print_curves(found: dict[str, Any]) -> None:
    """One column for each curve and method."""
    from railpatch.command.tables import new_table, spell
    from rich.console import Console

    rows = {method: [item.to_dict() for item in items] for method, items in found.items()}
    columns = [row for items in rows.values() for row in items]
    names = [f"{method} {row['radius']:g} m" for method, items in rows.items() for row in items]
    table = new_table(names, "curve")
    for key, unit in next(iter(found.values()))[0].UNITS.items():
        table.add_row(key, unit, *(spell(row[key]) for row in columns))
    Console().print(table)
