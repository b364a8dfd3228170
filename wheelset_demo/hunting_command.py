"""The sub-command ``railpatch hunting``."""

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
    quiet_flag,
    scene_argument,
    show_scene_option,
    tell_warnings,
    wrong_calls,
)
from railpatch.command.output import check_output, files_of
from railpatch.errors import CaseError

SCENE = "hunting.toml"
# of the critical speed by eigenvalues: where the runs in time begin
BRACKET = (0.85, 1.15)
# the same, where modes are drawn
DRAWN = (0.5, 0.7, 0.8, 0.9, 0.95, 1.0, 1.05, 1.1, 1.2, 1.3)
LOGGED = 1.1
# m/s
SLOWEST, FASTEST = 0.05, 200.0


def default_scene_text() -> str:
    """The scene that is taken by default."""
    from wheelset_demo.scene import scene_file

    return scene_file(SCENE).read_text(encoding="utf-8")


@click.command("hunting", cls=NeedingCommand, needs=need_pinocchio)
@scene_argument()
@click.option("--lowest", type=float, default=10.0, metavar="M/S", help="Lowest speed tried.")
@click.option("--highest", type=float, default=150.0, metavar="M/S", help="Highest speed tried.")
@click.option(
    "--simulate", is_flag=True, help="Also by runs in time at speeds around it, some 20 s."
)
@output_option(
    "RUN.mcap",
    "The log to write, of a run in time; railpatch report shows it with what was found.",
    required=False,
)
@click.option(
    "--speed",
    type=float,
    metavar="M/S",
    help="Of the run that is logged; left out: 1.1 of the critical speed.",
)
@click.option(
    "--slip",
    is_flag=True,
    help="Of a vehicle: its sliders slip, with their stiffness left out; without it they stick.",
)
@json_option()
@show_scene_option(default_scene_text)
@quiet_flag("Print nothing but --json.")
@click.pass_context
def hunting(
    context: click.Context,
    scene: Path | None,
    lowest: float,
    highest: float,
    simulate: bool,
    output: Path | None,
    speed: float | None,
    slip: bool,
    as_json: bool,
    quiet: bool,
) -> None:
    """Find the speed above which a wheelset or a vehicle hunts.

    From the eigenvalues of the equations of motion, linearised straight on with the contact's
    derivatives. The scene is one of railpatch wheelset or railpatch vehicle; without one it has
    coned wheels and a primary suspension. A contact that cannot be solved ends it with exit code 3.
    """
    for name, value in (("--lowest", lowest), ("--highest", highest)):
        if not SLOWEST <= value <= FASTEST:
            raise WrongCall(f"{name}: value is {value}, allowed {SLOWEST:g} ... {FASTEST:g} m/s")
    if not lowest < highest:
        raise WrongCall(f"--lowest: value is {lowest}, allowed below --highest ({highest})")
    if speed is not None and (output is None or not 0 < speed <= FASTEST):
        raise WrongCall(f"--speed: value is {speed}, allowed > 0, at most {FASTEST:g}, with -o")
    from railpatch.case.load import read_toml

    from wheelset_demo.scene import load_wheelset_scene, scene_file
    from wheelset_demo.system import ContactFailure

    try:
        with wrong_calls():
            file = scene_file(SCENE) if scene is None else scene
            if "vehicle" in read_toml(file):
                refuse_time(simulate, output)
                show(search_whole(file, lowest, highest, slip, quiet), as_json, quiet)
                return
            if slip:
                raise WrongCall("--slip: given, allowed with a scene of railpatch vehicle")
            loaded = load_wheelset_scene(file)
            check_output(output, file, *files_of(loaded.case, file.parent))
            found = search(loaded, lowest, highest, simulate)
            try:
                if output is not None:
                    write_log(loaded, found, speed, output)
            finally:
                # what was found is not lost with the log
                show(found, as_json, quiet)
    except ContactFailure as failure:
        click.echo(f"status: {failure}", err=True)
        context.exit(EXIT_NOT_CONVERGED)


def show(found: dict[str, Any], as_json: bool, quiet: bool) -> None:
    """On stdout."""
    if as_json:
        click.echo(json.dumps(found, allow_nan=False))
    elif not quiet:
        click.echo(text_of(found))


def refuse_time(simulate: bool, output: Path | None) -> None:
    """Of a vehicle. Raises WrongCall."""
    for name, given in (("--simulate", simulate), ("--output", output is not None)):
        if given:
            text = "allowed with a scene of railpatch wheelset: railpatch vehicle runs in time"
            raise WrongCall(f"{name}: given, {text}")


def search_whole(
    file: Path, lowest: float, highest: float, slip: bool, quiet: bool
) -> dict[str, Any]:
    """What is printed of a vehicle: SI units, None for what was not found."""
    from wheelset_demo.vehicle.hunting import left_out, moves_at, search_vehicle, vehicle_mode
    from wheelset_demo.vehicle.plausible import doubts_of
    from wheelset_demo.vehicle.scene import load_vehicle_scene

    scene = load_vehicle_scene(file)
    tell_warnings(doubts_of(scene), strict=False, quiet=quiet)
    searched = search_vehicle(scene, lowest, highest, slip)
    found = found_by(scene.name, searched, lowest, highest)
    middle = found["critical_speed"]
    speeds = [lowest, highest] if middle is None else [part * middle for part in BRACKET]
    around = [vehicle_mode(scene, speed, slip) for speed in speeds]
    found["growth"] = [{"speed": m.speed, "growth": m.growth} for m in around]
    found["moves"] = moves_at(scene, speeds[0] if middle is None else middle, slip)
    found["left_out"] = left_out(scene)
    return found


def found_by(name: str, searched: Any, lowest: float, highest: float) -> dict[str, Any]:
    """Of a search between two speeds (m/s)."""
    mode, diverging = searched.critical, searched.diverging
    return {
        "scene": name,
        "range": [lowest, highest],
        "critical_speed": None if mode is None else mode.speed,
        "frequency": None if mode is None else mode.frequency,
        "wave_length": None if mode is None else mode.wave_length,
        # waves grow at the lowest speed: the critical one is below this
        "critical_speed_below": lowest if searched.below else None,
        "divergence": None
        if diverging is None
        else {"speed": diverging.speed, "growth": diverging.divergence},
    }


def search(scene: Any, lowest: float, highest: float, simulate: bool) -> dict[str, Any]:
    """What is printed: SI units, None for what was not found."""
    from wheelset_demo.hunting import critical_speed_in_time, search_modes, slowest_mode

    searched = search_modes(scene, lowest, highest)
    mode = searched.critical
    found = found_by(scene.name, searched, lowest, highest)
    speeds = [lowest, highest] if mode is None else [part * mode.speed for part in BRACKET]
    around = [slowest_mode(scene, speed) for speed in speeds]
    found["growth"] = [{"speed": m.speed, "growth": m.growth} for m in around]
    if simulate and mode is not None:
        speed, runs = critical_speed_in_time(scene, *speeds, mode.frequency)
        found["critical_speed_in_time"] = speed
        found["runs"] = [row_of(run) for run in runs]
    return found


def row_of(found: Any) -> dict[str, float]:
    """Of a mode or a run."""
    return {"speed": found.speed, "growth": found.growth, "frequency": found.frequency}


def write_log(scene: Any, found: dict[str, Any], speed: float | None, output: Path) -> None:
    """The log of a run in time, with what was found and modes around it attached.

    Raises CaseError where there is no critical speed and no other, OSError.
    """
    from railpatch.log.channels import HUNTING

    from wheelset_demo.hunting import long_run, slowest_mode
    from wheelset_demo.simulation import run_scene

    middle = found["critical_speed"] or speed
    if middle is None:
        raise CaseError("--speed: left out, allowed one (m/s) where no critical speed is found")
    chosen = LOGGED * middle if speed is None else speed
    modes = [slowest_mode(scene, part * middle) for part in DRAWN]
    frequency = found["frequency"] or modes[DRAWN.index(1.0)].frequency
    content = found | {"modes": [row_of(mode) for mode in modes], "logged_speed": chosen}
    attached = {HUNTING: json.dumps(content, allow_nan=False, indent=1).encode()}
    summary = run_scene(long_run(scene, chosen, frequency), output, attached=attached)
    found["log"] = {"path": str(output), "speed": chosen, "status": summary.message or "converged"}


def text_of(found: dict[str, Any]) -> str:
    """A few lines for the terminal."""
    lines = [("scene", found["scene"])]
    speed, below = found["critical_speed"], found["critical_speed_below"]
    if below is not None:
        lines.append(("critical speed", f"below {below:g} m/s: waves already grow there"))
    elif speed is None:
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
    if found["divergence"] is not None:
        away = found["divergence"]
        text = f"{away['growth']:+.4f} 1/s at {away['speed']:.2f} m/s, without waves"
        lines.append(("divergence", text))
    if "moves" in found:
        shown = ", ".join(f"{name} {size:.2f}" for name, size in found["moves"].items())
        lines.append(("moves", f"across the track: {shown}"))
    if found.get("left_out"):
        lines.append(("left out", f"{', '.join(found['left_out'])}: straight, level, undriven"))
    if "runs" in found:
        in_time = found["critical_speed_in_time"]
        away = 100 * (in_time / speed - 1)
        lines.append(("in time", f"{in_time:.2f} m/s, {away:+.2f} %, of {len(found['runs'])} runs"))
    if "log" in found:
        log = found["log"]
        lines.append(("log", f"{log['path']}, at {log['speed']:.2f} m/s, {log['status']}"))
    return "\n".join(f"{name:<16}{value}" for name, value in lines)
