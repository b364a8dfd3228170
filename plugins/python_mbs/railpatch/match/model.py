"""What a scene gives for each row of a record."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from railpatch.case.load import Scene, load_scene
from railpatch.case.moving import moving_keys
from railpatch.errors import CaseError
from railpatch.many import States, solve_many
from railpatch.match.plan import Explanation, ObservedColumn, Plan, values_of
from railpatch.sweep.plan import steps_of

Array = NDArray[np.float64]


class Model:
    """An explanation's predictions: one state of the contact for each row with all inputs.

    rows: [m], of the record, which have all inputs and something measured. evaluations: of all rows,
    so far.
    """

    def __init__(self, plan: Plan, explanation: Explanation, threads: int = 1) -> None:
        self.plan, self.explanation = plan, explanation
        self.keys = tuple(explanation.seek)
        self._threads = threads
        inputs, measured = plan.inputs(), plan.measured()
        known = np.all([np.isfinite(values) for values in inputs.values()], axis=0)
        self.rows = np.flatnonzero(known & np.isfinite(measured).any(axis=0))
        if len(self.rows) <= len(self.keys):
            raise CaseError(
                f"match.record: value is {len(self.rows)} rows with all inputs, allowed more than "
                f"the {len(self.keys)} parameters that are sought"
            )
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
            [self._observed(key, column, states) for key, column in self.plan.table.observed.items()]
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
