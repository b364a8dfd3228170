"""The sub-command ``railpatch match``."""

from __future__ import annotations

import json
from importlib import resources
from pathlib import Path

import click

from railpatch.command.group import (
    folder_option,
    json_option,
    quiet_flag,
    show_scene_option,
    strict_flag,
    tell_warnings,
    wrong_calls,
)
from railpatch.command.output import check_folder


def example_text() -> str:
    """A match to start from."""
    return resources.files("railpatch.match").joinpath("example.toml").read_text("utf-8")


@click.command("match")
@click.argument("scene", metavar="SCENE.toml", type=click.Path(path_type=Path))
@click.option(
    "--record",
    type=click.Path(path_type=Path),
    metavar="POINTS.csv",
    help="The measured points; default: those that [match] names.",
)
@folder_option("Folder for match.toml, match.json, match.csv and match.html.")
@click.option(
    "--threads", type=click.IntRange(1, 1024), default=1, show_default=True, help="Of the solver."
)
@json_option("Print match.json.")
@show_scene_option(example_text, "Print a match, as a start for one's own.")
@strict_flag()
@quiet_flag()
def match(
    scene: Path,
    record: Path | None,
    output: Path,
    threads: int,
    as_json: bool,
    strict: bool,
    quiet: bool,
) -> None:
    """Find parameters of a scene from measured points, and how well these know them.

    The table [match] of the scene says what is sought, between which ends, and which columns of the
    record are what.
    """
    from railpatch.match.found import Match, unit_of
    from railpatch.match.model import need_writer
    from railpatch.match.plan import load_match
    from railpatch.match.run import run_match, write_match

    check_folder(output)
    silent = quiet or as_json

    def tell(text: str) -> None:
        if not silent:
            click.echo(text, err=True)

    def show(found: Match) -> None:
        for parameter in found.parameters.values():
            interval = f"{parameter.low:.6g} to {parameter.high:.6g}"
            unit = "" if parameter.unit == "-" else f" {parameter.unit}"
            click.echo(f"{parameter.key:<37} {parameter.value:<12.6g} {interval}{unit}".rstrip())
        own = found.explanations[0]
        for key, rms in zip(plan.table.observed, own.fit.rms, strict=True):
            unit = unit_of(key, plan.table.observed[key], plan).replace("-", "")
            click.echo(f"{'rms of ' + key:<37} {rms:.4g} {unit}".rstrip())
        for key, parts in own.chains.items():
            for name, (value, error) in parts.items():
                click.echo(f"{f'{name} of {key}':<38}{value:<12.6g}+- {error:.3g}")
        for key, one in own.screening.items():
            click.echo(f"{'effect of ' + key:<38}{one.effect:<12.4g}+- {one.spread:.3g}")
        for key, one in own.samples.items():
            click.echo(f"{'sampled ' + key:<38}{one.median:<12.6g}{one.low:.6g} to {one.high:.6g}")
        for text in own.not_told:
            click.echo(text)

    with wrong_calls():
        need_writer()
        plan = load_match(scene, record)
        tell_warnings(list(plan.warnings), strict=strict, quiet=silent)
        found = run_match(plan, threads=threads, tell=tell)
        written = write_match(found, output)
    if as_json:
        click.echo(json.dumps(found.to_dict(), allow_nan=False))
    elif not quiet:
        show(found)
        click.echo("\n".join(f"written       {file}" for file in written))
