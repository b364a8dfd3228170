"""What is matched: the scene, what is sought in it, what was given and what was measured."""

from __future__ import annotations

import math
from collections.abc import Mapping
from copy import deepcopy
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import BeforeValidator, Field, model_validator

from railpatch.case.kinds import kind_of
from railpatch.case.load import KINDS, check_table, plain, read_toml
from railpatch.case.types import Number, Pair, Positive, Table, relation
from railpatch.errors import CaseError
from railpatch.match.heads import heads_of
from railpatch.match.point_units import (
    creepage_doubts,
    own_unit,
    unit_of_input,
    unit_of_observed,
)
from railpatch.record import MeasuredColumn, Record, read_record
from railpatch.record.quantities import BY_NAME, OUTPUT
from railpatch.sweep.plan import Value, put

Array = NDArray[np.float64]
Key = str
# what is made of a match without explanations
OWN = "the scene"


class SoughtTable(Table):
    """One parameter: a key of the scene that is sought between two ends."""

    low: Number = Field(description="as of the key: the least value it may have")
    high: Number = Field(description="as of the key: the greatest value it may have")
    start: Number | None = Field(
        default=None, description="as of the key: a first guess; left out: the middle"
    )
    logarithmic: bool = Field(
        default=False,
        description="(no unit): whether the logarithm is sought, of what is known by its order of "
        "magnitude only",
    )
    prior: Number | None = Field(
        default=None, description="as of the key: what is known of it beforehand, with prior_error"
    )
    prior_error: Positive | None = Field(
        default=None, description="as of the key: standard deviation of what is known beforehand"
    )

    @model_validator(mode="after")
    def _ends(self) -> SoughtTable:
        if not self.low < self.high:
            raise relation("low", self.low, f"below high, {self.high:g}")
        if self.logarithmic and not self.low > 0:
            raise relation("low", self.low, "> 0 where the logarithm is sought")
        for name in ("start", "prior"):
            value = getattr(self, name)
            if value is not None and not self.low <= value <= self.high:
                raise relation(name, value, f"{self.low:g} to {self.high:g}")
        if (self.prior is None) != (self.prior_error is None):
            raise relation("prior", self.prior, "with prior_error, and only with it")
        return self

    def at(self, share: float) -> float:
        """The value at a share from 0 to 1 of the range."""
        if self.logarithmic:
            value = math.exp((1 - share) * math.log(self.low) + share * math.log(self.high))
        else:
            value = (1 - share) * self.low + share * self.high
        return min(max(value, self.low), self.high) if 0 <= share <= 1 else value

    def rate(self, value: float) -> float:
        """Of the value, by the share."""
        return value * math.log(self.high / self.low) if self.logarithmic else self.high - self.low

    def share(self, value: float) -> float:
        """The share of the range at which a value lies."""
        if self.logarithmic:
            return math.log(value / self.low) / math.log(self.high / self.low)
        return (value - self.low) / (self.high - self.low)


# from this ratio of its ends on a range by itself is one of orders of magnitude
ORDERS = 100.0


def ends_as_table(given: Any) -> Any:
    """[low, high] as a table; logarithmic where the ends lie orders of magnitude apart."""
    numbers = isinstance(given, list) and len(given) == 2
    if not numbers or any(isinstance(v, bool) or not isinstance(v, int | float) for v in given):
        return given
    low, high = map(float, given)
    return {"low": low, "high": high, "logarithmic": 0 < low * ORDERS <= high}


Sought = Annotated[
    SoughtTable,
    BeforeValidator(ends_as_table, json_schema_input_type=SoughtTable | Pair),
]
SOUGHT = (
    "(no unit): key of the scene, 'friction.coefficient' -> [low, high], as of the key, by orders "
    "of magnitude where high is 100 times low; or a table as in seek"
)


class ObservedColumn(MeasuredColumn):
    """One measured column, of what the scene's result has for it."""

    name: str | None = Field(  # type: ignore[assignment]
        default=None,
        description="(no unit), of the column; left out in a run, whose scene names its record",
    )
    over: str | None = Field(
        default=None,
        description="(no unit): another number of the result, that this one is divided by: "
        "normal_force",
    )
    error: Positive | None = Field(
        default=None,
        description="(the column's SI unit): standard deviation of what was measured; left out: "
        "estimated from what is left",
    )
    factor_error: Positive | None = Field(
        default=None,
        description="-, standard deviation of the measuring chain's factor about 1, which is found "
        "too: measured = factor * true + offset; left out: 1",
    )
    offset_error: Positive | None = Field(
        default=None,
        description="(the column's SI unit): standard deviation of the measuring chain's offset "
        "about 0, which is found too; left out: 0",
    )


class RowsTable(Table):
    """One input of a run that each row of its record has for itself, and that nobody measured."""

    low: Number = Field(description="SI unit of the quantity: the least value it may have")
    high: Number = Field(description="SI unit of the quantity: the greatest value it may have")
    starts: Annotated[int, Field(ge=3, le=1000)] = Field(
        default=33, description="-, values that are looked at first, evenly spread"
    )

    @model_validator(mode="after")
    def _ends(self) -> RowsTable:
        if not self.low < self.high:
            raise relation("low", self.low, f"below high, {self.high:g}")
        return self


class ExplanationTable(Table):
    """Another way to explain the same points."""

    change: dict[str, Any] = Field(
        default_factory=dict,
        description="(no unit): key of the scene -> what it is in this explanation",
    )
    leave_out: list[str] = Field(
        default_factory=list,
        description="(no unit): tables and keys of the scene that this explanation has not",
    )
    seek: dict[str, SoughtTable] | None = Field(
        default=None, description="(no unit): what is sought; left out: what the match seeks"
    )
    sought: dict[str, Sought] | None = Field(default=None, description=SOUGHT)

    @model_validator(mode="after")
    def _one(self) -> ExplanationTable:
        if self.seek and self.sought:
            raise relation("sought", "given with 'seek'", "one of them")
        return self


class MatchTable(Table):
    """What is matched."""

    scene: str | None = Field(
        default=None,
        description="(no unit): the scene file; left out: the tables beside this one. Paths start "
        "beside the file",
    )
    record: str | None = Field(
        default=None, description="(no unit): the file of points; --record names another one"
    )
    inputs: dict[str, MeasuredColumn] = Field(
        default_factory=dict,
        description="(no unit): moving key of the scene, 'creepage[0]' -> the column that drives "
        "it; none of a run, which its own record drives",
    )
    observed: dict[str, ObservedColumn] = Field(
        default_factory=dict,
        description="(no unit): number of the result, 'creep_force[0]' -> the column that it was "
        "measured in, left out: columns that are called so; of a run a quantity of its record, "
        "'left_lateral', left out: all measured forces",
    )
    seek: dict[str, SoughtTable] = Field(
        default_factory=dict,
        description="(no unit): key of the scene, 'friction.coefficient' -> its range; or sought",
    )
    sought: dict[str, Sought] | None = Field(default=None, description=SOUGHT)
    explanations: dict[str, ExplanationTable] = Field(
        default_factory=dict, description="(no unit): name -> another way to explain the points"
    )
    loss: Literal["linear", "soft_l1", "huber", "cauchy"] = Field(
        default="soft_l1",
        description="(no unit): how far points that lie apart count: linear: by their square; the "
        "others less (scipy.optimize.least_squares)",
    )
    starts: Annotated[int, Field(ge=1, le=100)] = Field(
        default=4, description="-, searches, each from another start"
    )
    rows: Annotated[dict[str, RowsTable], Field(max_length=1)] = Field(
        default_factory=dict,
        description="(no unit): of a run, 'lateral_position' or 'yaw' that its record has not -> "
        "the range it is sought in for each row",
    )
    discrepancy: bool | None = Field(
        default=None,
        description="(no unit): whether part of what is left may belong together from point to "
        "point, as the scene's own error does (Kennedy and O'Hagan 2001); left out: true, but with "
        "rows",
    )
    screening: bool = Field(
        default=False,
        description="(no unit): whether what the points do not feel is looked for beforehand "
        "(Morris 1991)",
    )
    sampling: Literal["none", "emcee"] = Field(
        default="none",
        description="(no unit): whether the posterior is sampled beside the intervals (emcee, "
        "Foreman-Mackey et al. 2013)",
    )
    samples: Annotated[int, Field(ge=20, le=1_000_000)] = Field(
        default=400, description="-, steps of each walker, the first fifth left out"
    )
    intervals: Literal["profile", "covariance"] = Field(
        default="profile",
        description="(no unit): intervals by profile likelihood, or by curvature at the optimum",
    )
    folds: Annotated[int, Field(ge=0, le=100)] = Field(
        default=10, description="-, parts of which each is left out once, to predict it; 0: none"
    )
    seed: Annotated[int, Field(ge=0, le=2**32 - 2)] = Field(
        default=0, description="-, of the starts and of the parts"
    )

    @property
    def wanted(self) -> dict[str, SoughtTable]:
        """What is sought."""
        return self.sought or self.seek

    @model_validator(mode="after")
    def _one(self) -> MatchTable:
        if bool(self.sought) == bool(self.seek):
            shown = "given with 'seek'" if self.seek else "missing"
            raise relation(
                "sought", shown, "keys of the scene with their ends, in 'sought' or 'seek'"
            )
        return self

    @model_validator(mode="after")
    def _folds(self) -> MatchTable:
        if self.folds == 1:
            raise relation("folds", self.folds, "0, or 2 and more")
        if self.rows and self.discrepancy:
            raise relation("discrepancy", True, "false with rows, which are solved each by itself")
        if self.rows:
            for key, column in self.observed.items():
                if column.factor_error or column.offset_error:
                    shown = f"factor_error or offset_error in observed.{key}"
                    raise relation("rows", shown, "none of them with rows")
        return self

    @property
    def correlated(self) -> bool:
        """Whether an error of the model is looked for."""
        return not self.rows if self.discrepancy is None else self.discrepancy


@dataclass(frozen=True)
class Explanation:
    """A scene's content and what is sought in it."""

    name: str
    content: dict[str, Any]
    seek: dict[str, SoughtTable]

    def record_name(self) -> Any:
        """Of the record that a run's scene names."""
        return self.content.get("rig", {}).get("record")

    def case(self, values: Mapping[str, float]) -> dict[str, Any]:
        """The content with values of what is sought. Raises CaseError."""
        content = deepcopy(self.content)
        for key, value in values.items():
            put(content, key, value, named="match.sought")
        return content


@dataclass(frozen=True)
class Plan:
    """A checked match. folder: where the scene's paths start. explanations: of which the first is
    the match's own; its values go into the scene that is written. record: n rows; None of a run.
    units: of a run's columns. warnings: of what is hardly meant, or was not said."""

    name: str
    table: MatchTable
    kind: str
    folder: Path
    explanations: tuple[Explanation, ...]
    record: Record | None
    units: Mapping[str, str] = field(default_factory=dict)
    warnings: tuple[str, ...] = ()

    @property
    def source(self) -> str:
        """Name of the file of points."""
        return self.record.path.name if self.record else str(self.explanations[0].record_name())

    def measured(self) -> Array:
        """SI units, [observed, n], NaN where a cell is empty."""
        assert self.record is not None
        return np.array([self.record.signals[observed_name(key)] for key in self.table.observed])

    def inputs(self) -> dict[str, Array]:
        """Input -> SI units, [n]."""
        assert self.record is not None
        return {key: self.record.signals[input_name(key)] for key in self.table.inputs}


def input_name(key: str) -> str:
    """Of a signal in the record; an input and a result may have the same name."""
    return f"inputs.{key}"


def observed_name(key: str) -> str:
    """Of a signal in the record."""
    return f"observed.{key}"


def load_match(path: str | Path, record: str | Path | None = None) -> Plan:
    """Checks a match's file, the scene and the record, but not the values of what is sought.

    record: in place of the one that the file names. Raises CaseError, RecordError.
    """
    path = Path(path)
    content = plain(read_toml(path))
    own = content.pop("match", None)
    if not isinstance(own, dict):
        raise CaseError(f"match: value is missing, allowed a table [match] in {path.name}")
    table = check_table(MatchTable, own, "match")
    if (table.scene is None) == (not content):
        shown = repr(table.scene) if table.scene else "missing"
        raise CaseError(
            f"match.scene: value is {shown}, allowed the name of a scene, or the scene's tables "
            "beside [match]"
        )
    folder = path.parent
    if table.scene is not None:
        place = folder / table.scene
        content, folder = plain(read_toml(place)), place.parent
    kind = "rig" if "rig" in content else content.get("kind")
    made = explanations_of(table, content)
    if kind == "rig":
        return run_plan(path.stem, table, folder, made, record)
    if table.rows:
        raise CaseError("match.rows: value is given, allowed of a rig only")
    if kind not in KINDS:
        raise CaseError(f"kind: value is {kind!r}, allowed {', '.join(KINDS)} or a rig in a match")
    file = Path(record) if record is not None else None
    if file is None and table.record is not None:
        file = path.parent / table.record
    if file is None:
        raise CaseError("match.record: value is missing, allowed a file of points, or --record")
    table, told = by_heads(table, file)
    read = points(table, file, kind)
    return Plan(path.stem, table, kind, folder, made, read, {}, (*read.warnings, *told))


def run_plan(
    name: str,
    table: MatchTable,
    folder: Path,
    made: tuple[Explanation, ...],
    record: str | Path | None,
) -> Plan:
    """Of a rig. Raises CaseError, RecordError."""
    check_run(table, made, record)
    prepare = kind_of("rig").prepare
    assert prepare is not None
    found = [prepare(one.content, folder, tuple(table.rows)) for one in made]
    made = tuple(
        replace(one, content=ready.content) for one, ready in zip(made, found, strict=True)
    )
    if not table.observed:
        forces = {key: ObservedColumn() for key in found[0].forces}
        if not forces:
            raise CaseError(
                "match.observed: value is missing, allowed what the record has by [rig.columns]"
            )
        table = table.model_copy(update={"observed": forces})
    return Plan(name, table, "rig", folder, made, None, found[0].units, tuple(found[0].warnings))


def check_run(table: MatchTable, made: tuple[Explanation, ...], record: str | Path | None) -> None:
    """Of a rig, whose scene has the record. record: in its place. Raises CaseError."""
    for given, name in ((table.inputs, "inputs"), (table.record, "record")):
        if given:
            raise CaseError(f"match.{name}: value is given, allowed none of a rig: [rig] has them")
    for key, column in table.observed.items():
        if key not in BY_NAME or BY_NAME[key].role != OUTPUT or column.name or column.over:
            allowed = ", ".join(name for name, q in BY_NAME.items() if q.role == OUTPUT)
            raise CaseError(
                f"match.observed: value is {key!r}, allowed {allowed}, with no more than errors: "
                "[rig.columns] says where they are"
            )
    for explanation in made:
        if record is not None:
            explanation.content["rig"]["record"] = str(Path(record).resolve())
        if explanation.record_name() is None:
            raise CaseError("rig.record: value is missing, allowed a measured run, or --record")


def explanations_of(table: MatchTable, content: dict[str, Any]) -> tuple[Explanation, ...]:
    """The match's own and those beside it. Raises CaseError."""
    found = [Explanation(OWN, content, table.wanted)]
    for name, other in table.explanations.items():
        own = deepcopy(content)
        for key in other.leave_out:
            leave_out(own, key, name)
        for key, value in other.change.items():
            put(own, key, value, named=f"match.explanations.{name}.change")
        found.append(Explanation(name, own, other.sought or other.seek or table.wanted))
    return tuple(found)


def leave_out(content: dict[str, Any], key: str, name: str) -> None:
    """Takes a table or a key out of a scene's content. Raises CaseError."""
    *above, last = key.split(".")
    place: Any = content
    for step in above:
        place = place.get(step) if isinstance(place, dict) else None
    if not isinstance(place, dict) or last not in place:
        raise CaseError(
            f"match.explanations.{name}.leave_out: value is {key!r}, allowed a table or key that "
            "the scene has"
        )
    del place[last]


def points(table: MatchTable, file: Path, kind: str) -> Record:
    """The record, in SI units by the names of inputs and results. Raises RecordError."""
    driven = {input_name(key): column for key, column in table.inputs.items()}
    columns = driven | {observed_name(key): column for key, column in table.observed.items()}
    for key, column in table.observed.items():
        if column.name is None:
            raise CaseError(f"match.observed.{key}.name: value is missing, allowed a column")
    logged = {
        input_name(key): unit_of_input(kind, key) or own_unit(column)
        for key, column in table.inputs.items()
    }
    logged |= {
        observed_name(key): unit_of_observed(key, column, column.over)
        for key, column in table.observed.items()
    }
    read = read_record(file, columns, logged=logged, prefix="match")
    slips = {name: one for name, one in driven.items() if name.startswith("inputs.creepage")}
    return replace(read, warnings=[*read.warnings, *creepage_doubts(read, slips)])


def by_heads(table: MatchTable, file: Path) -> tuple[MatchTable, list[str]]:
    """With columns by their names where the match does not say which are what, and what to tell.

    Raises CaseError, RecordError."""
    if table.inputs and table.observed:
        return table, []
    found = heads_of(file)
    inputs = table.inputs or {key: MeasuredColumn(**column) for key, column in found.inputs.items()}
    own = {key: ObservedColumn(**column) for key, column in found.observed.items()}
    observed, told = table.observed or own, found.warnings if not table.observed else []
    for name, columns in (("inputs", inputs), ("observed", observed)):
        if not columns:
            raise CaseError(
                f"match.{name}: value is missing, allowed columns of {file.name}, or such that are "
                f"called {found.allowed(name)}"
            )
    return table.model_copy(update={"inputs": inputs, "observed": observed}), told


def values_of(seek: Mapping[str, SoughtTable], shares: Array) -> dict[str, Value]:
    """What is sought at shares of their ranges."""
    return {
        key: sought.at(float(share))
        for (key, sought), share in zip(seek.items(), shares, strict=True)
    }
