"""kind = "patch": a contact patch given directly."""

from __future__ import annotations

import math
from typing import Annotated, Literal

from pydantic import Field, model_validator

from railpatch.case.choice import RATIOS, axis_ratio
from railpatch.case.common import (
    WHEEL_METHOD,
    Friction,
    Grid,
    Layer,
    Material,
    Method,
    Temperature,
    check_accuracy,
    check_fitted,
    check_physics,
    check_plane,
    check_spin_offset,
    check_tangential,
    check_unheated,
    couples,
)
from railpatch.case.types import (
    Curvatures,
    ForcePair,
    Pair,
    Pairs,
    Positive,
    SemiAxes,
    Shift,
    Table,
    exactly_one,
    key,
    relation,
)

# of [motion]: moving keys that are no continuous numbers
STEPWISE = ("direction", "steps")
SHAPES = ("semi_axes", "curvatures", "line_contact_radius", "undeformed_distance")


class Geometry(Table):
    """Shape of the undeformed bodies: exactly one of the four forms."""

    semi_axes: SemiAxes | None = key(default=None)
    curvatures: Curvatures | None = key(default=None)
    line_contact_radius: float | None = key(default=None)
    width: float | None = key(default=None)
    undeformed_distance: str | list[list[Shift]] | None = Field(
        default=None,
        description="m, undeformed distance: path of a CSV file (or nested lists), one row per "
        "grid row from low to high y, columns along rolling from low to high x",
    )

    @model_validator(mode="after")
    def _one_shape(self) -> Geometry:
        exactly_one(self, SHAPES)
        if (self.width is None) != (self.line_contact_radius is None):
            key = "width" if self.width is None else "line_contact_radius"
            raise relation(key, "missing", "'line_contact_radius' and 'width' together")
        return self


class Load(Table):
    """Normal load: the force or the approach."""

    normal_force: float | None = key(default=None)
    approach: float | None = key(default=None)

    @model_validator(mode="after")
    def _one_load(self) -> Load:
        exactly_one(self, ("normal_force", "approach"))
        return self

    @property
    def moving(self) -> tuple[str, ...]:
        """The one that is given."""
        return ("normal_force",) if self.normal_force is not None else ("approach",)


class Motion(Table):
    """Relative motion; the table is left out for the normal problem alone."""

    regime: Literal["none", "shift", "transient_rolling", "steady_rolling"] = Field(
        default="steady_rolling", description="kind of motion (no unit)"
    )
    creepage: Pair | Pairs = Field(
        default=[0.0, 0.0],
        description="-, [longitudinal, lateral], wheel minus rail over the rolling speed; with "
        "shift m, the displacement of the wheel against the rail in a step. With steps also one "
        "pair for each of them",
    )
    tangential_force: ForcePair | None = Field(
        default=None,
        description="N, [longitudinal, lateral] on the wheel: the creep force is prescribed and "
        'the creepage found; "creepage" in place of a number leaves a component to the key '
        "creepage. Left out: both creepages are given",
    )
    direction: Literal[1, -1] = Field(
        default=1, description="-, rolling towards +x (1) or towards -x (-1)"
    )
    spin_creepage: float = key()
    rolling_speed: float = key()
    distance: Positive | None = Field(
        default=None, description="m, rolled in all steps of a solve with transient_rolling"
    )
    steps: Annotated[int, Field(ge=1, le=1_000_000)] | None = Field(
        default=None,
        description="-, number of equal steps of a solve with transient_rolling or shift; left "
        "out: 1",
    )

    @property
    def moving(self) -> tuple[str, ...]:
        """Creepages and forces as they are prescribed; distance and steps where they count."""
        keys = ["creepage", "spin_creepage", "rolling_speed", "direction"]
        if all(self.prescribed):
            keys.remove("creepage")
        if any(self.prescribed):
            keys.append("tangential_force")
        if self.regime == "transient_rolling":
            keys += ["distance", "steps"]
        return tuple(keys)

    @property
    def prescribed(self) -> tuple[bool, bool]:
        """Whether the longitudinal and the lateral force are prescribed."""
        force = self.tangential_force or ["creepage", "creepage"]
        return force[0] != "creepage", force[1] != "creepage"

    @property
    def forces(self) -> list[float]:
        """N, the components prescribed, else 0."""
        return [0.0 if force == "creepage" else force for force in self.tangential_force or (0, 0)]

    @model_validator(mode="after")
    def _by_regime(self) -> Motion:
        rolls = self.regime == "transient_rolling"
        if rolls and self.distance is None:
            raise relation("distance", "missing", "a number > 0 with regime = 'transient_rolling'")
        if not rolls and self.distance is not None:
            raise relation("distance", self.distance, "only with regime = 'transient_rolling'")
        if not rolls and self.regime != "shift" and self.steps is not None:
            raise relation("steps", self.steps, "only with regime = 'transient_rolling' or 'shift'")
        return self

    @property
    def creepages(self) -> list[list[float]]:
        """Creepage of each step."""
        if self.creepage and isinstance(self.creepage[0], list):
            return [list(pair) for pair in self.creepage if isinstance(pair, list)]
        return [[float(value) for value in self.creepage if not isinstance(value, list)]]

    @model_validator(mode="after")
    def _one_creepage_a_step(self) -> Motion:
        count = len(self.creepages)
        if count > 1 and count != (self.steps or 1):
            raise relation("creepage", f"{count} pairs", f"one pair, or steps = {self.steps} pairs")
        return self

    @model_validator(mode="after")
    def _one_of_force_and_creepage(self) -> Motion:
        if self.tangential_force is None:
            return self
        for pair in self.creepages:
            for prescribed, creepage in zip(self.prescribed, pair, strict=True):
                if not prescribed or creepage == 0:
                    continue
                shown = str(self.creepage)
                raise relation("creepage", shown, "0 where tangential_force gives the force")
        if not any(self.prescribed):
            raise relation(
                "tangential_force", str(self.tangential_force), "at least one force in N"
            )
        if not self.rolling_speed > 0:
            raise relation("rolling_speed", self.rolling_speed, "> 0 with tangential_force")
        return self


class PatchCase(Table):
    """A contact patch given directly."""

    kind: Literal["patch"] = Field(description="kind of case (no unit)")
    material: Material = Field(default=Material(), description="elastic constants (Pa, -)")
    geometry: Geometry = Field(description="shape of the undeformed bodies (m, 1/m)")
    load: Load = Field(description="normal force (N) or approach (m)")
    grid: Grid | None = Field(
        default=None, description="elements (-, m); left out: 24 across the contact"
    )
    motion: Motion = Field(
        default=Motion(regime="none"), description="relative motion (-, rad/m, m/s)"
    )
    friction: Friction | None = Field(
        default=None, description="friction law (-); needed where there is a tangential problem"
    )
    layer: Layer | None = Field(default=None, description="third-body layer (Pa, m)")
    temperature: Temperature | None = Field(
        default=None, description="surface temperature (degrees C, W/(m K), J/(kg K), kg/m^3)"
    )
    method: Method = Field(default=Method(), description="theories and tolerances (-)")

    @property
    def moving(self) -> tuple[str, ...]:
        """The tables that hold keys which move."""
        return ("load", "motion")

    @property
    def has_tangential(self) -> bool:
        """Whether the scene has a tangential problem."""
        return self.motion.regime != "none" and self.method.tangential != "none"

    @model_validator(mode="after")
    def _relations(self) -> PatchCase:
        if self.has_tangential:
            check_tangential(self.material, self.friction, self.layer, self.grid, self.method)
            check_physics(self.friction, self.layer, self.temperature, self.grid, self.method)
            self._check_regime()
        elif self.temperature is not None and self.method.tangential != "none":
            allowed = "'steady_rolling' or 'transient_rolling' with temperature"
            raise relation("motion.regime", repr(self.motion.regime), allowed)
        else:
            check_unheated(self.temperature)
        if self.friction is not None and self.friction.along_track is not None:
            shown = str(self.friction.along_track)
            raise relation("friction.along_track", shown, "to be left out with kind = 'patch'")
        if any(self.motion.prescribed):
            self._check_force()
        for name in WHEEL_METHOD:
            value = getattr(self.method, name)
            if value is not None:
                raise relation(f"method.{name}", repr(value), "only with wheels")
        line = self.geometry.line_contact_radius is not None
        check_fitted(self.grid, self.method, line=line)
        check_plane(self.method)
        ellipse = not line and self.geometry.undeformed_distance is None
        check_accuracy(self.grid, self.method, ellipse=ellipse, line=line)
        if ellipse and self.method.accuracy is not None:
            self._check_ratio()
        if line:
            self._check_line()
        gap = self.geometry.undeformed_distance
        if gap is not None and self.method.accuracy is not None:
            raise relation(
                "method.accuracy",
                self.method.accuracy,
                "to be left out with geometry.undeformed_distance: give 'grid'",
            )
        if gap is not None and (self.grid is None or self.grid.element_size is None):
            raise relation(
                "grid.element_size", "missing", "[dx, dy] in m with geometry.undeformed_distance"
            )
        if gap is not None and self.method.normal == "hertz":
            raise relation(
                "method.normal",
                "'hertz'",
                "'half_space', 'kik_piotrowski' or 'analyn' with undeformed_distance",
            )
        return self

    def _check_ratio(self) -> None:
        """Where the errors that an accuracy is chosen by were measured."""
        ratio = axis_ratio(self)
        low, high = RATIOS
        if ratio is not None and not low * (1 - 1e-9) <= ratio <= high * (1 + 1e-9):
            shown = f"{self.method.accuracy!r} with a/b = {ratio:.3g}"
            allowed = f"a/b of {low:g} ... {high:g}; for others give 'grid'"
            raise relation("method.accuracy", shown, allowed)

    def _check_regime(self) -> None:
        """What shift and transient rolling need: a grid that is fixed in the contact frame."""
        regime = self.motion.regime
        if regime == "shift":
            for key, asked in (
                ("friction.law", self.friction is not None and self.friction.law != "coulomb"),
                ("temperature", self.temperature is not None),
            ):
                if asked:
                    raise relation("motion.regime", "'shift'", f"a regime that rolls with {key}")
        if regime == "steady_rolling":
            return
        by_heat = self.friction is not None and self.friction.law == "temperature"
        if by_heat and couples(self.material):
            allowed = "'steady_rolling' with friction.law = 'temperature' and unlike (1 - 2 nu)/G"
            raise relation("motion.regime", f"'{regime}'", f"{allowed} in 'material'")
        if self.method.tangential != "full":
            shown = repr(self.method.tangential)
            raise relation("method.tangential", shown, f"'full' with regime = '{regime}'")
        if self.grid is not None and self.grid.fitted is not None:
            shown = str(self.grid.fitted)
            raise relation("grid.fitted", shown, f"to be left out with regime = '{regime}'")
        if regime == "shift":
            check_spin_offset(self.method, f"with regime = '{regime}'")
        if self.method.accuracy is not None:
            shown = f"to be left out with regime = '{regime}': give 'grid'"
            raise relation("method.accuracy", self.method.accuracy, shown)
        sized = self.grid is not None and self.grid.element_size and self.grid.max_elements
        if self.geometry.curvatures is not None and not sized:
            allowed = f"element_size and max_elements with curvatures and regime = '{regime}'"
            raise relation("grid", "another", allowed)

    def _check_force(self) -> None:
        """What a prescribed tangential force needs."""
        if self.motion.regime == "none":
            raise relation("motion.regime", "'none'", "a regime of motion with tangential_force")
        if self.method.tangential != "full":
            shown = repr(self.method.tangential)
            raise relation("method.tangential", shown, "'full' with motion.tangential_force")
        if self.load.normal_force is None or self.friction is None:
            return
        most = self.friction.greatest_anywhere * self.load.normal_force
        if math.hypot(*self.motion.forces) > most * (1 + 1e-12):
            shown = str(self.motion.tangential_force)
            plain = self.friction.law == "coulomb" and self.friction.factor is None
            which = "friction.coefficient" if plain else "the greatest friction coefficient"
            allowed = f"at most {which} * load.normal_force = {most:g} N in magnitude"
            raise relation("motion.tangential_force", shown, allowed)

    def _check_line(self) -> None:
        """What a line contact is not combined with."""
        if self.load.approach is not None:
            raise relation("load.approach", self.load.approach, "normal_force with a line contact")
        if self.method.normal in ("kik_piotrowski", "analyn"):
            shown = f"'{self.method.normal}'"
            raise relation("method.normal", shown, "'half_space' or 'hertz' with a line contact")
        if self.has_tangential and self.method.tangential != "full":
            raise relation(
                "method.tangential", repr(self.method.tangential), "'full' with a line contact"
            )
        elements = self.grid and self.grid.elements
        if elements and elements[1] != 1:
            raise relation("grid.elements", str(elements), "[n, 1] with a line contact")
