"""modelDescription.xml of FMI 3.0, from the same table: vectors are arrays."""

from __future__ import annotations

from typing import Any

from railpatch.fmu.description import (
    PLAIN,
    Labels,
    attributes,
    experiment_line,
    log_category_lines,
    start_text,
    type_attributes,
    unit_lines,
    used_types,
    variability,
)
from railpatch.fmu.table import (
    Item,
    Kind,
    Table,
    Variable,
    dependencies,
    first_item,
    items_of,
)

# names of FMI 3.0 for the base types of FMI 2.0
ELEMENTS = {
    "Real": "Float64",
    "Integer": "Int32",
    "Enumeration": "Enumeration",
    "String": "String",
    "Boolean": "Boolean",
}


def description3_xml(
    labels: Labels, table: Table, kind: Kind, variables: list[Variable], token: str
) -> str:
    """The whole file."""
    head = {
        "fmiVersion": "3.0",
        "modelName": labels.name,
        "instantiationToken": token,
        "description": labels.description,
        "version": labels.version,
        "license": labels.licence,
        "generationTool": f"Railpatch {labels.version}",
        "generationDateAndTime": labels.date,
        "variableNamingConvention": "structured",
    }
    model = {
        "modelIdentifier": labels.identifier,
        "canGetAndSetFMUState": "true",
        "canSerializeFMUState": "true",
        "providesDirectionalDerivatives": str(labels.derivatives).lower(),
        "providesAdjointDerivatives": str(labels.derivatives).lower(),
    }
    exchange = [] if kind.has_history else [f"  <ModelExchange{attributes(model)}/>"]
    slave = {**model, "canHandleVariableCommunicationStepSize": "true"}
    items = items_of(variables, 3)
    lines = [
        '<?xml version="1.0" encoding="UTF-8"?>',
        f"<fmiModelDescription{attributes(head)}>",
        *exchange,
        f"  <CoSimulation{attributes(slave)}/>",
        *unit_lines(table, variables),
        *type_lines(table, variables),
        *log_category_lines(),
        experiment_line(labels),
        "  <ModelVariables>",
        *(line for item in items for line in variable_lines(table, item)),
        "  </ModelVariables>",
        *structure_lines(kind, items),
        "</fmiModelDescription>",
        "",
    ]
    return "\n".join(lines)


def type_lines(table: Table, variables: list[Variable]) -> list[str]:
    """TypeDefinitions."""
    lines = ["  <TypeDefinitions>"]
    for name, declared in used_types(table, variables).items():
        base = table.base(name)
        if base in PLAIN:
            continue
        element = f"    <{ELEMENTS[base]}Type"
        listed = attributes({"name": name, **type_attributes(table, name)})
        if base != "Enumeration":
            lines.append(f"{element}{listed}/>")
            continue
        lines.append(f"{element}{listed}>")
        for value, item in enumerate(declared["items"], first_item(declared)):
            lines.append(f"      <Item{attributes({'name': item, 'value': value})}/>")
        lines.append(f"    </{ELEMENTS[base]}Type>")
    return [*lines, "  </TypeDefinitions>"]


def variable_lines(table: Table, item: Item) -> list[str]:
    """One variable, which may be an array."""
    first = item.first
    listed: dict[str, Any] = {
        "name": item.name,
        "valueReference": first.reference,
        "description": item.description,
        "causality": first.causality,
        "variability": variability(first),
    }
    element = ELEMENTS[first.base]
    if first.base == "String":
        start = attributes({"value": str(first.start)})
        listed["initial"] = "exact"
        return [
            f"    <{element}{attributes(listed)}>",
            f"      <Start{start}/>",
            f"    </{element}>",
        ]
    if first.base == "Boolean":
        listed |= {"initial": "exact", "start": start_text(first)}
        return [f"    <{element}{attributes(listed)}/>"]
    listed["declaredType"] = first.type
    if first.causality != "independent":
        listed["initial"] = "calculated" if first.causality == "output" else "exact"
    listed |= type_attributes(table, first.type)
    if first.base == "Enumeration":
        listed |= {"min": int(first.range[0]), "max": int(first.range[1])}
    if first.causality not in ("output", "independent"):
        listed["start"] = " ".join(repr(v.start) for v in item.variables)
    if not item.is_array:
        return [f"    <{element}{attributes(listed)}/>"]
    size = attributes({"start": str(len(item.variables))})
    return [
        f"    <{element}{attributes(listed)}>",
        f"      <Dimension{size}/>",
        f"    </{element}>",
    ]


def structure_lines(kind: Kind, items: list[Item]) -> list[str]:
    """ModelStructure: outputs depend on inputs, at the start on parameters too."""
    known = [v for item in items for v in item.variables if v.causality in ("input", "parameter")]
    inputs = [v for v in known if v.causality == "input"]
    whole = {v.reference: item.first.reference for item in items for v in item.variables}
    lines = ["  <ModelStructure>"]
    for tag, candidates in (("Output", inputs), ("InitialUnknown", known)):
        for item in items:
            if item.first.causality != "output":
                continue
            found = {
                whole[d.reference]: None
                for v in item.variables
                for d in dependencies(v, candidates, kind)
            }
            listed = {
                "valueReference": item.first.reference,
                "dependencies": " ".join(map(str, found)),
                "dependenciesKind": " ".join(["dependent"] * len(found)),
            }
            lines.append(f"    <{tag}{attributes(listed)}/>")
    return [*lines, "  </ModelStructure>"]
