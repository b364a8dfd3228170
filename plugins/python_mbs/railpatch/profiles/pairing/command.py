"""The sub-command ``railpatch profile``."""

from __future__ import annotations

from pathlib import Path

import click

from railpatch.command.group import (
    WrongCall,
    complete_file,
    output_option,
    quiet_flag,
    wrong_call,
)
from railpatch.command.output import check_page, refuse_same
from railpatch.page.browser import BrowserError
from railpatch.profiles.pairing.contact_points import Dimensions
from railpatch.profiles.pairing.doctor import tables_of
from railpatch.profiles.pairing.pressures import LOAD
from railpatch.profiles.prepared import SUFFIX, write_prepared
from railpatch.profiles.raw import Mirror, Reading, Role, Unit


def length_option(name: str, field: str, text: str) -> click.Option:
    """A dimension of the pair in m, with its default."""
    return click.option(
        name, field, type=float, default=getattr(Dimensions, field), show_default=True, help=text
    )


@click.command("profile")
@click.argument("source", metavar="NAME|FILE", shell_complete=complete_file)
@output_option(
    "PLOT.html|.pdf|NAME.profile",
    "The page to write; a PDF is made by Chromium, Chrome or Edge. NAME.profile: no page, but the "
    "profile as an FMU reads it at run time. Left out: the answers on the terminal alone.",
    required=False,
)
@click.option(
    "--rail",
    metavar="NAME|FILE",
    shell_complete=complete_file,
    help="Partner of a wheel.  [default: UIC60@1:40]",
)
@click.option(
    "--wheel",
    metavar="NAME|FILE",
    shell_complete=complete_file,
    help="Partner of a rail.  [default: S1002]",
)
@click.option(
    "--smoothing",
    type=click.FloatRange(0, 0.1),
    metavar="LENGTH",
    help="m, wave length of which half the amplitude is kept in profile files; 0: interpolation.",
)
@click.option(
    "--role", type=click.Choice(["wheel", "rail"]), help="Where neither name nor partner tells."
)
@click.option("--unit", type=click.Choice(["m", "mm", "in"]), help="Of length in the file.")
@click.option("--swap/--no-swap", default=None, help="Whether its columns are z, y.")
@click.option(
    "--mirror",
    type=click.Choice(["none", "y", "z", "yz"]),
    help="Axes that point the other way than from flange or gauge side to field side, and down.",
)
@click.option(
    "--origin", type=float, nargs=2, metavar="Y Z", help="m, the profile's origin in the file."
)
@click.option(
    "--load",
    type=click.FloatRange(1e2, 5e5),
    default=LOAD,
    show_default=True,
    help="N, on the wheel, of the pressures.",
)
@length_option("--gauge", "gauge", "m, track gauge.")
@length_option("--radius", "nominal_radius", "m, wheel radius at the profile's z = 0.")
@length_option("--flange-back-distance", "flange_back_distance", "m, between the flange backs.")
@length_option(
    "--flange-back-position", "flange_back_position", "m, of the flange back on the profile's y."
)
@length_option("--gauge-height", "gauge_height", "m, below the rail's top, of the gauge.")
@quiet_flag()
def profile(
    source: str,
    output: Path | None,
    rail: str | None,
    wheel: str | None,
    smoothing: float | None,
    role: Role | None,
    unit: Unit | None,
    swap: bool | None,
    mirror: Mirror | None,
    origin: tuple[float, float] | None,
    load: float,
    quiet: bool,
    **lengths: float,
) -> None:
    """Examine a wheel or rail profile, and make a page of plots.

    What was assumed of a file, with the lines of a scene that say so; its points, how far they lie
    off the curve, shape, slope, curvature and kinks; with the partner, for a wheelset with two such
    wheels on two such rails: contact points, rolling radius difference, equivalent conicity and
    greatest pressure, with the error that the points' noise leaves in it, which go into
    PLOT.contact.csv and PLOT.contact.json too. The page needs no network.
    """
    if output is not None and output.suffix == SUFFIX:
        refuse_same(output, source)
        path = prepare(source, output, role, smoothing, Reading(unit, swap, mirror, origin))
        if not quiet:
            click.echo(path)
        return
    if rail is not None and wheel is not None:
        raise WrongCall("--rail, --wheel: both given, allowed one: the profile's partner")
    if output is not None:
        check_page(output, source, rail, wheel, others=(SUFFIX,))
        for path in tables_of(output):
            refuse_same(path, source, rail, wheel)
    # plotly takes a while to import; other commands need not wait for it
    from railpatch.profiles.pairing.page import examine, write_profile_page

    by_partner: Role | None = "wheel" if rail is not None else "rail" if wheel is not None else None
    if role is not None and by_partner not in (None, role):
        raise WrongCall(f"--role: value is {role!r}, allowed {by_partner!r} with such a partner")
    found = examine(
        source,
        role=role or by_partner,
        reading=Reading(unit, swap, mirror, origin),
        partner=rail or wheel,
        dimensions=Dimensions(**lengths),
        smoothing=smoothing,
        load=load,
    )
    for note in found.told:
        click.echo(f"note: {note}", err=True)
    if output is not None:
        try:
            write_profile_page(found, output)
        except (BrowserError, OSError) as error:
            raise wrong_call(error) from None
    if quiet:
        return
    click.echo(found.text())
    for path in [output, *tables_of(output)] if output is not None else []:
        click.echo(path)


def prepare(
    source: str, output: Path, role: Role | None, smoothing: float | None, reading: Reading
) -> Path:
    """Writes a prepared profile, read and smoothed as a scene would. Raises ProfileError."""
    from railpatch.profiles import load_profile
    from railpatch.profiles.pairing.page import EITHER, role_of

    if role is None and source.partition("@")[0] in EITHER:
        raise WrongCall(f"--role: left out, allowed wheel or rail: {source} may be either")
    role = role or role_of(source)
    profile = load_profile(source, role, smoothing=smoothing, reading=reading)
    try:
        return write_prepared(profile, role, Path(source).name, output)
    except OSError as error:
        raise wrong_call(error) from None
