"""Prints one line for each JUnit file: how many tests passed, failed and were skipped."""

import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path


def count(path: Path) -> tuple[int, int, int]:
    """Passed, failed and skipped test cases of one JUnit file."""
    passed = failed = skipped = 0
    for case in ElementTree.parse(path).getroot().iter("testcase"):
        if case.find("failure") is not None or case.find("error") is not None:
            failed += 1
        elif case.find("skipped") is not None:
            skipped += 1
        else:
            passed += 1
    return passed, failed, skipped


def main() -> int:
    bad = 0
    for argument in sys.argv[1:]:
        path = Path(argument)
        passed, failed, skipped = count(path)
        bad += failed
        rest = [f"{n} {word}" for n, word in ((failed, "failed"), (skipped, "skipped")) if n]
        print(f"  {path.stem:<24} {', '.join([f'{passed} passed', *rest])}")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
