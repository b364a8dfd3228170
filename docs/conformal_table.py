"""The tables of conformal.md: python docs/conformal_table.py"""

from __future__ import annotations

import statistics
import time
from typing import Any

import numpy as np
import railpatch

PLACES = (-3.0, 0.0, 3.0, 5.0, 5.5, 6.0, 6.25, 6.5, 6.75, 7.0, 8.0)  # mm
REPEATS = 5


def wheel_case(y: float, surface: str) -> dict[str, Any]:
    return {
        "kind": "wheel_rail",
        "wheelset": {
            "y": 1e-3 * y,
            "vertical_force": 8e4,
            "speed": 20.0,
            "pitch_rate": -20.0 / 0.46,
            "nominal_radius": 0.46,
            "flange_back_distance": 1.36,
            "flange_back_position": -0.07,
        },
        "track": {"cant": 0.025},
        "profiles": {"wheel": "S1002", "rail": "UIC60"},
        "grid": {"element_size": [2.5e-4, 2.5e-4]},
        "friction": {"coefficient": 0.3},
        "method": {"reference_surface": surface, "patch_rule": "contact"},
    }


def solved(y: float, surface: str) -> tuple[railpatch.Result, float]:
    """The result and the median time of a cold solve (s)."""
    times = []
    for _ in range(REPEATS):
        contact = railpatch.Contact(wheel_case(y, surface))
        begin = time.perf_counter()
        result = contact.step(fields=True)
        times.append(time.perf_counter() - begin)
    assert result.status == "converged"
    return result, statistics.median(times)


def row(y: float) -> str:
    (plane, before), (curved, after) = (solved(y, surface) for surface in ("plane", "curved"))
    spans = []
    for patch in curved["patches"]:
        touching = patch["row_angle"][(patch["pressure"] > 0).any(axis=1)]
        spans.append(f"{np.degrees(touching[-1] - touching[0]):.0f}")
    cells = [f"{y:g}", ", ".join(spans)]
    for axis in (1, 0):
        cells += [f"{r['force'][axis] / 1e3:.2f}" for r in (plane, curved)]
    for key, unit, shown in (("max_pressure", 1e6, ".0f"), ("contact_area", 1e-6, ".1f")):
        reduce = max if key == "max_pressure" else sum
        cells += [
            format(reduce(p[key] for p in r["patches"]) / unit, shown) for r in (plane, curved)
        ]
    cells += [f"{r['moment'][2]:.0f}" for r in (plane, curved)]
    cells += [f"{1e3 * before:.0f}", f"{after / before:.1f}"]
    return "| " + " | ".join(cells) + " |"


def main() -> None:
    heads = ["y mm", "angle deg"]
    for name in ("lateral kN", "longitudinal kN", "pressure MPa", "area mm^2", "yaw moment N m"):
        heads += [f"{name}, plane", "curved"]
    heads += ["plane ms", "time ratio"]
    print("| " + " | ".join(heads) + " |")
    print("|" + "---|" * len(heads))
    for y in PLACES:
        print(row(y))


if __name__ == "__main__":
    main()
