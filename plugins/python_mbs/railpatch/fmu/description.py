"""modelDescription.xml of a scene, from the table of variables."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any
from xml.sax.saxutils import quoteattr

from railpatch.fmu.step_size import StepSize
from railpatch.fmu.table import Kind, Table, Variable, dependencies, first_item

# base units of SI: exponents
BASE_UNITS = {
    "1": {},
    "m": {"m": 1},
    "s": {"s": 1},
    "kg": {"kg": 1},
    "kg.m2": {"kg": 1, "m": 2},
    "rad": {"rad": 1},
    "m/s": {"m": 1, "s": -1},
    "rad/s": {"rad": 1, "s": -1},
    "rad/m": {"rad": 1, "m": -1},
    "N": {"kg": 1, "m": 1, "s": -2},
    "N.m": {"kg": 1, "m": 2, "s": -2},
    "Pa": {"kg": 1, "m": -1, "s": -2},
    "m2": {"m": 2},
    "W": {"kg": 1, "m": 2, "s": -3},
    "J": {"kg": 1, "m": 2, "s": -2},
    "m3/s": {"m": 3, "s": -1},
    "degC": {"K": 1, "offset": 273.15},
    # of constants
    "%": {"factor": 0.01},
    "m/s2": {"m": 1, "s": -2},
    "1/m": {"m": -1},
    "1/s": {"s": -1},
    "s/m": {"s": 1, "m": -1},
    "1/N": {"kg": -1, "m": -1, "s": 2},
    "N/m": {"kg": 1, "s": -2},
    "N.s/m": {"kg": 1, "s": -1},
    "Pa/m": {"kg": 1, "m": -2, "s": -2},
    "Pa.s": {"kg": 1, "m": -1, "s": -1},
    "K": {"K": 1},
    "W/K": {"kg": 1, "m": 2, "s": -3, "K": -1},
    "W/(m.K)": {"kg": 1, "m": 1, "s": -3, "K": -1},
    "J/(kg.K)": {"m": 2, "s": -2, "K": -1},
    "kg/m3": {"kg": 1, "m": -3},
    "J/m": {"kg": 1, "m": 1, "s": -2},
}
# that have no declared type: there is nothing to say of them
PLAIN = ("String", "Boolean")
CAPABILITIES = {
    "canHandleVariableCommunicationStepSize": "true",
    "canInterpolateInputs": "true",
    "canRunAsynchronuously": "false",
    "canBeInstantiatedOnlyOncePerProcess": "false",
    "canNotUseMemoryManagementFunctions": "true",
    "canGetAndSetFMUstate": "true",
    "canSerializeFMUstate": "true",
}
OF_SLAVES = (
    "canHandleVariableCommunicationStepSize",
    "canInterpolateInputs",
    "canRunAsynchronuously",
)
CATEGORIES = {
    "logStatusError": "The call was wrong, or cannot be carried out",
    "logStatusDiscard": "A step or value that the contact could not solve, and what to change",
    "logStatusWarning": "What can hardly be meant, though it was solved",
    "logAll": "All messages",
}


@dataclass(frozen=True)
class Labels:
    """What the FMU as a whole is called."""

    identifier: str  # of the model, and name of the library
    name: str
    description: str
    licence: str
    version: str
    date: str
    tolerance: float
    step: StepSize  # that masters take
    derivatives: bool  # of the outputs, from the core's
    warnings: tuple[str, ...] = ()  # what hardly can be meant

    def model(self) -> dict[str, str]:
        """Attributes of both interfaces."""
        own = {key: value for key, value in CAPABILITIES.items() if key not in OF_SLAVES}
        provides = {"providesDirectionalDerivative": str(self.derivatives).lower()}
        return {"modelIdentifier": self.identifier, **own, **provides}

    def slave(self) -> dict[str, str]:
        """Attributes of co-simulation."""
        own = {key: CAPABILITIES[key] for key in OF_SLAVES}
        return {**self.model(), **own, "maxOutputDerivativeOrder": str(int(self.derivatives))}


def description_xml(
    labels: Labels, table: Table, kind: Kind, variables: list[Variable], guid: str
) -> str:
    """The whole file."""
    head = {
        "fmiVersion": "2.0",
        "modelName": labels.name,
        "guid": guid,
        "description": labels.description,
        "version": labels.version,
        "license": labels.licence,
        "generationTool": f"Railpatch {labels.version}",
        "generationDateAndTime": labels.date,
        "variableNamingConvention": "structured",
        "numberOfEventIndicators": "0",
    }
    # states and events there are none, and what has a history cannot be asked twice
    exchange = [] if kind.has_history else [f"  <ModelExchange{attributes(labels.model())}/>"]
    lines = [
        '<?xml version="1.0" encoding="UTF-8"?>',
        f"<fmiModelDescription{attributes(head)}>",
        *exchange,
        f"  <CoSimulation{attributes(labels.slave())}/>",
        *unit_lines(table, variables),
        *type_lines(table, variables),
        *log_category_lines(),
        experiment_line(labels),
        "  <ModelVariables>",
        *(line for v in variables for line in variable_lines(table, v)),
        "  </ModelVariables>",
        *structure_lines(kind, variables),
        "</fmiModelDescription>",
        "",
    ]
    return "\n".join(lines)


def log_category_lines() -> list[str]:
    """LogCategories."""
    return [
        "  <LogCategories>",
        *(
            f"    <Category{attributes({'name': k, 'description': CATEGORIES[k]})}/>"
            for k in CATEGORIES
        ),
        "  </LogCategories>",
    ]


def experiment_line(labels: Labels) -> str:
    """DefaultExperiment."""
    listed = {"startTime": 0.0, "stopTime": 1.0, "tolerance": labels.tolerance}
    return f"  <DefaultExperiment{attributes({**listed, 'stepSize': labels.step.seconds})}/>"


def attributes(values: dict[str, Any]) -> str:
    """' a="1" b="2"'; None is left out."""
    return "".join(
        f" {key}={quoteattr(value if isinstance(value, str) else repr(value))}"
        for key, value in values.items()
        if value is not None
    )


def used_types(table: Table, variables: list[Variable]) -> dict[str, dict[str, Any]]:
    """Declared types that occur, in the table's order."""
    names = {v.type for v in variables}
    return {name: declared for name, declared in table.types.items() if name in names}


def unit_lines(table: Table, variables: list[Variable]) -> list[str]:
    """UnitDefinitions."""
    displays: dict[str, dict[str, dict[str, float]]] = {}
    for declared in used_types(table, variables).values():
        if "unit" in declared:
            name, *numbers = declared["display"]
            scale = dict(zip(("factor", "offset"), numbers, strict=False))
            displays.setdefault(declared["unit"], {})[name] = scale
    lines = ["  <UnitDefinitions>"]
    for unit, display in displays.items():
        lines.append(f"    <Unit{attributes({'name': unit})}>")
        lines.append(f"      <BaseUnit{attributes(BASE_UNITS[unit])}/>")
        for name, scale in display.items():
            lines.append(f"      <DisplayUnit{attributes({'name': name, **scale})}/>")
        lines.append("    </Unit>")
    return [*lines, "  </UnitDefinitions>"] if displays else []


def type_attributes(table: Table, name: str) -> dict[str, Any]:
    """What a declared type and each of its variables say."""
    declared = table.types[name]
    if "items" in declared:
        return {"quantity": name}
    if table.base(name) in PLAIN:
        return {}
    if "range" not in declared:  # a constant
        keys = ("quantity", "unit", "nominal")
        found = {key: declared[key] for key in keys if key in declared}
        return found | ({"displayUnit": declared["display"][0]} if "display" in declared else {})
    low, high = declared["range"]
    if "unit" not in declared:
        return {"quantity": name, "min": low, "max": high}
    return {
        "quantity": declared["quantity"],
        "unit": declared["unit"],
        "displayUnit": declared["display"][0],
        "min": low,
        "max": high,
        "nominal": declared["nominal"],
    }


def type_lines(table: Table, variables: list[Variable]) -> list[str]:
    """TypeDefinitions."""
    lines = ["  <TypeDefinitions>"]
    for name, declared in used_types(table, variables).items():
        base = table.base(name)
        if base in PLAIN:
            continue
        lines.append(f"    <SimpleType{attributes({'name': name})}>")
        element = f"      <{base}{attributes(type_attributes(table, name))}"
        if base == "Enumeration":
            lines.append(element + ">")
            for value, item in enumerate(declared["items"], first_item(declared)):
                lines.append(f"        <Item{attributes({'name': item, 'value': value})}/>")
            lines.append("      </Enumeration>")
        else:
            lines.append(element + "/>")
        lines.append("    </SimpleType>")
    return [*lines, "  </TypeDefinitions>"]


def variable_lines(table: Table, variable: Variable) -> list[str]:
    """One ScalarVariable."""
    role = {
        "name": variable.name,
        "valueReference": variable.reference,
        "description": variable.description,
        "causality": variable.causality,
        "variability": variability(variable),
        "initial": {"output": "calculated", "input": None}.get(variable.causality, "exact"),
    }
    value = {"declaredType": variable.type, **type_attributes(table, variable.type)}
    if variable.base == "Enumeration":
        value |= {"min": int(variable.range[0]), "max": int(variable.range[1])}
    if variable.base in PLAIN:
        value = {}
    value["start"] = start_text(variable)
    return [
        f"    <ScalarVariable{attributes(role)}>",
        f"      <{variable.base}{attributes(value)}/>",
        "    </ScalarVariable>",
    ]


def start_text(variable: Variable) -> Any:
    """A start value as XML has it."""
    return str(variable.start).lower() if variable.base == "Boolean" else variable.start


def variability(variable: Variable) -> str:
    """FMI's variability."""
    if variable.causality == "local":
        return "constant"
    if variable.causality == "parameter":
        return "fixed" if variable.fixed else "tunable"
    return "continuous" if variable.base == "Real" else "discrete"


def structure_lines(kind: Kind, variables: list[Variable]) -> list[str]:
    """ModelStructure: outputs depend on inputs, at the start on parameters too."""
    number = {v.reference: i for i, v in enumerate(variables, 1)}
    known = [v for v in variables if v.causality in ("input", "parameter")]
    inputs = [v for v in known if v.causality == "input"]
    lines = ["  <ModelStructure>"]
    for tag, candidates in (("Outputs", inputs), ("InitialUnknowns", known)):
        lines.append(f"    <{tag}>")
        for v in variables:
            if v.causality == "output":
                found = [number[d.reference] for d in dependencies(v, candidates, kind)]
                kinds = " ".join(["dependent"] * len(found))
                listed = {
                    "index": number[v.reference],
                    "dependencies": " ".join(map(str, found)),
                    "dependenciesKind": kinds,
                }
                lines.append(f"      <Unknown{attributes(listed)}/>")
        lines.append(f"    </{tag}>")
    return [*lines, "  </ModelStructure>"]
