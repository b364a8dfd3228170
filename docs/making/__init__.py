"""What makes the documentation's site: reference, tutorials and book from the sources of each.

``mkdocs build`` runs hooks.py. Each module gives pages as Markdown, by path in the site, from what
is installed and what stands in the checkout; nothing here states a fact of its own.
"""

from __future__ import annotations

from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
Pages = dict[str, str]


def cell(text: str) -> str:
    """Text for a cell of a table: one line, no bar, no tag."""
    flat = " ".join(text.split())
    return flat.replace("|", "\\|").replace("<", "&lt;").replace("*", "\\*").replace("_", "\\_")


def code(text: str) -> str:
    """Code for a cell of a table."""
    return f"`{' '.join(text.split())}`".replace("|", "\\|") if text else ""


def table(head: list[str], rows: list[list[str]]) -> str:
    """A table of cells that are Markdown already."""
    lines = [head, ["---"] * len(head), *rows]
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)
