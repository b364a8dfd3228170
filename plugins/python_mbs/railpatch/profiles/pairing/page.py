"""The page on a profile: one HTML file that needs no network."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
from pathlib import Path

import numpy as np

from railpatch.errors import ProfileError
from railpatch.page.document import document
from railpatch.page.figures import plot
from railpatch.page.parts import DOUBT, GOOD, Key, folded, opening
from railpatch.page.printing import write_page
from railpatch.page.tables import short
from railpatch.profiles import load_profile, read_profile
from railpatch.profiles.curve import Profile
from railpatch.profiles.pairing import doctor, figures
from railpatch.profiles.pairing.contact_points import ContactPoints, Dimensions, contact_points
from railpatch.profiles.pairing.pressures import LOAD, Pressures, pressures
from railpatch.profiles.raw import RawProfile, Reading, Role
from railpatch.profiles.shape import CORNER_RADIUS, CURVATURE_STEP, Shape, shape_of
from railpatch.writing import write_whole

PARTNERS: dict[Role, str] = {"wheel": "UIC60@1:40", "rail": "S1002"}
# built-in names that are one or the other, and those that are either
ROLES: dict[str, Role] = {"S1002": "wheel", "UIC60": "rail"}
EITHER = ("cone", "arc", "cylinder", "worn")
# m, amplitudes of the plot and of the table
AMPLITUDE = 3e-3  # m, of the conicity by which pairs are compared (EN 15302)
AMPLITUDES = 1e-4 * np.arange(5, 81)
TABLE = 1e-3 * np.arange(1, 9)


@dataclass(frozen=True)
class Examined:
    """A profile with its partner: what there is to say of it."""

    source: str | Path
    role: Role
    pair: tuple[str | Path, str | Path]  # wheel, rail
    raw: RawProfile | None  # of a file
    curves: tuple[Profile, Profile]  # wheel, rail
    shape: Shape
    points: ContactPoints
    pressed: Pressures
    notes: dict[str, list[str]]  # of each curve, by role of the profile and "partner"
    lines: list[str]  # of TOML, that read the file so

    @property
    def profile(self) -> Profile:
        """The profile itself."""
        return self.curves[self.role == "rail"]

    @property
    def told(self) -> list[str]:
        """What was assumed of each file, and what is doubtful."""
        other = self.pair[self.role == "wheel"]
        named = ((self.source, self.notes[self.role]), (other, self.notes["partner"]))
        found = [f"{Path(name).name}: {note}" for name, notes in named for note in notes]
        found += [f"doubtful: {text}" for text in self.pressed.doubts]
        line = self.pressed.line()
        return [*found, line] if line else found

    def text(self) -> str:
        """Answer, numbers and the lines of a scene, as the terminal shows them."""
        verdict, keys = answers(self)
        notes = [f" ({key.note})" if key.note else "" for key in keys]
        rows = [f"  {key.name}: {key.value}{note}" for key, note in zip(keys, notes, strict=True)]
        scene = ["", *self.lines] if self.raw is not None else []
        return "\n".join([verdict, *rows, *scene])


def examine(
    source: str | Path,
    *,
    role: Role | None = None,
    partner: str | Path | None = None,
    dimensions: Dimensions | None = None,
    smoothing: float | None = None,
    reading: Reading | None = None,
    load: float = LOAD,
) -> Examined:
    """A profile by built-in name or file, and its contact with a partner.

    role: "wheel" or "rail"; may be left out where name, extension or header tell. partner: the
    other profile; by default UIC60@1:40 for a wheel and S1002 for a rail. smoothing: m, as in
    load_profile, for the files of both. reading: what the profile's file does not say of itself.
    load: N, on the wheel, of the pressures. Raises ProfileError, CaseError.
    """
    role = role or role_of(source)
    raw = read_profile(source, role, reading) if Path(source).is_file() else None
    profile = load_profile(source, role, smoothing=smoothing, reading=reading)
    other = partner or PARTNERS[role]
    pair = (source, other) if role == "wheel" else (other, source)
    points = contact_points(
        *pair, dimensions=dimensions, smoothing=smoothing, readings={role: reading}
    )
    pressed = pressures(*pair, dimensions, load=load, smoothing=smoothing, readings={role: reading})
    beside = load_profile(other, "rail" if role == "wheel" else "wheel", smoothing=smoothing)
    notes = {
        key: pressed.notes.get(Path(name).name, list(curve.notes))
        for key, name, curve in ((role, source, profile), ("partner", other, beside))
    }
    curves = (profile, beside) if role == "wheel" else (beside, profile)
    lines = doctor.scene_lines(source, role, raw)
    return Examined(
        source, role, pair, raw, curves, shape_of(profile), points, pressed, notes, lines
    )


def write_profile_page(found: Examined, output: str | Path) -> Path:
    """Writes the page on a profile, and beside it the contact points as tables
    (``doctor.tables_of``); returns ``output``. Raises OSError."""
    points, pressed = found.points, found.pressed
    body = "".join(
        [
            opening_of(found),
            *(f"<p class=warn>{escape(text)}</p>" for text in pressed.doubts),
            *pair_section(points, found.curves, found.pair),
            *pressure_section(pressed),
            *shape_section(found.shape, found.raw, found.profile),
            *assumed_section(found.raw, found.notes[found.role], found.lines),
        ]
    )
    columns = doctor.table(points, pressed)
    texts = (
        doctor.csv_table(columns),
        doctor.json_table(columns, pressed.load, found.notes, found.lines),
    )
    write_page(output, document(Path(found.source).name, body))
    for path, text in zip(doctor.tables_of(output), texts, strict=True):
        write_whole(path, text.encode())
    return Path(output)


def answers(found: Examined) -> tuple[str, list[Key]]:
    """One sentence, and conicity, pressure and flank of a profile on its partner."""
    points, pressed, shape = found.points, found.pressed, found.shape
    wheel, rail = (Path(name).name for name in found.pair)
    conicity = points.conicity(AMPLITUDE)
    radius, half = points.dimensions.nominal_radius, points.position[points.y.size // 2]
    keys = []
    if np.isfinite(conicity):
        # Klingel's, with the cone of this conicity
        wave = 2 * np.pi * np.sqrt(radius * half / conicity) if conicity > 0 else np.nan
        note = f"waves of {short(wave)} m" if np.isfinite(wave) else "at an amplitude of 3 mm"
        keys.append(Key("equivalent conicity at 3 mm", f"{conicity:.3f}", note))
    middle = int(np.argmin(np.abs(pressed.y)))
    if np.isfinite(pressed.pressure[middle]):
        error = float(pressed.error[middle])
        note = f"± {100 * error:.2g} % by noise" if error > 0 else f"{1e-3 * pressed.load:g} kN"
        value = f"{short(1e-6 * pressed.pressure[middle])} MPa"
        keys.append(Key("greatest pressure in the middle", value, note))
    if np.isfinite(pressed.pressure).any():
        most = int(np.nanargmax(pressed.pressure))
        value = f"{short(1e-6 * pressed.pressure[most])} MPa"
        keys.append(Key("greatest pressure", value, f"at {short(1e3 * pressed.y[most])} mm"))
    # behind the flange's tip, or on the rail's field side, the slope has the other sign
    slope = -shape.slope if found.role == "wheel" else np.abs(shape.slope)
    flank = f"{np.degrees(slope.max()):.1f}°"
    keys.append(Key("steepest flank", flank, f"of the {found.role}"))
    lost = int(np.isnan(points.position).sum())
    keys.append(
        Key(
            "positions without regular contact",
            f"{lost} of {points.y.size}",
            "lateral positions of the wheelset",
            DOUBT if lost else GOOD,
        )
    )
    verdict = f"{wheel} on {rail}: "
    verdict += (
        f"equivalent conicity {conicity:.3f} at 3 mm"
        if np.isfinite(conicity)
        else "no equivalent conicity at 3 mm"
    )
    if pressed.doubts:
        verdict += "; what the file is taken for is doubtful"
    return verdict + ".", keys


def opening_of(found: Examined) -> str:
    """The answers at the head of the page."""
    verdict, keys = answers(found)
    doubtful = bool(found.pressed.doubts) or any(key.state == DOUBT for key in keys)
    name, state = Path(found.source).name, DOUBT if doubtful else GOOD
    return opening(name, f"{found.role} profile", verdict, keys, state)


def assumed_section(raw: RawProfile | None, notes: Sequence[str], lines: list[str]) -> list[str]:
    """What was assumed of a file, and how a scene says it."""
    if raw is None:
        return []
    listed = "".join(f"<li>{escape(note)}</li>" for note in notes)
    text = (
        f"<ul>{listed}</ul><p>A scene that reads it so, whatever rules would find:</p>"
        f"<pre>{escape(chr(10).join(lines))}</pre>"
    )
    return [folded("What was assumed of the file", text)]


def role_of(source: str | Path) -> Role:
    """Whether a profile is a wheel's or a rail's. Raises ProfileError where nothing tells."""
    base = str(source).split("@")[0]
    if base in EITHER:
        raise ProfileError(source, "is a wheel or a rail: give its partner by --rail or --wheel")
    return ROLES[base] if base in ROLES else read_profile(source).role


def shape_section(shape: Shape, raw: RawProfile | None, profile: Profile) -> list[str]:
    """Plots of the profile alone."""
    points = None if raw is None else (raw.y, raw.z)
    parts = [
        "<h2>Shape</h2><p>From the flange or gauge side to the field side; z, slope and curvature "
        f"count downwards. Marked: {shape.steps.size} steps of the curvature by more than "
        f"{CURVATURE_STEP:g} 1/m, as at the joints of arcs, and {shape.corners.size} corners of "
        f"less than {1e3 * CORNER_RADIUS:g} mm radius.</p>",
        plot(figures.shape_figure(shape, points), "shape"),
    ]
    if raw is not None:
        residual = doctor.residuals(raw, profile)
        parts += [
            f"<h2>Points off the curve</h2><p>{raw.y.size} points, "
            f"{1e6 * float(np.sqrt(np.mean(residual**2))):.2g} um root mean square, at most "
            f"{1e6 * float(np.abs(residual).max()):.2g} um.</p>",
            plot(figures.residual_figure(raw.y, residual), "residual"),
        ]
    return parts


def pair_section(
    points: ContactPoints, curves: tuple[Profile, Profile], names: tuple[str | Path, str | Path]
) -> list[str]:
    """Plots of wheel and rail together."""
    wheel, rail = map(str, names)
    sizes = points.dimensions
    conicity = np.array([points.conicity(amplitude) for amplitude in AMPLITUDES])
    lost = int(np.isnan(points.position).sum())
    parts = [
        f"<h2>{escape(wheel)} on {escape(rail)}</h2><p>A wheelset with two such wheels on two such "
        f"rails: gauge {1e3 * sizes.gauge:g} mm, flange backs {1e3 * sizes.flange_back_distance:g} "
        f"mm apart, at {1e3 * sizes.flange_back_position:g} mm on the profile, radius "
        f"{1e3 * sizes.nominal_radius:g} mm. Without load, roll and yaw. Right-hand side shown; "
        "y &gt; 0 is towards its flange.</p>",
    ]
    if lost:
        parts.append(
            f"<p class=warn>No regular contact in {lost} of {points.y.size} positions.</p>"
        )
    return [
        *parts,
        plot(figures.pair_figure(points, *curves), "pair"),
        "<h2>Equivalent conicity</h2><p>tan of the inclination of the cone with the same kinematic "
        "wave length, by integration of the kinematic motion (UIC 519, EN 15302).</p>",
        plot(figures.conicity_figure(AMPLITUDES, conicity), "conicity"),
        conicity_table(points),
        "<h2>Where they touch</h2>",
        plot(figures.contact_figure(points), "contact"),
        "<h2>Rolling radius difference</h2><p>Right wheel minus left wheel.</p>",
        plot(figures.difference_figure(points), "difference"),
    ]


def pressure_section(found: Pressures) -> list[str]:
    """Plot of the greatest pressure, and how far noise leaves it open."""
    line = found.line()
    said = f"<p>{escape(line[0].upper() + line[1:])}: the band.</p>" if line else ""
    return [
        f"<h2>Greatest pressure</h2><p>Steel, {1e-3 * found.load:g} kN on the wheel, without "
        f"friction.</p>{said}",
        plot(figures.pressure_figure(found), "pressure"),
    ]


def conicity_table(points: ContactPoints) -> str:
    """Conicity at whole millimetres."""
    head = "<tr><th class=n>amplitude [mm]</th><th class=n>equivalent conicity [-]</th></tr>"
    rows = []
    for amplitude in TABLE:
        value = points.conicity(amplitude)
        shown = f"{value:.4f}" if np.isfinite(value) else "none"
        rows.append(f"<tr><td class=n>{1e3 * amplitude:g}</td><td class=n>{shown}</td></tr>")
    return f'<div class="scroll"><table>{head}{"".join(rows)}</table></div>'
