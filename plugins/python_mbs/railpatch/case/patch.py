"""kind = "patch": a contact patch given directly."""

from __future__ import annotations

import itertools
import math
from typing import Annotated, Any, Literal

from pydantic import Field, model_validator

from railpatch.case.asked import Damage, Subsurface, check_asked
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
    check_left_out,
    check_max_work,
    check_physics,
    check_plane,
    check_spin_offset,
    check_tangential,
    couples,
)
from railpatch.case.fluid import Fluid, check_ehl, check_fluid
from railpatch.case.own_influence import check_own_influence
from railpatch.case.theories import BY_ROWS
from railpatch.case.types import (
    LEFT_OUT,
    Curvatures,
    ForcePair,
    Number,
    Pair,
    Pairs,
    Positive,
    Problems,
    SemiAxes,
    Shift,
    Table,
    exactly,
    exactly_one,
    key,
    likely,
    refuse,
    relation,
)
from railpatch.case.viscous import check_viscous

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
    regimes: (
        Annotated[
            list[Literal["shift", "transient_rolling", "steady_rolling"]], Field(min_length=1)
        ]
        | None
    ) = Field(
        default=None,
        description="(no unit) of each step of a solve, which goes on from the tractions of the "
        "one before; regime is then that of the first, and a moving key of a Contact. Left out: "
        "regime in all steps",
    )
    creepage: Pair | Pairs = Field(
        **likely(
            "creepage",
            default=[0.0, 0.0],
            description="-, [longitudinal, lateral], wheel minus rail over the rolling speed; with "
            "shift m, the displacement of the wheel against the rail in a step. With steps also "
            "one pair for each of them",
        )
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
    slip_field: (
        Annotated[
            list[
                Annotated[list[Annotated[list[Number], Field(min_length=1)]], Field(min_length=1)]
            ],
            exactly(2),
        ]
        | None
    ) = Field(
        default=None,
        description="-, [longitudinal, lateral] rigid slip of each element, wheel minus rail over "
        "the rolling speed, as rows from low to high y of elements from low to high x: added to "
        "that of creepages and spin in each step; with shift m. Needs "
        "geometry.undeformed_distance. Left out: none",
    )
    rolling_speed: float = key()
    distance: Positive | None = Field(
        default=None,
        description="m, rolled in all steps of a solve with transient_rolling together",
    )
    steps: Annotated[int, Field(ge=1, le=1_000_000)] | None = Field(
        default=None,
        description="-, number of equal steps of a solve with transient_rolling or shift; left "
        "out: 1",
    )

    @property
    def moving(self) -> tuple[str, ...]:
        """Creepages and forces as they are prescribed; distance and steps where they count."""
        if self.regime == "none":
            return ()
        keys = ["creepage", "spin_creepage", "rolling_speed", "direction"]
        if all(self.prescribed):
            keys.remove("creepage")
        if any(self.prescribed):
            keys.append("tangential_force")
        if self.rolls_on:
            keys += ["distance", "steps"]
        if self.changes:
            keys.append("regime")
        if self.slip_field is not None:
            keys.append("slip_field")
        return tuple(keys)

    @property
    def changes(self) -> bool:
        """Whether the regime may change from step to step."""
        return self.regimes is not None

    @property
    def of_steps(self) -> list[str]:
        """Regime of each step of a solve."""
        return list(self.regimes) if self.regimes is not None else [self.regime] * (self.steps or 1)

    @property
    def rolls_on(self) -> bool:
        """Whether a step may be one of transient rolling."""
        return self.regime == "transient_rolling" or self.changes

    @property
    def step_distance(self) -> float | None:
        """m, rolled in one step of transient rolling."""
        if self.distance is None:
            return None
        return self.distance / max(self.of_steps.count("transient_rolling"), 1)

    @property
    def prescribed(self) -> tuple[bool, bool]:
        """Whether the longitudinal and the lateral force are prescribed."""
        force = self.tangential_force or ["creepage", "creepage"]
        return force[0] != "creepage", force[1] != "creepage"

    @property
    def forces(self) -> list[float]:
        """N, the components prescribed, else 0."""
        return [0.0 if force == "creepage" else force for force in self.tangential_force or (0, 0)]

    @model_validator(mode="before")
    @classmethod
    def _first_regime(cls, data: Any) -> Any:
        if isinstance(data, dict) and "regime" not in data and data.get("regimes"):
            regimes = data["regimes"]
            return {**data, "regime": regimes[0]} if isinstance(regimes, list) else data
        return data

    @model_validator(mode="after")
    def _of_each_other(self) -> Motion:
        refuse(itertools.chain(self._by_regime(), self._by_step(), self._by_force()))
        return self

    def _by_regime(self) -> Problems:
        rolls = "transient_rolling" in (self.regime, *self.of_steps)
        if rolls and self.distance is None:
            yield relation("distance", "missing", "a number > 0 with regime = 'transient_rolling'")
        if not self.rolls_on and self.distance is not None:
            yield relation("distance", self.distance, "only with regime = 'transient_rolling'")
        if self.regimes is not None:
            if self.regime == "none":
                yield relation("regime", "'none'", "a regime of motion with regimes")
            if self.steps not in (None, len(self.regimes)):
                allowed = f"{len(self.regimes)} or left out with so many regimes"
                yield relation("steps", self.steps, allowed)
        elif not rolls and self.regime != "shift" and self.steps is not None:
            yield relation("steps", self.steps, "only with regime = 'transient_rolling' or 'shift'")
        if self.regime != "none":
            return
        for name in ("creepage", "direction", "spin_creepage", "slip_field", "rolling_speed"):
            value = getattr(self, name)
            if value != type(self).model_fields[name].default:
                yield relation(name, str(value), f"{LEFT_OUT} with regime = 'none'")

    @property
    def creepages(self) -> list[list[float]]:
        """Creepage of each step."""
        if self.creepage and isinstance(self.creepage[0], list):
            return [list(pair) for pair in self.creepage if isinstance(pair, list)]
        return [[float(value) for value in self.creepage if not isinstance(value, list)]]

    def _by_step(self) -> Problems:
        count = len(self.creepages)
        steps = len(self.of_steps)
        if count > 1 and count != steps:
            given = self.steps if self.regimes is None else steps
            yield relation("creepage", f"{count} pairs", f"one pair, or steps = {given} pairs")

    def _by_force(self) -> Problems:
        if self.tangential_force is None:
            return
        for pair in self.creepages:
            for prescribed, creepage in zip(self.prescribed, pair, strict=True):
                if not prescribed or creepage == 0:
                    continue
                shown = str(self.creepage)
                yield relation("creepage", shown, "0 where tangential_force gives the force")
        if not any(self.prescribed):
            yield relation(
                "tangential_force", str(self.tangential_force), "at least one force in N"
            )
        if not self.rolling_speed > 0:
            yield relation("rolling_speed", self.rolling_speed, "> 0 with tangential_force")


class PatchCase(Table):
    """A contact patch given directly."""

    kind: Literal["patch"] = Field(description="kind of case (no unit)")
    material: Material = Field(default=Material(), description="elastic constants (Pa, -)")
    geometry: Geometry = Field(description="shape of the undeformed bodies (m, 1/m)")
    load: Load = Field(description="normal force (N) or approach (m)")
    grid: Grid | None = Field(
        default=None,
        description="elements (-, m); left out: 24 across the contact. Hertz's ellipse with a "
        "theory that gives no tractions, or with fitted rows, has none and reads none",
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
    fluid: Fluid | None = Field(
        default=None, description="liquid between wheel and rail (m, Pa s, degrees C, m^3/s)"
    )
    method: Method = Field(default=Method(), description="theories and tolerances (-)")
    subsurface: Subsurface | None = Field(
        default=None, description="stresses below the surface at these depths (m)"
    )
    damage: Damage | None = Field(
        default=None, description="wear and rolling contact fatigue by these laws (-)"
    )

    @property
    def moving(self) -> tuple[str, ...]:
        """The tables that hold keys which move."""
        fluid = ("fluid",) if self.fluid is not None else ()
        friction = ("friction",) if self.friction is not None and self.has_tangential else ()
        return ("load", "motion", *fluid, *friction)

    @property
    def has_tangential(self) -> bool:
        """Whether the scene has a tangential problem."""
        return self.motion.regime != "none" and self.method.tangential != "none"

    @model_validator(mode="after")
    def _relations(self) -> PatchCase:
        refuse(
            itertools.chain(
                self._check_physics(),
                self._check_of_wheels(),
                self._check_shape(),
                self._check_slip(),
                check_viscous(self),
                check_own_influence(self),
                check_asked(self, self.geometry.line_contact_radius is not None),
            )
        )
        return self

    def _check_physics(self) -> Problems:
        if self.has_tangential:
            yield from check_tangential(
                self.material,
                self.friction,
                self.layer,
                self.grid,
                self.method,
                self.motion.regime,
                self.fluid,
            )
            prescribed = any(self.motion.prescribed)
            yield from check_fluid(
                self.fluid,
                self.friction,
                self.method.accuracy,
                self.method.tangential,
                prescribed=prescribed,
                without_time="kind = 'patch'",
            )
            yield from check_ehl(
                self.fluid,
                self.method.normal,
                self.motion.regime,
                fitted=self.grid is not None and self.grid.fitted is not None,
            )
            yield from check_physics(
                self.friction, self.layer, self.temperature, self.grid, self.method
            )
            yield from self._check_regime()
        else:
            none = "motion.regime" if self.motion.regime == "none" else "method.tangential"
            yield from check_left_out(self, f"with {none} = 'none'")
        if any(self.motion.prescribed):
            yield from self._check_force()
            if self.method.accuracy is not None:
                shown = f"{LEFT_OUT} with motion.tangential_force, found is the creepage"
                yield relation("method.accuracy", self.method.accuracy, f"{shown}: give 'grid'")

    def _check_of_wheels(self) -> Problems:
        """Keys that patches given directly have not."""
        if self.temperature is not None and self.temperature.bulk is not None:
            yield relation("temperature.bulk", "given", f"{LEFT_OUT} with kind = 'patch': no time")
        if self.friction is not None and self.friction.along_track is not None:
            shown = str(self.friction.along_track)
            yield relation("friction.along_track", shown, f"{LEFT_OUT} with kind = 'patch'")
        for name in WHEEL_METHOD:
            value = getattr(self.method, name)
            if value is not None:
                yield relation(f"method.{name}", repr(value), "only with wheels")
        yield from check_plane(self.method)
        yield from check_max_work(self.method, "with kind = 'patch': no height is searched")

    def _check_shape(self) -> Problems:
        """What the shape is not combined with, and what it needs."""
        line = self.geometry.line_contact_radius is not None
        gap = self.geometry.undeformed_distance is not None
        ellipse = not line and not gap
        yield from check_fitted(self.grid, self.method, line=line)
        if not gap:
            yield from check_accuracy(self.grid, self.method, ellipse=ellipse, line=line)
        if ellipse and self.method.accuracy is not None:
            yield from self._check_ratio()
        if line:
            yield from self._check_line()
        if gap:
            yield from self._check_gap()

    def _check_slip(self) -> Problems:
        """What a slip of each element needs: a grid that is given, and the full theory on it."""
        slip = self.motion.slip_field
        if slip is None:
            return
        name = "motion.slip_field"
        gap = self.geometry.undeformed_distance
        if gap is None:
            yield relation(name, "given", f"{LEFT_OUT} but with geometry.undeformed_distance")
        elif not isinstance(gap, str):
            shape = len(gap), len(gap[0]) if gap else 0
            if any(len(part) != shape[0] or {*map(len, part)} != {shape[1]} for part in slip):
                allowed = f"twice {shape[0]} rows of {shape[1]} numbers, as the grid has"
                yield relation(name, "of another shape", allowed)
        if self.method.tangential != "full":
            shown = repr(self.method.tangential)
            yield relation("method.tangential", shown, f"'full' with {name}")
        if self.grid is not None and self.grid.fitted is not None:
            yield relation("grid.fitted", str(self.grid.fitted), f"{LEFT_OUT} with {name}")
        if self.fluid is not None:
            yield relation("fluid", "given", f"{LEFT_OUT} with {name}")
        if self.method.derivatives:
            yield relation("method.derivatives", "True", f"False with {name}")

    def _check_gap(self) -> Problems:
        """What an undeformed distance needs: its own grid."""
        where = "with geometry.undeformed_distance"
        if self.method.accuracy is not None:
            allowed = f"{LEFT_OUT} {where}: give 'grid'"
            yield relation("method.accuracy", self.method.accuracy, allowed)
        if self.grid is None or self.grid.element_size is None:
            yield relation("grid.element_size", "missing", f"[dx, dy] in m {where}")
        elif self.grid.max_elements is not None:
            allowed = f"{LEFT_OUT} {where}: its rows and columns are the grid"
            yield relation("grid.max_elements", str(self.grid.max_elements), allowed)
        if self.method.normal == "hertz":
            others = ", ".join(repr(name) for name in BY_ROWS)
            allowed = f"'half_space', {others} with undeformed_distance"
            yield relation("method.normal", "'hertz'", allowed)

    def _check_ratio(self) -> Problems:
        """Where the errors that an accuracy is chosen by were measured."""
        ratio = axis_ratio(self)
        low, high = RATIOS
        if ratio is not None and not low * (1 - 1e-9) <= ratio <= high * (1 + 1e-9):
            shown = f"{self.method.accuracy!r} with a/b = {ratio:.3g}"
            allowed = f"a/b of {low:g} ... {high:g}; for others give 'grid'"
            yield relation("method.accuracy", shown, allowed)

    def _check_regime(self) -> Problems:
        """What shift and transient rolling need: a grid that is fixed in the contact frame."""
        if self.motion.changes:
            yield from self._check_changes()
        for regime in dict.fromkeys((self.motion.regime, *self.motion.of_steps)):
            yield from self._check_one_regime(regime)

    def _check_changes(self) -> Problems:
        """What regimes that change are not combined with."""
        regimes = self.motion.regimes
        if regimes and self.motion.regime != regimes[0]:
            allowed = f"{regimes[0]!r}, the first of motion.regimes, or left out with them"
            yield relation("motion.regime", repr(self.motion.regime), allowed)
        for name, given in (("temperature", self.temperature), ("fluid", self.fluid)):
            if given is not None:
                yield relation(name, "given", f"{LEFT_OUT} with motion.regimes")
        if regimes == ["steady_rolling"] * len(regimes or ()):
            # of others each regime says what it needs
            yield from self._check_history("motion.regimes")

    def _check_one_regime(self, regime: str) -> Problems:
        """What a step of this regime needs."""
        if regime == "shift":
            for key, asked in (
                ("fluid", self.fluid is not None),
                ("friction.law", self.friction is not None and self.friction.law != "coulomb"),
                ("temperature", self.temperature is not None),
            ):
                if asked:
                    yield relation("motion.regime", "'shift'", f"a regime that rolls with {key}")
        if regime == "steady_rolling":
            return
        by_heat = self.friction is not None and self.friction.law == "temperature"
        if by_heat and couples(self.material):
            allowed = "'steady_rolling' with friction.law = 'temperature' and unlike (1 - 2 nu)/G"
            yield relation("motion.regime", f"'{regime}'", f"{allowed} in 'material'")
        if regime == "shift" and not self.motion.changes:
            yield from check_spin_offset(self.method, f"with regime = '{regime}'")
        yield from self._check_history(f"regime = '{regime}'")

    def _check_history(self, which: str) -> Problems:
        """What steps that go on from each other need: the full theory on a grid that stays."""
        if self.method.tangential != "full":
            shown = repr(self.method.tangential)
            yield relation("method.tangential", shown, f"'full' with {which}")
        if self.grid is not None and self.grid.fitted is not None:
            shown = str(self.grid.fitted)
            yield relation("grid.fitted", shown, f"{LEFT_OUT} with {which}")
        if self.method.accuracy is not None:
            shown = f"{LEFT_OUT} with {which}: give 'grid'"
            yield relation("method.accuracy", self.method.accuracy, shown)
        sized = self.grid is not None and self.grid.element_size and self.grid.max_elements
        if self.geometry.curvatures is not None and not sized:
            allowed = f"element_size and max_elements with curvatures and {which}"
            shown = "none" if self.grid is None else str(self.grid.model_dump(exclude_none=True))
            yield relation("grid", shown, allowed)

    def _check_force(self) -> Problems:
        """What a prescribed tangential force needs."""
        if self.motion.regime == "none":
            yield relation("motion.regime", "'none'", "a regime of motion with tangential_force")
        if self.method.tangential != "full":
            shown = repr(self.method.tangential)
            yield relation("method.tangential", shown, "'full' with motion.tangential_force")
        if self.load.normal_force is None or self.friction is None or self.fluid is not None:
            return
        most = self.friction.greatest_anywhere * self.load.normal_force
        if math.hypot(*self.motion.forces) > most * (1 + 1e-12):
            shown = str(self.motion.tangential_force)
            plain = self.friction.law == "coulomb" and self.friction.factor is None
            which = "friction.coefficient" if plain else "the greatest friction coefficient"
            allowed = f"at most {which} * load.normal_force = {most:g} N in magnitude"
            yield relation("motion.tangential_force", shown, allowed)

    def _check_line(self) -> Problems:
        """What a line contact is not combined with."""
        if self.fluid is not None and self.fluid.model != "ehl":
            allowed = f"{LEFT_OUT} with a line contact: the film is that of an elliptic one"
            yield relation("fluid", "given", allowed)
        if self.load.approach is not None:
            yield relation("load.approach", self.load.approach, "normal_force with a line contact")
        if self.method.normal in BY_ROWS:
            shown = f"'{self.method.normal}'"
            yield relation("method.normal", shown, "'half_space' or 'hertz' with a line contact")
        if self.has_tangential and self.method.tangential != "full":
            yield relation(
                "method.tangential", repr(self.method.tangential), "'full' with a line contact"
            )
        elements = self.grid and self.grid.elements
        if elements and elements[1] != 1:
            yield relation("grid.elements", str(elements), "[n, 1] with a line contact")
