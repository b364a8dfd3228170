"""Time of the force element beyond the contact solve, by wall-clock time on this machine.

python docs/force_element_cost.py
"""

from __future__ import annotations

import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests"))

import mbs_samples as samples
import numpy as np
import pinocchio as pin
from railpatch.pinocchio import ForceElement

STEPS = 300
SCENES = {
    "Hertz and FASTSIM, 8 x 8": {"normal": "hertz", "tangential": "fastsim"},
    "half-space and full theory, 8 x 8": {"normal": "half_space", "tangential": "full"},
}


def measure(method: dict[str, str]) -> dict[str, float]:
    """us, medians over steps along a wave: whole call, contact solve by the library's clock around
    it, the rest; and the solve's stages by the observer."""
    model = samples.model()
    data, fext = model.createData(), samples.no_forces(model)
    element = ForceElement(model, "wheelset", samples.case(method=method), timing=True)
    times = []
    for index in range(STEPS):
        q = samples.rolling(0, 1e-3 * np.sin(0.05 * index), 0, 0, 1e-3 * np.cos(0.05 * index), 0)
        pin.forwardKinematics(model, data, q, samples.RATES)
        before, begin = element.solve_seconds, time.perf_counter()
        element.step(data, fext)
        whole = time.perf_counter() - begin
        times.append([whole, element.solve_seconds - before])
    whole, solve = 1e6 * np.array(times).T
    stages = sum(stage["seconds"] for stage in element.contacts[0].stages())
    return {
        "step": float(np.median(whole)),
        "solve": float(np.median(solve)),
        "beyond": float(np.median(whole - solve)),
        "beyond, 95 %": float(np.percentile(whole - solve, 95)),
        "stages, mean": 1e6 * stages / STEPS,
    }


def lines() -> list[str]:
    """One for each scene."""
    found = []
    for name, method in SCENES.items():
        values = ", ".join(f"{key} {value:.1f}" for key, value in measure(method).items())
        found.append(f"force element, us, {name}: {values}")
    return found


if __name__ == "__main__":
    print(*lines(), sep="\n")
