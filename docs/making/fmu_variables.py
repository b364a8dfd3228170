"""Variables of FMUs, from the list that modelDescription.xml is made from."""

from __future__ import annotations

import re

from railpatch.fmu.table import Table, Variable

from making import ROOT, Pages, cell, code, table

SOURCE = ROOT / "plugins/fmu/variables.toml"


def generic(variable: Variable) -> str:
    """The name with SIDE and P in the place of a side and a patch's number."""
    name = variable.name
    if variable.side is not None:
        name = re.sub(r"\b(left|right)\b", "SIDE", name)
    return re.sub(r"patch\[\d+\]", "patch[P]", name) if variable.patch is not None else name


def pages() -> Pages:
    """reference/fmu_variables.md."""
    found = Table(SOURCE)
    lines = [
        "# Variables of an FMU",
        "",
        "An FMU has those that its scene needs. Names are those of a wheelset: `SIDE` is `left` or"
        " `right`, `P` a patch, 1 to 6. One wheel has no `SIDE.` before its outputs, a patch no"
        " `patch[P].` either. A value reference is that of the left side's first patch; the right"
        " side adds 1000, each further patch 100.",
        "",
    ]
    seen: set[tuple[str, str]] = set()
    groups: dict[str, list[list[str]]] = {"input": [], "parameter": [], "output": []}
    for variable in found.everything():
        name = generic(variable)
        # the independent one is the time, which every FMU has
        if (name, variable.causality) in seen or variable.causality not in groups:
            continue
        seen.add((name, variable.causality))
        declared = found.types[variable.type]
        low, high = variable.range
        groups[variable.causality].append(
            [
                code(name),
                str(variable.reference),
                cell(declared.get("unit", "")),
                f"{low:g} to {high:g}",
                cell(variable.description),
            ]
        )
    titles = {"input": "Inputs", "parameter": "Parameters", "output": "Outputs"}
    for causality, rows in groups.items():
        lines += [f"## {titles[causality]}", ""]
        lines += [table(["name", "value reference", "unit", "range", "meaning"], rows), ""]
    lines += ["## Enumerations", ""]
    rows = [
        [code(name), ", ".join(declared["items"]) or "those that the scene has"]
        for name, declared in found.types.items()
        if "items" in declared
    ]
    lines += [table(["type", "items"], rows), ""]
    return {"reference/fmu_variables.md": "\n".join(lines)}
