"""What a wear run does: a sweep whose cases are the mix, and a table [wear]."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import Field, model_validator

from railpatch.case.load import check_case, check_table, plain, read_toml
from railpatch.case.types import LEFT_OUT, Positive, Problems, Table, between, refuse, relation
from railpatch.errors import CaseError
from railpatch.sweep.plan import Plan, digest, load_plan

KINDS = ("wheel_rail", "wheelset")
# how far each body's run goes
OF_BODY = {"wheel": "distance", "rail": "passages"}


class Wear(Table):
    """How far the profiles wear."""

    bodies: Literal["wheel", "rail", "both"] = Field(
        default="wheel", description="whose profiles wear (no unit)"
    )
    distance: Positive | None = Field(
        default=None, description="m, that the wheels run in all; with wheels that wear"
    )
    passages: Positive | None = Field(
        default=None,
        description="-, axles that pass each place of the rails in all; with rails that wear",
    )
    largest_depth: Annotated[float, between(1e-8, 1e-2)] = Field(
        default=2e-5, description="m, that wears off before the contacts are solved anew, at most"
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
    rails_alike: bool = Field(
        default=False,
        description="whether both rails get the mean wear of both, as on a line with curves to "
        "either side (no unit)",
    )
    amplitude: Annotated[float, between(1e-4, 1e-2)] = Field(
        default=3e-3, description="m, of the wave whose equivalent conicity is told"
    )

    @model_validator(mode="after")
    def _by_body(self) -> Wear:
        refuse(self._ways())
        return self

    def _ways(self) -> Problems:
        for body, key in OF_BODY.items():
            value = getattr(self, key)
            if body in self.worn and value is None:
                yield relation(key, "missing", f"a number with bodies = {self.bodies!r}")
            if body not in self.worn and value is not None:
                yield relation(key, value, f"{LEFT_OUT} with bodies = {self.bodies!r}")
        if self.rails_alike and "rail" not in self.worn:
            yield relation("rails_alike", True, f"{LEFT_OUT} where rails do not wear")
        if self.largest_step is not None and self.distance is None:
            yield relation("largest_step", self.largest_step, f"{LEFT_OUT} where no wheel wears")

    @property
    def worn(self) -> tuple[str, ...]:
        """The bodies that wear."""
        return ("wheel", "rail") if self.bodies == "both" else (self.bodies,)

    @property
    def total(self) -> float:
        """What a run is measured by: the distance (m), or without it the passages."""
        known = self.distance if self.distance is not None else self.passages
        assert known is not None
        return known

    @property
    def passages_by_way(self) -> float:
        """1/m, passages on each metre of the wheels' way; 1 where no wheel wears."""
        return (self.passages or 0.0) / self.total


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
        # a run goes on to a longer way, of which the rails have the same part
        del table["distance"], table["passages"]
        table["passages_by_way"] = repr(self.table.passages_by_way)
        if self.table.bodies == "wheel":  # as runs were marked before rails wore
            for key in ("bodies", "rails_alike", "passages_by_way"):
                del table[key]
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
        for body in table.worn:
            if key.startswith(f"profiles.{body}"):
                raise CaseError(
                    f"vary.key: value is {key!r}, allowed for wear none of {body} profiles"
                )
    refuse_round_wheels(mix)
    if "rail" in table.worn:
        refuse_rails(mix)
    if table.weights is not None and len(table.weights) != len(mix.points):
        raise CaseError(
            f"wear.weights: has {len(table.weights)} numbers, allowed one for each of "
            f"{len(mix.points)} cases"
        )
    return WearPlan(mix, table)


def refuse_round_wheels(mix: Plan) -> None:
    """Wheels that have no one profile to wear. Raises CaseError."""
    for point in mix.points:
        if any(check_case(mix.case(point)).section_lists("wheelset").values()):
            raise CaseError(
                "wear: wheels wear, allowed where the wheels have no 'sections': one that is not "
                "worn alike all round has several profiles"
            )


def refuse_rails(mix: Plan) -> None:
    """Rails that have no one profile to wear. Raises CaseError."""
    for point in mix.points:
        case = check_case(mix.case(point))
        if case.track.kind != "rail":
            raise CaseError(
                "wear.bodies: rails wear, allowed with track.kind = 'rail': a roller is no rail"
            )
        if any(getattr(case.track, side).sections for side in case.sides):
            raise CaseError(
                "wear.bodies: rails wear, allowed where the track's rail has no 'sections'"
            )
