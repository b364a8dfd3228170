"""Check values and cost of stresses below the surface: draws docs/subsurface.svg, prints a table.

python docs/subsurface.py docs/subsurface.svg
"""

from __future__ import annotations

import math
import sys
import time

import numpy as np
from railpatch import Contact, Subsurface

A, PEAK, FRICTION = 4e-3, 1e9, 0.3


def contact(elements: int, creepage: float, friction: float = FRICTION) -> Contact:
    """A circle under Hertz' pressure, after a step."""
    found = Contact(
        {
            "kind": "patch",
            "geometry": {"semi_axes": [A, A]},
            "load": {"normal_force": 2 * math.pi * A**2 * PEAK / 3},
            "material": {"shear_modulus": 82e9, "poisson_ratio": 0.3},
            "grid": {"elements": [elements, elements]},
            "method": {"normal": "hertz"},
            "friction": {"coefficient": friction},
            "motion": {"rolling_speed": 20.0, "creepage": [creepage, 0.0]},
        }
    )
    found.step()
    return found


def axis(elements: int, depths: np.ndarray) -> tuple[float, float]:
    """Greatest shear below the middle of the circle without friction in p0, its depth in a."""
    below = Subsurface(contact(elements, 0.0), depths)
    points = np.stack([np.zeros_like(depths), np.zeros_like(depths), depths], axis=1)
    stress, _ = below.at(points)
    shear = 0.5 * np.abs(stress[:, 0] - stress[:, 2]) / PEAK
    return float(shear.max()), float(depths[shear.argmax()] / A)


def milliseconds(elements: int, count: int) -> float:
    """Of one solution at so many depths, memory and coefficients warm; the best of 20."""
    below = Subsurface(contact(elements, 2e-3), np.linspace(0.2e-3, 8e-3, count))
    below.solve()
    times = []
    for _ in range(20):
        start = time.perf_counter()
        below._core.solve(1, 0, 1)
        times.append(time.perf_counter() - start)
    return 1e3 * min(times)


def draw(file: str) -> None:
    """Von Mises stress in the middle plane, without and with full slip."""
    import matplotlib

    matplotlib.use("svg")
    from matplotlib import pyplot

    matplotlib.rcParams.update({"svg.hashsalt": "railpatch", "font.size": 9})
    figure, panels = pyplot.subplots(1, 2, figsize=(8, 3.2), sharey=True, layout="constrained")
    depth = np.linspace(0.02e-3, 8e-3, 60)
    for panel, (creepage, title) in zip(
        panels, ((0.0, "no creepage"), (0.05, "full slip, friction 0.3")), strict=True
    ):
        found = Subsurface(contact(60, creepage), depth).solve(body="rail")
        row = len(found["y"]) // 2
        levels = np.linspace(0, 0.7, 15)
        shown = panel.contourf(
            1e3 * found["x"], 1e3 * depth, found["von_mises"][:, row] / PEAK, levels
        )
        panel.set_title(title)
        panel.set_xlabel("x, mm (rolling to the right)")
    panels[0].set_ylabel("depth in the rail, mm")
    panels[0].invert_yaxis()
    figure.colorbar(shown, ax=panels, label="von Mises stress, p0")
    figure.savefig(file, metadata={"Date": None})


def main() -> None:
    depths = np.arange(0.3, 0.7, 0.005) * A
    print("| elements | greatest shear, p0 | at the depth, a |\n|---|---|---|")
    for elements in (16, 32, 64):
        print("| {0} x {0} | {1:.4f} | {2:.3f} |".format(elements, *axis(elements, depths)))
    print("\n| elements | depths | ms |\n|---|---|---|")
    for elements, count in ((16, 16), (32, 16), (64, 16)):
        print(f"| {elements} x {elements} | {count} | {milliseconds(elements, count):.2f} |")
    draw(sys.argv[1])


if __name__ == "__main__":
    main()
