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
    exactly,
    key,
    likely,
    listed,
    more_than,
    one_of,
    refuse,
    relation,
    show,
    within,
)

if TYPE_CHECKING:
    from railpatch.case.friction import Friction

NOT_NEGATIVE = Annotated[float, Field(ge=0, allow_inf_nan=False)]
RailWork = Annotated[list[NOT_NEGATIVE], exactly(2)]
Knots = Annotated[
    list[Annotated[list[NOT_NEGATIVE], exactly(6)]],
    Field(min_length=2, max_length=listed("fluid_knot_rate")["shape"][0]),
]
OF_KNOT = ("rate", "k_a", "k_s", "coefficient", "a", "b")
Coefficient = Annotated[float, between(0, 10)]
ViscosityTable = Annotated[list[Pair], Field(min_length=2, max_length=MOST_POINTS)]
# of the liquids, where the case says nothing else: 1/Pa, W/(m K), Pa; those of oil are assumed
PRESSURE_COEFFICIENT = {None: 0.5e-9, "water": 0.5e-9, "oil": 20e-9}
CONDUCTIVITY = {"water": 0.6, "oil": 0.14}
EYRING_STRESS = {"oil": 5e6}
HOT_OIL = 250.0  # degrees C
PACKED = 0.64  # -, content of solids; the core's check has the same
# degrees C, of water before the contact; the core's check has the same
LIQUID_WATER = (0.0, 100.0)
# keys of a step and the key of the table that each moves
MOVED = {
    "water_rate": "water_rate",
    "water_temperature": "temperature",
    "oil_film": "oil_film",
    "rail_work": "rail_work",
}


# -, mu_0 of the driest of the knots that come with the core (Polach 2005)
DRY_FRICTION = 0.55
OF_REGIMES = ("knots", "reference_rate", "recovery", "rail_work")
# keys that a model does not read
UNREAD = {
    "strip": (
        *("share", "mean_pressure", "pressure_coefficient", "water_rate", "oil_film", "starvation"),
        *("inlet_heating", "liquid_conductivity", "eyring_stress", "limiting_friction"),
        *OF_REGIMES,
    ),
    "film": OF_REGIMES,
    "ehl": (
        *("share", "mean_pressure", "starvation", "inlet_heating"),
        *OF_REGIMES,
    ),
    "regimes": (
        *("share", "mean_pressure", "pressure_coefficient", "oil_film", "starvation"),
        *("inlet_heating", "liquid_conductivity", "eyring_stress", "limiting_friction"),
        *("roughness", "boundary_friction", "hardness", "viscosity", "liquid", "viscosity_table"),
        *("reference_temperature", "roelands_slope", "temperature", "oxide"),
    ),
}


class Recovery(Table):
    """Friction's work cleans wheel and rail (model regimes)."""

    coefficient: Annotated[float, more_than(0, 1e6)] = Field(
        description="1/N, tau: the forces go over to those of the first knot by 1 - exp(-tau W), W "
        "(J/m) the work spent on each metre of rail and wheel"
    )


class Drying(Table):
    """The water of the paste falls as exp(-t/time - W/work), on each wheel (assumed)."""

    time: Annotated[float, more_than(0, 1e12)] | None = Field(
        default=None, description="s, in which the water falls to 1/e; left out: not by time"
    )
    work: Annotated[float, more_than(0, 1e15)] | None = Field(
        default=None,
        description="J/m, of friction on each metre of the wheel's circumference, by whose heat "
        "the water falls to 1/e; left out: not by work",
    )

    @model_validator(mode="after")
    def _one(self) -> Drying:
        if self.time is None and self.work is None:
            refuse([relation("time", "missing", "a number in s, or work in J/m")])
        return self


class Oxide(Table):
    """Solids in the liquid, such as oxide of rail and wheel: a paste (model D)."""

    solid_content: float = key(of="fluid_oxide_content", default=...)
    exponent: float = key(of="fluid_oxide_exponent")
    boundary_friction: Coefficient | None = Field(
        default=None,
        description="-, of asperities in the paste; left out: that of the table [fluid]",
    )
    drying: Drying | None = Field(
        default=None,
        description="by time and friction's work, of wheels with model = 'film': friction goes "
        "over to that of dry surfaces (-); left out: none",
    )

    @model_validator(mode="after")
    def _dries(self) -> Oxide:
        if self.drying is not None and not 0 < self.solid_content < PACKED:
            allowed = f"> 0 and < {PACKED:g}, where solids are packed, with drying"
            refuse([relation("solid_content", self.solid_content, allowed)])
        return self


class Fluid(Table):
    """A liquid between wheel and rail; the table is left out for none."""

    model: one_of("fluid_model", without=("none",)) = Field(
        description="(no unit) film: central film of an elliptic contact, the share of the load "
        "that asperities carry, one friction coefficient for every theory; strip: the pressure of "
        "the liquid along each row of the contact, friction where asperities carry; regimes: "
        "Polach's theory with parameters by water_rate"
    )
    share: one_of("fluid_share") = Field(
        default="film_ratio",
        description="of the load on asperities (no unit): film_ratio, exp(-1.8 (film/roughness)^1.2"
        "); load_sharing, asperities and liquid in balance",
    )
    roughness: float | None = key("; of film and strip", of="fluid_roughness", default=None)
    boundary_friction: Coefficient | None = Field(
        default=None,
        description="-, of asperities that the liquid wets; left out: friction.coefficient, which "
        "is that of dry surfaces",
    )
    hardness: float = key("; with share = 'load_sharing' and model = 'strip'", of="fluid_hardness")
    mean_pressure: Annotated[float, more_than(0, 1e12)] | Literal["contact"] = Field(
        default=listed("fluid_mean_pressure")["start"],
        description="Pa, nominal pressure that load_sharing compares with hardness, by default "
        "that of its calibration; 'contact': that of each contact",
    )
    viscosity: Annotated[float, within("fluid_viscosity")] | None = Field(
        **likely(
            "fluid_viscosity",
            default=None,
            description="Pa s, of the liquid at any temperature; with liquid = 'oil' at "
            "reference_temperature",
        )
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
        **likely(
            "fluid_temperature",
            default=None,
            description="degrees C, of the liquid before the contact, where its viscosity depends "
            "on it, of water 0 to 100; left out: the mean of [temperature]'s wheel and rail, "
            "without that table 20. Moves as water_temperature",
        )
    )
    water_rate: Annotated[float, within("fluid_water_rate")] | None = Field(
        **likely(
            "fluid_water_rate",
            default=None,
            description="m^3/s, supply of liquid, spread over the width of each contact: the film "
            "is starved; left out: flooded. Moves",
        )
    )
    oil_film: Annotated[float, within("fluid_oil_film")] | None = Field(
        **likely(
            "fluid_oil_film",
            default=None,
            description="m, layer of liquid on the surfaces before the contact, in place of "
            "water_rate: the film is starved; left out: flooded. Moves",
        )
    )
    starvation: float = key(of="fluid_starvation")
    inlet_heating: bool = Field(
        default=False,
        description="true: the liquid's shear in the inlet heats it and makes the film thinner "
        "(no unit)",
    )
    liquid_conductivity: Annotated[float, more_than(0, 1e3)] | None = Field(
        default=None,
        description="W/(m K), of the liquid, with inlet_heating; left out: 0.6, with oil 0.14; "
        "with model = 'ehl' its own shear in the contact heats it, left out: it does not",
    )
    eyring_stress: Annotated[float, within("fluid_eyring_stress")] | None = Field(
        **likely(
            "fluid_eyring_stress",
            default=None,
            description="Pa, of the liquid's own friction; 0: none, as of water; left out: 0, with "
            "oil 5e6 (assumed)",
        )
    )
    limiting_friction: float = key("; with eyring_stress", of="fluid_limiting_friction")
    knots: Knots | None = Field(
        default=None,
        description="m^3/s, -, -, -, -, s/m, [[water rate, k_A, k_S, mu_0, A, B], ...] of Polach's "
        "theory at increasing water rates, of regimes; left out: dry, damp and flooded ones",
    )
    reference_rate: float = key("; of regimes", of="fluid_reference_rate")
    recovery: Recovery | None = Field(
        default=None, description="cleaning by friction's work, of regimes (1/N); left out: none"
    )
    rail_work: RailWork = Field(
        default=[0.0, 0.0],
        description="J/m, friction work that wheels before have spent on each metre of the left "
        "and right rail, with recovery; of a patch the second counts. Moves",
    )
    oxide: Oxide | None = Field(
        default=None, description="solids in the liquid, a paste (-); left out: none"
    )

    @model_validator(mode="after")
    def _read(self) -> Fluid:
        refuse(self._problems())
        return self

    def _problems(self) -> Problems:
        if self.model == "regimes":
            yield from self._regimes()
        else:
            yield from self._viscosity()
            if self.roughness is None:
                shown = f"a number in m with model = {self.model!r}"
                yield relation("roughness", "missing", shown)
        for name in UNREAD.get(self.model, ()):
            if self._changed(name):
                shown = getattr(self, name)
                yield relation(name, show(shown), f"{LEFT_OUT} with model = {self.model!r}")
        for name in ("hardness", "mean_pressure"):
            read = self.share == "load_sharing" or (
                name == "hardness" and self.model in {"strip", "ehl"}
            )
            if not read and self._changed(name):
                yield relation(name, getattr(self, name), "only with share = 'load_sharing'")
        nominal = 0.0 if self.mean_pressure == "contact" else self.mean_pressure
        if self.share == "load_sharing" and self.hardness <= nominal:
            allowed = f"above mean_pressure, {nominal:g} Pa, with load_sharing"
            yield relation("hardness", self.hardness, allowed)
        if self.liquid_conductivity is not None and not self.inlet_heating:
            by_shear = self.core["eyring_stress"] > 0 and (
                self.liquid is not None or self.viscosity_table is not None
            )
            if self.model != "ehl":
                allowed = "only with inlet_heating = true or model = 'ehl'"
                yield relation("liquid_conductivity", self.liquid_conductivity, allowed)
            elif not by_shear:
                allowed = (
                    "only with eyring_stress and a viscosity by temperature with model = 'ehl'"
                )
                yield relation("liquid_conductivity", self.liquid_conductivity, allowed)
        if self.liquid == "water" and self.eyring_stress:
            allowed = "0 with liquid = 'water', whose own friction is 0"
            yield relation("eyring_stress", self.eyring_stress, allowed)
        if self.model != "regimes" and None not in (self.water_rate, self.oil_film):
            allowed = f"{LEFT_OUT} with water_rate: one of them says what arrives"
            yield relation("oil_film", self.oil_film, allowed)
        if self.dries and self.model != "film":
            allowed = f"{LEFT_OUT} with model = {self.model!r}"
            yield relation("oxide.drying", "given", allowed)
        if self._changed("limiting_friction") and not self.core["eyring_stress"] > 0:
            yield relation("limiting_friction", self.limiting_friction, "only with eyring_stress")

    def _regimes(self) -> Problems:
        if self.water_rate is None:
            yield relation("water_rate", "missing", "a number in m^3/s with model = 'regimes'")
        if self.recovery is None and self._changed("rail_work"):
            yield relation("rail_work", show(self.rail_work), "only with recovery")
        if self.knots is None:
            return
        columns = dict(zip(OF_KNOT, zip(*self.knots, strict=True), strict=True))
        if any(b <= a for a, b in itertools.pairwise(columns["rate"])):
            yield relation("knots", show(self.knots), "water rates that increase")
        for name, values in columns.items():
            field = listed(f"fluid_knot_{name}")
            low, high, open_low = field["low"], field["high"], field["bounds"][0] == "("
            at = OF_KNOT.index(name)
            for k, v in enumerate(values):
                if not low <= v <= high or (open_low and v == low):
                    unit = "" if field["unit"] == "-" else f" {field['unit']}"
                    allowed = f"{name} within {field['bounds'][0]}{low:g}, {high:g}]{unit}"
                    yield relation(f"knots[{k}][{at}]", v, allowed)

    def _viscosity(self) -> Problems:
        by_temperature = self.liquid is not None or self.viscosity_table is not None
        if self.liquid == "water" or self.viscosity_table is not None:
            which = "liquid = 'water'" if self.liquid == "water" else "viscosity_table"
            if self.viscosity is not None:
                yield relation("viscosity", self.viscosity, f"{LEFT_OUT} with {which}")
        elif self.viscosity is None:
            yield relation(
                "viscosity", "missing", "a number in Pa s (of oil too), liquid = 'water' or a table"
            )
        if self.liquid is not None and self.viscosity_table is not None:
            yield relation("liquid", repr(self.liquid), f"{LEFT_OUT} with viscosity_table")
        if self.liquid == "water" and self.temperature is not None:
            low, high = LIQUID_WATER
            if not low <= self.temperature <= high:
                allowed = f"{low:g} to {high:g} degrees C with liquid = 'water'"
                yield relation("temperature", self.temperature, allowed)
        if self.liquid == "oil" and self.temperature is not None and self.temperature > HOT_OIL:
            allowed = f"<= {HOT_OIL:g} degrees C with liquid = 'oil', which burns or boils beyond"
            yield relation("temperature", self.temperature, allowed)
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
            shown = show(self.viscosity_table)
            yield relation("viscosity_table", shown, "pairs with increasing temperatures")
        low, high = (listed("fluid_viscosity")[end] for end in ("low", "high"))
        if not all(low <= value <= high for _, value in self.viscosity_table):
            shown = show(self.viscosity_table)
            yield relation(
                "viscosity_table", shown, f"viscosities within {low:g} ... {high:g} Pa s"
            )
        if self.inlet_heating and self.liquid_conductivity is None:
            yield relation(
                "liquid_conductivity", "missing", "a number with inlet_heating and a table"
            )

    def _changed(self, name: str) -> bool:
        return bool(getattr(self, name) != type(self).model_fields[name].default)

    @property
    def dries(self) -> bool:
        """Whether a paste on the wheels loses its water from step to step."""
        return self.oxide is not None and self.oxide.drying is not None

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
        if self.recovery is not None:
            found["recovery"] = self.recovery.coefficient
        if self.pressure_coefficient is None:
            usual = PRESSURE_COEFFICIENT.get(self.liquid, PRESSURE_COEFFICIENT[None])
            found["pressure_coefficient"] = usual
        if self.eyring_stress is None:
            usual = EYRING_STRESS.get(self.liquid or "", 0.0)
            found["eyring_stress"] = usual if self.model in {"film", "ehl"} else 0.0
        if self.inlet_heating:
            usual = CONDUCTIVITY.get(self.liquid or "", 0.0)
            found["inlet_conductivity"] = self.liquid_conductivity or usual
        elif self.model == "ehl" and self.liquid_conductivity is not None:
            found["inlet_conductivity"] = self.liquid_conductivity
        if self.oxide is not None:
            found["oxide_content"] = self.oxide.solid_content
            found["oxide_exponent"] = self.oxide.exponent
            if self.oxide.boundary_friction is not None:
                found["boundary_friction"] = self.oxide.boundary_friction
            if self.oxide.drying is not None:
                found["drying_time"] = self.oxide.drying.time or 0.0
                found["drying_work"] = self.oxide.drying.work or 0.0
        return found

    @property
    def moving(self) -> tuple[str, ...]:
        """Supply and temperature of the liquid, by the names of a step's keys."""
        if self.model == "regimes":
            return ("water_rate", *(("rail_work",) if self.recovery is not None else ()))
        known = self.liquid is not None or self.viscosity_table is not None
        unread = {*UNREAD.get(self.model, ())}
        # of both ways to say what arrives the one that the case has
        if self.water_rate is not None:
            unread.add("oil_film")
        elif self.oil_film is not None:
            unread.add("water_rate")
        return tuple(
            name
            for name, key in MOVED.items()
            if key not in unread and (known or key != "temperature")
        )


def check_fluid(
    fluid: Fluid | None,
    friction: Friction | None,
    accuracy: float | None,
    tangential: str,
    *,
    prescribed: bool = False,
    without_time: str | None = None,
) -> Problems:
    """What a liquid is not combined with. accuracy: method's; prescribed: a creep force is;
    without_time: what of the case lets no paste dry."""
    if fluid is None:
        return
    if fluid.model == "regimes" and tangential != "polach":
        yield relation("method.tangential", repr(tangential), "'polach' with model = 'regimes'")
    if fluid.model == "regimes" and friction is not None and friction.coefficient is not None:
        allowed = f"{LEFT_OUT} with fluid.model = 'regimes', whose knots have friction of their own"
        yield relation("friction.coefficient", show(friction.coefficient), allowed)
    by_heat = fluid.model == "strip" and friction is not None and friction.law == "temperature"
    if friction is not None and friction.law != "coulomb" and not by_heat:
        others = " or 'temperature'" if fluid.model == "strip" else ""
        allowed = f"'coulomb'{others} with fluid.model = {fluid.model!r}"
        yield relation("friction.law", repr(friction.law), allowed)
    boundary = fluid.core.get("boundary_friction", fluid.boundary_friction)
    if by_heat and boundary is not None:
        allowed = f"{LEFT_OUT} with friction.law = 'temperature', which gives it"
        yield relation("fluid.boundary_friction", boundary, allowed)
    if fluid.dries and without_time:
        allowed = f"{LEFT_OUT} with {without_time}"
        yield relation("fluid.oxide.drying", "given", allowed)
    if accuracy is not None:
        allowed = f"{LEFT_OUT} with [fluid], whose error is not known: give 'grid'"
        yield relation("method.accuracy", accuracy, allowed)
    if prescribed and fluid.core["eyring_stress"] > 0:
        shown = fluid.core["eyring_stress"]
        allowed = "0 with motion.tangential_force: the liquid's friction follows from the creepage"
        yield relation("fluid.eyring_stress", shown, allowed)


def changes_with_time(case: Any) -> bool:
    """Whether wheels store heat, are cleaned, or dry, from step to step by the time between."""
    heat, fluid = case.temperature, case.fluid
    stores = heat is not None and heat.bulk is not None
    return stores or (fluid is not None and (fluid.recovery is not None or fluid.dries))


def check_ehl(fluid: Fluid | None, normal: str, regime: str, *, fitted: bool) -> Problems:
    """What model = "ehl" is not combined with."""
    if fluid is None or fluid.model != "ehl":
        return
    if normal != "half_space":
        yield relation("method.normal", repr(normal), "'half_space' with model = 'ehl'")
    if regime != "steady_rolling":
        yield relation("motion.regime", repr(regime), "'steady_rolling' with model = 'ehl'")
    if fitted:
        yield relation("grid.fitted", "given", f"{LEFT_OUT} with model = 'ehl'")


def without_dry_friction(fluid: Fluid | None) -> bool:
    """Whether no surface is dry, so that [friction] may be left out."""
    if fluid is not None and fluid.model == "regimes":
        return True
    if fluid is None or fluid.water_rate is not None or fluid.oil_film is not None or fluid.dries:
        return False
    return fluid.core.get("boundary_friction", fluid.boundary_friction) is not None
