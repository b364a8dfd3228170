"""Adhesion with water, oil and oxide: draws docs/fluids.svg.

Wheels of 0.46 m on rails of 0.30 m under 80 kN, steel. Top: adhesion over speed (both shares beside
the design line 13.6/(85 + V), dry 27.2/(85 + V)), temperature, roughness, water rate. Below: the
pressures along the middle of a contact by strips at 5, 20 and 72 m/s; creep curves dry, damp, wet,
oiled; a wheel set that brakes over a wet stretch, and those that follow on the cleaned rail.

    python docs/fluids.py docs/fluids.svg
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import numpy as np
import railpatch

STEEL = {"shear_modulus": 210e9 / 2.6, "poisson_ratio": 0.3}
RATIO = {"model": "film", "roughness": 0.5765e-6, "boundary_friction": 0.1485}
SHARED = {"model": "film", "share": "load_sharing", "roughness": 0.3565e-6}
SHARED |= {"boundary_friction": 0.1266}
WATER = {"liquid": "water", "temperature": 20.0}
# a braked wheelset: slip of 2 % at 20 m/s, 60 m dry, 120 m with 25 microlitres a second, 60 m dry
SPEED, CREEPAGE, STRETCH, TAU, RADIUS = 20.0, 0.02, (60.0, 180.0, 240.0), 2e-4, 0.46


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
    return railpatch.Contact(case if fluid is None else {**case, "fluid": fluid})


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
    temperatures = np.linspace(-5, 80, 40)
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
    """Wheelsets one behind the other over a wet stretch: each cleans the rail and itself."""
    x = np.arange(0.0, STRETCH[2], 1.0)
    spent = np.zeros_like(x)  # J/m, on each metre of the rail
    of = contact({"model": "regimes", "water_rate": 0.0, "recovery": {"coefficient": TAU}})
    for wheelset in range(1, 5):
        own, found = 0.0, []  # J/m of its circumference
        for place, before in zip(x, spent, strict=True):
            wet = STRETCH[0] <= place < STRETCH[1]
            result = of.step(
                creepage=[CREEPAGE, 0.0],
                rolling_speed=SPEED,
                water_rate=25e-9 if wet else 0.0,
                # nothing cleans what is dry
                rail_work=[0.0, before + own],
            )
            found.append(-result["creep_force"][0] / 80e3)
            # of this metre of the rail; of the wheel a turn takes 2 pi R metres
            work = result["friction_power"] / SPEED
            own += work / (2 * np.pi * RADIUS) if wet else 0.0
            spent[int(place)] += work if wet else 0.0
        panel.plot(x, found, label=f"wheelset {wheelset}")
    panel.set_xlabel("way [m]; 60 to 180 m damp, 25 microlitres/s")
    panel.set_ylabel("creep force over load")


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
