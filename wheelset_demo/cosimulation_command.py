"""The sub-command ``railpatch cosimulation``."""

from __future__ import annotations

import json
from importlib.util import find_spec
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
    wrong_calls,
)
from railpatch.command.output import check_output, files_of, refusal

from wheelset_demo.hunting_command import SCENE, default_scene_text

SPEEDS = (0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 40.0, 80.0)
QUICK_SPEEDS = (2.0, 20.0, 80.0)
ELEMENTS = 8
LIMITS = (0.05, 200.0)  # m/s
# the names of wheelset_demo.coupling.masters, which takes long to import
NAMES = (
    "parallel",
    "hold",
    "leapfrog",
    "linear",
    "mean",
    "iterate",
    "iterate-mixed",
    "iterate-newton",
    "implicit",
    "exchange",
)
MASTERS = (
    "hold",
    "leapfrog",
    "linear",
    "mean",
    "iterate",
    "iterate-newton",
    "implicit",
    "exchange",
)
QUICK_MASTERS = ("leapfrog", "mean", "implicit")


def speeds_of(text: str | None, quick: bool) -> list[float]:
    """m/s. Raises WrongCall."""
    if text is None:
        return list(QUICK_SPEEDS if quick else SPEEDS)
    low, high = LIMITS
    try:
        found = [float(part) for part in text.split(",")]
    except ValueError:
        found = []
    if not found or not all(low <= speed <= high for speed in found):
        raise WrongCall(f"--speeds: value is {text!r}, allowed {low:g} ... {high:g} m/s, by commas")
    return list(dict.fromkeys(found))


def masters_of(text: str | None, quick: bool) -> list[str]:
    """Names. Raises WrongCall."""
    if text is None:
        return list(QUICK_MASTERS if quick else MASTERS)
    found = text.split(",")
    for name in found:
        if name not in NAMES:
            raise WrongCall(f"--masters: value is {name!r}, allowed {', '.join(NAMES)}")
    return list(dict.fromkeys(found))


def check_kind(output: Path | None) -> None:
    """Of the file to write. Raises WrongCall."""
    if output is None:
        return
    if output.suffix not in (".html", ".svg"):
        raise WrongCall(
            f"--output: value is {str(output)!r}, allowed a name that ends in .html or .svg"
        )
    try:
        import matplotlib  # noqa: F401
    except ImportError:
        raise WrongCall(
            "--output: matplotlib is missing, allowed after pip install 'railpatch[bench]'"
        ) from None


def need_both() -> None:
    """Raises WrongCall where fmpy or Pinocchio is missing."""
    if find_spec("fmpy") is None:
        raise WrongCall(
            "railpatch cosimulation needs fmpy: pip install fmpy 'railpatch[pinocchio]'"
        )
    need_pinocchio()


@click.command("cosimulation", cls=NeedingCommand, needs=need_both)
@scene_argument()
@output_option("PAGE.html|PLOT.svg", "Page with plot and tables, or the plot.", required=False)
@click.option("--speeds", metavar="M/S,...", help="Speeds.  [default: 0.2 to 80]")
@click.option(
    "--masters", metavar="NAME,...", help=f"Masters: {', '.join(NAMES)}.  [default: most]"
)
@click.option(
    "--elements",
    type=click.IntRange(4, 64),
    default=ELEMENTS,
    show_default=True,
    help="Contact grid, across either way, in place of the scene's.",
)
@click.option("--quick", is_flag=True, help="Three speeds and masters, half a minute.")
@json_option()
@show_scene_option(default_scene_text)
@quiet_flag("Print nothing but --json, and no progress.")
@click.pass_context
def cosimulation(
    context: click.Context,
    scene: Path | None,
    output: Path | None,
    speeds: str | None,
    masters: str | None,
    elements: int,
    quick: bool,
    as_json: bool,
    quiet: bool,
) -> None:
    """Find the largest stable communication step of co-simulation masters over speed.

    The wheelset and its suspension are integrated here, the contact is in an FMU that the master
    steps through fmpy: forces held, of first order, iterated with rollback, or linearly implicit by
    the FMU's directional derivatives. Energy that the coupling makes or loses stands beside. The
    scene is one of railpatch wheelset; without one it is that of railpatch hunting. Takes some ten
    minutes. A speed at which a contact cannot be solved is marked, and ends it with exit code 3.
    """
    chosen_speeds, chosen = speeds_of(speeds, quick), masters_of(masters, quick)
    check_kind(output)
    from wheelset_demo.coupling.report import dict_of, text_of
    from wheelset_demo.coupling.slave import CouplingFailure
    from wheelset_demo.coupling.study import study, with_elements
    from wheelset_demo.scene import load_wheelset_scene, scene_file

    count = len(chosen_speeds) * len(chosen)
    try:
        with wrong_calls():
            file = scene_file(SCENE) if scene is None else scene
            loaded = load_wheelset_scene(file)
            check_output(output, file, *files_of(loaded.case, file.parent))
            with progress_bar("coupling", count, quiet) as advance:
                found = study(with_elements(loaded, elements), chosen_speeds, chosen, advance)
    except CouplingFailure as failure:
        click.echo(f"status: {failure}", err=True)
        context.exit(EXIT_NOT_CONVERGED)
    # minutes were spent: shown before a file can fail
    if as_json:
        click.echo(json.dumps(dict_of(found), allow_nan=False))
    elif not quiet:
        click.echo(text_of(found))
    if output is not None:
        save(found, output)
    for speed, text in found.failures.items():
        click.echo(f"status: at {speed:g} m/s: {text}", err=True)
    if found.failures:
        context.exit(EXIT_NOT_CONVERGED)


def save(found: Any, output: Path) -> None:
    """Raises WrongCall."""
    from wheelset_demo.coupling.report import write

    try:
        write(found, output)
    except OSError as error:
        raise refusal(output, f"a file that can be written: {error.strerror or error}") from None
