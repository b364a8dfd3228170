"""Tables and numbers of pages; every text that comes from a file is escaped here."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from html import escape

import numpy as np


def table(head: Sequence[str], rows: Iterable[Sequence[object]], css: str = "") -> str:
    """An HTML table; cells are escaped, columns of numbers aligned to the right."""
    rows = [list(row) for row in rows]
    numeric = [all(_is_number(value) for value in column) for column in zip(*rows, strict=True)]
    parts = [f'<div class="scroll"><table class="{escape(css)}">']
    if head:
        parts.append("<thead>" + _row("th", head, numeric or [False] * len(head)) + "</thead>")
    parts += [_row("td", row, numeric) for row in rows]
    return "".join([*parts, "</table></div>"])


# of numbers of pages, which are in units for people (kN, mm, MPa): less is rounding
ROUNDING = 1e-12
# characters, of cells that may be broken into lines, but not at every word
LONG = 30


def number(value: float) -> str:
    """Four digits, large numbers whole; a dash where there is no number, 0 for rounding."""
    if not np.isfinite(value):
        return "-"
    if abs(value) < ROUNDING:
        return "0"
    return f"{value:.4g}".replace("-", "\u2212") if abs(value) < 9999.5 else whole(value)


def short(value: float) -> str:
    """Three digits, for what is read at a glance; very large and small ones with a power of ten."""
    if not np.isfinite(value):
        return "-"
    digits, _, power = f"{value:.2e}".partition("e")
    if value == 0 or -4 < int(power) < 6:
        return number(float(f"{value:.3g}"))
    return f"{float(digits):g}\u00d710{power_text(int(power))}".replace("-", "\u2212")


def power_text(power: int) -> str:
    """In superscript digits."""
    return str(power).translate(str.maketrans("-0123456789", "\u207b\u2070\u00b9\u00b2\u00b3"
        "\u2074\u2075\u2076\u2077\u2078\u2079"))  # fmt: skip


def whole(value: float) -> str:
    """Whole number with narrow spaces between thousands, where no line breaks; a dash where there
    is no number."""
    if not np.isfinite(value):
        return "-"
    return f"{value:,.0f}".replace(",", "\u202f").replace("-", "\u2212")


def _row(tag: str, cells: Sequence[object], numeric: Sequence[bool]) -> str:
    shown = (
        f"<{tag}{_kind(tag, str(cell), right)}>{escape(str(cell))}</{tag}>"
        for cell, right in zip(cells, numeric, strict=True)
    )
    return f"<tr>{''.join(shown)}</tr>"


def _kind(tag: str, text: str, right: bool) -> str:
    """Numbers stand to the right; sentences are not squeezed into a column of single words."""
    if right:
        return " class=n"
    return " class=long" if tag == "td" and len(text) > LONG else ""


def _is_number(value: object) -> bool:
    text = str(value)
    return text == "-" or (text.lstrip("\u2212")[:1].isdigit() and " " not in text)
