"""The table of creep forces as it is read; core/fast/creep_table.hpp tells its form."""

from __future__ import annotations

import json
import struct
from functools import lru_cache
from importlib import resources
from typing import Any

import numpy as np

from railpatch.errors import CaseError

MAGIC = b"RPCREEP1"
HEAD = struct.Struct("<8sQQ")
BODY = struct.Struct("<4i2i3d2d1d3d2d")
FILE = "creep_table.bin"


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
        fields = BODY.unpack_from(data, HEAD.size)
        if magic != MAGIC or size != len(data) or checksum(data[HEAD.size :]) != total:
            raise ValueError("altered")
        end = len(data) - (-fields[4] % 8)
        return json.loads(data[end - fields[4] : end])
    except (ValueError, struct.error):
        raise CaseError(
            "creep table: value is none, allowed what 'railpatch table' writes"
        ) from None


@lru_cache(maxsize=1)
def default_table() -> np.ndarray:
    """The table that comes with the package, one copy for all."""
    path = resources.files("railpatch") / "data" / FILE
    if not path.is_file():
        raise CaseError("method.tangential: value is 'table', but the package holds no table")
    table = np.frombuffer(path.read_bytes(), np.uint8)
    table.setflags(write=False)
    return table
