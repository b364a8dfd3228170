"""Adhesion with water, oil and oxide: draws docs/fluids.svg.

Wheels of 0.46 m on rails of 0.30 m under 80 kN, steel. Top: adhesion over speed (both shares beside
the design line 13.6/(85 + V), dry 27.2/(85 + V)), temperature, roughness, water rate. Below: the
pressures along the middle of a contact by strips at 5, 20 and 72 m/s; creep curves dry, damp, wet,
oiled; a locomotive that brakes on a wet stretch, whose following wheels meet cleaned rails.

    python docs/fluids.py docs/fluids.svg
"""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import railpatch
from railpatch.case.fluid import Fluid

from wheelset_demo.scene import scene_file
from wheelset_demo.vehicle import Simulation, load_vehicle_scene
from wheelset_demo.vehicle.wet_track import WetTable

STEEL = {"shear_modulus": 210e9 / 2.6, "poisson_ratio": 0.3}
RATIO = {"model": "film", "roughness": 0.5765e-6, "boundary_friction": 0.1485}
SHARED = {"model": "film", "share": "load_sharing", "roughness": 0.3565e-6}
SHARED |= {"boundary_friction": 0.1266}
WATER = {"liquid": "water", "temperature": 20.0}
SPEED = 20.0  # m/s
# a braked locomotive: s, when the brakes come on; N m; m, where it is damp; 1/N
BRAKED, TORQUE, STRETCH, TAU = 1.5, 46875.0, (20.0, 80.0), 2e-4


def contact(fluid: dict[str, Any] | None, **tables: Any) -> railpatch.Contact:
    """Full sliding, or what the tables say."""
    case: dict[str, Any] = {
        "kind": "patch",
        "material": STEEL,
        "geometry": {"curvatures": [0.5 / 0.46, 0.5 / 0.30]},
        "load": {"normal_force": 80e3},
        "motion": {"creepage": [0.05, 0.0], "rolling_speed": 10.0},
        "friction": {"coefficient": 0.5},
        "method": {"normal": "hertz", "tangential": "polach"},
        **tables,
    }
    if fluid is not None:
        case["fluid"] = fluid
        if fluid["model"] == "regimes":  # whose knots have friction of their own
            del case["friction"]
    return railpatch.Contact(case)


def friction(of: railpatch.Contact, **changes: Any) -> float:
    """Adhesion that a step finds."""
    result = of.step(**changes)
    if result.status != "converged":
        sys.exit(f"{changes}: {result.reason}")
    return float(result["effective_friction"])


def over_speed(panel: Any) -> None:
    """Both shares, and the lines."""
    speeds = np.linspace(5, 300, 60)
    for fluid, label in ((RATIO, "film_ratio"), (SHARED, "load_sharing")):
        of = contact({**fluid, **WATER})
        panel.plot(speeds, [friction(of, rolling_speed=v / 3.6) for v in speeds], label=label)
    panel.plot(speeds, 13.6 / (85 + speeds), "k--", lw=1, label="13.6/(85 + V)")
    panel.plot(speeds, 27.2 / (85 + speeds), "k:", lw=1, label="dry, 27.2/(85 + V)")
    panel.plot([260], [0.04], "ko", ms=4, label="measured, 260 km/h")
    panel.set_xlabel("speed [km/h]")
    panel.set_ylabel("adhesion")
    panel.set_ylim(0, 0.32)


def over_temperature(panel: Any) -> None:
    """At three speeds."""
    temperatures = np.linspace(1, 80, 40)
    of = contact({**RATIO, **WATER})
    for speed in (10.0, 40.0, 72.2):
        found = [friction(of, rolling_speed=speed, water_temperature=t) for t in temperatures]
        panel.plot(temperatures, found, label=f"{speed:g} m/s")
    panel.set_xlabel("water [degrees C]")


def over_roughness(panel: Any) -> None:
    """Both shares at 40 m/s."""
    heights = np.geomspace(1e-7, 5e-6, 40)
    for fluid, label in ((RATIO, "film_ratio"), (SHARED, "load_sharing")):
        found = [
            friction(contact({**fluid, **WATER, "roughness": h}), rolling_speed=40.0)
            for h in heights
        ]
        panel.semilogx(1e6 * heights, found, label=f"{label}, 40 m/s")
    panel.set_xlabel("roughness [um]")


def over_rate(panel: Any) -> None:
    """The film starved, and the regimes."""
    rates = np.geomspace(1e-11, 1e-5, 60)
    of = contact({**RATIO, **WATER})
    found = [friction(of, rolling_speed=20.0, water_rate=q) for q in rates]
    panel.semilogx(1e9 * rates, found, label="film, 20 m/s")
    of = contact({"model": "regimes", "water_rate": 0.0})
    found = [-of.step(rolling_speed=20.0, water_rate=q)["creep_force"][0] / 80e3 for q in rates]
    panel.semilogx(1e9 * rates, found, label="regimes, 5 % creepage")
    panel.set_xlabel("water [microlitres/s]")


def pressures(panel: Any) -> None:
    """Along the middle row, liquid and asperities."""
    fluid = {"model": "strip", "roughness": 0.5e-6, "boundary_friction": 0.15, **WATER}
    of = contact(
        fluid, grid={"elements": [80, 21]}, method={"normal": "hertz", "tangential": "full"}
    )
    for speed, colour in ((5.0, "tab:blue"), (20.0, "tab:orange"), (72.2, "tab:green")):
        result = of.step(fields=True, rolling_speed=speed)
        middle = len(result["y"]) // 2
        x = 1e3 * np.array(result["x"])
        liquid = np.array(result["fluid_pressure"])[middle] / 1e6
        panel.plot(x, liquid, color=colour, label=f"liquid, {speed:g} m/s")
        whole = np.array(result["pressure"])[middle] / 1e6
        panel.plot(x, whole - liquid, color=colour, ls=":", lw=1)
    panel.plot(x, whole, "k", lw=1, label="nominal")
    panel.set_xlabel("x [mm], rolling to the right; dotted: asperities")
    panel.set_ylabel("pressure [MPa]")


def creep_curves(panel: Any) -> None:
    """Dry, damp, wet by regimes, oil by its film."""
    creepages = np.geomspace(1e-4, 0.3, 70)
    curves = [
        (contact({"model": "regimes", "water_rate": rate}), f"{label} (regimes)")
        for rate, label in ((0.0, "dry"), (25e-9, "damp"), (1e-6, "wet"))
    ]
    curves.append((contact({**RATIO, **WATER}), "wet (film)"))
    oil = {"model": "film", "roughness": 1e-6, "boundary_friction": 0.12}
    oil |= {"liquid": "oil", "viscosity": 0.1, "oil_film": 1e-6}
    curves.append((contact(oil), "oiled (film, 1 um)"))
    for of, label in curves:
        found = [
            -of.step(creepage=[c, 0.0], rolling_speed=SPEED)["creep_force"][0] / 80e3
            for c in creepages
        ]
        panel.semilogx(100 * creepages, found, label=label)
    panel.set_xlabel("creepage [%]")
    panel.set_ylabel("creep force over load")


def braking(panel: Any) -> None:
    """A locomotive brakes on a wet stretch: each wheelset cleans itself and the rails for the
    next."""
    scene = load_vehicle_scene(scene_file("locomotive.toml"))
    scene = scene.with_run(step=2e-3, log_every=1, duration=6.0).with_method(tangential="polach")
    damp = {"model": "regimes", "water_rate": 0.0, "recovery": {"coefficient": TAU}}
    liquid = {"friction": None, "fluid": Fluid(**damp)}
    torque = [[0.0, 0.0], [BRAKED, 0.0], [BRAKED + 0.5, -TORQUE]]
    drives = [one.model_copy(update={"torque": torque}) for one in scene.vehicle.drive]
    wet = WetTable(position=STRETCH[0], length=STRETCH[1] - STRETCH[0], water_rate=25e-9)
    simulation = Simulation(
        replace(
            scene,
            case=scene.case.model_copy(update=liquid),
            vehicle=scene.vehicle.model_copy(update={"drive": drives}),
            wet=(wet,),
        )
    )
    places, found = [], []
    for _ in simulation.steps():
        wheels = simulation.element.wheels
        places.append(simulation.system.positions.copy())
        found.append(wheels[:, :, 0].sum(axis=1) / wheels[:, :, 2].sum(axis=1))
    cells = np.floor(2.0 * np.array(places)).astype(int)
    for k in range(len(found[0])):
        count = np.bincount(cells[:, k])
        mean = np.bincount(cells[:, k], np.array(found)[:, k]) / np.maximum(count, 1)
        there = np.nonzero(count)[0]
        panel.plot(0.5 * there + 0.25, mean[there], label=f"wheelset {k + 1}")
    panel.set_xlabel(
        f"way [m]; {STRETCH[0]:g} to {STRETCH[1]:g} m damp, 25 microlitres/s a contact"
    )
    panel.set_ylabel("braking force over load")


def main() -> None:
    import matplotlib

    matplotlib.use("svg")
    from matplotlib import pyplot

    matplotlib.rcParams.update({"svg.hashsalt": "railpatch", "font.size": 8})
    figure = pyplot.figure(figsize=(11.0, 6.4), layout="constrained")
    top, bottom = figure.subfigures(2, 1, height_ratios=(1, 1.15))
    upper = top.subplots(1, 4, sharey=False)
    lower = bottom.subplots(1, 3)
    draw = (over_speed, over_temperature, over_roughness, over_rate)
    for panel, of in zip((*upper, *lower), (*draw, pressures, creep_curves, braking), strict=True):
        of(panel)
        panel.grid(alpha=0.3)
        panel.set_ylim(bottom=0)
        panel.legend(fontsize=6.5)
    path = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).with_suffix(".svg"))
    figure.savefig(path, metadata={"Date": None, "Creator": None})
    print(path)


if __name__ == "__main__":
    main()
