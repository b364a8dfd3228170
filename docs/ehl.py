"""Elastohydrodynamic lubrication of a wheel on a rail, beside film and strips: draws docs/ehl.svg.

The contact of docs/fluids.md: R_x 0.46 m, R_y 0.30 m, 80 kN, water of 20 degrees C, roughness
0.5 um.

    python docs/ehl.py docs/ehl.svg

With --grid in place of the file it prints the table of grids, with --moes that of circular contacts
by Moes's numbers.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import matplotlib as mpl

mpl.use("svg")
import matplotlib.pyplot as plt
import numpy as np
import railpatch

ELEMENTS = [64, 24]
SPEEDS = (5.0, 20.0, 72.2)
CASE: dict[str, Any] = {
    "kind": "patch",
    "material": {"shear_modulus": 80.77e9, "poisson_ratio": 0.3},
    "geometry": {"curvatures": [0.5 / 0.46, 0.5 / 0.30]},
    "load": {"normal_force": 8e4},
    "grid": {"elements": ELEMENTS},
    "motion": {"creepage": [5e-3, 0.0], "rolling_speed": 20.0},
}
WATER = {
    "roughness": 5e-7,
    "boundary_friction": 0.15,
    "viscosity": 1.0035e-3,
}
OIL = {
    "model": "ehl",
    "roughness": 1e-8,
    "boundary_friction": 0.15,
    "viscosity": 0.1,
    "pressure_coefficient": 20e-9,
}
MODELS = {
    "ehl": {"model": "ehl"},
    "film, load_sharing": {"model": "film", "share": "load_sharing", "mean_pressure": "contact"},
    "strip": {"model": "strip"},
}


def along(fluid: dict[str, Any], speed: float) -> dict[str, Any]:
    """Fields in the middle row."""
    contact = railpatch.Contact({**CASE, "fluid": fluid})
    r = contact.step(rolling_speed=speed, fields=True)
    middle = len(r["y"]) // 2
    return {
        "x": 1e3 * np.array(r["x"]),
        "pressure": 1e-9 * np.array(r["pressure"])[middle],
        "fluid": 1e-9 * np.array(r["fluid_pressure"])[middle],
        "film": 1e6 * np.array(r["film_thickness"])[middle],
    }


def shares(model: dict[str, Any], speeds: np.ndarray) -> list[float]:
    contact = railpatch.Contact({**CASE, "fluid": {**WATER, **model}})
    return [contact.step(rolling_speed=v)["mean_asperity_share"] for v in speeds]


def draw(path: Path) -> None:
    plt.rcParams.update({"svg.hashsalt": "ehl", "font.size": 9})
    figure, (left, middle, right) = plt.subplots(1, 3, figsize=(11, 3.6), layout="constrained")
    for k, speed in enumerate(SPEEDS):
        row = along({**WATER, "model": "ehl"}, speed)
        left.plot(row["x"], row["pressure"], color=f"C{k}", label=f"{speed:g} m/s")
        left.plot(row["x"], row["fluid"], color=f"C{k}", linestyle="--")
    left.set(
        xlabel="x, mm (rolling to the right)", ylabel="GPa", title="pressure, dashed: the water's"
    )
    left.legend()
    speeds = np.geomspace(1, 100, 9)
    for name, model in MODELS.items():
        middle.plot(speeds, shares(model, speeds), marker=".", label=name)
    middle.set(xscale="log", xlabel="speed, m/s", ylim=(0, 1.05), title="share of the asperities")
    middle.legend()
    row = along(OIL, 10.0)
    right.plot(row["x"], row["pressure"], color="C0")
    right.set(xlabel="x, mm", title="oil, 10 m/s: pressure, GPa, and film, um")
    film = right.twinx()
    film.plot(row["x"], row["film"], color="C1")
    film.set_ylim(0, 20)
    figure.savefig(path, metadata={"Date": None})


def refine() -> None:
    """The docs' table: rise of the reduced pressure, film and share over elements along rolling."""
    for liquid, speed in ((WATER, 5.0), (WATER, 20.0), (WATER, 80.0), (OIL, 10.0)):
        rows = []
        for elements in (16, 24, 32, 48, 64, 96):
            case = {**CASE, "grid": {"elements": [elements, 16]}}
            contact = railpatch.Contact({**case, "fluid": {**liquid, "model": "ehl"}})
            r = contact.step(rolling_speed=speed, fields=True)
            alpha = liquid.get("pressure_coefficient", 5e-10)
            reduced = 1 - np.exp(-alpha * np.array(r["fluid_pressure"])[:, ::-1])
            rise = np.diff(reduced, axis=1, prepend=0.0).max() / reduced.max()
            film, share = r["central_film_thickness"], r["mean_asperity_share"]
            rows.append((elements, rise, film, share, len(r.warnings)))
        name = "oil" if liquid is OIL else "water"
        for elements, rise, film, share, warned in rows[:-1]:
            error, more = 100 * (film / rows[-1][2] - 1), share - rows[-1][3]
            told = "warned" if warned else ""
            cells = f"{elements} | {rise:.3f} | {error:+.1f} | {more:+.3f} | {told}"
            print(f"| {name}, {speed:g} m/s | {cells} |")


def circle(load: float, growth: float, elements: int) -> tuple[dict[str, Any], float]:
    """A smooth circular contact of Moes's numbers, as in tests/cpp/test_ehl.cpp: M of the load, L
    of the viscosity's growth; and R U^(1/2) (m), the unit of films."""
    modulus, ratio, radius, viscosity, alpha = 1.1e11, 0.3, 0.02, 0.04, 2.2e-8
    stiffness = 2 * modulus
    speed = (growth / (alpha * stiffness)) ** 4
    case = {
        "kind": "patch",
        "material": {"shear_modulus": modulus * (1 - ratio), "poisson_ratio": ratio},
        "geometry": {"curvatures": [0.5 / radius, 0.5 / radius]},
        "load": {"normal_force": load * speed**0.75 * stiffness * radius**2},
        "grid": {"elements": [elements, elements]},
        "motion": {
            "creepage": [0.0, 0.0],
            "rolling_speed": speed * stiffness * radius / (2 * viscosity),
        },
        "fluid": {
            "model": "ehl",
            "roughness": 1e-9,
            "boundary_friction": 0.1,
            "viscosity": viscosity,
            "pressure_coefficient": alpha,
        },
    }
    return case, radius * speed**0.5


def moes() -> None:
    """The docs' table: central and least films of circular contacts over the fit of film."""
    for load, growth in ((20.0, 5.0), (100.0, 10.0)):
        for elements in (20, 30, 45):
            case, unit = circle(load, growth, elements)
            r = railpatch.Contact(case).step(fields=True)
            fluid = {**case["fluid"], "model": "film"}
            fit = railpatch.Contact({**case, "fluid": fluid}).step()["central_film_thickness"]
            gap, x, y = (np.array(r[name]) for name in ("film_thickness", "x", "y"))
            # in the middle, where the greatest pressure need not be
            film = np.interp(0.0, y, [np.interp(0.0, x, row) for row in gap])
            least = np.min(gap)
            cells = f"{film / unit:.3f} | {least / unit:.3f} | {100 * (film / fit - 1):+.1f}"
            print(f"| {load:g}, {growth:g} | {elements} | {cells} |")


if __name__ == "__main__":
    if sys.argv[1] == "--grid":
        refine()
    elif sys.argv[1] == "--moes":
        moes()
    else:
        draw(Path(sys.argv[1]))
