"""Where the core can be changed by one token, and to what."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

# numbers that are printed in tables are checked against their sources, not by mutants
GENERATED = {"kalker_table.inc", "error_model.inc", "elementary_table.inc"}

SWAPPED = {
    "+": "-",
    "-": "+",
    "*": "/",
    "/": "*",
    "%": "*",
    "+=": "-=",
    "-=": "+=",
    "*=": "/=",
    "/=": "*=",
    "==": "!=",
    "!=": "==",
    "&&": "||",
    "||": "&&",
    "++": "--",
    "--": "++",
    "min": "max",
    "max": "min",
    "sin": "cos",
    "cos": "sin",
    "floor": "ceil",
    "ceil": "floor",
    "true": "false",
    "false": "true",
}
# the end of an interval, and the other side
COMPARED = {"<": ("<=", ">"), "<=": ("<", ">="), ">": (">=", "<"), ">=": (">", "<=")}

TOKEN = re.compile(
    r"""
    (?<=\S\s)(?P<between>\+=|-=|\*=|/=|==|!=|<=|>=|&&|\|\||[-+*/%<>])(?=\s)
  | (?P<step>\+\+|--)(?=\w)
  | (?P<word>(?<=std::)(?:min|max|sin|cos|floor|ceil)\b(?=\()|\b(?:true|false)\b)
  | (?P<sign>(?<=[\s(\[{,])-(?=[A-Za-z_(])|!(?=[A-Za-z_(]))
  | (?<![\w.])(?P<number>\d[\d']*(?:\.\d*)?(?:e[-+]?\d+)?)(?![\w.])
    """,
    re.VERBOSE,
)
# neither comments, texts nor what the preprocessor reads
BLANK = re.compile(
    r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])\'|^[ \t]*#[^\n]*', re.S | re.M
)
# sizes and what holds at compile time: the compiler's to check, or memory that nothing reads
FIXED = re.compile(
    r"\bstatic_assert\s*\(.*?\);"
    r"|\btemplate\s*<[^;{]*?>(?=\s)"
    r"|<[\w:\s*,]*>"
    r"|\b(?:double|float|int|bool|char|size_t|auto|real|[a-z_]+_t|T)\s+\*?\w+(?:\[[^\]]*\])+",
    re.S,
)


@dataclass(frozen=True)
class Mutant:
    """One token of a file, and what stands there instead."""

    path: str  # in the project
    line: int
    begin: int
    token: str
    instead: str
    before: str  # the line
    after: str

    def applied(self, text: str) -> str:
        """The file's text with the change."""
        end = self.begin + len(self.token)
        if text[self.begin : end] != self.token:
            raise ValueError(f"{self.path}: {self.token} is not at {self.begin}")
        return text[: self.begin] + self.instead + text[end:]

    def __str__(self) -> str:
        return f"{self.path}:{self.line}\n  - {self.before}\n  + {self.after}"


def other_numbers(number: str) -> list[str]:
    """One more and less of an integer; double and half; a thousand times of a power of ten."""
    if number.isdigit():
        n = int(number)
        return ["1"] if n == 0 else [str(n - 1), str(n + 1)]
    value = float(number.replace("'", ""))
    if value == 0:
        return ["1.0"]
    factors = (1e-3, 1e3) if "e" in number else (0.5, 2.0)
    return [repr(value * factor) for factor in factors]


def others(match: re.Match[str]) -> list[str]:
    """What can stand in a token's place."""
    token = match[0]
    if match["number"]:
        return other_numbers(token)
    if match["sign"]:
        return [""]
    if token in COMPARED:
        return list(COMPARED[token])
    return [SWAPPED[token]]


def blanked(text: str) -> str:
    """The text with spaces in the place of what is never changed."""

    def spaces(match: re.Match[str]) -> str:
        return re.sub(r"[^\n]", " ", match[0])

    return FIXED.sub(spaces, BLANK.sub(spaces, text))


def mutants_of(root: Path, path: Path) -> list[list[Mutant]]:
    """The changes of one file, those of a token together."""
    text = path.read_text()
    lines = text.split("\n")
    found = []
    for match in TOKEN.finditer(blanked(text)):
        begin = match.start()
        number = text.count("\n", 0, begin)
        column = begin - (text.rfind("\n", 0, begin) + 1)
        line = lines[number]
        end = column + len(match[0])
        found.append(
            [
                Mutant(
                    str(path.relative_to(root)),
                    number + 1,
                    begin,
                    match[0],
                    other,
                    line.strip(),
                    (line[:column] + other + line[end:]).strip(),
                )
                for other in others(match)
            ]
        )
    return found


def all_mutants(root: Path) -> list[list[Mutant]]:
    """The changes of the whole core, in the files' order."""
    core = root / "core"
    paths = sorted([*core.glob("*/*.cpp"), *core.glob("*/*.hpp")])
    return [
        token for path in paths if path.name not in GENERATED for token in mutants_of(root, path)
    ]
