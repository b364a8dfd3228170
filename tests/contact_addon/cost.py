"""What a step by the add-on's calls costs beside the same step by railpatch.h, in instructions:
python cost.py PROGRAM (built from cost.cpp). Needs valgrind."""

from __future__ import annotations

import re
import subprocess
import sys
import tempfile
from pathlib import Path

MOST = 0.03
STEPS = (5, 15)


def counted(program: str, way: str, steps: int) -> tuple[int, str]:
    """Instructions of a run, and what it printed."""
    with tempfile.TemporaryDirectory() as folder:
        tool = ("valgrind", "--tool=callgrind", f"--callgrind-out-file={Path(folder) / 'out'}")
        done = subprocess.run(
            [*tool, program, way, str(steps)], capture_output=True, text=True, check=True
        )
    found = re.search(r"Collected : (\d+)", done.stderr)
    assert found is not None, done.stderr
    return int(found[1]), done.stdout


def main() -> int:
    """0 where the difference is allowed and the results are the same bits."""
    runs = {way: [counted(sys.argv[1], way, n) for n in STEPS] for way in ("addon", "core")}
    a_step = {way: (two[0] - one[0]) / (STEPS[1] - STEPS[0]) for way, (one, two) in runs.items()}
    more = a_step["addon"] / a_step["core"] - 1
    same = runs["addon"][1][1] == runs["core"][1][1]
    print(f"contact_addon: {more:+.3%} instructions a step, allowed {MOST:.0%}; same bits: {same}")
    return 0 if more < MOST and same else 1


if __name__ == "__main__":
    raise SystemExit(main())
