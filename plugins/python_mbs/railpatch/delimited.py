"""Text files of numbers, as machines and spreadsheets write them: reading that profiles and records
of measured runs share."""

from __future__ import annotations

import codecs
import re
from pathlib import Path

from railpatch.errors import FileError

COMMENT = ("!", "#", "%", "//")
# a comma between digits is a decimal one
DECIMAL_COMMA = re.compile(r"(?<=\d),(?=\d)")
UTF_16 = (codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)


def read_text(path: Path, error: type[FileError], absent: str, most: int) -> str:
    """The file's text, whatever its encoding; a mark of the byte order is left out.

    absent: what is said of a file that is not there. most: bytes. Raises ``error`` for what is
    absent, empty, larger, or no text.
    """
    if not path.is_file():
        raise error(path, absent)
    if path.stat().st_size > most:
        raise error(path, f"is larger than {most} bytes")
    data = path.read_bytes()
    if not data.strip():
        raise error(path, "is empty")
    if data.startswith(UTF_16):
        return data.decode("utf-16", errors="replace")
    if b"\0" in data:
        raise error(path, "is not a text file")
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError:
        return data.decode("latin-1")


def number(word: str) -> float:
    """Of one word; Fortran writes 1.0D+00. Raises ValueError."""
    return float(re.sub("[dD]", "e", word))


def decimal_points(text: str) -> str:
    """With points for the commas between digits."""
    return DECIMAL_COMMA.sub(".", text)
