"""The same bits on every processor: natively, what libraries may use switched off, and emulated.

``hashes.py --sample N`` solves N cases of every kind, method, regime and law.
"""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
import railpatch._core
from bits import interface
from bits.combinations import sample
from bits.hashes import changes, plain

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
# what the C library, numpy and OpenBLAS may use of a processor, switched off
PLAIN = {
    "GLIBC_TUNABLES": "glibc.cpu.hwcaps=-AVX2,-FMA,-FMA4,-AVX,-AVX512F",
    "OPENBLAS_CORETYPE": "Nehalem",
}
# steps.c: `make test-python` and `make test-long` build it
PROGRAM = ROOT / "build" / "release" / "tests" / "bits" / "bits_steps"
FUNCTIONS = (
    "a?sinh?|a?cosh?|a?tanh?|atan2|sincos|exp2?|exp10|expm1|log|log2|log10|log1p|pow|cbrt|hypot"
    "|erfc?|[lt]gamma|fma"
)


def found(
    path: Path, count: int, *emulator: str, environment: dict[str, str] | None = None
) -> dict[str, str]:
    """Case -> hash of its results, or how it was refused."""
    command = [*emulator, sys.executable, str(HERE / "hashes.py"), "--sample", str(count)]
    settings = {**os.environ, "OPENBLAS_NUM_THREADS": "1", **(environment or {})}
    done = subprocess.run(
        [*command, "-o", str(path)], env=settings, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    return json.loads(path.read_text())


def dispatched() -> str:
    """numpy's names of what it chooses by the processor here."""
    umath = sys.modules["numpy"]._core._multiarray_umath
    features = umath.__cpu_features__
    return " ".join(name for name in umath.__cpu_dispatch__ if features.get(name))


def test_results_do_not_hang_on_what_libraries_use(tmp_path: Path) -> None:
    plain = {**PLAIN, "NPY_DISABLE_CPU_FEATURES": dispatched()}
    here = found(tmp_path / "here.json", 80)
    there = found(tmp_path / "there.json", 80, environment=plain)
    solved = sum(not text.startswith("refused") for text in here.values())
    assert solved > 40
    assert {name: text for name, text in there.items() if here[name] != text} == {}


@pytest.fixture(scope="session")
def program() -> Path:
    assert PROGRAM.exists(), f"{PROGRAM} is missing: cmake --build build/release -t bits_steps"
    return PROGRAM


@pytest.fixture(scope="session")
def cases(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A third of those with one feature or none."""
    return interface.write(tmp_path_factory.mktemp("bits"), sample(0)[::3])


def numbers_of(value: Any) -> set[str]:
    """All numbers of a result, in hexadecimal."""
    if isinstance(value, dict):
        return set().union(*(numbers_of(item) for k, item in value.items() if k != "wall_time"))
    if isinstance(value, list):
        return set().union(*(numbers_of(item) for item in value))
    return {value.hex()} if isinstance(value, float) else set()


def test_c_interface_gives_what_python_gives(cases: Path, program: Path) -> None:
    """To the bit: every number of Python's results, fields included, is among those of C."""
    lines = interface.run([program], cases)
    assert len(lines) >= 30
    named = dict(sample(0))
    for number, line in list(enumerate(lines))[::3]:
        name, outcome, _ = line.split(" | ")
        contact, expected, statuses = railpatch.Contact(named[name]), set(), []
        for step in range(3):
            result = plain(contact.step(**changes(named[name], step), fields=True))
            statuses.append(result["status"])
            expected |= numbers_of(result)
        assert outcome.split(",")[:3] == statuses  # rates follow
        printed = interface.run([program], cases, str(number))
        found = {float.fromhex(text).hex() for text in printed}
        assert len(expected) > 100
        assert expected - found == set(), name


def test_c_interface_does_not_hang_on_what_the_c_library_uses(
    cases: Path, program: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    here = interface.run([program], cases)
    for name, value in PLAIN.items():
        monkeypatch.setenv(name, value)
    assert interface.differing(here, interface.run([program], cases)) == []


def test_no_function_of_c_is_called() -> None:
    """Neither by the sources nor by the library, but for those that are exact."""
    called = re.compile(rf"std::({FUNCTIONS})\(")
    paths = [p for folder in ("core", "plugins") for p in (ROOT / folder).rglob("*.[ch]pp")]
    assert len(paths) > 100
    lines = [
        f"{path.relative_to(ROOT)}: {match.group()}"
        for path in paths
        for match in called.finditer(path.read_text(encoding="utf-8"))
    ]
    assert lines == []
    libraries = [Path(railpatch._core.__file__)]
    libraries += (Path(railpatch.__file__).parent / "fmu" / "lib").rglob("*_eigen.so")
    assert len(libraries) == 3  # the module, the FMUs of both versions
    imported = re.compile(rf" U (({FUNCTIONS})[fl]?)(@|$)", re.MULTILINE)
    for path in libraries:
        names = subprocess.run(
            ["nm", "-D", "--undefined-only", path], capture_output=True, text=True, check=True
        ).stdout
        assert " U " in names
        assert [match[0] for match in imported.findall(names)] == []


def emulated() -> str:
    """QEMU's program."""
    emulator = shutil.which("qemu-x86_64")
    assert emulator is not None, "qemu-x86_64 is missing: apt install qemu-user"
    return emulator


@pytest.mark.long
@pytest.mark.parametrize("processor", ["Nehalem", "Haswell", "EPYC"])
def test_c_interface_gives_the_same_on_emulated_processors(
    tmp_path: Path, program: Path, processor: str
) -> None:
    cases = interface.write(tmp_path, sample(800), 200)
    here = interface.run([program], cases)
    there = interface.run([emulated(), "-cpu", processor, program], cases)
    assert interface.differing(here, there) == []


@pytest.mark.long
@pytest.mark.parametrize("processor", ["Nehalem", "Haswell", "EPYC"])
def test_results_are_the_same_on_emulated_processors(tmp_path: Path, processor: str) -> None:
    """200 cases; Nehalem knows neither AVX nor FMA."""
    emulator = emulated()
    here = found(tmp_path / "here.json", 200)
    there = found(tmp_path / "there.json", 200, emulator, "-cpu", processor)
    assert {name: text for name, text in there.items() if here[name] != text} == {}
