"""A wheel finds the height for its vertical force, where one patch becomes two too.

There the force can rise by a fifth over a third of a micrometre, a hundred times as steeply as
beside it. Checked by wheels whose height is given.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from case_samples import WHEELSET, with_values
from railpatch import _core
from railpatch.case.load import load_scene
from railpatch.case.to_core import config_of, input_of

BASE = with_values(
    WHEELSET,
    kind="wheel_rail",
    friction=None,
    wheelset__z=None,
    wheelset__vertical_force=6e4,
    method__normal="hertz",
    method__tangential="none",
)
TOLERANCE = 1e-5  # of the force, by default
# what a search is said to end within: core/numeric/force_search.hpp
MOST = 80
# y, yaw of an S1002 on UIC60 at 1:40 whose second patch comes at 51.18 kN
STEEP = {"y": 0.0055757333, "yaw": -0.0115580015}


class Wheel:
    """Finds heights and, beside it, the force at a height."""

    def __init__(self, **values: Any) -> None:
        self.found = load_scene(with_values(BASE, **values))
        fixed = {"wheelset__vertical_force": None, "wheelset__z": 0.0}
        self.given = load_scene(with_values(BASE, **values, **fixed))
        self.search, self.at = (
            _core.Contact(config_of(scene), False) for scene in (self.found, self.given)
        )

    def carrying(self, force: float, **state: float) -> dict[str, Any]:
        """A step from rest: no depth of an earlier one is known."""
        self.search.reset()
        return self.search.step({**input_of(self.found.case), **state, "vertical_force": force})

    def force(self, z: float, **state: float) -> float:
        """At a height, N."""
        return -self.at.step({**input_of(self.given.case), **state, "z": z})["force"][2]


def drawn(count: int, seed: int) -> list[tuple[float, dict[str, float]]]:
    """Forces over one and a half decades; farther out some are beyond an end of the rail."""
    rng = np.random.default_rng(seed)
    return [
        (
            10 ** rng.uniform(3.7, 5.2),
            {"y": rng.uniform(-6e-3, 6e-3), "yaw": rng.uniform(-0.03, 0.03)},
        )
        for _ in range(count)
    ]


@pytest.mark.parametrize("kind", ["wheel_rail", "wheelset"])
def test_every_force_of_a_steep_rise_is_found(kind: str) -> None:
    wheel = Wheel(kind=kind, method__tangential="table", friction={"coefficient": 0.3})
    for force in [*np.linspace(51.1e3, 61.3e3, 40), 60.45e3, 60.5e3, 60.59e3]:
        found = wheel.carrying(force, **STEEP)
        assert found["status"] == "converged", force
        assert abs(wheel.force(found["z"], **STEEP) - force) <= TOLERANCE * force
        # 1.5e-4 m, the first guess, halved to a step that changes the force by the tolerance,
        # 0.5 N at 100 N in a nanometre, takes 25; and those before and granted beside, 8 + 3
        assert found["evaluations"] <= 36, force


@pytest.mark.parametrize("grid", [{"element_size": [5e-4, 5e-4]}, {"elements": [16, 16]}])
def test_no_force_is_missed(grid: dict[str, Any]) -> None:
    wheel = Wheel(grid=grid)
    counts = []
    for force, state in drawn(500, 1):
        found = wheel.carrying(force, **state)
        assert found["status"] == "converged", (force, state)
        assert abs(wheel.force(found["z"], **state) - force) <= TOLERANCE * force
        counts.append(found["evaluations"])
    assert np.median(counts) <= 4
    assert np.percentile(counts, 95) <= 6
    assert max(counts) <= 36


def test_what_is_missed_is_a_jump() -> None:
    """Patches that become one at a distance, as the program CONTACT has it, make the force jump."""
    wheel = Wheel(method__patch_rule="contact")
    missed = 0
    for force, state in drawn(500, 1):
        found = wheel.carrying(force, **state)
        assert found["evaluations"] <= MOST
        if found["status"] == "converged":
            continue
        assert found["status"] == "not_converged"
        missed += 1
        # a picometre apart
        below, above = (wheel.force(found["z"] + h, **state) for h in (-1e-12, 1e-12))
        assert below < force < above
        assert above - below > 1e-3 * force
    assert missed > 0


# y, yaw, N, stiffness lateral and vertical: at the flange root, on rails that give way by more than
# the contact is wide
ON_SPRINGS = {
    "wheel_rail": [
        (0.007331, 0.01442, 111e3, [3.4e6, 2.7e7]),
        (0.006638, -0.00632, 83.5e3, [8.1e6, 4.5e7]),
        (0.007139, -0.00933, 29e3, [3.8e6, 6.3e7]),
        (0.006996, -0.00761, 15.7e3, [4.4e6, 3.4e7]),
    ],
    "wheelset": [
        (0.005558, 0.01569, 49.9e3, [2.2e7, 6.7e7]),
        (0.006349, 0.0014, 80.8e3, [7.7e6, 5e7]),
        (0.007186, -0.01337, 22.8e3, [2.5e7, 4.9e7]),
    ],
}


@pytest.mark.parametrize("kind", ["wheel_rail", "wheelset"])
def test_places_of_elastic_rails_are_found(kind: str) -> None:
    for y, yaw, force, stiffness in ON_SPRINGS[kind]:
        support = {"stiffness": stiffness, "damping": [0.0, 0.0]}
        scene = load_scene(
            with_values(
                BASE,
                kind=kind,
                method__tangential="table",
                friction={"coefficient": 0.3},
                track__rail_support=support,
                wheelset__vertical_force=force,
                wheelset__y=y,
                wheelset__yaw=yaw,
            )
        )
        found = _core.Contact(config_of(scene), False).step(input_of(scene.case))
        assert found["status"] == "converged", (y, yaw, force)
        for side in ("left", "right") if kind == "wheelset" else ("right",):
            wheel = found[side]
            push = -np.array(wheel["force"][1:])
            left = np.array(stiffness) * wheel["rail_deflection"] - push
            assert np.abs(left).max() <= TOLERANCE * np.linalg.norm(push)
        assert -found["force"][2] == pytest.approx(force, rel=TOLERANCE)
