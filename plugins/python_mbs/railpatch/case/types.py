"""Value types that the tables of a case share. All numbers are finite and strictly typed.

Ranges are those of the core's own checks: from its lists where a key has a field's name, and a test
compares all.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from typing import Annotated, Any, Literal

from pydantic import (
    BaseModel,
    ConfigDict,
    Field,
    ValidationError,
    ValidatorFunctionWrapHandler,
    WithJsonSchema,
    WrapValidator,
)
from pydantic_core import PydanticCustomError, PydanticKnownError

from railpatch import _core

# of a wheelset and its track; the core counts them in this order
SIDES = ("left", "right")
# that touch, in the core's order
BODIES = ("wheel", "rail")


def between(low: float, high: float) -> Any:
    """The range of a number, both ends allowed."""
    return Field(ge=low, le=high, allow_inf_nan=False)


def from_to_below(low: float, high: float) -> Any:
    """The range of a number, the upper end not allowed."""
    return Field(ge=low, lt=high, allow_inf_nan=False)


def more_than(low: float, high: float) -> Any:
    """The range of a number, the lower end not allowed."""
    return Field(gt=low, le=high, allow_inf_nan=False)


# of a range, by the core's lists
ENDS = {"[": "ge", "(": "gt", "]": "le", ")": "lt"}


def listed(name: str) -> dict[str, Any]:
    """What the core's lists say of a field of a config or an input."""
    return _core.CONFIG_FIELDS.get(name) or _core.INPUT_FIELDS[name]


def limits(name: str) -> dict[str, Any]:
    """The range of a field of the core, as arguments of Field."""
    field = listed(name)
    whole = field["type"] == "int32_t"
    found: dict[str, Any] = {} if whole else {"allow_inf_nan": False}
    for end, value in zip(field["bounds"], (field["low"], field["high"]), strict=False):
        if math.isfinite(value):
            found[ENDS[end]] = int(value) if whole else value
    return found


def within(name: str) -> Any:
    """The range of a field of the core, for one of its numbers."""
    return Field(**limits(name))


def number_or(name: str, word: str) -> Any:
    """A number in the range of a field of the core, or a word in its place."""
    return Annotated[float, within(name)] | Literal[word]


def up_to(name: str) -> Any:
    """At least one, and no more than a field of the core takes."""
    return Field(ge=1, le=limits(name)["le"])


# of a JSON schema, by the words of pydantic's Field
WORDS_OF_SCHEMA = {
    "ge": "minimum",
    "gt": "exclusiveMinimum",
    "le": "maximum",
    "lt": "exclusiveMaximum",
}


def of_bodies(name: str) -> Any:
    """One number for wheel and rail, or one of each, in the range of a field of the core."""
    number = {"type": "number"} | {
        WORDS_OF_SCHEMA[word]: value
        for word, value in limits(name).items()
        if word in WORDS_OF_SCHEMA
    }
    pair = {"type": "array", "items": number, "minItems": 2, "maxItems": 2}
    return Annotated[
        list[Annotated[float, within(name)]],
        exactly(2),
        WrapValidator(lambda value, check: twice(value, check)),
        WithJsonSchema({"anyOf": [number, pair]}),
    ]


def likely(name: str, **options: Any) -> dict[str, Any]:
    """Arguments of Field, with the range outside of which a warning says that a field of the core
    is hardly meant."""
    if name in _core.PLAUSIBLE:
        low, high = _core.PLAUSIBLE[name]
        options["description"] += f"; hardly meant outside {low:g} to {high:g}"
        options["json_schema_extra"] = {"plausible": [low, high]}
    return options


class Key:
    """A key that stands in the core's lists under its own name, or under ``of``."""

    def __init__(self, more: str, of: str | None, bounded: bool, options: dict[str, Any]) -> None:
        self.more, self.of, self.bounded, self.options = more, of, bounded, options

    def field(self, name: str) -> Any:
        """What pydantic takes. A list's range is in its type."""
        known = listed(self.of or name)
        options = {} if known["shape"] or not self.bounded else limits(self.of or name)
        start = known["start"]
        options["default"] = [start] * known["shape"][0] if known["shape"] else start
        options["description"] = f"{known['unit']}, {known['text']}{self.more}"
        return Field(**{**likely(self.of or name, **options), **self.options})


def key(more: str = "", *, of: str | None = None, bounded: bool = True, **options: Any) -> Any:
    """A key of a table with range, unit, default and text of the core's field of its name.

    more: goes on with the text. of: the field's name where it is another. bounded: whether the
    range is set; else it is in the type. options: of pydantic's Field, in place of the core's;
    default=... for a key that is needed.
    """
    return Key(more, of, bounded, options)


class Named(type(BaseModel)):
    """Puts the core's words in the place of key()."""

    def __new__(cls, name: str, bases: Any, namespace: dict[str, Any], **more: Any) -> Any:
        """The class."""
        for own, value in namespace.items():
            if isinstance(value, Key):
                namespace[own] = value.field(own)
        return super().__new__(cls, name, bases, namespace, **more)


def one_of(choice: str, *, without: tuple[str, ...] = (), besides: tuple[str, ...] = ()) -> Any:
    """One of the words of a choice of the core, in its order, and of those besides."""
    words = (word for word in _core.CHOICES[choice] if word not in without)
    return Literal[(*words, *besides)]


def exactly(count: int) -> Any:
    """The length of a list."""
    return Field(min_length=count, max_length=count)


Number = Annotated[float, Field(allow_inf_nan=False)]
Positive = Annotated[float, Field(gt=0, allow_inf_nan=False)]
NotNegative = Annotated[float, Field(ge=0, allow_inf_nan=False)]
Shift = Annotated[float, within("wheel_offset")]  # m
Angle = Annotated[float, within("wheel_rotation")]  # rad
Modulus = Annotated[float, within("shear_modulus")]  # Pa
# of a line contact 1 across
Count = Annotated[int, up_to("elements")]
Capacity = Annotated[int, up_to("max_elements")]

Pair = Annotated[list[Number], exactly(2)]
# one for each step
Pairs = Annotated[list[Pair], Field(min_length=1, max_length=1_000_000)]
# a number, or the word that leaves the component to its creepage
ForcePair = Annotated[list[Number | Literal["creepage"]], exactly(2)]
CountPair = Annotated[list[Count], exactly(2)]
Nodes = Annotated[int, up_to("fitted")]
FittedPair = Annotated[list[Nodes], exactly(2)]
CapacityPair = Annotated[list[Capacity], exactly(2)]
ElementSize = Annotated[list[Annotated[float, within("element_size")]], exactly(2)]
SemiAxes = Annotated[list[Annotated[float, within("semi_axes")]], exactly(2)]
Curvatures = Annotated[list[Annotated[float, within("curvatures")]], exactly(2)]
Vector = Annotated[list[Number], exactly(3)]
ShiftVector = Annotated[list[Shift], exactly(3)]
AngleVector = Annotated[list[Angle], exactly(3)]


# degrees C
Celsius = Annotated[float, within("bulk_temperature")]
# factor of the friction law at a position, and displacement with yield stress: of the core
MOST_POINTS = listed("friction_position")["shape"][0]
Points = Annotated[list[Pair], Field(min_length=2, max_length=MOST_POINTS)]
HardeningTable = Annotated[
    list[Annotated[list[NotNegative], exactly(2)]], Field(min_length=2, max_length=MOST_POINTS)
]


class Table(BaseModel, metaclass=Named):
    """A table of the case file: no unknown keys, no conversion of types, no change afterwards."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True, allow_inf_nan=False)

    @property
    def moving(self) -> tuple[str, ...]:
        """The keys that may change from step to step."""
        return ()


def twice(value: Any, check: ValidatorFunctionWrapHandler) -> Any:
    """One number stands for wheel and rail; what is wrong with it is said once."""
    if isinstance(value, list):
        return check(value)
    try:
        return check([value, value])
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        raise PydanticKnownError(first["type"], first.get("ctx")) from None


# what a check of several relations gives: one for each that is broken
Problems = Iterator[PydanticCustomError]
LONGEST = 60  # characters of a value in a message
# of a key that nothing would read
LEFT_OUT = "none: it must be left out"


def show(value: Any) -> str:
    """A value of a case as its file has it, cut to a readable length."""
    if isinstance(value, dict | BaseModel):
        return "a table"
    text = repr(value)
    return text if len(text) <= LONGEST else f"{text[: LONGEST - 3]}..."


def relation(key: str, value: Any, allowed: str) -> PydanticCustomError:
    """Error of a relation between keys; the key is relative to the table that raises it. Checks
    of several relations give all that are broken, for refuse()."""
    shown = show(value) if isinstance(value, BaseModel | dict | list) else value
    return PydanticCustomError(
        "relation", "relation", {"key": key, "shown": shown, "allowed": allowed}
    )


def refuse(found: Iterable[PydanticCustomError]) -> None:
    """Raises one error for all problems of a table's keys, if there are any."""
    problems = list(found)
    if len(problems) == 1:
        raise problems[0]
    if problems:
        known = {"found": [problem.context for problem in problems]}
        raise PydanticCustomError("relations", "relations", known)


def exactly_one(table: BaseModel, names: tuple[str, ...]) -> None:
    """Raises unless exactly one of the keys is given."""
    given = [name for name in names if getattr(table, name) is not None]
    if len(given) != 1:
        listed = ", ".join(f"'{name}'" for name in names)
        shown = " and ".join(given) or "none of them"
        raise relation("", shown, f"exactly one of {listed}")
