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
# what lines hold and which digit asks for them, by their first value: a line too few or too many
# shows where the next one is read
LINES = {
    "MODULE": "1, 3, or 0 at the end",
    "MAXGS": "solver, G other than 1",
    "PEN": "load and creepages",
    "FN": "load and creepages",
    "FSTAT": "friction, L = 0",
    "FKIN": "friction, L = 2, 3, 4",
    "FREF": "friction, L = 6",
    "MEMDST": "friction's memory, L = 2, 3, 4, 6",
    "CHI": "rolling direction, step and speed, T = 2, 3 with C3 >= 2",
    "IF_METH": "influence by angles, C3 = 4",
    "NU1": "materials of both bodies, C3 >= 2",
    "CDAMPN": "damping, M2 = 2",
    "BKTEMP": "heat, H = 3",
    "IPOTCN": "kind of grid, D = 2",
    "MX": "grid, D = 2",
    "IBASE": "undeformed distance, Z = 2",
    "DX": "grid and joining of patches, D >= 2",
    "GAUGHT": "track, Z = 1, 3",
    "'FILE'": "profile of the rail, Z = 3, or of the wheel, E = 3, 5",
    "DY": "deviation of the rail, Z = 2, 3",
    "KY": "springs under the rail, F = 3",
    "FBDIST": "wheelset, E = 3, 5",
    "S": "position, E >= 1",
    "VS": "velocity, E >= 2",
    "RPITCH": "velocity, E >= 2",
    "VX": "rates of deviation, E = 4, 5",
}


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
        self._lines: list[tuple[str, int]] = []

    def expect(self, names: str) -> None:
        """Says for errors what is read from here on: values by name, or what stands for them."""
        at_end = not self.ended and self._at >= len(self._rows[self._row])
        row = min(self._row + at_end, len(self._rows) - 1)
        self._lines.append((names, self._rows[row][0].line if self._rows else 0))

    def told(self) -> str:
        """Which line was expected where a word does not fit, and which was read before it."""
        if not self._lines:
            return ""
        (names, line), before = self._lines[-1], self._lines[:-1]
        text = f", in {_meant(names)}" if " " in names else ""
        earlier = [one for one in before if one[1] < line]
        if earlier:
            text += f"; before it line {earlier[-1][1]} was read as {_meant(earlier[-1][0])}"
        return text

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
            raise CaseError(f"{self.name}: ends where {what} is needed{self.told()}")
        word = self._rows[self._row][self._at]
        self._at += 1
        return word

    @property
    def beside(self) -> str:
        """What follows on the line of the last word, or nothing."""
        if self.ended or self._at >= len(self._rows[self._row]):
            return ""
        return self._rows[self._row][self._at].text

    def end_line(self) -> None:
        """What is left of the line is comment."""
        if self._at > 0:
            self._row, self._at = self._row + 1, 0

    def real(self, what: str, *, angle: bool = False) -> float:
        """A mandatory number; angle: degrees as 90d, radians as 1.57r."""
        word = self._next(what)
        value = number_of(word.text, angle=angle)
        if value is None:
            found = f"expected a number, found {word.text[:40]!r}"
            raise self.error(f"{what}: {found}{self.told()}", word.line)
        return value

    def reals(self, names: str, angles: tuple[str, ...] = ()) -> dict[str, float]:
        """Mandatory numbers by name; the line's rest stays for optional ones."""
        self.expect(names)
        return {name: self.real(name, angle=name in angles) for name in names.split()}

    def integer(self, what: str) -> int:
        """A mandatory whole number."""
        line, value = self.line, self.real(what)
        if value != int(value) or abs(value) > 2**31:
            found = f"expected a whole number, found {value:g}"
            raise self.error(f"{what}: {found}{self.told()}", line)
        return int(value)

    def digits(self, what: str) -> str:
        """A control word."""
        self.expect(what)
        word = self._next(what)
        if not re.fullmatch(r"\d{1,9}", word.text):
            found = f"expected digits, found {word.text[:40]!r}"
            raise self.error(f"{what}: {found}{self.told()}", word.line)
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
            raise self.error(f"{what}: {found}{self.told()}", word.line)
        return word.text[1:-1].strip()


def _meant(names: str) -> str:
    """Names of a line's values with what they are."""
    held = LINES.get(names) or LINES.get(names.split(" ", 1)[0])
    return f"{names} ({held})" if held else names


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
        return path.read_bytes().decode("utf-8-sig", errors="replace")
    except OSError as error:
        raise CaseError(f"{path}: {error.strerror or error}") from error
