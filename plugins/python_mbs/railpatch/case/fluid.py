"""The table [fluid]: a liquid between wheel and rail (docs/fluids.md)."""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING, Annotated, Any, Literal

from pydantic import Field, model_validator

from railpatch.case.types import (
    LEFT_OUT,
    MOST_POINTS,
    Pair,
    Problems,
    Table,
    between,
    key,
    listed,
    more_than,
    one_of,
    refuse,
    relation,
    within,
)

if TYPE_CHECKING:
    from railpatch.case.friction import Friction

Coefficient = Annotated[float, between(0, 10)]
ViscosityTable = Annotated[list[Pair], Field(min_length=2, max_length=MOST_POINTS)]
# of the liquids, where the case says nothing else: 1/Pa, W/(m K), Pa; those of oil are assumed
PRESSURE_COEFFICIENT = {None: 0.5e-9, "water": 0.5e-9, "oil": 20e-9}
CONDUCTIVITY = {"water": 0.6, "oil": 0.14}
EYRING_STRESS = {"oil": 5e6}
# keys of a step and the key of the table that each moves
MOVED = {"water_rate": "water_rate", "water_temperature": "temperature", "oil_film": "oil_film"}


class Oxide(Table):
    """Solids in the liquid, such as oxide of rail and wheel: a paste (model D)."""

    solid_content: float = key(of="fluid_oxide_content", default=...)
    exponent: float = key(of="fluid_oxide_exponent")
    boundary_friction: Coefficient | None = Field(
        default=None,
        description="-, of asperities in the paste; left out: that of the table [fluid]",
    )


class Fluid(Table):
    """A liquid between wheel and rail; the table is left out for none."""

    model: one_of("fluid_model", without=("none",)) = Field(
        description="(no unit) film: central film of an elliptic contact, the share of the load "
        "that asperities carry, one friction coefficient for every theory"
    )
    share: one_of("fluid_share") = Field(
        default="film_ratio",
        description="of the load on asperities (no unit): film_ratio, exp(-1.8 (film/roughness)^1.2"
        "); load_sharing, asperities and liquid in balance",
    )
    roughness: float = key(of="fluid_roughness", default=...)
    boundary_friction: Coefficient | None = Field(
        default=None,
        description="-, of asperities that the liquid wets; left out: friction.coefficient, which "
        "is that of dry surfaces",
    )
    hardness: float = key("; with load_sharing", of="fluid_hardness")
    mean_pressure: Annotated[float, more_than(0, 1e12)] | Literal["contact"] = Field(
        default=listed("fluid_mean_pressure")["start"],
        description="Pa, nominal pressure that load_sharing compares with hardness, by default "
        "that of its calibration; 'contact': that of each contact",
    )
    viscosity: Annotated[float, within("fluid_viscosity")] | None = Field(
        default=None,
        description="Pa s, of the liquid at any temperature; with liquid = 'oil' at "
        "reference_temperature",
    )
    liquid: Literal["water", "oil"] | None = Field(
        default=None,
        description="viscosity by temperature (no unit): water (Vogel), or oil (Roelands) from "
        "viscosity at reference_temperature",
    )
    viscosity_table: ViscosityTable | None = Field(
        default=None,
        description="degrees C and Pa s, [[temperature, viscosity], ...]; logarithms straight in "
        "between, constant beyond",
    )
    reference_temperature: float = key("; of oil", of="fluid_reference_temperature")
    roelands_slope: float = key("; of oil", of="fluid_roelands_slope")
    pressure_coefficient: Annotated[float, within("fluid_pressure_coefficient")] | None = Field(
        default=None,
        description="1/Pa, alpha of the viscosity's growth by exp(alpha p); left out: 0.5e-9, with "
        "oil 20e-9",
    )
    temperature: Annotated[float, within("fluid_temperature")] | None = Field(
        default=None,
        description="degrees C, of the liquid before the contact, where its viscosity depends on "
        "it; left out: the mean of [temperature]'s wheel and rail, without that table 20. Moves as "
        "water_temperature",
    )
    water_rate: Annotated[float, within("fluid_water_rate")] | None = Field(
        default=None,
        description="m^3/s, supply of liquid, spread over the width of each contact: the film is "
        "starved; left out: flooded. Moves",
    )
    oil_film: Annotated[float, within("fluid_oil_film")] | None = Field(
        default=None,
        description="m, layer of liquid on the surfaces before the contact: the film is starved; "
        "left out: flooded. Moves",
    )
    starvation: float = key(of="fluid_starvation")
    inlet_heating: bool = Field(
        default=False,
        description="true: the liquid's shear in the inlet heats it and makes the film thinner "
        "(no unit)",
    )
    liquid_conductivity: Annotated[float, more_than(0, 1e3)] | None = Field(
        default=None,
        description="W/(m K), of the liquid, with inlet_heating; left out: 0.6, with oil 0.14",
    )
    eyring_stress: Annotated[float, within("fluid_eyring_stress")] | None = Field(
        default=None,
        description="Pa, of the liquid's own friction; 0: none; left out: 0, with oil 5e6 "
        "(assumed)",
    )
    limiting_friction: float = key("; with eyring_stress", of="fluid_limiting_friction")
    oxide: Oxide | None = Field(
        default=None, description="solids in the liquid, a paste (-); left out: none"
    )

    @model_validator(mode="after")
    def _read(self) -> Fluid:
        refuse(self._problems())
        return self

    def _problems(self) -> Problems:
        yield from self._viscosity()
        for name in ("hardness", "mean_pressure"):
            if self.share != "load_sharing" and self._changed(name):
                yield relation(name, getattr(self, name), "only with share = 'load_sharing'")
        if self.liquid_conductivity is not None and not self.inlet_heating:
            yield relation(
                "liquid_conductivity", self.liquid_conductivity, "only with inlet_heating = true"
            )
        if self._changed("limiting_friction") and not self.core["eyring_stress"] > 0:
            yield relation("limiting_friction", self.limiting_friction, "only with eyring_stress")

    def _viscosity(self) -> Problems:
        by_temperature = self.liquid is not None or self.viscosity_table is not None
        if self.liquid == "water" or self.viscosity_table is not None:
            which = "liquid = 'water'" if self.liquid == "water" else "viscosity_table"
            if self.viscosity is not None:
                yield relation("viscosity", self.viscosity, f"{LEFT_OUT} with {which}")
        elif self.viscosity is None:
            yield relation("viscosity", "missing", "a number, liquid = 'water' or viscosity_table")
        if self.liquid is not None and self.viscosity_table is not None:
            yield relation("liquid", repr(self.liquid), f"{LEFT_OUT} with viscosity_table")
        for name in ("reference_temperature", "roelands_slope"):
            if self.liquid != "oil" and self._changed(name):
                yield relation(name, getattr(self, name), "only with liquid = 'oil'")
        for name in ("temperature", "inlet_heating"):
            if not by_temperature and self._changed(name):
                shown = getattr(self, name)
                yield relation(name, shown, "only with 'liquid' or 'viscosity_table'")
        yield from self._table()

    def _table(self) -> Problems:
        if self.viscosity_table is None:
            return
        places = [place for place, _ in self.viscosity_table]
        if any(b <= a for a, b in itertools.pairwise(places)):
            shown = str(self.viscosity_table)
            yield relation("viscosity_table", shown, "pairs with increasing temperatures")
        low, high = (listed("fluid_viscosity")[end] for end in ("low", "high"))
        if not all(low <= value <= high for _, value in self.viscosity_table):
            shown = str(self.viscosity_table)
            yield relation("viscosity_table", shown, f"viscosities within {low:g} ... {high:g}")
        if self.inlet_heating and self.liquid_conductivity is None:
            yield relation(
                "liquid_conductivity", "missing", "a number with inlet_heating and a table"
            )

    def _changed(self, name: str) -> bool:
        return bool(getattr(self, name) != type(self).model_fields[name].default)

    @property
    def core(self) -> dict[str, Any]:
        """What of the core's numbers the liquid gives, by name without fluid_."""
        liquid = "table" if self.viscosity_table is not None else self.liquid or "given"
        found: dict[str, Any] = {
            "model": self.model,
            "liquid": liquid,
            "mean_pressure": 0.0 if self.mean_pressure == "contact" else self.mean_pressure,
            "pressure_coefficient": self.pressure_coefficient,
            "eyring_stress": self.eyring_stress,
        }
        if self.pressure_coefficient is None:
            usual = PRESSURE_COEFFICIENT.get(self.liquid, PRESSURE_COEFFICIENT[None])
            found["pressure_coefficient"] = usual
        if self.eyring_stress is None:
            found["eyring_stress"] = EYRING_STRESS.get(self.liquid or "", 0.0)
        if self.inlet_heating:
            usual = CONDUCTIVITY.get(self.liquid or "", 0.0)
            found["inlet_conductivity"] = self.liquid_conductivity or usual
        if self.oxide is not None:
            found["oxide_content"] = self.oxide.solid_content
            found["oxide_exponent"] = self.oxide.exponent
            if self.oxide.boundary_friction is not None:
                found["boundary_friction"] = self.oxide.boundary_friction
        return found

    @property
    def moving(self) -> tuple[str, ...]:
        """Supply and temperature of the liquid, by the names of a step's keys."""
        if self.liquid is None and self.viscosity_table is None:
            return tuple(name for name in MOVED if name != "water_temperature")
        return tuple(MOVED)


def check_fluid(
    fluid: Fluid | None,
    friction: Friction | None,
    accuracy: float | None,
    *,
    prescribed: bool = False,
) -> Problems:
    """What a liquid is not combined with. accuracy: method's; prescribed: a creep force is."""
    if fluid is None:
        return
    if friction is not None and friction.law != "coulomb":
        yield relation("friction.law", repr(friction.law), "'coulomb' with [fluid]")
    if accuracy is not None:
        allowed = f"{LEFT_OUT} with [fluid], whose error is not known: give 'grid'"
        yield relation("method.accuracy", accuracy, allowed)
    if prescribed and fluid.core["eyring_stress"] > 0:
        shown = fluid.core["eyring_stress"]
        allowed = "0 with motion.tangential_force: the liquid's friction follows from the creepage"
        yield relation("fluid.eyring_stress", shown, allowed)


def without_dry_friction(fluid: Fluid | None) -> bool:
    """Whether no surface is dry, so that [friction] may be left out."""
    if fluid is None or fluid.water_rate is not None or fluid.oil_film is not None:
        return False
    return fluid.core.get("boundary_friction", fluid.boundary_friction) is not None
