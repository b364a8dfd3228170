"""The table of columns of a record: which column of the file is what, in which unit."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Literal

from pydantic import Field, create_model, model_validator

from railpatch.case.load import check_table, plain, read_toml
from railpatch.case.types import Number, Positive, Table, relation
from railpatch.errors import CaseError
from railpatch.record.forces import COUNTED
from railpatch.record.quantities import QUANTITIES
from railpatch.record.units import UNITS


class MeasuredColumn(Table):
    """One column: sign * (factor * number + offset), in the unit."""

    name: str = Field(
        default="",
        description="(no unit), of the column in the file's head, with or without its unit; in a "
        "file without a head its number from 1, as a text; needed",
    )
    column: str | None = Field(default=None, description="(no unit), the same as name")
    unit: str | None = Field(
        default=None,
        description="(a unit), of the numbers; left out: as the head has it, 'yaw [mrad]' or in a "
        "line below the names",
    )
    sign: Literal[1, -1] = Field(default=1, description="-, -1 turns the sign of all numbers")
    factor: Number = Field(default=1.0, description="-, by which all numbers are multiplied")
    offset: Number = Field(
        default=0.0, description="(the column's unit), added after the factor, before the sign"
    )
    low_pass: Positive | None = Field(
        default=None, description="Hz, cut-off of this column, in place of the record's low_pass"
    )

    @model_validator(mode="before")
    @classmethod
    def _named(cls, given: Any) -> Any:
        """The column's name by either key."""
        if not isinstance(given, dict):
            return given
        if "column" in given and "name" in given:
            raise relation("column", given["column"], "'name' or 'column', one of them")
        if "column" in given:
            return {**given, "name": given["column"]}
        if "name" not in given and cls.model_fields["name"].default is not None:
            raise relation("name", "missing", "the name of a column")
        return given


def described(text: str, dimension: str) -> str:
    """SI unit, meaning and units that may be given."""
    units = UNITS[dimension]
    return f"{next(iter(units))}, {text}; in {', '.join(units)}"


# a key for each quantity
Columns: Any = create_model(
    "Columns",
    __base__=Table,
    __doc__="Which column of the record is what; left out: columns with the names of these keys.",
    **{
        quantity.name: (
            MeasuredColumn | None,
            Field(default=None, description=described(quantity.text, quantity.dimension)),
        )
        for quantity in QUANTITIES
    },
    **{
        key.replace(".", "_").replace("[", "_").replace("]", ""): (
            MeasuredColumn | None,
            Field(default=None, alias=key, description=described(text, "force")),
        )
        for key, text in COUNTED.items()
    },
)


def given(columns: Any) -> dict[str, MeasuredColumn]:
    """Those of a checked table that are there."""
    fields = type(columns).model_fields
    found = {field.alias or name: getattr(columns, name) for name, field in fields.items()}
    return {name: column for name, column in found.items() if column is not None}


def load_columns(path: Path) -> dict[str, MeasuredColumn]:
    """From a file with a table [columns], or the scene of a rig with [rig.columns].

    Keys are the names of quantities or of columns of a log's table, "/left/contact.force.y".
    Raises CaseError.
    """
    content = plain(read_toml(path))
    rig = content.get("rig")
    table = content.get("columns") or (rig.get("columns") if isinstance(rig, dict) else None)
    if not isinstance(table, dict) or not table:
        raise CaseError(f"{path}: columns: value is missing, allowed a table [columns]")
    logged = {key: value for key, value in table.items() if key.startswith("/")}
    named = {key: value for key, value in table.items() if key not in logged}
    found = given(check_table(Columns, named, "columns"))
    for key, value in logged.items():
        found[key] = check_table(MeasuredColumn, value, f"columns.{key!r}")
    return found
