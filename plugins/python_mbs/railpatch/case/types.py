"""Value types that the tables of a case share. All numbers are finite and strictly typed."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import BaseModel, ConfigDict, Field
from pydantic_core import PydanticCustomError

# elements of one patch along one axis
MOST_ELEMENTS = 1024

Number = Annotated[float, Field(allow_inf_nan=False)]
Positive = Annotated[float, Field(gt=0, allow_inf_nan=False)]
NotNegative = Annotated[float, Field(ge=0, allow_inf_nan=False)]
Pair = Annotated[list[Number], Field(min_length=2, max_length=2)]
PositivePair = Annotated[list[Positive], Field(min_length=2, max_length=2)]
Vector = Annotated[list[Number], Field(min_length=3, max_length=3)]
Count = Annotated[int, Field(ge=1, le=MOST_ELEMENTS)]
CountPair = Annotated[list[Count], Field(min_length=2, max_length=2)]


def twice(value: Any) -> Any:
    """One number stands for wheel and rail."""
    return value if isinstance(value, list) else [value, value]


Ratio = Annotated[float, Field(ge=0, le=0.5, allow_inf_nan=False)]
RatioPair = Annotated[list[Ratio], Field(min_length=2, max_length=2)]


class Table(BaseModel):
    """A table of the case file: no unknown keys, no conversion of types, no change afterwards."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True, allow_inf_nan=False)


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
