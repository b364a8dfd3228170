"""Checks dicts against the channel table and turns them into protobuf messages.

Every error is a ValueError that names the place ("/left/contact: patches[1].creep_force"), the
value, and what is allowed.
"""

from __future__ import annotations

import math
import numbers
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from railpatch.log.channels import (
    CONTACT_FIELDS,
    ELEMENT_STATES,
    LEFT_OUT,
    PATCH_FIELDS,
    Field,
    Message,
)
from railpatch.log.quick import UINT32_MAX, quick
from railpatch.log.schema import message_class

# of two components: along and across, or of wheel and rail
_VECTOR_FIELDS = ("traction", "micro_slip", "temperature")


def encode(message: Message, values: Mapping[str, Any], topic: str) -> Any:
    """A protobuf message with ``values``; None, and a list of nothing but None, means absent.

    Raises ValueError for an unknown or missing field, a wrong shape or type, or a number that is
    not finite.
    """
    plain = quick(message, values)
    if plain is not None:
        return message_class(message)(**plain)
    return encode_closely(message, values, topic)


def encode_closely(message: Message, values: Mapping[str, Any], topic: str) -> Any:
    """The same value by value, which takes several times as long."""
    target = message_class(message)()
    _fill(target, message, values, f"{topic}: ")
    return target


def encode_fields(patches: Sequence[Mapping[str, Any]], topic: str) -> Any | None:
    """The snapshot message of one wheel, or None where no patch has fields.

    ``patches`` are patch results made with fields: ``x`` and ``y`` of shape (columns,) and (rows,)
    or (rows, columns), ``pressure`` and ``element_division`` of shape (rows, columns),
    ``traction``, ``micro_slip`` and ``temperature`` of shape (2, rows, columns). Other keys of a
    patch result are not looked at; patches without pressure are left out.
    """
    if isinstance(patches, (str, Mapping)) or not isinstance(patches, Sequence):
        raise ValueError(f"{topic}: {patches!r} must be a list of patches")
    target = message_class(CONTACT_FIELDS)()
    for index, patch in enumerate(patches):
        place = f"{topic}: patches[{index}]"
        _require_mapping(patch, place)
        if patch.get("pressure") is None:
            continue
        values = {"patch": index} | _flat_arrays(patch, place)
        _fill(target.patches.add(), PATCH_FIELDS, values, place + ".")
    return target if target.patches else None


def _fill(target: Any, message: Message, values: Mapping[str, Any], place: str) -> None:
    _require_mapping(values, place.rstrip(".: "))
    known = {field.name for field in message.fields}
    for key in values:
        if key not in known and key not in LEFT_OUT.get(message.name, ()):
            raise ValueError(f"{place}{key} is not a field; the fields are {_listed(known)}")
    for field in message.fields:
        value = values.get(field.name)
        if value is not None:
            _set(target, field, value, place + field.name)
        elif field.required:
            raise ValueError(f"{place}{field.name} is missing")


def _set(target: Any, field: Field, value: Any, place: str) -> None:
    if isinstance(field.kind, Message):
        if field.size == 1:
            getattr(target, field.name).SetInParent()
            _fill(getattr(target, field.name), field.kind, value, place + ".")
            return
        for index, item in enumerate(_listing(value, place)):
            _fill(getattr(target, field.name).add(), field.kind, item, f"{place}[{index}].")
    elif field.size == 1:
        setattr(target, field.name, _scalar(field, value, place))
    elif isinstance(value, np.ndarray):
        getattr(target, field.name).extend(_finite_array(field, value, place))
    else:
        items = _listing(value, place)
        if items and all(item is None for item in items):
            return
        _check_length(field, len(items), place, value)
        checked = [_scalar(field, item, f"{place}[{i}]") for i, item in enumerate(items)]
        getattr(target, field.name).extend(checked)


def _scalar(field: Field, value: Any, place: str) -> Any:
    if field.kind == "string":
        allowed = f"one of {', '.join(field.choices)}" if field.choices else "a text"
        if not isinstance(value, str) or (field.choices and value not in field.choices):
            raise ValueError(f"{place} is {value!r}; it must be {allowed}")
        return value
    if field.kind == "uint32":
        whole = isinstance(value, numbers.Integral) and not isinstance(value, (bool, np.bool_))
        if not whole or not 0 <= value <= UINT32_MAX:
            raise ValueError(f"{place} is {value!r}; it must be a whole number >= 0")
        return int(value)
    real = isinstance(value, numbers.Real) and not isinstance(value, (bool, np.bool_))
    if not real or not math.isfinite(value):
        raise ValueError(f"{place} is {value!r}; it must be a finite number [{field.unit}]")
    return float(value)


def _finite_array(field: Field, value: np.ndarray, place: str) -> list[Any]:
    if value.ndim != 1 or value.dtype.kind not in "fiu":
        raise ValueError(
            f"{place} has shape {value.shape} and type {value.dtype}; it must be a "
            f"list of numbers [{field.unit}]"
        )
    _check_length(field, value.size, place, value)
    bad = np.flatnonzero(~np.isfinite(value))
    if bad.size:
        raise ValueError(
            f"{place}[{bad[0]}] is {value[bad[0]]}; it must be a finite number [{field.unit}]"
        )
    if field.kind == "uint32":
        wrong = (value != np.round(value)) | (value < 0) | (value > UINT32_MAX)
        if wrong.any():
            raise ValueError(f"{place} holds {value[wrong][0]}; it must be whole numbers >= 0")
        return value.astype(int).tolist()
    return value.astype(float).tolist()


def _flat_arrays(patch: Mapping[str, Any], place: str) -> dict[str, Any]:
    """The arrays of one patch flattened, with their common shape."""
    pressure = _array(patch["pressure"], place + ".pressure")
    if pressure.ndim != 2:
        raise ValueError(f"{place}.pressure has shape {pressure.shape}; it must be (rows, columns)")
    rows, columns = pressure.shape
    values: dict[str, Any] = {"rows": rows, "columns": columns}
    for field in PATCH_FIELDS.fields:
        name = field.name
        if field.size != 0 or patch.get(name) is None:
            continue
        array = _spread(name, _array(patch[name], f"{place}.{name}"), rows, columns)
        shape = (2, rows, columns) if name in _VECTOR_FIELDS else (rows, columns)
        if array.shape != shape:
            raise ValueError(
                f"{place}.{name} has shape {array.shape}; with a pressure of shape "
                f"{pressure.shape} it must be {shape}"
            )
        if field.kind == "uint32":
            _check_division(array, f"{place}.{name}")
        values[name] = array.ravel()
    for name in ("x", "y"):
        if name not in values:
            raise ValueError(f"{place}.{name} is missing")
    return values


def _spread(name: str, array: np.ndarray, rows: int, columns: int) -> np.ndarray:
    """The element centres of a plain grid, given per axis, spread over all elements."""
    if name == "x" and array.shape == (columns,):
        return np.broadcast_to(array, (rows, columns))
    if name == "y" and array.shape == (rows,):
        return np.broadcast_to(array[:, None], (rows, columns))
    return array


def _check_division(array: np.ndarray, place: str) -> None:
    wrong = (array != np.round(array)) | (array < 0) | (array >= len(ELEMENT_STATES))
    if wrong.any():
        raise ValueError(
            f"{place} holds {array[wrong][0]}; its values must be 0 to "
            f"{len(ELEMENT_STATES) - 1} ({', '.join(ELEMENT_STATES)})"
        )


def _array(value: Any, place: str) -> np.ndarray:
    try:
        return np.asarray(value, dtype=float)
    except (TypeError, ValueError):
        raise ValueError(f"{place} must be an array of numbers, every row of one length") from None


def _listing(value: Any, place: str) -> Sequence[Any]:
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, (str, bytes)) or not isinstance(value, Sequence):
        raise ValueError(f"{place} is {value!r}; it must be a list")
    return value


def _check_length(field: Field, length: int, place: str, value: Any) -> None:
    if field.size not in (0, length):
        raise ValueError(f"{place} has {length} values ({value!r}); it must have {field.size}")


def _require_mapping(values: Any, place: str) -> None:
    if not isinstance(values, Mapping):
        raise ValueError(f"{place} is {values!r}; it must be a dict")


def _listed(names: set[str]) -> str:
    return ", ".join(sorted(names))
