"""What the FMU adds to a step of the full theory, in instructions: python overhead.py PROGRAM

PROGRAM is fmu_overhead, run under valgrind. Exit code 1 where it adds more than the share below.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

SHARE = 0.03
STEPS = 50
OF_FMU = ("fmi2SetReal", "fmi2DoStep", "fmi2GetReal")


def instructions(program: str, scene: str, steps: int, functions: tuple[str, ...]) -> int:
    """Of these functions with all that they call."""
    with tempfile.TemporaryDirectory() as folder:
        counts = Path(folder) / "counts"
        command = ["valgrind", "--tool=callgrind", "--quiet", f"--callgrind-out-file={counts}"]
        command += ["--collect-atstart=no", *(f"--toggle-collect={name}" for name in functions)]
        subprocess.run([*command, program, scene, str(steps)], check=True)
        found = re.search(r"^(?:summary|totals): (\d+)", counts.read_text(), re.MULTILINE)
    assert found, "callgrind wrote no sum"
    return int(found[1])


def share(program: str, scene: str, pool: ThreadPoolExecutor) -> float:
    """Of what the FMU adds; prints a line."""
    # the solve at the start is no step
    counts = [(0, ("rp_step",)), (STEPS, ("rp_step",)), (STEPS, OF_FMU)]
    runs = [pool.submit(instructions, program, scene, *one) for one in counts]
    start, solve, whole = (run.result() for run in runs)
    solve -= start
    added = whole / solve - 1
    print(f"FMU, {scene}: {solve // STEPS:,} instructions a step, {added:.2%} beside them")
    return added


def main() -> None:
    """Both scenes."""
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        worst = max(share(sys.argv[1], scene, pool) for scene in ("patch", "rail"))
    if worst > SHARE:
        sys.exit(f"FMU: {worst:.2%} of a step, allowed {SHARE:.0%}")


if __name__ == "__main__":
    main()
