"""The formats of tables: how each is written, and what it needs."""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from importlib import import_module
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from railpatch.errors import CaseError
from railpatch.log.table import Column, LogTable
from railpatch.writing import write_whole

# of an Excel sheet
MOST_ROWS, MOST_COLUMNS = 1_048_576, 16_384
# characters of a name in a MATLAB file
MOST_LETTERS = 63
# what XML 1.0 has no place for
CONTROL = re.compile(r"[\x00-\x08\x0b\x0c\x0e-\x1f]")


@dataclass(frozen=True)
class Format:
    """encode: a table's bytes. module: that it takes beside what every installation has."""

    encode: Callable[[LogTable], bytes]
    module: str = ""


def write_table(table: LogTable, output: str | PathLike[str]) -> Path:
    """Writes a table in the format of the output's ending, whole or not at all; returns it.

    Raises CaseError where the ending is none of FORMATS, the format's library is not installed or
    a sheet is too small for the table; OSError.
    """
    output = Path(output)
    chosen = format_of(output)
    need_library(output)
    return write_whole(output, chosen.encode(table))


def format_of(output: Path) -> Format:
    """By its ending. Raises CaseError that names all."""
    chosen = FORMATS.get(output.suffix.lower())
    if chosen is None:
        *others, last = FORMATS
        allowed = f"a name that ends in {', '.join(others)} or {last}"
        raise CaseError(f"--output: value is {str(output)!r}, allowed {allowed}")
    return chosen


def need_library(output: Path) -> None:
    """Raises CaseError that says what to install where a known format's library is missing."""
    chosen = FORMATS.get(output.suffix.lower())
    if chosen is None or not chosen.module:
        return
    try:
        import_module(chosen.module)
    except ImportError:
        raise CaseError(
            f"--output: {output.suffix.lower()} files need {chosen.module.partition('.')[0]}, "
            "which is not installed; pip install 'railpatch[export]' has it"
        ) from None


def as_csv(table: LogTable) -> bytes:
    """Comma-separated, UTF-8: one line of names with units, numbers with all digits, gaps empty."""
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow([column.head for column in table.columns])
    writer.writerows(zip(*map(cells, table.columns), strict=True))
    return stream.getvalue().encode()


def cells(column: Column) -> list[Any]:
    """Plain values; None for what is absent."""
    values = column.values.tolist()
    if column.values.dtype != np.float64:
        return values
    return [value if value == value else None for value in values]


def as_xlsx(table: LogTable) -> bytes:
    """A sheet with the table, and one with the meanings of its columns."""
    from openpyxl import Workbook

    rows, columns = len(table.time), len(table.columns)
    if rows >= MOST_ROWS or columns > MOST_COLUMNS:
        raise CaseError(
            f"--output: the table has {rows} rows and {columns} columns, allowed {MOST_ROWS - 1} "
            f"and {MOST_COLUMNS} in an .xlsx file; choose channels, or write .csv or .parquet"
        )
    book = Workbook(write_only=True)
    sheet = book.create_sheet("run")
    sheet.freeze_panes = "B2"
    sheet.append([column.head for column in table.columns])
    for row in zip(*map(cells, table.columns), strict=True):
        sheet.append([sheet_cell(sheet, value) for value in row])
    meanings = book.create_sheet("columns")
    for row in [("name", "unit", "meaning"), *((c.name, c.unit, c.text) for c in table.columns)]:
        meanings.append([sheet_cell(meanings, value) for value in row])
    stream = io.BytesIO()
    book.save(stream)
    return stream.getvalue()


def sheet_cell(sheet: Any, value: Any) -> Any:
    """A text stays a text, also one that begins as a formula does."""
    if not isinstance(value, str):
        return value
    from openpyxl.cell import WriteOnlyCell

    cell = WriteOnlyCell(sheet, CONTROL.sub(" ", value))
    cell.data_type = "s"
    return cell


def as_mat(table: LogTable) -> bytes:
    """MATLAB 5: structs data, unit and name, whose fields are the columns by names that MATLAB
    takes."""
    from scipy.io import savemat

    names = matlab_names([column.name for column in table.columns])
    content = {
        "data": {n: c.values for n, c in zip(names, table.columns, strict=True)},
        "unit": {n: c.unit for n, c in zip(names, table.columns, strict=True)},
        "name": {n: c.name for n, c in zip(names, table.columns, strict=True)},
    }
    stream = io.BytesIO()
    savemat(stream, content, long_field_names=True, oned_as="column")
    return stream.getvalue()


def matlab_names(names: Sequence[str]) -> list[str]:
    """Letters, digits and underscores, each name once: left_contact_force_y."""
    found: dict[str, None] = {}
    for name in names:
        plain = re.sub(r"\W+", "_", name, flags=re.ASCII).strip("_")[:MOST_LETTERS]
        number = 1
        while plain in found:
            number += 1
            ending = f"_{number}"
            plain = plain[: MOST_LETTERS - len(ending)] + ending
        found[plain] = None
    return list(found)


def as_parquet(table: LogTable) -> bytes:
    """Columns by their names; unit and meaning are metadata of each."""
    import pyarrow
    import pyarrow.parquet

    fields, arrays = [], []
    for column in table.columns:
        arrays.append(pyarrow.array(cells(column)) if column.is_text else arrow_numbers(column))
        about = {"unit": column.unit, "meaning": column.text}
        fields.append(pyarrow.field(column.name, arrays[-1].type, metadata=about))
    made = pyarrow.Table.from_arrays(arrays, schema=pyarrow.schema(fields))
    stream = io.BytesIO()
    pyarrow.parquet.write_table(made, stream, compression="zstd")
    return stream.getvalue()


def arrow_numbers(column: Column) -> Any:
    """What is absent is null."""
    import pyarrow

    return pyarrow.array(column.values, mask=~np.isfinite(column.values))


FORMATS = {
    ".csv": Format(as_csv),
    ".xlsx": Format(as_xlsx, "openpyxl"),
    ".mat": Format(as_mat),
    ".parquet": Format(as_parquet, "pyarrow.parquet"),
}
