"""How well `railpatch match` knows parameters of a rig: synthetic rigs with known ones.

    python docs/match_synthetic.py --rigs 100 [--first 0] [--intervals profile] [--rows out.csv]

Each rig is that of rig_model/synthetic.py with random values, its number as the seed: friction
coefficient 0.3 to 0.6, layer of 20 to 200 um, frame of 5 to 50 MN/m, an offset of the measured
lateral position within 1 mm. Its run of 15 to 100 positions has noise of 0.5 to 3 % of half the
load in lateral and longitudinal forces of both wheels (60 to 400 numbers). The match starts from
the middle of wide ranges and is told nothing of the noise. Printed: of intervals of 95 % how many
hold the truth, the mean difference of value and truth in half widths of the interval, and the time
of a match.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
from railpatch.match import load_match, run_match

from rig_model.synthetic import OFFSET, SEEK, write_synthetic


def truth_of(random: np.random.Generator) -> dict[str, float]:
    """Random values of what is sought."""
    return {
        "friction.coefficient": random.uniform(0.3, 0.6),
        "layer.thickness": float(np.exp(random.uniform(np.log(2e-5), np.log(2e-4)))),
        "rig.frame.stiffness": float(np.exp(random.uniform(np.log(5e6), np.log(5e7)))),
        OFFSET: random.uniform(-1.0, 1.0),
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--rigs", type=int, default=100)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--elements", type=float, default=1.2e-3, help="m, of the grid")
    parser.add_argument("--intervals", choices=("profile", "covariance"), default="profile")
    parser.add_argument("--rows", type=Path, help="a CSV file that gets a line for each rig")
    options = parser.parse_args()
    inside: dict[str, list[bool]] = {key: [] for key in SEEK}
    bias: dict[str, list[float]] = {key: [] for key in SEEK}
    times, clocks = [], []
    for seed in range(options.first, options.first + options.rigs):
        random = np.random.default_rng(seed)
        truth = truth_of(random)
        count, noise = int(random.integers(15, 101)), random.uniform(0.005, 0.03)
        with tempfile.TemporaryDirectory() as folder:
            path = write_synthetic(
                Path(folder), truth, count=count, noise=noise, random=random,
                elements=options.elements,
            )  # fmt: skip
            plan = load_match(path)
            table = plan.table.model_copy(
                update={
                    "starts": 1, "folds": 0, "discrepancy": False, "intervals": options.intervals,
                }
            )  # fmt: skip
            begin, clock = time.process_time(), time.perf_counter()
            found = run_match(replace(plan, table=table))
            times.append(time.process_time() - begin)
            clocks.append(time.perf_counter() - clock)
        line = [f"{seed}", f"{times[-1]:.1f}"]
        for key, value in truth.items():
            own = found.parameters[key]
            inside[key].append(own.low < value < own.high)
            # of a logarithm where that is sought
            measure = np.log if SEEK[key].get("logarithmic") else float
            at, true, low, high = (measure(v) for v in (own.value, value, own.low, own.high))
            bias[key].append((at - true) / (0.5 * (high - low)))
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
