"""Writes contact_addon.f90, the interface as a Fortran module, from contact_addon.h beside it:
python fortran.py. A test holds both together."""

from __future__ import annotations

import re
from pathlib import Path

HERE = Path(__file__).parent
HEAD = """! The calls of contact_addon.h for Fortran, made from it by fortran.py. Scalars, arrays
! alike go by reference; arrays have any length.
module contact_addon
  use, intrinsic :: iso_c_binding
  implicit none
  interface
"""
KINDS = {"int": "integer(c_int)", "double": "real(c_double)", "char": "character(kind=c_char)"}


def module(header: str) -> str:
    """The module's text."""
    lines = [HEAD]
    for name, arguments in re.findall(r"CNTC_API void (\w+)\(([^)]*)\);", header):
        pairs = re.findall(r"(int|double|char) \*(\w+)", arguments)
        lines.append(f"    subroutine {name}( &\n      {names(pairs)}) bind(c)\n      import\n")
        lines += [f"      {KINDS[kind]} :: {word}(*)\n" for kind, word in pairs]
        lines.append(f"    end subroutine {name}\n")
    lines.append("  end interface\nend module contact_addon\n")
    return "".join(lines).replace("( &\n      ) bind", "() bind")


def names(pairs: list[tuple[str, str]]) -> str:
    """The arguments, a few on each line."""
    words = [word for _, word in pairs]
    rows = [", ".join(words[i : i + 6]) for i in range(0, len(words), 6)]
    return ", &\n      ".join(rows)


if __name__ == "__main__":
    text = module((HERE / "contact_addon.h").read_text(encoding="utf-8"))
    (HERE / "contact_addon.f90").write_text(text, encoding="utf-8")
