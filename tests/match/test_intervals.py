"""Ends of profile intervals beside the likelihood itself, where parameters are known together."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from railpatch import solve_many
from railpatch.case.load import check_case, plain, read_toml
from railpatch.match import load_match
from railpatch.match.fit import Search
from railpatch.match.interval import intervals_of
from railpatch.match.model import model_of
from scipy.stats import t as student

SCENE = """kind = "patch"
[material]
shear_modulus = 82e9
poisson_ratio = 0.28
[geometry]
semi_axes = [6e-3, 12e-3]
[load]
normal_force = 1e5
[motion]
creepage = [0.0, 0.0]
rolling_speed = 10.0
[friction]
law = "slip_velocity"
kinetic = 0.15
amplitude = 0.2
halving_speed = 1.5
[method]
normal = "hertz"
tangential = "polach"
[match]
record = "curve.csv"
loss = "linear"
starts = 1
sought = { "friction.kinetic" = [0.02, 0.3], "friction.amplitude" = [0.02, 0.4], \
"method.polach_k_s" = [0.05, 1.0] }
"""


def test_ends_are_where_the_likelihood_says(tmp_path: Path) -> None:
    """Kinetic friction and amplitude are known nearly only together (correlation below -0.9)."""
    path = tmp_path / "scene.toml"
    path.write_text(SCENE)
    content = plain(read_toml(path))
    del content["match"]
    check_case(content)
    creepage = np.linspace(5e-4, 4e-2, 40)
    states = {"creepage": np.column_stack([creepage, 0 * creepage])}
    force = np.asarray(solve_many(content, states)["creep_force"])[:, 0]
    force = force + 1500.0 * np.random.default_rng(4).standard_normal(len(force))
    rows = [f"{c:.8g},{f:.8g}" for c, f in zip(creepage, force, strict=True)]
    (tmp_path / "curve.csv").write_text("\n".join(["creepage,force", *rows]) + "\n")
    plan = load_match(path)
    search = Search(model_of(plan, plan.explanations[0], 1))
    fit = search.run()
    errors = np.sqrt(np.diag(fit.covariance))
    assert fit.covariance[0, 1] / (errors[0] * errors[1]) < -0.9
    assert fit.noise.size == 0
    fall = float(student.ppf(0.975, fit.noise.degrees)) ** 2
    assert 3.84 < fall < 4.3
    least = squares(search, fit.shares, fit)
    for k, ends in enumerate(intervals_of(search, fit, "profile")):
        for end in ends:
            if not 0.0 < end < 1.0:
                continue
            # 5 % of the half width are 10 % of the fall
            rise = least_at(search, fit, k, end) - least
            assert abs(rise - fall) < 0.15 * fall, (k, end, rise)


def squares(search: Search, shares: np.ndarray, fit) -> float:
    """Weighted, of all points."""
    left = search.computed(shares) - search.measured
    return float(np.sum((left / fit.noise.error[:, None]) ** 2))


def least_at(search: Search, fit, k: int, value: float) -> float:
    """By a simplex over the others, which takes no derivatives."""
    from scipy.optimize import minimize

    others = [i for i in range(len(fit.shares)) if i != k]

    def of(some: np.ndarray) -> float:
        shares = fit.shares.copy()
        shares[k] = value
        shares[others] = np.clip(some, 0.0, 1.0)
        return squares(search, shares, fit)

    guess = fit.shares + fit.covariance[:, k] / fit.covariance[k, k] * (value - fit.shares[k])
    found = minimize(of, guess[others], method="Nelder-Mead", options={"maxfev": 250})
    return float(found.fun)
