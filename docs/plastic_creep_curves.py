"""Traction over creepage with a plastic layer: draws docs/plastic_creep_curves.svg.

The two-dimensional case of Meierhofer et al. 2014 as in table 3 of the report DOT/FRA/ORD-24/18
(Vollebregt 2024), section 4.4.5, figure 41. k_rel = k_u/S, slope beyond yield over that of the
elastic part, gives the hardening k_tau = S k_rel/(1 - k_rel).

    python docs/plastic_creep_curves.py docs/plastic_creep_curves.svg
"""

from __future__ import annotations

import math
import sys
from pathlib import Path

import numpy as np
import railpatch

SHEAR_MODULUS, POISSON_RATIO = 77519.4e6, 0.29
FORCE, FRICTION, PEAK = 1323.6e3, 0.5, 1000e6  # N/m, -, Pa
HALF_LENGTH = 2 * FORCE / (math.pi * PEAK)
RADIUS = math.pi * HALF_LENGTH**2 * SHEAR_MODULUS / (1 - POISSON_RATIO) / (4 * FORCE)
SLOPE = 3121e9 * 3000e9 / (3121e9 - 3000e9)  # Pa/m, S of k_tau = 3121 and k_u = 3000 N/mm^3
WIDTH = 1e-3
YIELD_STRESSES = (200e6, 350e6)
RELATIVE = (-0.05, -0.02, 0.0, 0.01, 0.04, 0.1, 0.3)
CREEPAGES = np.concatenate([np.linspace(2e-4, 1e-2, 50), np.linspace(0.0105, 0.05, 80)])


def curve(relative: float | None, yield_stress: float) -> np.ndarray:
    """Coefficient of traction at CREEPAGES, each from the one before; None: no plastic layer."""
    case = {
        "kind": "patch",
        "material": {"shear_modulus": SHEAR_MODULUS, "poisson_ratio": POISSON_RATIO},
        "geometry": {"line_contact_radius": RADIUS, "width": WIDTH},
        "load": {"normal_force": FORCE * WIDTH},
        "grid": {"elements": [80, 1]},
        "motion": {"rolling_speed": 1.0},
        "friction": {"coefficient": FRICTION},
    }
    if relative is not None:
        hardening = SLOPE * relative / (1 - relative)
        case["layer"] = {"thickness": 0.0, "yield_stress": yield_stress, "hardening": hardening}
    contact = railpatch.Contact(case)
    found = []
    for creepage in CREEPAGES:
        result = contact.step(creepage=[-creepage, 0.0])
        if result.status != "converged":
            sys.exit(f"k_rel {relative}, creepage {creepage}: {result.status}")
        found.append(result["creep_force"][0] / (FORCE * WIDTH))
    return np.array(found)


def main() -> None:
    import matplotlib

    matplotlib.use("svg")
    from matplotlib import pyplot

    matplotlib.rcParams.update({"svg.hashsalt": "railpatch", "font.size": 9})
    figure, panels = pyplot.subplots(1, 2, figsize=(9.5, 4.0), sharey=True, layout="constrained")
    colours = pyplot.get_cmap("viridis")(np.linspace(0, 0.9, len(RELATIVE)))
    for panel, yield_stress in zip(panels, YIELD_STRESSES, strict=True):
        panel.plot(100 * CREEPAGES, curve(None, yield_stress), "k--", lw=1.2, label="no plasticity")
        for relative, colour in zip(RELATIVE, colours, strict=True):
            found = curve(relative, yield_stress)
            label = f"$k_{{rel}}$ = {relative:g}"
            panel.plot(100 * CREEPAGES, found, color=colour, lw=1.6, label=label)
        share = yield_stress / (FRICTION * PEAK)
        panel.set_title(rf"$\tau_{{c0}}$ = {yield_stress / 1e6:.0f} MPa, {share:g} of the bound")
        panel.set_xlabel("creepage [%]")
        panel.set_ylim(0, 0.55)
        panel.set_xlim(0, 5)
        panel.grid(alpha=0.3)
    panels[0].set_ylabel("coefficient of traction")
    panels[1].legend(loc="lower right", ncols=2)
    path = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).with_suffix(".svg"))
    figure.savefig(path, metadata={"Date": None, "Creator": None})
    print(path)


if __name__ == "__main__":
    main()
