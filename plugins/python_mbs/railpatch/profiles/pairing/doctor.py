"""What a profile's file was taken for, how far its points lie off the curve, tables of the pair.

Everything that the page on a profile says besides its figures.
"""

from __future__ import annotations

import csv
import io
import json
from dataclasses import asdict
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from railpatch.profiles.curve import Profile
from railpatch.profiles.pairing.contact_points import ContactPoints
from railpatch.profiles.pairing.pressures import Pressures
from railpatch.profiles.raw import RawProfile, Role

Array = NDArray[np.float64]
# of the table: name, unit
COLUMNS = (
    ("y", "m"),
    ("position", "m"),
    ("on_wheel", "m"),
    ("contact_angle", "rad"),
    ("rolling_radius", "m"),
    ("rolling_radius_difference", "m"),
    ("conicity", "-"),
    ("touches", "-"),
    ("max_pressure", "Pa"),
    ("max_pressure_error", "-"),
)


def tables_of(output: str | Path) -> tuple[Path, Path]:
    """The files beside the page: NAME.contact.csv and NAME.contact.json."""
    return Path(output).with_suffix(".contact.csv"), Path(output).with_suffix(".contact.json")


def scene_lines(source: str | Path, role: Role, raw: RawProfile | None) -> list[str]:
    """Lines of TOML that read the file as it was read now, whatever later rules may find."""
    lines = ["[profiles]", f"{role} = {json.dumps(str(source))}"]
    if raw is not None:
        given = [
            f"{key} = {json.dumps(list(value) if isinstance(value, tuple) else value)}"
            for key, value in asdict(raw.taken).items()
            if value is not None
        ]
        lines.append(f"{role}_file = {{ {', '.join(given)} }}")
    return lines


def residuals(raw: RawProfile, profile: Profile) -> Array:
    """m, [n], how far each point of the file lies below the curve: across the nearest knot's
    tangent, with its curvature."""
    from scipy.spatial import KDTree

    knots = np.column_stack([profile.y, profile.z])
    _, nearest = KDTree(knots).query(np.column_stack([raw.y, raw.z]))
    dy, dz = profile.dy[nearest], profile.dz[nearest]
    off_y, off_z = raw.y - profile.y[nearest], raw.z - profile.z[nearest]
    bend = np.gradient(profile.dz, profile.arc_length) * profile.dy
    bend -= np.gradient(profile.dy, profile.arc_length) * profile.dz
    along = off_y * dy + off_z * dz
    return off_z * dy - off_y * dz - 0.5 * bend[nearest] * along * along


def table(points: ContactPoints, found: Pressures) -> dict[str, Array]:
    """Columns of COLUMNS, [n] by lateral position; conicity for the amplitude |y|, NaN at 0;
    pressures where they were solved, NaN elsewhere."""
    conicity = np.array([points.conicity(abs(y)) if y else np.nan for y in points.y.tolist()])
    pressure, error = found.at(points.y)
    made = {"conicity": conicity, "max_pressure": pressure, "max_pressure_error": error}
    return {
        name: made[name] if name in made else np.asarray(getattr(points, name), dtype=float)
        for name, _ in COLUMNS
    }


def csv_table(columns: dict[str, Array]) -> str:
    """With a head of names and units; what there is not is empty."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow([f"{name} [{unit}]" for name, unit in COLUMNS])
    for row in zip(*columns.values(), strict=True):
        writer.writerow(["" if np.isnan(value) else f"{value:.9g}" for value in row])
    return text.getvalue()


def json_table(
    columns: dict[str, Array], load: float, notes: dict[str, list[str]], lines: list[str]
) -> str:
    """The same with units, what was assumed of each profile, and the lines of a scene. load: N, of
    the pressures."""
    values = {
        name: {"unit": unit, "values": [None if np.isnan(v) else v for v in columns[name].tolist()]}
        for name, unit in COLUMNS
    }
    return (
        json.dumps({"notes": notes, "toml": lines, "load": load, "contact_points": values}) + "\n"
    )
