"""Turns pydantic's errors into 'key: value is ..., allowed ...'."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Mapping
from types import UnionType
from typing import Annotated, Any, Literal, Union, get_args, get_origin

from pydantic import BaseModel, ValidationError
from pydantic.fields import FieldInfo

from railpatch.case.homes import Tables, models_in, unknown_key
from railpatch.case.key_units import parts_of_unit
from railpatch.case.types import show

ALLOWED = {
    "greater_than": "> {gt}",
    "greater_than_equal": ">= {ge}",
    "less_than": "< {lt}",
    "less_than_equal": "<= {le}",
    "finite_number": "a finite number",
    "float_type": "a number",
    "int_type": "a whole number",
    "string_type": "a text",
    "string_too_short": "a text that is not empty",
    "list_type": "a list",
    "model_type": "a table",
    "model_attributes_type": "a table",
    "dict_type": "a table",
    "literal_error": "{expected}",
}
# of numbers: limits are of their unit
LIMITS = ("greater_than", "greater_than_equal", "less_than", "less_than_equal")
# of lists: pydantic's errors; least and greatest length, and what they hold
Lengths = tuple[int | None, int | None, str]
LENGTHS = ("too_short", "too_long")
# what a value below the limit of a key may have been meant as
BELOW = {"motion.rolling_speed": "; motion.direction = -1 rolls towards -x"}
# pydantic's names of the branch of a union that is a text
TEXTS = (("str",), ("constrained-str",))
# an element of a list that is wrong: the list, what is allowed
ELEMENT = re.compile(r"([^:]*?)(?:\[\d+\])+: value is .*, allowed (.*)", re.DOTALL)
MOST_ELEMENTS = 3  # told one by one

# a value that is no table, or no list of tables
NO_TABLE = ("list_type", "model_type", "model_attributes_type", "dict_type")


def problems(
    model: type[BaseModel],
    error: ValidationError,
    prefix: str = "",
    beside: Iterable[str] = (),
    among: Tables = (),
) -> list[str]:
    """One line for each error. prefix: key of the table that the model stands for. beside: keys
    that may stand beside those of the model. among: files in which a key that is unknown here may
    have its place, nearest first."""
    found: list[str] = []
    keys: set[str] = set()
    for item in of_meant_branches(error.errors(include_url=False)):
        if item["type"] == "relations":
            loc = tuple(item["loc"])
            each = [{"type": "relation", "loc": loc, "ctx": c} for c in item["ctx"]["found"]]
            lines = dict.fromkeys(problem(model, one, prefix) for one in each)
            found += lines
            keys |= {line.split(":")[0] for line in lines}
            continue
        text = problem(model, item, prefix, beside, among)
        # a number or a word in its place
        if item["type"] == "literal_error" and found and found[-1] == number_of(text):
            found[-1] += f" or {item['ctx']['expected']}"
        # the branches of a union report the same key several times
        if text.split(":")[0] not in keys:
            keys.add(text.split(":")[0])
            found.append(text)
    return folded(found)


def of_meant_branches(items: list[Any]) -> list[Any]:
    """Without those of branches of a union that were not meant: a text where a list was given,
    numbers where lists of numbers were, and the other way round."""
    other = [of_another_branch(item) for item in items]
    # where no branch fits all elements, what each says
    places = {place_of(item) for item, is_other in zip(items, other, strict=True) if not is_other}
    return [
        item
        for item, is_other in zip(items, other, strict=True)
        if not is_other or (item["loc"][-1:] not in TEXTS and place_of(item) not in places)
    ]


def place_of(item: Any) -> tuple[Any, ...]:
    """The path of an error up to a branch of lists."""
    return tuple(item["loc"][: branch_of(item["loc"])])


def branch_of(loc: tuple[Any, ...]) -> int:
    """Where a path has the name of a branch of lists; its length: nowhere."""
    lists = (k for k, part in enumerate(loc) if str(part).startswith("list["))
    return next(lists, len(loc))


def of_another_branch(item: Any) -> bool:
    """Whether an error is of a branch that was not meant."""
    loc, given = item["loc"], item["input"]
    if loc[-1:] in TEXTS:
        return isinstance(given, list)
    at = branch_of(loc)
    if at == len(loc):
        return False
    if str(loc[at]).startswith("list[list["):
        return len(loc) == at + 2 and item["type"] == "list_type"
    if len(loc) == at + 1:  # of the list itself: as its first element is
        given = given[0] if isinstance(given, list) and given else None
    return isinstance(given, list)


def folded(lines: list[str]) -> list[str]:
    """Of many elements of one list that are wrong in the same way the first ones, and how many
    more there are."""
    kinds = [ELEMENT.fullmatch(line) for line in lines]
    count = Counter(kind.groups() for kind in kinds if kind)
    told: Counter[tuple[str, ...]] = Counter()
    found: list[str] = []
    for line, kind in zip(lines, kinds, strict=True):
        if kind is None or count[kind.groups()] <= MOST_ELEMENTS + 1:
            found.append(line)
            continue
        told[kind.groups()] += 1
        if told[kind.groups()] <= MOST_ELEMENTS:
            found.append(line)
        elif told[kind.groups()] == MOST_ELEMENTS + 1:
            key, allowed = kind.groups()
            more = count[kind.groups()] - MOST_ELEMENTS
            found.append(f"{key}: {more} more of its elements, allowed {allowed}")
    return found


def number_of(text: str) -> str:
    """The line on the same value if a number were allowed."""
    return f"{text.rsplit(', allowed ', 1)[0]}, allowed {ALLOWED['float_type']}"


def problem(
    model: type[BaseModel],
    item: Any,
    prefix: str,
    beside: Iterable[str] = (),
    among: Tables = (),
) -> str:
    """The line for one of pydantic's errors."""
    context = item.get("ctx", {})
    loc = [part for part in item["loc"] if not is_branch(part)]
    key = spell(prefix, loc)
    if item["type"] == "relation":
        key = ".".join(part for part in (key, context["key"]) if part) or "case"
        return f"{key}: value is {context['shown']}, allowed {context['allowed']}"
    table = table_at(model, loc[:-1])
    if item["type"] == "extra_forbidden":
        names = [*(table.model_fields if table else ()), *(beside if len(loc) == 1 else ())]
        more = beside if isinstance(beside, Mapping) else {}
        files = among if prefix else ({**model.model_fields, **more}, *among)
        return unknown_key(key, str(loc[-1]), item["input"], names, files)
    if item["type"] == "missing":
        description = table.model_fields[str(loc[-1])].description if table else "a value"
        inner = f"a table [{key}]: " if table_at(model, loc) else ""
        if inner and table and get_origin(table.model_fields[str(loc[-1])].annotation) is list:
            inner = f"at least one [[{key}]]: "
            description = str(description).removeprefix("(no unit): ")
        words = words_of(table.model_fields[str(loc[-1])].annotation) if table else []
        if words:
            inner, description = one_of_these(words), str(description).removeprefix("(no unit): ")
            inner += f": {description}" if description else ""
            return f"{key}: value is missing, allowed {inner}"
        return f"{key}: value is missing, allowed {inner}{description}{keys_of(model, loc)}"
    if item["type"] == "value_error":
        said = str(context["error"])
        return f"{key}: {said}" if key else said
    if key and item["type"] in NO_TABLE and (keys := keys_of(model, loc)):
        wanted = f"[[{key}]] tables" if item["type"] == "list_type" else f"a table [{key}]"
        return f"{key}: value is {show(item['input'])}, allowed {wanted}{keys}"
    template = ALLOWED.get(item["type"])
    if item["loc"][-1:] in TEXTS:
        template = "a path or rows of numbers"
    allowed = template.format(**context) if template else item["msg"]
    if item["type"] in LENGTHS:
        allowed = length_at(model, loc, context)
    if item["type"] in LIMITS:
        allowed += unit_at(model, loc)
    if item["type"] == "greater_than_equal":
        allowed += BELOW.get(key, "")
    return f"{key}: value is {show(item['input'])}, allowed {allowed}"


def length_at(model: type[BaseModel], loc: list[Any], context: Mapping[str, Any]) -> str:
    """'2 values' or '2 to 8 rows' of a list, by its type. context: of pydantic's error, which has
    the end that the list goes beyond."""
    held, deep = held_at(model, loc)
    found = lengths_in(held.annotation, deep) if held else None
    if held and found and not deep:
        found = ended(found, held.metadata)
    low, high, what = found or (None, None, "values")
    low, high = context.get("min_length", low), context.get("max_length", high)
    if low == high:
        return f"{low} values"
    if high is None:
        return f"{low} or more {what}"
    return f"{low} to {high} {what}" if low else f"at most {high} {what}"


def ended(found: Lengths, marks: Iterable[Any]) -> Lengths:
    """With the ends that marks of the list's type set."""
    low, high, what = found
    ends = [end for mark in marks for end in getattr(mark, "metadata", (mark,))]
    for end in ends:
        low, high = getattr(end, "min_length", low), getattr(end, "max_length", high)
    return low, high, what


def lengths_in(annotation: Any, deep: int) -> Lengths | None:
    """Least and greatest length of a list and what it holds, of the type of a key. deep: how many
    lists it lies in. None where the type holds no such list."""
    origin, parts = get_origin(annotation), get_args(annotation)
    if origin is Annotated:
        found = lengths_in(parts[0], deep)
        return found if found is None or deep else ended(found, parts[1:])
    if origin is list:
        if deep:
            return lengths_in(parts[0], deep - 1)
        inner = parts[0]
        while get_origin(inner) is Annotated:
            inner = get_args(inner)[0]
        return None, None, "rows" if get_origin(inner) is list else "values"
    return next(filter(None, (lengths_in(part, deep) for part in parts)), None)


def held_at(model: type[BaseModel], loc: list[Any]) -> tuple[FieldInfo | None, int]:
    """The key of a table that a location lies in, and in how many of its lists."""
    names = [place for place, part in enumerate(loc) if isinstance(part, str)]
    table = table_at(model, loc[: names[-1]]) if names else None
    held = table.model_fields.get(str(loc[names[-1]])) if table else None
    return held, len(loc) - 1 - names[-1] if names else 0


def unit_at(model: type[BaseModel], loc: list[Any]) -> str:
    """' m' of a number of a case, as its description says, of rows that of the column; nothing of
    what has no unit."""
    held, _ = held_at(model, loc)
    parts = parts_of_unit(held.description or "") if held else [""]
    if len(parts) > 1 and not isinstance(loc[-1], int):
        return ""
    unit = parts[min(int(loc[-1]), len(parts) - 1)] if isinstance(loc[-1], int) else parts[0]
    return "" if unit == "-" or not unit else f" {unit}"


def words_of(annotation: Any) -> list[Any]:
    """Words that a type allows for a value by itself, in order."""
    if get_origin(annotation) is Literal:
        return list(get_args(annotation))
    parts: tuple[Any, ...] = ()
    if get_origin(annotation) in (Union, UnionType):
        parts = get_args(annotation)
    elif get_origin(annotation) is Annotated:
        parts = get_args(annotation)[:1]
    return [word for part in parts for word in words_of(part)]


def one_of_these(words: list[Any]) -> str:
    """'a', 'b' or 'c'."""
    *first, last = map(repr, words)
    return f"{', '.join(first)} or {last}" if first else last


def is_branch(part: Any) -> bool:
    """pydantic puts the name of a union's branch, 'str' or 'list[...]', into the location."""
    return isinstance(part, str) and (
        part in ("str", "constrained-str", "float", "constrained-float")
        or part.startswith(("list[", "literal["))
    )


def spell(prefix: str, loc: list[Any]) -> str:
    """'wheelset.left.offset[1]'."""
    key = prefix
    for part in loc:
        key += f"[{part}]" if isinstance(part, int) else f".{part}" if key else str(part)
    return key


def table_at(model: type[BaseModel], loc: list[Any]) -> type[BaseModel] | None:
    """The model of the table at a location, also of one in a list."""
    table: type[BaseModel] | None = model
    for part in loc:
        if isinstance(part, int):
            continue
        if table is None or part not in table.model_fields:
            return None
        table = next(models_in(table.model_fields[part].annotation), None)
    return table


def keys_of(model: type[BaseModel], loc: list[Any]) -> str:
    """The keys of the table that a location is for; nothing of other values."""
    table = table_at(model, loc)
    return f", with the keys {', '.join(table.model_fields)}" if table else ""
