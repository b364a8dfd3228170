"""Grids of one and two rows or columns.

Rows are strips of finite length on the half-space. Against dense sums in numpy over the elements'
own influence (Boussinesq and Cerruti integrated over rectangles: Love 1929; Kalker 1990, appendix
C), and where they are long against the contact against Hertz's and Carter's closed forms (Carter
1926; Johnson 1985, sections 4.2 and 8.3).
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import railpatch
from numpy.typing import NDArray
from patch_cases import STEEL, modulus
from railpatch import CaseError, Contact

Array = NDArray[np.float64]

DX, DY, MU, SPEED = 2e-4, 3e-3, 0.3, 10.0
CREEPAGE, SPIN = (-4e-4, 3e-4), 0.2
EXACT = 1e-8
SHAPES = [(24, 1), (24, 2), (1, 16), (2, 16), (1, 1), (2, 2), (1, 2)]  # along rolling, lateral


def centres(count: int, size: float) -> Array:
    return (np.arange(count) - (count - 1) / 2) * size


def case(nx: int, ny: int, motion: dict[str, Any], **more: Any) -> dict[str, Any]:
    """The grid is narrow where it has few elements: all of the bodies that there is."""
    size = [DX if nx > 2 else DY, DX if ny > 2 else DY]
    x, y = centres(nx, size[0]), centres(ny, size[1])
    curved = 1.0 if nx > 2 else 0.0, 1.2 if ny > 2 else 0.0
    gap = curved[0] * x**2 + curved[1] * (y[:, None] - 1e-5) ** 2
    found: dict[str, Any] = {
        "kind": "patch",
        "material": STEEL,
        "geometry": {"undeformed_distance": gap.tolist()},
        "load": {"normal_force": 900.0 * ny if nx > 2 else 900.0 * nx},
        "grid": {"element_size": size},
        "motion": {"rolling_speed": SPEED, **motion},
        "friction": {"coefficient": MU},
        "method": {"tolerance": 1e-11, "max_iterations": 300, "spin_offset": "none"},
    }
    if motion["regime"] in ("shift", "none"):
        del found["method"]["spin_offset"]
    if motion["regime"] == "none":
        del found["motion"]["rolling_speed"], found["friction"]
    return found | more


def influence(nx: int, ny: int, size: list[float], ahead: float = 0.0) -> Array:
    """m/Pa, [x y n, observer, x y n, source] of two like bodies; the observer stands `ahead` (m)
    further along x."""
    x, y = (part.ravel() for part in np.meshgrid(centres(nx, size[0]), centres(ny, size[1])))
    rx, ry = x[:, None] - x + ahead, y[:, None] - y
    sums = np.zeros((3, *rx.shape))
    for i in (1, -1):
        for j in (1, -1):
            cx, cy = rx + i * size[0] / 2, ry + j * size[1] / 2
            sums[0] += i * j * cy * np.arcsinh(cx / np.abs(cy))  # of 1/r that falls along x
            sums[1] += i * j * cx * np.arcsinh(cy / np.abs(cx))
            sums[2] -= i * j * np.hypot(cx, cy)
    nu, c = STEEL["poisson_ratio"], 1 / (np.pi * STEEL["shear_modulus"])
    whole = np.zeros((3, len(x), 3, len(x)))
    whole[0, :, 0] = c * (sums[0] + (1 - nu) * sums[1])
    whole[1, :, 1] = c * (sums[1] + (1 - nu) * sums[0])
    whole[0, :, 1] = whole[1, :, 0] = c * nu * sums[2]
    whole[2, :, 2] = c * (1 - nu) * (sums[0] + sums[1])
    return whole


@pytest.mark.parametrize("load", ["force", "position"])
@pytest.mark.parametrize(("nx", "ny"), SHAPES)
def test_pressure_by_direct_sums(nx: int, ny: int, load: str) -> None:
    """Within 1e-8: pressure solves the dense equations of its area, and nothing else touches."""
    scene = case(nx, ny, {"regime": "none"})
    if load == "position":
        scene["load"] = {"approach": 4e-6}
    result = railpatch.solve(scene, fields=True)
    assert result.good, result.reason
    size = scene["grid"]["element_size"]
    a = influence(nx, ny, size)[2, :, 2]
    h = np.ravel(scene["geometry"]["undeformed_distance"])
    p = result["pressure"].ravel()
    touch = p > 0
    assert touch.any()
    approach = result["approach"]
    wanted = np.linalg.solve(a[np.ix_(touch, touch)], approach - h[touch])
    np.testing.assert_allclose(p[touch], wanted, rtol=0, atol=EXACT * p.max())
    assert (h + a @ p - approach >= -EXACT * (a @ p).max()).all()
    assert result["normal_force"] == pytest.approx(p.sum() * size[0] * size[1], rel=1e-12)
    asked = scene["load"]
    named = "approach" if load == "position" else "normal_force"
    assert result[named] == pytest.approx(asked[named], rel=1e-10)


def expect_friction(p: Array, slip: Array, bound: Array, scale: float) -> None:
    """Coulomb's law in each element, within 1e-8. p: Pa, slip: with a scale, [2, element]."""
    size, speed = np.hypot(*p), np.hypot(*slip)
    touch, top = bound > 0, bound.max()
    assert touch.any()
    assert (size[~touch] == 0).all()
    assert (size <= bound + EXACT * top).all()
    stick = touch & (size < bound * (1 - 1e-7))
    assert (speed[stick] <= EXACT * scale).all()
    slides = touch & ~stick & (speed > 1e-4 * scale)
    against = p[:, slides] + bound[slides] * slip[:, slides] / speed[slides]
    assert (np.abs(against) <= EXACT * top).all()


@pytest.mark.parametrize("regime", ["steady_rolling", "shift", "transient_rolling"])
@pytest.mark.parametrize(("nx", "ny"), SHAPES)
def test_friction_by_direct_sums(nx: int, ny: int, regime: str) -> None:
    """Slip from dense sums of the tractions; rolling sees upstream one element ahead."""
    unit = 5e-3 if regime == "shift" else 1.0
    phi = 0.0 if regime == "transient_rolling" else SPIN
    motion: dict[str, Any] = {
        "regime": regime,
        "creepage": [unit * c for c in CREEPAGE],
        "spin_creepage": unit * phi,
    }
    scene = case(nx, ny, motion)
    size = scene["grid"]["element_size"]
    if regime == "transient_rolling":
        motion["distance"] = size[0]
        scene["motion"]["distance"] = size[0]
    contact = Contact(scene)
    here, ahead = influence(nx, ny, size), influence(nx, ny, size, size[0])
    x, y = (part.ravel() for part in np.meshgrid(centres(nx, size[0]), centres(ny, size[1])))
    rigid = np.array([CREEPAGE[0] - phi * y, CREEPAGE[1] + phi * x])
    before = np.zeros((2, nx * ny))
    for _ in range(1 if regime == "steady_rolling" else 3):
        result = contact.step(fields=True)
        assert result.good, result.reason
        p = result["traction"].reshape(2, -1)
        now = np.einsum("aibj,bj->ai", here[:2, :, :2], p)
        if regime == "steady_rolling":
            before = p
        looks = here if regime == "shift" else ahead
        then = np.einsum("aibj,bj->ai", looks[:2, :, :2], before)
        way = unit if regime == "shift" else size[0]
        slip = rigid * way + now - then
        bound = MU * result["pressure"].ravel()
        expect_friction(p, slip, bound, max(np.abs(rigid).max() * way, np.abs(now).max()))
        before = p


RADIUS, LINE_FORCE = 0.5, 178.90e3  # m, N/m: half-length 1 mm
HALF = np.sqrt(4 * LINE_FORCE * RADIUS / (np.pi * modulus()))


def long_strip(rows: int, creepage: float = 0.0, elements: int = 50) -> dict[str, Any]:
    """1 m long against 2 mm."""
    dx = 2 * HALF / elements
    gap = [(centres(elements + 4, dx) ** 2 / (2 * RADIUS)).tolist()] * rows
    motion = {"regime": "steady_rolling", "creepage": [creepage, 0.0]}
    more = {
        "geometry": {"undeformed_distance": gap},
        "load": {"normal_force": LINE_FORCE},
        "grid": {"element_size": [dx, 1.0 / rows]},
    }
    return case(elements + 4, rows, motion, **more)


@pytest.mark.parametrize("rows", [1, 2])
def test_a_long_strip_is_a_line_contact(rows: int) -> None:
    """Hertz's pressure and Carter's force within the errors of 50 elements, and the line contact of
    plane strain on the same elements within what the strip's ends make: (a / length)^2."""
    result = railpatch.solve(long_strip(rows, -2.4e-4), fields=True)
    assert result.good, result.reason
    peak = 2 * LINE_FORCE / (np.pi * HALF)
    assert result["max_pressure"] == pytest.approx(peak, rel=0.01)
    x = centres(54, 2 * HALF / 50)
    inside = np.abs(x) < 0.8 * HALF
    wanted = peak * np.sqrt(1 - (x[inside] / HALF) ** 2)
    np.testing.assert_allclose(result["pressure"][0][inside], wanted, rtol=0.01)
    force = result["creep_force"][0] / (MU * LINE_FORCE)
    stick = 1 - 2.4e-4 / (MU * HALF / RADIUS)
    assert force == pytest.approx(1 - stick**2, rel=0.02)
    if rows > 1:
        return
    line = long_strip(1, -2.4e-4) | {"geometry": {"line_contact_radius": RADIUS, "width": 1.0}}
    line["grid"] = {"element_size": [2 * HALF / 50, 1.0]}
    line["method"] = line["method"] | {"normal": "half_space"}
    plane = railpatch.solve(line)
    assert result["max_pressure"] == pytest.approx(plane["max_pressure"], rel=1e-4)
    assert result["creep_force"][0] == pytest.approx(plane["creep_force"][0], rel=1e-3)


ELSE: dict[str, dict[str, Any]] = {
    "layer": {"layer": {"shear_modulus": 1e9, "thickness": 2e-5}},
    "falling": {
        "friction": {
            "law": "slip_velocity",
            "kinetic": 0.2,
            "amplitude": 0.15,
            "halving_speed": 0.01,
        }
    },
    "warm": {"temperature": {}},
}


@pytest.mark.parametrize("name", ELSE)
@pytest.mark.parametrize(("nx", "ny"), [(24, 1), (2, 16)])
def test_friction_takes_what_motion_supplies(nx: int, ny: int, name: str) -> None:
    """In steady rolling, with what else acts between the bodies."""
    motion = {"regime": "steady_rolling", "creepage": list(CREEPAGE)}
    result = railpatch.solve(case(nx, ny, motion, **ELSE[name]), fields=True)
    assert result.good, result.reason
    area = DX * DY
    supplied = -SPEED * area * np.einsum("ajk,a->", result["traction"], CREEPAGE)
    assert result["creep_power"] == pytest.approx(supplied, rel=1e-9)
    assert result["friction_power"] == pytest.approx(supplied, rel=1e-6)
    assert np.isnan(list(result["error_estimate"].values())[:2]).all()


def test_unlike_bodies_are_those_of_a_line() -> None:
    """Pressure and traction act on each other: a long strip against plane strain."""
    unlike = {"shear_modulus": [82e9, 160e9], "poisson_ratio": 0.28}
    scene = long_strip(1, -2.4e-4) | {"material": unlike}
    strip = railpatch.solve(scene)
    assert strip.good, strip.reason
    line = scene | {"geometry": {"line_contact_radius": RADIUS, "width": 1.0}}
    line["method"] = scene["method"] | {"normal": "half_space"}
    plane = railpatch.solve(line)
    assert strip["max_pressure"] == pytest.approx(plane["max_pressure"], rel=1e-4)
    assert strip["creep_force"][0] == pytest.approx(plane["creep_force"][0], rel=1e-3)


REFUSED = [
    ({"method": {"normal": "kik_piotrowski"}}, "but with normal = half_space"),
    ({"method": {"tangential": "fastsim"}}, "but with tangential = full and no fitted rows"),
    ({"grid": {"element_size": [DX, DY], "fitted": [8, 8]}}, "tangential = full and no fitted"),
    ({"method": {"accuracy": 0.05}}, r"method\.accuracy: value is 0\.05, allowed none"),
    ({"method": {"derivatives": True}}, "with derivatives"),
    (
        {"fluid": {"model": "film", "roughness": 1e-6, "liquid": "water", "water_rate": 1e-7}},
        "with fluid_model",
    ),
]


@pytest.mark.parametrize(("more", "problem"), REFUSED)
def test_what_needs_three_rows(more: dict[str, Any], problem: str) -> None:
    """Refused by name."""
    motion = {"regime": "steady_rolling", "creepage": list(CREEPAGE)}
    with pytest.raises(CaseError, match=problem):
        railpatch.solve(case(24, 2, motion, **more))


def test_contact_at_the_ends_of_a_row_is_at_the_border() -> None:
    """Along the row the grid has a border as before."""
    scene = case(24, 1, {"regime": "none"})
    scene["load"] = {"normal_force": 2e5}
    result = railpatch.solve(scene)
    assert result.status == "out_of_range"
    assert "border" in result.reason


def test_one_row_of_a_file(tmp_path: Path) -> None:
    """The same numbers to the bit as of lists."""
    scene = case(24, 1, {"regime": "steady_rolling", "creepage": list(CREEPAGE)})
    wanted = railpatch.solve(scene)
    row = scene["geometry"]["undeformed_distance"][0]
    (tmp_path / "gap.csv").write_text(",".join(map(repr, row)) + "\n")
    scene["geometry"] = {"undeformed_distance": "gap.csv"}
    assert Contact(scene, folder=tmp_path).step()["creep_force"] == wanted["creep_force"]


@pytest.mark.parametrize(
    ("nx", "ny", "coarse"),
    [(24, 1, False), (2, 16, False), (1, 1, False), (1, 6, True), (6, 24, True)],
)
def test_strips_are_not_called_coarse(nx: int, ny: int, coarse: bool) -> None:
    """One and two rows or columns are meant; fewer than eight elements along them are a fault."""
    found = railpatch.solve(case(nx, ny, {"regime": "none"}))
    assert any("fewer than 8 elements" in text for text in found.warnings) == coarse
