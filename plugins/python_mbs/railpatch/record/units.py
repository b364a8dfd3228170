"""Units that a record may have, and what they are in SI units."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass

# N, of a pound force: 0.45359237 kg at 9.80665 m/s^2, both exact (NIST SP 811, B.8)
POUND_FORCE = 0.45359237 * 9.80665
DEGREE = math.pi / 180


@dataclass(frozen=True)
class Unit:
    """value in SI = factor * value + offset."""

    factor: float
    offset: float = 0.0


# by dimension; the first is that of the log
UNITS: dict[str, dict[str, Unit]] = {
    "time": {"s": Unit(1.0), "ms": Unit(1e-3), "min": Unit(60.0), "h": Unit(3600.0)},
    "number": {"-": Unit(1.0), "%": Unit(0.01), "permille": Unit(1e-3)},
    "angle": {"rad": Unit(1.0), "mrad": Unit(1e-3), "urad": Unit(1e-6), "deg": Unit(DEGREE)},
    "length": {
        "m": Unit(1.0),
        "mm": Unit(1e-3),
        "cm": Unit(1e-2),
        "um": Unit(1e-6),
        "in": Unit(0.0254),
    },
    "way": {
        "m": Unit(1.0),
        "km": Unit(1e3),
        "ft": Unit(0.3048),
        "mi": Unit(1609.344),
    },
    "force": {
        "N": Unit(1.0),
        "kN": Unit(1e3),
        "MN": Unit(1e6),
        "daN": Unit(10.0),
        "lbf": Unit(POUND_FORCE),
        "kip": Unit(1e3 * POUND_FORCE),
        "kgf": Unit(9.80665),
    },
    "speed": {
        "m/s": Unit(1.0),
        "km/h": Unit(1 / 3.6),
        "mph": Unit(0.44704),
        "ft/s": Unit(0.3048),
        "mm/s": Unit(1e-3),
    },
    "turning": {
        "rad/s": Unit(1.0),
        "rpm": Unit(math.tau / 60),
        "Hz": Unit(math.tau),
        "deg/s": Unit(DEGREE),
    },
    "temperature": {
        "degC": Unit(1.0),
        "K": Unit(1.0, -273.15),
        "degF": Unit(5 / 9, -32 * 5 / 9),
    },
}
# other ways to write them
OTHERS = {
    "°": "deg",
    "°C": "degC",
    "C": "degC",
    "°F": "degF",
    "µm": "um",
    "μm": "um",
    "µrad": "urad",
    "μrad": "urad",
    "lb": "lbf",
    "lbs": "lbf",
    "klbf": "kip",
    "kips": "kip",
    "inch": "in",
    "kph": "km/h",
    "1/min": "rpm",
    "1/s": "Hz",
    "sec": "s",
    "degrees C": "degC",
    "‰": "permille",
    "1": "-",
    "": "-",
}


def dimension_of(unit: str) -> str:
    """Of a unit of the log; empty where none is known."""
    return next((name for name, units in UNITS.items() if unit in units), "")


def spelt(unit: str) -> str:
    """As in UNITS, where that is another way to write it."""
    return OTHERS.get(unit.strip(), unit.strip())


def split_head(head: str) -> tuple[str, str]:
    """Name and unit of a column's title, "yaw [mrad]" or "yaw (mrad)"; "" where it has none. A
    number in brackets is a component's, "creepage[0]"."""
    found = re.fullmatch(r"(.*?)\s*[\[(]([^\[\]()]*)[\])]\s*", head)
    if found and found[2].strip().isdecimal() and head.rstrip().endswith("]"):
        return head.strip(), ""
    return (found[1].strip(), found[2].strip()) if found else (head.strip(), "")
