"""Tables of published numbers: CSV under lines of '#' that tell source, unit, sign and reading
error."""

from __future__ import annotations

import csv
from collections.abc import Iterator
from os import PathLike
from pathlib import Path


def read_rows(path: str | PathLike[str]) -> Iterator[tuple[int, dict[str, str]]]:
    """Line number and text by column of every row below the head."""
    lines = Path(path).read_text(encoding="utf-8").splitlines()
    head = sum(line.startswith("#") for line in lines)
    if any(line.startswith("#") for line in lines[head:]):
        raise ValueError(f"{path}: a line of '#' below the head")
    yield from enumerate(csv.DictReader(lines[head:]), start=head + 2)


def read_numbers(path: str | PathLike[str]) -> list[dict[str, float]]:
    """Every row of a table that holds numbers alone."""
    return [{key: float(text) for key, text in row.items()} for _, row in read_rows(path)]
