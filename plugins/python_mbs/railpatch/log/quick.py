"""The quick way to encode: one pass over a dict, numbers checked all at once.

What is plainly right is taken; of anything else encode.py, which names places, decides.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from operator import itemgetter
from typing import Any

import numpy as np

from railpatch.log.channels import LEFT_OUT, Message

UINT32_MAX = 2**32 - 1
KINDS = ("double", "uint32", "string")
_NUMBER_TYPES = frozenset({float, int, np.float64})
_COUNT_TYPES = frozenset({int})
_Get = Callable[[dict[str, Any]], Sequence[Any]]


@dataclass(frozen=True)
class _Plan:
    """What a dict with certain keys, some of them None, is to have.

    numbers, counts: get the values of these fields. lists: names and lengths of lists of numbers.
    texts: names and choices. parts, many: names and messages. lines: names of lists of texts.
    dropped: keys to leave out.
    """

    numbers: _Get
    counts: _Get
    lists: tuple[tuple[str, int], ...]
    texts: tuple[tuple[str, frozenset[str]], ...]
    parts: tuple[tuple[str, Message], ...]
    many: tuple[tuple[str, Message], ...]
    lines: tuple[str, ...]
    dropped: frozenset[str]


def quick(message: Message, values: Any) -> dict[str, Any] | None:
    """Arguments of the message's class, which takes None for absent; None: look at it closely."""
    numbers: list[Any] = []
    counts: list[Any] = []
    found = _collect(message, values, numbers, counts)
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
    message: Message, values: Any, numbers: list[Any], counts: list[Any]
) -> dict[str, Any] | None:
    if type(values) is not dict:
        return None
    # the dicts of a run are alike: what theirs has to have is found once
    plan = _plan(message, tuple(values), tuple([k for k, v in values.items() if v is None]))
    if plan is None:
        return None
    numbers += plan.numbers(values)
    counts += plan.counts(values)
    for name, size in plan.lists:
        value = values[name]
        if type(value) is not list or (size and len(value) != size):
            return None
        numbers += value
    for name, choices in plan.texts:
        if type(values[name]) is not str or (choices and values[name] not in choices):
            return None
    for name in plan.lines:
        if type(values[name]) is not list or not all(type(text) is str for text in values[name]):
            return None
    if not plan.dropped and not plan.parts and not plan.many:
        return values
    found = {key: value for key, value in values.items() if key not in plan.dropped}
    for name, part in plan.parts:
        found[name] = _collect(part, values[name], numbers, counts)
        if found[name] is None:
            return None
    for name, part in plan.many:
        if type(values[name]) is not list:
            return None
        found[name] = [_collect(part, item, numbers, counts) for item in values[name]]
        if None in found[name]:
            return None
    return found


@lru_cache(maxsize=1024)
def _plan(message: Message, keys: tuple[Any, ...], absent: tuple[Any, ...]) -> _Plan | None:
    """None where a key is unknown or a required one missing, or for a list that is not of
    numbers or messages."""
    fields = {field.name: field for field in message.fields}
    dropped = set(LEFT_OUT.get(message.name, ()))
    there = [key for key in keys if key not in absent]
    if not set(keys) <= set(fields) | dropped:
        return None
    if not {field.name for field in message.fields if field.required} <= set(there):
        return None
    chosen = [fields[key] for key in there if key in fields]
    plain = [field for field in chosen if not isinstance(field.kind, Message)]
    if any(field.size != 1 and field.kind == "uint32" for field in plain):
        return None
    listed = [field for field in plain if field.size != 1]
    single = {kind: [f.name for f in plain if f.kind == kind and f.size == 1] for kind in KINDS}
    nested = [field for field in chosen if isinstance(field.kind, Message)]
    return _Plan(
        _getter(single["double"]),
        _getter(single["uint32"]),
        tuple((f.name, f.size) for f in listed if f.kind == "double"),
        tuple((f.name, frozenset(f.choices)) for f in plain if f.kind == "string" and f.size == 1),
        tuple((f.name, f.kind) for f in nested if f.size == 1),
        tuple((f.name, f.kind) for f in nested if f.size != 1),
        tuple(f.name for f in listed if f.kind == "string"),
        frozenset(dropped.intersection(keys)),
    )


def _getter(names: list[str]) -> _Get:
    """Gets the values of these keys, in one call where there are two or more."""
    if len(names) > 1:
        return itemgetter(*names)
    return lambda values: [values[name] for name in names]
