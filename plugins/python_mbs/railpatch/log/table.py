"""A run log as one table: a row for each moment, a column for each number or text.

A column is named by its channel and the field's path there, as in the log's metadata:
"/wheelset/state.yaw", "/left/contact.patches[0].approach". Of a vector each component is a column
of its own, "/left/contact.force.y", by axis where the vector has axes, by number from 0 else.
"""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from railpatch.errors import CaseError
from railpatch.log.channels import Field, Message, channel

TIME = "time"
# a channel of maps over the contact patches: taken only where a pattern names it
MAPS = "/fields"
# components of vectors by frame and size; of all others their numbers
AXES = {
    ("track", 2): "yz",
    ("contact", 2): "xy",
    ("start", 4): "xyzw",
}
SPACE = "xyz"
Patterns = Sequence[str]
# of a vehicle, whose log has thousands of columns: what is read first, by channel
READ = {
    "/vehicle/state": "*",
    "/vehicle/bodies": r"bodies\[\d+\]\.(name|acceleration).*",
    "/vehicle/comfort": "*",
    "/vehicle/assessment": "*",
    "/wheelset/N/state": "x|y|z|roll|yaw|speed|rolling_radius_difference|conicity|wear_number|"
    "drive_torque|slip_speed",
    "/wheelset/N/support": "*",
    "/wheelset/N/contact": r"status|force\..*|rolling_radius|(mean_)?(guiding_force|wheel_load)|"
    "derailment_quotient|wear_number|friction_work|friction_power|wheel_temperature",
}


@dataclass(frozen=True)
class Column:
    """One column: its name, unit ("-": none, "": a text), meaning, and n values.

    values: float64, NaN where absent; int64 of counts that are all there; objects of texts.
    """

    name: str
    unit: str
    text: str
    values: np.ndarray

    @property
    def is_text(self) -> bool:
        """Whether it holds texts."""
        return self.values.dtype == object

    @property
    def head(self) -> str:
        """Name and unit, "/wheelset/state.yaw [rad]"; a name alone of texts and plain numbers."""
        return f"{self.name} [{self.unit}]" if self.unit not in ("", "-") else self.name


@dataclass(frozen=True)
class LogTable:
    """Columns of n values each; the first is the time."""

    columns: list[Column]

    @property
    def time(self) -> np.ndarray:
        """s, [n]."""
        return self.columns[0].values

    def __getitem__(self, name: str) -> Column:
        """The column of that name; KeyError."""
        for column in self.columns:
            if column.name == name:
                return column
        raise KeyError(name)


@dataclass(frozen=True)
class Leaf:
    """A column before its values are laid out: one value of each message."""

    topic: str
    path: str
    field: Field
    unit: str
    values: list[Any]

    @property
    def name(self) -> str:
        """Of the column."""
        return f"{self.topic}.{self.path}"


def log_table(
    series: Mapping[str, Any], channels: Patterns = (), signals: Patterns = ()
) -> LogTable:
    """The columns of a log that match a pattern of each kind; without patterns all that have a
    value, maps over the patches excepted.

    series: by topic, of Run.channels. channels: topics. signals: names of columns, of fields
    ("yaw", "force") or paths ("force.y"). In both, * and ? stand for any characters. Rows are the
    moments at which a chosen channel has a message. Raises CaseError, which names what is near,
    where a pattern matches nothing.
    """
    topics = chosen_topics(series, channels, signals)
    leaves = [leaf for topic in topics for leaf in leaves_of(topic, series[topic].messages)]
    if signals:
        leaves = chosen_leaves(leaves, signals)
    leaves = [leaf for leaf in leaves if any(value is not None for value in leaf.values)]
    if not leaves:
        raise CaseError("the log has no message of these channels: nothing to export")
    used = list(dict.fromkeys(leaf.topic for leaf in leaves))
    moments = np.unique(np.concatenate([series[topic].time for topic in used]))
    rows = {topic: np.searchsorted(moments, series[topic].time) for topic in used}
    found = [column_of(leaf, rows[leaf.topic], len(moments)) for leaf in leaves]
    return LogTable(
        [Column(TIME, "s", "simulation time from the start of the run", moments), *found]
    )


def is_read(name: str) -> bool:
    """Whether a column of a vehicle's log is one of READ."""
    topic, _, path = name.partition(".")
    like = re.sub(r"^/wheelset/\d+/(left/|right/)?", "/wheelset/N/", topic)
    pattern = READ.get(like)
    return pattern == "*" or (pattern is not None and re.fullmatch(pattern, path) is not None)


def chosen_topics(series: Mapping[str, Any], channels: Patterns, signals: Patterns) -> list[str]:
    """The channels that are looked into, as the log has them."""
    known = [topic for topic in series if is_known(topic)]
    for pattern in channels:
        if not any(is_like(pattern, topic) for topic in known):
            raise unmatched("--channel", pattern, known)
    named = [topic for topic in known if any(is_like(p, topic) for p in channels)]
    named = [topic for topic in named if MAPS not in topic or any(MAPS in p for p in channels)]
    if channels:
        return named
    with_maps = any(MAPS in pattern for pattern in signals)
    return [topic for topic in known if with_maps or MAPS not in topic]


def chosen_leaves(leaves: list[Leaf], signals: Patterns) -> list[Leaf]:
    """Those that match a pattern. Raises CaseError for one without match, or without a value."""
    for pattern in signals:
        matched = [leaf for leaf in leaves if is_signal(pattern, leaf)]
        if not matched:
            names = [name for leaf in leaves for name in names_of(leaf)]
            raise unmatched("--signal", pattern, names)
        if not any(value is not None for leaf in matched for value in leaf.values):
            raise CaseError(f"--signal: value is {pattern!r}, of which this log has no value")
    return [leaf for leaf in leaves if any(is_signal(p, leaf) for p in signals)]


def unmatched(option: str, pattern: str, names: Sequence[str]) -> CaseError:
    """Names what is near, else all or a part of what there is."""
    names = list(dict.fromkeys(names))
    near = difflib.get_close_matches(pattern, names, 3, 0.5)
    parts = [name for name in names if pattern.strip("*?").lower() in name.lower()]
    shown = near or parts[:3]
    if shown:
        said = f"did you mean {', '.join(map(repr, shown))}?"
    else:
        said = f"allowed {', '.join(names[:8])}{' ...' if len(names) > 8 else ''}"
    return CaseError(f"{option}: value is {pattern!r}, which this log does not have; {said}")


def is_like(pattern: str, text: str) -> bool:
    """Whether a text matches; brackets are themselves, as they stand in names."""
    parts = re.split(r"([*?])", pattern)
    made = "".join({"*": ".*", "?": "."}.get(part, re.escape(part)) for part in parts)
    return re.fullmatch(made, text) is not None


def is_signal(pattern: str, leaf: Leaf) -> bool:
    """Whether one of its names matches."""
    return any(is_like(pattern, name) for name in names_of(leaf))


def names_of(leaf: Leaf) -> tuple[str, ...]:
    """By which it can be asked for: in whole, by path, and without the component."""
    whole = leaf.path if leaf.field.size == 1 else re.split(r"\.\w+$|\[\d+\]$", leaf.path)[0]
    return leaf.name, leaf.path, whole, f"{leaf.topic}.{whole}", leaf.field.name


def is_known(topic: str) -> bool:
    """Whether the table of channels has it; logs of later versions may have others."""
    try:
        return bool(channel(topic))
    except KeyError:
        return False


def leaves_of(topic: str, messages: Sequence[Any]) -> Iterator[Leaf]:
    """All columns of a channel, also those without any value."""
    yield from _leaves(topic, "", channel(topic).message, list(messages))


def _leaves(topic: str, prefix: str, message: Message, values: list[Any]) -> Iterator[Leaf]:
    for field in message.fields:
        own = [value.get(field.name) if value else None for value in values]
        path = prefix + field.name
        if isinstance(field.kind, Message) and field.size == 0:
            for place in range(max((len(value or ()) for value in own), default=0)):
                each = [component(value, place) for value in own]
                yield from _leaves(topic, f"{path}[{place}].", field.kind, each)
        elif isinstance(field.kind, Message):
            yield from _leaves(topic, f"{path}.", field.kind, own)
        elif field.size == 1:
            yield Leaf(topic, path, field, field.unit, own)
        elif field.kind == "string":
            joined = ["; ".join(value) if value else None for value in own]
            yield Leaf(topic, path, field, field.unit, joined)
        else:
            yield from _components(topic, path, field, own)


def _components(topic: str, path: str, field: Field, own: list[Any]) -> Iterator[Leaf]:
    """Of a vector, or of a list of numbers over the elements of a patch."""
    count = field.size or max((len(value or ()) for value in own), default=0)
    units = field.unit.split(", ")
    axes = AXES.get((field.frame, count), SPACE if field.frame and count == len(SPACE) else "")
    for place in range(count):
        name = f"{path}.{axes[place]}" if axes else f"{path}[{place}]"
        unit = units[place] if len(units) == count else field.unit
        yield Leaf(topic, name, field, unit, [component(value, place) for value in own])


def component(value: Sequence[Any] | None, place: int) -> Any:
    """Of a list that may be absent or shorter."""
    return value[place] if value is not None and place < len(value) else None


def column_of(leaf: Leaf, rows: np.ndarray, count: int) -> Column:
    """Its values in their rows."""
    axes = f", {leaf.field.frame} axes" if leaf.field.frame else ""
    text = f"{leaf.field.text}{axes}"
    if leaf.field.kind == "string":
        texts = np.full(count, "", dtype=object)
        texts[rows] = [value or "" for value in leaf.values]
        return Column(leaf.name, leaf.unit, text, texts)
    numbers = np.full(count, np.nan)
    numbers[rows] = [np.nan if value is None else value for value in leaf.values]
    if leaf.field.kind == "uint32" and np.isfinite(numbers).all():
        return Column(leaf.name, leaf.unit, text, numbers.astype(np.int64))
    return Column(leaf.name, leaf.unit, text, numbers)
