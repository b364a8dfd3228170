"""What a scene gives for each row of a record: a contact's states, or the positions of a run."""

from __future__ import annotations

from importlib.util import find_spec
from pathlib import Path
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from railpatch.case.kinds import kind_of
from railpatch.case.load import Scene, load_scene
from railpatch.case.moving import moving_keys
from railpatch.errors import CaseError
from railpatch.many import States, solve_many
from railpatch.match.exact import ExactRates, direction_of
from railpatch.match.plan import Explanation, ObservedColumn, Plan, values_of
from railpatch.sweep.plan import steps_of

Array = NDArray[np.float64]

# of a range, of derivatives by differences; of what is uneven on its grid
DIFFERENCE, COARSE = 1e-3, 5e-3


class Model(Protocol):
    """An explanation's predictions.

    keys: [p], of what is sought. rows: [m], of the record. inputs: name -> [m], what points are
    told apart by. measured: [observed, m], SI units, NaN where there is nothing. evaluations: of
    all rows, so far. free: numbers that rows find for themselves.
    """

    plan: Plan
    explanation: Explanation
    keys: tuple[str, ...]
    rows: NDArray[np.intp]
    inputs: dict[str, Array]
    measured: Array
    evaluations: int

    free: int

    def at(self, shares: Array) -> Array:
        """[observed, m], SI units, NaN where a state has no good result. Raises CaseError."""
        ...

    def slopes(self, shares: Array) -> Array | None:
        """[observed, m, p], of the same by the shares; None: differences of it. Raises
        CaseError."""
        return None

    def weigh(self, error: Array) -> None:
        """Errors of what is measured, [observed], by which rows find what is their own."""

    def forget(self) -> None:
        """What rows found for themselves is sought anew, over its whole range."""


class Followed(Protocol):
    """A run that is replayed for one content of its scene after another (SceneKind.follow).

    yaw: rad, progress: -, [m]. measured: [names, m], SI units. place: [p], shares of the content,
    by which balances start closer. exact: whether its derivatives are exact for most numbers.
    row_values: of what is unknown in each row, [m], with ends of 95 % and whether other values
    would do, [m]; None without rows.
    """

    yaw: Array
    progress: Array
    measured: Array
    exact: bool

    def computed(self, content: dict[str, Any], place: Array) -> Array: ...

    def slopes(
        self,
        content: dict[str, Any],
        changed: list[dict[str, Any]],
        steps: list[float],
        place: Array,
    ) -> Array: ...

    def weigh(self, error: Array) -> None: ...

    def forget(self) -> None: ...

    def row_values(self, covariance: Array) -> tuple[Array, Array, Array, Array]: ...


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
        self.evaluations, self.free = 0, 0
        self._exact = True

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

    def slopes(self, shares: Array) -> Array | None:
        """[observed, m, p]: exact where the contact has them; None where it has none at all."""
        if not self._exact:
            return None
        sought = self.explanation.seek
        values = values_of(sought, shares)
        scene = load_scene(self.explanation.case(values), self.plan.folder)
        ways = [direction_of(scene.case, key, tuple(self.inputs)) for key in self.keys]
        exact = [k for k, way in enumerate(ways) if way is not None]
        rates = self._rates(scene, [ways[k] for k in exact]) if exact else None
        if rates is None:
            self._exact = False
            return None
        found = np.empty((*self.measured.shape, len(shares)))
        here = self.at(shares) if len(exact) < len(ways) else None
        for k, (key, one) in enumerate(sought.items()):
            if k in exact:
                found[..., k] = rates[..., exact.index(k)] * one.rate(values[key])
                continue
            assert here is not None
            step = -DIFFERENCE if shares[k] > 0.5 else DIFFERENCE
            moved = shares.copy()
            moved[k] += step
            found[..., k] = (self.at(moved) - here) / step
        return np.nan_to_num(found)

    def _rates(self, scene: Scene, ways: list[dict[str, Any] | None]) -> Array | None:
        """[observed, m, ways], by the keys; None where the contact has no exact ones."""
        columns = self._columns(scene)
        observed = [(key, column.over) for key, column in self.plan.table.observed.items()]
        contact, rows = ExactRates(scene), []
        for row in range(self.measured.shape[1]):
            changes = {key: values[row].tolist() for key, values in columns.items()}
            rates = contact.at(changes, [way for way in ways if way is not None], observed)
            if rates is None:
                return None
            rows.append(rates)
        return np.stack(rows, axis=1)

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
    """The positions of a run whose scene names its record."""

    def __init__(self, plan: Plan, explanation: Explanation) -> None:
        """Raises CaseError, ProfileError."""
        self.plan, self.explanation = plan, explanation
        self.keys = tuple(explanation.seek)
        self.evaluations = 0
        start = [0.5 if s.start is None else s.share(s.start) for s in explanation.seek.values()]
        follow = kind_of(plan.kind).follow
        assert follow is not None
        content = self._content(np.array(start))
        self.followed: Followed = follow(
            content, plan.folder, tuple(plan.table.observed), plan.table.rows
        )
        self.measured = self.followed.measured
        self.rows = np.arange(self.measured.shape[1])
        self.free = len(self.rows) if plan.table.rows else 0
        check_count(int(np.isfinite(self.measured).sum()) - self.free, self.keys)
        # the yaw angle first: what the figures of a rig are over
        self.inputs = {"yaw": self.followed.yaw, "progress": self.followed.progress}

    def at(self, shares: Array) -> Array:
        """[observed, m]: as in Model."""
        self.evaluations += 1
        return self.followed.computed(self._content(shares), shares)

    def slopes(self, shares: Array) -> Array:
        """[observed, m, p]: as in Model."""
        width = DIFFERENCE if self.followed.exact else COARSE
        steps = [-width if share > 0.5 else width for share in shares]
        changed = []
        for k, step in enumerate(steps):
            moved = shares.copy()
            moved[k] += step
            changed.append(self._content(moved))
        # by the share: a step of what enters linearly is taken over the numbers themselves
        found = self.followed.slopes(self._content(shares), changed, steps, shares)
        return np.nan_to_num(found)

    def weigh(self, error: Array) -> None:
        """As in Model."""
        self.followed.weigh(error)

    def forget(self) -> None:
        """As in Model."""
        self.followed.forget()

    def _content(self, shares: Array) -> dict[str, Any]:
        values = values_of(self.explanation.seek, np.clip(shares, 0.0, 1.0))
        content = self.explanation.case(values)
        for name, table in self.plan.table.rows.items():
            # each row has its own; what a run needs is there
            middle = 0.5 * (table.low + table.high)
            content["rig"][name] = [[0.0, middle], [1.0, middle]]
        return content


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
