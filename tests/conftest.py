"""What all tests share."""

from __future__ import annotations

from collections.abc import Iterator
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
