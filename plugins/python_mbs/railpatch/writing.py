"""Writes a file whole or not at all; what is no file, as a device or a pipe, is written through."""

from __future__ import annotations

import os
from pathlib import Path


def write_whole(output: str | os.PathLike[str], content: bytes) -> Path:
    """Writes a file's new content, or leaves it as it was; returns ``output``.

    Links are followed. Raises OSError, with the name of the output.
    """
    output = Path(output)
    target = output.resolve()
    temporary = target.with_name(f".{os.getpid()}.{target.name}"[:200])
    try:
        if target.exists() and not target.is_file():
            target.write_bytes(content)
            return output
        temporary.write_bytes(content)
        if target.exists():
            temporary.chmod(target.stat().st_mode)
        temporary.replace(target)
    except OSError as error:
        raise OSError(error.errno, error.strerror, str(output)) from None
    finally:
        temporary.unlink(missing_ok=True)
    return output
