"""Work of shift that turns round: friction's, the layer's, and what the rigid slip supplies.

A ball on a plane moved to and fro (Mindlin and Deresiewicz 1953; Johnson 1985, section 7.4): with
q = Q/(mu P) a cycle between -Q and Q takes

    9 (2 - nu) mu^2 P^2/(5 a G) (1 - (1 - q)^(5/3) - 5/6 q (1 + (1 - q)^(2/3))),

at the displacement 3 (2 - nu) mu P/(8 a G) (1 - (1 - q)^(2/3)). It is exact for nu = 0 and does not
hang on the number of steps: an element slides against its bound once its traction is there.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import railpatch
from case_samples import with_values
from patch_cases import Line, check

A, LOAD, FRICTION, MODULUS = 3e-3, 3e4, 0.3, 82e9
BOUND = FRICTION * LOAD
REACH = 3 * 2 * BOUND / (8 * A * MODULUS)  # m, at which all of it slides


def case(**more: Any) -> dict[str, Any]:
    base = {
        "kind": "patch",
        "material": {"shear_modulus": MODULUS, "poisson_ratio": 0.28},
        "geometry": {"semi_axes": [A, A]},
        "load": {"normal_force": LOAD},
        "grid": {"elements": [14, 14]},
        "motion": {"regime": "shift", "creepage": [0.0, 0.0]},
        "friction": {"coefficient": FRICTION},
        "method": {"tolerance": 1e-9},
    }
    return with_values(base, **more)


def loop_work(q: float) -> float:
    """J, of a cycle."""
    part = 1 - (1 - q) ** (5 / 3) - 5 / 6 * q * (1 + (1 - q) ** (2 / 3))
    return 9 * 2 * BOUND**2 / (5 * A * MODULUS) * part


@pytest.mark.parametrize("steps", [1, 3])
@pytest.mark.parametrize("q", [0.7, 0.9, 0.99])
def test_a_cycle_takes_what_mindlin_says(q: float, steps: int) -> None:
    way = REACH * (1 - (1 - q) ** (2 / 3))
    own = case(material__poisson_ratio=0.0, grid__elements=[32, 32])
    contact = railpatch.Contact(own)

    def moved(by: float) -> float:
        work = 0.0
        for _ in range(steps):
            result = contact.step(creepage=[by / steps, 0.0])
            assert result.status == "converged"
            work += result["friction_power"]
        return work

    moved(way)
    work = [moved(-2 * way), moved(2 * way)]
    wanted = loop_work(q)
    check(
        [
            Line("a cycle (J)", sum(work), wanted, 0.005 * wanted),
            Line("there as back (J)", work[1], work[0], 1e-3 * wanted),
        ]
    )


def test_sliding_back_in_one_step() -> None:
    """From full sliding to full sliding back: friction times what is slid, the way less what both
    bodies give, which is twice that of the first loading."""
    contact = railpatch.Contact(case(material__poisson_ratio=0.0, grid__elements=[32, 32]))
    contact.step(creepage=[3 * REACH, 0.0])
    result = contact.step(creepage=[-6 * REACH, 0.0])
    # beyond 2 REACH all slides; up to there half the cycle of q = 1 is taken
    wanted = BOUND * 4 * REACH + 0.5 * loop_work(1.0)
    # what is stored is the same before and after
    check(
        [
            Line("friction work (J)", result["friction_power"], wanted, 1e-3 * wanted),
            Line("work supplied (J)", result["creep_power"], wanted, 1e-3 * wanted),
        ]
    )


FEATURES: dict[str, dict[str, Any]] = {
    "plain": {},
    "elastic layer": {"layer": {"thickness": 2e-5, "shear_modulus": 1e9}},
    "yields": {
        "layer": {
            "thickness": 2e-5,
            "shear_modulus": 1e9,
            "yield_stress": 1.5e8,
            "hardening": 1e12,
        }
    },
    "yields alone": {"layer": {"thickness": 0.0, "yield_stress": 1.5e8, "hardening": 1e12}},
    "unlike": {"material": {"shear_modulus": [82e9, 60e9]}},
    "unlike yields": {
        "material": {"shear_modulus": [82e9, 60e9]},
        "layer": {"thickness": 2e-5, "shear_modulus": 1e9, "yield_stress": 1.5e8},
    },
    "rows": {"friction": {"coefficient": 0.3, "factor": [[-3e-3, 1.0], [3e-3, 0.6]]}},
}
# m along x and s, and N at its end
HISTORY = (
    ([8e-6, 2e-6], 3e4),
    ([1.6e-5, 4e-6], 3e4),
    ([-2e-5, -5e-6], 3e4),
    ([-6e-5, 0.0], 3e4),
    ([6e-5, 0.0], 3e4),
    ([-4e-5, 0.0], 2e4),
    ([4e-5, 0.0], 3e4),
)


def works(features: dict[str, Any], steps: int) -> np.ndarray:
    """J, [of HISTORY, supplied, friction, layer, stored]: in so many steps for each of its parts.
    Checks the book of each step."""
    contact = railpatch.Contact(case(**features))
    last = contact.step()
    before, found = LOAD, []
    for way, load in HISTORY:
        sums = np.zeros(4)
        for k in range(1, steps + 1):
            now = contact.step(
                creepage=[x / steps for x in way],
                normal_force=before + (load - before) * k / steps,
            )
            assert now.status == "converged"
            layer = now["plastic_power"]
            taken = now["friction_power"], 0.0 if np.isnan(layer) else layer
            stored = now["elastic_energy"] - last["elastic_energy"]
            if "material" in features:
                # unlike bodies: pressure stores too, and the load goes down with the approach
                mean = before + (load - before) * (k - 0.5) / steps
                stored -= mean * (now["approach"] - last["approach"])
            else:
                stored -= now["pressure_energy"] - last["pressure_energy"]
            sums += now["creep_power"], *taken, stored
            assert taken[0] > -1e-9 * now["elastic_energy"]
            assert taken[1] >= 0
            last = now
        before = load
        found.append(sums)
    return np.array(found)


@pytest.mark.parametrize("name", FEATURES)
def test_books_close_and_steps_do_not_count(name: str) -> None:
    """With one step for each part of a history, and with 20, of which each knows the way better.

    Loads change pressure along the way in which both differ, by the part of it that comes before
    sliding."""
    once, often = works(FEATURES[name], 1), works(FEATURES[name], 20)
    size = np.abs(often[:, 1] + often[:, 2]).max()
    for found in (once, often):
        # unlike bodies: the load's work is by the mean of both ends, where the load changes
        level = [k for k, (_, load) in enumerate(HISTORY) if load == 3e4 and k < 5]
        rows = level if "material" in FEATURES[name] else range(len(HISTORY))
        supplied, friction, layer, stored = found[list(rows)].T
        missing = np.abs(supplied - friction - layer - stored).max()
        assert missing < 1e-5 * size
    taken = once[:, 1] + once[:, 2], often[:, 1] + often[:, 2]
    # a mean of both ends' tractions left nine tenths of it out
    assert np.abs(taken[0] - taken[1])[:5].max() < 0.01 * size
    assert np.abs(taken[0] - taken[1]).max() < 0.01 * size
