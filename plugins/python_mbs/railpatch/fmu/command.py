"""The sub-command ``railpatch fmu``."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from railpatch.command.group import (
    complete_file,
    completed,
    output_option,
    quiet_flag,
    scene_argument,
)
from railpatch.command.output import check_output, files_of
from railpatch.errors import CaseError


def scene_names() -> list[str]:
    """Of the scenes that come with the package."""
    from railpatch.fmu.scenes import kinds

    return kinds()


@click.command("fmu")
@scene_argument()
@output_option("NAME.fmu", "The FMU to write; NAME is also that of the library inside.")
@click.option(
    "--scene",
    "kind",
    metavar="NAME",
    shell_complete=completed(scene_names),
    help="One of the scenes that come with the package, in place of a file: patch, wheel, "
    "wheelset_rail, ...; an unknown name gives the list.",
)
@click.option(
    "--fmi",
    type=click.Choice(["2", "3"]),
    default="2",
    show_default=True,
    help="Version of the standard: FMI 2.0, or FMI 3.0, in which vectors are arrays.",
)
@click.option(
    "--fft",
    type=click.Choice(["eigen", "fftw"]),
    default="eigen",
    show_default=True,
    help="The FFT library: fftw makes the FMU one under the GPL; its library is made by "
    "`make fmu-fftw`.",
)
@click.option(
    "--derivatives",
    type=click.Choice(["exact", "always", "none"]),
    default="exact",
    show_default=True,
    help="Directional derivatives: where exact ones exist, always (else by differences), or none.",
)
@click.option("--averages", is_flag=True, help="Also give forces averaged over a step.")
@click.option(
    "--largest-step",
    is_flag=True,
    help="Also give the largest step that forces may be held for; takes two to three steps' time.",
)
@click.option(
    "--inputs",
    "inputs",
    metavar="friction",
    help="Further inputs, separated by commas: friction, the coefficient of Coulomb's law, of a "
    "wheelset one for each wheel; of other laws a factor. Left out, it is a tunable parameter.",
)
@click.option(
    "--outputs",
    "outputs",
    metavar="LIST",
    help="Outputs to keep, separated by commas: names, patterns (left.*), or the groups forces, "
    "wheels, patches, power; without it all. The status is always there.",
)
@click.option(
    "--patches",
    type=int,
    metavar="N",
    help="Greatest number of patches of a wheel, in place of the scene's max_patches.",
)
@click.option(
    "--wheel-profile",
    "wheel_profiles",
    multiple=True,
    metavar="NAME|FILE",
    shell_complete=complete_file,
    help="A further profile of both wheels beside the scene's own, to choose by the parameter "
    "profiles.wheel; may be given several times.",
)
@click.option(
    "--rail-profile",
    "rail_profiles",
    multiple=True,
    metavar="NAME|FILE",
    shell_complete=complete_file,
    help="The same of both rails or rollers: profiles.rail.",
)
@click.option(
    "--profile-files",
    is_flag=True,
    help="Also take the profile of each wheel and rail from a file at run time: parameters "
    "profiles.wheel_left_file, ...; `railpatch profile FILE -o NAME.profile` makes such files.",
)
@click.option(
    "--libraries",
    type=click.Path(exists=True, file_okay=False, path_type=Path),
    metavar="FOLDER",
    help="Libraries for further systems and the sources, as made by `make fmu`.",
)
@quiet_flag()
def fmu(
    scene: Path | None,
    kind: str | None,
    output: Path,
    fmi: Any,
    fft: Any,
    derivatives: Any,
    averages: bool,
    largest_step: bool,
    inputs: str | None,
    outputs: str | None,
    patches: int | None,
    wheel_profiles: tuple[str, ...],
    rail_profiles: tuple[str, ...],
    profile_files: bool,
    libraries: Path | None,
    quiet: bool,
) -> None:
    """Pack a scene as an FMU: FMI 2.0 or 3.0, Linux on x86-64 unless --libraries has more.

    Position and velocity come in, forces and the patches' quantities go out; the FMU holds its own
    description in documentation/index.html. A scene is a case file, or that of a rig. Without one
    it is the roller rig, or where that is not installed an S1002 wheelset on UIC60 rails.
    """
    from railpatch.fmu.pack import pack_fmu
    from railpatch.fmu.scenes import kind_scene, kinds, scene_of

    if kind is not None and scene is not None:
        raise CaseError(f"--scene: given beside {scene}, allowed one of the two")
    if kind is not None and kind not in kinds():
        raise CaseError(f"--scene: value is {kind!r}, allowed {', '.join(kinds())}")
    name, loaded = kind_scene(kind) if kind is not None else scene_of(scene)
    read = libraries.rglob("*") if libraries is not None else ()
    wheels, rails = from_here(wheel_profiles), from_here(rail_profiles)
    read = [*files_of(loaded.case, loaded.folder), *read, *wheels, *rails]
    check_output(output, scene, *read)
    written = pack_fmu(
        loaded,
        output,
        name=name,
        backend=fft,
        derivatives=derivatives,
        averages=averages,
        largest_step=largest_step,
        libraries=libraries,
        wheel_profiles=wheels,
        rail_profiles=rails,
        profile_files=profile_files,
        fmi=int(fmi),
        inputs=listed(inputs),
        outputs=listed(outputs),
        patches=patches,
    )
    for text in written.warnings:
        click.echo(f"warning: {text}", err=True)
    if not quiet:
        licence = ", under the GPL because of FFTW" if fft == "fftw" else ""
        click.echo(f"{written}: {name}{licence}")


def listed(text: str | None) -> list[str]:
    """The words of a list with commas."""
    return [word.strip() for word in (text or "").split(",") if word.strip()]


def from_here(profiles: tuple[str, ...]) -> list[str]:
    """Built-in names as they are, files by their whole path: the scene's folder may be another."""
    from railpatch.profiles.builtin import PATTERN

    return [name if PATTERN.fullmatch(name) else str(Path(name).absolute()) for name in profiles]
