"""Viscoelastic bodies in steady rolling: standard linear solids on the half-space.

The rolling of a cylinder against its closed form (Hunter 1961, J. Appl. Mech. 28; derived below),
slow and fast rolling against elastic bodies of compliance (1 + f)/G and 1/G, the conditions of
contact and friction and the bodies' power by dense sums of influence coefficients under the
history's integral, which share nothing with the core.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import railpatch
from numpy.typing import NDArray
from railpatch import CaseError, Contact
from railpatch.case.load import load_scene
from railpatch.fmu.pack import check_regime
from scipy.optimize import brentq
from scipy.special import ive, kve

Array = NDArray[np.float64]

SHEAR, POISSON, RATIO, SPEED = 5e6, 0.5, 3.0, 10.0
RADIUS, WIDTH, FORCE = 0.1, 0.05, 400.0
TIMES = [1e-4, 5e-4, 1e-3, 3e-3, 1e-2, 1e-1]


def rubber(time: float, ratio: Any = RATIO, shear: Any = SHEAR) -> dict[str, Any]:
    found = {"shear_modulus": shear, "poisson_ratio": POISSON}
    return found | {"viscoelastic_ratio": ratio, "relaxation_time": time} if time else found


def cylinder(material: dict[str, Any], elements: int, **motion: Any) -> dict[str, Any]:
    return {
        "kind": "patch",
        "material": material,
        "geometry": {"line_contact_radius": RADIUS, "width": WIDTH},
        "load": {"normal_force": FORCE},
        "grid": {"elements": [elements, 1]},
        "motion": {"rolling_speed": SPEED, **motion},
        "method": {"normal": "half_space", "tangential": "none", "tolerance": 1e-10},
    }


DX, DY = 1.4e-3, 2e-3
X, Y = DX * (np.arange(24) - 11.5), DY * (np.arange(18) - 8.5)
GAP = 5.0 * X**2 + 4.0 * Y[:, None] ** 2


def ball(material: dict[str, Any], **more: Any) -> dict[str, Any]:
    """With creepage and spin, so that much sticks and much slips."""
    return {
        "kind": "patch",
        "material": material,
        "geometry": {"undeformed_distance": GAP.tolist()},
        "load": {"normal_force": 100.0},
        "grid": {"element_size": [DX, DY]},
        "motion": {"creepage": [-0.01, 0.004], "spin_creepage": 0.3, "rolling_speed": SPEED},
        "friction": {"coefficient": 0.4},
        "method": {"normal": "half_space", "tolerance": 1e-11, "spin_offset": "none"},
    } | more


def round_ball(material: dict[str, Any], elements: int) -> dict[str, Any]:
    return ball(
        material, geometry={"curvatures": [5.0, 4.0]}, grid={"elements": [elements, elements]}
    )


def patch_of(case: dict[str, Any], *, fields: bool = False) -> Any:
    result = railpatch.solve(case, fields=fields)
    assert result.good, result.reason
    if all(ratio > 0 for ratio in np.ravel(case["material"].get("viscoelastic_ratio", 0))):
        # rubber is soft
        assert not any("shear_modulus" in text for text in result.warnings)
    return result


def hunter(load: float, length: float) -> tuple[float, float, float]:
    """Half width (m), middle ahead of the axis (m) and moment (N) of a cylinder, per width.

    With places x ahead of the axis, L = V tau and D = 1 - L d/dx the surface's slope u' has
    D u' = -c int q/(x - t) dt, q = (1 + f) p - L p', c = 2 (1 - nu)/(pi G), and -x/R + L/R where
    the bodies touch, m - a < x < m + a. With y = x - m the Cauchy integral has the solutions
      q = K ((a^2 - y^2) - (m - L) y + C)/(a^2 - y^2)^(1/2), K = 1/(pi c R).
    p = 0 at the trailing edge, and u' = -x/R at the leading one, where D leaves a part exp(x/L)
    open, give C and m by Bessel functions of a/L and (1 + f) a/L; the sums of q load and moment.
    """
    k = RADIUS * 2 * (1 - POISSON) / SHEAR

    def of(a: float) -> tuple[float, float, float]:
        ahead = kve(1, a / length) / kve(0, a / length)
        behind = ive(0, (1 + RATIO) * a / length) / ive(1, (1 + RATIO) * a / length)
        m = length * RATIO / (1 + RATIO) / (1 + ahead * behind)
        c = m * a * ahead
        n = np.pi / k * (a * a / 2 + c) / (1 + RATIO)
        turn = m * n + (np.pi / k * (length - m) * a * a / 2 - length * n) / (1 + RATIO)
        return n, m, turn

    a = brentq(lambda half: of(half)[0] - load, 1e-6, 1.0, xtol=1e-15, rtol=1e-14)
    return (a, *of(a)[1:])


def by_edges(load: float, half: float, size: float) -> float:
    """N m: what elements of a size (m) leave open of the moment, and of the power times radius over
    speed, of a load (N) on a half width (m).

    An edge of contact lies anywhere within an element: by (size/2 half)^2 of load times half width
    the load's middle is off. The power, by central differences of displacements, has beside it the
    pressure of each edge's last element times the gap at the next: with the edge s before and t
    behind their centres 0.42 s^(1/2) t^(3/2)/half^2 of the same after Hertz, 0.14 (size/half)^2 at
    most. Both together are a half (size/half)^2.
    """
    return 0.5 * load * size**2 / half


@pytest.mark.parametrize("time", TIMES)
def test_rolling_resistance_of_a_cylinder(time: float) -> None:
    """Over Deborah numbers V tau/a of 0.05 to 100, with errors of second order."""
    half, _, turn = hunter(FORCE / WIDTH, SPEED * time)
    for elements in (40, 160):
        found = patch_of(cylinder(rubber(time), elements), fields=True)
        size = np.diff(np.unique(found["x"]))[0]
        within = by_edges(FORCE, half, size)
        assert found["rolling_resistance_moment"] == pytest.approx(WIDTH * turn, abs=within / 2)
        lost = found["viscous_power"] * RADIUS / SPEED
        assert lost == pytest.approx(WIDTH * turn, abs=within)
        # one element at each edge
        assert found["contact_size"][0] == pytest.approx(2 * half, abs=2 * size)


def heat_of_dashpots(pressure: Array, size: float, length: float) -> float:
    """W/m of elements' pressure (Pa) on a line: traction times rate of the springs beside them.

    Of the wave k the second springs yield v = f A p/(1 + (k L)^2)^(1/2) in length, with A =
    2 (1 - nu)/(G k) of both bodies (Johnson 1985, Contact Mechanics, 13.3), and the dashpots, L v
    k/(f A) each, take V L k^2 |v|^2/(f A). Gauss-Legendre on panels of the wave as long as the
    grid, and shorter ones about 1/L; beyond 30 waves an element all but nothing is left.
    """
    edges = np.linspace(0.0, 60 * np.pi / size, 30 * pressure.size + 1)
    edges = np.union1d(edges, np.geomspace(0.01, 100.0, 40) / length)
    node, weight = np.polynomial.legendre.leggauss(6)
    low, high = edges[:-1, None], edges[1:, None]
    k = ((low + high) / 2 + (high - low) / 2 * node).ravel()
    places = size * np.arange(pressure.size)
    waves = np.exp(-1j * np.outer(k, places)) @ pressure * size * np.sinc(k * size / 2 / np.pi)
    flexibility = RATIO * 2 * (1 - POISSON) / SHEAR
    lost = flexibility * length * k / (1 + (k * length) ** 2) * np.abs(waves) ** 2
    return SPEED / np.pi * float(((high - low) / 2 * weight).ravel() @ lost)


@pytest.mark.parametrize("time", TIMES)
def test_resistance_does_the_work_that_dashpots_turn_into_heat(time: float) -> None:
    half = hunter(FORCE / WIDTH, SPEED * time)[0]
    for elements in (40, 160):
        found = patch_of(cylinder(rubber(time), elements), fields=True)
        size = np.diff(np.unique(found["x"]))[0]
        heat = WIDTH * heat_of_dashpots(found["pressure"].ravel(), size, SPEED * time)
        within = by_edges(FORCE, half, size) * SPEED / RADIUS
        assert found["viscous_power"] == pytest.approx(heat, abs=within)
        work = found["rolling_resistance_moment"] * SPEED / RADIUS
        assert work == pytest.approx(heat, abs=within)


def test_the_resistance_has_its_peak_between() -> None:
    """At V tau of about a, after Hunter, and as good as nothing at either end: by L/a = 1e-6 and
    a/L = 1e-8."""
    turns = np.array([hunter(FORCE / WIDTH, SPEED * time)[2] for time in TIMES])
    found = [patch_of(cylinder(rubber(time), 80))["rolling_resistance_moment"] for time in TIMES]
    assert (np.sign(np.diff(found)) == np.sign(np.diff(turns))).all()
    top = int(np.argmax(found))
    assert 0.3 < SPEED * TIMES[top] / hunter(FORCE / WIDTH, SPEED * TIMES[top])[0] < 5
    for time in (1e-9, 1e5):
        end = patch_of(cylinder(rubber(time), 80))["rolling_resistance_moment"]
        assert abs(end) < 1e-5 * max(found)


@pytest.mark.parametrize("direction", [1, -1])
def test_slow_and_fast_rolling_are_elastic(direction: int) -> None:
    """G/(1 + f) and G, by the elastic solvers on the same grid. What is left is L over the element,
    1e-9, of slow and f (a/L) ln(L/a) = 7e-8 of fast rolling; the spin moment, in which most
    tractions cancel, in terms of a force at the arm of an element."""
    motion = ball({})["motion"] | {"direction": direction}
    for time, shear in ((1e-13, SHEAR / (1 + RATIO)), (1e6, SHEAR)):
        soft = patch_of(ball(rubber(time), motion=motion))
        hard = patch_of(ball(rubber(0.0, shear=shear), motion=motion))
        for name in ("creep_force", "normal_force", "max_pressure", "approach"):
            assert soft[name] == pytest.approx(hard[name], rel=2e-7), (name, time)
        arm = 2e-7 * np.hypot(*hard["creep_force"]) * DX
        assert soft["spin_moment"] == pytest.approx(hard["spin_moment"], abs=arm)
        for division in ("stick", "slip"):
            assert soft["elements"][division] == hard["elements"][division]
        assert abs(soft["viscous_power"]) < 1e-6 * hard["friction_power"]
        assert soft["friction_power"] == pytest.approx(hard["friction_power"], rel=1e-6)


def test_a_body_at_rest_has_yielded() -> None:
    still = patch_of(cylinder(rubber(1e-3), 40, rolling_speed=0.0))
    soft = cylinder(rubber(0.0, shear=SHEAR / (1 + RATIO)), 40)
    soft = patch_of(soft)
    assert still["max_pressure"] == pytest.approx(soft["max_pressure"], rel=1e-8)
    assert still["viscous_power"] == 0
    assert abs(still["rolling_resistance_moment"]) < 1e-8 * FORCE * RADIUS


def test_fmus_refuse_it() -> None:
    with pytest.raises(CaseError, match=r"material\.viscoelastic_ratio: given, allowed in an FMU"):
        check_regime(load_scene(ball(rubber(1e-3))))


def corners(x: Array, y: Array) -> tuple[Array, Array, Array]:
    """Primitives of Boussinesq and Cerruti (Love 1929; Kalker 1990, appendix C)."""
    return (
        y * np.arcsinh(x / np.abs(y)),
        x * np.arcsinh(y / np.abs(x)),
        -np.hypot(x, y),
    )


def elastic_at(x: Array, y: Array, dx: float, dy: float) -> Array:
    """1/Pa m of unit G and nu: zz, xx, yy, xy at places off the element's edges."""
    sums = np.zeros((3, *np.broadcast(x, y).shape))
    for u, a in ((x + dx / 2, 1), (x - dx / 2, -1)):
        for v, b in ((y + dy / 2, 1), (y - dy / 2, -1)):
            sums += a * b * np.array(np.broadcast_arrays(*corners(u, v)))
    one, two, three = sums
    half = 1 / (np.pi * SHEAR)
    near = 1 - POISSON
    return half * np.array(
        [near * (one + two), one + near * two, two + near * one, POISSON * three]
    )


def under_history(
    x: Array, y: Array, dx: float, dy: float, length: float, ratio: float = RATIO
) -> Array:
    """The elastic coefficients and `ratio` times their mean over the line ahead of x:
    Gauss-Legendre between and beyond the element's edges, towards which the panels shrink."""
    total = elastic_at(x, y, dx, dy)
    node, weight = np.polynomial.legendre.leggauss(14)
    for k, place in np.ndenumerate(x):
        edges = [e - place for e in (-dx / 2, dx / 2) if e - place > 1e-12]
        ends = [0.0]
        for edge in edges:
            start = ends[-1]
            ends += [edge - (edge - start) * 0.25**n for n in range(1, 14)] + [edge]
            ends += [edge + dx / 2 * 0.25**n for n in range(13, 0, -1)]
        ends += list(ends[-1] + np.geomspace(dx / 4, 40 * length + dx, 24))
        low, high = np.array(ends[:-1])[:, None], np.array(ends[1:])[:, None]
        s = (low + high) / 2 + (high - low) / 2 * node
        share = ratio * (high - low) / 2 * weight * np.exp(-s / length) / length
        at = elastic_at(place + s.ravel(), np.full(s.size, y[k]), dx, dy)
        total[(slice(None), *k)] += at @ share.ravel()
    return total


def test_contact_friction_and_power_by_dense_sums() -> None:
    """e = h + A p - approach, s = w + B p and the laws of both by matrices; what friction and the
    bodies take of the power that the motion supplies."""
    time = 6e-4
    patch = patch_of(ball(rubber(time)), fields=True)
    p, traction, slip = (np.array(patch[k]) for k in ("pressure", "traction", "micro_slip"))
    (nx, ny), (dx, dy), x, y = (X.size, Y.size), (DX, DY), X, Y
    p = p.reshape(ny, nx)
    traction, slip = traction.reshape(2, ny, nx), slip.reshape(2, ny, nx)

    length = SPEED * time
    offset = np.meshgrid(dx * np.arange(-nx, nx + 1), dy * np.arange(0, ny), indexing="ij")
    table = under_history(*offset, dx, dy, length)

    def matrix(kind: int, ahead: int = 0) -> Array:
        i = np.subtract.outer(np.arange(nx) + ahead, np.arange(nx)) + nx
        j = np.subtract.outer(np.arange(ny), np.arange(ny))
        sign = np.sign(j) if kind == 3 else np.ones_like(j)
        values = table[kind][i[None, :, None, :], np.abs(j)[:, None, :, None]]
        return (values * sign[:, None, :, None]).reshape(nx * ny, nx * ny)

    down = matrix(0) @ p.ravel()
    h = GAP.ravel()
    error = h + down - patch["approach"]
    touching = p.ravel() > 0
    scale = patch["approach"]
    assert np.abs(error[touching]).max() < 1e-8 * scale
    assert error[~touching].min() > -1e-8 * scale
    assert p.sum() * dx * dy == pytest.approx(100.0, rel=1e-9)

    px, py = traction[0].ravel(), traction[1].ravel()
    moved = [
        (matrix(a) - matrix(a, 1)) @ px / dx + (matrix(b) - matrix(b, 1)) @ py / dx
        for a, b in ((1, 3), (3, 2))
    ]
    rigid = [
        (-0.01 - 0.3 * y[:, None] + 0 * x).ravel(),
        (0.004 + 0.3 * x + 0 * y[:, None]).ravel(),
    ]
    s = np.array([w + m for w, m in zip(rigid, moved, strict=True)])
    assert np.abs(s - slip.reshape(2, -1))[:, touching].max() < 1e-8 * 0.01
    bound, size = 0.4 * p.ravel(), np.hypot(px, py)
    speed = np.hypot(*s)
    sticks = touching & (speed < 1e-8 * 0.01)
    slips = touching & ~sticks
    assert sticks.sum() == patch["elements"]["stick"] > 50
    assert slips.sum() == patch["elements"]["slip"] > 30
    assert (size[touching] < bound[touching] * (1 + 1e-8)).all()
    assert np.allclose(size[slips], bound[slips], rtol=1e-8)
    against = -(px * s[0] + py * s[1])[slips] / (size * speed)[slips]
    assert np.allclose(against, 1.0, rtol=1e-8)

    # -p . du/ds by central differences: of the elastic part nothing
    def rate(kind: int) -> Array:
        return SPEED * (matrix(kind, -1) - matrix(kind, 1)) / (2 * dx)

    area = dx * dy
    pressed = area * p.ravel() @ rate(0) @ p.ravel()
    # the resistance's work but for the pressure of the edges' last elements times the gap beside
    gap = error.reshape(ny, nx)
    beside = SPEED * area * (p[:, 1:-1] * (gap[:, :-2] - gap[:, 2:])).sum() / (2 * dx)
    resisted = 2 * 5.0 * SPEED * patch["rolling_resistance_moment"]
    assert pressed == pytest.approx(resisted + beside, rel=1e-8)
    half = (touching.reshape(ny, nx).any(axis=0)).sum() * dx / 2
    assert abs(beside) < 2 * 5.0 * SPEED * by_edges(100.0, half, dx)
    pulled = area * (px @ rate(1) @ px + px @ rate(3) @ py + py @ rate(3) @ px + py @ rate(2) @ py)
    assert patch["viscous_power"] == pytest.approx(pressed + pulled, rel=1e-8)
    supplied = -SPEED * area * (px @ rigid[0] + py @ rigid[1])
    assert patch["creep_power"] == pytest.approx(supplied, rel=1e-9)
    assert patch["friction_power"] == pytest.approx(supplied - pulled, rel=1e-8)
    assert patch["friction_power"] > 0
    assert pulled > 0.1 * supplied


def test_power_balances() -> None:
    """The pressure's part is the resistance times the speed but for the edges, creep power that of
    friction and the tractions' part."""
    for elements in (16, 48):
        case = round_ball(rubber(8e-4), elements)
        del case["method"]["tolerance"]
        rolling = patch_of(case)
        case["method"]["tangential"] = "none"
        del case["friction"], case["motion"]["creepage"], case["motion"]["spin_creepage"]
        del case["method"]["spin_offset"]
        free = patch_of(case, fields=True)
        half, size = free["contact_size"][0] / 2, np.diff(np.unique(free["x"]))[0]
        power = 2 * 5.0 * SPEED * free["rolling_resistance_moment"]
        within = 2 * 5.0 * SPEED * by_edges(100.0, half, size)
        assert free["viscous_power"] == pytest.approx(power, abs=within)
        # with nu = 0.5 tractions leave the pressure alone
        by_tractions = rolling["viscous_power"] - free["viscous_power"]
        taken = rolling["friction_power"] + by_tractions
        assert rolling["creep_power"] == pytest.approx(taken, rel=1e-9)


def test_rolling_back_is_the_mirror() -> None:
    ahead = patch_of(ball(rubber(1e-3)))
    motion = {"creepage": [0.01, 0.004], "spin_creepage": -0.3, "rolling_speed": SPEED}
    back = patch_of(ball(rubber(1e-3), motion={**motion, "direction": -1}))
    for name in ("normal_force", "viscous_power", "rolling_resistance_moment", "friction_power"):
        assert back[name] == pytest.approx(ahead[name], rel=1e-8)
    assert back["creep_force"][0] == pytest.approx(-ahead["creep_force"][0], rel=1e-8)
    assert back["creep_force"][1] == pytest.approx(ahead["creep_force"][1], rel=1e-8)
    assert back["spin_moment"] == pytest.approx(-ahead["spin_moment"], rel=1e-7)


def test_unlike_bodies() -> None:
    """One viscoelastic body on one that is hard, of half the compliance each: as both of half the
    ratio, where the times are the same. Where nothing couples they may differ."""
    one = patch_of(ball(rubber([1e-3, 0.0], [RATIO, 0.0])))
    both = patch_of(ball(rubber(1e-3, RATIO / 2)))
    for name in ("creep_force", "viscous_power", "rolling_resistance_moment", "max_pressure"):
        assert one[name] == pytest.approx(both[name], rel=1e-8)
    apart = patch_of(ball(rubber([1e-3, 2e-3], [RATIO, RATIO])))
    as_one = [patch_of(ball(rubber(time)))["approach"] for time in (1e-3, 2e-3)]
    assert min(as_one) < apart["approach"] < max(as_one)


@pytest.mark.parametrize("ratio", [30.0, 1000.0])
@pytest.mark.parametrize("time", [1e-4, 1e-3, 1e-2, 1.0])
def test_rubber_far_from_elastic(ratio: float, time: float) -> None:
    case = round_ball(rubber(time, ratio), 20)
    del case["method"]["tolerance"]
    found = patch_of(case)
    assert found["normal_force"] == pytest.approx(100.0)
    assert found["viscous_power"] > 0
    assert found["friction_power"] > 0


@pytest.mark.parametrize(("ratio", "slenderness"), [(300.0, 4.0), (1000.0, 1.0), (1000.0, 10.0)])
def test_areas_that_come_back(ratio: float, slenderness: float) -> None:
    """Bodies that yield by far more than they are elastic, over a length of the order of the
    contact's: rounds with whole steps return to areas that they had. The conditions of contact by
    dense sums."""
    length = 0.06
    case = {
        "kind": "patch",
        "material": rubber(1.0, ratio),
        "geometry": {"curvatures": [10.0, 10.0 / slenderness**1.5]},
        "load": {"normal_force": 500.0},
        "grid": {"elements": [20, 20]},
        "motion": {"rolling_speed": length},
        "method": {"normal": "half_space", "tangential": "none", "tolerance": 1e-6},
    }
    found = patch_of(case, fields=True)
    x, y, p = (np.array(found[name]) for name in ("x", "y", "pressure"))
    x, y = np.unique(x), np.unique(y)
    dx, dy = x[1] - x[0], y[1] - y[0]
    offset = np.meshgrid(dx * np.arange(-x.size, x.size), dy * np.arange(y.size), indexing="ij")
    table = under_history(*offset, dx, dy, length, ratio)[0]
    i = np.subtract.outer(np.arange(x.size), np.arange(x.size)) + x.size
    j = np.abs(np.subtract.outer(np.arange(y.size), np.arange(y.size)))
    down = np.einsum("jikl,kl->ji", table[i[None, :, None, :], j[:, None, :, None]], p)
    first, second = 10.0, 10.0 / slenderness**1.5
    error = first * x**2 + second * y[:, None] ** 2 + down - found["approach"]
    assert np.abs(error[p > 0]).max() < 2e-6 * down.max()
    assert error[p == 0].min() > -2e-6 * down.max()
    assert p.sum() * dx * dy == pytest.approx(500.0, rel=1e-9)


def test_steps_from_each_other_and_prescribed_forces() -> None:
    contact = Contact(ball(rubber(1e-3)))
    first = contact.step()
    state = contact.save()
    warm = contact.step(rolling_speed=12.0)
    contact.restore(state)
    assert contact.step(rolling_speed=12.0)["creep_force"] == warm["creep_force"]
    cold = patch_of(ball(rubber(1e-3), motion={**ball({})["motion"], "rolling_speed": 12.0}))
    assert warm["creep_force"] == pytest.approx(cold["creep_force"], rel=1e-7)
    force = first["creep_force"]
    motion = {"tangential_force": force, "spin_creepage": 0.3, "rolling_speed": SPEED}
    found = patch_of(ball(rubber(1e-3), motion=motion))
    assert found["creepage"] == pytest.approx([-0.01, 0.004], rel=1e-5)


REFUSED = [
    (
        {"geometry": {"semi_axes": [5e-3, 5e-3]}, "grid": {"elements": [9, 9]}},
        "geometry.semi_axes",
    ),
    ({"motion": {"regime": "none"}, "friction": None}, "motion.regime"),
    ({"motion": {"regime": "shift", "creepage": [1e-5, 0.0]}}, "motion.regime"),
    (
        {
            "motion": {
                "regime": "transient_rolling",
                "creepage": [1e-3, 0.0],
                "rolling_speed": 1.0,
                "distance": 1e-3,
            }
        },
        "motion.regime",
    ),
    ({"method": {"normal": "hertz"}}, "method.normal"),
    ({"method": {"normal": "half_space", "tangential": "fastsim"}}, "method.tangential"),
    ({"method": {"normal": "half_space", "derivatives": True}}, "method.derivatives"),
    ({"grid": {"element_size": [DX, DY], "fitted": [8, 8]}}, "grid.fitted"),
    ({"layer": {"thickness": 1e-3, "shear_modulus": 1e8}}, "layer"),
    ({"temperature": {}}, "temperature"),
    (
        {
            "friction": {
                "law": "slip_velocity",
                "shape": "exponential",
                "kinetic": 0.2,
                "amplitude": 0.1,
                "halving_speed": 1.0,
                "memory_distance": 1e-5,
            }
        },
        "friction.law",
    ),
    ({"subsurface": {"depths": [1e-3]}}, "subsurface"),
    ({"material": rubber(0.0) | {"viscoelastic_ratio": 1.0}}, "material.relaxation_time: "),
    ({"material": rubber(0.0) | {"relaxation_time": 1.0}}, "material.relaxation_time: "),
    # a wheel of rubber on an elastic rail has [time, 0.0]
    ({"material": rubber(1e-3, [RATIO, 0.0])}, "material.relaxation_time[1]: "),
    ({"material": rubber(1e-3) | {"poisson_ratio": [0.5, 0.4]}}, "material.viscoelastic_ratio"),
    (
        {"material": rubber(1e-3, [3.0, 2.0]) | {"poisson_ratio": 0.4}},
        "material.viscoelastic_ratio",
    ),
]


@pytest.mark.parametrize(("change", "named"), REFUSED)
def test_what_is_refused(change: dict[str, Any], named: str) -> None:
    case = {k: v for k, v in (ball(rubber(1e-3)) | change).items() if v is not None}
    with pytest.raises(CaseError) as refused:
        railpatch.solve(case)
    assert named in str(refused.value)
    assert "viscoelastic_ratio" in str(refused.value)
    if "relaxation_time" in named:
        assert len(refused.value.problems) == 1
