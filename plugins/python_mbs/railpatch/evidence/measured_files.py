"""Profile files as if they were measured, with noise, in several formats, flipped, swapped and cut,
against the shapes that they were made of: what is said of the greatest pressure, and what is true.

``python -m railpatch.evidence.measured_files`` prints the tables of docs/profiles.md, in a minute.

S1002 on UIC60 at 1:40, both from files of one kind, a wheel of 0.46 m radius under 80 kN at
POSITIONS, with 0.3 friction; files that ask for a key get it.
"""

from __future__ import annotations

import tempfile
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from railpatch.contact import Contact
from railpatch.errors import CaseError, ProfileError
from railpatch.pressure_error import LIMIT
from railpatch.profiles import load_profile
from railpatch.profiles.curve import Profile

Array = NDArray[np.float64]
Format = Literal["semicolons", "blanks", "miniprof", "simpack"]
Change = Literal["none", "flipped", "mirrored", "swapped", "cut"]
NAMES = {"wheel": "S1002", "rail": "UIC60@1:40"}
POSITIONS = (-4.5e-3, -3e-3, -1.5e-3, 0.0, 1.5e-3, 3e-3, 4.5e-3, 6e-3)
NORMALS = ("half_space", "hertz", "kik_piotrowski", "analyn")
LOAD = 80e3
# of a force over the load, what counts as an error
FORCE_LIMIT = 0.01
SUFFIX: dict[tuple[Format, str], str] = {
    ("semicolons", "wheel"): ".csv", ("semicolons", "rail"): ".csv",
    ("blanks", "wheel"): ".dat", ("blanks", "rail"): ".dat",
    ("miniprof", "wheel"): ".whl", ("miniprof", "rail"): ".ban",
    ("simpack", "wheel"): ".prw", ("simpack", "rail"): ".prr",
}  # fmt: skip


@dataclass(frozen=True)
class File:
    """noise: m, standard deviation across. spacing: m. form, change: of both files of a pair."""

    noise: float
    spacing: float
    form: Format
    change: Change
    seed: int = 0

    def __str__(self) -> str:
        return f"{1e6 * self.noise:g} | {1e3 * self.spacing:g} | {self.form} | {self.change}"


FILES = (
    File(1e-6, 0.05e-3, "semicolons", "none"),
    File(1e-6, 0.1e-3, "miniprof", "none"),
    File(1e-6, 0.2e-3, "simpack", "flipped"),
    File(1e-6, 0.5e-3, "blanks", "cut"),
    File(2e-6, 0.05e-3, "miniprof", "mirrored"),
    File(2e-6, 0.1e-3, "blanks", "swapped"),
    File(2e-6, 0.2e-3, "semicolons", "cut"),
    File(2e-6, 0.5e-3, "simpack", "none"),
    File(3e-6, 0.05e-3, "blanks", "flipped"),
    File(3e-6, 0.1e-3, "simpack", "cut"),
    File(3e-6, 0.2e-3, "miniprof", "cut"),
    File(5e-6, 0.05e-3, "simpack", "mirrored"),
    File(5e-6, 0.1e-3, "semicolons", "flipped"),
    File(5e-6, 0.2e-3, "blanks", "none"),
    File(5e-6, 0.5e-3, "miniprof", "none"),
    File(10e-6, 0.05e-3, "semicolons", "swapped"),
    File(10e-6, 0.1e-3, "miniprof", "mirrored"),
    File(10e-6, 0.2e-3, "blanks", "cut"),
    File(20e-6, 0.05e-3, "simpack", "none"),
    File(20e-6, 0.2e-3, "semicolons", "flipped"),
)


@dataclass(frozen=True)
class Found:
    """What came of one pair of files.

    asked: the refusal that a key answered, or none. refused: why there is nothing. pressure, said:
    -, [n], by position: error of the greatest pressure over the true one, and what 95 % of the
    errors stay below. force: -, [n], error of the wheel's force over the load.
    """

    file: File
    asked: str
    refused: str
    pressure: Array
    said: Array
    force: Array

    @property
    def warned(self) -> NDArray[np.bool_]:
        """[n], whether a warning says that the pressure is not known to LIMIT."""
        return ~(self.said <= LIMIT)


def text_of(file: File, role: str, profile: Profile) -> str:
    """The content of a file."""
    number = FILES.index(file) if file in FILES else len(FILES)
    rng = np.random.default_rng([number, file.seed, list(NAMES).index(role)])
    s = np.arange(profile.arc_length[0], profile.arc_length[-1], file.spacing)
    y, z = profile.evaluate(s)
    ahead = np.array(profile.evaluate(s + 1e-6)) - (y, z)
    tangent = ahead / np.hypot(*ahead)
    off = file.noise * rng.standard_normal(s.size)
    y, z = y - off * tangent[1], z + off * tangent[0]
    if file.change == "cut":
        # the end of the field side, and the back of a flange or the foot of the gauge face
        keep = (y < 0.045) & (s > 0.02) if role == "wheel" else (y < 0.025) & (z < 0.02)
        y, z = y[keep], z[keep]
    if file.form in ("miniprof", "blanks"):
        z = -z  # heights
    if file.change == "flipped":
        z = -z
    if file.change == "mirrored":
        y = -y
    return written(file.form, role, *((z, y) if file.change == "swapped" else (y, z)))


def written(form: Format, role: str, y: Array, z: Array) -> str:
    """Two columns, m, in a format."""
    if form == "blanks":
        return "".join(f"{a:.9f} {b:.9f}\n" for a, b in zip(y, z, strict=True))
    rows = zip(1e3 * y, 1e3 * z, strict=True)
    if form == "semicolons":
        return "y;z\n" + "".join(f"{a:.5f};{b:.5f}\n" for a, b in rows)
    if form == "miniprof":
        head = f"ProgramName=MiniProf\nColumnDef=X,Y\nXYPoints={y.size}\n\n"
        return head + "".join(f"{a:10.5f}{b:10.5f}\n" for a, b in rows)
    kind = 1 if role == "wheel" else 0
    body = "".join(f"    {a:.6f} {b:.6f}\n" for a, b in rows)
    return (
        f"header.begin\n  version = 1\n  type = {kind}\nheader.end\nspline.begin\n"
        f"  units.len.f = 1000\n  point.begin\n{body}  point.end\nspline.end\n"
    )


def case_of(profiles: dict[str, Any], normal: str) -> dict[str, Any]:
    """The wheel of this module's head."""
    return {
        "kind": "wheel_rail",
        "grid": {"elements": [20, 24]},
        "method": {"normal": normal, "tangential": "fastsim"},
        "friction": {"coefficient": 0.3},
        "wheelset": {
            "vertical_force": LOAD, "speed": 20.0, "pitch_rate": -20.0 / 0.46,
            "nominal_radius": 0.46, "flange_back_distance": 1.36, "flange_back_position": -0.07,
        },
        "track": {"gauge": 1.435, "gauge_height": 0.014},
        "profiles": profiles,
    }  # fmt: skip


def pressures_and_forces(contact: Contact, positions: Iterable[float]) -> tuple[Array, Array]:
    """Pa, [n], and N, [n, 3]; NaN where nothing is found."""
    pressure, force = [], []
    for y in positions:
        result = contact.step(y=y)
        patches = result["patches"] if result.solved else []
        pressure.append(max((p["max_pressure"] for p in patches), default=np.nan))
        force.append(result["force"])
    return np.array(pressure), np.array(force)


def tried(
    file: File, normal: str = "half_space", positions: tuple[float, ...] = POSITIONS
) -> Found:
    """One pair of files, read and solved."""
    true = pressures_and_forces(Contact(case_of(dict(NAMES), normal)), positions)
    with tempfile.TemporaryDirectory() as folder:
        profiles: dict[str, Any] = {}
        for role, name in NAMES.items():
            path = Path(folder) / f"{role}{SUFFIX[file.form, role]}"
            path.write_text(text_of(file, role, load_profile(name, role)), encoding="utf-8")  # type: ignore[arg-type]
            profiles[role] = path.name
        asked, contact = "", None
        keys: dict[str, Any] = {}
        for _ in range(3):
            try:
                contact = Contact(case_of({**profiles, **keys}, normal), folder=folder)
                break
            except (CaseError, ProfileError) as error:
                said = str(error)
                answers = answered(said, file)
                if keys.items() >= answers.items():
                    none = np.full(len(positions), np.nan)
                    return Found(file, asked, said.split(": ", 1)[-1], none, none, none)
                keys |= answers
                asked = said.split(": ", 1)[-1]
        assert contact is not None
        pressure, force, said_errors = [], [], []
        for y in positions:
            one, two = pressures_and_forces(contact, [y])
            pressure.append(one[0])
            force.append(two[0])
            said_errors.append(contact.pressure_error().get("right", np.nan))
    return Found(
        file,
        asked,
        "",
        np.array(pressure) / true[0] - 1.0,
        np.array(said_errors),
        np.linalg.norm(np.array(force) - true[1], axis=1) / LOAD,
    )


def answered(said: str, file: File) -> dict[str, Any]:
    """The keys of [profiles] that a refusal asks for, of the file at whose name it begins."""
    role = "rail" if "rail." in said.split(":")[0] else "wheel"
    up = (file.form in ("miniprof", "blanks")) != (file.change == "flipped")
    mirror = ("y" if file.change == "mirrored" else "") + ("z" if up else "")
    if "mirror" in said:
        return {f"{role}_file": {"mirror": mirror or "none"}}
    if "swap" in said:
        return {f"{body}_file": {"swap": True} for body in NAMES}
    return {}


def rows(found: Iterable[Found]) -> Iterator[str]:
    """Of the table of all files."""
    yield (
        "| noise, um | points every, mm | format | change | greatest error of the pressure, % | "
        "said there, % | positions warned of | greatest error of the force, % |"
    )
    yield "|---|---|---|---|---|---|---|---|"
    for one in found:
        if one.refused:
            yield f"| {one.file} | refused: {one.refused.split(':')[0]} | | | |"
            continue
        worst = int(np.argmax(np.abs(one.pressure)))
        note = f"; asks: {one.asked.split(':')[0]}" if one.asked else ""
        yield (
            f"| {one.file}{note} | {100 * one.pressure[worst]:.1f} | {100 * one.said[worst]:.1f} | "
            f"{int(one.warned.sum())} of {one.said.size} | {100 * one.force.max():.2f} |"
        )


def counted(found: list[Found]) -> dict[str, float]:
    """Over all files that are read and all positions: their number, the share of errors below what
    is said, and how many are beyond LIMIT, or forces beyond FORCE_LIMIT, in silence."""
    error = np.concatenate([np.abs(one.pressure) for one in found if not one.refused])
    said = np.concatenate([one.said for one in found if not one.refused])
    force = np.concatenate([one.force for one in found if not one.refused])
    return {
        "positions": error.size,
        "below": float(np.mean(error <= said)),
        "beyond": int(np.sum(error > LIMIT)),
        "silent": int(np.sum((error > LIMIT) & (said <= LIMIT))),
        "force": int(np.sum((force > FORCE_LIMIT) & (said <= LIMIT))),
        "rms": float(np.sqrt(np.mean(error * error))),
        "said": float(np.sqrt(np.mean(said * said))),
    }


def main() -> None:
    """Prints the tables."""
    found = [tried(file) for file in FILES]
    print("\n".join(rows(found)))
    print(
        "\n| normal | positions | errors below what is said, % | errors above 5 % | "
        "of these without a warning | forces off by 1 % without one | errors, root mean square, % "
        "| half of what is said, likewise, % |"
    )
    print("|---|---|---|---|---|---|---|---|")
    for normal in NORMALS:
        result = counted(found if normal == NORMALS[0] else [tried(f, normal) for f in FILES])
        print(
            f"| {normal} | {result['positions']:.0f} | {100 * result['below']:.1f} | "
            f"{result['beyond']:.0f} | {result['silent']:.0f} | {result['force']:.0f} | "
            f"{100 * result['rms']:.1f} | {50 * result['said']:.1f} |"
        )


if __name__ == "__main__":
    main()
