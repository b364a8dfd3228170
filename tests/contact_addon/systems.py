"""The add-on on its systems: python systems.py FOLDER, of plugins/contact_addon/build.py.

Looks at the libraries' symbols (binutils), links the driver in C with each of them by the
cross-compiler, runs that of Linux here and that of Windows under Wine, and compares every number
that they print; ends with 1 where one differs by more than rounding. The drivers add up and give
undeformed distances by the mathematical functions of each system: these digits differ.
"""

from __future__ import annotations

import argparse
import os
import re
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "plugins" / "fmu" / "cross"))

from addon_inputs import write_inputs
from check import check_elf, check_pe, emulators, must, output

from build import ENDINGS, PLATFORMS, package

HERE = Path(__file__).resolve().parent
# as the drivers in C and Fortran are compared: test_addon.py
SAME, LEAST = 1e-9, 1e-12
DECLARED = re.compile(r"\b((?:cntc|subs)_\w+)\(")


def linked(platform: str, folder: Path, ending: str) -> Path:
    """The driver with a platform's library, which lies beside it."""
    library = folder / "lib" / f"contact_addon_{platform}{ENDINGS[PLATFORMS[platform][1]]}"
    program = library.with_name(f"driver_{platform}{ending}")
    zig = [package("ziglang") / "zig", "cc"]
    if ending:  # what this machine's own programs need it has
        zig += ["-target", PLATFORMS[platform][0]]
    strict = ["-std=c11", "-Wall", "-Wextra", "-Werror", f"-I{folder / 'lib'}"]
    # as the library: else each compiler joins products and sums as it likes
    strict += ["-ffp-contract=off"]
    beside = [] if ending else ["-Wl,-rpath,$ORIGIN", "-lm"]
    output(*zig, *strict, HERE / "driver.c", library, *beside, "-o", program)
    return program


def said(program: list[str | Path], driver: Path, folder: Path, prefix: str) -> dict[str, float]:
    """What it prints, of basic contacts and of wheels: name -> number."""
    files, positions = write_inputs(folder)
    paths = [f"{prefix}{p}" for p in (files["rail"], files["wheel"], positions, folder)]
    both = [["basic", paths[-1]], ["wheels", *paths]]
    environment = {**os.environ, "WINEDEBUG": "-all", "DISPLAY": ""}
    texts = [output(*program, driver, *words, env=environment) for words in both]
    rows = (line.split() for line in "".join(texts).splitlines())
    return {name: float(value) for name, value in rows}


def main() -> int:
    """Symbols, then numbers."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    folder = parser.parse_args().folder.resolve()
    os.environ.setdefault("WINEPREFIX", str(folder / "wine"))
    runs = folder / "driver"
    runs.mkdir(exist_ok=True)
    header = (folder / "lib" / "contact_addon.h").read_text(encoding="utf-8")
    declared = set(DECLARED.findall(re.sub(r"/\*.*?\*/", "", header, flags=re.DOTALL)))
    for platform, look in (("linux64", check_elf), ("win64", check_pe)):
        exports = look(platform, next((folder / "lib").glob(f"contact_addon_{platform}.*")))
        must(exports == declared, f"{platform}: its functions alone, not {exports ^ declared}")
    here = said([], linked("linux64", folder, ""), runs, "")
    print(f"linux64: {len(exports)} functions, {len(here)} numbers here")
    wrong = 0
    for other in emulators():
        if other.platform == "win64":
            there = said(other.program, linked("win64", folder, ".exe"), runs, other.prefix)
            must(here.keys() == there.keys(), "both print the same numbers")
            far = {n: abs(x - there[n]) / max(abs(x), LEAST / SAME) for n, x in here.items()}
            count, most = sum(value > 0 for value in far.values()), max(far, key=far.__getitem__)
            print(f"win64 under {other.name}: {count} of {len(there)} numbers differ,", end=" ")
            print(f"at most by {far[most]:.1e} of the number: {most}")
            wrong += sum(value > SAME for value in far.values())
    return min(wrong, 1)


if __name__ == "__main__":
    sys.exit(main())
