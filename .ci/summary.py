"""Prints what the parts of `make test` took, the slowest tests, and how many passed.

Usage: summary.py PARTS JUNIT..., PARTS as .ci/part writes it. A line for each part, for each of the
slowest tests of all JUnit files, and for each JUnit file: how many passed, failed, were skipped.
"""

import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

SLOWEST = 10
BESIDE = ", beside"  # parts that run while others do


def cases(path: Path) -> list[ElementTree.Element]:
    """All test cases of a JUnit file."""
    return list(ElementTree.parse(path).getroot().iter("testcase"))


def count(path: Path) -> tuple[int, int, int]:
    """Passed, failed and skipped test cases of one JUnit file."""
    passed = failed = skipped = 0
    for case in cases(path):
        if case.find("failure") is not None or case.find("error") is not None:
            failed += 1
        elif case.find("skipped") is not None:
            skipped += 1
        else:
            passed += 1
    return passed, failed, skipped


def print_parts(path: Path) -> None:
    """Seconds by the clock, their share, seconds of the processors."""
    parts = [line.split("\t") for line in path.read_text().splitlines()]
    rows = [(name, float(clock), float(processors)) for name, clock, processors in parts]
    clock = sum(row[1] for row in rows if not row[0].endswith(BESIDE))
    total = ("together", clock, sum(row[2] for row in rows))
    print(f"  {'part':<24} {'s':>6}  share  s of processors")
    for name, clock, processors in (*rows, total):
        share = "" if name.endswith(BESIDE) else f"{clock / max(total[1], 1e-9):.0%}"
        print(f"  {name:<24} {clock:>6.0f}  {share:>5}  {processors:>6.0f}")


def print_slowest(paths: list[Path]) -> None:
    """Seconds, JUnit file, test."""
    found = [
        (float(case.get("time", 0)), path.stem, case) for path in paths for case in cases(path)
    ]
    found.sort(key=lambda one: -one[0])
    print(f"  the {SLOWEST} slowest tests")
    for seconds, stem, case in found[:SLOWEST]:
        name, group = case.get("name", ""), case.get("classname", "")
        full = name if group in ("", name) else f"{group}::{name}"
        print(f"  {seconds:>6.1f} s  {stem:<7} {full}")


def main() -> int:
    times, *junit = map(Path, sys.argv[1:])
    print_parts(times)
    print_slowest(junit)
    bad = 0
    for path in junit:
        passed, failed, skipped = count(path)
        bad += failed
        rest = [f"{n} {word}" for n, word in ((failed, "failed"), (skipped, "skipped")) if n]
        print(f"  {path.stem:<24} {', '.join([f'{passed} passed', *rest])}")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
