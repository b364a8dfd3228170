"""The core as a library whose objects can be exchanged, and the tests that load it."""

from __future__ import annotations

import json
import os
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
# of the Python tests: those of the core's physics and contracts
FOLDERS = ("analytic", "published", "property", "equivalence", "mbs", "rig", "profiles", "case")
LIBRARY = "librailpatch_static.so"
OPTIMISED = "-O1 -DNDEBUG"
# of what a test takes by itself, in processor time: a mutant that takes longer has fallen
PATIENCE = 5
QUICK = 0.02  # s
QUIET = ("--gtest_fail_fast", "--gtest_brief=1")


@dataclass(frozen=True)
class Suite:
    """Some tests of a C++ program, or a file of Python tests."""

    name: str
    source: Path
    program: Path | None = None  # None: pytest
    tests: str = "*"  # of a program
    seconds: float = 0.0  # of processor time
    most: float = 0.0  # the same of all that it shares its preparations with


class Failed(Exception):
    """The build or the tests fail without any mutant."""


def run(command: list[str] | str, **options) -> str:
    """The output of a command that has to succeed."""
    done = subprocess.run(
        command,
        shell=isinstance(command, str),
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        **options,
    )
    if done.returncode:
        raise Failed(f"{command}\n{done.stdout[-4000:]}")
    return done.stdout


@dataclass(frozen=True)
class Ended:
    """How a test ended."""

    passed: bool
    output: str
    seconds: float  # of processor time


def limited(command: list[str], environment: dict, seconds: float) -> Ended:
    """Runs a test within its processor time."""

    def limit() -> None:
        most = int(seconds) + 1
        resource.setrlimit(resource.RLIMIT_CPU, (most, most + 1))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))

    with tempfile.TemporaryFile() as output:
        done = subprocess.Popen(
            command,
            cwd=ROOT,
            env=environment,
            preexec_fn=limit,
            start_new_session=True,
            stdin=subprocess.DEVNULL,
            stdout=output,
            stderr=subprocess.STDOUT,
        )
        # one that waits for another thread takes no processor time
        timer = threading.Timer(120 + 20 * seconds, os.killpg, (done.pid, signal.SIGKILL))
        timer.start()
        _, status, usage = os.wait4(done.pid, 0)
        timer.cancel()
        done.returncode = os.waitstatus_to_exitcode(status)
        output.seek(0)
        text = output.read().decode(errors="replace")
    return Ended(done.returncode == 0, text, usage.ru_utime + usage.ru_stime)


class Build:
    """The base build in `folder`."""

    def __init__(self, folder: Path, jobs: int, python: bool = True) -> None:
        self.folder = folder
        self.jobs = jobs
        self.python = python  # its tests too
        self.base = folder / "base"
        self.package = folder / "package"
        self.texts: dict[Path, str] = {}  # of tests

    # --- build -----------------------------------------------------------------------------------

    def make(self) -> None:
        """Builds the core, the C++ tests and the Python package around them."""
        environment = os.environ | {"LD_LIBRARY_PATH": str(self.base / "core")}
        run(
            [
                *("cmake", "-S", str(ROOT), "-B", str(self.base), "-G", "Ninja"),
                *("-DCMAKE_BUILD_TYPE=Release", f"-DCMAKE_CXX_FLAGS_RELEASE={OPTIMISED}"),
                *("-DRAILPATCH_MUTANTS=ON", "-DRAILPATCH_WERROR=OFF", "-DRAILPATCH_FMU=ON"),
                *("-DRAILPATCH_PYTHON=ON", "-DCMAKE_SKIP_RPATH=ON"),
                *("-DCMAKE_EXPORT_COMPILE_COMMANDS=ON", f"-DPython_EXECUTABLE={sys.executable}"),
            ]
        )
        targets = [] if self.python else ["--target", "tests/all"]
        build = ["cmake", "--build", str(self.base), "-j", str(self.jobs), *targets]
        run(build, env=environment)
        entries = json.loads((self.base / "compile_commands.json").read_text())
        self.commands = {
            Path(entry["file"]): entry["command"]
            for entry in entries
            if "_eigen" not in entry["command"]
        }
        link = run(["ninja", "-C", str(self.base), "-t", "commands", f"core/{LIBRARY}"])
        self.link = link.strip().split("\n")[-1]
        self.objects = {
            source: match[1]
            for source, command in self.commands.items()
            if source.is_relative_to(ROOT / "core")
            and (match := re.search(r" -o (\S+)", command))
            and match[1] in self.link
        }
        self.dependencies = self._dependencies()
        if self.python:
            self._make_package()

    def _dependencies(self) -> dict[str, set[Path]]:
        """The project's headers that each object was made from."""
        found: dict[str, set[Path]] = {}
        name = ""
        for line in run(["ninja", "-C", str(self.base), "-t", "deps"]).split("\n"):
            if line.startswith(" "):
                path = (self.base / line.strip()).resolve()
                if path.is_relative_to(ROOT):
                    found[name].add(path)
            elif line:
                name = line.split(":")[0]
                found[name] = set()
        return found

    def _make_package(self) -> None:
        """The installed package with an extension module that loads the core."""
        where = "from importlib.util import find_spec; print(find_spec('railpatch').origin)"
        installed = Path(run([sys.executable, "-c", where], cwd="/").strip()).parent
        shutil.rmtree(self.package, ignore_errors=True)
        to = self.package / "railpatch"
        shutil.copytree(installed, to, ignore=shutil.ignore_patterns("_core*.so", "__pycache__"))
        (module,) = self.base.glob("plugins/python_mbs/_core*.so")
        shutil.copy(module, to / module.name)

    def compile(
        self, source: Path, output: Path, flags: str = "", text: Path | None = None
    ) -> bool:
        """Compiles a file of the base build, or `text` in its place; whether it compiles."""
        command = self.commands[source]
        command = re.sub(r" -o \S+", f" -o {output}", command).replace("ccache ", "", 1)
        command = command.replace(f" -c {source}", f" -c {text or source}")
        command = re.sub(r"(^\S+)", rf"\1 {flags}", command, count=1)
        output.parent.mkdir(parents=True, exist_ok=True)
        done = subprocess.run(command, shell=True, cwd=self.base, capture_output=True, timeout=600)
        return done.returncode == 0

    def link_library(self, folder: Path, instead: dict[str, Path], flags: str = "") -> None:
        """The core with other objects in the place of some of the base build's."""
        folder.mkdir(parents=True, exist_ok=True)
        words = [str(instead.get(word, word)) for word in self.link.split()]
        command = " ".join(words).replace(f"-o core/{LIBRARY}", f"-o {folder / LIBRARY} {flags}")
        run(command, cwd=self.base)

    def concerns(self, test: Path, source: Path) -> bool:
        """Whether a test is named after a source of the core or includes its header."""
        if test.stem == f"test_{source.stem}":
            return True
        if test not in self.texts:
            self.texts[test] = test.read_text()
        return f'/{source.stem}.hpp"' in self.texts[test]

    # --- tests -----------------------------------------------------------------------------------

    def programs(self) -> list[Suite]:
        """The C++ tests."""
        tests = self.base / "tests"
        cpp = [
            Suite(path.stem, path, tests / path.stem)
            for path in sorted((ROOT / "tests/cpp").glob("test_*.cpp"))
        ]
        fmu = [
            Suite(f"test_fmu_{path.stem[5:]}", path, tests / f"test_fmu_{path.stem[5:]}")
            for path in sorted((ROOT / "tests/fmu").glob("test_*.cpp"))
        ]
        return cpp + fmu

    def modules(self) -> list[Suite]:
        """The Python tests."""
        return [
            Suite(str(path.relative_to(ROOT)), path)
            for folder in FOLDERS
            for path in sorted((ROOT / "tests" / folder).glob("test_*.py"))
        ]

    def suites(self) -> list[Suite]:
        """All tests with their times, the quickest first. Of a program what is quick goes together,
        and each slow test by itself."""
        with ThreadPoolExecutor(self.jobs) as pool:
            cpp = [part for parts in pool.map(self._parts, self.programs()) for part in parts]
            modules = list(pool.map(self._timed, self.modules() if self.python else []))
        return sorted(cpp, key=lambda s: s.seconds) + sorted(modules, key=lambda s: s.seconds)

    def _timed(self, suite: Suite) -> Suite:
        ended, failed = self.test([suite], self.base / "core", 600)
        if not ended.passed:
            raise Failed(f"without any mutant: {failed}\n{ended.output[-2000:]}")
        return replace(suite, seconds=ended.seconds, most=ended.seconds)

    def _parts(self, suite: Suite) -> list[Suite]:
        with tempfile.TemporaryDirectory() as folder:
            output = Path(folder) / "tests.json"
            environment = self.environment(self.base / "core") | {"GTEST_OUTPUT": f"json:{output}"}
            ended = limited([str(suite.program), "--gtest_brief=1"], environment, 600)
            if not ended.passed:
                raise Failed(f"without any mutant: {suite.name}\n{ended.output[-2000:]}")
            suites = json.loads(output.read_text())["testsuites"]
        times = {
            f"{test['classname']}.{test['name']}": float(test["time"].rstrip("s"))
            for group in suites
            for test in group["testsuite"]
        }
        # processor time, where other processes are in the way
        scale = ended.seconds / max(sum(times.values()), ended.seconds, 1e-3)
        times = {name: scale * seconds for name, seconds in times.items()}
        quick = [name for name, seconds in times.items() if seconds < QUICK]
        slow = [name for name, seconds in times.items() if seconds >= QUICK]
        suite = replace(suite, most=ended.seconds)
        parts = [
            replace(suite, name=f"{suite.name} {name}", tests=name, seconds=times[name])
            for name in slow
        ]
        if quick:
            spent = sum(times[name] for name in quick)
            but = f"-{':'.join(slow)}" if slow else "*"
            parts.append(replace(suite, tests=but, seconds=spent))
        return parts

    def environment(self, library: Path) -> dict:
        """In which tests load the core of a folder."""
        return os.environ | {
            "LD_LIBRARY_PATH": str(library),
            "PYTHONPATH": str(self.package),
            "PYTHONDONTWRITEBYTECODE": "1",
            "OMP_NUM_THREADS": "1",
            "OPENBLAS_NUM_THREADS": "1",
        }

    def test(
        self,
        suites: list[Suite],
        library: Path,
        seconds: float,
        programs: dict[str, Path] | None = None,
    ) -> tuple[Ended, str]:
        """One C++ program or some files of Python tests, until one fails; its name."""
        environment = self.environment(library)
        if suites[0].program:
            (suite,) = suites
            program = (programs or {}).get(suite.source.stem, suite.program)
            command = [str(program), f"--gtest_filter={suite.tests}", *QUIET]
            ended = limited(command, environment, seconds)
            failed = re.search(r"\[  FAILED  \] ([^\s,]+)", ended.output)
            return ended, failed[1] if failed else f"{suite.name} stops"
        command = [
            sys.executable,
            "-m",
            "pytest",
            "-x",
            "-q",
            "-p",
            "no:cacheprovider",
            "--no-header",
        ]
        command += ["--tb=no", *(suite.name for suite in suites)]
        ended = limited(command, environment, seconds)
        failed = re.search(r"^(?:FAILED|ERROR) (\S+)", ended.output, re.M)
        return ended, failed[1] if failed else f"tests/ stop: {ended.output[-300:]}"
