"""The wheels in many environments: python environments.py WHEELS FOLDER [NAME...]

Runs smoke.py in each environment below that this machine can make, or in those named, and writes
FOLDER/environments.md and .json. Where an environment needs what is not here, the table says what;
one that was named fails then. Ends with 1 where one failed. Environments are:

- Pythons of this machine: on the PATH, or of pyenv;
- pythonX.Y-alone: a CPython from Maven's registry (pythons.py), for one that is not here;
- Debian's suites, the smallest system that debootstrap makes, without a compiler: needs root;
- wine-X.Y: a CPython for Windows from Maven's registry: needs Wine.

pip fetches dependencies from its index, except in "offline", which takes all from a folder.
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
import subprocess
import sys
import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path

from pythons import PYTHONS, Python, interpreter

HERE = Path(__file__).resolve().parent
MIRROR = "http://deb.debian.org/debian"
CERTIFICATES = Path("/etc/ssl/certs/ca-certificates.crt")
# what a debootstrapped system has beside the smallest
PACKAGES = "python3,python3-venv,ca-certificates"
COMPILERS = ("cc", "gcc", "c++", "g++", "clang", "cmake")
# Wine 8 (Debian 12) lacks what newer ones call: complex functions of ucrtbase, bcryptprimitives.dll
WINE_8 = ("numpy==1.26.4", "pydantic<2.7")
LONGEST = 1800.0  # s, of one environment


class Missing(Exception):
    """What this machine would need for an environment."""


@dataclass
class Place:
    """Where smoke.py is run: its words before the arguments, and paths as seen from there."""

    python: list[str | Path]
    folder: Path  # for what is made, as this program sees it
    inside: str | None = None  # the same, as seen there
    wheels: str | None = None
    smoke: str | None = None
    environment: dict[str, str] = field(default_factory=dict)
    more: tuple[str, ...] = ()


@dataclass(frozen=True)
class Environment:
    """One row of the table."""

    name: str
    text: str
    make: Callable[[Path, Path], Place]  # of the wheels and a folder


def of_pythons(minor: str, system: str) -> Python:
    """The CPython of this version in Maven's registry."""
    return next(p for p in PYTHONS if p.system == system and p.minor == minor)


def own_python(minor: str, wheels: Path, folder: Path) -> Place:
    """A Python of this machine."""
    pyenv = Path(os.environ.get("PYENV_ROOT", Path.home() / ".pyenv")) / "versions"
    there = [shutil.which(f"python{minor}"), *sorted(pyenv.glob(f"{minor}.*/bin/python{minor}"))]
    for program in filter(None, there):
        # one that pyenv names and does not run is none; nor is one that has no venv
        told = subprocess.run([program, "-c", "import ensurepip, venv"], capture_output=True)
        if told.returncode == 0:
            return Place([program], folder)
    raise Missing(f"Python {minor} with its module venv")


def offline(minor: str, wheels: Path, folder: Path) -> Place:
    """The same, with everything fetched before into a folder."""
    place = own_python(minor, wheels, folder)
    house = folder / "house"
    # pip keeps what is there under the name of a newer wheel
    for old in house.glob("railpatch-*.whl"):
        old.unlink()
    run(
        *(*place.python, "-m", "pip", "download", "--quiet", "--only-binary", ":all:"),
        *("--find-links", wheels, "--dest", house, "railpatch", "fmpy"),
    )
    place.wheels = str(house)
    place.environment = {"PIP_NO_INDEX": "1"}
    return place


def alone(minor: str, wheels: Path, folder: Path) -> Place:
    """A CPython from Maven's registry on this system."""
    program = unpacked(of_pythons(minor, "linux"), folder.parent)
    return Place([program], folder, environment=libraries_of(program))


def unpacked(python: Python, folder: Path) -> Path:
    """Its program."""
    if shutil.which("mvn") is None:
        raise Missing("Maven's client")
    return interpreter(python, folder / "archives", folder / "pythons" / python.system)


def libraries_of(program: Path) -> dict[str, str]:
    """Where a CPython from Maven's registry finds its own."""
    home = program.parents[1]
    return {"LD_LIBRARY_PATH": f"{home}:{home / 'lib'}"}


def debian(suite: str, minor: str | None, wheels: Path, folder: Path) -> Place:
    """A Debian of its own in a folder; minor: with a CPython from Maven's registry."""
    if shutil.which("debootstrap") is None:
        raise Missing("debootstrap")
    if os.geteuid() != 0:
        raise Missing("root, for debootstrap and chroot")
    root = folder.parent / "roots" / suite
    if not (root / "made").is_file():
        shutil.rmtree(root, ignore_errors=True)
        run("debootstrap", "--variant=minbase", f"--include={PACKAGES}", suite, root, MIRROR)
        (root / "made").touch()
    inside = root / "railpatch"
    shutil.rmtree(inside, ignore_errors=True)
    inside.mkdir()
    shutil.copytree(wheels, inside / "wheels", ignore=only_wheels)
    shutil.copy(HERE / "smoke.py", inside)
    # names and certificates of this machine's network
    for name in ("/etc/resolv.conf", "/etc/hosts"):
        shutil.copy(name, root / name[1:])
    shutil.copy(CERTIFICATES, inside / "certificates.crt")
    program, more = "/usr/bin/python3", {}
    if minor is not None:
        own = unpacked(of_pythons(minor, "linux"), folder.parent)
        home = own.parents[1]
        shutil.copytree(home, inside / home.name, symlinks=True)
        program = f"/railpatch/{home.name}/bin/{own.name}"
        more = libraries_of(Path(program))
    for name in COMPILERS:
        if subprocess.run(["chroot", root, "which", name], capture_output=True).returncode == 0:
            sys.exit(f"{suite} has {name}")
    variables = {
        "PATH": "/usr/bin:/bin",
        "HOME": "/root",
        "LANG": "C.UTF-8",
        "PIP_CERT": "/railpatch/certificates.crt",
        **more,
    }
    words = [f"{name}={value}" for name, value in variables.items()]
    return Place(
        ["chroot", root, "/usr/bin/env", "-i", *words, program],
        inside / "tried",
        inside="/railpatch/tried",
        wheels="/railpatch/wheels",
        smoke="/railpatch/smoke.py",
    )


def only_wheels(folder: str, names: list[str]) -> list[str]:
    """What is not copied."""
    return [name for name in names if not name.endswith(".whl")]


def wine(minor: str, wheels: Path, folder: Path) -> Place:
    """A CPython for Windows; it needs no virtual environment, being one."""
    program = next(filter(None, map(shutil.which, ("wine64", "wine"))), None)
    if program is None:
        raise Missing("Wine")
    python = of_pythons(minor, "windows")
    made = unpacked(python, folder.parent).parent
    own = folder / "python"
    shutil.rmtree(own, ignore_errors=True)
    # without it Python asks Windows for its version in a way that Wine knows
    shutil.copytree(made, own, ignore=shutil.ignore_patterns("_wmi.pyd"))
    told = subprocess.run([program, "--version"], capture_output=True, text=True).stdout.split()
    return Place(
        [program, own / "python.exe"],
        folder,
        inside=f"Z:{folder}",
        wheels=f"Z:{wheels}",
        smoke=f"Z:{HERE / 'smoke.py'}",
        environment={
            "WINEPREFIX": str(folder.parent / "wine"),
            "WINEDEBUG": "-all",
            "DISPLAY": "",
            "RAILPATCH_SYSTEM": (told or ["wine"])[0],
            "PIP_CERT": f"Z:{CERTIFICATES}",
            # it is its own environment, whatever the one around asks for
            "PIP_REQUIRE_VIRTUALENV": "0",
            # else pip says what it says to a console that is none
            "PYTHONIOENCODING": "utf-8",
        },
        more=("--here", "--constraint", *WINE_8),
    )


def run(*words: object) -> None:
    """A program; ends where it fails."""
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"failed: {' '.join(map(str, words))}\n{done.stdout[-2000:]}{done.stderr[-2000:]}")


OWN = ("3.10", "3.11", "3.12", "3.13")
ENVIRONMENTS = (
    *(Environment(f"python{v}", "a Python of this machine", partial(own_python, v)) for v in OWN),
    Environment("offline", "the same, everything from a folder", partial(offline, "3.11")),
    Environment("python3.14-alone", "CPython from Maven", partial(alone, "3.14")),
    Environment("bullseye", "Debian 11, CPython from Maven", partial(debian, "bullseye", "3.12")),
    Environment("bookworm", "Debian 12", partial(debian, "bookworm", None)),
    Environment("trixie", "Debian 13", partial(debian, "trixie", None)),
    Environment("sid", "Debian unstable", partial(debian, "sid", None)),
    *(
        Environment(f"wine-{v}", "CPython for Windows from Maven", partial(wine, v))
        for v in ("3.10", "3.11", "3.12")
    ),
)


def tried(environment: Environment, wheels: Path, folder: Path, native: bool) -> dict[str, object]:
    """What was found; "failed" or "missing" where nothing was."""
    folder.mkdir(parents=True, exist_ok=True)
    row: dict[str, object] = {"name": environment.name, "text": environment.text}
    try:
        place = environment.make(wheels, folder)
    except Missing as missing:
        return {**row, "missing": str(missing)}
    found = place.folder / "found.json"
    found.unlink(missing_ok=True)
    words = [
        *(*place.python, place.smoke or HERE / "smoke.py", place.wheels or wheels),
        *(place.inside or place.folder, *(["--native"] if native else []), *place.more),
    ]
    begin = time.perf_counter()
    try:
        # by a pipe: under Wine Python cannot write to a file of this system
        done = subprocess.run(
            [str(word) for word in words],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            env={**os.environ, **place.environment},
            timeout=LONGEST,
        )
        code, output = done.returncode, done.stdout
    except subprocess.TimeoutExpired as expired:
        code, output = -1, (expired.stdout or b"") + b"\ntook too long"
    seconds = round(time.perf_counter() - begin, 1)
    text = output.decode(errors="replace")
    (folder / "smoke.log").write_text(text, encoding="utf-8")
    if code != 0 or not found.is_file():
        return {**row, "failed": text[-3000:] or f"code {code}", "seconds": seconds}
    return {**row, **json.loads(found.read_text(encoding="utf-8")), "seconds": seconds}


def table(rows: Iterable[dict[str, object]]) -> str:
    """Markdown."""
    lines = [
        "| environment | Python | system | wheel | numpy, scipy "
        "| `solve`, digest | `rig`, digest | `report` | `fmu` 2.0, 3.0, in fmpy |",
        f"|{'---|' * 9}",
    ]
    for row in rows:
        name = f"`{row['name']}`, {row['text']}"
        if "missing" in row:
            lines.append(f"| {name} | | | | | | | | not tried: needs {row['missing']} |")
        elif "failed" in row:
            last = str(row["failed"]).strip().splitlines()[-1:]
            lines.append(f"| {name} | | | | | | | | failed: {' '.join(last)} |")
        else:
            libraries = row["with"]
            cells = (
                *(name, row["python"], row["libc"], f"`{row['tags'][0]}`"),
                f"{libraries['numpy']}, {libraries['scipy']}",
                *(f"`{row['solve']}`", f"`{row['rig']}`", "ran", "ran"),
            )
            lines.append(f"| {' | '.join(map(str, cells))} |")
    return "\n".join(lines) + "\n"


def main() -> int:
    """All or the named ones."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("wheels", type=Path)
    parser.add_argument("folder", type=Path)
    parser.add_argument("names", nargs="*", metavar="NAME")
    parser.add_argument("--native", action="store_true", help="wheels that `pip wheel .` built")
    arguments = parser.parse_args()
    wheels, folder = arguments.wheels.resolve(), arguments.folder.resolve()
    known = {environment.name: environment for environment in ENVIRONMENTS}
    if unknown := set(arguments.names) - set(known):
        sys.exit(f"no environment {sorted(unknown)}; there are {', '.join(known)}")
    store = folder / "environments.json"
    rows: dict[str, dict[str, object]] = {}
    if arguments.names and store.is_file():  # the others stay as they were
        rows = {row["name"]: row for row in json.loads(store.read_text(encoding="utf-8"))}
    good = True
    for name in arguments.names or known:
        row = tried(known[name], wheels, folder / name, arguments.native)
        rows[name] = row
        good &= "failed" not in row and not ("missing" in row and bool(arguments.names))
        print(table([row]).splitlines()[-1], flush=True)
        if "failed" in row:
            print(row["failed"], flush=True)
    kept = [rows[name] for name in known if name in rows]
    for field_name in ("solve", "rig"):
        bits = {str(row[field_name]) for row in kept if field_name in row}
        print(f"{field_name}: {len(bits)} different result(s)")
        good &= len(bits) <= 1
    store.write_text(json.dumps(kept, indent=2) + "\n", encoding="utf-8")
    (folder / "environments.md").write_text(table(kept), encoding="utf-8")
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
