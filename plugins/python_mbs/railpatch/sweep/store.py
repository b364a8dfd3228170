"""What a sweep leaves in its folder: Parquet files of its chunks, and all in one at its end.

Rows are found by the ids of their cases: a sweep that was ended goes on where it was, and two
sweeps in one folder share the cases that they have in common.
"""

from __future__ import annotations

import io
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

from railpatch.errors import CaseError
from railpatch.sweep.plan import COLUMNS, Plan, Value, digest
from railpatch.sweep.work import Chunk, Row
from railpatch.writing import write_whole

CHUNKS = "results"
TABLE = "sweep.parquet"


def need_pyarrow() -> Any:
    """pyarrow and its Parquet. Raises CaseError that says what to install."""
    try:
        import pyarrow
        import pyarrow.parquet
    except ImportError:
        raise CaseError(
            "sweep: results are Parquet files, which need pyarrow, which is not installed; "
            "pip install 'railpatch[sweep]' has it"
        ) from None
    return pyarrow


def read_sweep(folder: str | Path) -> Any:
    """The table of a finished sweep: a row for each case, in the order of its points.

    Columns: the keys that vary, status, reason, warnings, seconds and the outputs. A pyarrow.Table:
    ``.to_pandas()`` where pandas is installed. Raises CaseError where there is none.
    """
    pyarrow = need_pyarrow()
    path = Path(folder) / TABLE
    if not path.is_file():
        raise CaseError(f"{folder}: has no {TABLE}, allowed the folder of a finished sweep")
    return pyarrow.parquet.ParquetFile(path).read()


def write_chunk(folder: Path, chunk: Chunk, rows: Sequence[Row]) -> Path:
    """One file, whole or not at all, named by its cases. Raises OSError."""
    name = digest([row.id for row in rows])
    columns = {**_keys(chunk.keys, chunk.points), **_columns(rows, chunk.outputs)}
    return _write(folder / CHUNKS / f"{name}.parquet", columns)


def is_new(folder: Path) -> bool:
    """Whether it has no rows of any sweep."""
    return not any((folder / CHUNKS).glob("*.parquet"))


def read_rows(folder: Path, wanted: Iterable[str], outputs: Sequence[str]) -> dict[str, Row]:
    """Rows that are there, by their ids. Files that are damaged are passed over: their cases are
    solved again."""
    pyarrow = need_pyarrow()
    ids, found = set(wanted), {}
    for path in sorted((folder / CHUNKS).glob("*.parquet")):
        try:
            content = pyarrow.parquet.ParquetFile(path).read().to_pydict()
        except (OSError, pyarrow.ArrowException):
            continue
        if not {*COLUMNS, *outputs} <= set(content):
            continue
        for i, name in enumerate(content["id"]):
            if name in ids:
                values = tuple(content[output][i] for output in outputs)
                warnings = tuple(content["warnings"][i] or ())
                found[name] = Row(
                    name,
                    content["status"][i],
                    content["reason"][i],
                    warnings,
                    content["seconds"][i],
                    values,
                )
    return found


def write_results(folder: Path, plan: Plan, rows: Sequence[Row], outputs: Sequence[str]) -> Path:
    """All cases in the order of their points. Raises OSError."""
    return _write(folder / TABLE, {**_keys(plan.keys, plan.points), **_columns(rows, outputs)})


def _keys(keys: Sequence[str], points: Sequence[tuple[Value, ...]]) -> dict[str, list[Any]]:
    """A column for each key that varies."""
    return {key: _one_type([point[i] for point in points]) for i, key in enumerate(keys)}


def _one_type(values: list[Any]) -> list[Any]:
    """Numbers as they are; of several types texts."""
    kinds = {bool if isinstance(v, bool) else str if isinstance(v, str) else float for v in values}
    return values if len(kinds) == 1 else list(map(str, values))


def _columns(rows: Sequence[Row], outputs: Sequence[str]) -> dict[str, Any]:
    pyarrow = need_pyarrow()
    text = pyarrow.string()
    columns = {
        "id": pyarrow.array([row.id for row in rows], text),
        "status": pyarrow.array([row.status for row in rows], text),
        "reason": pyarrow.array([row.reason for row in rows], text),
        "warnings": pyarrow.array([list(row.warnings) for row in rows], pyarrow.list_(text)),
        "seconds": pyarrow.array([row.seconds for row in rows], pyarrow.float64()),
    }
    for i, name in enumerate(outputs):
        values = [row.outputs[i] for row in rows]
        texts = any(isinstance(value, str) for value in values)
        columns[name] = pyarrow.array(values, text if texts else pyarrow.float64())
    return columns


def _write(path: Path, columns: dict[str, Any]) -> Path:
    pyarrow = need_pyarrow()
    stream = io.BytesIO()
    pyarrow.parquet.write_table(pyarrow.table(columns), stream, compression="zstd")
    path.parent.mkdir(parents=True, exist_ok=True)
    return write_whole(path, stream.getvalue())
