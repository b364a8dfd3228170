"""Derivatives of a contact's numbers by what is sought, exact where the core has them.

Those by moving inputs of the case (load.normal_force, wheelset.y, motion.spin_creepage) and by
Coulomb's friction coefficient are the core's own, of the state that is solved for each row; the
quotient rule gives those of numbers over others.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from railpatch.case.load import Scene, check_case
from railpatch.case.moving import BY_TABLE, FIXED, moving_keys
from railpatch.contact import Contact
from railpatch.result import GOOD
from railpatch.sweep.plan import steps_of

Array = NDArray[np.float64]


def direction_of(case: Any, key: str, driven: Sequence[str]) -> dict[str, Any] | None:
    """Rates of moving inputs for a rate of 1 of a key of the scene; None where it is none of them.

    driven: moving keys that the rows have themselves, [0] of lists too."""
    if key == "friction.coefficient":
        return {"friction_coefficient": 1.0} if case.friction.law == "coulomb" else None
    table, *steps = steps_of(key)
    keys = moving_keys(case)
    if not steps or table in BY_TABLE or keys.get(str(steps[0])) != table or steps[0] in FIXED:
        return None
    name, *index = steps
    if len(index) > 1 or any(steps_of(own)[0] == name for own in driven):
        return None
    value = getattr(getattr(case, str(table)), str(name))
    if not index:
        return {str(name): 1.0} if isinstance(value, float) else None
    if not isinstance(value, list | tuple) or not all(isinstance(v, float) for v in value):
        return None
    return {str(name): [float(place == index[0]) for place in range(len(value))]}


class ExactRates:
    """Of the states of one scene, one after the other."""

    def __init__(self, scene: Scene) -> None:
        """Raises CaseError, ProfileError."""
        content = scene.case.model_dump()
        content["method"]["derivatives"] = True
        self._contact = Contact(Scene(check_case(content), scene.folder))

    def at(
        self,
        changes: Mapping[str, Any],
        directions: Sequence[Mapping[str, Any]],
        observed: Sequence[tuple[str, str | None]],
    ) -> Array | None:
        """[observed, directions], NaN of a state without a good result; None where the core has no
        exact ones. observed: number of the result, and the one that it is divided by."""
        result = self._contact.step(**changes)
        found = np.full((len(observed), len(directions)), np.nan)
        if result.status not in GOOD:
            return found
        for k, direction in enumerate(directions):
            rates = self._contact.differentiate(**direction)
            if rates["kind"] != "exact":
                return None
            for o, (name, over) in enumerate(observed):
                value, rate = number_of(result, name), number_of(rates, name)
                if over is not None:
                    below, below_rate = number_of(result, over), number_of(rates, over)
                    rate = (rate - value / below * below_rate) / below
                found[o, k] = rate
        return found


def number_of(result: Any, key: str) -> float:
    """A number of a result, 'creep_force[0]' or 'left.force[1]'."""
    place = result
    for step in steps_of(key, "match.observed"):
        place = place[step]
    return np.nan if place is None else float(place)
