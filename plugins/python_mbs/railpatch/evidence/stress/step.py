"""One step of a case: what was asked, what came out, and the numbers that the conditions need."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
from scipy.special import ellipe, ellipk

from railpatch.case.load import Case
from railpatch.case.patch import PatchCase
from railpatch.evidence.stress import laws
from railpatch.evidence.stress.half_space import Array, HalfSpace, shifted

FIELDS = (
    "x",
    "y",
    "undeformed_distance",
    "pressure",
    "traction",
    "micro_slip",
    "element_division",
    "temperature",
    "friction",
    "plastic_displacement",
    "plastic_path",
    "yield_stress",
    "fluid_pressure",
)
VECTORS = ("traction", "micro_slip", "temperature", "plastic_displacement")


@dataclass(frozen=True)
class Finding:
    """A condition: its value and how great it may be."""

    name: str
    value: float
    limit: float

    @property
    def share(self) -> float:
        """Of the limit; infinite where the value is no number."""
        if not np.isfinite(self.value):
            return float("inf")
        if self.value <= 0:
            return 0.0
        return self.value / self.limit if self.limit > 0 else float("inf")


@dataclass(frozen=True)
class Step:
    """One patch in one step.

    case: checked. values: fields of rp_input. patch: the core's result of the patch. fields: by
    name, None where the scene has none. before: the step before, for what has a history.
    """

    case: Case
    values: dict[str, Any]
    patch: dict[str, Any]
    fields: dict[str, Array | None]
    before: Step | None = field(default=None, repr=False)

    def __getitem__(self, name: str) -> Array:
        found = self.fields[name]
        assert found is not None, name
        return found

    def has(self, name: str) -> bool:
        """Whether the scene has this field."""
        return self.fields[name] is not None

    @property
    def good(self) -> bool:
        """Whether the solver says that it found the solution."""
        return self.patch["status"] == "converged"

    @property
    def fitted(self) -> bool:
        """Whether the tangential problem is on rows fitted to the contact."""
        return self.case.grid is not None and self.case.grid.fitted is not None

    @property
    def regime(self) -> str:
        """Kind of motion."""
        if isinstance(self.case, PatchCase):
            return self.case.motion.regime
        return self.case.motion.regime if self.case.has_tangential else "none"

    @property
    def tolerance(self) -> float:
        """-, of the solver."""
        return self.case.method.tolerance

    @cached_property
    def elastic(self) -> tuple[float, float]:
        """Shear modulus (Pa) and Poisson's ratio of both together (Kalker 1990, eq. 1.44)."""
        moduli, ratios = map(np.array, (self.case.material.shear_modulus,
                                        self.case.material.poisson_ratio))  # fmt: skip
        modulus = 1 / np.mean(1 / moduli)
        return float(modulus), float(modulus * np.mean(ratios / moduli))

    @property
    def unlike(self) -> bool:
        """Whether pressure and traction act on each other (K of Kalker 1990, eq. 1.44)."""
        moduli, ratios = map(np.array, (self.case.material.shear_modulus,
                                        self.case.material.poisson_ratio))  # fmt: skip
        parts = np.broadcast_to((1 - 2 * ratios) / moduli, 2)
        return bool(abs(parts[0] - parts[1]) > 1e-9 * abs(parts).max())

    @property
    def layer(self) -> float:
        """m/Pa, flexibility of the third-body layer."""
        found = self.case.layer
        if found is None or found.thickness == 0:
            return 0.0
        assert found.shear_modulus is not None
        return found.thickness / found.shear_modulus

    @cached_property
    def half_space(self) -> HalfSpace:
        """On the grid of the fields."""
        dx, dy = self.patch["element_size"]
        ny, nx = self["pressure"].shape
        width = self.case.geometry.width if isinstance(self.case, PatchCase) else None
        return HalfSpace((ny, nx), dx, dy, *self.elastic, self.layer, width)

    @property
    def area(self) -> float:
        """m^2, of an element."""
        return self.half_space.dx * self.half_space.dy

    @cached_property
    def places(self) -> tuple[Array, Array]:
        """m, x and y of the elements' centres, [ny, nx]."""
        y, x = np.meshgrid(self["y"], self["x"], indexing="ij")
        return x, y

    @property
    def contact(self) -> Array:
        """Elements in contact, [ny, nx]."""
        return self["pressure"] > 0

    @property
    def direction(self) -> int:
        """1 or -1; 1 at standstill, where it does not matter."""
        return int(self.values.get("direction", self.patch["direction"])) or 1

    @property
    def rolled(self) -> float:
        """m, of the step; 1 for a shift, whose slips are lengths; an element in steady rolling."""
        if self.regime == "shift":
            return 1.0
        if self.regime == "transient_rolling":
            return float(self.values["distance"])
        return self.half_space.dx

    @property
    def ahead(self) -> float:
        """m along x, from where material is to where it was one step before."""
        stands = self.regime == "transient_rolling" and not self.patch["rolling_speed"] > 0
        return 0.0 if self.regime == "shift" or stands else self.direction * self.rolled

    @property
    def motion(self) -> tuple[float, float, float]:
        """Creepages (also those found) and spin; nothing moves at standstill."""
        if self.regime != "shift" and not self.patch["rolling_speed"] > 0:
            return 0.0, 0.0, 0.0
        xi, eta = self.patch["creepage"]
        return xi, eta, self.patch["spin_creepage"]

    @property
    def rigid_slip(self) -> Array:
        """[2, ny, nx], wheel minus rail over the rolling speed (shift: m)."""
        xi, eta, phi = self.motion
        x, y = self.places
        return np.array([xi - phi * y, eta + phi * (x + self.spin_offset)])

    @property
    def spin_offset(self) -> float:
        """m, added to x in the spin term."""
        method = self.case.method
        shares = {"none": 0.0, "sixth": 1 / 6, "quarter": 1 / 4, "automatic": 1 / 4}
        on_grid = method.tangential == "full" and not self.fitted and self.regime != "shift"
        layer = self.case.layer is not None and self.case.layer.thickness > 0
        if method.spin_offset == "automatic" and (layer or not on_grid):
            return 0.0
        way = min(self.rolled, self.contact_length)
        return self.direction * shares[method.spin_offset] * way

    @property
    def contact_length(self) -> float:
        """m, along x, of an ellipse whose pressure has the same variance."""
        dx = self.half_space.dx
        columns = self["pressure"].sum(axis=0)
        if not columns.any():
            return 0.0
        x = dx * np.arange(len(columns))
        mean = (columns * x).sum() / columns.sum()
        variance = (columns * (x - mean) ** 2).sum() / columns.sum() + dx**2 / 12
        return float(np.sqrt(20 * variance))

    @property
    def history(self) -> Step | None:
        """The step before on the same grid; None where nothing was carried over."""
        found = self.before
        if found is None or found.patch["status"] == "no_contact" or not found.has("traction"):
            return None
        return found if found["pressure"].shape == self["pressure"].shape else None

    @property
    def history_known(self) -> bool:
        """Whether all that the step went on from is known: not from a step that did not end well,
        nor from another grid, as those of wheels are."""
        before = self.before
        if self.regime == "transient_rolling" and not isinstance(self.case, PatchCase):
            return False
        if self.regime == "steady_rolling" or before is None:
            return True
        if before.patch["status"] == "no_contact":
            return True
        return before.good and self.history is not None

    @cached_property
    def displacement(self) -> Array:
        """m, [2, ny, nx], from the tractions."""
        return self.half_space.tangential(self["traction"])

    @cached_property
    def displacement_before(self) -> Array:
        """m, [2, ny, nx], of the same material one step before."""
        if self.regime == "steady_rolling":
            return self.half_space.tangential(self["traction"], self.ahead)
        if self.history is None:
            return np.zeros_like(self["traction"])
        return self.half_space.tangential(self.history["traction"], self.ahead)

    @cached_property
    def surface_slip(self) -> Array:
        """[2, ny, nx], of the surfaces on each other, also beside the contact, by the displacements
        of independent code."""
        return self.rigid_slip + (self.displacement - self.displacement_before) / self.rolled

    @cached_property
    def slip(self) -> Array:
        """[2, ny, nx], inelastic slip: micro-slip and plastic displacement of the step."""
        return np.where(self.contact, self.surface_slip, 0.0)

    @cached_property
    def traction_before(self) -> Array:
        """Pa, [2, ny, nx], of the same material one step before."""
        found = self if self.regime == "steady_rolling" else self.history
        if found is None:
            return np.zeros_like(self["traction"])
        return shifted(found["traction"], self.ahead / self.half_space.dx)

    @cached_property
    def friction_work(self) -> Array:
        """N/m, [ny, nx], what friction takes over the way of the step: by the traction at its
        middle, the mean of both ends, and in elements that have just left contact too."""
        before = self.traction_before
        left = ~self.contact & (before != 0).any(axis=0)
        slip = np.where(left, self.surface_slip, self["micro_slip"])
        return -0.5 * ((self["traction"] + before) * slip).sum(axis=0) * self.rolled

    @cached_property
    def asked_slip(self) -> Array:
        """[2, ny, nx], the inelastic slip without any traction in this step."""
        if self.regime == "steady_rolling":
            return self.rigid_slip
        return self.rigid_slip - self.displacement_before / self.rolled

    @cached_property
    def stiffness(self) -> float:
        """Pa, of a single element: turns slip to traction."""
        ahead = self.ahead if self.regime == "steady_rolling" else None
        return self.rolled / self.half_space.flexibility(ahead)

    @cached_property
    def steepness(self) -> float:
        """Pa, the least stiffness by which slip tells traction where the law falls with slip: a
        residual is known to tractions, and slip to tractions over this."""
        found = self.stiffness
        friction, layer = self.case.friction, self.case.layer
        if friction is not None and friction.law == "slip_velocity":
            fall = laws.steepest_fall(friction) * float(self["pressure"].max())
            found = max(found, 2 * fall * self.patch["rolling_speed"])
        if layer is not None and layer.is_plastic:
            found = max(found, 2 * laws.steepest_softening(layer) * self.rolled)
        return found


def curvatures_of(step: Step) -> tuple[float, float] | None:
    """1/m, of the undeformed distance c0 x^2 + c1 y^2; None where the case gives other shapes.

    From semi-axes by Hertz (Johnson 1985, eq. 4.26 and 4.28): p0 = 3 F/(2 pi a b), or from the
    approach, p0 b K(m) (1 - nu)/G with b the shorter one.
    """
    if not isinstance(step.case, PatchCase):
        return None
    geometry, load = step.case.geometry, step.case.load
    if geometry.curvatures is not None:
        return geometry.curvatures[0], geometry.curvatures[1]
    if geometry.line_contact_radius is not None:
        return 0.5 / geometry.line_contact_radius, 0.0
    if geometry.semi_axes is None:
        return None
    a, b = geometry.semi_axes
    longer, shorter = max(a, b), min(a, b)
    m = 1 - (shorter / longer) ** 2
    modulus = step.elastic[0] / (1 - step.elastic[1])
    if load.normal_force is not None:
        pressure = 1.5 * step.values["normal_force"] / (np.pi * a * b)
    else:
        pressure = step.values["approach"] * modulus / (shorter * ellipk(m))
    if m == 0:
        both = np.pi * pressure / (4 * a * modulus)
        return both, both
    size = pressure * shorter / (modulus * m * longer**2)
    along = size * (ellipk(m) - ellipe(m))
    across = size * (ellipe(m) / (1 - m) - ellipk(m))
    return (along, across) if a > b else (across, along)
