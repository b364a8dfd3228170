# ruff: noqa: E501 - lines of a table
"""Mistakes of each kind of user, made as a person would: files and command lines.

``python tests/case/mistakes.py > docs/mistakes.md`` writes the table of what Railpatch says of
each; test_mistakes.py makes all of them and compares.
"""

from __future__ import annotations

import re
import tempfile
from collections.abc import Callable
from contextlib import chdir
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from click.testing import CliRunner
from railpatch.case.kinds import kinds
from railpatch.command.cli import cli
from railpatch.profiles.builtin import builtin_profile

HEAD = (
    "# Mistakes and what is said of them\n\n"
    "What people get wrong, by what they do, with the first line that Railpatch says and the\n"
    "exit code: 2 where the call or a file is wrong, 3 where a contact has no solution, 0 with a\n"
    "warning where it has one that can hardly be meant (2 with `--strict`) and with notes where a\n"
    "file was read by rules. The table is made by\n"
    "`python tests/case/mistakes.py > docs/mistakes.md`; the tests make each mistake again.\n"
)
FOOT = """
## What is right

Cases without a mistake, numbered and seeded (`tests/case/correct.py`), are solved again by the tests: none has a warning.

| kind | cases | of them |
|---|---|---|
| `patch` | 124 | methods, regimes, laws, layers, shapes and pairs of these; loads, radii, creepages and speeds by chance; examples of the documentation |
| `wheel_rail` | 32 | profiles, loads, speeds and positions by chance, on rails and rollers |
| `wheelset` | 131 | the same in balance, in curves, on flats, joints and springs |
| all commands | 7 | the packaged scenes with `--strict`: `tests/case/test_warnings.py` |

## What a machine does wrong

| what ends | what is tried | what is left |
|---|---|---|
| memory | each allocation of `rp_create` in turn, of five handles (some 1,400): `tests/cpp/test_out_of_memory.cpp` | `RP_ERROR_MEMORY`, nothing is lost; steps take none |
| the disk | pages, FMUs, layouts and logs on disks of 0 to 2 MB: `tests/case/test_full_disk.py` | a line with the file's name, code 2; pages and FMUs as they were, logs up to there |
| the process | killed while it computes, writes, before it begins: `tests/log/test_killed.py` | the log up to its last whole chunk, and the library of MCAP reads it |
| a log | cut at any byte, damaged: `tests/log/test_killed.py` | what stands before it, and where it ends |
| a saved state | any byte changed, other scenes, other sizes: `tests/cpp/test_state.cpp` | `RP_ERROR_STATE`, the handle as it was |
| a step | Ctrl-C: `tests/cpp/test_interrupt.cpp` | ended within 0.2 s, the contact goes on as after `reset()` |
"""
RESEARCHER = "researcher: a contact patch"
VEHICLE = "vehicle engineer: wheels, profiles"
PROFILES = "vehicle engineer: own profile files"
RIG = "test engineer: rig and runs"
ANALYST = "analyst: logs and reports"
FMU = "user of an FMU"


@dataclass(frozen=True)
class Mistake:
    """person; what was done; command, words of which {} is the file made; make writes it, in the
    present folder, and returns its name."""

    person: str
    what: str
    command: str
    make: Callable[[], str]


def scene(kind: str, *changes: tuple[str, str]) -> Callable[[], str]:
    """The packaged scene of a kind, with words of it (regular expressions) in another way."""

    def make() -> str:
        text = kinds()[kind].scene.read_text(encoding="utf-8")
        for old, new in changes:
            text, count = re.subn(old, new, text, count=1, flags=re.MULTILINE)
            assert count == 1, f"{kind} has no {old}"
        name = f"{kind}.toml"
        Path(name).write_text(text, encoding="utf-8")
        return name

    return make


def recorded(head: str, *rows: str, yaw: str = 'name = "yaw"', more: str = "") -> Callable[[], str]:
    """The rig's scene with a record in place of its programme. more: columns beside the four."""

    def make() -> str:
        text = kinds()["rig"].scene.read_text(encoding="utf-8")
        keys = f'[rig]\nrecord = "run.csv"\n[rig.columns]\ntime = {{ name = "t" }}\nyaw = {{ {yaw} }}\n'
        keys += 'lateral_position = { name = "y" }\nvertical_load = { name = "load" }\n' + more
        Path("rig.toml").write_text(text[: text.index("[rig]")] + keys, encoding="utf-8")
        Path("run.csv").write_text("\n".join([head, *rows]), encoding="utf-8")
        return "rig.toml"

    return make


RECORD = "t [s],yaw [mrad],y [mm],load [kN]", "0,0,0.3,134", "1,2,0.6,134"


def patch(*changes: tuple[str, str], more: str = "") -> Callable[[], str]:
    """The patch scene changed; more: lines at its end."""
    return scene("patch", *changes, *([(r"\Z", "\n" + more)] if more else []))


def wheel(*changes: tuple[str, str]) -> Callable[[], str]:
    return scene("wheel_rail", *changes)


def loaded(*changes: tuple[str, str]) -> Callable[[], str]:
    """A wheelset that carries its load."""
    return scene("wheelset", (r"^z = 2.343e-4 .*$", "vertical_force = 120e3"), *changes)


def file(name: str, content: bytes | str) -> Callable[[], str]:
    def make() -> str:
        data = content.encode() if isinstance(content, str) else content
        Path(name).write_bytes(data)
        return name

    return make


def points(name: str = "S1002") -> tuple[np.ndarray, np.ndarray]:
    """Of a profile of the package, mm."""
    profile = builtin_profile(name, "wheel" if name == "S1002" else "rail")
    return 1e3 * np.asarray(profile.y), 1e3 * np.asarray(profile.z)


def profile(
    name: str,
    change: Callable[[np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]],
    of: str = "S1002",
    digits: int = 6,
    numbered: bool = False,
) -> Callable[[], str]:
    """A file of columns in mm, changed."""

    def make() -> str:
        y, z = change(*points(of))
        text = "".join(
            f"{i} " * numbered + f"{a:.{digits}f} {b:.{digits}f}\n"
            for i, (a, b) in enumerate(zip(y, z, strict=True))
        )
        return file(name, text)()

    return make


WATER = '[fluid]\nmodel = "film"\nroughness = 1e-6\nliquid = "water"\n'
NUMBER = r"[-+0-9.eE]+"
# a grid that does not change with the load
FIXED = (r"elements = \[.*\]", "element_size = [5e-4, 5e-4]\nmax_elements = [64, 64]")
MISTAKES: tuple[Mistake, ...] = (
    # --- a contact patch --------------------------------------------------------------------------
    *(
        Mistake(RESEARCHER, what, "solve {}", make)
        for what, make in (
            ("water of 150 degrees C", patch(more=WATER + "temperature = 150.0\n")),
            ("water between bodies of 150 degrees C",
             patch(more=WATER + "[temperature]\nwheel = 150.0\nrail = 150.0\n")),
            ("an oil's Eyring stress for water", patch(more=WATER + "eyring_stress = 5e6\n")),
            ("a film of oil beside a rate of water",
             patch(more=WATER + "water_rate = 1e-8\noil_film = 1e-6\n")),
            ("a hardness for wear by work", patch(more="[damage]\nhardness = 3.2e9\n")),
            ("shear modulus in GPa", patch(more="[material]\nshear_modulus = 82.0\n")),
            ("shear modulus in MPa", patch(more="[material]\nshear_modulus = 82e3\n")),
            ("Young's modulus in place of Poisson's ratio",
             patch(more="[material]\npoisson_ratio = 210e9\n")),
            ("Poisson's ratio in per cent", patch(more="[material]\npoisson_ratio = 28.0\n")),
            ("load in kN", patch((f"normal_force = {NUMBER}", "normal_force = 80.0"))),
            ("a vehicle's load on one contact",
             patch((f"normal_force = {NUMBER}", "normal_force = 6e5"))),
            ("load of the other sign", patch((f"normal_force = {NUMBER}", "normal_force = -8e4"))),
            ("semi-axes in mm",
             patch((r"curvatures = .*", "semi_axes = [6.0, 6.0]"))),
            ("radii in place of curvatures",
             patch((r"curvatures = .*", "curvatures = [0.002, 0.003]"))),
            ("radii in mm in place of curvatures",
             patch((r"curvatures = .*", "curvatures = [460.0, 300.0]"))),
            ("creepage in per cent", patch((r"creepage = \[.*\]", "creepage = [0.2, 0.0]"))),
            ("creepage in per mille", patch((r"creepage = \[.*\]", "creepage = [1.0, 0.0]"))),
            ("spin per mm in place of per m times a million",
             patch((f"spin_creepage = {NUMBER}", "spin_creepage = 200.0"))),
            ("friction in per cent", patch((f"coefficient = {NUMBER}", "coefficient = 30.0"))),
            ("no friction coefficient", patch((f"coefficient = {NUMBER}", ""))),
            ("a misspelt table", patch((r"\[friction\]", "[frictoin]"))),
            ("a misspelt key", patch(("normal_force", "normal_load"))),
            ("a key in the wrong table",
             patch((r"\[load\]", "[load]\ncreepage = [1e-3, 0.0]"))),
            ("one number for two", patch((r"elements = \[.*\]", "elements = 24"))),
            ("text for a number",
             patch((f"coefficient = {NUMBER}", 'coefficient = "0.3"'))),
            ("a decimal comma", patch((f"coefficient = {NUMBER}", "coefficient = 0,3"))),
            ("a shift in mm",
             patch((r"steady_rolling", "shift"), (r"creepage = \[.*\]", "creepage = [0.02, 0.0]"),
                   (r"^spin_creepage.*$", ""), (r"^rolling_speed.*$", ""), FIXED)),
            ("a rolled distance in mm",
             patch((r"steady_rolling\"", "transient_rolling\"\ndistance = 0.5"), FIXED)),
            ("a grid of 6 x 6", patch((r"elements = \[.*\]", "elements = [6, 6]"))),
            ("a grid of 4000 x 4000", patch((r"elements = \[.*\]", "elements = [4000, 4000]"))),
            ("an element in mm",
             patch((r"elements = \[.*\]", "element_size = [0.5, 0.5]"))),
            ("a layer's thickness in mm",
             patch(more="[layer]\nshear_modulus = 8.2e9\nthickness = 0.05\n")),
            ("a layer's modulus in GPa",
             patch(more="[layer]\nshear_modulus = 8.2\nthickness = 5e-5\n")),
            ("a layer's yield stress in MPa",
             patch(more="[layer]\nshear_modulus = 8.2e9\nthickness = 2e-5\nyield_stress = 50.0\n")),
            ("a wheel's temperature in K",
             patch(more="[temperature]\nwheel = 293.0\nrail = 293.0\n")),
            ("a supply of water in l/s", patch(more=WATER + "water_rate = 0.025\n")),
            ("a halving speed in mm/s",
             patch((f"coefficient = {NUMBER}", 'law = "slip_velocity"\nkinetic = 0.1\n'
                    "amplitude = 0.2\nhalving_speed = 400.0"))),
            ("a memory of friction in mm",
             patch((f"coefficient = {NUMBER}", 'law = "slip_velocity"\nkinetic = 0.1\n'
                    "amplitude = 0.2\nhalving_speed = 0.4\nmemory_distance = 0.1"))),
            ("a depth in mm", patch(more="[subsurface]\ndepths = [1.0]\n")),
            ("a shear yield stress in MPa", patch(more="[damage]\nshear_yield = 300.0\n")),
            ("a hardness of Brinell's scale",
             patch(more='[damage]\nwear = "archard"\nhardness = 300.0\n')),
            ("a method in capitals", patch(more='[method]\ntangential = "FASTSIM"\n')),
            ("a theory beyond its range",
             patch((r"creepage = \[.*\]", "creepage = [0.05, 0.0]"),
                   more='[method]\ntangential = "linear"\n')),
            ("a method that needs a smooth ellipse on a grid of distances",
             patch((r"curvatures = .*", "undeformed_distance = [[0.0, 0.0], [0.0, 0.0]]"),
                   more='[method]\nnormal = "hertz"\n')),
            ("accuracy in per cent",
             patch((r"\[grid\]\nelements = .*", ""), more="[method]\naccuracy = 1.0\n")),
            ("a friction law without its numbers",
             patch((f"coefficient = {NUMBER}", 'law = "slip_velocity"'))),
            ("nan", patch((f"normal_force = {NUMBER}", "normal_force = nan"))),
            ("no kind", patch((r"^kind = .*", ""))),
            ("a kind that is none", patch((r"^kind = .*", 'kind = "wheelrail"'))),
            ("an empty file", file("empty.toml", "")),
            ("JSON in a .toml", file("case.toml", '{"kind": "patch"}')),
            ("a picture", file("case.toml", bytes(range(256)))),
            ("a file that is not there", lambda: "absent.toml"),
        )
    ),
    # --- wheels -----------------------------------------------------------------------------------
    *(
        Mistake(VEHICLE, what, "solve {}", make)
        for what, make in (
            ("load in kN", loaded(("120e3", "120.0"))),
            ("load in t", loaded(("120e3", "12.0"))),
            ("radius in mm", loaded((f"nominal_radius = {NUMBER}", "nominal_radius = 460.0"))),
            ("radius in dm", loaded((f"nominal_radius = {NUMBER}", "nominal_radius = 4.6"))),
            ("gauge in mm", loaded((f"gauge = {NUMBER}", "gauge = 1435.0"))),
            ("gauge of rail centres", loaded((f"gauge = {NUMBER}", "gauge = 1.5"))),
            ("flange back distance in mm",
             loaded((f"flange_back_distance = {NUMBER}", "flange_back_distance = 1360.0"))),
            ("no sign of flange_back_position",
             loaded((r"flange_back_position = -0.070", "flange_back_position = 0.070"))),
            ("y in mm", loaded((r"^\[wheelset\]", "[wheelset]\ny = 3.0"))),
            ("y without roll", loaded((r"^\[wheelset\]", "[wheelset]\ny = 3e-3"))),
            ("yaw in degrees", loaded((r"^\[wheelset\]", "[wheelset]\nyaw = 0.5"))),
            ("speed in mm/s",
             loaded((f"^speed = {NUMBER}", "speed = 2e4"), (f"^pitch_rate = {NUMBER}", "pitch_rate = -43478.3"))),
            ("speed in km/h", loaded((f"^speed = {NUMBER}", "speed = 72.0"))),
            ("a pitch rate of the other sign",
             loaded((f"pitch_rate = {NUMBER}", "pitch_rate = 43.478"))),
            ("a locked wheel", loaded((f"pitch_rate = {NUMBER}", "pitch_rate = 0.0"))),
            ("z in mm", wheel((r"^z = 2.343e-4", "z = 0.2"))),
            ("an inclination of 40 for 1:40", wheel((r"UIC60@1:40", "UIC60@40"))),
            ("a profile that is not there", wheel((r'"S1002"', '"s1003"'))),
            ("wheel and rail exchanged",
             wheel((r'wheel = "S1002"', 'wheel = "UIC60@1:40"'),
                   (r'rail = "UIC60@1:40"', 'rail = "S1002"'))),
            ("a rail's origin in mm",
             wheel((r"\Z", "\n[track.right]\norigin = [717.5, 0.0]\n"))),
            ("a scene of a vehicle", scene("vehicle")),
        )
    ),
    Mistake(VEHICLE, "the scene of a wheelset to a vehicle", "vehicle {}", scene("wheelset")),
    Mistake(VEHICLE, "the scene of a patch to a run", "wheelset {} -o a.mcap", scene("patch")),
    Mistake(VEHICLE, "lubrication on the grid of a wheel", "solve {}",
            wheel((r"\Z", "\n" + WATER.replace("film", "ehl", 1)))),
    Mistake(VEHICLE, "a car body in t", "vehicle {} --duration 0.01 --method fastsim",
            scene("vehicle", (r"^mass = .*$", "mass = 32.0"))),
    # --- profile files ----------------------------------------------------------------------------
    *(
        Mistake(PROFILES, what, f"profile {{}} --role {role} -o page.html", make)
        for what, role, make in (
            ("points in inches", "wheel", profile("w.dat", lambda y, z: (y / 25.4, z / 25.4))),
            ("upside down", "wheel", profile("w.dat", lambda y, z: (y, -z))),
            ("columns exchanged", "wheel", profile("w.dat", lambda y, z: (z, y))),
            ("the tread alone", "wheel",
             profile("w.dat", lambda y, z: (y[abs(y) < 25], z[abs(y) < 25]))),
            ("a point twice, and back", "wheel",
             profile("w.dat", lambda y, z: (np.insert(y, 99, y[120]), np.insert(z, 99, z[120])))),
            ("an inclined rail of unknown side", "rail",
             profile("r.dat", lambda y, z: (y - z * 0.05, z + y * 0.05), "UIC60")),
            ("an origin 100 mm away", "wheel", profile("w.dat", lambda y, z: (y + 100, z))),
            ("three points", "wheel", profile("w.dat", lambda y, z: (y[::300], z[::300]))),
            ("a point every 5 mm", "wheel", profile("w.dat", lambda y, z: (y[::25], z[::25]))),
            ("an empty file", "wheel", file("w.dat", "")),
            ("text", "wheel", file("w.dat", "wheel of car 12\nleft\n")),
            ("points rounded to 0.1 mm", "wheel",
             profile("w.dat", lambda y, z: (y, z), digits=1)),
            ("an index before the columns", "wheel",
             profile("w.dat", lambda y, z: (y, z), numbered=True)),
            ("a spreadsheet", "wheel", file("w.xlsx", b"PK\x03\x04" + bytes(200))),
        )
    ),
    Mistake(PROFILES, "a rail named as a wheel", "solve {}",
            lambda: (profile("wheel.whl", lambda y, z: (y, z), "UIC60")(),
                     wheel((r'"S1002"', '"wheel.whl"'))())[1]),
    *(
        Mistake(PROFILES, what, "solve {}",
                lambda change=change, digits=digits: (
                    profile("w.dat", change, digits=digits)(),
                    loaded((r'"S1002"', '"w.dat"'))())[1])
        for what, change, digits in (
            ("points rounded to 10 um", lambda y, z: (y, z), 2),
            ("an origin 4 mm aside", lambda y, z: (y + 4, z), 6),
            ("an origin 6 mm too high", lambda y, z: (y, z + 6), 6),
            ("points with 5 um of noise",
             lambda y, z: (y, z + 5e-3 * np.random.default_rng(1).standard_normal(y.size)), 6),
        )
    ),
    Mistake(PROFILES, "a rail cut off above the gauge's height", "solve {}",
            lambda: (profile("r.dat", lambda y, z: (y[z < 8], z[z < 8]), "UIC60")(),
                     wheel((r'rail = .*', 'rail = "r.dat"'))())[1]),
    # --- rig --------------------------------------------------------------------------------------
    Mistake(RIG, "yaw in degrees", "rig {} --positions 2 -o a.mcap",
            scene("rig", (r"^yaw = .*$", "yaw = [[0.0, 0.0], [1.0, 1.0]]"))),
    Mistake(RIG, "load in kN", "rig {} --positions 2 -o a.mcap",
            scene("rig", (r"^vertical_force = \S+", "vertical_force = 133.95"))),
    Mistake(RIG, "the scene of a vehicle", "rig {} -o a.mcap", scene("vehicle")),
    Mistake(RIG, "a folder that is not there", "rig {} --positions 2 -o no/such/a.mcap",
            scene("rig")),
    Mistake(RIG, "a record's yaw in mrad, called rad", "rig {} -o a.mcap",
            recorded(*RECORD, yaw='name = "yaw", unit = "rad"')),
    Mistake(RIG, "a record's load in lbf, called N", "rig {} -o a.mcap",
            recorded(RECORD[0].replace("kN", "N"), "0,0,0.3,30120", "1,2,0.6,30120")),
    Mistake(RIG, "a record's speed in km/h, called m/s", "rig {} -o a.mcap",
            recorded(RECORD[0] + ",v [m/s]", *(row + ",16" for row in RECORD[1:]),
                     more='speed = { name = "v" }\n')),
    Mistake(RIG, "a record's L/V in parts, called %", "rig {} -o a.mcap",
            recorded(RECORD[0] + ",L/V [%]", *(row + ",0.4" for row in RECORD[1:]),
                     more='left_ratio = { name = "L/V" }\n')),
    Mistake(RIG, "a record's column by another name", "rig {} -o a.mcap",
            recorded(*RECORD, yaw='name = "jaw"')),
    Mistake(RIG, "a record whose clock falls", "rig {} -o a.mcap",
            recorded(*RECORD, "0.5,3,0.7,134")),
    Mistake(RIG, "no number of positions", "rig {} --positions 0 -o a.mcap", scene("rig")),
    # --- logs -------------------------------------------------------------------------------------
    Mistake(ANALYST, "a table of an ending that is none", "export {} -o a.txt", file("run.mcap", b"")),
    Mistake(ANALYST, "a report of a table", "report {} -o a.html", file("run.csv", "t,y\n0,1\n")),
    Mistake(ANALYST, "a log that is cut off", "report {} -o a.html",
            file("run.mcap", b"\x89MCAP0\r\n" + bytes(40))),
    Mistake(ANALYST, "a log that is not there", "report {} -o a.html", lambda: "absent.mcap"),
    Mistake(ANALYST, "a report as a text document", "report {} -o a.docx",
            file("run.mcap", b"\x89MCAP0\r\n" + bytes(40))),
    # --- FMU --------------------------------------------------------------------------------------
    Mistake(PROFILES, "a wheel's file without its role", "profile {} -o page.html",
            profile("w.dat", lambda y, z: (y, z))),
    Mistake(FMU, "a name that no scene has", "fmu --scene {} -o a.fmu", lambda: "wheelsets"),
    Mistake(FMU, "a scene that is not there", "fmu {} -o a.fmu", lambda: "absent.toml"),
    Mistake(FMU, "a folder as output", "fmu {} -o .", scene("patch")),
    Mistake(FMU, "shear modulus in GPa", "fmu {} -o a.fmu",
            patch(more="[material]\nshear_modulus = 82.0\n")),
    Mistake(FMU, "the scene of a vehicle", "fmu {} -o a.fmu", scene("vehicle")),
)  # fmt: skip


@dataclass(frozen=True)
class Answer:
    """Exit code, and the first line said or all notes."""

    code: int
    said: str


def answer(mistake: Mistake) -> Answer:
    """Makes the mistake in a folder of its own."""
    with tempfile.TemporaryDirectory() as folder, chdir(folder):
        name = mistake.make()
        words = mistake.command.replace("{}", name).split()
        ran = CliRunner().invoke(cli, words)
    if ran.exception is not None and not isinstance(ran.exception, SystemExit):
        raise ran.exception
    lines = [" ".join(line.split()).replace(folder, "...") for line in ran.stderr.splitlines()]
    told = [line for line in lines if re.match(r"(Error|warning|status):", line)]
    notes = "; ".join(line for line in lines if line.startswith("note:"))
    unmet = "no contact" if "no_contact" in ran.stdout else ""
    return Answer(ran.exit_code, told[0] if told else notes or unmet)


def section(person: str) -> list[str]:
    """Lines of docs/mistakes.md on one person."""
    lines = [f"## {person[0].upper()}{person[1:]}", ""]
    lines += ["| what was done | code | what is said |", "|---|---|---|"]
    for mistake in MISTAKES:
        if mistake.person == person:
            found = answer(mistake)
            said = found.said.replace("|", "\\|")
            lines.append(f"| {mistake.what} | {found.code} | {said} |")
    return lines


PERSONS = list(dict.fromkeys(mistake.person for mistake in MISTAKES))


if __name__ == "__main__":
    print(HEAD)
    print("\n\n".join("\n".join(section(person)) for person in PERSONS))
    print(FOOT, end="")
