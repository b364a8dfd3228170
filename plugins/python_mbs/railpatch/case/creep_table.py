"""The table of creep forces as it is read; core/fast/creep_table.hpp tells its form."""

from __future__ import annotations

import json
import struct
from functools import lru_cache
from importlib import resources
from pathlib import Path
from typing import Any

import numpy as np

from railpatch.errors import CaseError

MAGIC = b"RPCREEP1"
HEAD = struct.Struct("<8sQQ")
BODY = struct.Struct("<4i2i3d2d1d3d2d")
# of tables of shapes: core/fast/shape_table.hpp
SHAPES_MAGIC = b"RPSHAPE3"
SHAPES_BODY = struct.Struct("<2i3d12d8d1d2d")
FILE = "creep_table.bin"
MOST_BYTES = 200_000_000


def checksum(data: bytes) -> int:
    """FNV-1a by words of 8 bytes."""
    value = 14695981039346656037
    for word in np.frombuffer(data, "<u8").tolist():
        value = ((value ^ word) * 1099511628211) & 0xFFFFFFFFFFFFFFFF
    return value


def describe_table(data: bytes) -> dict[str, Any]:
    """Recipe and errors of a table. Raises CaseError."""
    try:
        magic, size, total = HEAD.unpack_from(data)
        if size != len(data) or checksum(data[HEAD.size :]) != total:
            raise ValueError("altered")
        if magic == SHAPES_MAGIC:
            return shapes_recipe(data)
        fields = BODY.unpack_from(data, HEAD.size)
        if magic != MAGIC:
            raise ValueError("altered")
        end = len(data) - (-fields[4] % 8)
        return json.loads(data[end - fields[4] : end])
    except (ValueError, struct.error):
        raise CaseError(
            "creep table: value is none, allowed what 'railpatch table' writes"
        ) from None


def shapes_recipe(data: bytes) -> dict[str, Any]:
    """Of a table of shapes."""
    count, text = SHAPES_BODY.unpack_from(data, HEAD.size)[:2]
    functions = 12 * 12 * 9 * 3 * 24 * 2  # spins, directions, sizes, Fx Fy Mz, of 2 bytes
    start = HEAD.size + SHAPES_BODY.size + -(-count // 8) * 8 * (8 * 4 + 24 * 8) + functions
    return json.loads(data[start : start + text])


def table_from(path: Path) -> np.ndarray:
    """The table of a file, one copy for all; the core looks at what it holds. Raises CaseError."""
    try:
        about = path.stat()
        if about.st_size > MOST_BYTES:
            raise CaseError(
                f"method.table_file: {path} has {about.st_size} bytes, allowed {MOST_BYTES}"
            )
        return read_table(path, about.st_size, about.st_mtime_ns)
    except OSError as error:
        raise CaseError(
            f"method.table_file: {path} cannot be read: {error.strerror or error}"
        ) from None


@lru_cache(maxsize=4)
def read_table(path: Path, _size: int, _changed: int) -> np.ndarray:
    """The table of a file that has not changed since. Raises CaseError, OSError."""
    data = path.read_bytes()
    if len(data) % 8 or data[:8] not in (MAGIC, SHAPES_MAGIC):
        raise CaseError(
            f"method.table_file: {path} is no creep table, allowed what 'railpatch table' writes"
        )
    table = np.frombuffer(data, np.uint8)
    table.setflags(write=False)
    return table


@lru_cache(maxsize=1)
def default_table() -> np.ndarray:
    """The table that comes with the package, one copy for all."""
    path = resources.files("railpatch") / "data" / FILE
    if not path.is_file():
        raise CaseError("method.tangential: value is 'table', but the package holds no table")
    table = np.frombuffer(path.read_bytes(), np.uint8)
    table.setflags(write=False)
    return table
