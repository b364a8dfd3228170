"""The sub-command ``railpatch fmu``."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from railpatch.commands import output_option, scene_argument


@click.command("fmu")
@scene_argument()
@output_option("NAME.fmu", "The FMU to write; NAME is also that of the library inside.")
@click.option(
    "--fft",
    type=click.Choice(["eigen", "fftw"]),
    default="eigen",
    show_default=True,
    help="The FFT library: fftw is faster, and makes the FMU one under the GPL.",
)
@click.option(
    "--libraries",
    type=click.Path(exists=True, file_okay=False, path_type=Path),
    metavar="FOLDER",
    help="Libraries for further systems and the sources, as made by `make fmu`.",
)
@click.option("--quiet", is_flag=True, help="Print nothing.")
def fmu(scene: Path | None, output: Path, fft: Any, libraries: Path | None, quiet: bool) -> None:
    """Pack a scene as an FMU: FMI 2.0, co-simulation, Linux on x86-64 unless --libraries has more.

    Position and velocity come in, forces and the patches' quantities go out; the FMU holds its own
    description in documentation/index.html. A scene is a case file, or that of a rig. Without one
    it is the roller rig, or where that is not installed an S1002 wheelset on UIC60 rails.
    """
    from railpatch.fmu.pack import pack_fmu
    from railpatch.fmu.scenes import scene_of

    name, loaded = scene_of(scene)
    written = pack_fmu(loaded, output, name=name, backend=fft, libraries=libraries)
    if not quiet:
        licence = ", under the GPL because of FFTW" if fft == "fftw" else ""
        click.echo(f"{written}: {name}{licence}")
