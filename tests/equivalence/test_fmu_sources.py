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
