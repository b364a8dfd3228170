"""Contact conditions of random cases of unlike bodies, by code that shares nothing with the solver.

Conditions as in test_contact_conditions.py; with (1 - 2 nu)/G different for wheel and rail pressure
moves the surfaces along each other and traction moves them apart (Kalker 1990, section 1.4).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
import pytest
import railpatch
from patch_cases import patch_case, solve
from railpatch.evidence.stress.half_space import Array, HalfSpace

SEEDS = range(24)
TOLERANCE = 1e-6
# the solver measures its residuals over all elements together; allow for another way of measuring
IMPOSED = 10 * TOLERANCE
STICK, SLIP = 1, 2


@dataclass
class Bodies:
    """Elastic constants of wheel and rail, and combined (Kalker 1990, eq. 1.44)."""

    shear_modulus: list[float]
    poisson_ratio: list[float]

    @property
    def combined(self) -> tuple[float, float, float]:
        (gw, gr), (nw, nr) = self.shear_modulus, self.poisson_ratio
        g = 2 / (1 / gw + 1 / gr)
        return g, g / 2 * (nw / gw + nr / gr), g / 4 * ((1 - 2 * nw) / gw - (1 - 2 * nr) / gr)

    @property
    def table(self) -> dict[str, Any]:
        return {"shear_modulus": self.shear_modulus, "poisson_ratio": self.poisson_ratio}

    def exchanged(self) -> Bodies:
        return Bodies(self.shear_modulus[::-1], self.poisson_ratio[::-1])


@dataclass
class Draw:
    """A random case with its own copy of what the conditions need."""

    case: dict[str, Any]
    bodies: Bodies
    curvatures: list[float]
    friction: float

    @property
    def rigid(self) -> tuple[list[float], float, int]:
        motion = self.case["motion"]
        return motion["creepage"], motion["spin_creepage"], motion["direction"]


def draw(seed: int) -> Draw:
    rng = np.random.default_rng([20241121, seed])
    if seed % 3 == 0:  # a rigid rail or wheel, the other compressible
        bodies = Bodies([82e9, 1e15], [float(rng.uniform(0, 0.3)), 0.3])
    else:
        other = 82e9 * 10 ** rng.uniform(-2, 2)
        bodies = Bodies([82e9, other], [float(v) for v in rng.uniform(0, 0.5, 2)])
    if rng.random() < 0.5:
        bodies = bodies.exchanged()
    g, nu, _ = bodies.combined
    curvatures = [float(v) for v in 10 ** rng.uniform(-0.5, 0.5, 2)]
    force, friction = float(10 ** rng.uniform(3.5, 5.3)), float(10 ** rng.uniform(-2, 0.3))
    # from near stick to full sliding, in units of the creepage where the linear theory saturates
    radius = np.cbrt(3 * force * (1 - nu) / (4 * g * sum(curvatures)))
    size = friction * force / (4 * g * radius**2) * 10 ** rng.uniform(-1.3, 1.3)
    angle = rng.uniform(0, 2 * np.pi)
    spin = float(rng.choice([0.0, 1.0]) * rng.normal() * size / radius)
    case = patch_case(
        {"curvatures": curvatures},
        force=force,
        elements=[int(rng.integers(10, 25)), int(rng.integers(10, 25))],
        creepage=[size * np.cos(angle), size * np.sin(angle)],
        spin=spin,
        direction=int(rng.choice([-1, 1])),
        friction=friction,
        material=bodies.table,
        tolerance=TOLERANCE,
    )
    return Draw(case, bodies, curvatures, friction)


@dataclass
class Checked:
    """A solution with the displacements of independent code."""

    drawn: Draw
    result: railpatch.Result
    half_space: HalfSpace
    slip: Array  # [2, N] on the elements in contact
    supplied: Array  # the part of it that the tractions do not cause

    @property
    def contact(self) -> Array:
        return self.result["pressure"] > 0

    @property
    def bound(self) -> Array:
        return self.drawn.friction * self.result["pressure"][self.contact]

    @property
    def tractions(self) -> Array:
        return self.result["traction"][:, self.contact]


@cache
def checked(seed: int) -> Checked:
    drawn = draw(seed)
    result = solve(drawn.case, fields=True)
    pressure, traction = result["pressure"], result["traction"]
    g, nu, mismatch = drawn.bodies.combined
    dx, dy = (np.diff(result[axis])[0] for axis in "xy")
    h = HalfSpace(pressure.shape, dx, dy, g, nu, mismatch=mismatch)
    mask = pressure > 0
    (xi, eta), phi, direction = drawn.rigid
    y, x = np.meshgrid(result["y"], result["x"], indexing="ij")
    # the spin is read a quarter of an element upstream
    supplied = np.array([xi - phi * y, eta + phi * (x + 0.25 * direction * dx)])
    supplied += (h.from_pressure(pressure) - h.from_pressure(pressure, direction * dx)) / dx
    slip = supplied + (h.tangential(traction) - h.tangential(traction, direction * dx)) / dx
    return Checked(drawn, result, h, slip[:, mask], supplied[:, mask])


@pytest.fixture(params=SEEDS)
def solution(request: pytest.FixtureRequest) -> Checked:
    return checked(request.param)


def test_pressure_and_gap(solution: Checked) -> None:
    c, h = solution, solution.half_space
    pressure = c.result["pressure"]
    by_pressure = h.normal(pressure)
    y, x = np.meshgrid(c.result["y"], c.result["x"], indexing="ij")
    distance = c.drawn.curvatures[0] * x**2 + c.drawn.curvatures[1] * y**2
    moved = by_pressure + h.from_traction(c.result["traction"])
    gap = (distance + moved - c.result["approach"]) / by_pressure.max()
    assert pressure.min() >= 0
    assert np.abs(gap[c.contact]).max() <= IMPOSED
    assert gap[~c.contact].min() >= -IMPOSED
    force = c.drawn.case["load"]["normal_force"]
    assert pressure.sum() * h.dx * h.dy == pytest.approx(force, rel=1e-9)


def test_stick_and_slip(solution: Checked) -> None:
    c, h = solution, solution.half_space
    division = c.result["element_division"][c.contact]
    stick, sliding = division == STICK, division == SLIP
    stiffness = h.dx / h.flexibility(c.drawn.rigid[2] * h.dx)
    slip = stiffness * c.slip  # in Pa
    size = np.hypot(*slip)
    asked = stiffness * np.hypot(*c.supplied)
    limit = IMPOSED * float(np.linalg.norm(np.minimum(c.bound, asked)))
    assert np.linalg.norm(size[stick]) <= limit
    assert np.linalg.norm((np.hypot(*c.tractions) - c.bound)[sliding]) <= limit
    assert np.max(np.hypot(*c.tractions) - c.bound) <= 1e-12 * c.bound.max()
    (px, py), (sx, sy) = c.tractions, slip
    across = np.abs(px * sy - py * sx) / np.maximum(size, 1e-300) * np.minimum(1, size / c.bound)
    assert np.linalg.norm(across[sliding]) <= limit
    assert np.max((c.tractions * slip).sum(axis=0) / c.bound) <= limit


def test_power_and_energy(solution: Checked) -> None:
    c, h = solution, solution.half_space
    area, speed = h.dx * h.dy, c.drawn.case["motion"]["rolling_speed"]
    pressure, traction = c.result["pressure"], c.result["traction"]
    # the power of the tractions on all slip that they do not cause themselves: on the rigid slip at
    # the elements, as force and moment are summed, and on what the pressure causes by the mean of
    # both ends of the material's way from element to element
    (xi, eta), phi, direction = c.drawn.rigid
    y, x = np.meshgrid(c.result["y"], c.result["x"], indexing="ij")
    rigid = np.array([xi - phi * y, eta + phi * x])
    pressed = (h.from_pressure(pressure) - h.from_pressure(pressure, direction * h.dx)) / h.dx
    before = np.zeros_like(traction)
    ahead, behind = (slice(1, None), slice(None, -1))[::direction]
    before[..., behind] = traction[..., ahead]
    work = traction * rigid + 0.5 * (traction + before) * pressed
    supplied = max(0.0, -speed * float(work.sum() * area))
    scale = speed * float(c.bound.sum() * area * np.abs(c.supplied).max())
    assert c.result["friction_power"] == pytest.approx(supplied, abs=1e-6 * scale)
    assert c.result["friction_power"] >= 0
    moved = h.normal(pressure) + h.from_traction(traction)
    along = h.tangential(traction) + h.from_pressure(pressure)
    energy = float((pressure * moved).sum() + (traction * along).sum()) * area / 2
    assert c.result["elastic_energy"] == pytest.approx(energy, rel=IMPOSED)


def wrench(result: railpatch.Result, case: dict[str, Any]) -> Array:
    """Forces over mu F_n, moment over mu F_n times a millimetre."""
    capacity = case["friction"]["coefficient"] * case["load"]["normal_force"]
    return np.array([*result["creep_force"], result["spin_moment"] / 1e-3]) / capacity


# what happens to creepages, spin, direction; and to forces and moment. Friction the other way is a
# symmetry of like bodies alone: it turns the tractions over and not the pressure.
SYMMETRIES = {
    "turned by half a turn": ((-1, -1, 1, -1), (-1, -1, 1)),
    "mirrored at y = 0": ((1, -1, -1, 1), (1, -1, -1)),
    "mirrored at x = 0": ((-1, 1, -1, -1), (-1, 1, -1)),
}


def moved_by(case: dict[str, Any], signs: tuple[int, int, int, int]) -> dict[str, Any]:
    sx, sy, spin, way = signs
    motion = case["motion"]
    creepage = [sx * motion["creepage"][0], sy * motion["creepage"][1]]
    changed = {
        "creepage": creepage,
        "spin_creepage": spin * motion["spin_creepage"],
        "direction": way * motion["direction"],
    }
    return {**case, "motion": {**motion, **changed}}


@pytest.mark.parametrize("name", SYMMETRIES)
@pytest.mark.parametrize("seed", SEEDS)
def test_symmetry(seed: int, name: str) -> None:
    c = checked(seed)
    motion, signs = SYMMETRIES[name]
    found = wrench(solve(moved_by(c.drawn.case, motion)), c.drawn.case)
    error = np.abs(found - np.array(signs) * wrench(c.result, c.drawn.case)).max()
    assert error <= 20 * IMPOSED


@pytest.mark.parametrize("seed", SEEDS)
def test_exchanged_bodies(seed: int) -> None:
    """K changes its sign: with creepages and spin reversed, tractions are reversed."""
    c = checked(seed)
    image = moved_by(c.drawn.case, (-1, -1, -1, 1))
    image["material"] = c.drawn.bodies.exchanged().table
    result = solve(image)
    assert np.abs(wrench(result, image) + wrench(c.result, image)).max() <= 20 * IMPOSED
    assert result["approach"] == pytest.approx(c.result["approach"], rel=20 * IMPOSED)


@pytest.mark.parametrize("seed", SEEDS[:8])
def test_warm_start_equals_cold_start(seed: int) -> None:
    c = checked(seed)
    case, motion = c.drawn.case, c.drawn.case["motion"]
    contact = railpatch.Contact(case)
    for factor, load in ((1.1, 1.0), (-1.0, 1.0), (0.3, 0.7), (1.0, 1.0)):
        warm = contact.step(
            creepage=[factor * v for v in motion["creepage"]],
            spin_creepage=factor * motion["spin_creepage"],
            normal_force=load * case["load"]["normal_force"],
        )
        assert warm.status == "converged"
    assert np.abs(wrench(warm, case) - wrench(c.result, case)).max() <= 20 * IMPOSED


def test_like_bodies_are_the_limit() -> None:
    """As K tends to 0 the solution tends to that of like bodies, linearly."""
    shape = {"curvatures": [1.0, 1.0]}
    shared = {"force": 1e4, "element_size": [2.5e-4, 2.5e-4], "creepage": [2e-4, 1e-4]}

    def forces(nu: list[float]) -> Array:
        material = {"shear_modulus": [82e9, 82e9], "poisson_ratio": nu}
        case = patch_case(shape, **shared, material=material, tolerance=1e-10)
        return wrench(solve(case), case)

    # the combined Poisson's ratio stays the same
    like = forces([0.28, 0.28])
    changes = [np.abs(forces([0.28 - d, 0.28 + d]) - like).max() for d in (1e-2, 1e-3, 1e-4, 1e-6)]
    print(f"\nchanges of the force {changes}")
    assert changes[0] > 1e-4
    ratios = np.array(changes[:-1]) / np.array(changes[1:])
    assert np.allclose(ratios, [10, 10, 100], rtol=0.05)


def test_without_friction_nothing_is_transferred() -> None:
    c = draw(0)
    c.case["friction"]["coefficient"] = 0.0
    result = solve(c.case, fields=True)
    assert np.all(result["traction"] == 0)
    like = {**c.case, "motion": {"regime": "none"}}
    del like["friction"]
    assert result["approach"] == pytest.approx(solve(like)["approach"], rel=IMPOSED)


def test_standstill_transfers_nothing() -> None:
    case = draw(1).case
    case["motion"]["rolling_speed"] = 0.0
    result = solve(case)
    assert result["creep_force"] == pytest.approx([0, 0], abs=0)
