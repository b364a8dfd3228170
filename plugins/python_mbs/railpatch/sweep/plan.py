"""What a sweep does: its scene, the keys that vary and the points they take."""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Mapping
from copy import deepcopy
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
import scipy
from numpy.typing import NDArray
from pydantic import Field, model_validator

from railpatch._core import version
from railpatch.case.kinds import kind_of
from railpatch.case.load import KINDS, OTHERS, check_table, plain, read_toml, refuse_others
from railpatch.case.types import Number, Table, relation, show
from railpatch.command.output import is_file
from railpatch.errors import CaseError

Value = float | int | bool | str
Array = NDArray[np.float64]
# designs whose number of points `samples` says, and those that sensitivities come from
SAMPLED = ("latin_hypercube", "sobol", "morris", "saltelli")
SENSITIVITY = ("morris", "saltelli")
# cases of one sweep
MOST = 10_000_000
# of every row, beside keys and outputs
COLUMNS = ("id", "status", "reason", "warnings", "seconds")
ROUNDING = 1e-15  # of a range's greater end
LEVELS = 4  # of a key in Morris's design


class SweepTable(Table):
    """What is swept."""

    scene: str = Field(
        description="(no unit): the scene file, of any kind that a command of railpatch runs; "
        "relative paths start beside the sweep"
    )
    design: Literal["grid", "list", "latin_hypercube", "sobol", "morris", "saltelli"] = Field(
        default="grid",
        description="(no unit): grid: every combination; list: the first values of all keys, then "
        "the second ones; latin_hypercube, sobol: points that fill the space evenly; morris, "
        "saltelli: those that Morris's and Sobol's sensitivities need",
    )
    samples: Annotated[int, Field(ge=1, le=MOST)] | None = Field(
        default=None,
        description="-, number of points of latin_hypercube and sobol, of trajectories of morris, "
        "of base points of saltelli",
    )
    seed: Annotated[int, Field(ge=0, le=2**32 - 2)] = Field(
        default=0, description="-, of the sampled designs"
    )
    outputs: list[str] | None = Field(
        default=None,
        description="(no unit): names of results; left out: numbers of the result that are not in "
        "its patches, of a run its summary",
    )
    keep_logs: bool = Field(
        default=False, description="(no unit): whether the logs of runs are kept, in logs/"
    )

    @model_validator(mode="after")
    def _samples(self) -> SweepTable:
        if (self.samples is None) != (self.design not in SAMPLED):
            allowed = f"with the designs {', '.join(SAMPLED)}, and only there"
            raise relation("samples", self.samples, allowed)
        if self.design in ("sobol", "saltelli") and self.samples and self.samples.bit_count() != 1:
            raise relation("samples", self.samples, f"a power of 2 with the design {self.design}")
        return self


class VaryTable(Table):
    """One key that varies: by a list of values or over a range."""

    key: Annotated[str, Field(min_length=1)] = Field(
        description="(no unit): of the scene, with its table: friction.coefficient, "
        "motion.creepage[0]"
    )
    values: Annotated[list[Value], Field(min_length=1)] | None = Field(
        default=None, description="as of the key: the values it takes"
    )
    low: Number | None = Field(default=None, description="as of the key: one end of its range")
    high: Number | None = Field(default=None, description="as of the key: the other end")
    count: Annotated[int, Field(ge=2, le=MOST)] | None = Field(
        default=None, description="-, values from low to high, of the designs grid and list"
    )
    logarithmic: bool = Field(
        default=False, description="(no unit): whether the range's logarithm is divided evenly"
    )

    @model_validator(mode="after")
    def _range(self) -> VaryTable:
        ends = (self.low, self.high)
        if (self.values is None) == (None in ends) or (self.values and ends != (None, None)):
            raise relation("values", self.values, "either 'values' or both 'low' and 'high'")
        if self.values is None and self.logarithmic and not min(*ends) > 0:
            raise relation("low", self.low, "> 0 where the range is logarithmic")
        if self.values is not None and (self.count is not None or self.logarithmic):
            raise relation("values", self.values, "without 'count' and 'logarithmic'")
        return self

    def listed(self) -> list[Value]:
        """The values of a grid or a list. Raises CaseError."""
        if self.values is not None:
            return list(self.values)
        if self.count is None:
            raise CaseError(f"vary.count: value is missing of {self.key}, allowed 2 to {MOST}")
        return [self.at(share) for share in np.linspace(0.0, 1.0, self.count)]

    def at(self, share: float) -> Value:
        """The value at a share from 0 to 1 of the range, or of the list."""
        if self.values is not None:
            return self.values[min(int(share * len(self.values)), len(self.values) - 1)]
        assert self.low is not None
        assert self.high is not None
        if share in (0.0, 1.0):
            return self.high if share else self.low
        if self.logarithmic:
            return math.exp((1 - share) * math.log(self.low) + share * math.log(self.high))
        value = float((1 - share) * self.low + share * self.high)
        # what rounding leaves of zero
        return value if abs(value) > ROUNDING * max(abs(self.low), abs(self.high)) else 0.0


class SweepFile(Table):
    """A sweep's file."""

    sweep: SweepTable = Field(description="what is swept (no unit)")
    vary: list[VaryTable] = Field(min_length=1, description="the keys that vary (no unit)")


@dataclass(frozen=True)
class Plan:
    """A checked sweep. content: of the scene; points: of every case, the values of the keys, files
    by the names that the sweep has for them."""

    name: str
    table: SweepTable
    vary: tuple[VaryTable, ...]
    kind: str
    content: dict[str, Any]
    files: dict[str, str]  # path -> check sum of what the scene names
    points: list[tuple[Value, ...]]
    named: dict[str, str] = field(default_factory=dict)  # values that are files -> their paths
    sums: dict[str, str] = field(default_factory=dict)  # of these: path -> check sum

    @property
    def keys(self) -> tuple[str, ...]:
        """Those that vary."""
        return tuple(vary.key for vary in self.vary)

    def case(self, point: tuple[Value, ...]) -> dict[str, Any]:
        """The scene's content at a point. Raises CaseError."""
        content = deepcopy(self.content)
        for key, value in zip(self.keys, self.placed(point), strict=True):
            put(content, key, value)
        return content

    def placed(self, point: tuple[Value, ...]) -> tuple[Value, ...]:
        """The point's values, of files their paths."""
        return tuple(self.named.get(v, v) if isinstance(v, str) else v for v in point)

    def ids(self) -> list[str]:
        """Of each case, by its content and that of its files: sweeps that have a case in common
        have its id in common."""
        base, keys = self._base, self.keys

        def told(value: Value) -> str:
            path = self.named.get(value) if isinstance(value, str) else None
            return repr(value) if path is None else f"{path} {self.sums[path]}"

        return [
            digest((base, *sorted(zip(keys, map(told, point), strict=True))))
            for point in self.points
        ]

    @property
    def _base(self) -> str:
        shared = (version(), self.kind, self.content, self.files, self.table.outputs)
        return digest(shared)

    def problem(self) -> dict[str, Any]:
        """As SALib takes it, on the unit cube."""
        return {
            "num_vars": len(self.keys),
            "names": list(self.keys),
            "bounds": [[0.0, 1.0]] * len(self.keys),
        }

    def unit_points(self) -> Array:
        """Of a sampled design, [cases, keys] from 0 to 1."""
        return unit_points(self.table, len(self.vary))


def load_plan(path: str | Path, besides: tuple[str, ...] = ()) -> Plan:
    """Checks a sweep's file and the scene it names, but not its cases. besides: tables that are
    another reader's. Raises CaseError."""
    path = Path(path)
    content = plain(read_toml(path))
    refuse_scene(content, path)
    unknown = set(content) - {"sweep", "vary", *besides}
    if unknown:
        raise CaseError(
            f"{name}: is no table of a sweep, allowed sweep, vary" for name in sorted(unknown)
        )
    table = check_table(SweepTable, content.get("sweep", {}), "sweep")
    entries = content.get("vary")
    if not isinstance(entries, list) or not entries:
        raise CaseError(f"vary: value is {show(entries)}, allowed [[vary]] tables, one for a key")
    vary = tuple(check_table(VaryTable, entry, f"vary[{i}]") for i, entry in enumerate(entries))
    keys = [one.key for one in vary]
    for key in keys:
        if keys.count(key) > 1:
            raise CaseError(f"vary.key: value is {key!r} twice, allowed once")
    for name in table.outputs or ():
        if name in (*COLUMNS, *keys):
            raise CaseError(f"sweep.outputs: value is {name!r}, which every row has")
        if (table.outputs or []).count(name) > 1:
            raise CaseError(f"sweep.outputs: value is {name!r} twice, allowed once")
    scene = path.parent / table.scene
    base = plain(read_toml(scene))
    kind = kind_of_content(base, scene)
    files = absolute_files(base, scene.parent)
    # as those of the scene, files that vary start at its folder
    texts = {v: v for one in vary for v in one.values or () if isinstance(v, str)}
    sums = absolute_files(texts, scene.parent)
    named = {text: path for text, path in texts.items() if path in sums}
    plan = Plan(path.name, table, vary, kind, base, files, points_of(table, vary), named, sums)
    plan.case(plan.points[0])
    return plan


def refuse_scene(content: Mapping[str, Any], path: Path) -> None:
    """Says once that a file is a scene, or one of another command. Raises CaseError."""
    try:
        refuse_others(content, "sweep")
    except CaseError as error:
        hint = f'a sweep names its scene: [sweep] scene = "{path.name}", and [[vary]] its keys'
        raise CaseError(f"{path}: {error}; {hint}") from None


def kind_of_content(content: Mapping[str, Any], path: Path) -> str:
    """The kind of scene by its tables. Raises CaseError."""
    for name, command in OTHERS.items():
        if name in content:
            if command in ("sweep", "match"):
                raise CaseError(f"sweep.scene: {path} is a {command} itself, allowed a scene")
            return kind_of("wheelset_run" if command == "wheelset" else command).name
    kind = content.get("kind")
    if kind not in KINDS:
        raise CaseError(f"{path}: kind: value is {show(kind)}, allowed {', '.join(KINDS)}")
    return str(kind)


def absolute_files(content: dict[str, Any], folder: Path) -> dict[str, str]:
    """Makes the names of files beside a scene absolute; returns their check sums."""
    found: dict[str, str] = {}

    def walk(value: Any) -> Any:
        if isinstance(value, dict):
            return {key: walk(item) for key, item in value.items()}
        if isinstance(value, list):
            return [walk(item) for item in value]
        if isinstance(value, str) and is_file(folder / value):
            path = str((folder / value).resolve())
            found[path] = hashlib.sha256(Path(path).read_bytes()).hexdigest()
            return path
        return value

    content.update({key: walk(value) for key, value in content.items()})
    return found


def points_of(table: SweepTable, vary: tuple[VaryTable, ...]) -> list[tuple[Value, ...]]:
    """Of every case the keys' values. Raises CaseError."""
    if table.design == "grid":
        lists = [one.listed() for one in vary]
        count = math.prod(map(len, lists))
        if count > MOST:
            raise CaseError(f"vary.count: the grid has {count} cases, allowed at most {MOST}")
        places = np.stack(np.unravel_index(np.arange(count), [len(one) for one in lists]), axis=1)
        return [tuple(one[i] for one, i in zip(lists, place, strict=True)) for place in places]
    if table.design == "list":
        lists = [one.listed() for one in vary]
        lengths = {one.key: len(values) for one, values in zip(vary, lists, strict=True)}
        if len(set(lengths.values())) > 1:
            shown = ", ".join(f"{key} has {length}" for key, length in lengths.items())
            raise CaseError(f"vary.values: {shown}, allowed lists of one length")
        return list(zip(*lists, strict=True))
    for one in vary:
        if one.count is not None:
            raise CaseError(
                f"vary.count: value is {one.count} of {one.key}, allowed to be left "
                f"out with the design {table.design}"
            )
    shares = unit_points(table, len(vary))
    return [tuple(one.at(float(s)) for one, s in zip(vary, row, strict=True)) for row in shares]


def unit_points(table: SweepTable, keys: int) -> Array:
    """Points of a sampled design in the unit cube, [cases, keys]. Raises CaseError."""
    count, seed = table.samples, table.seed
    assert count is not None
    if table.design == "latin_hypercube":
        return scipy.stats.qmc.LatinHypercube(keys, seed=seed).random(count)
    if table.design == "sobol":
        return scipy.stats.qmc.Sobol(keys, seed=seed).random(count)
    salib()
    from SALib.sample import morris, sobol

    problem = {
        "num_vars": keys,
        "names": [f"x{i}" for i in range(keys)],
        "bounds": [[0.0, 1.0]] * keys,
    }
    if keys < 2:
        raise CaseError(f"vary: has {keys} key, allowed 2 or more with the design {table.design}")
    # SALib takes a seed of 0 for none
    if table.design == "morris":
        return np.asarray(morris.sample(problem, count, num_levels=LEVELS, seed=1 + seed))
    return np.asarray(sobol.sample(problem, count, calc_second_order=False, seed=1 + seed))


def salib() -> None:
    """Raises CaseError that says what to install."""
    try:
        import SALib  # noqa: F401
    except ImportError:
        raise CaseError(
            "sweep.design: sensitivities need SALib, which is not installed; "
            "pip install 'railpatch[sweep]' has it"
        ) from None


def put(content: dict[str, Any], key: str, value: Any, *, named: str = "vary.key") -> None:
    """Sets the value at a dotted key; tables that are absent are made. named: of the key in
    messages. Raises CaseError."""
    place: Any = content
    steps = steps_of(key, named)
    for step, following in zip(steps, [*steps[1:], None], strict=True):
        if isinstance(step, int):
            if not isinstance(place, list) or not 0 <= step < len(place):
                raise CaseError(
                    f"{named}: value is {key!r}, but the scene has no list with a "
                    f"number {step} there"
                )
        elif not isinstance(place, dict):
            raise CaseError(
                f"{named}: value is {key!r}, but {step!r} would lie in what is no table"
            )
        elif isinstance(following, str):
            place.setdefault(step, {})
        if following is None:
            place[step] = value
        elif isinstance(step, str) and step not in place:
            raise CaseError(f"{named}: value is {key!r}, but the scene has no list {step!r}")
        else:
            place = place[step]


def steps_of(key: str, named: str = "vary.key") -> list[str | int]:
    """ "motion.creepage[0]" as names and numbers. Raises CaseError."""
    steps: list[str | int] = []
    for part in key.split("."):
        name, *indices = part.replace("]", "").split("[")
        if not name or not all(index.isdecimal() for index in indices):
            raise CaseError(f"{named}: value is {key!r}, allowed names with dots, and [0] of lists")
        steps += [name, *map(int, indices)]
    return steps


def digest(content: Any) -> str:
    """Of what JSON can write; the same for the same content."""
    text = json.dumps(content, sort_keys=True, default=str)
    return hashlib.sha256(text.encode()).hexdigest()[:32]
