"""Runs an FMU once with fmpy and prints what comes out: python -m railpatch.fmu.try_out NAME.fmu"""

from __future__ import annotations

import sys

import numpy as np

SHOWN = ("status", "z", "force[1]", "force[2]", "force[3]", "creep_force[1]", "creep_force[2]")


def main() -> None:
    """Validates, simulates 100 steps with the start values, prints the last ones."""
    from fmpy import read_model_description, simulate_fmu
    from fmpy.validation import validate_fmu

    path = sys.argv[1]
    problems = validate_fmu(path)
    if problems:
        sys.exit("\n".join([f"{path}: fmpy finds", *problems]))
    description = read_model_description(path)
    names = [v.name for v in description.modelVariables if v.causality == "output"]
    rows = simulate_fmu(
        path, stop_time=0.1, step_size=1e-3, output_interval=1e-3, output=names, set_stop_time=False
    )
    if not all(np.isfinite(rows[name]).all() for name in names):
        sys.exit(f"{path}: an output is not finite")
    print(f"{path}: valid, {len(rows)} points simulated")
    for name in SHOWN:
        if name in names:
            print(f"  {name:<16}{rows[name][-1]:.6g}")


if __name__ == "__main__":
    main()
