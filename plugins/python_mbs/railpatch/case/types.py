"""Value types that the tables of a case share. All numbers are finite and strictly typed.

Ranges are those of the core's own checks; a test compares them.
"""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, WithJsonSchema
from pydantic_core import PydanticCustomError

# of a wheelset and its track; the core counts them in this order
SIDES = ("left", "right")
# that touch, in the core's order
BODIES = ("wheel", "rail")
# elements of one patch along one axis; a grid has a border of one element besides
MOST_ELEMENTS = 1000


def between(low: float, high: float) -> Any:
    """The range of a number, both ends allowed."""
    return Field(ge=low, le=high, allow_inf_nan=False)


def more_than(low: float, high: float) -> Any:
    """The range of a number, the lower end not allowed."""
    return Field(gt=low, le=high, allow_inf_nan=False)


def exactly(count: int) -> Any:
    """The length of a list."""
    return Field(min_length=count, max_length=count)


Number = Annotated[float, Field(allow_inf_nan=False)]
Positive = Annotated[float, Field(gt=0, allow_inf_nan=False)]
NotNegative = Annotated[float, Field(ge=0, allow_inf_nan=False)]
Shift = Annotated[float, between(-1, 1)]  # m
Angle = Annotated[float, between(-1.5, 1.5)]  # rad
Dimension = Annotated[float, between(0.01, 10)]  # m
Modulus = Annotated[float, between(1.0, 1e15)]  # Pa
Ratio = Annotated[float, between(0, 0.5)]
Count = Annotated[int, Field(ge=1, le=MOST_ELEMENTS)]
Capacity = Annotated[int, Field(ge=1, le=MOST_ELEMENTS + 2)]

Pair = Annotated[list[Number], exactly(2)]
# one for each step
Pairs = Annotated[list[Pair], Field(min_length=1, max_length=1_000_000)]
# a number, or the word that leaves the component to its creepage
ForcePair = Annotated[list[Number | Literal["creepage"]], exactly(2)]
CountPair = Annotated[list[Count], exactly(2)]
Nodes = Annotated[int, Field(ge=1, le=64)]
FittedPair = Annotated[list[Nodes], exactly(2)]
CapacityPair = Annotated[list[Capacity], exactly(2)]
ModulusPair = Annotated[list[Modulus], exactly(2)]
RatioPair = Annotated[list[Ratio], exactly(2)]
ElementSize = Annotated[list[Annotated[float, between(1e-9, 1)]], exactly(2)]
SemiAxes = Annotated[list[Annotated[float, between(1e-7, 1)]], exactly(2)]
Curvatures = Annotated[list[Annotated[float, between(1e-9, 1e6)]], exactly(2)]
Vector = Annotated[list[Number], exactly(3)]
ShiftVector = Annotated[list[Shift], exactly(3)]
AngleVector = Annotated[list[Angle], exactly(3)]


# degrees C
Celsius = Annotated[float, between(-273.15, 1e4)]
# factor of the friction law at a position, and displacement with yield stress: of the core
MOST_POINTS = 32
Points = Annotated[list[Pair], Field(min_length=2, max_length=MOST_POINTS)]
HardeningTable = Annotated[
    list[Annotated[list[NotNegative], exactly(2)]], Field(min_length=2, max_length=MOST_POINTS)
]
HeatPair = Annotated[
    list[Positive],
    exactly(2),
    BeforeValidator(lambda value: twice(value)),
    WithJsonSchema(
        {
            "anyOf": [
                {"type": "number", "exclusiveMinimum": 0},
                {
                    "type": "array",
                    "items": {"type": "number", "exclusiveMinimum": 0},
                    "minItems": 2,
                    "maxItems": 2,
                },
            ]
        }
    ),
]


class Table(BaseModel):
    """A table of the case file: no unknown keys, no conversion of types, no change afterwards."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True, allow_inf_nan=False)

    @property
    def moving(self) -> tuple[str, ...]:
        """The keys that may change from step to step."""
        return ()


def twice(value: Any) -> Any:
    """One number stands for wheel and rail."""
    return value if isinstance(value, list) else [value, value]


def relation(key: str, value: Any, allowed: str) -> PydanticCustomError:
    """Error of a relation between keys; the key is relative to the table that raises it."""
    return PydanticCustomError(
        "relation", "relation", {"key": key, "shown": value, "allowed": allowed}
    )


def exactly_one(table: BaseModel, names: tuple[str, ...]) -> None:
    """Raises unless exactly one of the keys is given."""
    given = [name for name in names if getattr(table, name) is not None]
    if len(given) != 1:
        listed = ", ".join(f"'{name}'" for name in names)
        shown = " and ".join(given) or "none of them"
        raise relation("", shown, f"exactly one of {listed}")
