"""Tables that ask for more of a result than forces: [subsurface] and [damage]."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import pairwise
from typing import Annotated, Any, Literal

from pydantic import Field, model_validator

from railpatch.case.theories import has_tractions
from railpatch.case.types import (
    LEFT_OUT,
    NotNegative,
    Number,
    Positive,
    Problems,
    Table,
    between,
    exactly,
    refuse,
    relation,
    show,
)
from railpatch.errors import CaseError

Depths = Annotated[list[Annotated[float, between(0, 1)]], Field(min_length=1, max_length=1000)]
Point = Annotated[list[Number], exactly(3)]
Places = Annotated[list[Point], Field(min_length=1, max_length=10000)]
Steps = Annotated[
    list[Annotated[list[NotNegative], exactly(2)]], Field(min_length=1, max_length=32)
]
Life = Annotated[list[Annotated[list[Number], exactly(2)]], Field(min_length=2, max_length=32)]
ASSUMED = "assumed"
LEAST_LIMIT = 1e3  # Pa, of usfd_limits: less is N/mm^2
# Pa: less is N/mm^2, or a number of Brinell's or Vickers' scale, in kgf/mm^2
Stress = Annotated[float, between(1e6, 1e12)]
DEEP = 0.05  # m, below which nothing is left of a contact's stresses: more is mm
# keys that one law of wear reads
OF_LAW = {
    "usfd": ("usfd_rate", "usfd_plateau", "usfd_slope", "usfd_limits"),
    "archard": ("hardness", "archard_map", "seizure_pressure", "seizure_coefficient"),
}


class Subsurface(Table):
    """Stresses below each patch: docs/subsurface.md."""

    depths: Depths = Field(description="m, below the body's own surface")
    body: Literal["wheel", "rail"] = Field(
        default="rail", description="body that is looked at (no unit)"
    )
    points: Places | None = Field(
        default=None,
        description="m, [[x, y, depth], ...] in the contact frame, for stresses and displacements",
    )
    dang_van: Annotated[float, between(0, 3)] = Field(
        default=1 / 3,
        description="-, weight of the hydrostatic stress in Dang Van's criterion "
        f"({ASSUMED}, of no particular steel)",
    )

    @model_validator(mode="after")
    def _deep(self) -> Subsurface:
        for point in self.points or ():
            if not 0 <= point[2] <= 1:
                raise relation("points", f"depth {point[2]:g}", "depths of 0 to 1 m")
        return self


class Damage(Table):
    """Wear and rolling contact fatigue of each patch: docs/damage.md."""

    wear: Literal["usfd", "archard"] = Field(
        default="usfd",
        description="law of wear (no unit): by the work of friction over the area, or by pressure "
        "and way of slip",
    )
    basis: Literal["elements", "patch"] = Field(
        default="elements",
        description="what the law is asked for (no unit): each element by its own traction and "
        "slip, or the patch by its wear number over its area; Archard: by its greatest pressure",
    )
    worn_density: Annotated[float, between(100, 1e5)] = Field(
        default=7850.0, description=f"kg/m^3, of what wears off ({ASSUMED}: steel)"
    )
    usfd_rate: Annotated[float, between(1e-15, 1e-4)] = Field(
        default=5.3e-9,
        description="kg/J, mild wear: mass over work (Lewis and Dwyer-Joyce 2004: 5.3 ug/(m mm^2) "
        "by N/mm^2)",
    )
    usfd_plateau: Annotated[float, between(1e-9, 5.0)] = Field(
        default=55.0e-3,
        description="kg/m^3, severe wear: mass by metre rolled and m^2 (Lewis and Dwyer-Joyce "
        "2004: 55.0 ug/(m mm^2))",
    )
    usfd_slope: Annotated[float, between(1e-15, 1e-4)] = Field(
        default=61.9e-9,
        description="kg/J, catastrophic wear: mass over what work is above the last limit (Lewis "
        "and Dwyer-Joyce 2004: 61.9 ug/(m mm^2) by N/mm^2)",
    )
    usfd_limits: Annotated[list[NotNegative], exactly(2)] = Field(
        default=[10.4e6, 77.2e6],
        description="Pa, work by metre rolled and area where severe and catastrophic wear begin "
        "(Lewis and Dwyer-Joyce 2004)",
    )
    hardness: Stress = Field(
        default=2.6e9, description=f"Pa, of the softer body, for Archard's law ({ASSUMED})"
    )
    archard_map: Steps = Field(
        default=[[0.0, 5.5e-4], [0.2, 3.5e-3], [0.7, 5.5e-4]],
        description="m/s and -, [[slip speed from which on, coefficient], ...] from 0 on (regions "
        f"of Jendel 2002; the middle of each region's range, {ASSUMED})",
    )
    seizure_pressure: Positive = Field(
        default=0.8, description="-, of the hardness, where seizure begins (Jendel 2002)"
    )
    seizure_coefficient: NotNegative = Field(
        default=3.5e-2,
        description=f"-, of seizure (Jendel 2002; middle of its range, {ASSUMED})",
    )
    shear_yield: Stress = Field(
        default=300e6, description=f"Pa, yield stress in pure shear, cyclic ({ASSUMED}: rail steel)"
    )
    whole_life: Life = Field(
        default=[[15.0, 0.0], [65.0, 1e-5], [175.0, 0.0]],
        description="N and -, [[wear number, damage of one passage], ...], straight between and "
        "on beyond the last, where wear takes cracks away (after Burstow 2003, whose text was not "
        f"at hand: {ASSUMED})",
    )

    @model_validator(mode="after")
    def _increasing(self) -> Damage:
        refuse(self._orders())
        return self

    def _orders(self) -> Problems:
        for law, names in OF_LAW.items():
            for name in names if law != self.wear else ():
                value = getattr(self, name)
                if value != type(self).model_fields[name].default:
                    allowed = f"{LEFT_OUT} with wear = {self.wear!r}"
                    yield relation(name, show(value), allowed)
        if not self.usfd_limits[0] <= self.usfd_limits[1]:
            yield relation("usfd_limits", str(self.usfd_limits), "the lower limit first")
        if any(0 < limit < LEAST_LIMIT for limit in self.usfd_limits):
            allowed = f"0 or >= {LEAST_LIMIT:g} Pa: 10.4 N/mm^2 are 10.4e6"
            yield relation("usfd_limits", str(self.usfd_limits), allowed)
        for name, at in (("archard_map", "slip speeds"), ("whole_life", "wear numbers")):
            points = getattr(self, name)
            if not all(a[0] < b[0] for a, b in pairwise(points)):
                yield relation(name, show(points), f"{at} that increase")
        if self.archard_map[0][0] != 0:
            yield relation("archard_map", show(self.archard_map), "a first slip speed of 0")


def asked_doubts(case: Any) -> list[str]:
    """Warnings of depths that can hardly be meant."""
    below = case.subsurface
    if below is None:
        return []
    points = [point[2] for point in below.points or ()]
    found = {"depths": max(below.depths), "points": max(points, default=0.0)}
    return depth_doubts({f"subsurface.{name}": depth for name, depth in found.items()})


def depth_doubts(greatest: Mapping[str, float]) -> list[str]:
    """The same of the greatest depths (m) by the name of what gave them."""
    return [
        f"{name}: a depth is {depth:g} m, hardly meant above {DEEP:g} m, where little "
        "is left of a contact's stresses: depths are in m"
        for name, depth in greatest.items()
        if depth > DEEP
    ]


def check_asked(case: Any, line: bool) -> Problems:
    """What a case cannot give: theories without tractions, line contacts, grids of nodes."""
    method = case.method
    without = case.has_tangential and not has_tractions(method.tangential)
    fitted = case.grid is not None and case.grid.fitted is not None
    if case.subsurface is not None:
        if without:
            yield relation(
                "subsurface",
                "given",
                f"none with method.tangential = {method.tangential!r}, which has no tractions",
            )
        if line and case.subsurface.points:
            yield relation("subsurface.points", "given", "none in a line contact")
    if case.damage is None:
        return
    if not case.has_tangential:
        yield relation("damage", "given", "none without a tangential problem")
    elif "shift" in (case.motion.regime, *(getattr(case.motion, "regimes", None) or ())):
        yield relation("damage", "given", "none with motion.regime = 'shift', which rolls no way")
    elif case.damage.basis == "elements" and (without or fitted):
        why = "fitted rows" if fitted else f"method.tangential = {method.tangential!r}"
        yield relation("damage.basis", "'elements'", f"'patch' with {why}")
    elif (
        case.damage.basis == "elements"
        and method.accuracy is not None
        and method.tangential == "full"
    ):
        allowed = "'patch' with method.accuracy, which chooses rows of nodes or a table: or 'grid'"
        yield relation("damage.basis", "'elements'", allowed)
    elif case.damage.basis == "patch" and getattr(case.motion, "slip_field", None) is not None:
        allowed = "'elements' with motion.slip_field, which the wear number has not"
        yield relation("damage.basis", "'patch'", allowed)


def refuse_asked(case: Any, where: str) -> None:
    """Of commands whose contacts have no results of their own. Raises CaseError."""
    given = [name for name in ("subsurface", "damage") if getattr(case, name, None) is not None]
    if given:
        raise CaseError([f"{name}: given, allowed none {where}" for name in given])


def refuse_changes(case: Any, where: str) -> None:
    """Of what has one regime, and no slip by element, for all steps. Raises CaseError."""
    motion = getattr(case, "motion", None)
    for key in ("regimes", "regime_changes", "slip_field"):
        if getattr(motion, key, None):
            raise CaseError(f"motion.{key}: given, allowed none {where}")
