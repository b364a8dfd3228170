"""solve_many(): many states of one case, from arrays to arrays, on several threads."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from railpatch import _core
from railpatch.case.arrays import plain_numbers
from railpatch.case.asked import refuse_asked, refuse_changes
from railpatch.case.load import Case, Scene, load_scene
from railpatch.case.moving import moving_keys, refuse_unknown
from railpatch.case.patch import PatchCase
from railpatch.case.patch_doubts import patch_doubts
from railpatch.case.to_core import BODY_OF_TABLE, DEVIATION, config_of, field_of, input_of
from railpatch.case.track import irregularity_of
from railpatch.case.types import BODIES, SIDES, show
from railpatch.contact import CaseSource
from railpatch.errors import CaseError, StateError
from railpatch.pressure_error import run_doubts
from railpatch.result import (
    DIVISION,
    FIELDS,
    GOOD,
    PATCH_UNITS,
    PLACE_UNITS,
    TOTAL_UNITS,
    TURNING,
    WHEEL_UNITS,
    WHEELSET_UNITS,
    shaped_field,
)

# states for each thread that are solved before their results are taken out, and how it grows where
# that takes less than QUICK, s
BLOCK, MOST_IN_BLOCK, QUICK = 256, 4096, 0.02
MOST_STATES = 100_000_000
LONGEST = 100_000  # steps of a sequence
STATUSES = np.array(list(_core.STATUSES.values()))
# of a record that stands beside its parts, or is a text
APART = ("status", "reason", "reason_value", "warnings")
ESTIMATES = ("creep_force", "spin_moment", "max_pressure")
RIGHT = SIDES.index("right")


def record_type(name: str) -> np.dtype:
    """numpy's type of a struct of the core: "input", "result", "side" or "patch"."""
    layout = _core.LAYOUTS[name]
    members = layout["members"]
    formats = [
        (record_type(kind) if kind in _core.LAYOUTS else kind, shape)
        for _, kind, shape in members.values()
    ]
    offsets = [offset for offset, _, _ in members.values()]
    return np.dtype(
        {
            "names": list(members),
            "formats": formats,
            "offsets": offsets,
            "itemsize": layout["size"],
        }
    )


INPUT, RESULT = record_type("input"), record_type("result")
PATCH = record_type("patch")
# what is read of a result that is one patch
ONE_PATCH = np.dtype([("patch", PATCH), ("warnings", "<u4"), ("room", "V4")])
Slices = list[tuple[int, int, int]]


def slices_of(case: Case) -> tuple[np.dtype, Slices]:
    """What is kept of a result, and where it lies there: (from, bytes, to)."""
    if not isinstance(case, PatchCase):
        return RESULT, [(0, RESULT.itemsize, 0)]
    side = record_type("side")
    place = RESULT.fields["side"][1] + RIGHT * side.itemsize + side.fields["patch"][1]
    warnings = RESULT.fields["warnings"][1]
    return ONE_PATCH, [(place, PATCH.itemsize, 0), (warnings, 4, ONE_PATCH.fields["warnings"][1])]


class States:
    """Results of many states: ``states["creep_force"]`` is an array with a row for each.

    Names are those of the JSON result, with dots between its parts: of a wheel ``force`` [n, 3],
    ``patches.normal_force`` [n, p] with NaN where a state has fewer than p patches; of a wheelset
    ``left.force``. ``status`` is an array of texts, ``reason`` and ``warnings`` are those of states
    that have one, by their numbers: dicts of a text, and of texts. ``doubts``: warnings of the
    profiles, for all states (docs/profiles.md). What the scene left out is NaN.
    """

    def __init__(
        self,
        arrays: dict[str, NDArray[Any]],
        reason: dict[int, str],
        warnings: dict[int, list[str]],
        doubts: list[str],
    ) -> None:
        self.arrays, self.reason, self.warnings, self.doubts = arrays, reason, warnings, doubts

    def __getitem__(self, name: str) -> NDArray[Any]:
        if name not in self.arrays:
            raise KeyError(f"no quantity {name!r}; there are {', '.join(self.arrays)}")
        return self.arrays[name]

    def __contains__(self, name: object) -> bool:
        return name in self.arrays

    def __len__(self) -> int:
        return len(self.arrays["status"])

    def __repr__(self) -> str:
        names, counts = np.unique(self.arrays["status"], return_counts=True)
        shown = ", ".join(f"{count} {name}" for name, count in zip(names, counts, strict=True))
        return f"States({len(self)}: {shown})"

    def keys(self) -> list[str]:
        """Names of the quantities."""
        return list(self.arrays)

    @property
    def good(self) -> NDArray[np.bool_]:
        """[n], whether a state's solve ended well; no contact is a valid result."""
        return np.isin(self.arrays["status"], GOOD)

    def plot(self, name: str, over: str | Any | None = None) -> Any:
        """A plotly.graph_objects.Figure of a quantity's numbers, by state.

        over: the name of a quantity, or an array [n], along the abscissa; default the number of the
        state. Raises KeyError, ValueError.
        """
        import plotly.graph_objects as go

        from railpatch.page.figures import styled

        values = self[name]
        if values.dtype.kind not in "fiu":
            raise ValueError(f"plot: {name} holds no numbers")
        along = (
            np.arange(len(self)) if over is None else self[over] if isinstance(over, str) else over
        )
        along = np.asarray(along)
        if along.shape != (len(self),):
            shown = f"{over!r}" if isinstance(over, str) else "over"
            raise ValueError(f"plot: {shown} has the shape {along.shape}, allowed ({len(self)},)")
        figure = go.Figure()
        flat = values.reshape(len(values), -1)
        for i, place in enumerate(np.ndindex(values.shape[1:])):
            label = name + "".join(f"[{k}]" for k in place)
            figure.add_trace(go.Scatter(x=along, y=flat[:, i], mode="markers", name=label))
        figure.update_layout(showlegend=flat.shape[1] > 1)
        figure.update_xaxes(
            title_text=over if isinstance(over, str) else "state" if over is None else None
        )
        unit = unit_of_name(name)
        figure.update_yaxes(title_text=f"{name} [{unit}]" if unit else name)
        return styled(figure, 420)

    def to_pandas(self) -> Any:
        """A pandas.DataFrame with a column for each number: ``creep_force[0]``. Needs pandas."""
        pandas = _imported("pandas")
        columns: dict[str, Any] = {}
        for name, values in self.arrays.items():
            flat = values.reshape(len(values), -1)
            for i, place in enumerate(np.ndindex(values.shape[1:])):
                label = name + "".join(f"[{k}]" for k in place)
                columns[label] = flat[:, i]
        return pandas.DataFrame(columns)

    def to_xarray(self) -> Any:
        """An xarray.Dataset with the dimension ``state``; others by their length. Needs xarray."""
        xarray = _imported("xarray")
        return xarray.Dataset(
            {
                name: (("state", *(f"{name}_{k}" for k in range(1, values.ndim))), values)
                for name, values in self.arrays.items()
            }
        )


def unit_of_name(name: str) -> str:
    """Of a quantity by its name with dots; none for a number without one."""
    units = {**PATCH_UNITS, **PLACE_UNITS, **WHEEL_UNITS, **WHEELSET_UNITS, **TOTAL_UNITS}
    if name.startswith("error_estimate."):
        return dict(zip(ESTIMATES, units["error_estimate"].split(", "), strict=True))[
            name.split(".")[-1]
        ]
    return units.get(name.split(".")[-1], "")


def _imported(name: str) -> Any:
    """A package that is not needed otherwise. Raises ImportError that says what to install."""
    from importlib import import_module

    try:
        return import_module(name)
    except ImportError:
        raise ImportError(f"{name} is not installed; pip install {name} has it") from None


def solve_many(
    case: CaseSource,
    inputs: Mapping[str, Any],
    *,
    threads: int = 1,
    fields: bool = False,
    sequence: int = 1,
    outputs: Sequence[str] | None = None,
    progress: Callable[[int, int], None] | None = None,
    folder: str | Path | None = None,
) -> States:
    """Solves many states of a case.

    case: as of solve(). inputs: moving key -> array with a row for each of n states, or one value
    for all: ``creepage`` [n, 2], ``normal_force`` [n]; ``left.offset`` [n, 3],
    ``track.right.rotation``, ``temperature.rail``; others keep the case's value. threads: states
    are independent, each starts from nothing, so results are the same to the bit for any number.
    sequence: that many rows after each other are one motion: each step starts from the last one's
    solution, the first from nothing. outputs: names of results to keep, default all. fields: also
    pressure, traction, ... of each patch, as arrays of arrays, on one thread. progress: told how
    many of how many states are solved. folder: where relative paths start.

    The interpreter's lock is released; Ctrl-C ends it within 0.2 s. Raises CaseError (a wrong input
    of one state: StateError, with its number), ProfileError.
    """
    scene = case if isinstance(case, Scene) else load_scene(case, folder)
    check_call(scene, threads, fields, sequence)
    refuse_asked(scene.case, "in solve_many: steps of a Contact or a sweep have it")
    refuse_changes(scene.case, "in solve_many: all states have one")
    columns, count = columns_of(scene.case, inputs)
    if count % sequence:
        raise CaseError(f"sequence: value is {sequence}, allowed what divides {count} states")
    base = np.frombuffer(_core.input_record(input_of(scene.case)), dtype=np.uint8)
    contacts = [_core.Contact(config_of(scene)) for _ in range(threads)]
    found = Collected(scene.case, outputs, fields)
    size = max(1, BLOCK * threads // sequence) * sequence
    kept, slices = (RESULT, []) if fields else slices_of(scene.case)
    results = np.zeros(0, dtype=kept)
    first = 0
    while first < count:
        begin = time.perf_counter()
        records = records_of(base, columns, first, min(size, count - first))
        if len(results) < len(records):
            results = np.zeros(len(records), dtype=kept)
        taken = results[: len(records)]
        try:
            if fields:
                solve_with_fields(contacts[0], records, taken, sequence, found)
            else:
                places = records.view(np.uint8), sequence, taken.view(np.uint8)
                _core.Contact.step_many(contacts, *places, slices, kept.itemsize)
        except StateError as error:
            raise StateError(first + error.state, error.problem) from None
        found.take(first, taken)
        first += len(records)
        if progress is not None:
            progress(first, count)
        # threads are made for each block: quick states come in larger ones
        if time.perf_counter() - begin < QUICK and 2 * size <= MOST_IN_BLOCK:
            size *= 2
    said = patch_doubts if isinstance(scene.case, PatchCase) else run_doubts
    doubts = said(scene.case, scene.folder)
    return found.states(doubts)


def check_call(scene: Scene, threads: int, fields: bool, sequence: int) -> None:
    """Refuses what is not for many states. Raises CaseError."""
    for name, value, most in (("threads", threads, 1024), ("sequence", sequence, LONGEST)):
        if isinstance(value, bool) or not isinstance(value, int) or not 1 <= value <= most:
            raise CaseError(f"{name}: value is {show(value)}, allowed 1 to {most}")
    if fields and threads > 1:
        raise CaseError(f"threads: value is {threads}, allowed 1 with fields")
    if irregularity_of(scene) is not None:
        raise CaseError("track.irregularity: value is given, allowed none for many states")
    if isinstance(scene.case, PatchCase) and len(scene.case.motion.creepages) > 1:
        raise CaseError("motion.creepage: value is a list of steps, allowed one pair for many")


Place = tuple[str, tuple[int, ...]]


def places_of(case: Case) -> dict[str, Place]:
    """Name of an input -> field of rp_input, and where in it."""
    places: dict[str, Place] = {}
    tables = moving_keys(case)
    found = () if isinstance(case, PatchCase) else case.wheelset.found
    for key, table in tables.items():
        if key in SIDES or key == "track":
            # deviations of wheels stand under their side, those of rails under track and side
            sides = SIDES if key == "track" else (key,)
            for side in sides:
                prefix = f"{key}.{side}" if key == "track" else key
                for name in DEVIATION:
                    field = f"{BODY_OF_TABLE[table]}_{name}"
                    places[f"{prefix}.{name}"] = field, (SIDES.index(side),)
        elif key == "temperature":
            for k, (body, stores) in enumerate(zip(BODIES, case.temperature.stores, strict=True)):
                if not stores:
                    places[f"temperature.{body}"] = "bulk_temperature", (k,)
        elif key not in found and (field := field_of(table, key, _core.INPUT_FIELDS)):
            places[key] = field, ()
    return places


def columns_of(case: Case, inputs: Mapping[str, Any]) -> tuple[dict[Place, NDArray[Any]], int]:
    """Field and place in it -> array [n, ...] or one value for all; and n. Raises CaseError."""
    places = places_of(case)
    flat = dict(flattened(inputs))
    refuse_unknown(flat, places, "")
    columns: dict[Place, NDArray[Any]] = {}
    counts: dict[str, int] = {}
    for name, value in flat.items():
        field, index = places[name]
        shape = INPUT[field].shape[len(index) :]
        array = numbers_of(name, value, INPUT[field].base)
        if array.shape == shape:
            columns[field, index] = array
        elif array.ndim == len(shape) + 1 and array.shape[1:] == shape:
            columns[field, index] = array
            counts[name] = len(array)
        else:
            each = "one number" if not shape else f"{shape[0]} numbers"
            raise CaseError(
                f"{name}: value has the shape {array.shape}, allowed {each} for each state: "
                f"{('n', *shape)}"
            )
    if len(set(counts.values())) != 1:
        told = ", ".join(f"{name} has {n}" for name, n in counts.items()) or "none has rows"
        raise CaseError(f"inputs: {told}, allowed arrays with as many rows, one for each state")
    count = next(iter(counts.values()))
    if not 1 <= count <= MOST_STATES:
        raise CaseError(f"inputs: have {count} rows, allowed 1 to {MOST_STATES}")
    check_kept(case, columns, count)
    return columns, count


def numbers_of(name: str, value: Any, kind: np.dtype) -> NDArray[Any]:
    """An input's numbers as the core has them: finite, and integers without fractions. Raises
    CaseError."""
    numbers = plain_numbers(name, value)
    wrong = ~np.isfinite(numbers)
    if wrong.any():
        state = np.argwhere(wrong)[0][:1]
        raise CaseError(f"{name}: value of state {state} is not finite, allowed numbers")
    array = numbers.astype(kind)
    if (array != numbers).any():
        state = np.argwhere(array != numbers)[0][:1]
        raise CaseError(f"{name}: value of state {state} is no integer, allowed integers")
    return array


def check_kept(case: Case, columns: dict[Place, NDArray[Any]], count: int) -> None:
    """What a step may not change, and what the core counts otherwise. Raises CaseError."""
    if not isinstance(case, PatchCase):
        return
    force = columns.get(("tangential_force", ()))
    for i, prescribed in enumerate(case.motion.prescribed):
        if force is not None and not prescribed and np.any(force[..., i] != 0):
            raise CaseError(
                f"tangential_force: has component {i}, allowed 0 where the case prescribes none"
            )
    distance = columns.get(("distance", ()))
    if distance is not None:
        columns["distance", ()] = distance / (case.motion.steps or 1)


def flattened(inputs: Mapping[str, Any], prefix: str = "") -> Iterator[tuple[str, Any]]:
    """Tables in tables by names with dots. Raises CaseError."""
    if not isinstance(inputs, Mapping):
        raise CaseError(f"inputs: value is {show(inputs)}, allowed a table of arrays")
    for key, value in inputs.items():
        if isinstance(value, Mapping):
            yield from flattened(value, f"{prefix}{key}.")
        else:
            yield f"{prefix}{key}", value


def records_of(
    base: NDArray[np.uint8], columns: dict[Place, NDArray[Any]], first: int, count: int
) -> NDArray[Any]:
    """Of rp_input, of states from ``first`` on."""
    # by bytes: a record has more than its named members
    records = np.tile(base, count).view(INPUT)
    for (field, index), values in columns.items():
        many = values.ndim > INPUT[field].ndim - len(index)
        part = values[first : first + count] if many else values
        records[field][(slice(None), *index)] = part
    return records


def solve_with_fields(
    contact: Any,
    records: NDArray[Any],
    results: NDArray[Any],
    sequence: int,
    found: Collected,
) -> None:
    """One by one, and their fields. Raises CaseError."""
    for i in range(len(records)):
        if i % sequence == 0:
            contact.reset()
        try:
            one = slice(i, i + 1)
            contact.step_record(records[one].view(np.uint8), results[one].view(np.uint8))
        except CaseError as error:
            raise StateError(i, str(error)) from None
        found.take_fields(contact, results[i])


class Collected:
    """Arrays of results, block by block."""

    def __init__(self, case: Case, outputs: Sequence[str] | None, fields: bool) -> None:
        self.case, self.wanted, self.fields = case, outputs, fields
        self.parts: dict[str, list[NDArray[Any]]] = {}
        self.reason: dict[int, str] = {}
        self.warnings: dict[int, list[str]] = {}
        self.field_rows: list[list[dict[str, Any]]] = []

    def take(self, first: int, results: NDArray[Any]) -> None:
        """The numbers of a block of rp_result; first: its first state. Raises CaseError."""
        whole = self._part(results)
        for i in np.flatnonzero(whole["reason"]):
            self.reason[first + int(i)] = _core.reason_text(
                int(whole["reason"][i]), float(whole["reason_value"][i])
            )
        marked = results["warnings"]
        for i in np.flatnonzero(marked):
            self.warnings[first + int(i)] = _core.warning_texts(int(marked[i]))
        arrays = self._arrays(results)
        if self.wanted is not None:
            unknown = [name for name in self.wanted if name not in arrays]
            if unknown:
                raise CaseError(f"outputs: value is {unknown[0]!r}, allowed {', '.join(arrays)}")
            arrays = {name: arrays[name] for name in ("status", *self.wanted)}
        for name, values in arrays.items():
            self.parts.setdefault(name, []).append(np.array(values))

    def take_fields(self, contact: Any, result: Any) -> None:
        """The fields of the last step's patches."""
        rows = []
        for side in ("right",) if isinstance(self.case, PatchCase) else self.case.sides:
            record = result["side"][SIDES.index(side)]
            patches = 1 if isinstance(self.case, PatchCase) else int(record["patch_count"])
            for k in range(patches):
                grid = [int(v) for v in record["patch"][k]["grid"]]
                row = {
                    name: shaped_field(name, contact.field(SIDES.index(side), k, name), grid)
                    for name in FIELDS
                }
                rows.append({name: value for name, value in row.items() if value is not None})
        self.field_rows.append(rows)

    def states(self, doubts: list[str]) -> States:
        """All that was taken. doubts: of the profiles."""
        arrays = {name: joined(parts) for name, parts in self.parts.items()}
        if self.fields:
            column = np.empty(len(self.field_rows), dtype=object)
            column[:] = self.field_rows
            arrays["fields"] = column
        return States(arrays, self.reason, self.warnings, doubts)

    def _part(self, results: NDArray[Any]) -> NDArray[Any]:
        """What status and reason are those of."""
        if results.dtype == ONE_PATCH:
            return results["patch"]
        if isinstance(self.case, PatchCase):
            return results["side"][:, RIGHT]["patch"][:, 0]
        return results

    def _arrays(self, results: NDArray[Any]) -> dict[str, NDArray[Any]]:
        status = {"status": STATUSES[self._part(results)["status"]]}
        if isinstance(self.case, PatchCase):
            names = [*PATCH_UNITS, *(["creepage"] if any(self.case.motion.prescribed) else [])]
            return status | patch_arrays(self._part(results), names)
        sides = {side: results["side"][:, SIDES.index(side)] for side in self.case.sides}
        if self.case.kind == "wheel_rail":
            turning = TURNING if self.case.wheelset.found else ()
            of_wheel = wheel_arrays(results, sides[self.case.wheel.side])
            return status | of_wheel | {name: results[name] for name in turning}
        total = {
            name: results[name] for name in (*TOTAL_UNITS, *WHEELSET_UNITS) if name not in APART
        }
        for side, record in sides.items():
            of_side = {"status": STATUSES[record["status"]], **wheel_arrays(results, record)}
            total |= {f"{side}.{name}": values for name, values in of_side.items()}
        return status | total


def wheel_arrays(results: NDArray[Any], side: NDArray[Any]) -> dict[str, NDArray[Any]]:
    """Of one wheel and its patches."""
    arrays = {
        name: results["z"] if name == "z" else side[name]
        for name in WHEEL_UNITS
        if name not in APART
    }
    most = int(side["patch_count"].max(initial=0))
    names = [*PATCH_UNITS, *PLACE_UNITS]
    there = np.arange(most) < side["patch_count"][:, None]
    patches = side["patch"][:, :most]
    arrays["patches.count"] = side["patch_count"]
    arrays["patches.status"] = np.where(there, STATUSES[patches["status"]], "")
    for name, values in patch_arrays(patches, names).items():
        gone = ~there.reshape(there.shape + (1,) * (values.ndim - 2))
        arrays[f"patches.{name}"] = np.where(gone, np.nan, values)
    return arrays


def patch_arrays(patch: NDArray[Any], names: Sequence[str]) -> dict[str, NDArray[Any]]:
    """Of records of rp_patch_result of any shape."""
    arrays: dict[str, NDArray[Any]] = {}
    rolls = np.isfinite(patch["creep_force"][..., 0])
    for name in names:
        if name in APART:
            continue
        if name == "elements":
            for k, division in enumerate(DIVISION):
                values = patch["elements"][..., k].astype(float)
                # without a tangential problem nothing is known of stick and slip
                known = values if k == 0 else np.where(rolls, values, np.nan)
                arrays[f"elements.{division}"] = known
        elif name == "error_estimate":
            for k, estimate in enumerate(ESTIMATES):
                arrays[f"error_estimate.{estimate}"] = patch["error_estimate"][..., k]
        elif name == "iterations":
            arrays[name] = patch["normal_iterations"] + patch["newton_iterations"]
        else:
            arrays[name] = patch[name]
    return arrays


def joined(parts: list[NDArray[Any]]) -> NDArray[Any]:
    """Blocks after each other; those with fewer patches have NaN, or no text, in the others."""
    most = max(part.shape[1] if part.ndim > 1 else 0 for part in parts)
    wide = []
    for part in parts:
        if part.ndim > 1 and part.shape[1] < most:
            shape = (part.shape[0], most - part.shape[1], *part.shape[2:])
            fill = np.full(shape, "" if part.dtype.kind == "U" else np.nan)
            part = np.concatenate([part, fill], axis=1)
        wide.append(part)
    return wide[0] if len(wide) == 1 else np.concatenate(wide)
