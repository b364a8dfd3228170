"""Sources that an FMU carries are compiled as C++17: of C++20's library they need what stands in
plugins/fmu/cross/before_cxx20.hpp. `make fmu` compiles them; this finds the usual slips."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
BEFORE = (ROOT / "plugins/fmu/cross/before_cxx20.hpp").read_text()
SOURCES = [
    path
    for folder in ("core", "plugins/fmu/src")
    for path in sorted((ROOT / folder).rglob("*.[ch]pp"))
    if not path.name.endswith("_writer.cpp")
]


def test_the_numbers_are_declared() -> None:
    used = {
        name
        for path in SOURCES
        for name in re.findall(r"std::numbers::(\w+)", path.read_text())
        if not name.endswith("_v")
    }
    assert used
    assert used <= set(re.findall(r"constexpr double (\w+) =", BEFORE))


@pytest.mark.parametrize("word", ["std::ranges", "std::format", "std::bit_cast", "<=>", "co_await"])
def test_nothing_else_of_it(word: str) -> None:
    assert [str(path.relative_to(ROOT)) for path in SOURCES if word in path.read_text()] == []


def without_name(text: str) -> str:
    """What stands in the namespaces without a name of a source."""
    return "".join(
        re.findall(r"^namespace \{$.*?^\}  // namespace$", text, re.MULTILINE | re.DOTALL)
    )


def test_functions_with_clones_are_within_their_files() -> None:
    """GCC makes a function that chooses among clones; it is seen from outside, whatever is hidden,
    where the clones are not of their file alone."""
    texts = {path: path.read_text() for path in SOURCES if path.name != "simd.hpp"}
    users = {path: text for path, text in texts.items() if "RAILPATCH_DISPATCH" in text}
    assert len(users) > 5
    for path, text in users.items():
        own = without_name(text).count("RAILPATCH_DISPATCH")
        assert own == text.count("RAILPATCH_DISPATCH"), path.relative_to(ROOT)


def test_headers_of_the_system_stand_before_what_is_hidden() -> None:
    """A function of the system that is declared after it is taken for a hidden one of ours."""
    include = re.compile(r"#\s*include <([^>]+)>")
    packed = [path for path in SOURCES if path.name not in ("fft_fftw.cpp", "many.cpp")]
    used = {name for path in packed for name in include.findall(path.read_text())}
    # of Windows, and headers that are packed themselves
    others = {"windows.h", "unsupported/Eigen/FFT", "Eigen/Core"}
    assert used - others - set(include.findall(BEFORE)) == set()
