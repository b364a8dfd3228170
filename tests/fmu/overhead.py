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


def instructions(program: str, scene: str) -> tuple[int, int]:
    """Of the FMU's functions with all that they call, and of rp_step within them; the solve at the
    start is in none of them."""
    with tempfile.TemporaryDirectory() as folder:
        counts = Path(folder) / "counts"
        command = ["valgrind", "--tool=callgrind", "--quiet", f"--callgrind-out-file={counts}"]
        command += ["--collect-atstart=no", *(f"--toggle-collect={name}" for name in OF_FMU)]
        subprocess.run([*command, program, scene, str(STEPS)], check=True)
        whole = re.search(r"^(?:summary|totals): (\d+)", counts.read_text(), re.MULTILINE)
        listed = subprocess.run(
            ["callgrind_annotate", "--inclusive=yes", "--threshold=100", str(counts)],
            check=True,
            capture_output=True,
            text=True,
        ).stdout
    # a line for each function: number, share, file:function [object]
    step = re.search(r"^ *([\d,]+) .*:rp_step(?: |$)", listed, re.MULTILINE)
    assert whole, "callgrind wrote no sum"
    assert step, "no step was counted"
    return int(whole[1]), int(step[1].replace(",", ""))


def share(scene: str, found: tuple[int, int]) -> float:
    """Of what the FMU adds; prints a line."""
    whole, solve = found
    added = whole / solve - 1
    print(f"FMU, {scene}: {solve // STEPS:,} instructions a step, {added:.2%} beside them")
    return added


def main() -> None:
    """Both scenes."""
    scenes = ("patch", "rail")
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        found = list(pool.map(lambda scene: instructions(sys.argv[1], scene), scenes))
    worst = max(share(*one) for one in zip(scenes, found, strict=True))
    if worst > SHARE:
        sys.exit(f"FMU: {worst:.2%} of a step, allowed {SHARE:.0%}")


if __name__ == "__main__":
    main()
