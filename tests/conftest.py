"""What all tests share."""

from __future__ import annotations

import zlib
from collections.abc import Callable, Iterator
from typing import Any

import pytest
from lark import Lark


@pytest.fixture(scope="session", autouse=True)
def names_parsed_once() -> Iterator[None]:
    """fmpy parses the name of each variable by a grammar, 10 ms each, whenever it reads a
    description: every name once a session. An illegal name raises each time."""
    parse, trees = Lark.parse, {}

    def parse_once(self: Any, text: str, *rest: Any, **options: Any) -> Any:
        key = (self.source_grammar, text, rest, *options.items())
        if key not in trees:
            trees[key] = parse(self, text, *rest, **options)
        return trees[key]

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Lark, "parse", parse_once)
        yield


@pytest.fixture(scope="session", autouse=True)
def archives_packed_quickly() -> Iterator[None]:
    """FMUs hold the same, a little larger: a tenth of a second each."""
    compressor = zlib.compressobj
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(zlib, "compressobj", lambda level=-1, *rest: compressor(1, *rest))
        yield


@pytest.fixture
def measured(record_property: Callable[[str, object], None]) -> Callable[[str], None]:
    """Takes a line on what a test found, for the JUnit file and the end of the run."""
    return lambda text: record_property("measured", text)


def pytest_terminal_summary(terminalreporter: Any) -> None:
    """Prints what tests measured, whichever process they ran in."""
    reports = terminalreporter.stats.get("passed", []) + terminalreporter.stats.get("failed", [])
    lines = [text for r in reports for name, text in r.user_properties if name == "measured"]
    if lines:
        terminalreporter.section("measured")
    for line in lines:
        terminalreporter.write_line(line)
