"""A worker's function that leaves a mark for each case that it solves."""

from __future__ import annotations

import os
import time
from pathlib import Path

from railpatch.sweep.work import Chunk, Row, solve_chunk


def counted(chunk: Chunk) -> list[Row]:
    """As solve_chunk, slower: a line in the environment's COUNTED for each case."""
    rows = solve_chunk(chunk)
    time.sleep(0.05)
    with Path(os.environ["COUNTED"]).open("a", encoding="utf-8") as file:
        file.write("".join(f"{name} {os.getpid()}\n" for name in chunk.ids))
    return rows
