"""What plain cases cost in a core with and in one without the optional physics.

Usage: compare.py WITH WITHOUT, the programs pruning_steps of two builds of the same sources that
differ in the option RAILPATCH_PHYSICS alone. Counts the instructions of single steps with callgrind
and the memory of the handle, and asks that both are equal within 1 % and the solutions to the bit.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
import tempfile
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path

LIMIT = 0.01  # of instructions and of bytes
CASES = ("half_space", "hertz", "wheel_rail")
STARTS = ("cold", "warm")
Numbers = dict[str, list[float]]
Run = Future[tuple[Numbers, int]]


def run(program: str, case: str, start: str) -> tuple[Numbers, int]:
    """What the program prints, and the instructions of the step that it measures."""
    with tempfile.TemporaryDirectory() as folder:
        counts = Path(folder) / "counts"
        ran = subprocess.run(
            [
                "valgrind",
                "--tool=callgrind",
                "--collect-atstart=no",
                "--toggle-collect=measured_step",
                f"--callgrind-out-file={counts}",
                program,
                case,
                start,
            ],
            capture_output=True,
            text=True,
            check=False,
        )
        if ran.returncode != 0:
            sys.exit(f"{program} {case} {start}: {ran.stderr}")
        found = re.search(r"^(?:summary|totals): (\d+)", counts.read_text(), re.MULTILINE)
    assert found, "callgrind wrote no sum"
    numbers: Numbers = {}
    for line in ran.stdout.splitlines():
        name, value = line.split()
        numbers.setdefault(name, []).append(float(value))
    return numbers, int(found[1])


def differences(name: str, with_physics: float, without: float) -> str:
    """One row of the table."""
    share = with_physics / without - 1 if without else float(with_physics != 0)
    mark = "" if abs(share) <= LIMIT else f"  more than {LIMIT:.0%}"
    return f"  {name:<24} {with_physics:>14,.0f} {without:>14,.0f} {share:>+9.3%}{mark}"


def compare(case: str, start: str, runs: list[Run]) -> bool:
    """Prints one case's costs; whether they and the solutions are equal."""
    (a, instructions), (b, plain_instructions) = (ran.result() for ran in runs)
    rows = [differences("instructions", instructions, plain_instructions)]
    if start == "cold":
        for name in ("described", "allocated"):
            rows.append(differences(f"bytes, {name}", a[name][0], b[name][0]))
    print(f"{case}, {start}: {a['newton'][0]:.0f} Newton steps")
    print("\n".join(rows))
    if instructions < 10_000 or a["status"] != [0.0]:
        print("  nothing was solved")
        return False
    same = all(a[name] == b[name] for name in ("status", "newton", "force"))
    if not same:
        print(f"  the solutions differ: {a} and {b}")
    return same and not any("more than" in row for row in rows)


def check_refusals(programs: tuple[str, str]) -> bool:
    """The build with physics takes every scene, the other one names the field it cannot have."""
    taken, refused = (
        [
            line.split(": ", 1)
            for line in subprocess.run([p], capture_output=True, text=True, check=True)
            .stdout.strip()
            .splitlines()
        ]
        for p in programs
    )
    good = all(answer == "created" for _, answer in taken) and refused[0][1] == "created"
    good = good and all("this build" in text and text.startswith(f) for f, text in refused[1:])
    if not good:
        print(f"scenes taken and refused: {taken} and {refused}")
    return good


def main() -> int:
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    programs = (sys.argv[1], sys.argv[2])
    print(f"{'':<26} {'with':>14} {'without':>14}")
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        runs = {
            (case, start): [pool.submit(run, program, case, start) for program in programs]
            for case in CASES
            for start in STARTS
        }
        good = [compare(*key, found) for key, found in runs.items()]
    good.append(check_refusals(programs))
    return 0 if all(good) else 1


if __name__ == "__main__":
    sys.exit(main())
