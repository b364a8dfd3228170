"""How well `railpatch match` knows parameters of a rig: synthetic rigs with known ones.

    python docs/match_synthetic.py --rigs 100 [--first 0] [--intervals profile] [--rows out.csv]

Each rig is that of rig_model/synthetic.py with random values, its number as the seed: friction
coefficient 0.3 to 0.6, shear modulus of a layer of 50 um 2 to 20 GPa, a frame of 5 to 50 MN/m, an
offset of the measured lateral position within 1 mm, and friction that rises or falls to 0.7 to 1.5
of its first value with the work done where a wheel runs. Its run of 10 to 66 positions has noise of
0.5 to 3 % of a wheel's load in the three forces of both wheels (60 to 396 numbers). The match
starts from the middle of wide ranges and is told nothing of the noise. Printed: of intervals of 95
% how many hold the truth, the mean difference of value and truth in widths of the interval, and the
time of a match.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
from railpatch.match import load_match, run_match

from rig_model.synthetic import FORCES, OFFSET, VERTICAL, write_synthetic

PLATEAU = "rig.conditioning.plateau"
# what is sought; the offset is in mm as its column
SEEK = {
    "friction.coefficient": {"low": 0.1, "high": 0.9},
    "layer.shear_modulus": {"low": 2e8, "high": 2e11, "logarithmic": True},
    "rig.frame.stiffness": {"low": 1e6, "high": 2e8, "logarithmic": True},
    OFFSET: {"low": -2.0, "high": 2.0},
    PLATEAU: {"low": 0.3, "high": 2.0},
}
# J/m, with which half of a run's friction work changes friction, of 37 positions of 10 s
WORK = 3e6
MATCH = {"starts": 1, "folds": 0, "discrepancy": False}


def truth_of(random: np.random.Generator) -> dict[str, float]:
    """Random values of what is sought."""

    def logarithmic(low: float, high: float) -> float:
        return float(np.exp(random.uniform(np.log(low), np.log(high))))

    return {
        "friction.coefficient": random.uniform(0.3, 0.6),
        "layer.shear_modulus": logarithmic(2e9, 2e10),
        "rig.frame.stiffness": logarithmic(5e6, 5e7),
        OFFSET: random.uniform(-1.0, 1.0),
        PLATEAU: random.uniform(0.7, 1.5),
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--rigs", type=int, default=100)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--elements", type=float, default=1.5e-3, help="m, of the grid")
    parser.add_argument("--intervals", choices=("profile", "covariance"), default="profile")
    parser.add_argument("--rows", type=Path, help="a CSV file that gets a line for each rig")
    options = parser.parse_args()
    inside: dict[str, list[bool]] = {key: [] for key in SEEK}
    bias: dict[str, list[float]] = {key: [] for key in SEEK}
    times, clocks = [], []
    for seed in range(options.first, options.first + options.rigs):
        random = np.random.default_rng(seed)
        truth = truth_of(random)
        count, noise = int(random.integers(10, 67)), random.uniform(0.005, 0.03)
        with tempfile.TemporaryDirectory() as folder:
            path = write_synthetic(
                Path(folder), truth, count=count, noise=noise, random=random,
                elements=options.elements, seek=SEEK, forces=FORCES | VERTICAL,
                tables={"conditioning": {"plateau": 1.0, "work": WORK}},
            )  # fmt: skip
            plan = load_match(path)
            table = plan.table.model_copy(update=MATCH | {"intervals": options.intervals})
            begin, clock = time.process_time(), time.perf_counter()
            found = run_match(replace(plan, table=table))
            times.append(time.process_time() - begin)
            clocks.append(time.perf_counter() - clock)
        line = [f"{seed}", f"{count}", f"{noise:.4f}", f"{times[-1]:.1f}"]
        for key, value in truth.items():
            own = found.parameters[key]
            inside[key].append(own.low < value < own.high)
            # of a logarithm where that is sought
            measure = np.log if SEEK[key].get("logarithmic") else float
            at, true, low, high = (measure(v) for v in (own.value, value, own.low, own.high))
            bias[key].append((at - true) / (high - low))
            line += [f"{value:.6g}", f"{own.value:.6g}", f"{own.low:.6g}", f"{own.high:.6g}"]
        print(" ".join(line), flush=True)
        if options.rows:
            with options.rows.open("a") as file:
                file.write(",".join(line) + "\n")
    print(
        f"\n{len(times)} rigs; processor time of a match {np.median(times):.0f} s (median), "
        f"{np.max(times):.0f} s at most; by the clock {np.median(clocks):.0f} s (median)"
    )
    for key in SEEK:
        print(f"{key:<40}{sum(inside[key])} of {len(times)} inside, bias {np.mean(bias[key]):+.2f}")


if __name__ == "__main__":
    main()
