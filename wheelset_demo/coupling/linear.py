"""The masters as matrices: what a small disturbance becomes in one communication step.

With the multibody side linear, dx/dt = A x + B w, and the contact w = C x, a step h of a master is
x -> M x, with what the master remembers appended to x. It is stable where no eigenvalue of M is
above 1 in size. Over a step

    x(h) = F x + G0 w0 + G1 dw/dt,   F = exp(A h),   G0, G1 = integrals of exp(A (h - t)) B (1, t)

A and B are central differences of the multibody side, C the derivatives of the contact in this
process: nothing here runs a master or an FMU. x has the coordinates and velocities of the wheelset
without the pitch angle, on which nothing depends.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy

from wheelset_demo.coupling.masters import Mean
from wheelset_demo.coupling.multibody import MOTION, Multibody
from wheelset_demo.hunting import PITCH
from wheelset_demo.scene import WheelsetScene, refuse_bulk, refuse_changes
from wheelset_demo.start import released
from wheelset_demo.steppers import GAMMA
from wheelset_demo.system import COUNT, System, Vector

KEPT = [k for k in range(MOTION) if k != PITCH]
# of differences: m, rad, m/s, rad/s; the suspension is linear and turns are small
DIFFERENCE = 1e-6
PLACES = COUNT - 1  # coordinates come first
STEADY_STEPS = 3


@dataclass(frozen=True)
class Linearised:
    """Straight running at a speed. motion: [12], there. a: [11, 11], b: [11, 6], c: [6, 11]."""

    motion: Vector
    a: Vector
    b: Vector
    c: Vector

    @property
    def whole(self) -> Vector:
        """[11, 11], of both sides together."""
        return self.a + self.b @ self.c

    @property
    def growth(self) -> float:
        """1/s, of the motion that grows fastest, or dies most slowly."""
        return float(np.linalg.eigvals(self.whole).real.max())

    @property
    def bounce(self) -> float:
        """rad/s, of the fastest undamped oscillation on the contact's stiffness."""
        return float(np.sqrt(np.abs(np.linalg.eigvals(self.whole[PLACES:, :PLACES][:-1]))).max())

    @property
    def least_damped_bounce(self) -> tuple[float, float]:
        """1/s, decay rate, and rad/s, frequency of the bounce that dies most slowly."""
        values = np.linalg.eigvals(self.whole)
        fast = values[values.imag > 0.5 * self.bounce]
        slow = fast[np.argmax(fast.real)]
        return float(-slow.real), float(np.abs(slow))

    @property
    def creep(self) -> float:
        """1/s, of the fastest decay by creep forces."""
        values = np.linalg.eigvals(self.whole[PLACES:, PLACES:])
        return float(-values.real.min())


def steady(system: System, motion: Vector, speed: float) -> Vector:
    """The motion that goes on as it is, near one; with its contact solved last. Newton's method."""
    for _ in range(STEADY_STEPS):
        off = system.rates(0.0, motion).motion
        off[0] -= speed
        slope = system.derivatives(motion).by_motion[:MOTION]
        motion = motion.copy()
        motion[KEPT] -= np.linalg.solve(slope[np.ix_(KEPT, KEPT)], off[KEPT])
    system.rates(0.0, motion)
    return motion


def linearise(scene: WheelsetScene, speed: float) -> Linearised:
    """Straight on at a speed (m/s). Raises CaseError, ContactFailure."""
    refuse_bulk(scene.case, "a linearised wheelset")
    refuse_changes(scene.case, "a linearised wheelset")
    straight = scene.at_speed(speed, 0.0)
    system = System(straight, exact=True)
    motion = steady(system, released(straight, system).motion, speed)
    wrench = system.element.contact_wrench[0].copy()
    c = system.element.derivatives()[:, KEPT]
    side = Multibody(straight)
    a, b = np.zeros((MOTION, MOTION)), np.zeros((MOTION, 6))
    for k, unit in enumerate(DIFFERENCE * np.eye(MOTION)):
        high, low = (side.rates(0.0, motion + s * unit, wrench) for s in (1, -1))
        a[:, k] = (high - low)[:MOTION] / (2 * DIFFERENCE)
    for k, unit in enumerate(1e3 * np.eye(6)):
        high, low = (side.rates(0.0, motion, wrench + s * unit) for s in (1, -1))
        b[:, k] = (high - low)[:MOTION] / 2e3
    return Linearised(motion, a[np.ix_(KEPT, KEPT)], b[KEPT], c)


def over_step(system: Linearised, step: float) -> tuple[Vector, Vector, Vector]:
    """F, G0 and G1, of one exponential."""
    n, m = system.b.shape
    block = np.zeros((n + 2 * m, n + 2 * m))
    block[:n, :n], block[:n, n : n + m] = system.a, system.b
    block[n : n + m, n + m :] = np.eye(m)
    found = scipy.linalg.expm(step * block)[:n]
    return found[:, :n], found[:, n : n + m], found[:, n + m :]


def parallel(system: Linearised, step: float) -> Vector:
    """With the x before."""
    f, g, _ = over_step(system, step)
    return np.block([[f, g @ system.c], [np.eye(len(f)), np.zeros_like(f)]])


def hold(system: Linearised, step: float) -> Vector:
    """x alone."""
    f, g, _ = over_step(system, step)
    return f + g @ system.c


def leapfrog(system: Linearised, step: float) -> Vector:
    """x alone."""
    n = len(system.a)
    found = np.eye(n)
    found[PLACES:] += step * system.whole[PLACES:]
    # rates of coordinates are the velocities: rows of a
    found[:PLACES] += step * system.a[:PLACES] @ np.vstack([np.zeros((PLACES, n)), found[PLACES:]])
    return found


def linear(system: Linearised, step: float) -> Vector:
    """With the x before."""
    f, g0, g1 = over_step(system, step)
    rate = g1 @ system.c / step
    return np.block([[f + g0 @ system.c + rate, -rate], [np.eye(len(f)), np.zeros_like(f)]])


def mean(system: Linearised, step: float) -> Vector:
    """With the x before, and the inputs at which the FMU ended."""
    f, g, _ = over_step(system, step)
    n, count = len(f), Mean.substeps
    one, none = np.eye(n), np.zeros((n, n))
    # rates of the coordinates are the velocities, those of the velocities their last change
    here, before = np.zeros((n, n)), np.zeros((n, n))
    here[:PLACES] = system.a[:PLACES]
    here[PLACES:, PLACES:] = np.eye(n - PLACES) / step
    before[PLACES:, PLACES:] = -np.eye(n - PLACES) / step
    # inputs at the sub-steps' ends, [x, x before, where the FMU ended]
    ends = [
        np.hstack([one + past * here, past * before, none])
        for past in step * np.arange(1, count + 1) / count
    ]
    ended = np.hstack([none, none, one])
    average = (0.5 * ended + sum(ends[:-1]) + 0.5 * ends[-1]) / count
    moved = np.hstack([f, none, none]) + g @ system.c @ average
    return np.vstack([moved, np.hstack([one, none, none]), ends[-1]])


def iterate(system: Linearised, step: float) -> Vector:
    """x alone, where the iteration has converged."""
    f, g, _ = over_step(system, step)
    half = 0.5 * g @ system.c
    return np.linalg.solve(np.eye(len(f)) - half, f + half)


def contraction(system: Linearised, step: float) -> float:
    """-, what is left of an error of the wrench after one plain iteration."""
    _, g, _ = over_step(system, step)
    return radius(0.5 * system.c @ g)


def implicit(system: Linearised, step: float) -> Vector:
    """x alone; derivatives in linear motion are never old."""
    matrix = step * system.whole
    one = np.eye(len(matrix))
    inverse = np.linalg.inv(one - GAMMA * matrix)
    first = inverse @ matrix
    second = inverse @ (matrix @ (one + first) - 2 * first)
    return one + 1.5 * first + 0.5 * second


def exchange(system: Linearised, step: float) -> Vector:
    """x alone."""
    matrix = step * system.whole
    one = np.eye(len(matrix))
    return one + matrix @ (one + matrix / 2 @ (one + matrix / 3 @ (one + matrix / 4)))


MATRICES: dict[str, Callable[[Linearised, float], Vector]] = {
    "parallel": parallel,
    "hold": hold,
    "leapfrog": leapfrog,
    "linear": linear,
    "mean": mean,
    "iterate": iterate,
    "iterate-mixed": iterate,
    "iterate-newton": iterate,
    "implicit": implicit,
    "exchange": exchange,
}


def radius(matrix: Vector) -> float:
    """Size of the greatest eigenvalue."""
    return float(np.abs(np.linalg.eigvals(matrix)).max())


def stable(name: str, system: Linearised, step: float, growth: float) -> bool:
    """Whether nothing grows faster than by a rate (1/s), and the plain iteration converges."""
    if name == "iterate" and contraction(system, step) >= 1:
        return False
    return radius(MATRICES[name](system, step)) <= np.exp(growth * step)
