"""railpatch table --wheel W --rail R, or --case CASE.toml."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Any

import click

from railpatch.case.creep_table import describe_table
from railpatch.case.load import plain, read_toml
from railpatch.command.output import check_output
from railpatch.errors import CaseError
from railpatch.evidence.table.pair import Pair, Ranges
from railpatch.evidence.table.shapes import make_shapes
from railpatch.writing import write_whole

Asked = tuple[tuple[float, float] | None, tuple[float, float] | None, float | None]


def pair_case(wheel: str | None, rail: str | None) -> dict[str, Any]:
    """A right wheel of 0.46 m on standard gauge."""
    if wheel is None or rail is None:
        missing = "--wheel" if wheel is None else "--rail"
        raise CaseError(f"{missing}: value is none, allowed a profile: a pair has both")
    return {
        "kind": "wheel_rail",
        "wheel": {"side": "right"},
        "wheelset": {
            "nominal_radius": 0.46, "flange_back_distance": 1.36, "flange_back_position": -0.07,
        },
        "track": {"kind": "rail", "gauge": 1.435, "gauge_height": 0.014},
        "profiles": {"wheel": wheel, "rail": rail},
        "friction": {"coefficient": 0.3},
    }  # fmt: skip


def ranges_of(
    y: tuple[float, float] | None, load: tuple[float, float] | None, yaw: float | None = None
) -> Ranges:
    """In mm, kN and mrad, else the default ones. Raises CaseError."""
    found: dict[str, Any] = {}
    limits = {"--y": (y, -50.0, 50.0, 1e-3, "y"), "--load": (load, 0.1, 500.0, 1e3, "load")}
    for option, (given, low, high, unit, name) in limits.items():
        if given is None:
            continue
        if not low <= given[0] < given[1] <= high:
            raise CaseError(
                f"{option}: value is {given[0]:g} {given[1]:g}, allowed two rising numbers "
                f"from {low:g} to {high:g}"
            )
        found[name] = (unit * given[0], unit * given[1])
    if yaw is not None:
        if not 0 < yaw <= 100:
            raise CaseError(f"--yaw: value is {yaw:g}, allowed more than 0 and at most 100")
        found["yaw"] = 1e-3 * yaw
    return Ranges(**found)


def make_pair(
    output: Path, jobs: int, profiles: tuple[str | None, str | None], case: Path | None,
    error: float, ranges: Asked, check: int, most: int, seed: int, keep: bool, quiet: bool,
) -> None:  # fmt: skip
    """Makes and writes the table, and tells its errors."""
    check_output(output)
    if case is not None and any(profiles):
        raise CaseError("--case: value is given beside --wheel or --rail, allowed one of both")
    content = pair_case(*profiles) if case is None else plain(read_toml(case))
    folder = "." if case is None else str(case.parent)
    label = " on ".join(str(name) for name in profiles) if case is None else case.name
    pair = Pair(content, folder, ranges_of(*ranges), seed, label)
    parts = output.with_name(f"{output.name}.parts")
    try:
        with progress(quiet) as step:
            data = make_shapes(pair, error, check, jobs, step, most, parts)
        write_whole(output, data)
    except OSError as failed:
        raise CaseError(f"{output}: cannot be written: {failed.strerror or failed}") from None
    if not keep:
        shutil.rmtree(parts, ignore_errors=True)
    about = describe_table(data)
    if quiet:
        return
    found = about["error"]
    click.echo(
        f"{output}: {len(data)} bytes, {about['shapes']} shapes, {about['seconds']} s of processor "
        "time; error in per cent, median / 90 / 95 / 99 % / worst"
    )
    texts = [" / ".join(f"{100 * e:.3f}" for e in found[key]) for key in ("force", "moment")]
    click.echo(f"  {about['pair']}  {found['cases']} states  force {texts[0]}  moment {texts[1]}")
    if found["force"][2] > error:
        click.echo(
            f"  95 % lie below {100 * found['force'][2]:.2f} %, not {100 * error:g} % as asked for",
            err=True,
        )


class progress:
    """A line on stderr where that is a terminal."""

    def __init__(self, quiet: bool) -> None:
        from rich.console import Console

        console = Console(stderr=True)
        self._status = console.status("table") if console.is_terminal and not quiet else None

    def __enter__(self) -> Any:
        if self._status is None:
            return lambda _text: None
        self._status.start()
        return self._status.update

    def __exit__(self, *_error: object) -> None:
        if self._status is not None:
            self._status.stop()
