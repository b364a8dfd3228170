"""Which of the files in sources/ an importer compiles: buildDescription.xml and <SourceFiles>."""

from __future__ import annotations

import re
from collections.abc import Iterable
from xml.sax.saxutils import quoteattr

# in C++20 the library would hold parts of std::string, which the system's C++ library, where no
# other program has loaded it, takes from here and never lets go
LANGUAGE, COMPILER = "C++17", "gcc"
# the same inputs give the same bits only where no products and sums are fused; objects that are
# unique in a process would keep the library loaded
OPTIONS = "-std=c++17 -ffp-contract=off -O3 -fno-gnu-unique"


def of_version(path: str, version: int) -> bool:
    """Whether a file below sources/ is none of the other version's."""
    return re.search(rf"(^|/)fmi{5 - version}[^/]*$", path) is None


def compiled(paths: Iterable[str]) -> list[str]:
    """The translation units among files below sources/."""
    return sorted(path for path in paths if path.endswith(".cpp"))


def build_description(identifier: str, paths: Iterable[str]) -> str:
    """sources/buildDescription.xml, in the form of FMI 3.0, which FMI 2.0.4 recommends."""
    files = [f"      <SourceFile name={quoteattr(path)}/>" for path in compiled(paths)]
    how = {"language": LANGUAGE, "compiler": COMPILER, "compilerOptions": OPTIONS}
    attributes = " ".join(f"{key}={quoteattr(value)}" for key, value in how.items())
    lines = [
        '<?xml version="1.0" encoding="UTF-8"?>',
        '<fmiBuildDescription fmiVersion="3.0">',
        f"  <BuildConfiguration modelIdentifier={quoteattr(identifier)}>",
        f"    <SourceFileSet {attributes}>",
        *files,
        '      <IncludeDirectory name="."/>',
        "    </SourceFileSet>",
        "  </BuildConfiguration>",
        "</fmiBuildDescription>",
        "",
    ]
    return "\n".join(lines)


def with_source_files(description: str, paths: Iterable[str]) -> str:
    """modelDescription.xml with the list in each of its interfaces."""
    names = compiled(paths)
    if not names:
        return description
    files = "".join(f"      <File name={quoteattr(name)}/>\n" for name in names)
    inside = f"    <SourceFiles>\n{files}    </SourceFiles>\n"
    return re.sub(
        r"  <(CoSimulation|ModelExchange)([^>]*)/>\n",
        lambda found: f"  <{found[1]}{found[2]}>\n{inside}  </{found[1]}>\n",
        description,
    )
