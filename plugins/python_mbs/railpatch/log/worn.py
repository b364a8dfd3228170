"""Distributions of wear that a run's log holds, as tables for other programs."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from railpatch.case.types import SIDES
from railpatch.log.reader import Run
from railpatch.writing import write_whole

HEAD = (
    *("wheelset", "side", "y [m]", "wheel [kg/m]", "rail [kg/m]"),
    *("wheel depth [m]", "rail depth [m]"),
)
LISTS = ("y", "wheel", "rail", "wheel_depth", "rail_depth")


def worn_of(run: Run) -> dict[tuple[int, str], dict[str, Any]]:
    """The last message of wear by number (from 1) and side; empty where there is none."""
    numbers = run.metadata["railpatch"].get("wheelsets")
    topics = {
        (number, side): f"/wheelset/{number}/{side}/wear" if numbers else f"/{side}/wear"
        for number in range(1, int(numbers or 1) + 1)
        for side in SIDES
    }
    found = {wheel: run[topic].messages for wheel, topic in topics.items()}
    return {wheel: messages[-1] for wheel, messages in found.items() if messages}


def write_worn(run: Run, path: Path) -> None:
    """A CSV file, or JSON by the name's end. Raises ValueError for a log without wear, OSError."""
    found = worn_of(run)
    if not found:
        raise ValueError("holds no wear, allowed a log of a run whose scene has [damage]")
    if path.suffix.lower() == ".json":
        content = [
            {"wheelset": number, "side": side, **values} for (number, side), values in found.items()
        ]
        write_whole(path, json.dumps(content, allow_nan=False).encode())
        return
    lines = [",".join(HEAD)]
    for (number, side), values in found.items():
        columns = [values.get(name) or [] for name in LISTS]
        lines += [
            f"{number},{side}," + ",".join(repr(float(value)) for value in row)
            for row in zip(*columns, strict=True)
        ]
    write_whole(path, ("\n".join(lines) + "\n").encode())
