"""Makes docs/dipped_joint.svg and prints the table of docs/vehicle.md. Takes half a minute.

python docs/dipped_joint.py FILE.svg
"""

from __future__ import annotations

import math
import sys
from dataclasses import replace
from pathlib import Path

import matplotlib
import numpy as np

matplotlib.use("svg")
import matplotlib.pyplot as plt

from wheelset_demo.vehicle import Simulation, VehicleScene, load_vehicle_scene
from wheelset_demo.vehicle.alignment import AlignmentTable
from wheelset_demo.vehicle.deviations import DipTable
from wheelset_demo.vehicle.support import SupportTable

MASS, STIFFNESS, DAMPING = 245.0, 62e6, 55.4e3  # kg, N/m, N s/m, of one wheel
TRACK = SupportTable(rail_mass=MASS, pad_stiffness=[20e6, STIFFNESS], pad_damping=[20e3, DAMPING])
LENGTH, STEP = 4.0, 1e-4  # m, s
CASES = ((0.005, 20.0), (0.005, 40.0), (0.01, 20.0), (0.01, 40.0), (0.01, 60.0), (0.02, 40.0))
DRAWN = (0.01, 40.0)
HEADER = (
    *("2 alpha, mrad", "km/h", "formula, kN", "pad spring, kN", "ratio"),
    *("pad, damper too, kN", "contact (P1), kN"),
)


def jenkins(angle: float, speed: float, unsprung: float) -> float:
    """N, P2 - P0."""
    both = unsprung + MASS
    damped = 1 - math.pi * DAMPING / (4 * math.sqrt(STIFFNESS * both))
    return angle * speed * math.sqrt(unsprung / both) * damped * math.sqrt(STIFFNESS * unsprung)


def scene_of(angle: float, speed: float) -> VehicleScene:
    """The packaged coach on straight track with one joint in both rails."""
    scene = load_vehicle_scene().with_method(normal="hertz", tangential="fastsim")
    first = scene.vehicle.length
    dip = DipTable(position=first + 0.6 + 0.5 * LENGTH, angle=angle, length=LENGTH)
    scene = scene.with_run(duration=(0.5 * LENGTH + 0.7) / speed + 0.03, step=STEP, log_every=1)
    wheelset = scene.case.wheelset.model_copy(update={"speed": speed})
    case = scene.case.model_copy(update={"wheelset": wheelset})
    return replace(
        scene, case=case, alignment=AlignmentTable(), irregularity=None, support=TRACK, dip=(dip,)
    )


def forces(scene: VehicleScene) -> np.ndarray:
    """[n, 4]: m from the joint, N of the leading left wheel's contact, of its pad's spring, and of
    pad's spring and damper."""
    simulation, rows = Simulation(scene), []
    below = simulation.system.support
    assert below is not None
    for _ in simulation.steps():
        away = simulation.system.positions[0] - scene.dip[0].position
        load = -simulation.element.wheels[0, 0, 2]
        rows.append([away, load, STIFFNESS * below.place[0, 1], below.forces[0, 1]])
    return np.array(rows)


def main() -> None:
    """Figure and table."""
    print("| " + " | ".join(HEADER) + " |\n" + "|---" * len(HEADER) + "|")
    for angle, speed in CASES:
        scene = scene_of(angle, speed)
        vehicle = scene.vehicle
        wanted = jenkins(angle, speed, 0.5 * vehicle.wheelset[0].mass_on_rails)
        found = forces(scene)
        before = found[found[:, 0] < -0.02][-1]
        contact, spring, pad = (found[:, k].max() - before[k] for k in (1, 2, 3))
        cells = [f"{1e3 * angle:g}", f"{3.6 * speed:g}", f"{wanted / 1e3:.1f}"]
        cells += [f"{spring / 1e3:.1f}", f"{spring / wanted:.3f}", f"{pad / 1e3:.1f}"]
        print("| " + " | ".join([*cells, f"{contact / 1e3:.1f}"]) + " |")
        if (angle, speed) == DRAWN:
            draw(found, before, wanted, speed)


def draw(found: np.ndarray, before: np.ndarray, wanted: float, speed: float) -> None:
    """Of one case, over the way from the joint."""
    plt.rcParams.update({"svg.hashsalt": "joint", "font.size": 8, "path.simplify_threshold": 1.0})
    _, axis = plt.subplots(figsize=(7, 3), constrained_layout=True)
    time = 1e3 * found[:, 0] / speed
    for column, name, colour in ((1, "contact", "C1"), (2, "pad spring", "C0")):
        axis.plot(time, found[:, column] / 1e3, colour, lw=0.9, label=name)
    level = (before[2] + wanted) / 1e3
    axis.axhline(level, color="0.4", lw=0.8, ls="--", label="P2 of Jenkins et al. 1974")
    axis.set(xlabel="ms from the joint", ylabel="force below the leading wheel, kN", xlim=(-10, 30))
    axis.legend()
    plt.savefig(Path(sys.argv[1]), metadata={"Date": None})


if __name__ == "__main__":
    main()
