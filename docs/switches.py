"""Makes docs/switches.svg and prints the tables of docs/switches.md. Takes some 20 s.

python docs/switches.py FILE.svg
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np

matplotlib.use("svg")
import matplotlib.pyplot as plt
from railpatch import Contact
from railpatch.evidence.continuity.sweep import Path as Way
from railpatch.evidence.continuity.sweep import Sweep, measure
from railpatch.profiles import load_profile
from railpatch.profiles.turnout import (
    BLADE_DIVERGENCE,
    BLADE_TIP,
    DIVERGENCE,
    FLANGEWAY,
    KINDS,
    NOSE_TIP,
    case_of,
)

LOAD = 8e4  # N
ORIGIN = 0.7175  # m, of the right gauge line
# m: drawn from, to; measured from, to, coarse and fine steps
WAYS = {
    "blade": ((-0.2, 3.0, 0.005), (-0.3, 3.1, 5e-4, 5e-5)),
    "crossing": ((-0.2, 1.2, 0.0025), (-0.3, 1.3, 5e-4, 5e-5)),
}
WAVES, DEPTH, HOLLOW = 3, 2e-4, 3e-4  # waves of the radius round the wheel, m, m


def main() -> None:
    """Figure and tables."""
    figure, panels = plt.subplots(3, 3, figsize=(11, 8), layout="constrained")
    with tempfile.TemporaryDirectory() as folder:
        print("| | n | greatest jump, % of the load | of | at, m |\n|---|---|---|---|---|")
        for row, kind in enumerate(("blade", "crossing")):
            case = case_of(kind, Path(folder))
            draw_slices(panels[row, 0], kind)
            draw_way(panels[row, 1:], case, kind)
            found = jumps(case, kind)
            at, component = found.worst_at
            cells = [kind, len(found.samples), f"{found.worst:.3f}", component, f"{at:.4f}"]
            print("| " + " | ".join(map(str, cells)) + " |")
        draw_wheel(panels[2], Path(folder))
    figure.savefig(sys.argv[1])


def jumps(case: dict[str, Any], kind: str) -> Sweep:
    """By the rule of docs/continuity.md, along the track."""
    start, stop, coarse, fine = WAYS[kind][1]
    return measure(case, Way("x", lambda x: {"x": x}, start, stop, coarse, fine), LOAD)


def draw_slices(panel: Any, kind: str) -> None:
    """Every other one, by place."""
    slices = [part for part in KINDS[kind]() if part.position >= -0.3][::2]
    for k, part in enumerate(slices):
        colour = plt.get_cmap("viridis")(k / len(slices))
        panel.plot(*(1e3 * part.points.T), color=colour, lw=0.8, label=f"{part.position:.2g} m")
    panel.invert_yaxis()
    panel.set_xlabel("y from the gauge line [mm]")
    panel.set_ylabel(f"{kind}: z [mm]")
    panel.legend(fontsize=5, ncols=2)


def draw_way(panels: Any, case: dict[str, Any], kind: str) -> None:
    """Loads of both parts and the wheelset's height; the lateral force and the pressure."""
    start, stop, step = WAYS[kind][0]
    x = np.arange(start, stop, step)
    contact = Contact(case)
    rows = []
    for place in x:
        found = contact.step(x=float(place))
        assert found.status == "converged", (kind, place, found.status)
        loads = [0.0, 0.0]
        for patch in (*found["patches"], *found["alternatives"]):
            beyond = patch["position"][1] - ORIGIN > border(kind, float(place))
            loads[int(beyond)] += patch["share"] * patch["normal_force"]
        pressure = max(patch["max_pressure"] for patch in found["patches"])
        rows.append([*loads, found["z"], found["force"][1], pressure])
    values = np.array(rows)
    left, right = panels
    names = ("stock rail", "blade") if kind == "blade" else ("wing rail", "nose")
    left.plot(x, values[:, 1] / 1e3, "0.4", label=names[0])
    left.plot(x, values[:, 0] / 1e3, "C3", label=names[1])
    left.set_ylabel("normal force [kN]")
    left.set_xlabel("x from the tip [m]")
    left.legend(fontsize=7)
    height = left.twinx()
    height.plot(x, 1e3 * values[:, 2], "C0", lw=0.8)
    height.set_ylabel("wheelset's z [mm]", color="C0")
    height.invert_yaxis()
    right.plot(x, values[:, 3] / 1e3, "C3")
    right.set_ylabel("lateral force on the wheel [kN]", color="C3")
    right.set_xlabel("x from the tip [m]")
    pressure_panel = right.twinx()
    pressure_panel.plot(x, values[:, 4] / 1e9, "0.4", lw=0.8)
    pressure_panel.set_ylabel("greatest pressure [GPa]")
    change = np.flatnonzero((values[:, 0] > 0) & (values[:, 1] > 0))
    if change.size:
        print(f"<!-- {kind}: both parts carry from {x[change[0]]:.4g} to {x[change[-1]]:.4g} m -->")


def border(kind: str, x: float) -> float:
    """m from the gauge line, of blade and stock rail or of nose and wing rail."""
    if x < 0:
        return -1.0
    if kind == "blade":
        return BLADE_TIP + BLADE_DIVERGENCE * x
    return NOSE_TIP + DIVERGENCE * x + 0.5 * FLANGEWAY


def draw_wheel(panels: Any, folder: Path) -> None:
    """A wheel whose radius has three waves and whose tread is hollow at one side of it."""
    angles = 2 * np.pi * np.arange(24) / 24
    wheel = load_profile("S1002", "wheel")
    sections = []
    for k, angle in enumerate(angles):
        hollow = HOLLOW * 0.5 * (1 - np.cos(angle)) * np.exp(-((wheel.y / 0.02) ** 2))
        z = wheel.z + DEPTH * np.cos(WAVES * angle) - hollow
        name = folder / f"wheel_{k:02d}.txt"
        np.savetxt(name, 1e3 * np.column_stack([wheel.y, z]), fmt="%.9f")
        sections.append({"angle": float(angle), "profile": str(name)})
        if k in (0, 4, 12):
            panels[0].plot(1e3 * wheel.y, 1e3 * z, label=f"{np.degrees(angle):g}°")
    panels[0].set_xlim(-25, 60)
    panels[0].set_ylim(1.5, -2.5)
    panels[0].set_xlabel("y of the wheel's profile [mm]")
    panels[0].set_ylabel("out of round: z [mm]")
    panels[0].legend(fontsize=7)
    contact = Contact(wheel_case(sections))
    turn = np.linspace(0, 2 * np.pi, 361)
    steps = [contact.step(pitch=float(-angle)) for angle in turn]
    assert {step.status for step in steps} == {"converged"}
    degrees = np.degrees(turn)
    z = np.array([step["z"] for step in steps])
    radius = np.array([step["rolling_radius"] for step in steps])
    panels[1].plot(degrees, 1e3 * (z - z[0]), "C0", label="wheelset's z")
    panels[1].plot(degrees, 1e3 * (radius - radius[0]), "C3", label="rolling radius")
    panels[1].set_ylabel("change [mm]")
    panels[1].legend(fontsize=7)
    force = np.array([step["force"] for step in steps])
    panels[2].plot(degrees, force[:, 0] / 1e3, "C3", label="longitudinal")
    panels[2].plot(degrees, force[:, 1] / 1e3, "0.4", label="lateral")
    panels[2].set_ylabel("force on the wheel [kN]")
    panels[2].legend(fontsize=7)
    for panel in panels[1:]:
        panel.set_xlabel("angle rolled [°]")
    print(
        f"<!-- wheel: z {1e3 * np.ptp(z):.3f} mm, radius {1e3 * np.ptp(radius):.3f} mm, "
        f"Fx {np.ptp(force[:, 0]) / 1e3:.1f} kN -->"
    )


def wheel_case(sections: list[dict[str, Any]]) -> dict[str, Any]:
    """A wheel of these profiles round it."""
    return {
        "kind": "wheel_rail",
        "wheelset": {
            "y": 0.001,
            "vertical_force": LOAD,
            "speed": 20.0,
            "pitch_rate": -20.0 / 0.46,
            "nominal_radius": 0.46,
            "flange_back_distance": 1.36,
            "flange_back_position": -0.07,
            "right": {"sections": sections},
        },
        "track": {"gauge": 1.435, "section_blend": "cubic"},
        "profiles": {
            "wheel": "S1002",
            "rail": "UIC60@1:40",
            "smoothing": 0.0,
            "wheel_file": {"unit": "mm", "swap": False, "mirror": "none"},
        },
        "friction": {"coefficient": 0.3},
        "grid": {"elements": [16, 16]},
    }


if __name__ == "__main__":
    main()
