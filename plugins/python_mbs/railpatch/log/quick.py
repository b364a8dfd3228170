"""The quick way to encode: one pass over a dict, numbers checked all at once.

What is plainly right is taken; of anything else encode.py, which names places, decides.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np

from .channels import LEFT_OUT, Message

UINT32_MAX = 2**32 - 1
_NUMBER, _NUMBERS, _COUNT, _TEXT, _PART, _PARTS, _OTHER = range(7)
_NUMBER_TYPES = frozenset({float, int, np.float64})
_COUNT_TYPES = frozenset({int})


@dataclass(frozen=True)
class _Plan:
    """kinds: by field, its kind and what that needs. left_out: keys to pass by."""

    kinds: dict[str, tuple[int, Any]]
    required: frozenset[str]
    left_out: frozenset[str]


def quick(message: Message, values: Any) -> dict[str, Any] | None:
    """The arguments of the message's class, without what is None; None: look at it closely."""
    numbers: list[Any] = []
    counts: list[Any] = []
    found = _collect(_plan(message), values, numbers, counts)
    if found is None:
        return None
    # bool is none of the types; a sum is finite only where every number is
    if not _NUMBER_TYPES.issuperset(map(type, numbers)) or not math.isfinite(sum(numbers)):
        return None
    if counts and (
        not _COUNT_TYPES.issuperset(map(type, counts))
        or min(counts) < 0
        or max(counts) > UINT32_MAX
    ):
        return None
    return found


def _collect(
    plan: _Plan, values: Any, numbers: list[Any], counts: list[Any]
) -> dict[str, Any] | None:
    if type(values) is not dict:
        return None
    found: dict[str, Any] = {}
    for key, value in values.items():
        if value is None:
            if key in plan.kinds or key in plan.left_out:
                continue
            return None
        entry = plan.kinds.get(key)
        if entry is None:
            if key in plan.left_out:
                continue
            return None
        kind, detail = entry
        if kind == _NUMBER:
            numbers.append(value)
        elif kind == _COUNT:
            counts.append(value)
        elif kind == _PART:
            value = _collect(detail, value, numbers, counts)
            if value is None:
                return None
        elif type(value) is str:
            if kind != _TEXT or (detail and value not in detail):
                return None
        elif type(value) is not list:
            return None
        elif kind == _NUMBERS:
            if detail and len(value) != detail:
                return None
            numbers.extend(value)
        elif kind == _PARTS:
            value = [_collect(detail, item, numbers, counts) for item in value]
            if None in value:
                return None
        else:
            return None
        found[key] = value
    return found if plan.required <= found.keys() else None


@cache
def _plan(message: Message) -> _Plan:
    kinds: dict[str, tuple[int, Any]] = {}
    for field in message.fields:
        single = field.size == 1
        if isinstance(field.kind, Message):
            kinds[field.name] = (_PART if single else _PARTS, _plan(field.kind))
        elif field.kind == "double":
            kinds[field.name] = (_NUMBER, None) if single else (_NUMBERS, field.size)
        elif field.kind == "string" and single:
            kinds[field.name] = (_TEXT, frozenset(field.choices))
        else:
            kinds[field.name] = (_COUNT, None) if single else (_OTHER, None)
    required = frozenset(field.name for field in message.fields if field.required)
    return _Plan(kinds, required, frozenset(LEFT_OUT.get(message.name, ())))
