"""Walks the pages of each person word by word in a fresh environment: the table of docs/walks.md.

python docs/walks.py [--wheels DIR] [PERSON ...]

Each person gets an own virtual environment and an empty folder for each page. Everything that runs
there stands on the page: its `pip install`, its commands, its cells. The wheel lies in DIR, or pip
builds it of this checkout. Times are by the clock.
"""

from __future__ import annotations

import argparse
import os
import re
import shlex
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

DOCS = Path(__file__).resolve().parent
ROOT = DOCS.parent
sys.path.insert(0, str(DOCS))

from making import table  # noqa: E402
from making.tutorials import cells  # noqa: E402

BLOCK = re.compile(r"^```sh\n(.*?)^```", re.DOTALL | re.MULTILINE)
FORM = re.compile(r"\[(?!\w+(,\w+)*\]')|\b[A-Z]{3,}\b")  # extras of pip stand in brackets too
INDENTED = re.compile(r"^ {4}(railpatch .*)$", re.MULTILINE)
SPOKEN = re.compile(r"`((?:pip install|railpatch init|railpatch \w+ [^`]*-o) [^`]+)`")


@dataclass(frozen=True)
class Walk:
    """One page as one person follows it, and files that it has to leave."""

    person: str
    page: str
    comes_out: str
    leaves: tuple[str, ...] = ()
    blocks: int = 1
    spoken: bool = False  # a tutorial's commands, in place of its cells


WALKS = [
    Walk(
        "rig engineer",
        "../examples/rig_engineer.py",
        "an own record replayed beside its measurements, friction found",
        ("own.mcap", "own.html", "own.csv", "matched/match.toml"),
    ),
    Walk(
        "rig engineer",
        "measured_runs.md",
        "the packaged run replayed, report, tables",
        ("roller.html", "run.mcap", "run.html", "run.xlsx"),
    ),
    Walk(
        "rig engineer",
        "matching_tutorial.md",
        "friction, layer, frame and offset found in a noisy record, with intervals",
        ("demo/record.csv", "demo/out/match.toml", "demo/out/match.html"),
        blocks=2,
    ),
    Walk(
        "vehicle engineer",
        "../examples/vehicle_engineer.py",
        "Q, Y/Q, pressure and wear number on own profiles, of a coach with own masses",
        ("mine/vehicle.toml",),
    ),
    Walk(
        "vehicle engineer",
        "../examples/vehicle_engineer.py",
        "its commands: a scene to change, and the log of its 20 s by the full theory",
        ("mine/vehicle.toml", "run.mcap"),
        spoken=True,
    ),
    Walk(
        "researcher",
        "../examples/researcher.py",
        "creep curves of three theories, fields of a patch, derivatives",
    ),
    Walk(
        "FMU user",
        "../examples/fmu_user.py",
        "a mass on a contact in fmpy at three steps, and the step that it bears",
        ("wheel.fmu",),
    ),
    Walk("FMU user", "../examples/fmu_user.py", "its command: an FMU", ("wheel.fmu",), spoken=True),
    Walk(
        "analyst",
        "../examples/analyst.py",
        "a log in pandas, tables for other programs, a layout for viewers",
        ("run.mcap", "run.csv", "run.parquet", "layout.json"),
    ),
    Walk(
        "analyst",
        "../examples/analyst.py",
        "its commands: a wheelset's log, its table and report",
        ("run.mcap", "run.xlsx", "run.html"),
        spoken=True,
    ),
    Walk(
        "analyst",
        "logs.md",
        "the rig's log, report, layout, three tables",
        ("run.mcap", "report.html", "layout.json", "run.csv", "yaw.csv", "left.mat"),
    ),
]


def commands(page: str, blocks: int = 1) -> list[str]:
    """Those in a page's first blocks and in its indented lines, without comments; what has
    placeholders in capitals is a form, not a command."""
    text = (DOCS / page).read_text(encoding="utf-8")
    found = [*BLOCK.findall(text)[:blocks], *INDENTED.findall(text)]
    lines = [line.partition(" #")[0].strip() for part in found for line in part.splitlines()]
    return [line for line in lines if line and not FORM.search(line)]


def spoken(page: str) -> list[str]:
    """Commands in a tutorial's text."""
    text = "\n".join(cell.source for cell in cells(DOCS / page) if cell.is_text)
    return [line for line in SPOKEN.findall(text) if not FORM.search(line)]


def words_of(walk: Walk) -> tuple[list[str], list[str], str]:
    """What a page says to install, its commands, and its cells of code as one script."""
    if walk.page.endswith(".md"):
        lines, code = commands(walk.page, walk.blocks), []
    else:
        lines = spoken(walk.page)
        code = [cell.source for cell in cells(DOCS / walk.page) if not cell.is_text]
    installs = [line for line in lines if line.startswith("pip install")]
    lines = [line for line in lines if line not in installs]
    # from measured points alone; the packaged run has none: matching_tutorial.md
    lines = [line for line in lines if not line.startswith("railpatch match mine")]
    if walk.page.endswith(".md") or walk.spoken:
        return [] if walk.spoken else installs, lines, ""  # the same page was followed before
    return installs, [f"cell {k}" for k in range(1, len(code) + 1)], "\n\n".join(code)


def called(seconds: float) -> str:
    """A time as minutes and seconds."""
    return f"{int(seconds) // 60}:{int(seconds) % 60:02d}"


class Environment:
    """One person's: a virtual environment outside the checkout."""

    def __init__(self, folder: Path, wheels: Path) -> None:
        self.folder = folder
        self.own = {k: v for k, v in os.environ.items() if not k.startswith("PYTHON")}
        self.own["PATH"] = f"{folder / 'bin'}{os.pathsep}{os.environ['PATH']}"
        links = os.environ.get("PIP_FIND_LINKS", "")
        self.own["PIP_FIND_LINKS"] = f"{wheels} {links}".strip()
        self.run([sys.executable, "-m", "venv", str(folder)], folder.parent)

    def run(self, words: list[str], where: Path) -> str:
        """Runs a command; raises with what it said."""
        ended = subprocess.run(
            words, cwd=where, env=self.own, capture_output=True, text=True, check=False
        )
        if ended.returncode:
            raise SystemExit(f"{shlex.join(words)}\n{ended.stdout}{ended.stderr}")
        return ended.stdout

    def walk(self, walk: Walk, where: Path) -> tuple[int, int, float, float]:
        """Installs, does what the page says: counts of both, and seconds of both."""
        installs, lines, code = words_of(walk)
        begin = time.perf_counter()
        for line in installs:
            self.run(["sh", "-c", line], where)
        middle = time.perf_counter()
        if code:
            (where / "page.py").write_text(code, encoding="utf-8")
            self.run(["python", "page.py"], where)
        else:
            for line in lines:
                self.run(["sh", "-c", line], where)
        ended = time.perf_counter()
        place = self.run(["python", "-c", "import railpatch; print(railpatch.__file__)"], where)
        assert Path(place.strip()).is_relative_to(self.folder), place
        missing = [name for name in walk.leaves if not (where / name).is_file()]
        if missing:
            raise SystemExit(f"{walk.page}: did not leave {missing}")
        return len(installs), len(lines), middle - begin, ended - middle


def link(walk: Walk) -> str:
    name = Path(walk.page).stem.replace("_", " ").replace("fmu", "FMU")
    return f"[{name}]({walk.page})"


def rows(persons: list[str], wheels: Path, folder: Path) -> list[list[str]]:
    """One for each page of each person."""
    found, environments = [], {}
    for number, walk in enumerate(WALKS):
        if walk.person not in persons:
            continue
        begin = time.perf_counter()
        if walk.person not in environments:
            place = folder / walk.person.replace(" ", "_")
            environments[walk.person] = Environment(place, wheels)
        made = time.perf_counter() - begin
        where = folder / f"walk{number}"
        where.mkdir()
        first = walk is next(w for w in WALKS if w.person == walk.person)
        installs, lines, install, took = environments[walk.person].walk(walk, where)
        unit = "cells" if not walk.page.endswith(".md") and not walk.spoken else "commands"
        unit = unit.removesuffix("s") if lines == 1 else unit
        set_up = f"{installs + first}, {called(install + made)}" if first or installs else "-"
        found.append(
            [walk.person, link(walk), set_up, f"{lines} {unit}", called(took), walk.comes_out]
        )
        print(found[-1], file=sys.stderr, flush=True)
    return found


def main() -> None:
    """Prints the table and how loaded the machine was."""
    parser = argparse.ArgumentParser(description=__doc__)
    known = list(dict.fromkeys(walk.person for walk in WALKS))
    parser.add_argument("persons", nargs="*", metavar="PERSON", help=", ".join(known))
    parser.add_argument("--wheels", type=Path, help="a folder with a wheel of this Python")
    given = parser.parse_args()
    if unknown := set(given.persons) - set(known):
        parser.error(f"{', '.join(sorted(unknown))}: not one of {', '.join(known)}")
    before = os.getloadavg()[0]
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        wheels = given.wheels.resolve() if given.wheels else folder / "wheels"
        if not given.wheels:
            build = [sys.executable, "-m", "pip", "wheel", "--no-deps", "-w", str(wheels)]
            subprocess.run([*build, str(ROOT)], check=True, stdout=subprocess.DEVNULL)
        found = rows(given.persons or known, wheels, folder)
    head = ["you", "page", "set-up: commands, min:s", "on the page", "min:s", "what comes out"]
    print(table(head, found))
    print(
        f"Load average {before:.1f} at the beginning, {os.getloadavg()[0]:.1f} at the end, on"
        f" {os.cpu_count()} processors; Python {sys.version.split()[0]}."
    )


if __name__ == "__main__":
    main()
