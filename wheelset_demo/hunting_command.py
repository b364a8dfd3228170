"""The sub-command ``railpatch hunting``."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import click
from railpatch.commands import (
    EXIT_NOT_CONVERGED,
    WrongCall,
    scene_argument,
    show_scene_option,
)
from railpatch.errors import CaseError, ProfileError

SCENE = "hunting.toml"
# of the critical speed by eigenvalues: where the runs in time begin
BRACKET = (0.85, 1.15)


def default_scene_text() -> str:
    """The scene that is taken by default."""
    from wheelset_demo.scene import scene_file

    return scene_file(SCENE).read_text(encoding="utf-8")


@click.command("hunting")
@scene_argument()
@click.option("--lowest", type=float, default=10.0, metavar="M/S", help="Lowest speed tried.")
@click.option("--highest", type=float, default=150.0, metavar="M/S", help="Highest speed tried.")
@click.option(
    "--simulate", is_flag=True, help="Also by runs in time at speeds around it, some 20 s."
)
@click.option("--json", "as_json", is_flag=True, help="Print one JSON object.")
@show_scene_option(default_scene_text)
@click.option("--quiet", is_flag=True, help="Print nothing but --json.")
@click.pass_context
def hunting(
    context: click.Context,
    scene: Path | None,
    lowest: float,
    highest: float,
    simulate: bool,
    as_json: bool,
    quiet: bool,
) -> None:
    """Find the speed above which a wheelset hunts.

    From the eigenvalues of the equations of motion, linearised straight on with the contact's
    derivatives. The scene is one of railpatch wheelset; without one it has coned wheels and a
    primary suspension. A contact that cannot be solved ends it with exit code 3.
    """
    if not 0 < lowest < highest:
        raise WrongCall(f"--lowest: value is {lowest}, allowed > 0 and below --highest ({highest})")
    try:
        import railpatch.pinocchio  # noqa: F401
    except ImportError as error:
        raise WrongCall(str(error)) from None
    from wheelset_demo.scene import load_wheelset_scene, scene_file
    from wheelset_demo.system import ContactFailure

    try:
        loaded = load_wheelset_scene(scene_file(SCENE) if scene is None else scene)
        found = search(loaded, lowest, highest, simulate)
    except ContactFailure as failure:
        click.echo(f"status: {failure}", err=True)
        context.exit(EXIT_NOT_CONVERGED)
    except (CaseError, ProfileError, OSError) as error:
        raise WrongCall(str(error)) from None
    if as_json:
        click.echo(json.dumps(found, allow_nan=False))
    elif not quiet:
        click.echo(text_of(found))


def search(scene: Any, lowest: float, highest: float, simulate: bool) -> dict[str, Any]:
    """What is printed: SI units, None for what was not found."""
    from wheelset_demo.hunting import critical_mode, critical_speed_in_time, slowest_mode

    mode = critical_mode(scene, lowest, highest)
    found: dict[str, Any] = {
        "scene": scene.name,
        "range": [lowest, highest],
        "critical_speed": None if mode is None else mode.speed,
        "frequency": None if mode is None else mode.frequency,
        "wave_length": None if mode is None else mode.wave_length,
    }
    speeds = [lowest, highest] if mode is None else [part * mode.speed for part in BRACKET]
    around = [slowest_mode(scene, speed) for speed in speeds]
    found["growth"] = [{"speed": m.speed, "growth": m.growth} for m in around]
    if simulate and mode is not None:
        speed, runs = critical_speed_in_time(scene, *speeds, mode.frequency)
        found["critical_speed_in_time"] = speed
        found["runs"] = [{"speed": run.speed, "growth": run.growth} for run in runs]
    return found


def text_of(found: dict[str, Any]) -> str:
    """A few lines for the terminal."""
    lines = [("scene", found["scene"])]
    speed = found["critical_speed"]
    if speed is None:
        low, high = found["range"]
        lines.append(("critical speed", f"none between {low:g} and {high:g} m/s"))
    else:
        lines += [
            ("critical speed", f"{speed:.2f} m/s ({3.6 * speed:.1f} km/h), from eigenvalues"),
            ("hunting", f"{found['frequency']:.3f} Hz, waves of {found['wave_length']:.2f} m"),
        ]
    lines += [
        ("growth", f"{g['growth']:+.4f} 1/s at {g['speed']:.2f} m/s") for g in found["growth"]
    ]
    if "runs" in found:
        in_time = found["critical_speed_in_time"]
        away = 100 * (in_time / speed - 1)
        lines.append(("in time", f"{in_time:.2f} m/s, {away:+.2f} %, of {len(found['runs'])} runs"))
    return "\n".join(f"{name:<16}{value}" for name, value in lines)
