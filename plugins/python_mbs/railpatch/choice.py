"""What ``accuracy`` in [method] chooses: the cheapest method and grid whose force error, measured
as the 95th percentile over friction coefficient times normal force, is no greater.

``python -m railpatch.bench.reach`` measures the errors below again.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import exp, log
from typing import TYPE_CHECKING, Any

from scipy.optimize import brentq
from scipy.special import elliprd

from railpatch.accuracy import fitted_size

if TYPE_CHECKING:
    from railpatch.case.common import Method
    from railpatch.case.load import Case

# error of the full theory on fitted rows by their scale: with Hertz's pressure, and with that of
# the half-space on a grid of NORMAL times as many elements across
ROWS_ON_ELLIPSE = {
    6: 0.026, 7: 0.014, 9: 0.011, 10: 0.0075, 11: 0.006, 12: 0.0055, 14: 0.0042, 16: 0.0036,
    18: 0.0029, 20: 0.0024, 24: 0.002,
}  # fmt: skip
ROWS_ON_PRESSURE = {6: 0.024, 7: 0.021, 8: 0.017, 9: 0.013, 10: 0.0115, 12: 0.009, 16: 0.006}
NORMAL = 2
# error of what no finer grid makes better, FAST_ELEMENTS across
REACHED = {
    "linear": 0.1,
    "polach": 0.1,
    "fastsim": 0.1,
    "fastrip": 0.1,
    "kik_piotrowski": 0.1,
    "analyn": 0.1,
}
FAST_ELEMENTS = 20
# of the table of creep forces on a Hertzian patch, and the a/b that it holds
ON_TABLE, TABLE_RATIOS = 0.0027, (0.1, 10.0)
QUADRATIC = ("semi_axes", "curvatures")


@dataclass(frozen=True)
class Choice:
    """A method and its grid. error: -, as measured."""

    normal: str
    tangential: str
    elements: int
    fitted: tuple[int, int] | None
    error: float

    def spell(self, accuracy: float) -> str:
        """One line on what was chosen and why."""
        grid = f"{self.elements} elements across"
        if self.tangential == "table":
            grid = "no grid"
        if self.fitted is not None:
            rows = f"{self.fitted[0]} nodes on {self.fitted[1]} fitted rows"
            grid = rows if self.normal == "hertz" else f"{rows}, pressure on {grid}"
        theories = f"normal = {self.normal}, tangential = {self.tangential}"
        return (
            f"accuracy = {accuracy:g}: {theories}, {grid}; "
            f"95 % of measured force errors are below {100 * self.error:.2g} %"
        )


def least_error(method: Method) -> float:
    """-, what the given theories reach at best."""
    table = ROWS_ON_PRESSURE if "normal" in method.model_fields_set else ROWS_ON_ELLIPSE
    theories = (
        REACHED.get(method.normal, 0.0),
        REACHED.get(method.tangential, min(table.values())),
    )
    return max(theories)


def smallest(table: dict[int, float], accuracy: float) -> int:
    """The smallest scale that reaches it; the finest one where none does."""
    return min((scale for scale, e in table.items() if e <= accuracy), default=max(table))


def choose(case: Case) -> Choice | None:
    """What the case's accuracy asks for; None without one."""
    method = case.method
    if method.accuracy is None:
        return None
    ratio = axis_ratio(case)
    given = "normal" in method.model_fields_set or ratio is None
    normal = method.normal if given else "hertz"
    tangential = method.tangential
    if "tangential" not in method.model_fields_set and table_serves(case, normal, ratio):
        return Choice("hertz", "table", FAST_ELEMENTS, None, ON_TABLE)
    table = ROWS_ON_ELLIPSE if normal == "hertz" else ROWS_ON_PRESSURE
    scale = smallest(table, method.accuracy)
    errors = [REACHED[name] for name in (normal, tangential) if name in REACHED]
    if tangential != "full":
        elements = FAST_ELEMENTS if tangential in REACHED else NORMAL * scale
        return Choice(normal, tangential, elements, None, max(errors, default=table[scale]))
    size = fitted_size(scale, ratio or 1.0)
    return Choice(normal, tangential, NORMAL * scale, size, max([table[scale], *errors]))


def table_serves(case: Case, normal: str, ratio: float | None) -> bool:
    """Whether the table of creep forces gives the accuracy that the case asks for."""
    low, high = TABLE_RATIOS
    forced = getattr(getattr(case, "motion", None), "tangential_force", None) is not None
    return (
        normal == "hertz"
        and ratio is not None
        and low <= ratio <= high
        and (case.method.accuracy or 0.0) >= ON_TABLE
        and case.has_tangential
        and (case.layer is None or case.layer.thickness == 0)
        and not forced
    )


def axis_ratio(case: Case) -> float | None:
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
        return float(log(elliprd(0, 1, square) / elliprd(0, square, 1)) - log(along / across))

    limit = log(1e6)
    # a long contact has the smaller curvature along its length
    if excess(-limit) * excess(limit) > 0:
        return exp(limit if along < across else -limit)
    return exp(brentq(excess, -limit, limit, xtol=1e-9))


def resolved(case: Case) -> Case:
    """The case with the method and the grid that its accuracy chooses."""
    from railpatch.case.common import Grid

    choice = choose(case)
    if choice is None:
        return case
    fitted = list(choice.fitted) if choice.fitted else None
    grid = Grid(elements=[choice.elements] * 2, fitted=fitted)
    method = case.method.model_copy(
        update={"accuracy": None, "normal": choice.normal, "tangential": choice.tangential}
    )
    return case.model_copy(update={"grid": grid, "method": method})
