"""What must hold of an FMU for many systems: python check.py NAME.fmu FOLDER [--compile]

Looks at the libraries' symbols (binutils), runs those of this machine by steps.c, of FMI 3.0 by
steps_fmi3.c, where Wine is installed those of Windows too, and where QEMU is installed those for
ARM (Debian: wine64; qemu-user-static and libc6-arm64-cross), and compares their numbers; --compile:
also the library that fmpy makes of the sources, with the compiler of this machine. FOLDER is for
what is made here; it may stay.
"""

from __future__ import annotations

import argparse
import os
import re
import shutil
import subprocess
import sys
import xml.etree.ElementTree as ET
import zipfile
from dataclasses import dataclass
from pathlib import Path

from build import package, use_cache

GLIBC = (2, 17)
# names of FMI 2.0 and 3.0
SYSTEM = {
    "linux64": r"lib(c|m|pthread|dl)\.so\.\d|ld-linux-x86-64\.so\.2",
    "x86_64-linux": r"lib(c|m|pthread|dl)\.so\.\d|ld-linux-x86-64\.so\.2",
    "aarch64-linux": r"lib(c|m|pthread|dl)\.so\.\d|ld-linux-aarch64\.so\.1",
    "win64": r"KERNEL32\.dll|api-ms-win-crt-[a-z0-9-]*\.dll|ucrtbase\.dll",
    "x86_64-windows": r"KERNEL32\.dll|api-ms-win-crt-[a-z0-9-]*\.dll|ucrtbase\.dll",
}
FUNCTIONS = re.compile(r"FullName\((fmi[23]\w+)\)")
# relative, of the largest output of the same quantity: libraries of different compilers round
# differently, and an iteration carries that on
SAME = 1e-9
LOADS = 100
# Debian's folder of the C library for ARM
ARM = Path("/usr/aarch64-linux-gnu")


@dataclass(frozen=True)
class Emulator:
    """Runs another system's programs here."""

    name: str
    platforms: tuple[str, str]  # in FMI 2.0, in FMI 3.0
    target: str  # of the compiler
    program: list[str | Path]
    ending: str = ""
    prefix: str = ""  # of a path
    libraries: tuple[str, ...] = ()

    @property
    def platform(self) -> str:
        """Its name in FMI 2.0."""
        return self.platforms[0]


def emulators() -> list[Emulator]:
    """Those at hand."""
    found = []
    if (wine := which("wine64", "wine", "/usr/lib/wine/wine64")) is not None:
        target = "x86_64-windows-gnu"
        found.append(Emulator("Wine", ("win64", "x86_64-windows"), target, [wine], ".exe", "Z:"))
    qemu = which("qemu-aarch64", "qemu-aarch64-static")
    if qemu is not None and ARM.is_dir():
        target = "aarch64-linux-gnu.2.17"
        program = [qemu, "-L", ARM]
        name = "aarch64-linux"
        found.append(Emulator("QEMU", (name, name), target, program, libraries=("-ldl",)))
    return found


def which(*names: str) -> str | None:
    """The first of these programs that there is."""
    return next((found for name in names if (found := shutil.which(name))), None)


def output(*command: str | Path, **options: object) -> str:
    """What a program prints; ends where it fails."""
    done = subprocess.run(
        [str(part) for part in command], capture_output=True, text=True, check=False, **options
    )
    if done.returncode != 0:
        sys.exit(f"failed: {' '.join(map(str, command))}\n{done.stdout}{done.stderr}")
    return done.stdout


def made(source: Path, program: Path, *command: str | Path) -> None:
    """Compiles it, where it is not newer than its source and what lies beside that."""
    newest = max(path.stat().st_mtime for path in source.parent.glob("*.[ch]"))
    if not program.is_file() or program.stat().st_mtime < newest:
        output(*command, "-o", program)


def must(good: object, what: str) -> None:
    """Ends where something does not hold."""
    if not good:
        sys.exit(f"does not hold: {what}")


def check_elf(platform: str, path: Path) -> set[str]:
    """Symbols of a Linux library, and what it needs; gives the exports."""
    names = output("readelf", "-W", "--dyn-syms", path)
    found = [tuple(map(int, v.split("."))) for v in re.findall(r"GLIBC_([0-9.]+)", names)]
    must(max(found) <= GLIBC, f"{platform}: nothing newer than GLIBC {GLIBC}, found {max(found)}")
    dynamic = output("readelf", "-dW", path)
    for library in re.findall(r"\(NEEDED\).*\[(.*)\]", dynamic):
        must(re.fullmatch(SYSTEM[platform], library), f"{platform}: {library} is of the system")
    must(not re.search("RPATH|RUNPATH|TEXTREL", dynamic), f"{platform}: no RPATH, no TEXTREL")
    must(re.search("GNU_STACK .* RW ", output("readelf", "-lW", path)), f"{platform}: stack")
    defined = [line.split() for line in names.splitlines() if " UND " not in line]
    print(f"{platform}: GLIBC_{'.'.join(map(str, max(found)))}, {path.stat().st_size} bytes")
    return {words[7].split("@")[0] for words in defined if len(words) > 7 and words[4] == "GLOBAL"}


def check_pe(platform: str, path: Path) -> set[str]:
    """The same of a library for Windows."""
    text = output("objdump", "-p", path)
    libraries = re.findall(r"DLL Name: (\S+)", text)
    for library in libraries:
        must(re.fullmatch(SYSTEM[platform], library), f"{platform}: {library} is of the system")
    print(f"{platform}: {' '.join(libraries)}, {path.stat().st_size} bytes")
    names = text[text.index("[Ordinal/Name Pointer] Table") :]
    return set(re.findall(r"^\s*\[\s*\d+\](?: \+base\[\s*\d+\]\s+[0-9a-f]+)? (\w+)", names, re.M))


@dataclass(frozen=True)
class Variable:
    """A real one of a model description, of either version of FMI."""

    reference: str
    causality: str
    quantity: str
    nominal: float
    start: str  # of an array, commas between its values
    length: int  # of an array; else 1

    @staticmethod
    def of(element: ET.Element, version: int) -> Variable:
        """As it is declared."""
        declared = element[0].attrib if version == 2 else element.attrib
        length = 1
        for dimension in element.findall("Dimension"):
            length *= int(dimension.attrib["start"])
        return Variable(
            element.attrib["valueReference"],
            element.attrib["causality"],
            declared.get("quantity", ""),
            float(declared.get("nominal", 1.0)),
            ",".join(declared.get("start", "").split()),
            length,
        )

    def keys(self, version: int) -> list[str]:
        """What the program for this version prints before its values."""
        if version == 2:
            return [self.reference]
        return [f"{self.reference}[{k}]" for k in range(self.length)]


class Unpacked:
    """An FMU in a folder."""

    def __init__(self, path: Path, folder: Path) -> None:
        shutil.rmtree(folder, ignore_errors=True)
        zipfile.ZipFile(path).extractall(folder)
        self.folder = folder
        self.root = ET.parse(folder / "modelDescription.xml").getroot()
        self.version = int(self.root.attrib["fmiVersion"][0])
        if self.version == 2:
            found = [v for v in self.root.iter("ScalarVariable") if v[0].tag == "Real"]
        else:
            found = list(self.root.iter("Float64"))
        self.reals = [Variable.of(v, self.version) for v in found if "causality" in v.attrib]

    def binary(self, platform: str) -> Path:
        """Of a platform; the only file there."""
        return next((self.folder / "binaries" / platform).iterdir())

    def platforms(self) -> list[str]:
        """FMI's names."""
        return sorted(p.name for p in (self.folder / "binaries").iterdir())

    @property
    def here(self) -> str:
        """The name of this system."""
        return "linux64" if self.version == 2 else "x86_64-linux"

    @property
    def program(self) -> str:
        """What runs it, without the ending of its source."""
        return "steps" if self.version == 2 else "steps_fmi3"

    @property
    def outputs(self) -> list[Variable]:
        """What is compared."""
        return [v for v in self.reals if v.causality == "output"]

    def arguments(self, platform: str, prefix: str) -> list[str]:
        """Of the program; prefix: stands before a path."""
        moved = next(v for v in self.reals if v.causality == "input")
        library = f"{prefix}{self.binary(platform)}"
        resources = f"{prefix}{self.folder / 'resources'}"
        if self.version == 2:
            resources = f"file://{'/' if prefix else ''}{resources}"
            token, numbers = self.root.attrib["guid"], [v.reference for v in self.outputs]
        else:
            resources += "/"
            token = self.root.attrib["instantiationToken"]
            numbers = [f"{v.reference}:{v.length}" for v in self.outputs]
        return [library, token, resources, str(LOADS), moved.reference, moved.start, *numbers]

    def run(self, platform: str, program: list[str | Path], prefix: str = "") -> dict[str, float]:
        """Reference, of an array with the element -> the last value."""
        environment = {"WINEDEBUG": "-all", "DISPLAY": "", **os.environ}
        text = output(*program, *self.arguments(platform, prefix), env=environment)
        rows = [line.split() for line in text.splitlines()]
        return {reference: float.fromhex(value) for reference, value in rows}

    def worst(self, one: dict[str, float], other: dict[str, float]) -> float:
        """Largest difference, relative to the largest output of the same quantity, or where that is
        0 but for rounding, as a moment by symmetry, to a thousandth of the nominal value."""
        each = [(v, key) for v in self.outputs for key in v.keys(self.version)]
        must(each and {key for _, key in each} == set(one) == set(other), "every output is there")
        sizes: dict[str, float] = {}
        for v, key in each:
            least = 1e-3 * v.nominal
            sizes[v.quantity] = max(sizes.get(v.quantity, 0.0), least, abs(one[key]))
        found = 0.0
        for v, key in each:
            # the residual is the rest that the solver left: rounding itself
            if v.quantity != "RelativeError":
                found = max(found, abs(one[key] - other[key]) / sizes[v.quantity])
        return found


def compiled(path: Path, folder: Path) -> Unpacked:
    """The FMU with the library for this machine that fmpy makes of the sources."""
    from fmpy.build import build_platform_binary

    fmu = Unpacked(path, folder)
    shutil.rmtree(fmu.folder / "binaries")
    build_platform_binary(fmu.folder)
    return fmu


def main() -> None:
    """Everything, in the order of the cost."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("fmu", type=Path)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--compile", action="store_true")
    arguments = parser.parse_args()
    path, folder = arguments.fmu.resolve(), arguments.folder.resolve()
    use_cache(folder.parent)  # of `make fmu`: the compiler's parts for each system are there
    must(path.stat().st_size < 5e6, "the FMU is below 5 MB")
    fmu = Unpacked(path, folder / path.stem)
    headers = package("fmpy") / "c-code"
    header = headers / f"fmi{fmu.version}Functions.h"
    expected = set(FUNCTIONS.findall(header.read_text()))
    for platform in fmu.platforms():
        if "darwin" in platform:
            print(f"{platform}: {fmu.binary(platform).stat().st_size} bytes, not looked into")
            continue
        look = check_pe if "win" in platform else check_elf
        exports = look(platform, fmu.binary(platform))
        must(exports <= expected, f"{platform}: only FMI's functions, not {exports - expected}")
        must(exports == expected, f"{platform}: all of FMI's functions, not {expected - exports}")
    source = Path(__file__).with_name(f"{fmu.program}.c")
    zig = [package("ziglang") / "zig", "cc", source, f"-I{headers}"]
    made(source, folder / fmu.program, *zig, "-ldl")
    here = fmu.run(fmu.here, [folder / fmu.program])
    print(f"{fmu.here}: {LOADS} loads, 100 steps here")
    os.environ.setdefault("WINEPREFIX", str(folder / "wine"))
    for other in emulators():
        platform = other.platforms[fmu.version - 2]
        if platform in fmu.platforms():
            program = folder / f"{fmu.program}_{platform}{other.ending}"
            made(source, program, *zig, "-target", other.target, *other.libraries)
            there = fmu.run(platform, [*other.program, program], prefix=other.prefix)
            compare(fmu, here, there, f"{platform} under {other.name}")
    if arguments.compile:
        own = compiled(path, folder / f"{path.stem}_compiled")
        names = output("nm", "-DC", "--defined-only", own.binary(fmu.here))
        must("railpatch" not in names and " rp_" not in names, "compiled by fmpy: hides the core")
        must(not re.search(r" u ", names), "compiled by fmpy: holds nothing unique in a process")
        compare(fmu, here, own.run(fmu.here, [folder / fmu.program]), "compiled by fmpy")


def compare(fmu: Unpacked, here: dict[str, float], there: dict[str, float], name: str) -> None:
    """Prints the difference to the numbers of this system; ends where it is too large."""
    worst = fmu.worst(here, there)
    print(f"{name}: {LOADS} loads, 100 steps, {worst:.1e} from {fmu.here}")
    must(worst < SAME, f"{name}: {worst} is below {SAME}")


if __name__ == "__main__":
    main()
