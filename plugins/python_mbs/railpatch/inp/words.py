"""The words of an input file: numbers, angles, strings, over lines, with what may be left out."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from pathlib import Path

from railpatch.errors import CaseError

# a longer file is no input file
MAX_BYTES = 20_000_000
MAX_LINE = 256
REAL = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)([eEdD][-+]?\d+)?$")
ANGLE = re.compile(r"([-+]?(?:\d+\.?\d*|\.\d+))(d|r|rad|radians|deg|degrees)$", re.IGNORECASE)
WORD = re.compile(r"'[^']*'|[^\s,=]+")


@dataclass(frozen=True)
class Word:
    """A word and the line it stands on."""

    text: str
    line: int


class Reader:
    """Takes words one after the other. name: of the file, for errors."""

    def __init__(self, name: str, text: str) -> None:
        self.name = name
        self._rows: list[list[Word]] = []
        for number, line in enumerate(text.splitlines(), 1):
            if len(line) > MAX_LINE:
                raise CaseError(f"{name}, line {number}: is longer than {MAX_LINE} characters")
            row = [Word(word, number) for word in WORD.findall(line.split("%", 1)[0])]
            if row:
                self._rows.append(row)
        self._row, self._at = 0, 0

    @property
    def ended(self) -> bool:
        """Whether no line is left."""
        return self._row >= len(self._rows)

    @property
    def line(self) -> int:
        """Of the next word, or the last line."""
        row = min(self._row, len(self._rows) - 1)
        return self._rows[row][0].line if self._rows else 0

    def error(self, what: str, line: int | None = None) -> CaseError:
        """Of a line, to be raised."""
        return CaseError(f"{self.name}, line {self.line if line is None else line}: {what}")

    def _next(self, what: str) -> Word:
        while self._row < len(self._rows) and self._at >= len(self._rows[self._row]):
            self._row, self._at = self._row + 1, 0
        if self.ended:
            raise CaseError(f"{self.name}: ends where {what} is needed")
        word = self._rows[self._row][self._at]
        self._at += 1
        return word

    def end_line(self) -> None:
        """What is left of the line is comment."""
        if self._at > 0:
            self._row, self._at = self._row + 1, 0

    def real(self, what: str, *, angle: bool = False) -> float:
        """A mandatory number; angle: degrees as 90d, radians as 1.57r."""
        word = self._next(what)
        value = number_of(word.text, angle=angle)
        if value is None:
            raise self.error(f"{what}: expected a number, found {word.text[:40]!r}", word.line)
        return value

    def reals(self, names: str, angles: tuple[str, ...] = ()) -> dict[str, float]:
        """Mandatory numbers by name; the line's rest stays for optional ones."""
        return {name: self.real(name, angle=name in angles) for name in names.split()}

    def integer(self, what: str) -> int:
        """A mandatory whole number."""
        value = self.real(what)
        if value != int(value) or abs(value) > 2**31:
            raise self.error(f"{what}: expected a whole number, found {value:g}")
        return int(value)

    def digits(self, what: str) -> str:
        """A control word."""
        word = self._next(what)
        if not re.fullmatch(r"\d{1,9}", word.text):
            raise self.error(f"{what}: expected digits, found {word.text[:40]!r}", word.line)
        return word.text

    def optional(self, *, angle: bool = False) -> float | None:
        """A number that stands on the line of the last one, or None."""
        if self.ended or self._at >= len(self._rows[self._row]):
            return None
        value = number_of(self._rows[self._row][self._at].text, angle=angle)
        if value is not None:
            self._at += 1
        return value

    def string(self, what: str) -> str:
        """A text between apostrophes."""
        word = self._next(what)
        if not re.fullmatch(r"'[^']*'", word.text):
            found = f"expected a name in '...', found {word.text[:40]!r}"
            raise self.error(f"{what}: {found}", word.line)
        return word.text[1:-1].strip()


def number_of(text: str, *, angle: bool = False) -> float | None:
    """A number in any Fortran form, or None."""
    if angle and (found := ANGLE.match(text)):
        value = float(found[1])
        return math.radians(value) if found[2][0] in "dD" else value
    if not REAL.match(text):
        return None
    value = float(re.sub("[dD]", "e", text))
    return value if math.isfinite(value) else None


def read_text(path: Path) -> str:
    """A file's text. Raises CaseError."""
    try:
        if path.stat().st_size > MAX_BYTES:
            raise CaseError(f"{path}: is larger than 20 MB")
        return path.read_bytes().decode("utf-8", errors="replace")
    except OSError as error:
        raise CaseError(f"{path}: {error.strerror or error}") from error
