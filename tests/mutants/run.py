"""Do the tests bite? Puts one-token changes into the core, one at a time, and reports which of them
no test notices."""

from __future__ import annotations

import argparse
import json
import random
import subprocess
import sys
import threading
import time
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict
from pathlib import Path

from sites import Mutant, all_mutants
from workshop import PATIENCE, ROOT, Build, Failed, Suite

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

EQUIVALENT = Path(__file__).with_name("equivalent.toml")


class Worker:
    """One mutant at a time: its objects, its library, its tests."""

    def __init__(self, build: Build, suites: list[Suite], folder: Path) -> None:
        self.build = build
        self.suites = suites
        self.folder = folder

    def judge(self, mutant: Mutant) -> dict | None:
        """What became of a mutant; None: it does not compile, or to the same object."""
        begin = time.monotonic()
        source = ROOT / mutant.path
        text = self.folder / "text" / Path(mutant.path).relative_to("core")
        text.parent.mkdir(parents=True, exist_ok=True)
        text.write_text(mutant.applied(source.read_text()))
        try:
            objects = self._objects(source, text)
        finally:
            if source.suffix == ".cpp":
                text.unlink()
        if objects is None:
            text.unlink(missing_ok=True)
            return None
        library = self.folder / "library"
        self.build.link_library(library, objects)
        fallen = self._fallen(mutant, library)
        text.unlink(missing_ok=True)
        return {
            **asdict(mutant),
            "fallen": fallen,
            "seconds": round(time.monotonic() - begin, 1),
        }

    def _objects(self, source: Path, text: Path) -> dict[str, Path] | None:
        """The objects that the change alters."""
        header = source.suffix == ".hpp"
        overlay = f"-I{self.folder / 'text'}" if header else ""
        changed = {}
        for user, name in self.build.objects.items():
            if user != source and source not in self.build.dependencies[name]:
                continue
            output = self.folder / "objects" / f"{user.stem}.o"
            if not self.build.compile(user, output, overlay, None if header else text):
                return None
            if stripped(output) != stripped(self.build.base / name):
                changed[name] = output
        return changed or None

    def _fallen(self, mutant: Mutant, library: Path) -> str | None:
        """The first test that notices."""
        source = ROOT / mutant.path
        programs: dict[str, Path] = {}
        cpp = [suite for suite in self.suites if suite.program]
        # those that know the file come first
        cpp.sort(key=lambda suite: not self.build.concerns(suite.source, source))
        for suite in cpp:
            if failed := self._first(suite, library, programs):
                return failed
        if source.suffix == ".hpp":
            # tests have the header's functions in their own objects too
            for suite in cpp:
                if not self._rebuilt(suite, source, programs):
                    continue
                if failed := self._first(suite, library, programs):
                    return failed
        python = [suite for suite in self.suites if not suite.program]
        if python:
            seconds = PATIENCE * sum(suite.seconds for suite in python) + 10
            ended, failed = self.build.test(python, library, seconds)
            if not ended.passed:
                return failed
        return None

    def _first(self, suite: Suite, library: Path, programs: dict[str, Path]) -> str | None:
        seconds = PATIENCE * suite.most + 2
        ended, failed = self.build.test([suite], library, seconds, programs)
        return None if ended.passed else failed

    def _rebuilt(self, suite: Suite, header: Path, programs: dict[str, Path]) -> bool:
        """Whether a program was made anew because its own object has the header."""
        if suite.source.stem in programs:
            return True
        # in its own functions, not in what it includes in turn
        if f'#include "{header.parent.name}/{header.name}"' not in suite.source.read_text():
            return False
        command = self.build.commands[suite.source]
        name = command.split(" -o ")[1].split()[0]
        output = self.folder / "objects" / f"{suite.program.name}.o"
        if not self.build.compile(suite.source, output, f"-I{self.folder / 'text'}"):
            return False
        if stripped(output) == stripped(self.build.base / name):
            return False
        target = f"tests/{suite.program.name}"
        link = (
            subprocess.run(
                ["ninja", "-C", str(self.build.base), "-t", "commands", target],
                capture_output=True,
                text=True,
                check=True,
            )
            .stdout.strip()
            .split("\n")[-1]
        )
        program = self.folder / "programs" / suite.program.name
        program.parent.mkdir(parents=True, exist_ok=True)
        link = link.replace(f" {name} ", f" {output} ").replace(f" -o {target} ", f" -o {program} ")
        subprocess.run(link, shell=True, cwd=self.build.base, check=True, capture_output=True)
        programs[suite.source.stem] = program
        return True


def stripped(path: Path) -> bytes:
    """An object without what names its source."""
    out = path.with_suffix(".stripped")
    if path.name.endswith(".cpp.o"):
        out = path.with_name(f"{path.name}.{threading.get_ident()}")
    subprocess.run(["objcopy", "--strip-debug", "-R", ".comment", str(path), str(out)], check=True)
    content = out.read_bytes()
    out.unlink()
    return content


def equivalents() -> dict[tuple[str, str, str], str]:
    """The mutants that nothing can notice: file, line and changed line, with the reason."""
    if not EQUIVALENT.exists():
        return {}
    entries = tomllib.loads(EQUIVALENT.read_text()).get("mutant", [])
    return {(Path(e["file"]).name, e["line"], e["instead"]): e["reason"] for e in entries}


def drawn(seed: int) -> list[Mutant]:
    """All mutants in the seed's order, one for each token."""
    order = random.Random(seed)
    tokens = all_mutants(ROOT)
    order.shuffle(tokens)
    return [order.choice(token) for token in tokens]


def survivors(run: Path) -> list[Mutant]:
    """Those of a kept run, wherever their lines are now."""
    former = [r for r in json.loads(run.read_text()).values() if r and not r["fallen"]]
    left = [(r["before"], r["after"]) for r in former]
    found = []
    for token in all_mutants(ROOT):
        for mutant in token:
            if (mutant.before, mutant.after) in left:
                left.remove((mutant.before, mutant.after))
                found.append(mutant)
    for before, after in left:
        print(f"is no more:\n  - {before}\n  + {after}")
    return found


def judged(
    build: Build, suites: list[Suite], candidates: list[Mutant], count: int, kept: Path
) -> list[dict]:
    """The first `count` mutants of the candidates and what became of them."""
    results: dict[int, dict | None] = {}
    if kept.exists():
        results = {int(k): v for k, v in json.loads(kept.read_text()).items()}
    lock = threading.Lock()
    free = list(range(build.jobs))

    def enough() -> bool:
        # all before the last that counts are judged
        return sum(1 for result in results.values() if result) >= count

    def one(at: int) -> None:
        with lock:
            if at in results or enough():
                return
            number = free.pop()
        try:
            result = Worker(build, suites, build.folder / f"worker{number}").judge(candidates[at])
        finally:
            with lock:
                free.append(number)
        with lock:
            results[at] = result
            kept.write_text(json.dumps(results, indent=0))
            if result:
                done = [r for r in results.values() if r]
                fell = sum(1 for r in done if r["fallen"])
                place = f"{result['path']}:{result['line']}"
                print(f"{fell}/{len(done)}  {place}  {result['fallen'] or 'SURVIVES'}", flush=True)
                if not result["fallen"]:
                    print(f"  - {result['before']}\n  + {result['after']}", flush=True)

    with ThreadPoolExecutor(build.jobs) as pool:
        list(pool.map(one, range(min(len(candidates), 4 * count))))
    return [results[at] for at in sorted(results) if results[at]][:count]


def report(results: list[dict], name: str) -> tuple[str, float]:
    """In words, and the share that fell."""
    reasons = equivalents()
    fallen = [r for r in results if r["fallen"]]
    rest = [r for r in results if not r["fallen"]]
    lines = [
        f"{name}: {len(fallen)} of {len(results)} mutants fell "
        f"({100 * len(fallen) / len(results):.1f} %)"
    ]
    by_kind = Counter("C++" if not r["fallen"].startswith("tests/") else "Python" for r in fallen)
    lines.append("  by " + ", ".join(f"{kind} tests {n}" for kind, n in sorted(by_kind.items())))
    rooms = Counter(Path(r["path"]).parts[1] for r in results)
    lost = Counter(Path(r["path"]).parts[1] for r in rest)
    lines += [f"  {room:<12} {n - lost[room]:3} of {n}" for room, n in sorted(rooms.items())]
    listed, open_ = [], []
    for r in rest:
        reason = reasons.get((Path(r["path"]).name, r["before"], r["after"]))
        (listed if reason else open_).append((r, reason))
    for title, part in (("listed as equivalent", listed), ("survivors", open_)):
        lines.append(f"{title}: {len(part)}")
        for r, reason in part:
            lines.append(f"  {r['path']}:{r['line']}\n    - {r['before']}\n    + {r['after']}")
            if reason:
                lines.append(f"    {reason}")
    return "\n".join(lines), len(fallen) / len(results)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, nargs="+", default=[1, 2])
    parser.add_argument("--count", type=int, default=300)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--least", type=float, default=0.95, help="share that has to fall")
    parser.add_argument("-o", "--output", type=Path, default=ROOT / "build/mutants")
    parser.add_argument(
        "--continue", dest="resume", action="store_true", help="keep what is judged"
    )
    parser.add_argument("--cpp", action="store_true", help="C++ tests alone")
    parser.add_argument("--again", type=Path, help="judge the survivors of a kept run again")
    parser.add_argument("--only", default="", help="files whose path holds this")
    arguments = parser.parse_args()
    build = Build(arguments.output, arguments.jobs, not arguments.cpp)
    try:
        build.make()
        suites = build.suites()
    except Failed as error:
        print(error, file=sys.stderr)
        return 2
    only = f"_{arguments.only}".replace("/", "_") if arguments.only else ""
    runs = {f"seed_{seed}{only}": drawn(seed) for seed in arguments.seeds}
    if arguments.again:
        runs = {f"{arguments.again.stem}_again": survivors(arguments.again)}
    bad = False
    for name, candidates in runs.items():
        candidates = [
            m
            for m in candidates
            if (m.path.endswith(".hpp") or ROOT / m.path in build.objects)
            and arguments.only in m.path
        ]
        kept = arguments.output / f"{name}.json"
        if not arguments.resume:
            kept.unlink(missing_ok=True)
        results = judged(build, suites, candidates, arguments.count, kept)
        text, share = report(results, name)
        kept.with_suffix(".txt").write_text(text + "\n")
        print(text, flush=True)
        bad = bad or share < arguments.least
    return int(bad)


if __name__ == "__main__":
    sys.exit(main())
