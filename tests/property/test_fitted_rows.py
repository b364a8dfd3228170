"""Fitted rows in random cases: their conditions by code that shares nothing with the solver.

Kalker 1990, Three-dimensional elastic bodies in rolling contact, chapter 1, on the nodes of rows
(fitted_rows.py of the package's stress program): stick has no slip at the point half a step ahead,
slip has the bound against a slip between those of the two points around the node.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
import pytest
import railpatch
from patch_cases import patch_case, solve
from railpatch.evidence.stress.fitted_rows import Rows, rigid_slip
from railpatch.evidence.stress.half_space import Array

SEEDS = range(40)
TOLERANCE = 1e-7
SHEAR_MODULUS = 82e9
STICK, SLIP = 1, 2
# micro-slip of the rows against rectangles, over the largest slip that the motion or the bound asks
# for: the rows' own quadrature where stick ends
OF_SLIP = 0.02


@dataclass
class Draw:
    seed: int
    case: dict[str, Any]
    friction: float
    poisson_ratio: float
    layer: float
    length: float

    @property
    def motion(self) -> dict[str, Any]:
        return self.case["motion"]

    @property
    def force(self) -> float:
        return self.case["load"]["normal_force"]

    @property
    def capacity(self) -> float:
        return self.friction * self.force


def draw(seed: int) -> Draw:
    rng = np.random.default_rng([20240911, seed])
    length = 10 ** rng.uniform(-3, -2)
    ratio = 5 ** rng.uniform(-1, 1)
    force, friction = 10 ** rng.uniform(3.5, 5.3), rng.uniform(0.05, 0.6)
    nu = float(rng.uniform(0, 0.5))
    # from near stick to full sliding, in units of the creepage where the linear theory saturates
    unit = friction * force / (4 * SHEAR_MODULUS * length**2)
    size = 10 ** rng.uniform(-1.0, 1.3) * unit
    angle = rng.uniform(0, 2 * np.pi)
    spin = float(rng.choice([0.0, 1.0]) * rng.normal() * size / length)
    layer = None
    if rng.random() < 0.35:
        layer = {"shear_modulus": 8.2e9, "thickness": float(10 ** rng.uniform(-6, -3))}
    case = patch_case(
        {"semi_axes": [length * ratio**0.5, length * ratio**-0.5]},
        force=force,
        fitted=[int(rng.integers(8, 17)), int(rng.integers(8, 17))],
        creepage=[float(size * np.cos(angle)), float(size * np.sin(angle))],
        spin=spin,
        direction=int(rng.choice([-1, 1])),
        friction=friction,
        material={"shear_modulus": SHEAR_MODULUS, "poisson_ratio": nu},
        layer=layer,
        tolerance=TOLERANCE,
        normal="hertz",
    )
    flexibility = layer["thickness"] / layer["shear_modulus"] if layer else 0.0
    return Draw(seed, case, friction, nu, flexibility, length)


@dataclass
class Checked:
    drawn: Draw
    result: railpatch.Result
    rows: Rows
    bound: Array  # [rows, n]
    points: Array  # [2, rows, n + 1], slip at the points, from the leading edge

    def fail(self, what: str, value: float, bound: float) -> str:
        return f"seed {self.drawn.seed}: {what} {value:.3e}, bound {bound:.3e}: {self.drawn.case}"

    @property
    def direction(self) -> int:
        return self.drawn.motion["direction"]

    @property
    def scale(self) -> float:
        """Slip: the largest of the motion, or of the bound's own displacement in a long strip: its
        slope is 2 (1 - nu) mu p0/G at the edge (Johnson 1985, section 8.3)."""
        rigid = rigid_slip(self.drawn.motion, self.rows.x, self.rows.y[:, None])
        elastic = 2 * (1 - self.drawn.poisson_ratio) * self.bound.max() / SHEAR_MODULUS
        return float(max(np.hypot(*rigid).max(), elastic))


@cache
def checked(seed: int) -> Checked:
    drawn = draw(seed)
    result = solve(drawn.case, fields=True)
    rows = Rows(result["x"], result["y"], result["traction"])
    direction = drawn.motion["direction"]
    slope = rows.slope(direction, SHEAR_MODULUS, drawn.poisson_ratio, drawn.layer)
    rigid = rigid_slip(drawn.motion, rows.points(direction), rows.y[:, None])
    bound = drawn.friction * result["pressure"]
    return Checked(drawn, result, rows, bound, rigid - direction * slope)


@pytest.fixture(params=SEEDS)
def solution(request: pytest.FixtureRequest) -> Checked:
    return checked(request.param)


def test_cases_reach_from_stick_to_sliding() -> None:
    stick = np.array([checked(s).result["elements"]["stick"] for s in SEEDS])
    slip = np.array([checked(s).result["elements"]["slip"] for s in SEEDS])
    print("\n", *zip(stick, slip, strict=True))
    assert stick.min() == 0
    assert np.any(stick > 2 * slip)
    assert np.sum((stick > slip / 5) & (slip > stick / 5)) >= 5
    assert max(checked(s).result["residual"] for s in SEEDS) <= TOLERANCE


def test_pressure_carries_the_load(solution: Checked) -> None:
    c = solution
    force = float((c.result["pressure"] * c.rows.areas).sum())
    assert force == pytest.approx(c.drawn.force, rel=1e-9)
    assert c.result["pressure"].min() > 0


def test_stick_and_slip(solution: Checked) -> None:
    c = solution
    size = np.hypot(*c.rows.traction)
    assert np.all(size <= c.bound * (1 + 1e-9))
    division, given = c.result["element_division"], c.result["micro_slip"]
    assert np.all((division == STICK) | (division == SLIP))
    counts = {"stick": int((division == STICK).sum()), "slip": int((division == SLIP).sum())}
    assert {name: c.result["elements"][name] for name in counts} == counts
    sliding = division == SLIP
    assert np.all(given[:, ~sliding] == 0)
    # the solver's residual is a traction: shares of the greatest bound
    limit = 100 * TOLERANCE
    short = float(((c.bound - size)[sliding] / c.bound.max()).max(initial=0.0))
    assert short <= limit, c.fail("traction below the bound in slip", short, limit)
    (px, py), (sx, sy) = c.rows.traction, given
    slip = np.hypot(sx, sy)
    # where the slip is next to nothing its way is not known: weight with slip as a traction
    weight = np.minimum(1, SHEAR_MODULUS * slip / c.bound.max())
    across = np.abs(px * sy - py * sx) / np.maximum(slip, 1e-300) / c.bound.max() * weight
    worst = float(across[sliding].max(initial=0.0))
    assert worst <= limit, c.fail("traction across the slip", worst, limit)
    assert np.all((px * sx + py * sy)[sliding] <= 0)


def test_slip_by_rectangles(solution: Checked) -> None:
    c = solution
    division = c.rows.from_leading_edge(c.result["element_division"], c.direction)
    given = c.rows.from_leading_edge(c.result["micro_slip"], c.direction)
    ahead, behind = c.points[:, :, :-1], c.points[:, :, 1:]
    limit = OF_SLIP * c.scale
    stick = float(np.hypot(*ahead)[division == STICK].max(initial=0.0))
    # distance of the given slip from the way between the two points' slips
    way = behind - ahead
    share = ((given - ahead) * way).sum(axis=0) / np.maximum((way**2).sum(axis=0), 1e-300)
    off = np.hypot(*(given - ahead - np.clip(share, 0, 1) * way))
    slip = float(off[division == SLIP].max(initial=0.0))
    print(f"seed {c.drawn.seed}: {stick / c.scale:.4f} {slip / c.scale:.4f}")
    assert stick <= limit, c.fail("slip in stick", stick, limit)
    assert slip <= limit, c.fail("micro-slip", slip, limit)


def test_resultants_and_power(solution: Checked) -> None:
    c = solution
    areas, (px, py) = c.rows.areas, c.rows.traction
    force = [float((p * areas).sum()) for p in (px, py)]
    moment = float(((c.rows.x * py - c.rows.y[:, None] * px) * areas).sum())
    capacity, motion = c.drawn.capacity, c.drawn.motion
    reach = float(np.abs(c.rows.x).max() + np.abs(c.rows.y).max())
    assert np.allclose(c.result["creep_force"], force, rtol=0, atol=1e-9 * capacity)
    assert c.result["spin_moment"] == pytest.approx(moment, abs=1e-9 * capacity * reach)
    work = np.dot(c.result["creep_force"], motion["creepage"])
    work += c.result["spin_moment"] * motion["spin_creepage"]
    assert c.result["friction_power"] == pytest.approx(-motion["rolling_speed"] * work, rel=1e-9)
    assert c.result["friction_power"] >= 0


# --- symmetries --------------------------------------------------------------------------------


def wrench(result: railpatch.Result, drawn: Draw) -> Array:
    return np.array([*result["creep_force"], result["spin_moment"] / drawn.length]) / drawn.capacity


# what happens to creepages, spin, direction; and to forces and moment
SYMMETRIES = {
    "mirrored at y = 0": ((1, -1, -1, 1), (1, -1, -1)),
    "mirrored at x = 0": ((-1, 1, -1, -1), (-1, 1, -1)),
    "turned by half a turn": ((-1, -1, 1, -1), (-1, -1, 1)),
    "friction the other way": ((-1, -1, -1, 1), (-1, -1, -1)),
}


@pytest.mark.parametrize("name", SYMMETRIES)
def test_symmetry(solution: Checked, name: str) -> None:
    c, motion = solution, solution.drawn.motion
    (sx, sy, spin, way), signs = SYMMETRIES[name]
    moved = {
        **motion,
        "creepage": [sx * motion["creepage"][0], sy * motion["creepage"][1]],
        "spin_creepage": spin * motion["spin_creepage"],
        "direction": way * motion["direction"],
    }
    image = wrench(solve({**c.drawn.case, "motion": moved}), c.drawn)
    worst = float(np.abs(image - np.array(signs) * wrench(c.result, c.drawn)).max())
    assert worst <= 1e-6, c.fail(name, worst, 1e-6)


@pytest.mark.parametrize("seed", range(0, 40, 4))
def test_units_do_not_matter(seed: int) -> None:
    c = checked(seed)
    case, motion = c.drawn.case, c.drawn.motion
    layer = case.get("layer")
    scaled = patch_case(
        {"semi_axes": [10 * v for v in case["geometry"]["semi_axes"]]},
        force=1e3 * c.drawn.force,
        fitted=case["grid"]["fitted"],
        creepage=motion["creepage"],
        spin=motion["spin_creepage"] / 10,
        direction=motion["direction"],
        friction=c.drawn.friction,
        material={"shear_modulus": 10 * SHEAR_MODULUS, "poisson_ratio": c.drawn.poisson_ratio},
        layer=None
        if layer is None
        else {"shear_modulus": 10 * layer["shear_modulus"], "thickness": 10 * layer["thickness"]},
        tolerance=TOLERANCE,
        normal="hertz",
    )
    result = solve(scaled)
    found = np.array([*result["creep_force"], result["spin_moment"] / 10 / c.drawn.length])
    worst = float(np.abs(found / 1e3 / c.drawn.capacity - wrench(c.result, c.drawn)).max())
    assert worst <= 1e-6, c.fail("ten times the length and the stiffness", worst, 1e-6)


@pytest.mark.parametrize("seed", SEEDS)
def test_warm_start_equals_cold_start(seed: int) -> None:
    c = checked(seed)
    rng = np.random.default_rng([20240912, seed])
    motion, contact = c.drawn.motion, railpatch.Contact(c.drawn.case)
    size = float(np.hypot(*motion["creepage"]))
    for _ in range(3):
        before = contact.step(
            creepage=[float(v) for v in size * rng.normal(size=2)],
            spin_creepage=float(size / c.drawn.length * rng.normal()),
            normal_force=c.drawn.force * float(rng.uniform(0.3, 2)),
            direction=int(rng.choice([-1, 1])),
        )
        assert before.status == "converged"
    warm = contact.step(
        creepage=motion["creepage"],
        spin_creepage=motion["spin_creepage"],
        normal_force=c.drawn.force,
        direction=motion["direction"],
    )
    assert warm.status == "converged"
    worst = float(np.abs(wrench(warm, c.drawn) - wrench(c.result, c.drawn)).max())
    assert worst <= 1e-5, c.fail("warm minus cold over mu F_n", worst, 1e-5)


# --- smoothness --------------------------------------------------------------------------------


def sweep(changes: list[dict[str, Any]], case: dict[str, Any]) -> Array:
    contact = railpatch.Contact(case)
    values = []
    for change in changes:
        result = contact.step(**change)
        assert result.status == "converged"
        values.append([*result["creep_force"], result["spin_moment"] / 5e-3])
    return np.array(values)


@pytest.mark.parametrize("name", ["load", "creepage", "spin"])
def test_forces_change_without_jumps(name: str) -> None:
    """A jump would be a step many times the ones beside it; steps change by parts of themselves."""
    case = patch_case(
        {"curvatures": [1.0, 1.3]},
        force=5e4,
        fitted=[8, 8],
        creepage=[8e-4, -4e-4],
        spin=0.1,
        tolerance=1e-9,
        normal="hertz",
    )
    changes = {
        "load": [{"normal_force": v} for v in np.linspace(4e4, 8e4, 401)],
        "creepage": [{"creepage": [float(v), -4e-4]} for v in np.linspace(1e-4, 3e-3, 401)],
        "spin": [{"spin_creepage": float(v)} for v in np.linspace(0.0, 0.6, 401)],
    }[name]
    values = sweep(changes, case)
    steps = np.linalg.norm(np.diff(values, axis=0), axis=1)
    bends = np.linalg.norm(np.diff(values, n=2, axis=0), axis=1)
    print(f"\n{name}: greatest step over median {steps.max() / np.median(steps):.2f}")
    print(f"greatest change of a step over the greatest step {bends.max() / steps.max():.2f}")
    assert bends.max() <= 0.5 * steps.max()
