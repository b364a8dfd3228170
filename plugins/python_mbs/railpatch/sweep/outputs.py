"""Outputs of a case by their names: numbers of a result, statistics of a run's channels."""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from railpatch.errors import CaseError

if TYPE_CHECKING:
    from railpatch.log import Run

Output = float | str | None
STATISTICS = {
    "min": np.nanmin,
    "max": np.nanmax,
    "absmax": lambda values: np.nanmax(np.abs(values)),
    "mean": np.nanmean,
    "rms": lambda values: np.sqrt(np.nanmean(np.square(values))),
    "sum": np.nansum,
    "first": lambda values: values[0],
    "last": lambda values: values[-1],
}
CALL = re.compile(rf"({'|'.join(STATISTICS)})\((.+)\)")
# of a result: no outputs of the contact, or long
LEFT_OUT = {
    "status",
    "reason",
    "warnings",
    "wall_time",
    "stages",
    "profiles",
    "notes",
    "patches",
    "alternatives",
}


def value_of(name: str, result: Mapping[str, Any], run: Run | None) -> Output:
    """One output; None where the case has none. Raises CaseError for a name that no result has."""
    found = CALL.fullmatch(name)
    statistic, path = found.groups() if found else (None, name)
    if path.startswith("/"):
        values = channel_values(name, path, run)
    else:
        values = result_values(name, path, result, run)
        if statistic is None and len(values) > 1:
            raise CaseError(
                f"sweep.outputs: value is {name!r}, which has {len(values)} values, allowed one of "
                f"them by [0] or one of {', '.join(STATISTICS)}, as max({path})"
            )
    if path.startswith("/") and statistic is None:
        raise CaseError(
            f"sweep.outputs: value is {name!r}, allowed with one of {', '.join(STATISTICS)}, as "
            f"max({path})"
        )
    if statistic is None:
        return as_output(values[0]) if values else None
    numbers = np.array([np.nan if v is None else v for v in values], dtype=object)
    if any(isinstance(v, str) for v in numbers):
        raise CaseError(f"sweep.outputs: value is {name!r}, allowed of numbers, not of texts")
    array = numbers.astype(float)
    if statistic not in ("first", "last") and not np.isfinite(array).any():
        return None
    return as_output(float(STATISTICS[statistic](array))) if len(array) else None


def result_values(name: str, path: str, result: Mapping[str, Any], run: Run | None) -> list[Any]:
    """Of a result, or a run's summary. Raises CaseError, for a run with the channels of its log."""
    try:
        return list(reach(result, path, name))
    except CaseError as error:
        if run is None or not run.channels:
            raise
        channels = ", ".join(sorted(run.channels))
        raise CaseError(
            f"{error}; of its log as max({min(run.channels)}.FIELD): {channels}"
        ) from None


def channel_values(name: str, path: str, run: Run | None) -> list[Any]:
    """Of a run's log: "/topic.field". Raises CaseError."""
    topic, _, field = path.partition(".")
    if run is None:
        raise CaseError(
            f"sweep.outputs: value is {name!r}, allowed names of the result: "
            "this scene is no run with channels"
        )
    try:
        if not field:
            raise KeyError(f"no field is named: {topic}.FIELD")
        values = run[topic][field]
    except KeyError as error:
        raise CaseError(f"sweep.outputs: value is {name!r}: {error.args[0]}") from None
    if values.ndim > 1:
        raise CaseError(
            f"sweep.outputs: value is {name!r}, which has {values.shape[1]} values at "
            f"a time, allowed one of them, as {path}[0]"
        )
    return list(values)


def reach(value: Any, path: str, name: str) -> Iterator[Any]:
    """The values at a dotted path; of a list without [number] all. Raises CaseError."""
    if not path:
        if isinstance(value, list):
            for item in value:
                yield from reach(item, "", name)
        elif isinstance(value, dict):
            raise CaseError(
                f"sweep.outputs: value is {name!r}, allowed one of it: {', '.join(value)}"
            )
        else:
            yield value
        return
    if isinstance(value, list) and not path.startswith("["):
        for item in value:
            yield from reach(item, path, name)
        return
    if path.startswith("["):
        number, _, rest = path[1:].partition("]")
        if not number.isdecimal() or not isinstance(value, list):
            raise CaseError(f"sweep.outputs: value is {name!r}, allowed [0], [1], ... of lists")
        if int(number) < len(value):
            yield from reach(value[int(number)], rest.removeprefix("."), name)
        return
    head = re.split(r"[.\[]", path, maxsplit=1)[0]
    if value is None:
        return
    if not isinstance(value, dict) or head not in value:
        known = list(value) if isinstance(value, dict) else []
        near = difflib.get_close_matches(head, known, 1)
        hint = f"; did you mean {near[0]!r}?" if near else ""
        shown = ", ".join(known) or "a number, which has nothing below it"
        raise CaseError(f"sweep.outputs: value is {name!r}, but {head!r} is none of {shown}{hint}")
    yield from reach(value[head], path[len(head) :].removeprefix("."), name)


def as_output(value: Any) -> Output:
    """A number, a text, or None for what is no number."""
    if isinstance(value, str) or value is None:
        return value
    number = float(value)
    return number if np.isfinite(number) else None


def default_names(result: Mapping[str, Any]) -> list[str]:
    """The numbers of a result outside its patches."""
    names: list[str] = []

    def walk(value: Any, path: str) -> None:
        if isinstance(value, dict):
            for key, item in value.items():
                if key not in LEFT_OUT:
                    walk(item, f"{path}.{key}" if path else key)
        elif isinstance(value, list) and path != "steps":
            for index, item in enumerate(value):
                walk(item, f"{path}[{index}]")
        elif isinstance(value, int | float) and not isinstance(value, bool):
            names.append(path)

    walk(dict(result), "")
    return names
