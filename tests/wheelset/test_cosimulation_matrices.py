"""The masters as matrices: closed forms on one oscillator and one damped mass, and real runs.

With x'' = -w^2 x, or v' = -c v, the largest stable step of each master is a closed form: of forces
held over a step whose motion is exact, of Newmark's methods, of Adams and Bashforth's of order 2.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from fmpy import read_model_description, simulate_fmu
from railpatch.fmu import pack_fmu
from railpatch.pinocchio.element import STATE

from wheelset_demo.coupling.linear import (
    KEPT,
    MATRICES,
    PLACES,
    Linearised,
    contraction,
    linearise,
    radius,
)
from wheelset_demo.coupling.masters import MASTERS
from wheelset_demo.coupling.multibody import Multibody
from wheelset_demo.coupling.slave import ContactSlave
from wheelset_demo.coupling.stability import (
    CLOSE,
    LARGEST,
    Rolling,
    bound_by_matrix,
    bound_by_runs,
    largest,
)
from wheelset_demo.scene import WheelsetScene
from wheelset_demo.system import System

W, C, D = 1200.0, 3e4, 6.0  # rad/s, of a bounce; 1/s, of creep; 1/s, half of a bounce's damping
EXPLICIT = ("parallel", "hold", "leapfrog", "linear", "mean")


def model(stiffness: float, damping: float, own: float = 0.0) -> Linearised:
    """A unit mass along z: contact stiffness (1/s^2) and damping (1/s), and damping of its own."""
    n = len(KEPT)
    a, b, c = np.zeros((n, n)), np.zeros((n, 6)), np.zeros((6, n))
    a[:PLACES, PLACES : 2 * PLACES] = np.eye(PLACES)
    a[PLACES + 2, PLACES + 2] = -own
    b[PLACES + 2, 2] = 1.0
    c[2, 2], c[2, PLACES + 2] = -stiffness, -damping
    return Linearised(np.zeros(12), a, b, c)


def bound(name: str, system: Linearised, low: float, high: float) -> float:
    """Where the greatest eigenvalue crosses 1; plain motion at constant speed has two of size 1."""

    def grows(step: float) -> bool:
        diverges = name == "iterate" and contraction(system, step) > 1
        return diverges or radius(reduced(MATRICES[name](system, step))) > 1 + 1e-9

    assert not grows(low)
    assert grows(high)
    while high > 1.0001 * low:
        middle = np.sqrt(low * high)
        low, high = (low, middle) if grows(middle) else (middle, high)
    return low


def reduced(matrix: np.ndarray) -> np.ndarray:
    """Of z alone: all else moves on freely."""
    count = len(matrix) // len(KEPT)
    kept = [len(KEPT) * k + at for k in range(count) for at in (2, PLACES + 2)]
    return matrix[np.ix_(kept, kept)]


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("parallel", 1),
        ("hold", 2),
        ("leapfrog", 2),
        ("linear", 1),
        ("iterate", 2),
        ("exchange", 2.785),
    ],
)
def test_creep_bounds_steps_by_its_decay_rate(name: str, value: float):
    # Runge-Kutta of order 4: 1 + z + z^2/2 + z^3/6 + z^4/24 is 1 at z = -2.785
    found = bound(name, model(0.0, C), 0.1 / C, 10 / C)
    assert found == pytest.approx(value / C, rel=1e-3)


def test_bounce_bounds_steps_by_its_frequency():
    # leapfrog 2/w; plain iteration 2/w, too: the mean force over half the square of the step
    for name in ("leapfrog", "iterate"):
        assert bound(name, model(W**2, 0.0), 0.1 / W, 10 / W) == pytest.approx(2 / W, rel=1e-3)


def test_model_exchange_is_bounded_by_its_explicit_method():
    # 2.828: the same polynomial on the imaginary axis, |.| = 1 at z^2 = -8
    found = bound("exchange", model(W**2, 0.0), 0.1 / W, 10 / W)
    assert found == pytest.approx(np.sqrt(8) / W, rel=1e-3)


def test_held_forces_drive_a_bounce_that_is_damped_too_little():
    # determinant 1 + (w h)^2/2 without damping; to first order w^2 h/4 against D
    system = model(W**2, 0.0, 2 * D)
    assert bound("hold", system, 1e-6, 1e-3) == pytest.approx(4 * D / W**2, rel=0.01)
    undamped = model(W**2, 0.0)
    step = 1e-4
    found = np.linalg.det(reduced(MATRICES["hold"](undamped, step)))
    assert found == pytest.approx(1 + 0.5 * (W * step) ** 2, rel=1e-12)


def test_iteration_and_implicit_steps_have_no_bound():
    for system in (model(W**2, 0.0), model(0.0, C), model(W**2, C)):
        for step in np.geomspace(1e-6, 1.0, 13):
            for name in ("iterate-newton", "implicit"):
                assert radius(reduced(MATRICES[name](system, step))) <= 1 + 1e-9
    # the trapezoidal rule keeps a bounce's energy, ros2 ends it
    long = model(W**2, 0.0)
    assert radius(reduced(MATRICES["iterate"](long, 0.01))) == pytest.approx(1, abs=1e-9)
    assert radius(reduced(MATRICES["implicit"](long, 0.01))) < 0.4


@pytest.mark.parametrize("guess", [0.0, 3e-6, 1e-4, 1e-3, LARGEST])
def test_the_search_finds_a_bound_wherever_it_begins(guess: float):
    for limit in (1.3e-6, 8e-6, 1.1e-4, 7e-3):
        found = largest(lambda step, limit=limit: step <= limit, guess)
        assert limit / CLOSE <= found <= limit
    assert largest(lambda step: True, guess) == LARGEST
    assert largest(lambda step: False, guess) == 0.0


@pytest.mark.parametrize("speed", [0.2, 20.0, 80.0])
def test_both_sides_together_are_the_linearised_wheelset(scene: WheelsetScene, speed: float):
    # one side by differences of the multibody side, the other by Pinocchio's derivatives
    found = linearise(scene, speed)
    system = System(scene.at_speed(speed, 0.0), exact=True)
    system.rates(0.0, found.motion)
    expected = system.derivatives(found.motion).by_motion[np.ix_(KEPT, KEPT)]
    scale = np.abs(expected).max(axis=1, keepdims=True)
    assert (np.abs(found.whole - expected) / scale).max() < 1e-5


def test_multibody_derivatives_are_differences(scene: WheelsetScene):
    side, motion = Multibody(scene), Rolling(scene, 20.0).system.motion.copy()
    motion[[1, 3, 4, 7]] += [1e-3, 1e-3, 2e-3, 0.1]
    wrench = np.array([1e3, -2e3, -1.2e5, 500.0, -300.0, 200.0])
    by_motion, by_wrench, _ = side.derivatives(0.0, motion, wrench)
    greatest = np.abs(by_motion).max()
    for k, unit in enumerate(1e-6 * np.eye(12)):
        high, low = (side.rates(0.0, motion + s * unit, wrench) for s in (1, -1))
        column = (high - low)[:12] / 2e-6
        assert column == pytest.approx(by_motion[:, k], rel=1e-5, abs=1e-5 * greatest)
    for k, unit in enumerate(np.eye(6)):
        column = (side.rates(0.0, motion, wrench + unit) - side.rates(0.0, motion, wrench))[:12]
        assert column == pytest.approx(by_wrench[:, k], abs=1e-9)


@pytest.mark.parametrize("name", MASTERS)
def test_a_run_is_what_its_matrix_says(name: str, scene: WheelsetScene, slave: ContactSlave):
    # the disturbance is small, so the FMU's run is the linear map, step by step
    rolling = Rolling(scene, 20.0)
    step = 0.5 * min(1e-3, bound_by_matrix(rolling.system, name))
    matrix = MATRICES[name](rolling.system, step)
    x = (rolling.start - rolling.system.motion)[KEPT]
    expected = np.tile(x, len(matrix) // len(x))
    master = MASTERS[name](Multibody(rolling.scene), slave)
    point = master.begin(0.0, rolling.start)
    for _ in range(25):
        point, expected = master.step(point, step), matrix @ expected
    off = (point.motion - rolling.system.motion)[KEPT]
    off[0] -= rolling.speed * point.time
    # sizes by energy
    scale = rolling.scale
    assert np.linalg.norm(scale * (off - expected[: len(x)])) < 0.02 * np.linalg.norm(scale * x)


@pytest.mark.parametrize(("name", "speed"), [("leapfrog", 20.0), ("mean", 80.0)])
def test_the_bound_of_runs_is_that_of_eigenvalues(
    name: str, speed: float, scene: WheelsetScene, slave: ContactSlave
):
    rolling = Rolling(scene, speed)
    found, _ = bound_by_runs(rolling, slave, name)
    # runs close in to 6 %
    assert found == pytest.approx(bound_by_matrix(rolling.system, name), rel=0.1)
    assert found < 2e-3


def test_the_fmu_names_half_of_the_step_that_held_forces_bear(scene: WheelsetScene, tmp_path: Path):
    # its output largest_step is 1/c where creep is stiffest, the bound of hold 2/c
    system = linearise(scene, 0.2)
    path = pack_fmu(scene.at_height(derivatives=True), tmp_path / "a.fmu", largest_step=True)
    body = scene.body
    about = body.roll_inertia + body.carrier_inertia
    values = {"wheelset.mass": body.total_mass} | {
        f"wheelset.inertia[{k}]": value
        for k, value in ((1, about), (2, body.pitch_inertia), (3, about))
    }
    names = {v.name for v in read_model_description(str(path)).modelVariables}
    motion = zip((f"wheelset.{name}" for name in STATE), system.motion.tolist(), strict=True)
    values |= {name: value for name, value in motion if name in names}
    found = simulate_fmu(
        str(path),
        start_values=values,
        stop_time=1e-3,
        output_interval=1e-3,
        output=["largest_step"],
    )
    assert found["largest_step"][-1] == pytest.approx(
        0.5 * bound_by_matrix(system, "hold"), rel=0.01
    )
