"""The scene as constants of the FMU: every key of the case that is fixed when it is packed."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from railpatch.case.key_units import unit_of_text
from railpatch.case.load import Case
from railpatch.case.types import SIDES
from railpatch.case.wheel import Deviation
from railpatch.fmu.table import Table, Variable
from railpatch.fmu.this_scene import keys_of

# value references: above those of every side and patch
FIRST = 4001
# numbers of a list; longer ones stand on the FMU's page only
MOST_NUMBERS = 12
# tables of which a key that keeps its default is of no interest, but for these
QUIET = ("method.", "friction.", "layer.")
TOLD = ("method.normal", "method.tangential", "method.tolerance", "friction.law")
# of the case, said elsewhere: whether the FMU has derivatives is an attribute of its interfaces
LEFT_OUT = {"method.derivatives"}
# unit of a key -> declared type, quantity, unit of FMI, display unit, its factor
UNITS: dict[str, tuple[str, str, str, str, float]] = {
    "-": ("Number", "Number", "1", "%", 100.0),
    "": ("Number", "Number", "1", "%", 100.0),
    "%": ("Percentage", "Percentage", "%", "1", 0.01),
    "s": ("Duration", "Time", "s", "ms", 1000.0),
    "m": ("Size", "Length", "m", "mm", 1000.0),
    "m/s": ("Speed", "Velocity", "m/s", "km/h", 3.6),
    "m/s^2": ("Acceleration", "Acceleration", "m/s2", "mm/s2", 1000.0),
    "rad": ("FixedAngle", "Angle", "rad", "deg", 57.29577951308232),
    "rad/s": ("FixedRate", "AngularVelocity", "rad/s", "1/min", 9.549296585513721),
    "rad/m": ("FixedSpin", "SpinCreepage", "rad/m", "deg/m", 57.29577951308232),
    "1/m": ("Curvature", "Curvature", "1/m", "1/km", 1000.0),
    "1/s": ("Frequency", "Frequency", "1/s", "1/min", 60.0),
    "Hz": ("Frequency", "Frequency", "1/s", "1/min", 60.0),
    "s/m": ("Slowness", "Slowness", "s/m", "ms/m", 1000.0),
    "N": ("FixedForce", "Force", "N", "kN", 0.001),
    "1/N": ("Compliance", "InverseForce", "1/N", "1/kN", 1000.0),
    "N/m": ("Stiffness", "Stiffness", "N/m", "kN/mm", 1e-6),
    "N s/m": ("Damping", "Damping", "N.s/m", "kN.s/m", 0.001),
    "N m": ("FixedMoment", "Torque", "N.m", "kN.m", 0.001),
    "kg": ("FixedMass", "Mass", "kg", "t", 0.001),
    "kg m^2": ("FixedInertia", "MomentOfInertia", "kg.m2", "t.m2", 0.001),
    "Pa": ("Stress", "Stress", "Pa", "MPa", 1e-6),
    "Pa/m": ("Hardening", "StressPerLength", "Pa/m", "MPa/mm", 1e-9),
    "Pa s": ("Viscosity", "DynamicViscosity", "Pa.s", "mPa.s", 1000.0),
    "K": ("TemperatureDifference", "TemperatureDifference", "K", "mK", 1000.0),
    "degrees C": ("FixedTemperature", "ThermodynamicTemperature", "degC", "mdegC", 1000.0),
    "m^2": ("FixedArea", "Area", "m2", "mm2", 1e6),
    "m^3/s": ("FixedFlow", "VolumeFlowRate", "m3/s", "ul/s", 1e9),
    "W/K": ("Conductance", "ThermalConductance", "W/K", "kW/K", 0.001),
    "W/(m K)": ("Conductivity", "ThermalConductivity", "W/(m.K)", "mW/(m.K)", 1000.0),
    "J/(kg K)": ("HeatCapacity", "SpecificHeatCapacity", "J/(kg.K)", "kJ/(kg.K)", 0.001),
    "kg/m^3": ("Density", "Density", "kg/m3", "g/cm3", 0.001),
    "J": ("FixedEnergy", "Energy", "J", "mJ", 1000.0),
    "J/m": ("WorkPerLength", "WorkPerLength", "J/m", "kJ/m", 0.001),
}
TEXT, FLAG, COUNT = "Text", "Flag", "FixedCount"


@dataclass(frozen=True)
class Constant:
    """One number, text or truth value of a case."""

    name: str
    value: float | int | bool | str
    unit: str  # as in the case's schema
    meaning: str
    component: int  # of a list of numbers, from 1; 0: alone
    size: int


def constants_of(case: Case, table: Table, variables: list[Variable]) -> list[Variable]:
    """The case's fixed keys as variables; gives the table their types. variables: those of the
    FMU, whose names they do not take."""
    taken = {v.name.partition("[")[0] for v in variables}
    # of each wheel they are inputs
    own = {v.name.rpartition(".")[2] for v in variables if v.field.startswith("friction_scale")}
    taken |= {f"friction.{key}" for key in (own | {"scale"} if own else own)}
    found = []
    for constant in numbered(case, taken):
        declared, kind = type_of(constant)
        table.types.setdefault(declared, kind)
        found.append(
            Variable(
                reference=FIRST + len(found),
                name=constant.name,
                type=declared,
                base=table.base(declared),
                causality="local",
                field="",
                plus="",
                level="none",
                side=None,
                range=(-1e300, 1e300),
                description=f"Constant of the scene: {constant.meaning}",
                start=constant.value,
                component=constant.component,
                size=constant.size,
            )
        )
    return found


def numbered(case: Case, taken: set[str]) -> Iterator[Constant]:
    """Every key that is fixed, and of a list each number."""
    untold = moves_of(case) | taken | LEFT_OUT
    for name, value, text, usual in keys_of(case, ""):
        if name in untold or (usual and name.startswith(QUIET) and name not in TOLD):
            continue
        unit, meaning = unit_of_text(text), meaning_of(text)
        if isinstance(value, (list, tuple)):
            yield from of_list(name, value, unit, meaning)
        elif isinstance(value, (bool, int, float, str)):
            yield Constant(name, value, unit, meaning, 0, 1)


def moves_of(case: Case) -> set[str]:
    """Keys that move: inputs where they have an effect, else of no interest."""
    found = set()
    for table in ("load", "motion", "wheelset", "track"):
        for key in getattr(getattr(case, table, None), "moving", ()):
            # of the tables of wheels and rails what deviates; shapes stay
            parts = Deviation.model_fields if key in SIDES else ()
            found |= {f"{table}.{key}.{part}" for part in parts} or {f"{table}.{key}"}
    return found


def of_list(name: str, value: Any, unit: str, meaning: str) -> Iterator[Constant]:
    """The numbers of a list, or of a list of lists."""
    flat = [v for row in value for v in row] if is_table(value) else list(value)
    if not 0 < len(flat) <= MOST_NUMBERS or not all(is_number(v) for v in flat):
        return
    if is_table(value):
        units = re.split(r", | and ", unit)
        for i, row in enumerate(value, 1):
            for k, number in enumerate(row, 1):
                own = units[min(k, len(units)) - 1]
                yield Constant(f"{name}[{i},{k}]", number, own, meaning, 0, 1)
        return
    whole = all(isinstance(v, int) for v in flat)
    for k, number in enumerate(flat, 1):
        one = number if whole else float(number)
        alone = len(flat) == 1 or whole
        size = 1 if alone else len(flat)
        yield Constant(f"{name}[{k}]", one, unit, meaning, 0 if alone else k, size)


def is_table(value: Any) -> bool:
    """Whether it is a list of rows."""
    return all(isinstance(row, (list, tuple)) for row in value)


def is_number(value: Any) -> bool:
    """Whether it is a number, and no truth value."""
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def meaning_of(text: str) -> str:
    """A key's description without its unit, and without the note on what is hardly meant."""
    plain = text.partition("; hardly meant")[0].replace(" (no unit)", "").replace(", no unit", "")
    unit = unit_of_text(plain)
    plain = plain.removeprefix(f"{unit}, ") if unit else plain.removeprefix("(no unit)")
    return plain.strip()


def type_of(constant: Constant) -> tuple[str, dict[str, Any]]:
    """Name of the declared type, and what it says."""
    if isinstance(constant.value, bool):
        return FLAG, {"flag": True}
    if isinstance(constant.value, str):
        return TEXT, {"text": True}
    if isinstance(constant.value, int):
        return COUNT, {"whole": True}
    # a unit that is not listed here is said in the description
    name, quantity, unit, display, factor = UNITS.get(constant.unit, UNITS["-"])
    return name, {"quantity": quantity, "unit": unit, "display": [display, factor], "nominal": 1.0}
