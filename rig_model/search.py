"""What the searches for a balance have in common: functions, settings and roots."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Vector = NDArray[np.float64]


@dataclass(frozen=True)
class Evaluation:
    """f at one point.

    residual: [n], or None where f has no value there. solved: whether the value may be relied on;
    a point that is not solved guides the search, but is no root. payload: what the caller wants
    back with the root. slope: gives the Jacobian of f there, [n, n], as long as no other point was
    evaluated since; asked for by Newton's method only.
    """

    residual: Vector | None
    solved: bool = True
    payload: Any = None
    slope: Callable[[], Vector] | None = None


Function = Callable[[Vector], Evaluation]


@dataclass(frozen=True)
class Settings:
    """How f is searched; all arrays have shape [n].

    residual_scale: f / residual_scale is compared with tolerance, its largest component counts.
    difference: steps of x for the Jacobian by differences. step_limit: largest change of x in one
    step. max_evaluations: of f in one solve. max_restarts: Jacobians by differences in one solve,
    beyond the first one.
    """

    residual_scale: Vector
    difference: Vector
    step_limit: Vector
    tolerance: float = 1e-5
    max_evaluations: int = 40
    max_restarts: int = 2


@dataclass(frozen=True)
class Root:
    """How a solve ended: the best point found, converged or not.

    x, residual: [n], not scaled; residual is None where f had no value at the start. iterations:
    steps taken. restarts: Jacobians by differences beyond the first one.
    """

    converged: bool
    x: Vector
    residual: Vector | None
    evaluations: int
    iterations: int
    restarts: int
    payload: Any = None
