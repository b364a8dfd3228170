"""What a scene gives for each row of a record: a contact's states, or the positions of a run."""

from __future__ import annotations

import tempfile
from importlib.util import find_spec
from pathlib import Path
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from railpatch.case.kinds import kind_of
from railpatch.case.load import Scene, load_scene
from railpatch.case.moving import moving_keys
from railpatch.errors import CaseError
from railpatch.log.reader import read_run
from railpatch.log.table import LogTable
from railpatch.many import States, solve_many
from railpatch.match.plan import Explanation, ObservedColumn, Plan, values_of
from railpatch.record.quantities import BY_NAME
from railpatch.report.beside import MEASURED, Computed
from railpatch.sweep.plan import steps_of

Array = NDArray[np.float64]


class Model(Protocol):
    """An explanation's predictions.

    keys: [p], of what is sought. rows: [m], of the record. inputs: name -> [m], what points are
    told apart by. measured: [observed, m], SI units, NaN where there is nothing. evaluations: of
    all rows, so far.
    """

    plan: Plan
    explanation: Explanation
    keys: tuple[str, ...]
    rows: NDArray[np.intp]
    inputs: dict[str, Array]
    measured: Array
    evaluations: int

    def at(self, shares: Array) -> Array:
        """[observed, m], SI units, NaN where a state has no good result. Raises CaseError."""
        ...


class ContactModel(Model):
    """One state of the contact for each row with all inputs and something measured."""

    def __init__(self, plan: Plan, explanation: Explanation, threads: int = 1) -> None:
        self.plan, self.explanation = plan, explanation
        self.keys = tuple(explanation.seek)
        self._threads = threads
        inputs, measured = plan.inputs(), plan.measured()
        known = np.all([np.isfinite(values) for values in inputs.values()], axis=0)
        self.rows = np.flatnonzero(known & np.isfinite(measured).any(axis=0))
        check_count(int(np.isfinite(measured[:, self.rows]).sum()), self.keys)
        self.inputs = {key: values[self.rows] for key, values in inputs.items()}
        self.measured = measured[:, self.rows]
        self.evaluations = 0

    def at(self, shares: Array) -> Array:
        """[observed, m], SI units, NaN where a state has no good result. Raises CaseError."""
        values = values_of(self.explanation.seek, shares)
        scene = load_scene(self.explanation.case(values), self.plan.folder)
        outputs = sorted({result_name(name) for name in self._outputs()})
        columns = self._columns(scene)
        states = solve_many(scene, columns, threads=self._threads, outputs=outputs)
        self.evaluations += 1
        found = np.array(
            [
                self._observed(key, column, states)
                for key, column in self.plan.table.observed.items()
            ]
        )
        found[:, ~states.good] = np.nan
        return found

    def _outputs(self) -> list[str]:
        named = [*self.plan.table.observed]
        return named + [c.over for c in self.plan.table.observed.values() if c.over]

    def _columns(self, scene: Scene) -> dict[str, Array]:
        """Moving key -> [m], or [m, size] of which inputs may drive one component each."""
        known = moving_keys(scene.case)
        made: dict[str, Array] = {}
        for key, values in self.inputs.items():
            name, *index = steps_of(key)
            if name not in known or len(index) > 1 or not all(isinstance(i, int) for i in index):
                raise CaseError(
                    f"match.inputs: value is {key!r}, allowed {', '.join(sorted(known))}, of lists "
                    "with the number of a component, as creepage[0]"
                )
            if not index:
                made[str(name)] = values
                continue
            if str(name) not in made:
                made[str(name)] = np.tile(own_list(scene, str(name), key), (len(values), 1))
            column, place = made[str(name)], int(index[0])
            if not 0 <= place < column.shape[1]:
                raise CaseError(
                    f"match.inputs: value is {key!r}, allowed [0] to [{column.shape[1] - 1}]"
                )
            column[:, place] = values
        return made

    def _observed(self, key: str, column: ObservedColumn, states: States) -> Array:
        found = component_of(states, key)
        return found / component_of(states, column.over) if column.over else found


class RunModel(Model):
    """The positions of a run whose scene names its record: what the log has of both."""

    def __init__(self, plan: Plan, explanation: Explanation) -> None:
        """Runs the scene once. Raises CaseError."""
        self.plan, self.explanation = plan, explanation
        self.keys = tuple(explanation.seek)
        self.evaluations = 0
        self._kind = kind_of(plan.kind)
        start = [0.5 if s.start is None else s.share(s.start) for s in explanation.seek.values()]
        self.inputs, self.measured = {}, np.zeros((len(plan.table.observed), 0))
        table, _ = self._run(np.array(start))
        self.measured = np.array([self._column(table, name) for name in plan.table.observed])
        self.rows = np.arange(self.measured.shape[1])
        check_count(int(np.isfinite(self.measured).sum()), self.keys)
        # the yaw angle first: what the figures of a rig are over
        named = {"yaw": "/wheelset/state.yaw", "progress": "/wheelset/state.progress"}
        self.inputs = {name: np.asarray(table[column].values) for name, column in named.items()}

    def at(self, shares: Array) -> Array:
        """[observed, m]: as in Model."""
        return self._run(shares)[1]

    def _column(self, table: LogTable, name: str) -> Array:
        try:
            return np.asarray(table[f"{MEASURED}.{name}"].values, dtype=float)
        except KeyError:
            raise CaseError(
                f"match.observed: value is {name!r}, allowed what the record has by [rig.columns]"
            ) from None

    def _run(self, shares: Array) -> tuple[LogTable, Array]:
        """The log's table, and what was computed of what is observed."""
        values = values_of(self.explanation.seek, np.clip(shares, 0.0, 1.0))
        content = placed(self.explanation.case(values), self.plan.folder)
        with tempfile.TemporaryDirectory() as folder:
            scene, log = Path(folder) / "scene.toml", Path(folder) / "run.mcap"
            scene.write_text(toml_of(content), encoding="utf-8")
            assert self._kind.run is not None
            self._kind.run(scene, log)
            computed = Computed(read_run(log))
        self.evaluations += 1
        balanced = np.asarray(computed.table["/rig/balance.status"].values) == "converged"
        found = [computed.values(BY_NAME[name]) for name in self.plan.table.observed]
        return computed.table, np.array([np.where(balanced, v, np.nan) for v in found])


def model_of(plan: Plan, explanation: Explanation, threads: int) -> Model:
    """Of a contact or a run. Raises CaseError."""
    if plan.record is None:
        return RunModel(plan, explanation)
    return ContactModel(plan, explanation, threads)


def check_count(count: int, keys: tuple[str, ...]) -> None:
    """Raises CaseError where parameters are more than points."""
    if count <= len(keys):
        raise CaseError(
            f"match.record: value is {count} measured numbers with all inputs, allowed more than "
            f"the {len(keys)} parameters that are sought"
        )


def placed(content: dict[str, Any], folder: Path) -> dict[str, Any]:
    """With the files that it names by their whole paths, so that it may lie elsewhere."""
    for table, keys in (("profiles", None), ("rig", ("record",))):
        own = content.get(table, {})
        for key in keys or tuple(own):
            name = own.get(key)
            if isinstance(name, str) and (folder / name).is_file():
                own[key] = str((folder / name).resolve())
    return content


def toml_of(content: dict[str, Any]) -> str:
    """Raises CaseError where the writer is not installed."""
    need_writer()
    import tomli_w

    return tomli_w.dumps(content)


def need_writer() -> None:
    """Raises CaseError where the writer is not installed."""
    if find_spec("tomli_w") is None:
        raise CaseError("tomli-w is not installed: pip install 'railpatch[match]'")


def own_list(scene: Scene, name: str, key: str) -> Array:
    """[size], what the case has for a moving list. Raises CaseError."""
    value = np.array(getattr(getattr(scene.case, moving_keys(scene.case)[name]), name), dtype=float)
    if value.ndim != 1:
        raise CaseError(f"match.inputs: value is {key!r}, but {name} is no list of numbers")
    return value


def result_name(key: str) -> str:
    """Of a number of a result without its component."""
    return key.split("[")[0]


def component_of(states: States, key: str) -> Array:
    """[m], a number of the results. Raises CaseError."""
    name, *index = key.replace("]", "").split("[")
    if name not in states or not all(i.isdecimal() for i in index):
        raise CaseError(
            f"match.observed: value is {key!r}, allowed numbers of the result, as creep_force[0]"
        )
    values = np.asarray(states[name], dtype=float)
    if values.ndim != 1 + len(index) or any(
        int(i) >= size for i, size in zip(index, values.shape[1:], strict=True)
    ):
        shape = "".join(f"[0 to {size - 1}]" for size in values.shape[1:])
        raise CaseError(f"match.observed: value is {key!r}, allowed {name}{shape}")
    return values[(slice(None), *map(int, index))]
