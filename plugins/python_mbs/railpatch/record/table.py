"""The file of a record as it is: names of columns, their units, and cells."""

from __future__ import annotations

import csv
import difflib
import re
from dataclasses import dataclass
from datetime import date
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from railpatch.delimited import COMMENT, decimal_points, number, read_text
from railpatch.errors import RecordError
from railpatch.record.units import split_head

MAX_BYTES = 1_000_000_000
# cells without a value
GAPS = {"", "-", "--", "---", "nan", "na", "n/a", "#n/a", "null", "none"}
# what stands between columns, in the order in which it is looked for in the head
SEPARATORS = ("\t", ";", ",")
# a time of day, perhaps with its date
CLOCK = re.compile(r"(?:(\d{4}-\d\d-\d\d)[T ])?(\d{1,2}):(\d\d):(\d\d(?:\.\d*)?)Z?")
# between blanks, with the unit that follows
WORD = re.compile(r"[^\s\[(]+(?:\s*[\[(][^\])]*[\])])?")


@dataclass(frozen=True)
class RawTable:
    """names: of the columns, without units. units: of the head, "" where it has none. rows: cells;
    lines: of the file. separator: "" for blanks."""

    path: Path
    names: list[str]
    units: list[str]
    rows: list[list[str]]
    lines: list[int]
    separator: str

    def find(self, name: str, key: str) -> int:
        """The column of a name, with or without its unit. Raises RecordError."""
        wanted = split_head(name)[0]
        matches = [i for i, own in enumerate(self.names) if name == own]
        matches = matches or [i for i, own in enumerate(self.names) if wanted == own]
        matches = matches or [
            i for i, own in enumerate(self.names) if wanted.lower() == own.lower()
        ]
        if len(matches) == 1:
            return matches[0]
        if matches:
            problem = f"{key}.name: value is {name!r}, which {len(matches)} columns are called"
            raise RecordError(self.path, f"{problem}, allowed one of its own")
        near = difflib.get_close_matches(wanted, self.names, 1, 0.5)
        hint = f"; did you mean {near[0]!r}?" if near else ""
        there = ", ".join(map(repr, self.names))
        problem = f"{key}.name: value is {name!r}, allowed {there}{hint}"
        raise RecordError(self.path, problem)

    def numbers(self, column: int, *, clock: bool = False) -> NDArray[np.float64]:
        """[n], NaN where a cell is empty. clock: times of day and dates are read too, as s. Raises
        RecordError with the line."""
        words = [row[column].strip() for row in self.rows]
        if self.separator != ",":
            words = [decimal_points(word) for word in words]
        values = np.full(len(words), np.nan)
        for place, word in enumerate(words):
            if word.lower() in GAPS:
                continue
            seconds = seconds_of(word) if clock else None
            try:
                values[place] = number(word) if seconds is None else seconds
            except ValueError:
                raise RecordError(
                    self.path,
                    f"column {self.names[column]!r}: value is {word[:40]!r}, allowed a number or "
                    "an empty cell",
                    self.lines[place],
                ) from None
            if np.isinf(values[place]):
                problem = f"column {self.names[column]!r}: value is {word[:40]!r}, not finite"
                raise RecordError(self.path, problem, self.lines[place])
        return values


def read_table(path: Path) -> RawTable:
    """Comma, semicolon, tab or blanks between columns, decimal points or commas; a line of names,
    perhaps one of units below. Raises RecordError."""
    text = read_text(path, RecordError, "file not found", MAX_BYTES)
    told: list[str] = []
    kept: list[tuple[int, str]] = []
    for line, row in enumerate(text.splitlines(), 1):
        if not row.strip():
            continue
        if not kept and row.lstrip().startswith(COMMENT):
            told.append(row.strip().lstrip("!#%/ "))
        elif not row.lstrip().startswith(COMMENT):
            kept.append((line, row))
    if not kept:
        raise RecordError(path, "holds no rows")
    separator = next((mark for mark in SEPARATORS if mark in kept[0][1]), "")
    lines = [line for line, _ in kept]
    try:
        cells = split([row for _, row in kept], separator)
    except csv.Error as error:
        raise RecordError(path, f"cannot be split into cells: {error}") from None
    if len(cells) != len(lines):
        raise RecordError(path, 'has a cell over several lines, allowed one whose " is closed')
    heads = head_of(cells, told, separator)
    if heads is cells[0]:
        cells, lines = cells[1:], lines[1:]
    names, units = map(list, zip(*map(split_head, heads), strict=True))
    if cells and any(map(str.strip, cells[0])) and not any(map(is_value, cells[0])):
        below = [cell.strip().strip("[]()") for cell in cells[0]] + [""] * len(names)
        units = [unit or other for unit, other in zip(units, below, strict=False)]
        cells, lines = cells[1:], lines[1:]
    if len(cells) < 2:
        raise RecordError(path, f"holds {len(cells)} rows of numbers, allowed 2 or more")
    return RawTable(path, names, units, even(path, cells, lines, len(names)), lines, separator)


def seconds_of(word: str) -> float | None:
    """s, of "14:03:07.25" since midnight, of "2024-05-31 14:03:07.25" since some day; else None."""
    found = CLOCK.fullmatch(word)
    if found is None:
        return None
    day, hours, minutes, seconds = found.groups()
    try:
        days = date.fromisoformat(day).toordinal() - date(1970, 1, 1).toordinal() if day else 0
    except ValueError:
        return None
    return 86400.0 * days + 3600.0 * int(hours) + 60.0 * int(minutes) + float(seconds)


def split(rows: list[str], separator: str) -> list[list[str]]:
    """Cells of each row."""
    if not separator:
        cells = [WORD.findall(row) for row in rows]
        # one column, whose name may have blanks
        return [[row.strip()] for row in rows] if len(cells[-1]) == 1 else cells
    return [list(row) for row in csv.reader(rows, delimiter=separator, skipinitialspace=True)]


def head_of(cells: list[list[str]], told: list[str], separator: str) -> list[str]:
    """The line of names, which may be a comment; else numbers from 1."""
    first = cells[0]
    if not any(map(is_value, first)):
        return first
    if told and len(found := split([told[-1]], separator)[0]) == len(first) > 1:
        return found
    return [str(place + 1) for place in range(len(first))]


def is_value(cell: str) -> bool:
    """Whether a cell holds a number or a time, and no name or unit."""
    word = decimal_points(cell.strip())
    try:
        number(word)
    except ValueError:
        return seconds_of(word) is not None
    return re.search(r"\d", word) is not None


def even(path: Path, cells: list[list[str]], lines: list[int], width: int) -> list[list[str]]:
    """Rows of one width: cells that are empty at the end may be left out, or be too many."""
    rows = []
    for row, line in zip(cells, lines, strict=True):
        if any(cell.strip() for cell in row[width:]):
            problem = f"has {len(row)} cells, allowed {width} as in the head"
            raise RecordError(path, problem, line)
        rows.append(row[:width] + [""] * (width - len(row)))
    return rows
