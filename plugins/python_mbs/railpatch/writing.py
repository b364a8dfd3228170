"""Writes a file whole or not at all; what is no file, as a device or a pipe, is written through."""

from __future__ import annotations

import os
from pathlib import Path


def write_whole(output: str | os.PathLike[str], content: bytes) -> Path:
    """Writes a file's new content, or leaves it as it was; returns ``output``.

    Links are followed. Raises OSError.
    """
    output = Path(output)
    target = output.resolve()
    if target.exists() and not target.is_file():
        target.write_bytes(content)
        return output
    temporary = target.with_name(f".{os.getpid()}.{target.name}"[:200])
    try:
        temporary.write_bytes(content)
        if target.exists():
            temporary.chmod(target.stat().st_mode)
        temporary.replace(target)
    finally:
        temporary.unlink(missing_ok=True)
    return output
