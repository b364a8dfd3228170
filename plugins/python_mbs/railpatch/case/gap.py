"""The undeformed distance on the grid, from a CSV file or nested lists."""

from __future__ import annotations

import re
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from railpatch.case.types import listed
from railpatch.errors import CaseError

KEY = "geometry.undeformed_distance"


def read_gap(value: str | list[list[float]] | None, folder: Path) -> NDArray[np.float64] | None:
    """m, [lateral, along rolling]. Raises CaseError that names the file and the line."""
    if value is None:
        return None
    if not isinstance(value, str):
        return gap_of(list(enumerate(value, 1)))
    path = (folder / value).absolute()
    try:
        about = path.stat()
    except OSError:
        return gap_of(read_rows(folder / value))  # which says what is wrong
    return _gap_in(path, about.st_size, about.st_mtime_ns)


@lru_cache(maxsize=4)
def _gap_in(path: Path, _size: int, _changed: int) -> NDArray[np.float64]:
    """Of a file, read once for all cases that name it; it must not be written to."""
    gap = gap_of(read_rows(path))
    gap.setflags(write=False)
    return gap


def gap_of(rows: list[tuple[int, list[float]]]) -> NDArray[np.float64]:
    """m, of lines with their numbers. Raises CaseError."""
    if not rows:
        raise CaseError(f"{KEY}: value is empty, allowed one row of numbers per grid row")
    columns = len(rows[0][1])
    for line, row in rows:
        if len(row) != columns:
            raise CaseError(
                f"{KEY}: line {line} holds {len(row)} values, allowed {columns} as in the first"
            )
    shape = (len(rows), columns)
    least, most = (int(listed("distance_shape")[end]) for end in ("low", "high"))
    if min(shape) < least or max(shape) > most:
        raise CaseError(f"{KEY}: shape is {shape}, allowed {least} ... {most} in each direction")
    return np.array([row for _, row in rows], dtype=float)


def read_rows(path: Path, key: str = KEY) -> list[tuple[int, list[float]]]:
    """Line numbers and values; '#' starts a comment."""
    try:
        text = path.read_text(encoding="utf-8-sig")
    except OSError as error:
        raise CaseError(f"{key}: {path} cannot be read: {error.strerror or error}") from None
    except UnicodeDecodeError:
        raise CaseError(f"{key}: {path} is not a text file") from None
    rows: list[tuple[int, list[float]]] = []
    for line, words in enumerate(text.splitlines(), 1):
        words = words.split("#", 1)[0].strip()
        if words:
            values = [parse(path, line, word, key) for word in re.split(r"[\s,;]+", words)]
            rows.append((line, values))
    return rows


def parse(path: Path, line: int, word: Any, key: str = KEY) -> float:
    """One finite number."""
    try:
        value = float(word)
    except ValueError:
        value = np.nan
    if not np.isfinite(value):
        raise CaseError(f"{key}: {path}:{line}: value is {word!r}, allowed a finite number")
    return value
