"""Wear over a wheel's profile, full theory beside FASTSIM: draws docs/damage.svg, prints numbers.

python docs/damage.py docs/damage.svg
"""

from __future__ import annotations

import sys
from typing import Any

import matplotlib.pyplot as plt
from railpatch import Contact
from railpatch.damage.distribution import Distribution

CASE: dict[str, Any] = {
    "kind": "wheelset",
    "wheelset": {"y": 0.0, "vertical_force": 120e3, "roll": "balanced", "speed": 20.0,
                 "pitch_rate": "free", "nominal_radius": 0.46, "flange_back_distance": 1.36,
                 "flange_back_position": -0.07},
    "track": {"kind": "rail", "gauge": 1.435, "gauge_height": 0.014},
    "profiles": {"wheel": "S1002", "rail": "UIC60@1:40"},
    "friction": {"coefficient": 0.3},
}  # fmt: skip
METHODS = {
    "full theory": {"method": {}, "damage": {}},
    "FASTSIM": {"method": {"tangential": "fastsim"}, "damage": {}},
    "full theory, by patch": {"method": {}, "damage": {"basis": "patch"}},
}
POSITIONS = ((0.0, 0.0), (2e-3, 3e-4), (3e-3, 6e-4), (4e-3, 1e-3))  # m, rad: y, yaw
WAY = 1e5  # m, at each


def worn(tables: dict[str, Any]) -> Distribution:
    """Of the right wheel, over all positions."""
    contact, found = Contact({**CASE, **tables}), Distribution()
    for y, yaw in POSITIONS:
        contact.step(y=y, yaw=yaw)
        for share, rows in contact.wear_rows()["right"]:
            found.add(rows, WAY, share)
    return found


def main(target: str) -> None:
    """Draws and prints."""
    figure, axes = plt.subplots(figsize=(7.2, 3.4), layout="constrained")
    for name, tables in METHODS.items():
        found = worn(tables)
        depth = 1e6 * found.depth("wheel", 7850.0, 2 * 3.141592653589793 * 0.46)
        axes.plot(1e3 * found.y, depth, label=name)
        print(f"| {name} | {1e3 * found.mass('wheel'):.1f} | {depth.max():.1f} |")
    axes.set(xlabel="y of the wheel's profile, mm", ylabel="wear depth, um", xlim=(-45, 25))
    axes.legend(frameon=False)
    figure.savefig(target)


if __name__ == "__main__":
    main(sys.argv[1])
