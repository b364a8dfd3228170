"""What a user does first, in a clean environment: python smoke.py WHEELS FOLDER [--here]

Run by the Python that is to be tried, with nothing but its standard library: makes a virtual
environment in FOLDER (--here: uses this Python itself), lets pip choose among the wheels in WHEELS
and fetch what they and fmpy depend on, and runs the command: solve, rig, fmu, report, export, the
FMU in fmpy, and a command that has to say what is missing. Writes FOLDER/found.json; ends with 1
where something does not hold.
--constraint NAME... holds dependencies back, for systems that cannot run the newest. --native: of a
wheel that `pip wheel .` has built, whose FMUs are for its own system.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import os
import platform
import subprocess
import sys
import time
import zipfile
from pathlib import Path

CASE = """kind = "patch"
[material]
shear_modulus = 82e9
poisson_ratio = 0.28
[geometry]
semi_axes = [0.006, 0.004]
[load]
normal_force = 8.0e4
[grid]
elements = [20, 14]
[motion]
regime = "steady_rolling"
creepage = [1e-3, 5e-4]
spin_creepage = 0.3
rolling_speed = 20.0
[friction]
coefficient = 0.35
"""
CLOCK = ("wall_time", "stages")
# what an FMU of any wheel holds, of each version of FMI
BINARIES = {
    "2": {"linux64", "win64", "aarch64-linux"},
    "3": {"x86_64-linux", "x86_64-windows", "aarch64-linux"},
}
ASK = """
import importlib.metadata as m, json, pathlib, railpatch
names = "numpy", "scipy", "pydantic", "protobuf", "click"
made = m.distribution("railpatch")
print(json.dumps({
    "version": railpatch.__version__,
    "module": pathlib.Path(railpatch._core.__file__).name,
    "tags": [x[5:] for x in made.read_text("WHEEL").splitlines() if x.startswith("Tag: ")],
    "with": {n: m.version(n) for n in names},
    "bytes": sum(f.locate().stat().st_size for f in made.files if f.locate().is_file()),
}))
"""


class Trial:
    """One environment."""

    def __init__(self, folder: Path, here: bool) -> None:
        self.folder = folder
        if here:
            self.python = Path(sys.executable)
        else:
            made = folder / "venv"
            self.call(sys.executable, "-m", "venv", "--clear", made)
            windows = os.name == "nt"
            self.python = made / ("Scripts/python.exe" if windows else "bin/python")
        self.script = self.python.parent
        if os.name == "nt" and here:
            self.script = self.python.parent / "Scripts"

    def call(self, *command: str | Path, code: int = 0) -> str:
        """A program's output; ends where its exit code is another."""
        words = [str(word) for word in command]
        done = subprocess.run(
            words, stdin=subprocess.DEVNULL, capture_output=True, text=True, encoding="utf-8"
        )
        if done.returncode != code:
            told = f"{done.stdout[-3000:]}{done.stderr[-3000:]}"
            sys.exit(f"failed ({done.returncode}): {' '.join(words)}\n{told}")
        return done.stdout + (done.stderr if code else "")

    def railpatch(self, *words: str | Path, code: int = 0) -> str:
        """The command, as it was installed."""
        return self.call(self.script / "railpatch", *words, code=code)


def must(good: object, what: str) -> None:
    """Ends where something does not hold."""
    if not good:
        sys.exit(f"does not hold: {what}")


def digest(content: object) -> str:
    """Of numbers, bit by bit."""
    return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()[:16]


def solved(trial: Trial) -> str:
    """The digest of a patch, all its fields."""
    case = trial.folder / "case.toml"
    case.write_text(CASE)
    found = json.loads(trial.railpatch("solve", case, "--json", "--fields"))
    must(found["status"] == "converged", "the patch is solved")
    return digest({key: value for key, value in found.items() if key not in CLOCK})


def replayed(trial: Trial) -> str:
    """The digest of the roller rig's replay; makes a report."""
    log, table, page = (trial.folder / f"rig.{kind}" for kind in ("mcap", "csv", "html"))
    trial.railpatch("rig", "--positions", "5", "--quiet", "-o", log)
    trial.railpatch("report", log, "-o", page)
    must("Roller rig" in page.read_text(encoding="utf-8"), "the report is one")
    trial.railpatch("export", log, "--channel", "/wheelset/state", "-o", table)
    return hashlib.sha256(table.read_bytes().replace(b"\r\n", b"\n")).hexdigest()[:16]


def packed(trial: Trial, native: bool) -> int:
    """The size of an FMU for all systems; fmpy has run it here, of both versions of FMI."""
    for version, binaries in BINARIES.items():
        made = trial.folder / f"rail_fmi{version}.fmu"
        trial.railpatch("fmu", "--scene", "patch", "--fmi", version, "-o", made)
        with zipfile.ZipFile(made) as archive:
            names = archive.namelist()
        there = {name.split("/")[1] for name in names if name.startswith("binaries/")}
        wanted = set() if native else binaries
        must(there >= wanted, f"an FMU for {sorted(wanted)}, found {sorted(there)}")
        sources = any(name.startswith("sources/") for name in names)
        must(sources or native, "an FMU with its sources")
        told = trial.call(trial.python, "-m", "railpatch.fmu.try_out", made)
        must("valid" in told, f"fmpy runs the FMU: {told}")
    return made.stat().st_size


def main() -> None:
    """Installs, runs, tells."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("wheels", type=Path)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--here", action="store_true")
    parser.add_argument("--native", action="store_true")
    parser.add_argument("--constraint", nargs="*", default=[])
    arguments = parser.parse_args()
    arguments.folder.mkdir(parents=True, exist_ok=True)
    trial = Trial(arguments.folder, arguments.here)
    start = time.perf_counter()
    trial.call(
        *(trial.python, "-m", "pip", "install", "--quiet", "--only-binary", ":all:"),
        *("--find-links", arguments.wheels, "railpatch", "fmpy", *arguments.constraint),
    )
    installed = time.perf_counter() - start
    told = json.loads(trial.call(trial.python, "-c", ASK))
    must(trial.railpatch("--version").split() == ["railpatch", told["version"]], "--version")
    refusal = trial.railpatch("wheelset", "--wrong", code=2)
    must("railpatch[pinocchio]" in refusal, "what to install is said before options are read")
    found = {
        "python": platform.python_version(),
        "system": platform.platform(),
        "libc": " ".join(platform.libc_ver()) or os.environ.get("RAILPATCH_SYSTEM", ""),
        **told,
        "install_seconds": round(installed, 1),
        "solve": solved(trial),
        "rig": replayed(trial),
        "fmu_bytes": packed(trial, arguments.native),
    }
    (arguments.folder / "found.json").write_text(json.dumps(found, indent=2) + "\n")
    print(json.dumps(found, indent=2))


if __name__ == "__main__":
    main()
