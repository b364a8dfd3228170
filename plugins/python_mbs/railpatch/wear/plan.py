"""What a wear run does: a sweep whose cases are the mix, and a table [wear]."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

from pydantic import Field

from railpatch.case.load import check_table, plain, read_toml
from railpatch.case.types import Positive, Table, between
from railpatch.errors import CaseError
from railpatch.sweep.plan import Plan, digest, load_plan

KINDS = ("wheel_rail", "wheelset")


class Wear(Table):
    """How far the profiles wear."""

    distance: Positive = Field(description="m, to run in all")
    largest_depth: Annotated[float, between(1e-8, 1e-2)] = Field(
        default=5e-5, description="m, that wears off before the contacts are solved anew, at most"
    )
    largest_step: Positive | None = Field(
        default=None, description="m, between two profiles at most; left out: by depth alone"
    )
    smoothing: Annotated[float, between(0, 0.05)] = Field(
        default=1.5e-3,
        description="m, standard deviation of the bell curve that depths are smoothed with "
        "(assumed: what a mix of few cases leaves out)",
    )
    weights: list[Positive] | None = Field(
        default=None, description="-, parts of the way, one for each case; left out: equal ones"
    )
    alike: bool = Field(
        default=True,
        description="whether both wheels get the mean wear of both, as of a vehicle that is turned "
        "(no unit)",
    )
    amplitude: Annotated[float, between(1e-4, 1e-2)] = Field(
        default=3e-3, description="m, of the wave whose equivalent conicity is told"
    )


@dataclass(frozen=True)
class WearPlan:
    """A checked wear run."""

    mix: Plan
    table: Wear

    @property
    def shares(self) -> list[float]:
        """-, of the way, one for each case."""
        weights = self.table.weights or [1.0] * len(self.mix.points)
        return [weight / sum(weights) for weight in weights]

    @property
    def mark(self) -> str:
        """The same for the same run, however far it goes."""
        table = self.table.model_dump()
        del table["distance"]
        return digest((self.mix.ids(), self.mix.content, table))


def load_wear(path: str | Path) -> WearPlan:
    """Checks a sweep's file with [wear]; the scene must have [damage]. Raises CaseError."""
    content: dict[str, Any] = plain(read_toml(Path(path)))
    if "wear" not in content:
        raise CaseError("wear: the table is left out, allowed [wear] with distance")
    table = check_table(Wear, content["wear"], "wear")
    mix = load_plan(path, besides=("wear",))
    if mix.kind not in KINDS:
        raise CaseError(f"sweep.scene: is a {mix.kind}, allowed for wear {' or '.join(KINDS)}")
    if "damage" not in mix.content:
        raise CaseError("damage: the scene leaves it out, allowed for wear [damage]")
    for key in mix.keys:
        if key.startswith("profiles.wheel"):
            raise CaseError(f"vary.key: value is {key!r}, allowed for wear none of wheel profiles")
    if table.weights is not None and len(table.weights) != len(mix.points):
        raise CaseError(
            f"wear.weights: has {len(table.weights)} numbers, allowed one for each of "
            f"{len(mix.points)} cases"
        )
    return WearPlan(mix, table)
