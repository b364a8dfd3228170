"""What a chain has found for an element is that element's alone."""

from __future__ import annotations

from typing import Any

from railpatch.pinocchio.derivative import StateChain


class Counted(StateChain):
    """Finds a new object each time; needs no model."""

    def __init__(self) -> None:
        self._found = {}

    def _make(self, element: Any, index: int) -> Any:
        return [type(element), index]


class Element:
    """Any element; a later one may stand where a former one stood."""


def test_each_element_has_its_own() -> None:
    chain = Counted()
    first = Element()
    assert chain.of(first, 0) is chain.of(first, 0)
    assert chain.of(first, 0) is not chain.of(first, 1)


def test_an_element_is_not_taken_for_one_that_is_gone() -> None:
    chain = Counted()
    found = [chain.of(Element(), 0) for _ in range(100)]
    assert len({id(one) for one in found}) == len(found)
