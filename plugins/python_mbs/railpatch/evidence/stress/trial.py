"""A trial: a case, the steps that one contact takes, and what is expected of each."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from railpatch.case.theories import FAST, has_tractions
from railpatch.evidence.bench.problems import merged

Changes = Mapping[str, Any]
SOLVED = ("converged",)
# where theory or numbers end within the range tried: solved, or the result says that it is not
SAYS_SO = ("converged", "out_of_range", "not_converged")
IN_THEORY = ("converged", "out_of_range")
NO_CONTACT = ("no_contact",)
REFUSED = ("refused",)


@dataclass(frozen=True)
class Move:
    """Moving inputs (fields of rp_input) that a step changes, and the statuses expected of it."""

    changes: Changes = field(default_factory=dict)
    expects: tuple[str, ...] = SOLVED


@dataclass(frozen=True)
class Trial:
    """One line of the table. note: what is expected, and why, where that is not plain."""

    family: str
    name: str
    case: dict[str, Any]
    moves: tuple[Move, ...] = (Move(),)
    note: str = ""

    @property
    def method(self) -> str:
        """The tangential theory and its discretisation."""
        method = self.case.get("method", {})
        theory = method.get("tangential", "full")
        if theory != "full":
            return str(theory)
        return "fitted rows" if "fitted" in self.case.get("grid", {}) else "full"


def moves(*changes: Changes, expects: tuple[str, ...] = SOLVED) -> tuple[Move, ...]:
    """Steps with the same expectation."""
    return tuple(Move(change, expects) for change in changes)


# the case against which times are measured: steel, a = b = 6 mm, 0.3, half of saturation
MODULUS, POISSON = 82e9, 0.28
SEMI_AXIS, FORCE, FRICTION = 0.006, 1e5, 0.3
PRESSURE = 1.5 * FORCE / (3.141592653589793 * SEMI_AXIS**2)  # Pa, greatest
# creepage near which the linear theory saturates: mu Fn/(4 G a b); and the spin
CREEPAGE = FRICTION * FORCE / (4 * MODULUS * SEMI_AXIS**2)
SPIN = CREEPAGE / SEMI_AXIS
NOMINAL: dict[str, Any] = {
    "kind": "patch",
    "material": {"shear_modulus": MODULUS, "poisson_ratio": POISSON},
    "geometry": {"semi_axes": [SEMI_AXIS, SEMI_AXIS]},
    "load": {"normal_force": FORCE},
    "grid": {"elements": [24, 24]},
    "motion": {"creepage": [0.5 * CREEPAGE, 0.0], "spin_creepage": 0.0, "rolling_speed": 10.0},
    "friction": {"coefficient": FRICTION},
}
METHODS: dict[str, dict[str, Any]] = {
    "full": {},
    "fitted rows": {"grid": {"elements": None, "fitted": [12, 12]}, "method": {"normal": "hertz"}},
    **{
        name: {
            "method": {"tangential": name, **({} if has_tractions(name) else {"normal": "hertz"})}
        }
        for name in FAST
    },
}


def nominal(*changes: Changes) -> dict[str, Any]:
    """The nominal case with tables or keys replaced; None takes one away."""
    case: dict[str, Any] = NOMINAL
    for change in changes:
        case = merged(case, change)
    return case


def expected(method: str) -> tuple[str, ...]:
    """What a theory may answer: the fast ones have a range of their own."""
    return SOLVED if METHODS[method].get("method", {}).get("tangential") is None else IN_THEORY
