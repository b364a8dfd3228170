"""Contact conditions of random cases, checked again by code that shares nothing with the solver.

Kalker 1990, Three-dimensional elastic bodies in rolling contact, chapter 1: pressure and gap are
not negative and not both positive; stick has no slip and at most the bound; slip has the bound,
against the slip. Displacements come from railpatch/evidence/stress/half_space.py, by other
code than the solver's.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cache
from typing import Any

import numpy as np
import pytest
import railpatch
from patch_cases import patch_case, solve
from railpatch.evidence.stress.half_space import Array, HalfSpace
from scipy.special import ellipe, ellipk

SEEDS = range(40)
TOLERANCE = 1e-5
# the solver measures its residual over all elements together; allow for another way of measuring
IMPOSED = 10 * TOLERANCE
SHEAR_MODULUS = 82e9
EXTERIOR, STICK, SLIP = 0, 1, 2


def hertz_curvatures(a: float, b: float, force: float, modulus: float) -> list[float]:
    """1/m, of the undeformed distance that gives the ellipse (Johnson 1985, chapter 4)."""
    major, minor = max(a, b), min(a, b)
    m = max(1 - (minor / major) ** 2, 1e-9)
    size = 3 * force / (2 * np.pi * modulus * major**3 * m)
    along, across = size * (ellipk(m) - ellipe(m)), size * (ellipe(m) / (1 - m) - ellipk(m))
    return [along, across] if a >= b else [across, along]


@dataclass
class Draw:
    """A random case with its own copy of what the conditions need."""

    seed: int
    case: dict[str, Any]
    curvatures: list[float]
    friction: float
    poisson_ratio: float
    layer: float
    notes: str = field(default="")

    @property
    def motion(self) -> dict[str, Any]:
        return self.case["motion"]


def draw(seed: int) -> Draw:
    rng = np.random.default_rng([20240610, seed])
    a = 10 ** rng.uniform(-3, -2)
    b = a / 10 ** rng.uniform(-0.7, 0.7)
    force, friction = 10 ** rng.uniform(3.5, 5.3), rng.uniform(0.05, 0.6)
    nu = float(rng.uniform(0, 0.5))
    curvatures = hertz_curvatures(a, b, force, SHEAR_MODULUS / (1 - nu))
    # from near stick to full sliding, in units of the creepage where the linear theory saturates
    unit = friction * force / (4 * SHEAR_MODULUS * a * b)
    load = 10 ** rng.uniform(-1.3, 1.3)
    angle = rng.uniform(0, 2 * np.pi)
    size = load * unit
    spin = float(rng.choice([0.0, 1.0]) * rng.normal() * size / np.sqrt(a * b))
    layer = None
    if rng.random() < 0.35:
        layer = {"shear_modulus": 8.2e9, "thickness": float(10 ** rng.uniform(-6, -3))}
    case = patch_case(
        {"curvatures": curvatures},
        force=force,
        elements=[int(rng.integers(12, 41)), int(rng.integers(12, 41))],
        creepage=[size * np.cos(angle), size * np.sin(angle)],
        spin=spin,
        direction=int(rng.choice([-1, 1])),
        friction=friction,
        material={"shear_modulus": SHEAR_MODULUS, "poisson_ratio": nu},
        layer=layer,
        tolerance=TOLERANCE,
    )
    flexibility = layer["thickness"] / layer["shear_modulus"] if layer else 0.0
    notes = f"a/b {a / b:5.2f} load {load:6.2f} spin {spin: .1e} layer {flexibility:.0e}"
    return Draw(seed, case, curvatures, friction, nu, flexibility, notes)


@dataclass
class Checked:
    """A solution with the displacements of independent code."""

    drawn: Draw
    result: railpatch.Result
    x: Array
    y: Array
    pressure: Array
    traction: Array
    division: Array
    half_space: HalfSpace
    slip: Array  # [2, N] on the elements in contact

    def fail(self, what: str, value: float, bound: float) -> str:
        return (
            f"seed {self.drawn.seed}: {what} is {value:.3e}, bound {bound:.3e}: {self.drawn.case}"
        )

    @property
    def contact(self) -> Array:
        return self.pressure > 0

    @property
    def bound(self) -> Array:
        return self.drawn.friction * self.pressure[self.contact]

    @property
    def tractions(self) -> Array:
        """[2, N] on the elements in contact."""
        return self.traction[:, self.contact]

    @property
    def rigid_slip(self) -> Array:
        motion = self.drawn.motion
        (xi, eta), phi = motion["creepage"], motion["spin_creepage"]
        y, x = np.meshgrid(self.y, self.x, indexing="ij")
        if not self.drawn.layer > 0:
            # without a layer the spin is read a quarter of an element upstream
            x = x + 0.25 * motion["direction"] * self.half_space.dx
        return np.array([xi - phi * y[self.contact], eta + phi * x[self.contact]])

    @property
    def stiffness(self) -> float:
        """Pa, of a single element: turns slip to traction."""
        return self.half_space.dx / self.half_space.flexibility(self.half_space.dx)

    @property
    def scale(self) -> float:
        """Pa, what the residual is measured by: the traction that the rigid slip asks for."""
        asked = self.stiffness * np.hypot(*self.rigid_slip)
        return float(np.linalg.norm(np.minimum(self.bound, asked)))


@cache
def checked(seed: int) -> Checked:
    drawn = draw(seed)
    result = solve(drawn.case, fields=True)
    x, y, pressure = result["x"], result["y"], result["pressure"]
    half_space = HalfSpace(
        pressure.shape, x[1] - x[0], y[1] - y[0], SHEAR_MODULUS, drawn.poisson_ratio, drawn.layer
    )
    found = Checked(
        drawn,
        result,
        x,
        y,
        pressure,
        result["traction"],
        result["element_division"],
        half_space,
        np.zeros(0),
    )
    # material that arrives at x was at the next element upstream one step before
    now = half_space.tangential(found.traction)
    before = half_space.tangential(found.traction, drawn.motion["direction"] * half_space.dx)
    found.slip = found.rigid_slip + (now - before)[:, found.contact] / half_space.dx
    return found


@pytest.fixture(params=SEEDS)
def solution(request: pytest.FixtureRequest) -> Checked:
    return checked(request.param)


def test_every_case_converges() -> None:
    rows = []
    for seed in SEEDS:
        c = checked(seed)
        n = c.result["elements"]
        rows.append(
            f"{seed:3d} {c.drawn.notes} grid {len(c.x):2d} x {len(c.y):2d} stick {n['stick']:4d} "
            f"slip {n['slip']:4d} iterations {c.result['iterations']:3d} "
            f"residual {c.result['residual']:.1e}"
        )
    print("\n" + "\n".join(rows))
    sticking = [checked(s).result["elements"]["stick"] for s in SEEDS]
    sliding = [checked(s).result["elements"]["slip"] for s in SEEDS]
    # the cases reach from full sliding to little slip
    assert min(sticking) == 0
    assert any(a > 5 * b for a, b in zip(sticking, sliding, strict=True))
    assert max(checked(s).result["residual"] for s in SEEDS) <= TOLERANCE


def test_pressure_and_gap(solution: Checked) -> None:
    c = solution
    displacement = c.half_space.normal(c.pressure)
    y, x = np.meshgrid(c.y, c.x, indexing="ij")
    distance = c.drawn.curvatures[0] * x**2 + c.drawn.curvatures[1] * y**2
    gap = (distance + displacement - c.result["approach"]) / displacement.max()
    assert c.pressure.min() >= 0
    touching = float(np.abs(gap[c.contact]).max())
    assert touching <= IMPOSED, c.fail("gap in contact", touching, IMPOSED)
    open_gap = float(gap[~c.contact].min())
    assert open_gap >= -IMPOSED, c.fail("interpenetration", open_gap, IMPOSED)
    area = c.half_space.dx * c.half_space.dy
    force = c.drawn.case["load"]["normal_force"]
    assert c.pressure.sum() * area == pytest.approx(force, rel=1e-9)


def test_traction_keeps_to_the_bound(solution: Checked) -> None:
    c = solution
    assert np.all(c.traction[:, ~c.contact] == 0)
    over = float(np.max(np.hypot(*c.tractions) - c.bound) / c.bound.max())
    assert over <= 1e-12, c.fail("traction over the bound", over, 1e-12)


def test_division_is_of_the_contact(solution: Checked) -> None:
    c = solution
    assert np.array_equal(c.division != EXTERIOR, c.contact)
    names = ("exterior", "stick", "slip")
    counts = dict(zip(names, np.bincount(c.division.ravel(), minlength=3), strict=True))
    assert {name: c.result["elements"][name] for name in names} == counts


def test_stick_and_slip(solution: Checked) -> None:
    c = solution
    division = c.division[c.contact]
    slip = c.stiffness * c.slip  # in Pa
    size, limit = np.hypot(*slip), IMPOSED * c.scale
    stick, sliding = division == STICK, division == SLIP

    residual = float(np.linalg.norm(size[stick]))
    assert residual <= limit, c.fail("slip in stick (Pa)", residual, limit)
    short = float(np.linalg.norm((np.hypot(*c.tractions) - c.bound)[sliding]))
    assert short <= limit, c.fail("traction below the bound in slip (Pa)", short, limit)
    # traction and slip opposite: what of the traction is not along the slip, where that has a way
    (px, py), (sx, sy) = c.tractions, slip
    across = np.abs(px * sy - py * sx) / np.maximum(size, 1e-300)
    weight = np.minimum(1, size / c.bound)
    worst = float(np.linalg.norm((across * weight)[sliding]))
    assert worst <= limit, c.fail("traction across the slip (Pa)", worst, limit)
    power = (c.tractions * slip).sum(axis=0)
    least = float(np.max(power / c.bound))
    assert least <= limit, c.fail("traction along the slip (Pa)", least, limit)


def test_resultants_and_energy(solution: Checked) -> None:
    c = solution
    area = c.half_space.dx * c.half_space.dy
    y, x = np.meshgrid(c.y, c.x, indexing="ij")
    force = c.traction.sum(axis=(1, 2)) * area
    moment = float((x * c.traction[1] - y * c.traction[0]).sum() * area)
    capacity = c.drawn.friction * c.drawn.case["load"]["normal_force"]
    reach = max(np.ptp(c.x), np.ptp(c.y))
    assert np.allclose(c.result["creep_force"], force, rtol=0, atol=1e-12 * capacity)
    assert c.result["spin_moment"] == pytest.approx(moment, abs=1e-12 * capacity * reach)

    speed = c.drawn.motion["rolling_speed"]
    bound = IMPOSED * speed * capacity * float(np.abs(c.rigid_slip).max())
    # the power that the rigid motion supplies; the elements' own dissipation never exceeds it
    motion = c.drawn.motion
    supplied = -speed * (np.dot(force, motion["creepage"]) + moment * motion["spin_creepage"])
    error = abs(c.result["friction_power"] - supplied)
    assert error <= 1e-6 * bound, c.fail("friction power (W)", error, 1e-6 * bound)
    assert c.result["friction_power"] >= 0
    dissipated = -speed * float((c.tractions * c.slip).sum() * area)
    excess = float(dissipated + speed * (c.tractions * c.rigid_slip).sum() * area)
    assert excess <= bound, c.fail("dissipation beyond the supplied power (W)", excess, bound)


def test_micro_slip_field(solution: Checked) -> None:
    c = solution
    given = c.result["micro_slip"]
    assert np.all(given[:, c.division != SLIP] == 0)
    sliding = c.division[c.contact] == SLIP
    error = np.linalg.norm((given[:, c.contact] - c.slip)[:, sliding])
    bound = 1e-9 * np.linalg.norm(c.rigid_slip) + 1e-9 * np.linalg.norm(c.slip)
    assert error <= bound, c.fail("micro-slip", error, bound)


def capacity_of(case: dict[str, Any]) -> float:
    return case["friction"]["coefficient"] * case["load"]["normal_force"]


def wrench(result: railpatch.Result, case: dict[str, Any], length: float) -> Array:
    """Forces over mu F_n and moment over mu F_n times a length."""
    return np.array([*result["creep_force"], result["spin_moment"] / length]) / capacity_of(case)


@pytest.mark.parametrize("seed", SEEDS)
def test_warm_start_equals_cold_start(seed: int) -> None:
    c = checked(seed)
    case, motion = c.drawn.case, c.drawn.motion
    length = max(c.x.max(), c.y.max())
    contact = railpatch.Contact(case)
    # a neighbour, the opposite, and a lighter load come first
    for factor, load in ((1.1, 1.0), (-1.0, 1.0), (0.3, 0.7)):
        contact.step(
            creepage=[factor * v for v in motion["creepage"]],
            spin_creepage=factor * motion["spin_creepage"],
            normal_force=load * case["load"]["normal_force"],
        )
    warm = contact.step(
        creepage=motion["creepage"],
        spin_creepage=motion["spin_creepage"],
        normal_force=case["load"]["normal_force"],
    )
    assert warm.status == "converged"
    difference = wrench(warm, case, length) - wrench(c.result, case, length)
    worst = float(np.abs(difference).max())
    assert worst <= IMPOSED, c.fail("warm minus cold over mu F_n", worst, IMPOSED)


# what happens to creepages, spin, direction; and to forces and moment
SYMMETRIES = {
    "turned by half a turn": ((-1, -1, 1, -1), (-1, -1, 1)),
    "mirrored at y = 0": ((1, -1, -1, 1), (1, -1, -1)),
    "mirrored at x = 0": ((-1, 1, -1, -1), (-1, 1, -1)),
    "friction the other way": ((-1, -1, -1, 1), (-1, -1, -1)),
}


@pytest.mark.parametrize("name", SYMMETRIES)
@pytest.mark.parametrize("seed", SEEDS)
def test_symmetry(seed: int, name: str) -> None:
    c = checked(seed)
    case, motion = c.drawn.case, c.drawn.motion
    (sx, sy, spin, way), signs = SYMMETRIES[name]
    image = {
        **case,
        "motion": {
            **motion,
            "creepage": [sx * motion["creepage"][0], sy * motion["creepage"][1]],
            "spin_creepage": spin * motion["spin_creepage"],
            "direction": way * motion["direction"],
        },
    }
    length = max(c.x.max(), c.y.max())
    found = wrench(solve(image), case, length)
    worst = float(np.abs(found - np.array(signs) * wrench(c.result, case, length)).max())
    assert worst <= IMPOSED, c.fail(f"{name}: difference over mu F_n", worst, IMPOSED)
