"""The error estimate, computed again from what a result shows: features by numpy, as
core/patch/error_estimate.hpp names them, and the networks of core/patch/error_model.inc as they
stand there.

Creepage coefficients are asked of the linear theory (Kalker 1967), whose forces are products of
them, on an ellipse of the same axes.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import railpatch
from case_samples import PATCH, with_values
from scipy.optimize import brentq
from scipy.special import ellipe, ellipk

MODEL = Path(__file__).parents[2] / "core" / "patch" / "error_model.inc"
MODULUS, POISSON = 82e9, 0.28
FLOOR = 3e-4  # of mu Fn: accuracy of the results that the networks were fitted to
FARTHEST = (16.0, 4.0)  # scaled creepage and spin up to which they were
AREA, MOTION = 12, 11  # features
AXES = (6e-3, 4e-3)  # m, of elliptic contacts
CURVATURES = (0.6, 1.1)  # 1/m, of those of Kik and Piotrowski
EGG = (0.5, 0.9, 30.0)  # c0 x^2 (1 + 60 y) + c1 y^2 + c2 y^3
NAMES = {"hertz": None, "half_space": 7, "kik_piotrowski": 8, "analyn": 9}


@pytest.fixture(scope="module")
def networks() -> dict[str, np.ndarray]:
    """Name -> the numbers of a network."""
    found = re.findall(r"double (\w+)_values_(\d)\[\] = \{([^}]*)\}", MODEL.read_text())
    return {f"{name} {k}": np.array(text.split(","), float) for name, k, text in found}


def value(numbers: np.ndarray, features: np.ndarray) -> float:
    """w0 + sum of w g(v0 + v f), g(t) = t/(1 + |t|)."""
    units = numbers[1:].reshape(-1, 2 + len(features))
    t = units[:, 1] + units[:, 2:] @ features
    return float(numbers[0] + units[:, 0] @ (t / (1 + abs(t))))


def coefficients(ratio: float) -> tuple[float, float, float]:
    """C11, C22, C23 of an ellipse with a/b = ratio."""
    a, b = 6e-3 * ratio**0.5, 6e-3 / ratio**0.5
    case = with_values(
        PATCH,
        geometry={"semi_axes": [a, b]},
        friction__coefficient=1.0,
        method={"normal": "hertz", "tangential": "linear"},
    )
    contact = railpatch.Contact(case)
    scale = -MODULUS * a * b
    fx, fy = contact.step(creepage=[1e-6, 1e-6], spin_creepage=0.0)["creep_force"]
    spin = contact.step(creepage=[0.0, 0.0], spin_creepage=1e-5)["creep_force"][1]
    return fx / 1e-6 / scale, fy / 1e-6 / scale, spin / 1e-5 / scale / (a * b) ** 0.5


class Area:
    """The area of contact, from the pressures of a result."""

    def __init__(self, result: railpatch.Result, normal: str) -> None:
        data = result.data
        self.centre = np.zeros(2)
        self.features = np.zeros(AREA)
        self.across = (0, 0)
        self.axes = list(AXES)
        if normal != "hertz":
            self.axes = self.read(data, width_of(data, normal))
            self.features[NAMES[normal]] = 1.0
        axes = self.axes
        self.length = np.sqrt(axes[0] * axes[1])
        self.features[0] = np.log(axes[0] / axes[1])
        self.features[1] = np.linalg.norm(self.centre) / self.length
        self.features[2] = POISSON - 0.28

    def read(self, data: dict[str, Any], width: float | None) -> list[float]:
        """Features of shape and grid; semi-axes of the ellipse of the same width and area."""
        p, x, y = (np.asarray(data[name]) for name in ("pressure", "x", "y"))
        dx, dy = np.diff(x)[0], np.diff(y)[0]
        rows, columns = np.flatnonzero(p.sum(1)), np.flatnonzero(p.sum(0))
        self.across = (np.ptp(columns) + 1, np.ptp(rows) + 1)
        box = self.across[0] * dx, self.across[1] * dy
        weights = p / p.sum()
        self.centre = np.array([weights.sum(0) @ x, weights.sum(1) @ y])
        area = data["contact_area"]
        # a uniform pressure within each element, second moments about the centre; an ellipse's are
        # a twentieth of the squared width
        second = (
            weights.sum(0) @ (x - self.centre[0]) ** 2,
            weights.sum(1) @ (y - self.centre[1]) ** 2,
        )
        spread = [
            20 * (m + d**2 / 12) / w**2 for m, d, w in zip(second, (dx, dy), box, strict=True)
        ]
        self.features[3:5] = np.log(np.array(self.across) / 16)
        self.features[5] = np.log(data["max_pressure"] * area / (1.5 * data["normal_force"]))
        self.features[6] = np.log(
            np.count_nonzero(p) / (np.pi / 4 * self.across[0] * self.across[1])
        )
        self.features[10:12] = np.log(spread)
        half = (width or box[1]) / 2
        return [area / (np.pi * half), half]


def width_of(data: dict[str, Any], normal: str) -> float | None:
    """m, of the theories by rows, which know it better than by elements; None: by elements.

    Both on paraboloids. Kik and Piotrowski (2008): the ellipse with Hertz's ratio of axes and the
    area in which bodies, moved together by 0.55 of the approach, overlap. ANALYN: Hertz's ellipse.
    """
    if normal == "half_space":
        return None
    if normal == "analyn":
        return 2 * AXES[1]
    overlap = 0.55 * data["approach"] / np.sqrt(CURVATURES[0] * CURVATURES[1])
    return 2 * np.sqrt(overlap / hertz_ratio())


def hertz_ratio() -> float:
    """a/b > 1 of Hertz's ellipse on c0 x^2 + c1 y^2 (Johnson 1985, eq. 4.25)."""

    def excess(ratio: float) -> float:
        m = 1 - ratio**-2
        k, e = ellipk(m), ellipe(m)
        return (ratio**2 * e - k) / (k - e) - CURVATURES[1] / CURVATURES[0]

    return brentq(excess, 1.001, 20, xtol=1e-12)


def motion(case: dict[str, Any], result: railpatch.Result, area: Area) -> tuple[np.ndarray, float]:
    """Features of the motion; the sum of scaled creepage and spin."""
    data, given = result.data, case["motion"]
    force = case["friction"]["coefficient"] * data["normal_force"]
    layer = case.get("layer", {})
    flexibility = layer["thickness"] / layer["shear_modulus"] if layer else 0.0
    a, b = area.axes
    c11, c22, c23 = coefficients(a / b)
    # flexibilities of bodies and layer are added: 8 a/(3 C G) + L (Kalker 1982)
    stiff = [8 * a / (3 * MODULUS) / (8 * a / (3 * MODULUS * c) + flexibility) for c in (c11, c22)]
    unit = MODULUS * a * b / force
    spin = given["spin_creepage"]
    xi = given["creepage"][0] - spin * area.centre[1]
    eta = given["creepage"][1] + spin * area.centre[0]
    spin *= given.get("direction", 1)
    sx, sy = abs(xi) * unit * stiff[0], abs(eta) * unit * stiff[1]
    sp = abs(spin) * area.length * unit * c23 * stiff[1] / c22
    with_spin = sy + sp if eta * spin >= 0 else sy - sp
    coupling = np.copysign(sy * sp, eta * spin)
    linear = np.hypot(sx, with_spin)
    fx, fy = data["creep_force"]
    moment = data["spin_moment"] - area.centre[0] * fy + area.centre[1] * fx
    stick, slip = data["elements"]["stick"], data["elements"]["slip"]
    features = np.zeros(MOTION)
    features[0] = np.log1p(min(np.hypot(sx, sy), FARTHEST[0]))
    features[1] = np.log1p(min(sp, FARTHEST[1]))
    features[2] = sx**2 / (sx**2 + sy**2 + 0.0025)
    features[3] = coupling / (0.05 + sx**2 + sy**2 + sp**2)
    features[4] = linear / (1 + linear)
    features[5] = np.hypot(fx, fy) / force
    features[6] = abs(moment) / (force * area.length)
    features[7] = stick / (stick + slip) if stick + slip else 0.0
    features[10] = np.log1p(20 * flexibility * MODULUS / area.length)
    return features, np.hypot(sx, sy) + sp


METHODS: dict[str, tuple[str, dict[str, Any]]] = {
    "uniform": ("uniform", {"method": {}, "grid": {"elements": [14, 11]}}),
    "uniform, Hertz": ("uniform", {"method": {"normal": "hertz"}, "grid": {"elements": [14, 11]}}),
    "Kik-Piotrowski": (
        "uniform",
        {"method": {"normal": "kik_piotrowski"}, "grid": {"elements": [13, 12]}},
    ),
    "ANALYN": ("fastsim", {"method": {"normal": "analyn", "tangential": "fastsim"}}),
    "FASTSIM": (
        "fastsim",
        {
            "method": {"normal": "hertz", "tangential": "fastsim"},
            "grid": {"elements": [16, 16]},
        },
    ),
    "FaStrip": ("fastrip", {"method": {"tangential": "fastrip"}, "grid": {"elements": [12, 12]}}),
    "Polach": ("polach", {"method": {"normal": "hertz", "tangential": "polach"}}),
    "linear": ("linear", {"method": {"normal": "hertz", "tangential": "linear"}}),
    "rows": ("fitted", {"method": {"normal": "hertz"}, "grid": {"fitted": [9, 7]}}),
    "layer": (
        "uniform",
        {"method": {}, "layer": {"shear_modulus": 8.2e9, "thickness": 4e-5}},
    ),
}
MOTIONS = {
    "creepage": ([6e-4, -2e-4], 0.0, 1),
    "with spin": ([3e-4, 5e-4], 0.3, 1),
    "against spin": ([-2e-4, 5e-4], -0.35, 1),
    "backwards": ([2e-4, 4e-4], 0.25, -1),
    "sliding": ([0.06, 0.03], 8.0, 1),
    "nearly still": ([2e-7, 1e-7], 1e-5, 1),
}


@pytest.mark.parametrize("moving", MOTIONS)
@pytest.mark.parametrize("name", METHODS)
def test_the_estimate_is_what_its_features_give(
    name: str, moving: str, networks: dict[str, np.ndarray]
) -> None:
    model, changes = METHODS[name]
    creepage, spin, direction = MOTIONS[moving]
    normal = changes["method"].get("normal", "half_space")
    distance = 5e-4 * np.arange(-11.5, 12)
    x, y = np.meshgrid(distance, distance)
    # an egg: its centre of pressure lies off the reference, and no feature is that of an ellipse
    egg = {
        "undeformed_distance": (
            EGG[0] * x**2 * (1 + 60 * y) + EGG[1] * y**2 + EGG[2] * y**3
        ).tolist()
    }
    shaped = normal == "half_space" and name != "FaStrip"
    geometry = egg if shaped else {"semi_axes": list(AXES)}
    if normal == "kik_piotrowski":
        geometry = {"curvatures": list(CURVATURES)}
    grid = {"element_size": [5e-4, 5e-4]} if shaped else changes.get("grid")
    case = with_values(
        PATCH,
        **{**changes, "geometry": geometry, "grid": grid},
        load={"normal_force": 1e4},
        motion__creepage=creepage,
        motion__spin_creepage=spin,
        motion__direction=direction,
    )
    result = railpatch.solve(case, fields=True)
    assert result.status in ("converged", "out_of_range")
    area = Area(result, normal)
    moved, size = motion(case, result, area)
    tangential = case["method"].get("tangential", "full")
    if tangential not in ("polach", "linear"):
        moved[8:10] = np.log(np.array(grid_of(name, area)) / 16)
    given = result["error_estimate"]
    force = case["friction"]["coefficient"] * result["normal_force"]
    features = np.concatenate([area.features, moved])
    for k, (quantity, scale) in enumerate((("creep_force", 1.0), ("spin_moment", area.length))):
        relative = size / (1 + size) * np.exp(value(networks[f"{model} {k}"], features))
        wanted = force * scale * max(FLOOR * min(1.0, size), relative)
        # creepage coefficients from linear forces: equal but for rounding and interpolation's
        assert given[quantity] == pytest.approx(wanted, rel=1e-6), quantity
    pressure = networks.get(f"{normal}_pressure 0")
    bound = 1e-10 if pressure is None else np.exp(value(pressure, area.features))
    assert given["max_pressure"] == pytest.approx(result["max_pressure"] * bound, rel=1e-9)


def grid_of(name: str, area: Area) -> tuple[int, int]:
    """Elements of the tangential problem along rolling and lateral."""
    if name == "rows":
        return 9, 7
    if name == "uniform, Hertz":
        return 14, 11
    return area.across if area.across[0] else (16, 16)
