"""Measured errors of methods and grids, which ``accuracy`` in [method] is chosen by: the 95th
percentile of the force error over friction coefficient times normal force.

``python -m railpatch.evidence.bench.reach`` measures the errors below again.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import exp, inf, log
from typing import Any

import scipy

from railpatch.case.theories import FAST, has_tractions

# error of the full theory on fitted rows by their scale: with Hertz's pressure, a/b = 1/10 ... 10,
# any Poisson's ratio; and on as many nodes as rows, with the pressure of the half-space on a grid
# of NORMAL times as many elements, on random ellipses, other shapes and wheels
ROWS_ON_ELLIPSE = {
    6: 0.026, 7: 0.0173, 9: 0.0111, 10: 0.0091, 11: 0.008, 12: 0.0063, 14: 0.0058, 16: 0.0043,
    18: 0.0039, 20: 0.0032, 28: 0.0018,
}  # fmt: skip
# grids beyond the chosen one that a step may go on to; each errs some 0.55 times as much as the one
# before, the last one as a sixth of the chosen one
FINER = 3
ROWS_ON_PRESSURE = {6: 0.0292, 7: 0.0255, 8: 0.0169, 9: 0.0161, 10: 0.0128, 11: 0.01}
NORMAL = 2
# the least accuracy that the finest grids reach with Hertz's pressure, and with that of a grid
LEAST_ON_ELLIPSE, LEAST_ON_PRESSURE = 0.001, 0.003
# error of what no finer grid makes better, FAST_ELEMENTS across, on the same cases (FASTSIM, Polach
# and ANALYN: the greater one on the benchmark's); of the table on other shapes and of the corrected
# Kik-Piotrowski it is not known
REACHED = {
    **dict.fromkeys(FAST, inf),
    "polach": 0.42,
    "fastsim": 0.09,
    "fastrip": 0.06,
    "kik_piotrowski": 0.045,
    "kik_piotrowski_corrected": inf,
    "analyn": 0.04,
}
FAST_ELEMENTS = 20
# rows on the pressure of Kik-Piotrowski and ANALYN, and elements of that, as those were measured
ROWS_ON_APPROXIMATE = 16
# of the table of creep forces on a Hertzian patch
TABLE_ON_ELLIPSE = 0.0039
# a/b of the ellipses that all were measured on
RATIOS = (0.1, 10.0)
QUADRATIC = ("semi_axes", "curvatures")


@dataclass(frozen=True)
class Choice:
    """A method and the grid that a step begins on. error: -, as measured.

    fitted: with a table the rows that follow it. finer: grids that a step may go on to.
    """

    normal: str
    tangential: str
    elements: int
    fitted: tuple[int, int] | None
    error: float
    finer: int = 0

    def spell(self, accuracy: float) -> str:
        """One line on what was chosen and why."""
        closed = self.normal == "hertz" and not has_tractions(self.tangential)
        grid = "no grid" if closed else f"{self.elements} elements across"
        if self.fitted is not None and self.tangential == "full":
            rows = f"{self.fitted[0]} nodes on {self.fitted[1]} fitted rows"
            grid = rows if self.normal == "hertz" else f"{rows}, pressure on {grid}"
        theories = f"normal = {self.normal}, tangential = {self.tangential}"
        others = f", then up to {self.finer} finer grids where need be" if self.finer else ""
        return (
            f"accuracy = {accuracy:g}: {theories}, {grid}{others}; "
            f"95 % of measured force errors are below {100 * self.error:.2g} % on the first"
        )


def least_error(method: Any, *, ellipse: bool) -> float:
    """-, what the theories of a table [method] reach at best. ellipse: the contact area is one."""
    normal = method.normal if "normal" in method.model_fields_set or not ellipse else "hertz"
    if normal == "hertz" and method.tangential == "table":
        return TABLE_ON_ELLIPSE
    least = LEAST_ON_ELLIPSE if normal == "hertz" else LEAST_ON_PRESSURE
    return max(REACHED.get(normal, 0.0), REACHED.get(method.tangential, least))


def smallest(table: dict[int, float], accuracy: float) -> int:
    """The smallest scale that reaches it; the finest one where none does."""
    return min((scale for scale, e in table.items() if e <= accuracy), default=max(table))


def axis_ratio(case: Any) -> float | None:
    """-, a/b of a patch of quadratic surfaces; None where the contact is no known ellipse."""
    geometry: Any = getattr(case, "geometry", None)
    if geometry is None or all(getattr(geometry, name) is None for name in QUADRATIC):
        return None
    if geometry.semi_axes is not None:
        a, b = geometry.semi_axes
        return a / b
    return ratio_of_curvatures(*geometry.curvatures)


def ratio_of_curvatures(along: float, across: float) -> float:
    """-, a/b of the contact of the undeformed distance along x^2 + across y^2.

    along/across = R_D(0, b^2, a^2)/R_D(0, a^2, b^2), Johnson, *Contact Mechanics*, 1985, section
    4.2, with Carlson's R_D; 1e-6 ... 1e6.
    """

    def excess(logarithm: float) -> float:
        square = exp(2 * logarithm)
        return float(
            log(scipy.special.elliprd(0, 1, square) / scipy.special.elliprd(0, square, 1))
            - log(along / across)
        )

    limit = log(1e6)
    # a long contact has the smaller curvature along its length
    if excess(-limit) * excess(limit) > 0:
        return exp(limit if along < across else -limit)
    return exp(scipy.optimize.brentq(excess, -limit, limit, xtol=1e-9))
