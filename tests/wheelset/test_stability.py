"""Steps of 1 ms from 0.2 to 80 m/s with exact derivatives, and what the balances leave open.

The scene is hunting.toml, whose wheels stay on the treads. The reference is rk4 with steps below
its bound, see wheelset_demo/steppers.py: of the wheelset's spin 10.7 us at 0.2 m/s.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import wheelset_scenes as scenes

from wheelset_demo.coupling.study import with_elements
from wheelset_demo.simulation import Simulation
from wheelset_demo.system import COUNT
from wheelset_demo.trace import Trace

# m/s: s, duration; s, step of the reference
CASES = {0.2: (0.02, 1e-5), 2.0: (0.1, 1e-4), 20.0: (0.4, 5e-4), 80.0: (0.4, 5e-4)}
RELEASED = 2e-3  # m
STEP = 1e-3  # s
WAVE = 16.6  # m, Klingel's of these wheels and rails
# elements across: a small grid, and the scene's own
GRIDS = [8, pytest.param(12, marks=pytest.mark.long)]


def traced(
    folder: Path, elements: int, speed: float, step: float, stepper: str, every: int = 1
) -> Trace:
    """A run, logged at every ms."""
    values = {
        "speed": speed,
        "y": RELEASED,
        "distance": speed * CASES[speed][0],
        "step": step,
        "stepper": stepper,
        "derivatives_every": every,
        "log_every": round(STEP / step),
    }
    scene = scenes.scene(folder, "hunting.toml", **values)
    return Simulation(with_elements(scene, elements)).run()


def lateral_error(found: Trace, expected: Trace, speed: float) -> float:
    """Of y, yaw and the rate of yaw, relative to what the wave has of each.

    The bounce on the contacts, undamped and some 1500 rad/s, is not followed by such steps.
    """
    a, b = np.array(found.motions), np.array(expected.motions)
    assert len(a) == len(b)
    columns = [1, 4, COUNT + 4]
    turn = 2 * np.pi / WAVE
    wave = RELEASED * np.array([1.0, turn, speed * turn**2])
    scale = np.maximum(wave, np.abs(b).max(axis=0)[columns])
    return float((np.abs(a - b).max(axis=0)[columns] / scale).max())


@pytest.mark.parametrize("speed", CASES)
@pytest.mark.parametrize("elements", GRIDS)
def test_one_millisecond(elements: int, speed: float, tmp_path: Path, measured):
    _, fine = CASES[speed]
    expected = traced(tmp_path, elements, speed, fine, "rk4")
    assert expected.failure is None
    for every in (1, 25):
        found = traced(tmp_path, elements, speed, STEP, "ros2", every)
        assert found.failure is None
        motion = lateral_error(found, expected, speed)
        lost = found.work("friction")[-1] + found.work("damping")[-1]
        mechanical = np.abs(found.mechanical_residual()).max() / lost
        contact = np.abs(found.contact_residual()).max() / lost
        linear, angular = found.momentum_errors()
        measured(
            f"{speed} m/s, 1 ms, derivatives every {every}: {motion:.1e} off rk4; "
            f"energy open by {mechanical:.1e} (bodies), {contact:.1e} (contacts) of the loss; "
            f"momentum by {linear:.1e}, about the centre by {angular:.1e}"
        )
        assert motion < 5e-3
        assert mechanical < 1e-3
        assert contact < 5e-3
        assert linear < 1e-12
        assert angular < 1e-6


@pytest.mark.parametrize("elements", GRIDS)
def test_explicit_steps_of_one_millisecond_fail_where_creep_is_stiff(elements: int, tmp_path: Path):
    # creep forces at the bound of friction throw it to and fro
    explicit, implicit = (traced(tmp_path, elements, 0.2, STEP, name) for name in ("rk4", "ros2"))
    lateral = [np.abs(trace.coordinate(COUNT + 1)).max() for trace in (explicit, implicit)]
    assert lateral[0] > 20 * lateral[1]
