"""Cases for steps.c, which solves them by the C interface, and what it prints.

    python tests/bits/interface.py -o FOLDER --sample 200   writes them
    python tests/bits/interface.py --compare A.txt B.txt    which lines of two outputs differ

What Python prepares of profiles and shapes is in the file: the same numbers for every system.
"""

from __future__ import annotations

import argparse
import struct
import subprocess
import sys
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

import numpy as np
from bits.combinations import Case, sample
from bits.hashes import changes, direction
from railpatch import CaseError, ProfileError, _core
from railpatch.case.creep_table import default_table
from railpatch.case.load import load_scene
from railpatch.case.moving import changed_case
from railpatch.case.to_core import config_of, input_of, rates_of

PROFILE = ("arc_length", "y", "z", "dy", "dz")
TABLE = "creep_table.bin"


def record(word: str, name: str = "", values: Any = ()) -> bytes:
    """One of steps.c."""
    numbers = np.asarray(values, dtype="<f8").ravel()
    return struct.pack("<4si120s", word.encode(), numbers.size, name.encode()) + numbers.tobytes()


def records(name: str, case: Case) -> Iterator[bytes]:
    """Of a case: the config, three steps, rates where it has them. Raises CaseError."""
    scene = load_scene(case)
    config = config_of(scene)
    steps = [scene.case]
    for step in (1, 2):
        steps.append(changed_case(steps[-1], changes(case, step)))
    assert "rail_sections" not in config
    yield record("case", name)
    for key, values in _core.config_numbers(config).items():
        yield record("conf", key, values)
    for body in ("wheel", "rail"):
        for side, profile in enumerate(config.get(body, ())):
            for part in PROFILE if profile is not None else ():
                yield record("arra", f"{body} {side} {part}", profile[part])
    for shape in ("runout", "rail_height"):
        for side, values in enumerate(config.get(shape, ())):
            if values is not None and len(values):
                yield record("arra", f"{shape} {side}", values)
    if "undeformed_distance" in config:
        yield record("arra", "undeformed_distance", config["undeformed_distance"])
    for step in steps:
        for key, values in input_of(step).items():
            yield record("inpu", key, values)
        yield record("step")
    if scene.case.method.derivatives:
        for key, values in rates_of(steps[-1], direction(case)).items():
            yield record("rate", key, values)
        yield record("diff")
    yield record("done")


def write(folder: Path, cases: Iterable[tuple[str, Case]], count: int | None = None) -> Path:
    """The file of those that no check of Python's refuses, or of the first so many, and the creep
    table beside."""
    folder.mkdir(parents=True, exist_ok=True)
    path, written = folder / "cases.bin", 0
    with path.open("wb") as file:
        for name, case in cases:
            if written == count:
                break
            try:
                found = b"".join(records(name, case))
            except (CaseError, ProfileError):
                continue
            file.write(found)
            written += 1
    assert count is None or written == count
    (folder / TABLE).write_bytes(default_table().tobytes())
    return path


def run(program: Sequence[str | Path], cases: Path, *more: str, prefix: str = "") -> list[str]:
    """What steps.c prints of the cases; prefix: stands before a path."""
    paths = [f"{prefix}{path}" for path in (cases, cases.parent / TABLE)]
    done = subprocess.run(
        [*map(str, program), *paths, *more], capture_output=True, text=True, check=False
    )
    if done.returncode != 0:
        raise RuntimeError(f"failed: {program}\n{done.stdout[-500:]}{done.stderr[-2000:]}")
    return done.stdout.splitlines()


def differing(one: list[str], two: list[str]) -> list[tuple[int, str, str]]:
    """Number and lines of cases that differ."""
    if len(one) != len(two):
        return [(-1, f"{len(one)} cases", f"{len(two)} cases")]
    return [(k, a, b) for k, (a, b) in enumerate(zip(one, two, strict=True)) if a != b]


def main() -> int:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("-o", "--output", type=Path, metavar="FOLDER")
    parser.add_argument("--sample", type=int, default=200, metavar="N")
    parser.add_argument("--compare", nargs=2, type=Path, metavar="FILE")
    arguments = parser.parse_args()
    if arguments.output:
        print(write(arguments.output, sample(4 * arguments.sample), arguments.sample))
    if not arguments.compare:
        return 0
    one, two = (path.read_text(encoding="utf-8").splitlines() for path in arguments.compare)
    found = differing(one, two)
    for _, a, b in found:
        print(f"{a}\n  {b}")
    print(f"{len(one)} cases: {len(found)} differ")
    return min(len(found), 1)


if __name__ == "__main__":
    sys.exit(main())
