"""What the FMU adds to a step of the full theory, in instructions: python overhead.py PROGRAM

PROGRAM is fmu_overhead, run under valgrind. Exit code 1 where it adds more than the share below.
"""

from __future__ import annotations

import re
import subprocess
import sys
import tempfile
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


def share(program: str, scene: str) -> float:
    """Of what the FMU adds; prints a line."""
    # the solve at the start is no step
    start = instructions(program, scene, 0, ("rp_step",))
    solve = instructions(program, scene, STEPS, ("rp_step",)) - start
    added = instructions(program, scene, STEPS, OF_FMU) / solve - 1
    print(f"FMU, {scene}: {solve // STEPS:,} instructions a step, {added:.2%} beside them")
    return added


def main() -> None:
    """Both scenes."""
    worst = max(share(sys.argv[1], scene) for scene in ("patch", "rail"))
    if worst > SHARE:
        sys.exit(f"FMU: {worst:.2%} of a step, allowed {SHARE:.0%}")


if __name__ == "__main__":
    main()
