"""A published regression as a match: the creep curve of the VT-FRA roller rig.

    python docs/match_regression.py -o DIR

The thesis on the rig's statistics (2020) gives the longitudinal force over the creepage c in per
cent, 0 to 2, as F = -934.06 + 1014.52 c + 5281.21 sqrt(c) - 966.37 c^2 N with a residual standard
error of 224.8 N. 40 points of it from 0.05 % on, with normal noise of that size (seed 0), are
matched as a record of a patch. Load, speed and contact are not part of the regression: 10 kN, 1 m/s
and an ellipse of 3 by 2 mm stand for them. Friction coefficients are those of that load, halving
speeds those of that speed, and k_A and k_S those of that ellipse; forces and creepages that follow
from them are the rig's.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np
from railpatch.match import load_match, run_match, write_match

ERROR, POINTS = 224.8, 40
MATCH = """
kind = "patch"

[geometry]
semi_axes = [3e-3, 2e-3]

[load]
normal_force = 10e3

[friction]
law = "slip_velocity"
kinetic = 0.3
amplitude = 0.3
halving_speed = 0.02

[motion]
creepage = [0.0, 0.0]
rolling_speed = 1.0

[method]
normal = "hertz"
tangential = "polach"
polach_k_a = 0.3
polach_k_s = 0.3

[match]
record = "curve.csv"
loss = "linear"

[match.inputs]
"creepage[0]" = { name = "creepage" }

[match.observed]
"creep_force[0]" = { name = "force", unit = "N", sign = -1, error = 224.8 }

[match.seek]
"friction.kinetic" = { low = 0.01, high = 1.0 }
"friction.amplitude" = { low = 0.01, high = 1.0 }
"friction.halving_speed" = { low = 1e-3, high = 0.1, logarithmic = true }
"method.polach_k_a" = { low = 0.01, high = 1.0, logarithmic = true }
"method.polach_k_s" = { low = 0.01, high = 1.0, logarithmic = true }

[match.explanations.coulomb]
leave_out = ["friction"]
change = { "friction.coefficient" = 0.5 }

[match.explanations.coulomb.seek]
"friction.coefficient" = { low = 0.05, high = 1.0 }
"method.polach_k_a" = { low = 0.01, high = 1.0, logarithmic = true }
"method.polach_k_s" = { low = 0.01, high = 1.0, logarithmic = true }
"""


def regression(c: np.ndarray) -> np.ndarray:
    """N, over the creepage in per cent."""
    return -934.06 + 1014.52 * c + 5281.21 * np.sqrt(c) - 966.37 * c**2


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("-o", "--output", type=Path, required=True)
    folder = parser.parse_args().output
    folder.mkdir(parents=True, exist_ok=True)
    creepage = np.linspace(0.05, 2.0, POINTS)
    noise = ERROR * np.random.default_rng(0).standard_normal(POINTS)
    rows = zip(creepage, regression(creepage) + noise, strict=True)
    lines = ["creepage [%],force [N]", *(f"{c:.4g},{f:.6g}" for c, f in rows)]
    (folder / "curve.csv").write_text("\n".join(lines) + "\n")
    (folder / "regression.toml").write_text(MATCH)
    found = run_match(load_match(folder / "regression.toml"), tell=print)
    write_match(found, folder / "out")
    for own in found.explanations:
        held = own.predicted
        assert held is not None
        # computed is the force on the wheel, against the creepage
        left = regression(creepage) + own.fit.computed[0]
        print(
            f"\n{own.explanation.name}: rms {own.fit.rms[0]:.0f} N, of points left out "
            f"{held.rms[0]:.0f} N, {100 * held.within:.0f} % inside; from the regression itself "
            f"{np.sqrt(np.mean(left**2)):.0f} N; Akaike {own.criterion:.1f}, of the model "
            f"{own.fit.noise.size:.2g} of a point's error"
        )
        for p in own.parameters:
            print(f"  {p.key:<26}{p.value:<10.4g}{p.low:.4g} to {p.high:.4g}")
        print("\n".join(f"  {text}" for text in own.not_told))


if __name__ == "__main__":
    main()
