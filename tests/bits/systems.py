"""The same bits on other systems: python systems.py FOLDER, of plugins/fmu/cross/build.py.

Solves 200 cases by the C interface (steps.c) with the programs that Clang makes for each platform,
under Wine and QEMU where they are installed, and compares them with what the same program gives
here; ends with 1 where a number differs and prints how far.
"""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Sequence
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "plugins" / "fmu" / "cross"))

from bits.combinations import sample
from bits.interface import differing, run, write
from check import emulators

CASES = 200
PROGRAM = Path("tests") / "bits" / "bits_steps"


def farthest(here: list[str], there: list[str]) -> str:
    """Of all numbers of a case."""
    if len(here) != len(there):
        return f"{len(here)} numbers, {len(there)} there"
    pairs = [(float.fromhex(a), float.fromhex(b)) for a, b in zip(here, there, strict=True)]
    unlike = [(a, b) for a, b in pairs if a != b and not (a != a and b != b)]
    worst = max((abs(a - b) / max(abs(a), abs(b)) for a, b in unlike), default=0.0)
    return f"{len(unlike)} of {len(pairs)} numbers, by at most {worst:.1e} of themselves"


def compare(
    here: Sequence[str | Path], there: Sequence[str | Path], cases: Path, prefix: str
) -> int:
    """How many cases differ; says which."""
    found = differing(run(here, cases), run(there, cases, prefix=prefix))
    for number, one, two in found:
        print(f"  {one}\n  {two}")
        if number >= 0:
            each = run(here, cases, str(number)), run(there, cases, str(number), prefix=prefix)
            print(f"    {farthest(*each)}")
    return len(found)


def main() -> int:
    """Every platform that can be run here."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    folder = parser.parse_args().folder.resolve()
    os.environ.setdefault("WINEPREFIX", str(folder / "check" / "wine"))
    os.environ.setdefault("WINEDEBUG", "-all")
    cases = write(folder / "bits", sample(4 * CASES), CASES)
    here = [folder / "linux64" / PROGRAM]
    wrong = 0
    for other in emulators():
        program = folder / other.platform / PROGRAM.with_suffix(other.ending)
        if not program.exists():
            continue
        count = compare(here, [*other.program, program], cases, other.prefix)
        print(f"{other.platform} under {other.name}: {CASES} cases, {count} differ from linux64")
        wrong += count
    return min(wrong, 1)


if __name__ == "__main__":
    sys.exit(main())
