"""Tables that every kind of case has."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Field, model_validator

from railpatch.case.choice import least_error
from railpatch.case.fluid import Fluid, without_dry_friction
from railpatch.case.friction import Friction, increasing
from railpatch.case.theories import (
    BY_ROWS,
    FAST,
    READERS,
    blends_as_contact,
    follows_slip,
    has_tractions,
)
from railpatch.case.types import (
    BODIES,
    LEFT_OUT,
    CapacityPair,
    Celsius,
    CountPair,
    ElementSize,
    FittedPair,
    HardeningTable,
    Modulus,
    Problems,
    Table,
    between,
    exactly_one,
    key,
    likely,
    listed,
    of_bodies,
    one_of,
    refuse,
    relation,
)


class Material(Table):
    """Elastic constants of wheel and rail; steel where the table is left out."""

    shear_modulus: of_bodies("shear_modulus") = key(", or [wheel, rail]")
    poisson_ratio: of_bodies("poisson_ratio") = key(", or [wheel, rail]")
    viscoelastic_ratio: of_bodies("viscoelastic_ratio") = key(", or [wheel, rail]")
    relaxation_time: of_bodies("relaxation_time") = key(
        ", or [wheel, rail]: of a rubber wheel on an elastic rail [1e-3, 0.0], and "
        "viscoelastic_ratio likewise"
    )
    influence_file: str | None = Field(
        default=None,
        description="influence coefficients in m/Pa (file, .npz or .csv, from the case's folder) "
        "of a patch with geometry.undeformed_distance, of bodies that are the same wherever the "
        "load is, docs/physics.md; left out: the half-space's",
    )


# of the core: memory grows with the square
MAX_FITTED_NODES = 48 * 48


class Grid(Table):
    """Elements of the potential contact: by number or by size."""

    elements: CountPair | None = Field(
        default=None,
        description="-, elements across the contact's bounding box [along rolling, lateral]",
    )
    element_size: ElementSize | None = Field(
        default=None, description="m, size of an element [along rolling, lateral]"
    )
    max_elements: CapacityPair | None = Field(
        default=None,
        description="-, with element_size: capacity of one patch's grid [along rolling, lateral], "
        "in shift and transient rolling of a patch the grid itself; left out: chosen from the "
        "scene, by curvatures 130, along a line contact 1002; a contact that needs more is "
        "out_of_range",
    )

    fitted: FittedPair | None = Field(
        default=None,
        description="-, nodes along rolling and rows of the tangential problem (full) on rows "
        "fitted to the contact area, at most 2304 nodes in all; left out: the elements above. The "
        "normal problem keeps its elements, 24 across where none are given",
    )

    @model_validator(mode="after")
    def _one_way(self) -> Grid:
        if self.fitted is None or self.elements or self.element_size:
            exactly_one(self, ("elements", "element_size"))
        refuse(self._problems())
        return self

    def _problems(self) -> Problems:
        if self.max_elements is not None and self.element_size is None:
            yield relation("max_elements", str(self.max_elements), "only with element_size")
        if self.fitted is not None and self.fitted[0] < 3:
            yield relation("fitted", str(self.fitted), "3 to 64 nodes along rolling")
        if self.fitted is not None and self.fitted[0] * self.fitted[1] > MAX_FITTED_NODES:
            yield relation("fitted", str(self.fitted), f"{MAX_FITTED_NODES} nodes in all")


class Layer(Table):
    """Third-body layer, elastic and, with a yield stress, plastic; the table is left out for
    none."""

    shear_modulus: Modulus | None = Field(
        default=None, description="Pa, shear modulus of the layer; needed with a thickness > 0"
    )
    thickness: float = key(of="layer_thickness", default=...)
    yield_stress: Annotated[float, between(1e-3, 1e15)] | None = Field(
        **likely(
            "layer_yield_stress",
            default=None,
            description="Pa, at which the layer begins to yield; left out: elastic",
        )
    )
    hardening: Annotated[float, between(-1e25, 1e25)] | None = Field(
        default=None,
        description="Pa/m, slope of the yield stress over the plastic displacement, not below a "
        "tenth of yield_stress; left out: 0",
    )
    hardening_table: HardeningTable | None = Field(
        default=None,
        description="m and Pa, [[plastic displacement, yield stress], ...] from [0, yield_stress] "
        "on, in place of yield_stress and hardening; the last stress holds beyond",
    )
    plastic_rule: one_of("plastic_rule") = Field(
        default="path",
        description="what the yield stress depends on (no unit): length of the plastic "
        "displacement's path, or magnitude of its vector sum",
    )
    plastic_heat_fraction: float = key()

    @model_validator(mode="after")
    def _plastic(self) -> Layer:
        refuse(self._problems())
        return self

    def _problems(self) -> Problems:
        if self.thickness > 0 and self.shear_modulus is None:
            yield relation("shear_modulus", "missing", "a number with thickness > 0")
        if self.hardening_table is not None:
            for name in ("yield_stress", "hardening"):
                if getattr(self, name) is not None:
                    yield relation(name, getattr(self, name), f"{LEFT_OUT} with hardening_table")
            yield from increasing("hardening_table", self.hardening_table)
            if self.hardening_table[0][0] != 0:
                shown = str(self.hardening_table[0])
                yield relation("hardening_table", shown, "a first displacement of 0")
            low, high = (listed("hardening_stress")[end] for end in ("low", "high"))
            for k, (_, stress) in enumerate(self.hardening_table):
                if not low <= stress <= high:
                    yield relation(f"hardening_table[{k}][1]", stress, f"{low:g} to {high:g} Pa")
        elif self.hardening is not None and self.yield_stress is None:
            yield relation("hardening", self.hardening, "only with yield_stress")
        for name in () if self.is_plastic else ("plastic_rule", "plastic_heat_fraction"):
            if getattr(self, name) != type(self).model_fields[name].default:
                shown = repr(getattr(self, name))
                yield relation(name, shown, "only with yield_stress or hardening_table")

    @property
    def is_plastic(self) -> bool:
        """Whether the layer yields."""
        return self.yield_stress is not None or self.hardening_table is not None


def has_layer(layer: Layer | None) -> bool:
    """Whether there is a layer of some thickness, or one that yields."""
    return layer is not None and (layer.thickness > 0 or layer.is_plastic)


def yields_by(layer: Layer | None) -> str:
    """The key that lets a layer yield."""
    by_table = layer is not None and layer.hardening_table is not None
    return f"layer.{'hardening_table' if by_table else 'yield_stress'}"


class Bulk(Table):
    """Bodies whose bulk temperature the contacts' heat raises and the air takes away.

    mass c dT/dt = heat - air_conductance (T - air_temperature), by wheelset.time_step from step to
    step.
    """

    mass: of_bodies("bulk_mass") = key(", or [wheel, rail]", of="bulk_mass")
    air_conductance: of_bodies("air_conductance") = key(", or [wheel, rail]")
    air_temperature: float = key()

    @model_validator(mode="after")
    def _cooled(self) -> Bulk:
        if max(self.mass) == 0:
            raise relation("mass", self.mass, "> 0 for wheel, rail or both")
        bodies = zip(self.air_conductance, self.mass, strict=True)
        cooled = [conductance > 0 and mass == 0 for conductance, mass in bodies]
        if any(cooled):
            raise relation("air_conductance", self.air_conductance, "0 of a body with mass 0")
        if (
            max(self.air_conductance) == 0
            and self.air_temperature != listed("air_temperature")["start"]
        ):
            raise relation("air_temperature", self.air_temperature, "only with air_conductance")
        return self


class Temperature(Table):
    """Surface temperature of wheel and rail; the table is left out for none."""

    wheel: Celsius = Field(
        **likely(
            "bulk_temperature",
            default=0.0,
            description="degrees C, bulk temperature of the wheel",
        )
    )
    rail: Celsius = Field(
        **likely(
            "bulk_temperature", default=0.0, description="degrees C, bulk temperature of the rail"
        )
    )
    exchange: bool = Field(
        default=False,
        description="whether wheel and rail may become unequally warm in later steps (no unit); "
        "where they are unequal from the start they may anyway",
    )
    conductivity: of_bodies("conductivity") = key(", or [wheel, rail]")
    heat_capacity: of_bodies("heat_capacity") = key(", or [wheel, rail]")
    density: of_bodies("density") = key(", or [wheel, rail]")
    depth: float = key(of="temperature_depth")
    bulk: Bulk | None = Field(
        default=None,
        description="bodies that the heat warms, by wheelset.time_step (degrees C, kg, W/K)",
    )

    @property
    def moving(self) -> tuple[str, ...]:
        """The bulk temperatures that are given."""
        return tuple(body for body, stores in zip(BODIES, self.stores, strict=True) if not stores)

    @property
    def stores(self) -> tuple[bool, bool]:
        """Whether the run finds the temperature of wheel and rail."""
        if self.bulk is None:
            return False, False
        return self.bulk.mass[0] > 0, self.bulk.mass[1] > 0


SLIP = "slip_velocity"
# what only wheels read
WHEEL_METHOD = ("patch_rule", "contact_frame", "standstill_speed")


class Method(Table):
    """Which theory solves which problem."""

    normal: Literal[("hertz", *BY_ROWS, "half_space")] = Field(
        default="half_space",
        description="theory of the normal problem (no unit); kik_piotrowski_corrected: with the "
        "overlap's depth by Hertz, so that an ellipse is Hertz's",
    )
    tangential: Literal[("none", *FAST, "full")] = Field(
        default="full", description="theory of the tangential problem (no unit)"
    )
    table_file: str | None = Field(
        default=None,
        description="of table: a file that 'railpatch table' wrote, of ellipses or of a pair of "
        "profiles (file, from the case's folder); left out: the package's, of ellipses",
    )
    tolerance: float = key()
    max_iterations: int | None = key("; left out: the core's choice", default=None)
    accuracy: Annotated[float, between(0.001, 0.2)] | None = Field(
        default=None,
        description="-, wanted instead of [grid]: error of the creep force over friction "
        "coefficient times normal force, promised for each result: the cheapest grid, and the "
        "cheapest method where 'normal' and 'tangential' are left out, are chosen for it, and "
        "finer ones follow while the error estimate is above it; else the status is "
        "accuracy_not_met",
    )
    max_work: int | None = key(
        ". The result is that of the height that came nearest, the status work_spent; left out or "
        "0: no limit",
        default=None,
    )
    spin_offset: one_of("spin_offset") = Field(
        default="automatic",
        description="-, how far upstream of an element its spin term is read, of the way of a step "
        "(an element in steady rolling, else the distance rolled): automatic is what errs least, a "
        "quarter for tangential = 'full' on the uniform grid without an elastic layer, and none "
        "elsewhere; a sixth as in the program CONTACT, for comparisons",
    )
    reference_surface: one_of("reference_surface") = Field(
        default="plane",
        description="of half_space on wheels (no unit): plane, or curved between wheel and rail, "
        "with a normal for each row of elements, for conformal contact",
    )
    percent_kalker: float = key()
    traction_bound: one_of("traction_bound", without=("automatic",)) | None = Field(
        default=None,
        description="of fastsim (no unit): elliptic, the friction coefficient times the pressure, "
        "or parabolic, as its square; left out: elliptic, which errs less, but parabolic with "
        "hertz and flexibility_blending = 'contact'",
    )
    flexibility_blending: one_of("flexibility_blending") = Field(
        default="sliding",
        description="of fastsim and fastrip (no unit): one flexibility for all directions as "
        "sliding becomes full, or none; contact: fastsim as in the program CONTACT, to compare "
        "(blended, Kalker's published coefficients, whole elements as steps, bound not scaled)",
    )
    polach_k_a: float = key()
    polach_k_s: float = key()
    fastsim_k0: float = key()
    fastsim_alpha: float = key()
    fastsim_beta: float = key()
    patch_rule: one_of("patch_rule") | None = Field(
        default=None,
        description="of wheels (no unit): blended, the default, neighbouring areas of contact go "
        "over from one patch to two smoothly, both solved in between, each with its share, "
        "pressure along the surface's normals, slip and creep force at one point; or contact, by "
        "distances, normals and points as in the program CONTACT, for comparisons",
    )
    contact_frame: one_of("contact_frame") | None = Field(
        default=None,
        description="of wheels on rollers (no unit): track, the default, x along the track, which "
        "with patch_rule contact leaves out the normal force's part along it where a contact lies "
        "ahead of the roller's top, as published results do; or inclined, x along the surface",
    )
    standstill_speed: float | None = key("; left out: 0.001", default=None)

    derivatives: bool = Field(
        default=False,
        description="true: the contact gives derivatives of its last step (no unit)",
    )

    @model_validator(mode="after")
    def _read_by_theory(self) -> Method:
        refuse(self._unread())
        return self

    def _unread(self) -> Problems:
        where = f"with tangential = {self.tangential!r}"
        for name, readers in READERS.items():
            value = getattr(self, name)
            if self.tangential not in readers and value != type(self).model_fields[name].default:
                allowed = " or ".join(f"'{reader}'" for reader in readers)
                yield relation(name, repr(value), f"only with tangential = {allowed}")
            elif value == "contact" and not blends_as_contact(self.tangential):
                yield relation(name, repr(value), f"'sliding' or 'none' {where}")
        if self.table_file is not None and self.tangential != "table":
            yield relation("table_file", repr(self.table_file), "only with tangential = 'table'")
        if self.tangential == "none" or not has_tractions(self.tangential):
            yield from check_spin_offset(self, where, table="")


def check_physics(
    friction: Friction | None,
    layer: Layer | None,
    heat: Temperature | None,
    grid: Grid | None,
    method: Method,
) -> Problems:
    """Where the inelastic laws and temperature belong: the full theory on the uniform grid, and
    friction that follows the speed of slip to fast theories too."""
    law = "" if friction is None else f" = {friction.law!r}"
    asked = {
        f"friction.law{law}": friction is not None and friction.law != "coulomb",
        "friction.factor": friction is not None and friction.factor is not None,
        yields_by(layer): layer is not None and layer.is_plastic,
        "temperature": heat is not None,
    }
    for asking, needed in asked.items():
        if not needed:
            continue
        by_slip = asking == f"friction.law = '{SLIP}'"
        if by_slip and friction is not None and follows_slip(method.tangential):
            yield from check_without_memory(friction, method.tangential)
        elif method.tangential != "full":
            others = [f"'{name}'" for name in FAST if by_slip and follows_slip(name)]
            allowed = " or ".join(["'full'", *others])
            shown = repr(method.tangential)
            yield relation("method.tangential", shown, f"{allowed} with {asking}")
        if grid is not None and grid.fitted is not None:
            yield relation("grid.fitted", str(grid.fitted), f"{LEFT_OUT} with {asking}")
        if method.accuracy is not None:
            allowed = f"{LEFT_OUT} with {asking}: give 'grid'"
            yield relation("method.accuracy", method.accuracy, allowed)
    if layer is not None and heat is None:
        fraction = Layer.model_fields["plastic_heat_fraction"].default
        if layer.plastic_heat_fraction != fraction:
            shown = layer.plastic_heat_fraction
            yield relation("layer.plastic_heat_fraction", shown, "only with [temperature]")
    if friction is not None and friction.law == "temperature" and heat is None:
        yield relation("temperature", "missing", "the table [temperature] with this friction law")


def check_without_memory(friction: Friction, tangential: str) -> Problems:
    """Fast theories follow the speed of the rigid slip, which has no beginning."""
    if friction.memory_distance > 0:
        allowed = (
            f"0 with method.tangential = {tangential!r}: friction follows the rigid slip there"
        )
        yield relation("friction.memory_distance", friction.memory_distance, allowed)


def without_friction(content: dict[str, Any]) -> dict[str, Any]:
    """The content of a case for a first estimate: without tangential problem and what belongs to it
    alone."""
    method = {k: v for k, v in content["method"].items() if k not in OF_TANGENTIAL}
    grid = content["grid"]
    if grid is not None:
        grid = {**grid, "fitted": None}
    counted = grid is not None and (grid["elements"] or grid["element_size"])
    return {
        **content,
        **dict.fromkeys(PHYSICS),
        **dict.fromkeys(("subsurface", "damage")),
        "grid": grid if counted else None,
        "method": {**method, "tangential": "none"},
    }


# tables, and keys of [method], that belong to the tangential problem alone
PHYSICS = ("friction", "layer", "temperature", "fluid")
OF_TANGENTIAL = ("spin_offset", *READERS)


def check_left_out(case: Any, why: str) -> Problems:
    """What nothing reads in a scene without tangential problem. why: it has none."""
    for name in PHYSICS:
        if getattr(case, name) is not None:
            yield relation(name, "given", f"{LEFT_OUT} {why}")
    if case.grid is not None and case.grid.fitted is not None:
        allowed = f"{LEFT_OUT} {why}: rows are those of the tangential problem"
        yield relation("grid.fitted", str(case.grid.fitted), allowed)
    yield from check_spin_offset(case.method, why, table="method.")
    if case.method.tangential not in ("full", "none"):
        yield relation("method.tangential", repr(case.method.tangential), f"{LEFT_OUT} {why}")


def check_accuracy(
    grid: Grid | None, method: Method, *, ellipse: bool = False, line: bool = False
) -> Problems:
    """What a wanted accuracy is not combined with, and theories that do not reach it."""
    if method.accuracy is None:
        return
    key, shown = "method.accuracy", repr(method.accuracy)
    if grid is not None:
        yield relation(key, f"{shown} and grid is given", "exactly one of 'accuracy' and 'grid'")
    if line:
        yield relation(key, shown, f"{LEFT_OUT} with a line contact: give 'grid'")
    yield from check_spin_offset(method, "with accuracy")
    least = least_error(method, ellipse=ellipse)
    if method.accuracy < least:
        theories = f"normal = '{method.normal}' and tangential = '{method.tangential}'"
        known = f">= {least:g}, what {theories} reach"
        yield relation(key, shown, known if least < 1 else f"{LEFT_OUT} with {theories}")


def check_max_work(method: Method, why: str | None) -> Problems:
    """Of steps that search no height by its own. why: what of the case makes it so; None: none."""
    if method.max_work and why is not None:
        yield relation("method.max_work", method.max_work, f"{LEFT_OUT} {why}")


def check_fitted(grid: Grid | None, method: Method, *, line: bool = False) -> Problems:
    """What rows fitted to the contact area are not combined with."""
    if grid is None or grid.fitted is None or method.tangential == "none":
        return
    if method.tangential != "full":
        yield relation("grid.fitted", str(grid.fitted), "tangential = 'full', or no fitted rows")
    yield from check_spin_offset(method, "with grid.fitted")
    if line and grid.fitted[1] != 1:
        yield relation("grid.fitted", str(grid.fitted), "[n, 1] with a line contact")
    if not line and grid.fitted[1] < 3:
        yield relation("grid.fitted", str(grid.fitted), "3 to 64 rows")


def check_reference(material: Material, grid: Grid | None, method: Method) -> Problems:
    """What a curved reference surface is not combined with."""
    if method.reference_surface == "plane":
        return
    with_it = "with reference_surface = 'curved'"
    if method.normal != "half_space":
        yield relation("method.normal", repr(method.normal), f"'half_space' {with_it}")
    if method.tangential not in ("full", "none"):
        yield relation("method.tangential", repr(method.tangential), f"'full' or 'none' {with_it}")
    if method.accuracy is not None:
        yield relation("method.accuracy", method.accuracy, f"{LEFT_OUT} {with_it}: give 'grid'")
    if grid is not None and grid.fitted is not None:
        yield relation("grid.fitted", str(grid.fitted), f"{LEFT_OUT} {with_it}")
    if method.tangential != "none" and couples(material):
        yield relation("material", "unlike bodies", f"equal (1 - 2 nu)/G {with_it}")


def check_plane(method: Method) -> Problems:
    """Patches given directly have no normals of their own."""
    if method.reference_surface != "plane":
        shown = repr(method.reference_surface)
        yield relation("method.reference_surface", shown, "'plane' with kind = 'patch'")


def check_spin_offset(method: Method, where: str, table: str = "method.") -> Problems:
    """Only steps on the uniform grid have a place of the spin term that can be chosen."""
    if method.spin_offset not in ("automatic", "none"):
        allowed = f"'automatic', 'none' {where}: no steps from element to element read it"
        yield relation(f"{table}spin_offset", repr(method.spin_offset), allowed)


def check_tangential(
    material: Material,
    friction: Friction | None,
    layer: Layer | None,
    grid: Grid | None,
    method: Method,
    regime: str,
    fluid: Fluid | None,
) -> Problems:
    """What a tangential problem needs, and what this version cannot combine."""
    if friction is None and not without_dry_friction(fluid):
        asking = f"method.tangential = {method.tangential!r} and motion.regime = {regime!r}"
        allowed = f"the table [friction] with 'coefficient' with {asking}"
        yield relation("friction", "missing", allowed)
    if friction is not None and not without_dry_friction(fluid):
        yield from friction.missing()
    if method.tangential != "full" and has_layer(layer):
        yield relation(
            "method.tangential", repr(method.tangential), "'full' with a layer of thickness > 0"
        )
    if couples(material):
        yield from check_coupled(grid, method)


def couples(material: Material) -> bool:
    """Whether pressure moves the surfaces along each other: Kalker 1990, eq. 1.44, K not 0."""
    (g_wheel, g_rail), (nu_wheel, nu_rail) = material.shear_modulus, material.poisson_ratio
    wheel, rail = (1 - 2 * nu_wheel) / g_wheel, (1 - 2 * nu_rail) / g_rail
    return abs(wheel - rail) > 1e-12 * max(wheel, rail)


def check_whole_theory(case: Any, where: str) -> Problems:
    """Of a patch whose bodies are solved on the uniform grid alone, without derivatives. where:
    with which key."""
    grid, method = case.grid, case.method
    if method.normal != "half_space":
        yield relation("method.normal", repr(method.normal), f"'half_space' {where}")
    if method.tangential not in ("full", "none"):
        yield relation("method.tangential", repr(method.tangential), f"'full', 'none' {where}")
    if grid is not None and grid.fitted is not None:
        yield relation("grid.fitted", str(grid.fitted), f"{LEFT_OUT} {where}")
    if method.derivatives:
        yield relation("method.derivatives", "True", f"False {where}")


def check_coupled(grid: Grid | None, method: Method) -> Problems:
    """Bodies whose normal and tangential problem go together: the exact theory on the grid."""
    why = "with unlike (1 - 2 nu)/G of wheel and rail in 'material'"
    if method.tangential != "full":
        yield relation("method.tangential", repr(method.tangential), f"'full' {why}")
    if method.normal != "half_space":
        yield relation("method.normal", repr(method.normal), f"'half_space' {why}")
    if grid is not None and grid.fitted is not None:
        yield relation("grid.fitted", str(grid.fitted), f"{LEFT_OUT} {why}")
    if method.accuracy is not None:
        yield relation("method.accuracy", method.accuracy, f"{LEFT_OUT} {why}: give 'grid'")
