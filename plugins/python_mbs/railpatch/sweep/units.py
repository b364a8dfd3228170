"""Units of what a sweep varies and finds, for its page."""

from __future__ import annotations

import re
from functools import cache

from railpatch.case.key_units import unit_of_key
from railpatch.case.kinds import SceneKind, kind_of
from railpatch.log import channels
from railpatch.result import PATCH_UNITS, PLACE_UNITS, TOTAL_UNITS, WHEEL_UNITS, WHEELSET_UNITS
from railpatch.sweep.outputs import CALL
from railpatch.sweep.plan import steps_of

INDEX = re.compile(r"\[(\d*)\]")


@cache
def unit_of_varied(kind: str, key: str) -> str:
    """SI unit of a scene's key; "" of plain numbers and of what is no number."""
    return plain(unit_of_key(_schema(kind), steps_of(key)))


@cache
def unit_of_output(kind: str, name: str) -> str:
    """SI unit of an output, statistics included; "" of plain numbers and where none is known."""
    found = CALL.fullmatch(name)
    path = found[2] if found else name
    if path.startswith("/"):
        return plain(_of_channel(path))
    words = INDEX.sub("", path).split(".")
    scene = kind_of(kind)
    return plain(_of_run(scene, words) if scene.run else _of_result(words))


def labelled(name: str, unit: str) -> str:
    """A name with its unit, for axes and heads of columns."""
    return f"{name} [{unit}]" if unit else name


def plain(unit: str) -> str:
    """Plain numbers have none to show."""
    return "" if unit == "-" else unit


@cache
def _schema(kind: str) -> dict[str, object]:
    # without what other commands read of such files, whose code takes long to load
    return kind_of(kind).model.model_json_schema()


@cache
def _of_results() -> dict[str, str]:
    """All quantities of a contact's result by their names, which mean one thing each."""
    units: dict[str, str] = {}
    for message in (channels.SUBSURFACE, channels.DAMAGE, channels.ERROR_ESTIMATE):
        units |= {field.name: field.unit for field in message.fields}
    for known in (WHEELSET_UNITS, TOTAL_UNITS, WHEEL_UNITS, PLACE_UNITS, PATCH_UNITS):
        units |= known
    return units


def _of_result(words: list[str]) -> str:
    return _of_results().get(words[-1], "")


def _of_run(scene: SceneKind, words: list[str]) -> str:
    """By the kind's table: of the number, or of the table that it stands in."""
    parts = (".".join(words[:count]) for count in range(len(words), 0, -1))
    return next((scene.units[part] for part in parts if part in scene.units), "")


def _of_channel(path: str) -> str:
    topic, _, field = path.partition(".")
    indices = INDEX.findall(field)
    try:
        # a channel's own table writes lists of messages as patches[].approach
        inner = re.sub(r"\[\d*\](?=\.)", "[]", field)
        unit = channels.unit(topic, re.sub(r"\[\d*\]$", "", inner))
    except KeyError:
        return ""
    parts = unit.split(", ")
    last = int(indices[-1]) if indices and indices[-1] else 0
    return parts[min(last, len(parts) - 1)]
